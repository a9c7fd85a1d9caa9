/* Crush curves, the elastic branch, and the update of one particle. */
#include "engine/sph/material/palpha.h"

#include <math.h>
#include <stdbool.h>

/* 1. Curves */

double sph_palpha_crush(const struct sph_palpha_law *law, double p) {
  const struct sph_palpha_material *g = &law->given;
  if (p <= g->elastic_pressure)
    return law->elastic_distention;
  if (p >= g->solid_pressure)
    return 1;
  double left = (g->solid_pressure - p) / (g->solid_pressure - g->elastic_pressure);
  if (g->curve == SPH_CRUSH_QUADRATIC)
    return 1 + (law->elastic_distention - 1) * left * left;
  double alpha = 1 + (g->transition_distention - 1) * pow(left, g->exponent_high);
  if (p < g->transition_pressure)
    alpha += (law->elastic_distention - g->transition_distention) *
             pow((g->transition_pressure - p) / (g->transition_pressure - g->elastic_pressure), g->exponent_low);
  return alpha;
}

double sph_palpha_crush_begin(const struct sph_palpha_law *law) {
  const double rest = law->given.distention, rounding = 1e-9;
  double low = law->given.elastic_pressure, high = law->given.solid_pressure;
  if (sph_palpha_elastic(law, rest, low) >= law->elastic_distention * (1 - rounding))
    return low;
  for (int k = 0; k < 100; k++) {
    const double middle = (low + high) / 2;
    if (sph_palpha_crush(law, middle) > sph_palpha_elastic(law, rest, middle))
      low = middle;
    else
      high = middle;
  }
  return high;
}

