/* The columns of a system: which exist, their memory, and copying particles into them and back. The arrays of the
 * state, of a restart file and of the estimate of memory are all made from the set sph_system.columns. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "engine/sph/body/bodies.h"
#include "engine/sph/step/system_layout.h"

/* Columns that particles are set up with or read back into. */
static const struct {
  size_t column, member; /* SPH_COLUMN, and the place in struct sph_particles */
  bool filled, read;
  double absent; /* value read when no body has the column; NaN: nothing is written */
} carried[] = {
#define CARRIED(name, member_, filled_, read_, absent_)                                                                \
  { SPH_COLUMN(name), offsetof(struct sph_particles, member_), filled_, read_, absent_ }
    CARRIED(x, x, true, true, NAN), /* the positions first: they are wrapped */
    CARRIED(y, y, true, true, NAN),
    CARRIED(z, z, true, true, NAN),
    CARRIED(vx, vx, true, true, NAN),
    CARRIED(vy, vy, true, true, NAN),
    CARRIED(vz, vz, true, true, NAN),
    CARRIED(mass, mass, true, true, NAN),
    CARRIED(density, density, true, true, NAN),
    CARRIED(energy, energy, true, true, NAN),
    CARRIED(h, h, true, true, NAN),
    CARRIED(h_initial, h, true, false, NAN),
    CARRIED(pressure, pressure, false, true, NAN),
    CARRIED(damping, damping, true, true, NAN),
    CARRIED(damage, damage_cbrt, false, true, NAN),
#define PARTICLE_COLUMN(FLAG, member, absent, ...) CARRIED(member, member, false, true, absent),
#include "engine/sph/modules/declarations.h"
};

static double **slot_of(struct sph_columns *columns, size_t column) {
  return (double **)(void *)columns + column;
}

static double *member_of(const struct sph_particles *p, size_t member) {
  double *array;
  memcpy(&array, (const char *)p + member, sizeof array);
  return array;
}

struct sph_column_set sph_system_columns_of_all(bool damped) {
  struct sph_column_set columns = {0};
  set_add(columns.word, SPH_COLUMN(x), SPH_COLUMN(pressure_term) + 1 - SPH_COLUMN(x));
  if (damped)
    set_add(columns.word, SPH_COLUMN(damping), 1);
  return columns;
}

int sph_system_columns_arrays(const struct sph_column_set *columns) {
  int arrays = 0;
  if (set_has(columns->word, SPH_COLUMN(stress)))
    arrays |= SPH_WITH_STRESS;
  if (set_has(columns->word, SPH_COLUMN(damage)))
    arrays |= SPH_WITH_DAMAGE;
#define PARTICLE_ARRAYS(FLAG, column) arrays |= set_has(columns->word, SPH_COLUMN(column)) ? SPH_WITH_##FLAG : 0;
#include "engine/sph/modules/declarations.h"
  return arrays;
}

size_t sph_system_columns_list(const struct sph_system *s, double *column[SPH_COLUMNS]) {
  struct sph_columns columns = s->c;
  size_t count = 0;
  FOR_SET(k, s->columns.word, SPH_COLUMNS)
  column[count++] = *slot_of(&columns, k);
  return count;
}

/* Dozens of columns are read side by side: pages of 4 kB would overflow the address cache (TLB) of a core. */
static double *huge_pages(size_t bytes) {
  const size_t page = (size_t)1 << 21;
  if (bytes < 2 * page)
    return aligned_alloc(64, (bytes + 63) / 64 * 64);
  double *memory = aligned_alloc(page, (bytes + page - 1) / page * page);
#ifdef MADV_HUGEPAGE
  if (memory)
    madvise(memory, (bytes + page - 1) / page * page, MADV_HUGEPAGE); /* a hint: it may fail */
#endif
  return memory;
}

static bool has(const struct sph_system *s, size_t column) {
  return set_has(s->columns.word, column);
}

static void fill_column(struct sph_system *s, size_t column, double value) {
  double *values = *slot_of(&s->c, column);
  for (size_t i = 0; i < s->n; i++)
    values[i] = value;
}

static void set_initial(struct sph_system *s, size_t module) {
  for (const struct sph_column_need *need = sph_modules_at(module)->columns; need && need->count; need++)
    for (size_t k = need->first; need->initial != 0 && k < need->first + need->count; k++)
      if (has(s, k))
        fill_column(s, k, need->initial);
}

