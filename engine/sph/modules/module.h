/* Physics modules of the solid, as descriptors. Off means absent: the loops of a module run only on bodies that have
 * it, and columns that no body needs are not allocated. The scene decides which modules a body has.
 * A module owns its physics: NAME.h has its description, what it declares (structs of inputs, values of a material and
 * results, columns: declarations.h), its loops, compiled once per CPU class (ranges.h), checks, preparation and report.
 * It acts on other modules only through columns and through struct sph_terms (step/system.h), never by a flag inside
 * their loops:
 *
 *   solid_density  density of the solid matter, which the equation of state publishes
 *   yield_limit    a yield law sets it, other modules lower it, `elastic` brings the stress back to it
 *   two_mu         effective 2 mu, where it is not the material's, and shear_factor, its factor where strain feeds S
 *   flaw_damage    damage by flaws, where another module damages the body, too
 *   crack_stress, crack_pressure   the stress that opens flaws, where it is not the particle's own
 *   shear_damage   damage that scales the deviator, where it is not all damage (ranges.h)
 *
 * A step runs the stages in order, block by block, and within a stage the modules in the order of declarations.h. The
 * pair loop runs before SPH_FORCES. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/scene/inputs.h"

/* Sets of the numbers below a constant count: of columns, of modules. A set is a struct with `word`, a bit for each
 * number in as many words as the count needs:
 *
 *   struct sph_column_set { uint64_t word[SET_WORDS(SPH_COLUMNS)]; };
 *
 * The functions take the words, so that they serve sets of any size. */

enum { SET_BITS = 64 };
#define SET_WORDS(count) (((count) + SET_BITS - 1) / SET_BITS)

static inline bool set_has(const uint64_t *word, size_t number) {
  return word[number / SET_BITS] >> number % SET_BITS & 1;
}

/* Adds `count` numbers from `first` on. */
static inline void set_add(uint64_t *word, size_t first, size_t count) {
  for (size_t k = first; k < first + count; k++)
    word[k / SET_BITS] |= (uint64_t)1 << k % SET_BITS;
}

/* Adds all members of another set. Both are of numbers below `count`. */
static inline void set_unite(uint64_t *word, const uint64_t *other, size_t count) {
  for (size_t w = 0; w < SET_WORDS(count); w++)
    word[w] |= other[w];
}

/* How many members a set of numbers below `count` has. */
static inline size_t set_size(const uint64_t *word, size_t count) {
  size_t size = 0;
  for (size_t w = 0; w < SET_WORDS(count); w++)
    size += (size_t)__builtin_popcountll(word[w]);
  return size;
}

/* The first member from `from` on; `count` when there is none. */
static inline size_t set_next(const uint64_t *word, size_t count, size_t from) {
  while (from < count && !set_has(word, from))
    from++;
  return from;
}

/* The members in ascending order. */
#define FOR_SET(k, word, count) for (size_t k = set_next(word, count, 0); k < (count); k = set_next(word, count, k + 1))

enum sph_module_index {
#define MODULE(name) SPH_MODULE_##name,
#include "engine/sph/modules/declarations.h"
  SPH_MODULES
};
struct sph_module_set {
  uint64_t word[SET_WORDS(SPH_MODULES)];
};
struct sph_column_set; /* step/system.h */

/* Material and physics of one body. Off means absent: nothing is stored or called for it. */
struct sph_body_physics {
  struct sph_material material;
  bool strength;                 /* deviatoric stress: Hooke, Jaumann, radial return */
  const struct sph_flaws *flaws; /* NULL: no fracture; by the body's own particle order; copied at create */
};

enum sph_stage {
  SPH_PREDICT,       /* carries the module's own variables to the new time, by the rates of the old one */
  SPH_RESPOND,       /* pressure and sound speed of the predicted state */
  SPH_PUBLISH,       /* terms that other modules read */
  SPH_LIMIT,         /* bounds of the pressure */
  SPH_YIELD,         /* the yield limit of the solid: a law sets it, other modules lower it */
  SPH_YIELD_OF_BODY, /* from the solid's yield limit to that of the body */
  SPH_RETURN,        /* the deviator back to the yield limit; this and the two before only where a law sets a limit */
  SPH_CRACK,         /* open flaws and the damage by them, from the stress that the solid bears */
  SPH_DAMAGE,        /* all damage, where a body has several causes of it */
  SPH_FORCES,        /* after the pair loop: forces from elsewhere, before degrees of freedom are held */
  SPH_RATES,         /* after these: new rates from the velocity gradient, and half the change of rates added */
  SPH_STAGES
};