double sph_palpha_crush_slope(const struct sph_palpha_law *law, double p) {
  const struct sph_palpha_material *g = &law->given;
  if (p <= g->elastic_pressure || p >= g->solid_pressure)
    return 0;
  double range = g->solid_pressure - g->elastic_pressure, left = (g->solid_pressure - p) / range;
  if (g->curve == SPH_CRUSH_QUADRATIC)
    return -2 * (law->elastic_distention - 1) * left / range;
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

static double within(double value, double low, double high) {
  return value < low ? low : value > high ? high : value;
}

/* Change of alpha on the elastic branch from `rest` at 0 to a trial `alpha` at P, and its derivatives: Simpson's rule
 * with the middle by Hermite (Lobatto IIIA). */
struct elastic {
  double change, by_alpha, by_pressure;
};

static double slope_and_growth(const struct sph_palpha_law *law, double alpha, double *growth) {
  double h = 1 / (1 - law->stiffness_slope * (alpha - 1)), soft = (1 - h * h) / law->solid.A;
  *growth = 2 * alpha * (soft - alpha * law->stiffness_slope * h * h * h / law->solid.A);
  return alpha * alpha * soft;
}

static struct elastic elastic_change(const struct sph_palpha_law *law, double rest, double alpha, double p) {
  if (law->stiffness_slope == 0)
    return (struct elastic){0, 0, 0};
  double growth_to, growth_middle, from = sph_palpha_elastic_slope(law, rest);
  double to = slope_and_growth(law, alpha, &growth_to);
  double half = within((rest + alpha) / 2 + p / 8 * (from - to), 1, law->given.distention);
  double middle = slope_and_growth(law, half, &growth_middle);
  double mean = (from + 4 * middle + to) / 6;
  return (struct elastic){p * mean, p / 6 * (growth_to + growth_middle * (2 - p / 2 * growth_to)),
                          mean + p / 12 * growth_middle * (from - to)};
}

double sph_palpha_elastic(const struct sph_palpha_law *law, double rest, double p) {
  double high = law->given.distention, alpha = rest;
  for (int i = 0; i < 100; i++) {
    double next = within(rest + elastic_change(law, rest, alpha, p).change, 1, high);
    if (fabs(next - alpha) < 1e-15)
      return next;
    alpha = next;
  }
  return alpha;
}

double sph_palpha_rest(const struct sph_palpha_law *law, double alpha, double p) {
  double rest = alpha;
  for (int i = 0; i < 100; i++) {
    /* by symmetry: the branch from alpha at P back to 0 ends at `rest` */
    struct elastic e = elastic_change(law, alpha, rest, -p);
    double next = within(rest - (rest - alpha - e.change) / (1 - e.by_alpha), 1, law->given.distention);
    if (fabs(next - rest) < 1e-15)
      return next;
    rest = next;
  }
  return rest;
}

double sph_palpha_damage_cbrt(const struct sph_palpha_law *law, double rest) {
  const double pores = law->given.distention - 1, full = 0.01; /* closing of less than that breaks only a part */
  double closed = within(1 - (rest - 1) / pores, 0, 1);
  if (pores < full)
    closed *= pores / full;
  const double d = 0.01;
  return closed == 0 ? 0 : (cbrt(closed + d) - cbrt(d)) / (cbrt(1 + d) - cbrt(d));
}

/* 2. A law from what is given */

static status refuse(struct error *error, const char *what, double value, const char *remedy) {
  return status_fail(error, STATUS_CONTENT, "porosity.%s is %.9g: %s", what, value, remedy);
}

/* By the name that the document gave. */
static status refuse_pores(struct error *error, const struct sph_palpha_material *given, const char *remedy) {
  if (given->by_fraction)
    return status_fail(error, STATUS_CONTENT, "porosity.fraction is %.9g (distention %.9g): %s",
                       1 - 1 / given->distention, given->distention, remedy);
  return refuse(error, "distention", given->distention, remedy);
}

static status check_curve(const struct sph_palpha_material *g, struct error *error) {
  if (g->curve != SPH_CRUSH_QUADRATIC && g->curve != SPH_CRUSH_TWO_POWER)
    return refuse(error, "curve", g->curve, "it must be quadratic or two-power");
  const struct {
    const char *name;
    double value;
    bool good;
    const char *remedy;
  } checks[] = {
      {"distention", g->distention, g->distention > 1, "it must be above 1 (1 is a solid: leave the porosity out)"},
      {"elastic_pressure", g->elastic_pressure, g->elastic_pressure >= 0, "it must be a pressure of 0 or more"},
      {"solid_pressure", g->solid_pressure, g->solid_pressure > g->elastic_pressure,
       "it must be above elastic_pressure"},
      /* of two powers: */
      {"transition_pressure", g->transition_pressure,
       g->transition_pressure > g->elastic_pressure && g->transition_pressure < g->solid_pressure,
       "it must lie between elastic_pressure and solid_pressure"},
      {"transition_distention", g->transition_distention, g->transition_distention >= 1, "it must be 1 or more"},
      {"elastic_distention", g->elastic_distention,
       g->elastic_distention > 1 && g->elastic_distention >= g->transition_distention,
       "it must be above 1 and not below transition_distention"},
      {"exponent_low", g->exponent_low, g->exponent_low >= 1, "it must be 1 or more"},
      {"exponent_high", g->exponent_high, g->exponent_high >= 1, "it must be 1 or more"},
  };
  const size_t count = g->curve == SPH_CRUSH_QUADRATIC ? 3 : sizeof checks / sizeof *checks;
  for (size_t i = 0; i < count; i++)
    if (!checks[i].good || !isfinite(checks[i].value))
      return refuse(error, checks[i].name, checks[i].value, checks[i].remedy);
  return STATUS_OK;
}

/* Is the branch with this alpha_e valid up to alpha_0: does h stay above 0? (h = c_e/c_s at alpha_e.) */
static bool set_stiffness(struct sph_palpha_law *law, double ratio, double elastic_distention) {
  law->elastic_distention = elastic_distention;
  law->stiffness_slope = ratio < 1 ? (1 - ratio) / (elastic_distention - 1) : 0;
  return elastic_distention > 1 && law->stiffness_slope * (law->given.distention - 1) < 1;
}

/* Does one step from 0 to P_e give the alpha of many small steps, within a hundredth of the pores? Where h grows many
 * times over on the way it does not, and the one step would close pores that the branch leaves open. (Above P_e the
 * branch is stiffer.) */
static bool followed(const struct sph_palpha_law *law) {
  enum { STEPS = 256 };
  const double first = law->given.distention, pressure = law->given.elastic_pressure;
  double alpha = first;
  for (int i = 0; i < STEPS; i++)
    alpha = sph_palpha_elastic(law, alpha, pressure / STEPS);
  return fabs(alpha - sph_palpha_elastic(law, first, pressure)) < 0.01 * (first - 1);
}

/* Sound speed of the porous body over that of the solid. */
static status find_ratio(const struct sph_palpha_law *law, double *ratio, struct error *error) {
  if (!(law->solid.A > 0) || !(law->solid_density > 0))
    return status_fail(error, STATUS_CONTENT, "porosity: the solid has no bulk modulus or density");
  const double solid_speed = sqrt(law->solid.A / law->solid_density), speed = law->given.sound_speed;
  *ratio = isnan(speed) ? 1 : speed / solid_speed;
  if (*ratio > 0 && *ratio <= 1)
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "porosity.sound_speed is %.9g m/s: it must be above 0 and not above the solid's, %.6g m/s", speed,
                     solid_speed);
}

