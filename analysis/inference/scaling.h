/* Finite-size scaling: the critical value of an input and the exponents of a transition, from runs of several sizes.
 *
 * L is the size as a length in elements, N = L^d the number of elements, x the control. Of a run: P is its order
 * parameter, the mass share m_1 of the largest fragment unless another is given; S and T are the sums of squares and of
 * cubes of the masses of all other fragments, in elements, over N. Near a critical value x_c, with z = (x - x_c)
 * L^(1/nu) (Stauffer & Aharony 1994, chapter 4):
 *
 *     P = L^(-beta/nu) f(z)     S = L^(gamma/nu) g(z)     T/S = L^D h(z)     Q = q(z)
 *
 * Q is the mean over runs of m_1^2 over the sum of squares of all masses: 1 for one whole body, 0 for dust. It has no
 * dimension, so the curves of all sizes cross at x_c. r = 1/Q - 1, and ln r is fitted by one polynomial in z for all
 * sizes, which gives x_c and nu; ln P, ln S and ln T/S by polynomials in this z and a slope against ln L. T/S is the
 * cut-off M_0 of the mass spectrum m^-tau but for a constant factor, so that tau = 3 - (gamma/nu)/D: it is measured
 * from the second and the third moment of the masses. No relation between the exponents and d is used.
 * From four sizes on, S has a regular part b beside the critical one (the many small fragments that know nothing of the
 * transition): ln S and ln T/S get a term b/S.
 *
 * Corrections to scaling: a value shifts when the smallest size is dropped. If its corrections fall as 1/L, a known
 * multiple of the shift is still missing (of a slope 1.8 times, for four sizes or more that double, with as many runs
 * each); if they fall faster, less is. So the limit lies between the value without the smallest size and that of
 * corrections as 1/L. The estimate is midway, and half of the distance is part of the half width. There are two such
 * distances: of a value at given x_c and nu, and of x_c and nu, which move the value, too. A shift scatters itself: of
 * a half distance h the estimate goes the share h^2/(h^2 + its variance) only; the half width has the whole of both.
 *
 * The half width is the root of the sum of squares of that and of the scatter over whole runs: weights from an
 * exponential law for each seed of a size (Rubin 1981, doi 10.1214/aos/1176345338), Student's t for few seeds.
 * Corrections that fall more slowly than 1/L may be larger. Measured: tests/verification/scaling.md. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { SCALING_SIZES = 16, SCALING_LEAST_SIZES = 3, SCALING_LEAST_RUNS = 2 };

struct scaling_run {
  double size, control; /* L, x */
  uint64_t seed;        /* runs of one size and seed are resampled together */
  double order;         /* of the order parameter; NaN: none */
  double largest;       /* mass share of the largest fragment */
  double second, third; /* S, T; 0: one fragment */
};

enum scaling_kind {
  SCALING_FOUND,
  SCALING_JUMP,        /* beta/nu is 0 and 1/nu is d within their intervals, and 1/nu is above d/2 */
  SCALING_TOO_FEW,     /* fewer than three sizes, or than two values of the control beside the crossing */
  SCALING_NO_CROSSING, /* the curves of the sizes do not cross, or the runs do not tell */
  SCALING_NOT_ONE,     /* they cross, but their curves are not one: the values are NaN */
  SCALING_NOT_TOLD,    /* they cross, but no curve fits there the runs, or not most of the resampled runs */
};
extern const char
    *const scaling_kind_names[]; /* "found", "jump", "too-few", "no-crossing", "not-one-curve", "not-told" */

enum scaling_value {
  SCALING_CRITICAL,
  SCALING_NU,
  SCALING_BETA,
  SCALING_GAMMA,
  SCALING_CUTOFF,
  SCALING_TAU,
  SCALING_VALUES
};

struct scaling {
  enum scaling_kind kind;
  size_t sizes, runs; /* used */
  /* Of Q of the least and the largest size: where they cross, and two values of the control on each side. If they do
   * not: the value where they are nearest, Q there, and the range that both sizes have. NaN: none. */
  double crossing, about[2], nearest, nearest_q[2], range[2];
  bool differ, touch; /* by two standard errors somewhere; not by them at the nearest value */
  bool may_jump;      /* values of a jump are inside the intervals */
  /* x_c, nu, beta/nu, gamma/nu, D, tau. `shift`: without the smallest size less with it */
  struct scaling_estimate {
    double estimate, half_width, shift;
  } value[SCALING_VALUES];
  /* Of the collapse of P and of S (without its regular part), without the smallest size: reduced chi-square against the
   * curve of the other sizes (Houdayer & Hartmann 2004, doi 10.1103/PhysRevB.70.014418), and rms distance from it as a
   * share of its value. */
  double chi_square[2], distance[2];
  struct scaling_cell {                           /* the runs of one size and control */
    double size, control, mean[3], half_width[3]; /* of P, S and Q; 95 % interval; NaN: one run */
    bool used;                                    /* by the fits */
  } * cell;                                       /* owned: scaling_release() */
  size_t cells;
};

/* d: 2 or 3. STATUS_USAGE: more than SCALING_SIZES sizes. STATUS_MEMORY. */
status scaling_find(size_t n, const struct scaling_run *runs, int dimensions, struct scaling *out, struct error *error);

void scaling_release(struct scaling *scaling);
#define SCALING __attribute__((cleanup(scaling_release))) struct scaling
