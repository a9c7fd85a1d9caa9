/* How a system lies in memory; for engine/dem/ and its tests only.
 *
 * Grains are columns (structure of arrays), padded to blocks of eight and followed by two ghosts that unused lanes
 * point at. A pair of the tessellation owns one lane of a bond block: its beam, and its contact as a *window*, the
 * common side of either grain with the side before and after it (bond.h says why this is exact). All other pairs
 * that are near each other lie in near blocks: a cached separating side each. What neither decides goes, pair by
 * pair, through the general overlap of two convex polygons (overlap.h). */
#ifndef CLAST_ENGINE_DEM_STEP_SYSTEM_LAYOUT_H
#define CLAST_ENGINE_DEM_STEP_SYSTEM_LAYOUT_H

#include "engine/dem/step/system.h"

enum { DEM_BLOCK = 8, DEM_MAX_VERTICES = 64, DEM_NO_PAIR = -1 };
#define DEM_ALIGNED __attribute__((aligned(64)))

/* Per-block fields are eight doubles, one a lane. */
typedef double dem_lane[DEM_BLOCK] DEM_ALIGNED;

/* Eight tessellation pairs. `stiffness` is kappa (conservative) or Y/L_c (printed); 0 = no contact in this lane. */
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
  double stiffness;                          /* kappa (conservative law) or Y/L_c (printed law); 0 = no contact */
  double normal_damping, tangential_damping; /* m_eff gamma, kg/s; 0 = none */
};

struct dem_near_pair {
  uint32_t first, second; /* first < second */
  int32_t pair;           /* tessellation pair, or DEM_NO_PAIR */
  uint32_t unused;
  struct dem_contact contact; /* of a pair that is no tessellation pair */
};

/* A pair for the general overlap: near list position, or bond lane with the high bit set. */
#define DEM_FROM_BOND 0x80000000u

/* What the forces add up along the way. */
struct dem_sums {
  dem_lane contact, damping, friction; /* power, W/m; with `measure`: contact holds energy */
  dem_lane beam;                       /* with `measure`: energy */
  uint64_t overlaps;                   /* with `measure`: pairs with positive overlap area */
};

/* All that changes from step to step and is no array. */
struct dem_progress {
  double time, last_break;
  uint64_t steps, rebuilds;
  double contact, damping, friction, broken_beam, external_work; /* booked so far, J/m (contact: printed law) */
  uint64_t break_count, bond_blocks, near_count, live_pairs;
  uint64_t ready; /* forces belong to the positions */
  uint64_t gear_started;
};

struct dem_kernels; /* kernels.h */

struct dem_columns { /* padded to blocks of eight */
  double *x, *y, *angle, *cosine, *sine;
  double *vx, *vy, *spin;
  double *fx, *fy, *torque;
  double *mobility_x, *mobility_y, *mobility_angle; /* 1/mass, 1/moment; 0 = held or gone */
  double *guess_vx, *guess_vy, *guess_spin;         /* velocities the dissipative forces see */
  double *list_x, *list_y, *list_angle, *skin;      /* where the neighbour list was made, and how far it holds */
  double *gear[3][6];                               /* x, y, angle: dt^k/k! d^k/dt^k, k = 2..5 (0, 1 unused) */
};

struct dem_system {
  const struct dem_inputs *in; /* borrowed */
  struct dem_progress now;
  size_t count, padded; /* grains; with ghosts, a multiple of eight */
  uint32_t ghost;       /* the first of two ghosts */
  bool velocities;      /* contact forces need velocities (damping, friction, printed law's ledger) */
  struct dem_columns c;
  double *arena; /* holds every column */
  size_t arena_doubles;

  /* grains, fixed */
  double *mass, *inertia, *diameter;
  double *radius;                                   /* of the farthest vertex; padded */
  uint32_t *first_vertex;                           /* count + 1, into the outlines; each grain's closes on itself */
  double *outline_x, *outline_y;                    /* body frame */
  uint32_t *first_partner, *partner, *partner_pair; /* tessellation neighbours of each grain */
  double mean_diameter;

  /* grains, changing by hand */
  unsigned char *freedoms, *present;
  double *held_vx, *held_vy, *held_spin;
  uint32_t *held;
  size_t held_count;

  /* tessellation pairs */
  size_t pair_count;
  uint32_t (*pair)[2];
  struct dem_contact *pair_contact; /* fixed at the start, with the pair's own S_ref */
  unsigned char *alive;             /* beam */
  unsigned char *windowed;          /* contact handled by the bond block's window */
  int32_t *pair_lane;               /* lane in the bond blocks, or DEM_NO_PAIR */
  int32_t *lane_pair;               /* and back */
  struct dem_bond_block *bond;
  size_t bond_capacity; /* blocks */

  /* near pairs */
  struct dem_near_block *near;
  struct dem_near_pair *near_pair;
  size_t near_capacity; /* pairs */
  uint32_t *general;    /* pairs for the general overlap, this step */
  size_t general_capacity, general_count;

  /* cells of the neighbour search, only used while a list is made */
  uint32_t *cell_head, *cell_grain, *cell_next;
  int32_t (*cell_key)[2], (*cell_low)[2]; /* cell of an entry; lowest cell of a grain */
  size_t cell_capacity, cell_buckets;

  struct dem_break *log;
  struct dem_sums sums;
  const struct dem_kernels *kernels;
};

/* Forces at the positions now, with the lists as they are. `dt` books the dissipated powers for a step's length. */
void dem_system_evaluate(struct dem_system *system, double dt);

#endif