static status too_soft(const struct sph_palpha_law *law, struct error *error) {
  return refuse_pores(
      error, &law->given,
      "with this sound_speed the pores give way before elastic_pressure: give a higher sound_speed, or off, "
      "or a lower elastic_pressure");
}

/* alpha_e is given. */
static status prepare_two_power(struct sph_palpha_law *law, double ratio, struct error *error) {
  const struct sph_palpha_material *given = &law->given;
  if (!set_stiffness(law, ratio, given->elastic_distention))
    return refuse_pores(error, given,
                        "it is too far above elastic_distention for sound_speed: lower it, or raise one of the others");
  const double begin = sph_palpha_elastic(law, given->distention, given->elastic_pressure);
  if (begin > given->elastic_distention * (1 + 1e-6))
    return refuse_pores(error, given,
                        "it is above elastic_distention, where the crush curve begins: lower it or raise that");
  return followed(law) ? STATUS_OK : too_soft(law, error);
}

/* alpha_e is where the elastic branch ends, at P_e. The iteration begins above and falls to the largest solution. */
static status prepare_quadratic(struct sph_palpha_law *law, double ratio, struct error *error) {
  double alpha_e = law->given.distention;
  for (int i = 0; i < 1000; i++) {
    if (!set_stiffness(law, ratio, alpha_e))
      return too_soft(law, error);
    const double next = sph_palpha_elastic(law, law->given.distention, law->given.elastic_pressure);
    if (fabs(next - alpha_e) < 1e-14 * alpha_e)
      return followed(law) ? STATUS_OK : too_soft(law, error);
    alpha_e = next;
  }
  return too_soft(law, error);
}

status sph_palpha_prepare(const struct sph_palpha_material *given, const struct sph_material *solid,
                          struct sph_palpha_law *out, struct error *error) {
  TRY(check_curve(given, error));
  double ratio = 1;
  *out = (struct sph_palpha_law){.given = *given, .solid = solid->tillotson, .solid_density = solid->density};
  TRY(find_ratio(out, &ratio, error));
  return given->curve == SPH_CRUSH_TWO_POWER ? prepare_two_power(out, ratio, error)
                                             : prepare_quadratic(out, ratio, error);
}

/* 3. (alpha, P) of a density and an energy */

struct trial {
  struct sph_pressure solid;
  double pressure; /* bulk P(alpha) */
  double slope;    /* dP/dalpha at constant rho, u; never below 0: hot expanded matter counts as 0 */
};

static struct trial try_distention(const struct sph_palpha_law *law, double alpha, double rho, double u) {
  struct trial t = {.solid = sph_tillotson(&law->solid, law->solid_density, alpha * rho, u)};
  t.pressure = t.solid.pressure / alpha;
  t.slope = (rho * t.solid.by_density - t.pressure) / alpha;
  if (t.slope < 0)
    t.slope = 0;
  return t;
}

/* The distention that matter with the distention `rest` at rest has at a pressure: the lower one of the elastic branch
 * and the crush curve. */
struct target {
  double alpha;
  double rise; /* d(trial alpha - this alpha)/d(trial alpha) */
  bool crush;
};

static struct target target_at(const struct sph_palpha_law *law, double rest, double alpha, const struct trial *t) {
  const double p = t->pressure;
  if (p >= law->given.solid_pressure)
    return (struct target){1, 1, true};
  const struct elastic e = elastic_change(law, rest, alpha, p);
  struct target to = {rest + e.change, 1 - e.by_alpha - e.by_pressure * t->slope, false};
  if (to.alpha >= law->given.distention)
    to = (struct target){law->given.distention, 1, false};
  if (!(p > law->given.elastic_pressure))
    return to;
  const double bound = sph_palpha_crush(law, p);
  if (bound < to.alpha)
    to = (struct target){bound, 1 - sph_palpha_crush_slope(law, p) * t->slope, true};
  return to;
}