/* Where several modules that set the same quantity are on, the last of them acts and the others are off. */
enum sph_module_sets { SPH_SETS_NOTHING, SPH_SETS_PRESSURE, SPH_SETS_YIELD_LIMIT };

/* `count` members of struct sph_columns from `first` on, their first value, and which bodies need them. */
struct sph_column_need {
  size_t first, count;                                 /* SPH_COLUMNS_OF(member); a count of 0 ends a list */
  double initial;                                      /* of all particles, other bodies' too */
  bool (*needed)(const struct sph_body_physics *body); /* NULL: in every body that has the module */
};

struct sph_flaws;
struct sph_particles;
struct sph_solid;
struct sph_system;

struct sph_module {
  const char *name;   /* "yield" */
  const char *doc;    /* what it models, for `clast explain` */
  const char *source; /* paper and equation */
  const char *when;   /* the condition that turns it on, for `clast explain` */
  bool (*on)(const struct sph_body_physics *body, const struct sph_inputs *inputs);
  enum sph_module_sets sets;
  const struct sph_column_need *columns; /* NULL: none */
  int bytes_in_pairs;                    /* per particle, of the pair loop's records */
  int bytes_linked;                      /* per particle, made by `prepare`; an estimate */
  double cost;                           /* ns of one core per particle-step, where it is an option (bench_sph) */
  /* All optional. `check_material` refuses values of a material that do not go together, whether or not the module is
   * on; STATUS_CONTENT, the message begins with the value's name. `check` refuses inputs that their rows alone cannot
   * refuse: STATUS_CONTENT, without "body n: ". */
  status (*check_material)(const struct sph_material *material, struct error *error);
  status (*check)(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first, size_t last,
                  struct error *error);
  /* Sets up the particles first .. last - 1 of a body at rest. */
  void (*set_up)(const struct sph_body_physics *body, struct sph_particles *particles, size_t first, size_t last);
  /* Makes body->prepared[index]; `free_prepared` frees it. */
  status (*prepare)(const struct sph_inputs *inputs, const struct sph_particles *particles, struct sph_solid *body,
                    struct error *error);
  void (*free_prepared)(void *prepared);
  /* After a restart, makes again from the columns those prepared data that change in a run. */
  void (*restored)(struct sph_system *system, const struct sph_solid *body);
  /* Called once a step between SPH_RETURN and SPH_CRACK, when all blocks of all bodies have their new stress: for
   * computations on particles of several blocks. One module of a body may have it. */
  void (*meet)(struct sph_system *system, const struct sph_solid *body);
  /* Called once a step when the lists hold, just before the pair loop, which then leaves out pairs of different bodies
   * (sph_pairs_foreign): it computes what they do. One module may have it. False without memory. */
  bool (*touch)(struct sph_system *system);
  /* Initial values of the body's columns. */
  void (*fill)(struct sph_system *system, const struct sph_solid *body, const struct sph_particles *particles);
  /* Values of a material that follow from others: `given` says of each row of sph_materials_table whether the scene
   * gives it. Called whether or not the module is on. */
  void (*complete_material)(struct sph_material *material, const bool *given);
};

const struct sph_module *sph_modules_at(size_t index); /* by enum sph_module_index */

/* The modules of a set, in their order: FOR_MODULES(m, body->modules). */
#define FOR_MODULES(m, set) FOR_SET(m, (set).word, SPH_MODULES)
/* The modules that act in a body. */
struct sph_module_set sph_modules_of(const struct sph_body_physics *body, const struct sph_inputs *inputs);
/* The columns that these modules need in a body. */
struct sph_column_set sph_modules_columns(const struct sph_module_set *modules, const struct sph_body_physics *body);
/* Sets up the particles of a body at rest, by all of its modules. */
void sph_modules_set_up(const struct sph_body_physics *body, const struct sph_inputs *inputs,
                        struct sph_particles *particles, size_t first, size_t last);
/* Does damage scale the deviator of a body by 1 - D? Not where a module publishes the damage that does (shear_damage).
 */
bool sph_modules_damage_scales_shear(const struct sph_body_inputs *body, const struct sph_inputs *inputs);
/* complete_material of all modules. */
void sph_modules_complete_material(struct sph_material *material, const bool *given);
