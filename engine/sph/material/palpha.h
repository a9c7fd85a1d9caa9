/* P-alpha porosity: pores far below the resolution, as one number per particle. Herrmann 1969; Jutzi & Benz [JB];
 * Jutzi, Benz & Michel 2008 [JBM08].
 *
 * alpha = rho_s/rho >= 1 is the distention, rho_s the density of the solid between the pores, rho the bulk density:
 *     P = P_s(alpha rho, u) / alpha
 * and alpha follows the pressure on one of two branches:
 *   crush    alpha = alpha_crush(P), P_e < P < P_s; 1 from P_s on: pores close for good
 *   elastic  dalpha/dP = (alpha^2/K0)(1 - 1/h^2), h = 1 + (alpha-1)(c_e-c_s)/(c_s(alpha_e-1)), K0 = rho_s0 c_s^2:
 *            below P_e, and when matter that was crushed is unloaded and loaded again. On unloading pores open again
 * along it.
 *
 * The memory of a particle is its *rest distention*: alpha on its elastic branch at P = 0. It never rises,
 * whatever the path; everything else is a function of (rest, rho, u). (The papers integrate alpha-dot, which must know
 * whether a particle is being loaded; a code that takes the crush slope on reloading crushes the same pores twice. Here
 * the crush curve is a bound, alpha <= alpha_crush(P), and (alpha, P) is solved for, so that a jump past P_s in one
 * step closes all pores.) In tension alpha rises on the elastic branch, never above alpha_0.
 *
 * A body without pores has none of this: no array, no call (off means absent). */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "engine/sph/material/material.h"

/* A law: the values given, the solid, and constants that follow from both. */
struct sph_palpha_law {
  struct sph_palpha_material given; /* material.h */
  struct sph_tillotson_material solid;
  double solid_density;      /* kg/m^3, rho_s0 */
  double elastic_distention; /* alpha_e: where the crush curve begins, at P_e */
  double stiffness_slope;    /* q = (1 - c_e/c_s)/(alpha_e - 1), so that h = 1 - q(alpha - 1); 0: no elastic change */
};

/* alpha_e of the quadratic curve is where the elastic branch from alpha_0 at P = 0 meets P_e: implicit, since h
 * contains it. STATUS_CONTENT: a value that gives no law; the message has its name and a remedy. */
status sph_palpha_prepare(const struct sph_palpha_material *given, const struct sph_material *solid,
                          struct sph_palpha_law *out, struct error *error);

/* The crush curve: alpha_e up to P_e, 1 from P_s on; its slope dalpha/dP <= 0 in 1/Pa (0 outside P_e..P_s). */
double sph_palpha_crush(const struct sph_palpha_law *law, double pressure);
double sph_palpha_crush_slope(const struct sph_palpha_law *law, double pressure);

/* Pa: where the elastic branch of fresh matter meets the curve, so that pores begin to close. It is P_e, and higher for
 * a body of lower alpha_0 than the curve begins with. */
double sph_palpha_crush_begin(const struct sph_palpha_law *law);

/* The elastic branch: dalpha/dP (<= 0); alpha at P of the branch with `rest` at P = 0; and which branch (alpha, P) is
 * on. One symmetric fourth-order step from 0 to P (Lobatto IIIA), so that the two are each other's inverse. */
double sph_palpha_elastic_slope(const struct sph_palpha_law *law, double distention);
double sph_palpha_elastic(const struct sph_palpha_law *law, double rest, double pressure);
double sph_palpha_rest(const struct sph_palpha_law *law, double distention, double pressure);

/* Damage by compaction, as D^(1/3): x = 1 - (rest-1)/(alpha_0-1) is the share of the pores that is closed for good,
 * D^(1/3) = [(x+d)^(1/3) - d^(1/3)] / [(1+d)^(1/3) - d^(1/3)], d = 0.01 [JBM08]. (By `rest`: elastic change harms
 * nothing.) The share alone would break a body of next to no pores: where alpha_0 - 1 is below 0.01, x is the closed
 * volume over 0.01 of the solid's, so that alpha_0 -> 1 is the solid (our choice). */
double sph_palpha_damage_cbrt(const struct sph_palpha_law *law, double rest);

struct sph_palpha_state {
  double distention, rest;
  double pressure;              /* Pa, bulk */
  double by_density, by_energy; /* dP/drho, dP/du along the branch it is on */
  double distention_by_density; /* dalpha/drho at constant u */
  double distention_by_energy;
  double
      shear_factor; /* f = 1 + (rho/alpha) dalpha/drho along an adiabat, in [0, 1]: dS/dt = (f/alpha) 2 mu dev + ... */
  double sound_speed; /* m/s, from c_e at alpha_0 to the solid's at 1, at rho_s = alpha rho */
  double wave_speed;  /* m/s, of the wave that acts: while pores close that of the crush curve */
};

/* (alpha, P) for a bulk density and energy, given the old rest distention; `guess` is where the search starts (the last
 * distention; any number in [1, alpha_0] gives the same to about 1e-12). rest = 1 is the solid, to the bit. */
struct sph_palpha_state sph_palpha_update(const struct sph_palpha_law *law, double rest, double guess, double density,
                                          double energy);

/* The exact fronts that a piston makes in matter without strength, from the jump conditions: the reference of protocol
 * piston. They use this engine's equation of state and crush curve; tests compare them with a solution that shares
 * neither (tests/verification/palpha_exact.h).
 *
 * In porous matter there are two fronts: the elastic precursor, which raises the pressure to P_e (to
 * sph_palpha_crush_begin()), and behind it the shock, which crushes pores. A piston slower than the matter behind the
 * precursor makes only an elastic front. Where the shock would be faster than the precursor, and in solid matter, there
 * is only the shock. Across a front, ahead 1, behind 2, in the frame of the matter ahead:
 *
 *   rho1 U = rho2 (U - w)
 *   P2 - P1 = rho1 U w
 *   u2 - u1 = (P1 + P2)/2 (1/rho1 - 1/rho2)
 *
 * A two-power curve that softens at P_t could split the shock once more; here it is one shock. */

struct sph_front {
  double speed, velocity;           /* m/s at rest ahead of everything: of the front, of the matter behind it */
  double density, pressure, energy; /* behind it: kg/m^3 bulk, Pa, J/kg */
  double distention;                /* behind it */
};

struct sph_plane_shock {
  double first_density; /* kg/m^3, bulk, ahead of the fronts */
  bool has_precursor, has_shock;
  struct sph_front precursor, shock; /* all NaN where there is none */
};

/* STATUS_CONTENT: values that give no law, or a piston so fast or slow that no pressure up to 1e16 Pa stops it. */
status sph_plane_shock(const struct sph_material *material, double piston, struct sph_plane_shock *out,
                       struct error *error);
/* Prints the existing fronts, one per line. */
void sph_plane_shock_describe(const struct sph_plane_shock *shock, FILE *out);
