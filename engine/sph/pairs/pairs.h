/* The pair loop: all forces and rates between two particles, once a step. Particles are sorted in space (hilbert.h), so
 * that neighbours are near in memory. Each pair i < j is visited once: particle i has a list of neighbours j with a
 * skin, and the lists are used for many steps.
 *
 * Per pair, with h = (h_i + h_j)/2, the cubic spline W of support 2h, and the damaged stress sigma, pressure included:
 *   dv_i/dt   = sum_j m_j (sigma_i/rho_i^2 + sigma_j/rho_j^2 - Pi_ij + f^n (R_i + R_j)) . grad_i W      [BA95 eq. 17]
 *   dv_a/dx_b = sum_j (m_j/rho_i) (v_j - v_i)_a grad_i W_b          [BA95 eq. 18]; m_j/rho_j with `volume_weights`
 *   heating   = 1/2 sum_j m_j (v_i - v_j) . (Pi_ij - f^n (R_i + R_j)) . grad_i W   (J/kg/s; eq. 4 lacks it)
 * Pi is Monaghan's viscosity, for approaching pairs only (damaged ones included).
 *
 * With the gradient correction dv_a/dx_b is multiplied by B_i, the inverse of M_i = sum_j (m_j/rho_i) (x_j - x_i)
 * grad_i W, so that it is exact for linear fields. In the forces sigma_i/rho_i^2 becomes sigma_i B_i/rho_i^2, which
 * makes them conjugate to the corrected gradient: energy and angular momentum are conserved, and a free side is as
 * stiff as the inside [Bonet & Lok 1999, Comput. Methods Appl. Mech. Eng. 180, 97]. M_i is a sum of the same pass, so
 * the forces use the B_i of the pass before.
 *
 * With `volume_weights` dv_a/dx_b has m_j/rho_j, and for the same reason sigma_i/rho_i^2 + sigma_j/rho_j^2 becomes
 * (sigma_i + sigma_j)/(rho_i rho_j). */
#ifndef CLAST_ENGINE_SPH_PAIRS_PAIRS_H
#define CLAST_ENGINE_SPH_PAIRS_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/scene/inputs.h"
#include "schemas/status.h"

/* In float precision the pair loop reads and sums floats; all else stays double. Positions are read as integers in
 * units of h/2^20, so that a scene of kilometres is as accurate as a small one. */
enum sph_precision { SPH_DOUBLE, SPH_FLOAT, SPH_PRECISIONS };

/* Sections of the inputs, and what follows from the bodies. */
struct sph_pair_options {
  struct sph_viscosity_inputs viscosity;
  struct sph_method method;
  struct sph_artificial_stress_inputs artificial_stress;
  struct sph_gradient_correction_inputs gradient_correction;
  struct sph_fidelity fidelity; /* precision, and threads, on which the bits do not depend */
  bool strength;                /* stress[] is given; else the pressure alone */
  double spacing_over_h;        /* initial particle spacing over h: the f = W(r)/W(spacing) of the artificial stress */
  double periodic[3];           /* m, length of the periodic box along each axis; NaN = open */
};

/* Columns of n particles in sorted order; read only. */
struct sph_pair_fields {
  const double *x, *y, *z, *h, *vx, *vy, *vz, *mass, *density, *sound_speed;
  const double *pressure_term; /* -P/rho^2 with the damaged bulk pressure */
  const double *stress[5];     /* S, undamaged deviator, Pa: xx xy xz yy yz, its trace is zero; NULL without strength */
  const double *stress_factor; /* (1-D)/rho^2: sigma/rho^2 = stress_factor S + pressure_term I */
  /* Columns that terms read, also the sums of the pass before; only where the term is on. */
#define PAIR_FIELDS(member, count) const double *member[count];
#include "engine/sph/modules/declarations.h"
};

/* The sums of a pass, for some consecutive particles. */
struct sph_pair_sums {
  double *ax, *ay, *az; /* m/s^2 */
  double *gradient[9];  /* 1/s: xx xy xz yx ... with ab = dv_a/dx_b; corrected where that is on */
  double *heating;      /* J/kg/s: viscous, and the work of the artificial stress, which has either sign */
  /* Only with gradient_correction, else NULL. The work of the forces, J/kg/s: rho_i (sigma/rho^2 : g), where g is the
   * sum times the forces' B. With it total energy is conserved however much B changes between two passes. */
  double *power;
  /* Sums of terms, each for the column of its name; NULL where the term is off. */
#define PAIR_SUMS(term, member, count, scale) double *member[count];
#include "engine/sph/modules/declarations.h"
  /* m/s: largest |mu_ij| = h |v.r|/(r^2 + 0.01 h^2) of approaching pairs, for the time step. -1 without neighbours:
   * such a particle does not limit the step. */
  double *signal;
};

enum { SPH_PIECE = 512 }; /* number of particles whose sums are delivered together */

struct sph_pairs; /* opaque: lists and records */

/* For at most n particles. Later only sph_pairs_list allocates memory, when lists must grow. STATUS_MEMORY;
 * STATUS_CONTENT for more particles than the lists of float records can name (neighbours.h), and when the pair loop is
 * not compiled for terms that are on together (SPH_PAIR_COMBINATIONS in modules/list.h). */
status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error);
void sph_pairs_free(struct sph_pairs *pairs); /* NULL is fine */
size_t sph_pairs_bytes(const struct sph_pairs *pairs);

/* The smallest remaining slack (m) of the particles low .. high - 1. Slack shrinks as a particle moves and as its h
 * grows. Negative: the lists may miss pairs; it is also negative when a position is not finite or there are no lists
 * yet. */
double sph_pairs_slack(const struct sph_pairs *pairs, size_t low, size_t high, const double *x, const double *y,
                       const double *z, const double *h);
/* Makes new lists for particles in sorted order: all pairs with r < h_i + h_j + slack_i + slack_j. `slack` (m) is how
 * far a particle may move before the lists become stale; fast particles have more. Memory is bounded by n, whatever the
 * extent. STATUS_MEMORY; STATUS_CONTENT when a periodic box is thinner than twice the reach of a pair. */
status sph_pairs_list(struct sph_pairs *pairs, size_t n, const double *x, const double *y, const double *z,
                      const double *h, const double *slack, struct error *error);
/* x y z h slack, n each, with which the last lists were made. A restart puts them back; sph_pairs_relist then makes the
 * same lists again. */
double *const *sph_pairs_listed(struct sph_pairs *pairs);
status sph_pairs_relist(struct sph_pairs *pairs, struct error *error);
/* Receives the sums of `count` particles, at most SPH_PIECE, from `first` on, a multiple of SPH_PIECE. They may be
 * changed and are gone afterwards. */
typedef void sph_pairs_take(void *context, size_t first, size_t count, const struct sph_pair_sums *sums);
/* A pass over all pairs. Sums are delivered to `take` piece by piece, as soon as they are complete, while they are in
 * the cache. The pass no longer reads the fields of those particles, so they may be changed. Several threads call
 * `take` at the same time. */
void sph_pairs_sum(struct sph_pairs *pairs, size_t n, const struct sph_pair_fields *fields, sph_pairs_take *take,
                   void *context);
/* Do terms read the sums of the pass before? Then the first pass of a run must be made twice. */
bool sph_pairs_look_back(const struct sph_pairs *pairs);
/* Mean number of neighbours in the lists (each pair counts for both): the time of a pass is proportional to it. */
double sph_pairs_reached(const struct sph_pairs *pairs);
/* Mean number of neighbours within 2h in the last pass (each pair counts for both). */
double sph_pairs_neighbours(const struct sph_pairs *pairs);

#endif
