#include "engine/sph/palpha.h"

#include <math.h>
#include <stdbool.h>

#include "engine/sph/tillotson.h"

/* 1. Curves */

double sph_palpha_crush(const struct sph_palpha_law *law, double p) {
  const struct sph_palpha *g = &law->given;
  if (p <= g->elastic_pressure) return law->elastic_distention;
  if (p >= g->solid_pressure) return 1;
  double left = (g->solid_pressure - p) / (g->solid_pressure - g->elastic_pressure);
  if (g->curve == SPH_CRUSH_QUADRATIC) return 1 + (law->elastic_distention - 1) * left * left;
  double alpha = 1 + (g->transition_distention - 1) * pow(left, g->exponent_high);
  if (p < g->transition_pressure)
    alpha += (law->elastic_distention - g->transition_distention) *
             pow((g->transition_pressure - p) / (g->transition_pressure - g->elastic_pressure), g->exponent_low);
  return alpha;
}

double sph_palpha_crush_slope(const struct sph_palpha_law *law, double p) {
  const struct sph_palpha *g = &law->given;
  if (p <= g->elastic_pressure || p >= g->solid_pressure) return 0;
  double range = g->solid_pressure - g->elastic_pressure, left = (g->solid_pressure - p) / range;
  if (g->curve == SPH_CRUSH_QUADRATIC) return -2 * (law->elastic_distention - 1) * left / range;
  double slope = -(g->transition_distention - 1) * g->exponent_high * pow(left, g->exponent_high - 1) / range;
  if (p < g->transition_pressure) {
    range = g->transition_pressure - g->elastic_pressure;
    slope -= (law->elastic_distention - g->transition_distention) * g->exponent_low *
             pow((g->transition_pressure - p) / range, g->exponent_low - 1) / range;
  }
  return slope;
}

double sph_palpha_elastic_slope(const struct sph_palpha_law *law, double alpha) {
  double h = 1 - law->stiffness_slope * (alpha - 1); /* h^2 is the stiffness over the solid's */
  return alpha * alpha / law->solid.A * (1 - 1 / (h * h));
}

/* alpha - rest after P, for an end `alpha` of the branch that is itself unknown: Simpson's rule with the middle by
 * Hermite. Slopes outside 1..alpha_0 are not asked for. */
static double elastic_change(const struct sph_palpha_law *law, double rest, double alpha, double p) {
  double from = sph_palpha_elastic_slope(law, rest), to = sph_palpha_elastic_slope(law, alpha);
  double middle = (rest + alpha) / 2 + p / 8 * (from - to);
  if (middle < 1) middle = 1;
  if (middle > law->given.distention) middle = law->given.distention;
  return p / 6 * (from + 4 * sph_palpha_elastic_slope(law, middle) + to);
}

static double within(double value, double low, double high) {
  return value < low ? low : value > high ? high : value;
}

double sph_palpha_elastic(const struct sph_palpha_law *law, double rest, double p) {
  if (law->stiffness_slope == 0) return rest;
  double high = law->given.distention, alpha = rest;
  for (int i = 0; i < 100; i++) {
    double next = within(rest + elastic_change(law, rest, alpha, p), 1, high);
    if (fabs(next - alpha) < 1e-15) return next;
    alpha = next;
  }
  return alpha;
}

double sph_palpha_rest(const struct sph_palpha_law *law, double alpha, double p) {
  if (law->stiffness_slope == 0) return alpha;
  double high = law->given.distention, rest = alpha;
  for (int i = 0; i < 100; i++) {
    double next = within(alpha - elastic_change(law, rest, alpha, p), 1, high);
    if (fabs(next - rest) < 1e-15) return next;
    rest = next;
  }
  return rest;
}

double sph_palpha_damage_cbrt(const struct sph_palpha_law *law, double rest) {
  double closed = within(1 - (rest - 1) / (law->given.distention - 1), 0, 1);
  const double d = 0.01;
  return closed == 0 ? 0 : (cbrt(closed + d) - cbrt(d)) / (cbrt(1 + d) - cbrt(d));
}

/* 2. A law from what is given */

static status refuse(struct error *error, const char *what, double value, const char *remedy) {
  return status_fail(error, STATUS_CONTENT, "porosity: %s is %.9g: %s", what, value, remedy);
}