status sph_system_columns_take(struct sph_system *s, const struct sph_particles *p, struct error *error) {
  const size_t count = set_size(s->columns.word, SPH_COLUMNS);
  s->stride = (s->n + 7) / 8 * 8 + 8; /* columns must not share sets of the cache */
  s->arena_doubles = count * s->stride;
  s->arena = huge_pages(s->arena_doubles * sizeof(double));
  s->id = malloc(s->n * sizeof *s->id);
  s->order = malloc(s->n * sizeof *s->order);
  if (p->held)
    s->held = malloc(s->n * sizeof *s->held);
  if (!s->arena || !s->id || !s->order || (p->held && !s->held))
    return status_fail(error, STATUS_MEMORY, "no memory for %zu particles of %zu columns (%.3g GB)", s->n, count,
                       (double)(s->arena_doubles * sizeof(double)) / 1e9);
  memset(s->arena, 0, s->arena_doubles * sizeof(double));
  double *next = s->arena;
  FOR_SET(k, s->columns.word, SPH_COLUMNS) {
    *slot_of(&s->c, k) = next;
    next += s->stride;
  }
  for (size_t m = 0; m < SPH_MODULES; m++)
    set_initial(s, m);
  return STATUS_OK;
}

void sph_system_columns_fill(struct sph_system *s, const struct sph_particles *p) {
  for (size_t k = 0; k < sizeof carried / sizeof *carried; k++)
    if (carried[k].filled && has(s, carried[k].column))
      memcpy(*slot_of(&s->c, carried[k].column), member_of(p, carried[k].member), s->n * sizeof(double));
  if (s->held)
    memcpy(s->held, p->held, s->n);
  for (size_t i = 0; i < s->n; i++)
    s->id[i] = (uint32_t)i;
  for (size_t b = 0; b < s->body_count; b++)
    FOR_MODULES(m, s->solid[b].modules)
      if (sph_modules_at(m)->fill)
        sph_modules_at(m)->fill(s, &s->solid[b], p);
}

double sph_system_columns_bytes(const struct sph_column_set *columns, size_t pairs,
                                const struct sph_fidelity *fidelity) {
  enum { RECORDS = 378, LISTS = 108 }; /* of the pair loop at the usual h, without options; measured */
  const double reach = fidelity->smoothing / SPH_BODIES_H * (1 + fidelity->skin);
  return (double)(set_size(columns->word, SPH_COLUMNS) * sizeof(double) + 2 * sizeof(uint32_t) + pairs + RECORDS) +
         LISTS * reach * reach * reach;
}

double sph_system_columns_wrapped(double x, double length) {
  if (!(length > 0))
    return x;
  x -= length * floor(x / length);
  return x < length ? x : 0;
}

/* One column by particles' ids. */
static void read_column(const struct sph_system *s, const double *column, double *out, double absent) {
  if (!column && isnan(absent))
    return;
  for (size_t i = 0; i < s->n; i++)
    out[s->id[i]] = column ? column[i] : absent;
}

/* The sixth component follows: the deviator has no trace. */
static void read_stress(const struct sph_system *s, double *const out[6]) {
  for (size_t i = 0; i < s->n; i++) {
    for (int k = 0; k < 5; k++)
      out[k][s->id[i]] = s->c.stress[k][i];
    out[5][s->id[i]] = -(s->c.stress[0][i] + s->c.stress[3][i]);
  }
}

void sph_system_columns_read(const struct sph_system *s, struct sph_particles *out) {
  struct sph_columns columns = s->c;
  for (size_t k = 0; k < sizeof carried / sizeof *carried; k++) {
    double *to = member_of(out, carried[k].member);
    if (!carried[k].read || !to)
      continue;
    read_column(s, *slot_of(&columns, carried[k].column), to, carried[k].absent);
    for (size_t i = 0; k < 3 && i < s->n; i++)
      to[i] = sph_system_columns_wrapped(to[i], s->domain.periodic[k]);
  }
  if (out->stress[0] && s->c.stress[0])
    read_stress(s, out->stress);
  for (size_t i = 0; out->held && s->held && i < s->n; i++)
    out->held[s->id[i]] = s->held[i];
  for (size_t b = 0; b < s->body_count; b++)
    memset(out->body + s->solid[b].first, (int)b, s->solid[b].last - s->solid[b].first);
}
