/* Plane waves in porous matter without strength, from the jump conditions alone. The code is independent of the engine
 * (its own Tillotson, crush curve and elastic branch), so that it can be a reference for the moving solid.
 *
 * A piston that drives porous matter at rest makes two fronts when it is strong enough to crush: an elastic precursor
 * to P_e, and behind it the crushing shock. Across each, with the state ahead 1 and behind 2, in the frame of the
 * matter ahead: rho1 U = rho2 (U - w),  P2 - P1 = rho1 U w,  u2 - u1 = (P1 + P2)/2 (1/rho1 - 1/rho2). */
#pragma once

#include <math.h>

struct exact_matter {
  double rho_s0, A, B, a, b, E0; /* cold compressed Tillotson is enough */
  double alpha0, P_e, P_s, c_e;  /* quadratic curve; alpha0 = 1: solid */
};

struct exact_front {
  double ahead_speed, speed;                         /* m/s in the laboratory: matter ahead, front */
  double velocity, density, pressure, energy, alpha; /* behind it */
};

static double exact_solid_pressure(const struct exact_matter *m, double rho, double u) {
  double eta = rho / m->rho_s0, mu = eta - 1;
  return (m->a + m->b / (u / (m->E0 * eta * eta) + 1)) * rho * u + m->A * mu + (mu > 0 ? m->B * mu * mu : 0);
}

/* alpha at pressure P on the elastic branch from alpha0, midpoint steps; alpha_e by repeated substitution. */
static double exact_elastic(const struct exact_matter *m, double P, double alpha_e) {
  double cs = sqrt(m->A / m->rho_s0), alpha = m->alpha0;
  const int steps = 2000;
  for (int i = 0; i < steps; i++) {
    double a = alpha, slope = 0;
    for (int k = 0; k < 2; k++) {
      double h = 1 + (a - 1) * (m->c_e - cs) / (cs * (alpha_e - 1));
      slope = a * a / m->A * (1 - 1 / (h * h));
      a = alpha + slope * P / steps / 2;
    }
    alpha += slope * P / steps;
  }
  return alpha;
}

static double exact_alpha_e(const struct exact_matter *m) {
  double alpha_e = m->alpha0;
  for (int i = 0; i < 60; i++)
    alpha_e = exact_elastic(m, m->P_e, alpha_e);
  return alpha_e;
}

/* The state behind a front that raises P1 to P, alpha given; bisection for rho: P_s(alpha rho, u(rho)) = alpha P. */
static double exact_density(const struct exact_matter *m, double alpha, double rho1, double P1, double u1, double P) {
  double low = rho1, high = 4 * m->rho_s0 / alpha;
  for (int i = 0; i < 200; i++) {
    double rho = (low + high) / 2, u = u1 + (P1 + P) / 2 * (1 / rho1 - 1 / rho);
    if (exact_solid_pressure(m, alpha * rho, u) < alpha * P)
      low = rho;
    else
      high = rho;
  }
  return (low + high) / 2;
}

static double exact_crush(const struct exact_matter *m, double alpha_e, double P) {
  if (P >= m->P_s)
    return 1;
  return 1 + (alpha_e - 1) * pow((m->P_s - P) / (m->P_s - m->P_e), 2);
}

/* Front that raises the matter (rho1, P1, u1, moving at v1) to P; alpha behind it given. */
static struct exact_front exact_front_to(const struct exact_matter *m, double alpha, double rho1, double P1, double u1,
                                         double v1, double P) {
  struct exact_front f = {.ahead_speed = v1, .pressure = P, .alpha = alpha};
  f.density = exact_density(m, alpha, rho1, P1, u1, P);
  f.energy = u1 + (P1 + P) / 2 * (1 / rho1 - 1 / f.density);
  f.velocity = v1 + sqrt((P - P1) * (1 / rho1 - 1 / f.density));
  f.speed = v1 + (f.velocity - v1) * f.density / (f.density - rho1);
  return f;
}

/* Precursor and main front for a piston at `piston` m/s: both lie ahead of it. Solid matter has only the main front. */
static void exact_piston(const struct exact_matter *m, double piston, struct exact_front *precursor,
                         struct exact_front *shock) {
  double rho0 = m->rho_s0 / m->alpha0, alpha_e = m->alpha0;
  *precursor = (struct exact_front){.density = rho0, .alpha = m->alpha0};
  if (m->alpha0 > 1) {
    alpha_e = exact_alpha_e(m);
    *precursor = exact_front_to(m, alpha_e, rho0, 0, 0, 0, m->P_e);
  }
  double low = precursor->pressure, high = 1e12;
  for (int i = 0; i < 200; i++) {
    double P = sqrt(fmax(low, 1) * high);
    *shock = exact_front_to(m, exact_crush(m, alpha_e, P), precursor->density, precursor->pressure, precursor->energy,
                            precursor->velocity, P);
    if (shock->velocity < piston)
      low = P;
    else
      high = P;
  }
}

static const struct exact_matter exact_porous_aluminium = {2700, 7.52e10, 6.5e10, 0.5,   1.63,
                                                           5e6,  1.275,   80e6,   700e6, 4110};