static status check_curve(const struct sph_palpha *g, struct error *error) {
  if (!(g->distention > 1) || !isfinite(g->distention))
    return refuse(error, "distention", g->distention, "it must be above 1 (1 is a solid: leave the porosity out)");
  if (!(g->elastic_pressure >= 0) || !isfinite(g->elastic_pressure))
    return refuse(error, "elastic_pressure", g->elastic_pressure, "it must be a pressure of 0 or more");
  if (!(g->solid_pressure > g->elastic_pressure) || !isfinite(g->solid_pressure))
    return refuse(error, "solid_pressure", g->solid_pressure, "it must be above elastic_pressure");
  if (g->curve == SPH_CRUSH_QUADRATIC) return STATUS_OK;
  if (!(g->transition_pressure > g->elastic_pressure) || !(g->transition_pressure < g->solid_pressure))
    return refuse(error, "transition_pressure", g->transition_pressure,
                  "it must lie between elastic_pressure and solid_pressure");
  if (!(g->transition_distention >= 1) || !isfinite(g->transition_distention))
    return refuse(error, "transition_distention", g->transition_distention, "it must be 1 or more");
  if (!(g->elastic_distention >= g->transition_distention) || !isfinite(g->elastic_distention) ||
      g->elastic_distention <= 1)
    return refuse(error, "elastic_distention", g->elastic_distention,
                  "it must be above 1 and not below transition_distention");
  if (!(g->exponent_low >= 1) || !isfinite(g->exponent_low))
    return refuse(error, "exponent_low", g->exponent_low, "it must be 1 or more");
  if (!(g->exponent_high >= 1) || !isfinite(g->exponent_high))
    return refuse(error, "exponent_high", g->exponent_high, "it must be 1 or more");
  return STATUS_OK;
}

/* Is the branch with this alpha_e sound up to alpha_0, that is, stays h > 0? (h = c_e/c_s at alpha_e.) */
static bool set_stiffness(struct sph_palpha_law *law, double ratio, double elastic_distention) {
  law->elastic_distention = elastic_distention;
  law->stiffness_slope = ratio < 1 ? (1 - ratio) / (elastic_distention - 1) : 0;
  return elastic_distention > 1 && law->stiffness_slope * (law->given.distention - 1) < 1;
}

status sph_palpha_prepare(const struct sph_palpha *given, const struct sph_material *solid, struct sph_palpha_law *out,
                          struct error *error) {
  status code = check_curve(given, error);
  if (code != STATUS_OK) return code;
  *out = (struct sph_palpha_law){.given = *given, .solid = solid->tillotson, .solid_density = solid->density};
  if (!(solid->tillotson.A > 0) || !(solid->density > 0))
    return status_fail(error, STATUS_CONTENT, "porosity: the solid has no bulk modulus or density");
  double solid_speed = sqrt(solid->tillotson.A / solid->density);
  double ratio = isnan(given->sound_speed) ? 1 : given->sound_speed / solid_speed;
  if (!(ratio > 0) || !(ratio <= 1))
    return status_fail(error, STATUS_CONTENT,
                       "porosity: sound_speed is %.9g m/s: it must be above 0 and not above the solid's, %.6g m/s",
                       given->sound_speed, solid_speed);
  const char *soft = "with this sound_speed the pores give way before elastic_pressure: give a higher sound_speed or a "
                     "lower elastic_pressure";
  if (given->curve == SPH_CRUSH_TWO_POWER) {
    if (!set_stiffness(out, ratio, given->elastic_distention))
      return refuse(error, "distention", given->distention, "it is too far above elastic_distention for sound_speed");
    if (sph_palpha_elastic(out, given->distention, given->elastic_pressure) > given->elastic_distention * (1 + 1e-6))
      return refuse(error, "distention", given->distention,
                    "it is above elastic_distention, where the crush curve begins: lower it or raise that");
    return STATUS_OK;
  }
  /* alpha_e <- elastic branch at P_e, from above: falls to the largest solution */
  double alpha_e = given->distention;
  for (int i = 0; i < 1000; i++) {
    if (!set_stiffness(out, ratio, alpha_e)) return refuse(error, "distention", given->distention, soft);
    double next = sph_palpha_elastic(out, given->distention, given->elastic_pressure);
    if (fabs(next - alpha_e) < 1e-14 * alpha_e) return STATUS_OK;
    alpha_e = next;
  }
  return refuse(error, "distention", given->distention, soft);
}

/* 3. (alpha, P) of a density and an energy */

