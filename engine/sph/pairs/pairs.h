/* The pair loop: all that two particles do to each other, once a step. Particles stand sorted in space (order.h), so
 * that neighbours are near in memory, and each pair i < j is visited once: lists of j per i with a skin, reused over
 * steps.
 *
 * Per pair, with h = (h_i + h_j)/2, the cubic spline W of support 2h, and sigma the damaged stress with the pressure in
 * it: dv_i/dt   = sum_j m_j (sigma_i/rho_i^2 + sigma_j/rho_j^2 - Pi_ij + f^n (R_i + R_j)) . grad_i W      [BA95 eq. 17]
 *   dv_a/dx_b = sum_j (m_j/rho_i) (v_j - v_i)_a grad_i W_b          [BA95 eq. 18]; m_j/rho_j with `volume_weights`
 *   heating   = 1/2 sum_j m_j (v_i - v_j) . (Pi_ij - f^n (R_i + R_j)) . grad_i W   (J/kg/s; eq. 4 lacks it)
 * Pi: Monaghan's viscosity, approaching pairs only (damaged ones included).
 *
 * With the gradient correction dv_a/dx_b is multiplied by B_i, the inverse of M_i = sum_j (m_j/rho_i) (x_j - x_i)
 * grad_i W, so that it is exact for linear fields, and sigma_i/rho_i^2 in the forces becomes sigma_i B_i/rho_i^2, which
 * makes them conjugate to it: then energy and angular momentum are conserved, and a free side is as stiff as the inside
 * [Bonet & Lok 1999, Comput. Methods Appl. Mech. Eng. 180, 97]. M_i is a sum of the same pass, so the forces use B_i of
 * the pass before.
 *
 * With `volume_weights` dv_a/dx_b has m_j/rho_j, and sigma_i/rho_i^2 + sigma_j/rho_j^2 becomes (sigma_i +
 * sigma_j)/(rho_i rho_j), for the same reason. */
#ifndef CLAST_ENGINE_SPH_PAIRS_PAIRS_H
#define CLAST_ENGINE_SPH_PAIRS_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/sph/scene/inputs.h"
#include "schemas/status.h"

/* float: what the pair loop reads and sums. All else stays double; positions are read as integers in units of h/2^20,
 * so that a scene of kilometres is as accurate as a small one. */
enum sph_precision { SPH_DOUBLE, SPH_FLOAT };

/* Sections of the inputs, and what follows from the bodies. */
struct sph_pair_options {
  struct sph_viscosity viscosity;
  struct sph_method method;
  struct sph_fidelity fidelity; /* precision, and threads, on which the bits do not depend */
  bool strength;                /* stress[] is given; else the pressure alone */
  double spacing_over_h;        /* initial particle spacing over h: the f = W(r)/W(spacing) of the artificial stress */
  double periodic[3];           /* m, length of the periodic box along each axis; NaN = open */
};

/* Arrays of n in sorted order; read only. */
struct sph_pair_fields {
  const double *x, *y, *z, *h, *vx, *vy, *vz, *mass, *density, *sound_speed;
  const double *pressure_term; /* -P/rho^2 with the damaged bulk pressure */
  const double *stress[5];     /* S, undamaged deviator, Pa: xx xy xz yy yz, its trace is zero; NULL without strength */
  const double *stress_factor; /* (1-D)/rho^2: sigma/rho^2 = stress_factor S + pressure_term I */
  const double *correction[6]; /* B of the pass before (at first: 1); only with gradient_correction */
};

/* What a pass finds, for some particles that stand one after the other. */
struct sph_pair_sums {
  double *ax, *ay, *az; /* m/s^2 */
  double *gradient[9];  /* 1/s: xx xy xz yx ... with ab = dv_a/dx_b; corrected where that is on */
  double *heating;      /* J/kg/s: viscous, and the work of the artificial stress, which has either sign */
  /* Only with gradient_correction, else NULL. The work of the forces' B, J/kg/s, rho_i (sigma/rho^2 : g) with g the
   * sum times that B: total energy is then conserved however much B changes between two passes. */
  double *power;
  double *correction[6]; /* the new B; NULL without */
  double *signal; /* m/s: largest |mu_ij| = h |v.r|/(r^2 + 0.01 h^2) of approaching pairs, for the time step; -1 without
                     neighbours: what nobody feels need not be resolved */
};

enum { SPH_PIECE = 512 }; /* particles whose sums are handed over at once */

struct sph_pairs; /* opaque: lists and records */

/* STATUS_MEMORY; STATUS_CONTENT for more particles than float lists can name (neighbours.h). `n` particles at most;
 * nothing is allocated later but by sph_pairs_list when lists must grow. */
status sph_pairs_create(size_t n, const struct sph_pair_options *options, struct sph_pairs **out, struct error *error);
void sph_pairs_free(struct sph_pairs *pairs); /* NULL is fine */
size_t sph_pairs_bytes(const struct sph_pairs *pairs);

/* The least that one of the particles low .. high - 1 has left of its slack, m, of which it uses up how far it has
 * moved and how much its h has grown. Below zero a list may miss a pair: then, where a particle is nowhere, and when
 * there are no lists yet. */
double sph_pairs_slack(const struct sph_pairs *pairs, size_t low, size_t high, const double *x, const double *y,
                       const double *z, const double *h);
/* New lists for particles in sorted order: pairs with r < h_i + h_j + slack_i + slack_j. `slack` (m) is how far each
 * may go before the lists are worn; fast particles are given more. Memory is bounded by n, whatever the spatial extent.
 * STATUS_MEMORY; STATUS_CONTENT when a periodic box is thinner than twice the reach of a pair. */
status sph_pairs_list(struct sph_pairs *pairs, size_t n, const double *x, const double *y, const double *z,
                      const double *h, const double *slack, struct error *error);
/* x y z h slack of the last listing, n each; what the lists are made of again after a restart has put them back. */
double *const *sph_pairs_listed(struct sph_pairs *pairs);
status sph_pairs_relist(struct sph_pairs *pairs, struct error *error);
/* Takes the sums of `count` particles from `first` on (a multiple of SPH_PIECE), at most SPH_PIECE of them, which may
 * be changed and are gone afterwards. */
typedef void sph_pairs_take(void *context, size_t first, size_t count, const struct sph_pair_sums *sums);
/* A pass over all pairs. Sums are handed over piece by piece, as soon as they are complete, while they lie in the
 * cache: a piece's fields are not read any more then and may be changed. With threads `take` is called by all of them
 * at once. */
void sph_pairs_sum(struct sph_pairs *pairs, size_t n, const struct sph_pair_fields *fields, sph_pairs_take *take,
                   void *context);
/* Mean number of neighbours in the lists (both sides counted): what a pass takes time for. */
double sph_pairs_reached(const struct sph_pairs *pairs);
/* Mean number of neighbours within 2h at the last pass (both sides counted, itself not). */
double sph_pairs_neighbours(const struct sph_pairs *pairs);

#endif
