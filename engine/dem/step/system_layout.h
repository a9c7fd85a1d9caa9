/* The memory layout of a system; for engine/dem/ and its tests only.
 *
 * Grains are columns (structure of arrays). After them come two ghost grains, for unused lanes, and padding to blocks
 * of eight. A pair of the tessellation owns one lane of a bond block: its beam, and its contact as a *window*, the
 * common side of either grain with the side before and after it (bond_range.h says when this is exact). All other near
 * pairs are in near blocks, each with a cached separating side. Pairs that neither decides go one by one to the general
 * overlap of two convex polygons (contact_range.h). */
#pragma once

#include "engine/cpu_class.h"
#include "engine/dem/lattice/tessellation.h"
#include "engine/dem/scene/inputs.h"
#include "engine/dem/step/progress.h"
#include "engine/restart.h"

enum { DEM_BLOCK = 8, DEM_MAX_VERTICES = 64, DEM_NO_PAIR = -1 };
#define DEM_ALIGNED __attribute__((aligned(64)))

/* Per-block fields are eight doubles, one a lane. */
typedef double dem_lane[DEM_BLOCK] DEM_ALIGNED;

/* Eight tessellation pairs. `stiffness` is the law's coefficient (contacts/laws.h); 0 = no contact in this lane. */
struct dem_bond_block {
  uint32_t first[DEM_BLOCK] DEM_ALIGNED;
  uint32_t second[DEM_BLOCK];
  /* beam: direction the chord is measured from, and the chord's angle at that direction (unwrapped) */
  dem_lane reference_x, reference_y, reference_angle, length;
  dem_lane axial;                       /* alpha, N/m per m */
  dem_lane cross, diagonal;             /* beta l0^2 / 2 and delta l0^2, N m/rad */
  dem_lane weight_strain, weight_angle; /* 1/(t_eps l0)^2 and 1/t_Theta; 0 = does not break */
  /* contact */
  dem_lane stiffness, normal_damping, tangential_damping; /* damping: m_eff gamma, kg/s; 0 = none */
  dem_lane middle_x[2], middle_y[2]; /* middle of the common side from the grain's centre, body frame */
  dem_lane half_x[2], half_y[2];     /* half of the common side */
  dem_lane before_x[2], before_y[2]; /* the vertex before it, from its middle */
  dem_lane after_x[2], after_y[2];   /* the vertex after it, from its middle */
};

/* Eight near pairs: while the three vertices of `other` are outside the side of `owner` and the middle one is the
 * nearest of them, the grains are apart (a convex outline's distance to a line has one minimum). */
struct dem_near_block {
  uint32_t owner[DEM_BLOCK] DEM_ALIGNED;
  uint32_t other[DEM_BLOCK];
  dem_lane side_x, side_y, offset;   /* owner's body frame: a point p is outside when p x side > offset */
  dem_lane vertex_x[3], vertex_y[3]; /* other's body frame */
};

/* Coefficients of one contact. */
struct dem_contact {
  double stiffness;                          /* the law's coefficient (contacts/laws.h); 0 = no contact */
  double normal_damping, tangential_damping; /* m_eff gamma, kg/s; 0 = none */
};

struct dem_near_pair {
  uint32_t first, second; /* first < second */
  int32_t pair;           /* tessellation pair, or DEM_NO_PAIR */
  uint32_t unused;
  struct dem_contact contact; /* of a pair that is no tessellation pair */
};

/* A convex outline: vertices counter-clockwise, about any origin. The entries from `count` to its next multiple of
 * eight, and one more, repeat the first vertex. */
struct dem_ring {
  size_t count;
  double x[DEM_MAX_VERTICES + DEM_BLOCK] DEM_ALIGNED, y[DEM_MAX_VERTICES + DEM_BLOCK] DEM_ALIGNED;
};

/* The last entry in use. */
static inline size_t dem_overlap_last(const struct dem_ring *ring) {
  return (ring->count + DEM_BLOCK - 1) / DEM_BLOCK * DEM_BLOCK;
}