struct trial {
  struct sph_pressure solid;
  double pressure,
      slope; /* bulk P(alpha) and dP/dalpha at constant rho, u: not negative, but for hot expanded matter */
};

static struct trial try_distention(const struct sph_palpha_law *law, double alpha, double rho, double u) {
  struct trial t = {.solid = sph_tillotson(&law->solid, law->solid_density, alpha * rho, u)};
  t.pressure = t.solid.pressure / alpha;
  t.slope = (rho * t.solid.by_density - t.pressure) / alpha;
  if (t.slope < 0) t.slope = 0;
  return t;
}

/* Both branches fall with P, and P rises with alpha: alpha - branch(P(alpha)) rises, so that its only zero lies between
 * `low` and `high`. Newton, kept within the bracket (from below it climbs steadily: the curves are convex). A last step
 * from a miss below 1e-11 is taken, but not evaluated again. */
static double solve(const struct sph_palpha_law *law, bool crush, double rest, double low, double high, double alpha,
                    double rho, double u, struct trial *at) {
  double top = law->given.distention;
  for (int i = 0; i < 200; i++) {
    struct trial t = try_distention(law, alpha, rho, u);
    *at = t;
    double target, slope;
    if (crush) {
      target = sph_palpha_crush(law, t.pressure);
      slope = sph_palpha_crush_slope(law, t.pressure);
    } else {
      target = law->stiffness_slope == 0 ? rest : rest + elastic_change(law, rest, alpha, t.pressure);
      slope = law->stiffness_slope == 0 ? 0 : sph_palpha_elastic_slope(law, alpha);
      if (target >= top) target = top, slope = 0;
    }
    double miss = alpha - target;
    if (miss == 0) return alpha;
    if (miss > 0)
      high = alpha;
    else
      low = alpha;
    double next = alpha - miss / (1 - slope * t.slope);
    bool inside = next >= low && next <= high;
    if (fabs(miss) < 1e-11 || high - low < 1e-15) {
      if (!inside) return alpha;
      at->pressure += t.slope * (next - alpha);
      return next;
    }
    if (!inside || i % 32 == 31) next = low + (high - low) / 2;
    alpha = next;
  }
  return alpha;
}

static struct sph_palpha_state without_pores(const struct sph_palpha_law *law, double rho, double u) {
  struct sph_pressure p = sph_tillotson(&law->solid, law->solid_density, rho, u);
  return (struct sph_palpha_state){1, 1, p.pressure, p.by_density, p.by_energy, 0, 0, 1, p.sound_speed};
}

struct sph_palpha_state sph_palpha_update(const struct sph_palpha_law *law, double rest, double guess, double rho,
                                          double u) {
  if (!(rest > 1)) return without_pores(law, rho, u);
  double top = law->given.distention;
  struct trial t;
  double alpha = solve(law, false, rest, 1, top, within(guess, 1, top), rho, u, &t);
  double slope = law->stiffness_slope == 0 || alpha >= top ? 0 : sph_palpha_elastic_slope(law, alpha);
  if (t.pressure > law->given.elastic_pressure && alpha > sph_palpha_crush(law, t.pressure)) {
    alpha = solve(law, true, rest, 1, alpha, within(guess, 1, alpha), rho, u, &t);
    if (!(alpha > 1)) return without_pores(law, rho, u);
    slope = sph_palpha_crush_slope(law, t.pressure);
    double now = sph_palpha_rest(law, alpha, t.pressure);
    if (now < rest) rest = now;
  }
  /* Along a branch: dP (1 - slope (rho dP_s/drho_s - P)/alpha) = dP_s/drho_s drho + dP_s/du du/alpha */
  double below = alpha + slope * (t.pressure - rho * t.solid.by_density);
  if (!(below >= alpha)) below = alpha; /* as t.slope */
  struct sph_palpha_state s = {.distention = alpha, .rest = rest, .pressure = t.pressure};
  s.by_density = alpha * t.solid.by_density / below;
  s.by_energy = t.solid.by_energy / below;
  s.distention_by_density = slope * s.by_density;
  s.distention_by_energy = slope * s.by_energy;
  double adiabatic = s.distention_by_density + t.pressure / (rho * rho) * s.distention_by_energy;
  s.shear_factor = within(1 + adiabatic * rho / alpha, 0, 1);
  double c = t.solid.sound_speed;
  s.sound_speed = isnan(law->given.sound_speed) ? c : c + (law->given.sound_speed - c) * (alpha - 1) / (top - 1);
  return s;
}
