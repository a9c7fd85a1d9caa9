/* Field rows of the results that every engine reports. */
#include "engine/outcome.h"

#include <math.h>

static FIELD_WORDS(states, OUTCOME_STATES, [OUTCOME_COMPLETED] = "completed", [OUTCOME_END_TIME] = "end-time",
                   [OUTCOME_NOT_FINITE] = "not-finite", [OUTCOME_TIME_STEP] = "time-step", [OUTCOME_ENERGY] = "energy",
                   [OUTCOME_INVALID] = "invalid");

#define ROW(path_, kind_, unit_, ...)                                                                                  \
  { .path = #path_, .kind = kind_, .unit = unit_, .offset = offsetof(struct outcome, path_), __VA_ARGS__ }
#define REAL(path_, unit_, low, ...) ROW(path_, FIELD_REAL, unit_, .minimum = low, .maximum = HUGE_VAL, __VA_ARGS__)
#define COUNT(path_, ...)            ROW(path_, FIELD_INTEGER, "1", .minimum = 0, .maximum = HUGE_VAL, __VA_ARGS__)

static const struct field rows[] = {
    ROW(state, FIELD_CHOICE, NULL, .choices = states,
        .choice_docs = "fracture had ceased by the scene's declared rule\n"
                       "the end time (stop.end_time) came first: fragments may still be breaking\n"
                       "NaN or infinity appeared\n"
                       "the stable time step collapsed\n"
                       "errors of the computation made or lost more energy than the scene allows\n"
                       "the inputs cannot be run together",
        .doc = "How the run ended: with a usable result (completed, end-time), or without one."),
    ROW(message, FIELD_TEXT, NULL, .text = "", .doc = "What went wrong, in words; empty when nothing did."),
    ROW(warnings, FIELD_TEXT, NULL, .text = "",
        .doc = "Conditions that a usable run does not meet, a word for each; empty when it meets all."),
    COUNT(steps, .label = "time steps", .doc = "Time steps taken."),
    REAL(time, "s", 0, .label = "simulated time", .doc = "Simulated time at the end."),
    REAL(time_step, "s", 0, .doc = "The smallest time step used."),
    REAL(total_mass, "kg", 0, .doc = "Mass of the body at the end (two dimensions: per metre of thickness)."),
    REAL(energy_error, "1", 0, .flags = FIELD_MAY_BE_OFF, .number = NAN,
         .doc = "Energy gained or lost by numerical errors, as a share of the energy put in; in sph without the energy "
                "of the motion of all matter together, which no collision can use."),
    REAL(momentum_error, "1", 0, .flags = FIELD_MAY_BE_OFF, .number = NAN,
         .doc = "Change of total momentum minus the impulse of external forces, as a share of the sum of the momenta "
                "of all grains or particles."),
    COUNT(fragment_count, .main_rank = 3, .label = "number of fragments",
          .doc = "Fragments of any size, single grains (dust) included."),
    COUNT(single_count, .label = "number of single grains or particles",
          .doc = "Fragments of one grain or particle: below the model's resolution."),
    ROW(dust_fraction, FIELD_REAL, "1", .minimum = 0, .maximum = 1, .main_rank = 4, .label = "mass share of dust",
        .doc = "Mass share of dust: fragments lighter than a mass that the scene gives (sph: fragments.dust_mass), or "
               "single grains (dem)."),
    REAL(complete_mass, "kg", 0, .label = "least mass with a complete spectrum",
         .doc = "The spectrum of fragments is complete from this mass on: 10 particles (sph: 9.5 of the heaviest) or "
                "2 grains (dem: 1.5 mean ones). Exponents use heavier fragments only."),
    ROW(largest_fraction, FIELD_REAL, "1", .minimum = 0, .maximum = 1, .main_rank = 1,
        .label = "mass share of the largest fragment M₁/M",
        .doc = "Mass of the largest fragment over the total mass, M_1/M: that of all discs (dem), or of the target "
               "without the projectile (sph)."),
    ROW(second_fraction, FIELD_REAL, "1", .minimum = 0, .maximum = 1, .main_rank = 2,
        .label = "mass share of the second largest fragment M₂/M",
        .doc = "Mass of the second largest fragment over the total mass, M_2/M."),
    REAL(mean_fragment_mass, "kg", 0, .main_rank = 5, .label = "mean fragment mass (second over first moment)",
         .doc = "Sum of the squared fragment masses over the sum of the masses (not M_2/M_1). dem: kg/m."),
    REAL(mean_fragment_mass_rest, "kg", 0, .label = "mean fragment mass without the largest",
         .doc = "The same without the largest fragment."),
    REAL(kinetic_energy_share, "1", 0, .flags = FIELD_MAY_BE_OFF, .number = NAN,
         .label = "share of the energy that moves fragments",
         .doc = "Translation energy of the fragments over the energy put in."),
};

const struct field_table outcome_table = FIELD_TABLE(rows, struct outcome, "outcome",
                                                     "What every engine reports of a finished run.");

const struct field *outcome_main(size_t index) {
  for (size_t i = 0; i < outcome_table.count; i++)
    if (rows[i].main_rank == (int)index + 1)
      return &rows[i];
  return NULL;
}

const char *outcome_name(size_t offset) {
  for (size_t i = 0; i < outcome_table.count; i++)
    if (rows[i].offset == offset)
      return rows[i].path;
  return NULL;
}

bool outcome_is_usable(int state) {
  return state == OUTCOME_COMPLETED || state == OUTCOME_END_TIME;
}

bool outcome_counts(const struct outcome *outcome) {
  if (!outcome_is_usable(outcome->state))
    return false;
  for (size_t i = 0; i < outcome_table.count; i++) {
    const double *value = (const void *)((const char *)outcome + rows[i].offset);
    if (rows[i].main_rank && rows[i].kind == FIELD_REAL && isnan(*value))
      return false;
  }
  return true;
}

/* value/mass; 0 where there is no mass. */
static double over(double value, double mass) {
  return mass > 0 ? value / mass : 0;
}

void outcome_fragments(struct outcome *outcome, size_t count, const struct fragment *fragments,
                       const struct outcome_small *small) {
  double mass = 0, square = 0, dust = 0, rest = 0, rest_square = 0; /* rest: without the largest */
  outcome->fragment_count = (int64_t)count;
  outcome->single_count = 0;
  for (size_t k = 0; k < count; k++) {
    mass += fragments[k].mass;
    square += fragments[k].mass * fragments[k].mass;
    rest += k > 0 ? fragments[k].mass : 0;
    rest_square += k > 0 ? fragments[k].mass * fragments[k].mass : 0;
    outcome->single_count += fragments[k].count == 1;
    const bool is_dust = isnan(small->dust) ? fragments[k].count == 1 : fragments[k].mass < small->dust;
    dust += is_dust ? fragments[k].mass : 0;
  }
  const double largest = count > 0 ? fragments[0].mass : 0;
  outcome->total_mass = mass;
  outcome->complete_mass = small->complete;
  outcome->dust_fraction = over(dust, mass);
  outcome->largest_fraction = over(largest, mass);
  outcome->second_fraction = count > 1 ? fragments[1].mass / mass : 0;
  outcome->mean_fragment_mass = over(square, mass);
  outcome->mean_fragment_mass_rest = over(rest_square, rest);
}