struct dem_overlap {
  bool apart;                /* a side separates the two; then only that side and `gap` are set */
  double gap;                /* m, along the best separating side; negative: penetration */
  int owner;                 /* whose side it is: 0 or 1 */
  size_t side, vertex;       /* that side, and the vertex of the other that is nearest to it */
  double origin_x, origin_y; /* of the sums */
  double twice_area, chord_x, chord_y, moment, xx, xy, yy; /* see contact_range.h */
};

/* A pair for the general overlap: near list position, or bond lane with the high bit set. */
#define DEM_FROM_BOND 0x80000000u

/* Sums that the force loops add up. */
struct dem_sums {
  dem_lane contact, damping, friction; /* power, W/m; with `measure`: contact holds energy */
  dem_lane beam;                       /* with `measure`: energy */
  uint64_t overlaps;                   /* with `measure`: pairs with positive overlap area */
};

struct dem_kernels;

/* Columns: one double per grain, padded to blocks of eight; they lie in one arena. */
/* clang-format off */
#define DEM_COLUMNS(COLUMN) \
  COLUMN(x) COLUMN(y) COLUMN(angle) COLUMN(cosine) COLUMN(sine) \
  COLUMN(vx) COLUMN(vy) COLUMN(spin) \
  COLUMN(fx) COLUMN(fy) COLUMN(torque) \
  COLUMN(mobility_x) COLUMN(mobility_y) COLUMN(mobility_angle) /* 1/mass, 1/moment; 0 = held or removed */ \
  COLUMN(guess_vx) COLUMN(guess_vy) COLUMN(guess_spin)         /* velocities for the dissipative forces */ \
  COLUMN(list_x) COLUMN(list_y) COLUMN(list_angle)             /* state when the neighbour list was made */ \
  COLUMN(skin)                                                 /* distance over which the list holds */ \
  COLUMN(radius)                                               /* distance of the farthest vertex */
/* clang-format on */

/* Arrays of a system: the element's type, the name, how many elements are allocated, and how many of them the next step
 * depends on (a restart file saves those). This is the only list: it declares, allocates, frees, counts and saves. */
#define DEM_ARRAYS(ARRAY)                                                                                              \
  ARRAY(double, arena, s->arena_doubles, s->arena_doubles) /* all columns */                                           \
  /* grains, fixed */                                                                                                  \
  ARRAY(double, mass, s->count, 0)                                                                                     \
  ARRAY(double, inertia, s->count, 0)                                                                                  \
  ARRAY(double, diameter, s->count, 0)                                                                                 \
  ARRAY(uint32_t, first_vertex, s->count + 1, 0) /* into the outlines; each grain's closes on itself */                \
  ARRAY(double, outline_x, s->vertex_count, 0)   /* body frame */                                                      \
  ARRAY(double, outline_y, s->vertex_count, 0)                                                                         \
  ARRAY(uint32_t, first_partner, s->count + 2, 0) /* tessellation neighbours of each grain */                          \
  ARRAY(uint32_t, partner, 2 * s->pair_count, 0)                                                                       \
  ARRAY(uint32_t, partner_pair, 2 * s->pair_count, 0)                                                                  \
  /* grains, changed by the protocol: what is held, and at which velocity */                                           \
  ARRAY(unsigned char, freedoms, s->count, s->count)                                                                   \
  ARRAY(unsigned char, present, s->count, s->count)                                                                    \
  ARRAY(double, held_vx, s->count, s->count)                                                                           \
  ARRAY(double, held_vy, s->count, s->count)                                                                           \
  ARRAY(double, held_spin, s->count, s->count)                                                                         \
  ARRAY(uint32_t, held, s->count, s->count)                                                                            \
  /* tessellation pairs */                                                                                             \
  ARRAY(dem_pair, pair, s->pair_count, 0)                                                                              \
  ARRAY(struct dem_contact, pair_contact, s->pair_count, 0) /* fixed at the start, with the pair's own S_ref */        \
  ARRAY(unsigned char, windowed, s->pair_count, 0)          /* the bond block's window handles the contact */          \
  ARRAY(unsigned char, alive, s->pair_count, s->pair_count) /* the beam holds */                                       \
  ARRAY(int32_t, pair_lane, s->pair_count, s->pair_count)   /* lane in the bond blocks, or DEM_NO_PAIR */              \
  ARRAY(int32_t, lane_pair, DEM_BLOCK * s->bond_capacity, DEM_BLOCK * s->bond_capacity) /* the inverse */              \
  ARRAY(struct dem_bond_block, bond, s->bond_capacity, s->now.bond_blocks)                                             \
  ARRAY(struct dem_break, log, s->pair_count, s->now.break_count)                                                      \
  /* near pairs */                                                                                                     \
  ARRAY(struct dem_near_block, near, s->near_capacity / DEM_BLOCK, (s->now.near_count + DEM_BLOCK - 1) / DEM_BLOCK)    \
  ARRAY(struct dem_near_pair, near_pair, s->near_capacity, s->now.near_count)                                          \
  ARRAY(uint32_t, general, DEM_BLOCK * s->bond_capacity + s->near_capacity, 0) /* pairs for the general overlap */     \
  /* cell grid of the neighbour search, used only while a list is made */                                              \
  ARRAY(uint32_t, cell_head, s->cell_buckets, 0)                                                                       \
  ARRAY(uint32_t, cell_grain, s->cell_capacity, 0)                                                                     \
  ARRAY(uint32_t, cell_next, s->cell_capacity, 0)                                                                      \
  ARRAY(dem_cell, cell_key, s->cell_capacity, 0) /* cell of an entry */                                                \
  ARRAY(dem_cell, cell_low, s->count, 0)         /* lowest cell of a grain */