/* Both branches fall with P, and P rises with alpha, so alpha - min(elastic, crush)(P(alpha)) rises: its only zero lies
 * between 1 and alpha_0. Newton, kept within that bracket (on the crush curve, which is convex, it climbs steadily from
 * below). A last step from a miss below 1e-9 leaves the square of that: it is taken, but not evaluated again. */
static double solve(const struct sph_palpha_law *law, double rest, double alpha, double rho, double u, struct trial *at,
                    bool *crush) {
  double low = 1, high = law->given.distention;
  for (int i = 0; i < 200; i++) {
    *at = try_distention(law, alpha, rho, u);
    const struct target to = target_at(law, rest, alpha, at);
    const double miss = alpha - to.alpha;
    *crush = to.crush;
    if (miss == 0)
      return alpha;
    if (miss > 0)
      high = alpha;
    else
      low = alpha;
    const double next = alpha - miss / (to.rise > 0.1 ? to.rise : 0.1);
    const bool inside = next >= low && next <= high;
    const bool settled = fabs(miss) < 1e-9 || high - low < 1e-15;
    if (settled && !inside)
      return alpha;
    if (settled) {
      at->pressure += at->slope * (next - alpha);
      return next;
    }
    alpha = inside && i % 32 < 31 ? next : low + (high - low) / 2;
  }
  return alpha;
}

static struct sph_palpha_state without_pores(const struct sph_palpha_law *law, double rho, double u) {
  struct sph_pressure p = sph_tillotson(&law->solid, law->solid_density, rho, u);
  return (struct sph_palpha_state){1, 1, p.pressure, p.by_density, p.by_energy, 0, 0, 1, p.sound_speed, p.sound_speed};
}

/* Over this share of P_e above it the wave that acts turns from that of sound to that of the crush curve: an elastic
 * precursor stands at P_e, and with little viscosity it would ring across it and close pores (our choice). */
static const double BLEND = 0.1;

struct sph_palpha_state sph_palpha_update(const struct sph_palpha_law *law, double rest, double guess, double rho,
                                          double u) {
  if (!(rest > 1))
    return without_pores(law, rho, u);
  double top = law->given.distention, slope = 0;
  struct trial t;
  bool crush;
  double alpha = solve(law, rest, within(guess, 1, top), rho, u, &t, &crush);
  if (crush) {
    if (!(alpha > 1))
      return without_pores(law, rho, u);
    slope = sph_palpha_crush_slope(law, t.pressure);
    double now = sph_palpha_rest(law, alpha, t.pressure);
    if (now < rest)
      rest = now;
  } else if (law->stiffness_slope != 0 && alpha < top) {
    slope = sph_palpha_elastic_slope(law, alpha);
  }
  /* Along a branch: dP (1 - slope (rho dP_s/drho_s - P)/alpha) = dP_s/drho_s drho + dP_s/du du/alpha */
  double below = alpha + slope * (t.pressure - rho * t.solid.by_density);
  if (!(below >= alpha))
    below = alpha; /* as t.slope */
  struct sph_palpha_state s = {.distention = alpha, .rest = rest, .pressure = t.pressure};
  s.by_density = alpha * t.solid.by_density / below;
  s.by_energy = t.solid.by_energy / below;
  s.distention_by_density = slope * s.by_density;
  s.distention_by_energy = slope * s.by_energy;
  double adiabatic = s.distention_by_density + t.pressure / (rho * rho) * s.distention_by_energy;
  s.shear_factor = within(1 + adiabatic * rho / alpha, 0, 1);
  double c = t.solid.sound_speed;
  s.sound_speed = isnan(law->given.sound_speed) ? c : c + (law->given.sound_speed - c) * (alpha - 1) / (top - 1);
  s.wave_speed = s.sound_speed;
  if (crush) {
    const double plastic = sqrt(fmax(s.by_density + t.pressure / (rho * rho) * s.by_energy, 0));
    const double over = within((t.pressure - law->given.elastic_pressure) / (BLEND * law->given.elastic_pressure), 0,
                               1);
    s.wave_speed += (plastic - s.sound_speed) * over;
  }
  return s;
}