typedef uint32_t dem_pair[2];
typedef int32_t dem_cell[2];

struct dem_columns {
#define DEM_COLUMN(name) double *name;
  DEM_COLUMNS(DEM_COLUMN)
#undef DEM_COLUMN
  double *gear[3][6]; /* x, y, angle: dt^k/k! d^k/dt^k, k = 2..5 (0, 1 unused); NULL with velocity Verlet */
};

struct dem_system {
  const struct dem_inputs *in; /* borrowed */
  struct dem_progress now;
  size_t count, padded;               /* grains; with ghosts, a multiple of eight */
  size_t vertex_count, pair_count;    /* of all outlines; of the tessellation */
  size_t bond_capacity;               /* blocks */
  size_t near_capacity;               /* pairs, a multiple of eight */
  size_t cell_capacity, cell_buckets; /* entries; a power of two */
  size_t arena_doubles;
  size_t held_count, general_count; /* entries of held, of general */
  uint32_t ghost;                   /* the first of two ghosts */
  bool no_memory;                   /* the reason why a step failed */
  bool velocities;                  /* contact forces need velocities (damping, friction, some laws) */
  double mean_diameter;             /* m */
  struct dem_columns c;
#define DEM_ARRAY(type, name, allocated, saved) type *name;
  DEM_ARRAYS(DEM_ARRAY)
#undef DEM_ARRAY
  struct dem_sums sums;
  const struct dem_kernels *kernels;
};

/* Allocates every array for the grains and pairs counted so far, zeroed. False: no memory; what was allocated is in
 * the system. */
bool dem_system_arrays_allocate(struct dem_system *system);
size_t dem_system_arrays_bytes(const struct dem_system *system); /* of the arrays and the system itself */
/* Gives the near list a capacity of at least `pairs` and keeps its entries. False: no memory, and nothing changes. */
bool dem_system_arrays_grow_near(struct dem_system *system, size_t pairs);
/* Writes the outline of a grain, in its present orientation and shifted by (dx, dy) from its own centre. */
void dem_system_arrays_ring(const struct dem_system *system, uint32_t grain, double dx, double dy,
                            struct dem_ring *ring);

/* Fills the Gear derivatives r_2 .. r_5 from the accelerations along four trial steps of the classical Runge-Kutta
 * method; the trial steps are undone. False: no memory, or the trial steps are not finite. */
bool dem_system_start_gear(struct dem_system *system);

/* ---- lattice/assemble.c: from a tessellation to the arrays of a system ---- */

/* `system` must be zero except for in, velocities, kernels. STATUS_CONTENT: outlines that cannot be used;
 * STATUS_MEMORY. In both cases *system owns the allocated memory. */
status dem_assemble(struct dem_system *system, const struct dem_tessellation *tessellation, uint64_t seed,
                    struct error *error);

/* S_ref of a pair (conservative law: kappa = Y / (L_c S_ref)), m; it never changes during a run.
 * Pairs that were never bonded (side = 0): 0.27 (d_i + d_j). Bonded pairs: the common side, but at least half of that
 * value. The floor is needed because the lattice makes arbitrarily short sides, and kappa acts on any later overlap of
 * the two grains: without it, about 1 run in 100 had a pair too stiff for its time step after its beam had broken, and
 * its energy diverged. A pair with a side below the floor is softer than Y by side/S_ref when aligned; such pairs carry
 * little load. */
double dem_assemble_reference_side(double side, double diameter_i, double diameter_j);

/* Coefficients of the contact of two grains; `side` is their common side, 0 for grains that never had one. */
struct dem_contact dem_assemble_contact(const struct dem_system *system, uint32_t i, uint32_t j, double side);

/* ---- beams/breaking.c: rare changes of single lanes, outside the vector loops ---- */

/* Breaks a beam: logs it, books its energy, sets its elastic constants to zero (K99 section 2.3), and switches on the
 * pair's contact and damping if they were off while the beam held. (ux, uy) is the chord's direction. */
void dem_breaking_lane(struct dem_system *system, struct dem_bond_block *block, int lane, double length, double ux,
                       double uy, double theta_first, double theta_second);

/* Removes a beam without a log entry (removed grains). */
void dem_breaking_cut(struct dem_system *system, int32_t pair);

/* Points an unused lane at the ghosts, with every constant zero. */
void dem_breaking_clear(const struct dem_system *system, struct dem_bond_block *block, int lane);

/* Makes the chord's present direction its reference (sine and cosine: of the turn since the old one), so that
 * the angle from the reference stays small and the total angle unwrapped. */
void dem_breaking_turn(struct dem_bond_block *block, int lane, double ux, double uy, double sine, double cosine);

/* Present coefficients of a tessellation pair's contact: zero while the beam holds, if the inputs switch off contacts
 * of bonded pairs. */
struct dem_contact dem_breaking_contact(const struct dem_system *system, int32_t pair);
/* Writes these coefficients to the pair's lane. */
void dem_breaking_set_contact(const struct dem_system *system, int32_t pair, struct dem_bond_block *block, size_t lane);

/* ---- contacts/neighbours.c: pairs that can come into contact soon ---- */

/* Makes the near list and repacks the bond blocks, from the present positions. Every pair whose gap is less than the
 * sum of its two skins is in one of them afterwards. A skin grows with its grain's speed, so that a few fast grains do
 * not force a new list all the time. False: no memory; the list is then incomplete. */
bool dem_neighbours_make(struct dem_system *system);

/* Stores the side that keeps a near pair apart. */
void dem_neighbours_cache_side(struct dem_system *system, uint32_t near, const struct dem_overlap *overlap);

/* ---- kernels ---- */

/* The loops over whole ranges. They are compiled once per CPU class and chosen at run time; engine/cpu_class.h says
 * when results are bit-identical. */
struct dem_kernels {
  const char *name;                           /* of the CPU class */
  void (*rest)(struct dem_system *system);    /* takes the positions now as the rest state of the beams */
  void (*forces)(struct dem_system *system);  /* of beams and contacts, into fx, fy, torque */
  void (*measure)(struct dem_system *system); /* fills sums.beam, sums.contact, sums.overlaps */
  bool (*verlet_drift)(struct dem_system *system, bool *moved); /* false: not finite; moved: the lists end */
  void (*verlet_kick)(struct dem_system *system);
  bool (*gear_predict)(struct dem_system *system, bool *moved);
  void (*gear_correct)(struct dem_system *system);
  void (*turn)(struct dem_system *system); /* cosine and sine from the angles */
  void (*best_side)(const struct dem_ring ring[2], struct dem_overlap *out);
  void (*overlap)(struct dem_ring ring[2], struct dem_overlap *out); /* moves the rings' origin */
};

extern const struct dem_kernels dem_kernels_baseline;
#ifdef __x86_64__
extern const struct dem_kernels dem_kernels_v3, dem_kernels_v4;
#endif

/* The kernels of the CPU class that this run uses. */
static inline const struct dem_kernels *dem_kernels_choose(void) {
  return CPU_CLASS_OF(dem_kernels);
}
