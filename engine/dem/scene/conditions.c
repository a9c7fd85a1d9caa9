/* Conditions under which results of engine dem are valid (engine/condition.h). */
#include <math.h>
#include <stdio.h>

#include "engine/condition.h"
#include "engine/dem/run/run.h"

#define BEFORE(name, ...) CONDITION_BEFORE(struct dem_inputs, name, __VA_ARGS__)
#define AFTER(name, ...)  CONDITION_AFTER(struct dem_inputs, struct dem_run, struct dem_results, name, __VA_ARGS__)
#define ONLY              CONDITION_ONLY

/* ---- the integration ---- */

AFTER(drift, r->outcome->energy_error)

BEFORE(step_before, in->fidelity.time_step / dem_describe_stable_step(in))

static void step_estimated(const void *inputs, FILE *out) {
  (void)inputs;
  fputs(", estimated for the least stable of 40 bodies: each body has its own limit", out);
}

AFTER(step_after, in->fidelity.time_step / run->stable_time_step)

BEFORE(damping, dem_describe_damping(in) * in->fidelity.time_step)

AFTER(angular, results->angular_momentum_error)

/* ---- contacts ---- */

/* Fastest approach that the inputs themselves set up, m/s: of a charge, six equal neighbours that share its energy. */
static double closing_speed(const struct dem_inputs *in) {
  const double grain = in->grain.density * in->grain.spacing * in->grain.spacing;
  switch ((enum dem_kind)in->kind) {
  case DEM_DISC_EXPLOSION: return sqrt(2 * in->charge.energy / (6 * grain));
  case DEM_BLOCK_IMPACT: return in->impact.speed;
  case DEM_DISC_COLLISION: return in->collision.speed;
  case DEM_RING_EXPLOSION: /* its grains part */
  case DEM_UNIAXIAL:
  case DEM_COMPRESSION:
  case DEM_KINDS: break;
  }
  return 0;
}

static double passing_before(const void *inputs) {
  const double passing = dem_describe_passing_speed(inputs);
  return passing > 0 ? closing_speed(inputs) / passing : (double)NAN;
}

/* Bodies or grains that fly, without contacts. */
BEFORE(untouchable, !dem_inputs_loaded(in) && in->contact.law == DEM_CONTACT_OFF)

AFTER(passing_after, ONLY(run->passing_speed > 0, dem_system_now(run->system)->fastest_approach / run->passing_speed))

/* Share of the beams that broke before the end of the strains whose slope is the modulus of a block in compression. */
static double sloped(const struct condition_run *r) {
  const struct dem_run *run = r->run;
  const struct dem_results *results = r->results;
  if (run->inputs.kind != DEM_COMPRESSION)
    return NAN;
  const double end = dem_loading_slope_end(run);
  uint64_t broken = 0;
  for (size_t k = 0; k < run->state.frame.samples; k++)
    if (fabs(run->sample[k].strain) <= end)
      broken = run->sample[k].broken;
  return (double)broken / (double)results->beams;
}

/* Energy that contacts gave without having taken it: a lower bound with the printed law, where what contacts still
 * store hides a part. */
static double gain(const struct condition_run *r) {
  const struct dem_results *results = r->results;
  const struct dem_run *run = r->run;
  const struct dem_ledger ledger = dem_system_ledger(run->system);
  return (ledger.begun - fmin(ledger.contact, 0)) / results->energy_input;
}

/* Damping between joined grains without any damping. */
BEFORE(undamped, in->contact.law != DEM_CONTACT_OFF && in->contact.damping_bonded &&
                     !(in->contact.normal_damping > 0) &&
                     !(in->contact.tangential_damping > 0 && in->contact.friction > 0))

#define GIVEN(path, value) condition_given(&dem_inputs, path, value)

/* A modulus of overlaps, and no force of overlaps. */
static double unpressed(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return in->contact.law == DEM_CONTACT_OFF && GIVEN("grain.young_modulus", in->grain.young_modulus);
}

/* A rule of the end of breaking, and nothing breaks. */
static double unbreakable(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return !dem_inputs_loaded(in) && !in->threshold.breaking &&
         (GIVEN("stop.quiet_time", in->stop.quiet_time) || GIVEN("stop.least_time", in->stop.least_time));
}

/* One of friction and tangential damping without the other. */
BEFORE(alone, in->contact.law != DEM_CONTACT_OFF && (in->contact.friction > 0) != (in->contact.tangential_damping > 0))

/* ---- what a result needs to have happened ---- */

/* s, in which a wave crosses a free body; half of a ring's circumference. A ring that expands has turned back by then:
 * it does so after a quarter of 2 pi R sqrt(rho/E). */
static double crossing(const struct dem_inputs *in) {
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  const double longest = in->kind == DEM_BLOCK_IMPACT
                             ? fmax((double)in->body.columns, (double)in->body.rows) * in->grain.spacing
                         : field_is_off(in->body.wall) ? in->body.diameter
                                                       : M_PI / 2 * (in->body.diameter - in->body.wall);
  return longest / compression;
}

/* The time at which a wave has crossed the body once after the hit, over the simulated time. Circles round two discs
 * stand three grains apart at the start; rough discs may meet, and break, before the circles do.
 * fmin() leaves out a first break that is off. */
static double unfinished(const struct condition_run *r) {
  const struct dem_run *run = r->run;
  const struct dem_inputs *in = &run->inputs;
  if (dem_inputs_loaded(in) || !in->threshold.breaking)
    return NAN;
  const struct dem_results *results = r->results;
  double hit = 0;
  if (in->kind == DEM_DISC_COLLISION)
    hit = (dem_inputs_approach(in, in->body.diameter + 3 * in->grain.spacing) -
           dem_inputs_approach(in, in->body.diameter)) /
          in->collision.speed;
  return (fmin(hit, results->first_break) + crossing(in)) / r->outcome->time;
}

/* Momentum that one disc would give the other, by the force of now, while a wave crosses it; over that of its approach.
 */
static double pressing(const struct condition_run *r) {
  const struct dem_run *run = r->run;
  const struct dem_inputs *in = &run->inputs;
  double force[2] = {0, 0}, mass = 0, fx, fy, torque;
  for (uint32_t grain = 0; grain < run->tessellation->joined_at; grain++) { /* none of one body */
    dem_system_force(run->system, grain, &fx, &fy, &torque);
    force[0] += fx;
    force[1] += fy;
    mass += dem_system_grain(run->system, grain).mass;
  }
  return mass > 0 ? hypot(force[0], force[1]) * crossing(in) / (mass * in->collision.speed / 2) : (double)NAN;
}

BEFORE(quiet, dem_inputs_loaded(in) ? (double)NAN : fmax(in->stop.quiet_time, in->stop.least_time) / crossing(in))

BEFORE(grains, dem_inputs_loaded(in) ? (double)NAN : dem_inputs_grains(in))

/* Of a loaded block the columns or rows, whichever are fewer. A regular lattice has exact moduli with any number. */
static double across(const void *inputs) {
  const struct dem_inputs *in = inputs;
  const bool exact = in->kind == DEM_UNIAXIAL && !(in->grain.disorder > 0);
  return dem_inputs_loaded(in) && !exact ? fmin((double)in->body.columns, (double)in->body.rows) : (double)NAN;
}

AFTER(joined, (double)(r->outcome->fragment_count - r->outcome->single_count))

AFTER(cut, r->outcome->state == OUTCOME_END_TIME)

/* Crossings of the block by a wave while the sides move at full speed, up to a strain. They count one and a half
 * times where the ramp lasts two crossings: it leaves hardly any waves. */
static double crossings_to(const struct dem_inputs *in, double strain) {
  if (!dem_inputs_loaded(in))
    return NAN;
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  const bool pulled = in->kind == DEM_UNIAXIAL && in->loading.direction == DEM_EXTENSION;
  const double height = (double)in->body.rows * in->grain.spacing;
  const double duration = strain / in->loading.rate - in->loading.ramp / 2;
  const double crossing_time = height / (pulled ? extension : compression);
  return (in->loading.ramp >= 2 * crossing_time ? 1.5 : 1) * fmax(0, duration) / crossing_time;
}

BEFORE(crossings, crossings_to(in, in->loading.strain_end))

/* NaN: it did not fail. */
AFTER(crossings_to_failure, ONLY(results->broken > 0, crossings_to(in, results->failure_strain)))

/* Up to the failure of a block in compression, to the end of the slope under a uniaxial load. */
static double crossings_made(const struct condition_run *r) {
  const struct dem_inputs *in = r->inputs;
  const double to_failure = crossings_to_failure(r);
  if (in->kind == DEM_UNIAXIAL)
    return crossings_to(in, dem_loading_slope_end(r->run));
  return isnan(to_failure) ? crossings(in) : to_failure;
}

/* No block fails later. One of 12 x 20 grains fails at 0.9 to 2.4 % whether beams break at 0.1 or 2 %. */
BEFORE(crossings_at_most, ONLY(in->threshold.breaking, crossings(in)))

/* Change of the slope from the first half of its strains to the second one. */
AFTER(curved, ONLY(in->kind == DEM_UNIAXIAL, dem_loading_bend(run)))

BEFORE(amplitude, ONLY(in->kind == DEM_UNIAXIAL, in->loading.strain_end))

/* The last stress over the largest one: near 1 the block still bears its load. */
static double unbroken(const struct condition_run *r) {
  const struct dem_run *run = r->run;
  const size_t samples = run->state.frame.samples;
  if (!dem_inputs_loaded(&run->inputs) || !run->inputs.threshold.breaking || samples == 0)
    return NAN;
  return fabs(run->sample[samples - 1].stress) / run->state.stress_peak;
}

AFTER(whole, dem_inputs_loaded(in) && results->broken == 0)

#define OF_THE_LARGEST "largest_fraction second_fraction mean_fragment_mass mean_fragment_mass_rest"

const struct condition dem_conditions[] = {
    CONDITION("drift", .number = "the energy error, over the energy put in,", .bound = CONDITION_LARGEST_DRIFT,
              .doubt = "numerical errors made or lost more than 1 % of the energy",
              .reason = "our choice; the scene's fidelity.energy_bound may allow more",
              .remedy = "give a shorter fidelity.time_step", .lasting = true, .after = drift),
    CONDITION(
        "passing",
        .number =
            "the speed at which grains without a beam meet, over the speed at which they pass through each other,",
        .bound = 1, .doubt = "no overlap stores that much energy, so the model has no answer",
        .reason = "energy of the largest overlap (engine/dem/README.md)",
        .remedy = "lower the speed, or raise grain.young_modulus", .before = passing_before, .after = passing_after),
    CONDITION("passing", .fact = "grains fly with contact.law: off",
              .doubt = "grains and bodies pass through each other",
              .reason = "without a beam, grains act on each other by contacts only",
              .remedy = "set contact.law: conservative", .before = untouchable),
    CONDITION("step", .number = "fidelity.time_step over the longest stable step", .bound = 0.25,
              .doubt = "energy may drift",
              .reason = "Verlet's energy drifts by 1 % in some runs from 0.28 on (tests/extremes/map.md)",
              .remedy = "give a fidelity.time_step of a tenth of the stable step", .before = step_before,
              .beside = step_estimated, .after = step_after),
    CONDITION("turn", .number = "the error of the angular momentum", .bound = 0.01,
              .doubt = "bodies turn by numerical errors", .reason = "our choice, as for the energy error",
              .remedy = "give a shorter fidelity.time_step", .after = angular),
    CONDITION("damping", .number = "contact damping times fidelity.time_step", .bound = 0.05,
              .doubt = "the integrator does not resolve the damping",
              .reason = "some runs drift by 1 % from 0.1 on (tests/extremes/map.md)",
              .remedy = "give a shorter fidelity.time_step, or less damping", .before = damping),
    CONDITION("gain", .number = "the energy that contacts gave without having taken it, over the energy put in,",
              .bound = CONDITION_LARGEST_DRIFT,
              .doubt = "contact.law printed and contact.bonded false can make energy, which counts as work",
              .reason = "as for the energy error", .remedy = "set contact.law: conservative and contact.bonded: true",
              .after = gain),
    CONDITION("effect", .fact = "one of contact.friction and contact.tangential_damping is given without the other",
              .doubt = "it has no effect: friction bounds the force of tangential damping", .reason = "K99 eq. 4",
              .remedy = "give both, or none", .inputs = "contact.friction contact.tangential_damping", .results = "",
              .before = alone),
    CONDITION("effect", .fact = "grain.young_modulus is given with contact.law: off",
              .doubt = "it has no effect: overlapping grains do not repel each other", .reason = "K99 eqs. 1 and 2",
              .remedy = "leave it out, or set another contact.law", .inputs = "grain.young_modulus", .results = "",
              .before = unpressed),
    CONDITION("effect", .fact = "stop.quiet_time or stop.least_time is given with threshold.breaking: false",
              .doubt = "it has no effect: the run goes on to stop.end_time",
              .reason = "they count from the first break", .remedy = "leave it out",
              .inputs = "stop.quiet_time stop.least_time", .results = "", .before = unbreakable),
    CONDITION("effect", .fact = "contact.damping_bonded is on, and there is no damping",
              .doubt = "it has no effect: there is no damping", .reason = "K99 eqs. 3 and 4",
              .remedy = "give contact.normal_damping, or contact.tangential_damping and contact.friction",
              .inputs = "contact.damping_bonded", .results = "", .before = undamped),
    CONDITION("grains", .number = "the number of grains", .bound = 20, .least = true,
              .doubt = "shares of the mass go by steps of a grain, and most grains lie at the surface",
              .reason = "our choice", .remedy = "take a larger body, or a smaller grain.spacing", .before = grains),
    CONDITION("grains", .number = "the number of columns or rows of the block, the fewer ones,", .bound = 8,
              .least = true, .doubt = "the sides of the block are stiffer than its middle, and are most of it",
              .reason =
                  "Young's modulus is 10, 7 and 3 % above that of 12 x 20 with 4 x 4, 5 x 6 and 8 x 12 grains, the "
                  "strength in compression 40 % above it with 6 x 8",
              .remedy = "give more body.columns and body.rows",
              .results = "young_modulus poisson_ratio strength failure_strain upright_share end_triangle_share",
              .before = across),
    CONDITION("single", .number = "the number of fragments of two grains or more", .bound = 1, .least = true,
              .doubt = "the body is gone to single grains, which cannot break",
              .reason = "the model has nothing smaller than a grain", .remedy = "take a smaller grain.spacing",
              .results = OF_THE_LARGEST, .after = joined),
    CONDITION("cut", .fact = "stop.end_time ended the run while beams broke",
              .doubt = "more beams may break after that",
              .reason = "disc-explosion of 14 cm at 2 kJ/m: M_1/M is 0.96 after 1 ms and 0.65 after 20 ms",
              .remedy = "raise stop.end_time", .after = cut),
    CONDITION("early", .number = "the time that a wave needs to cross the body after the hit, over the simulated time,",
              .bound = 1, .doubt = "the run ended before all of the body could break",
              .reason = "a body can break from the hit until a wave has crossed it",
              .remedy = "give a longer stop.end_time", .after = unfinished),
    CONDITION("pressing",
              .number = "the momentum that one disc would give the other while a wave crosses it, over its own,",
              .bound = 0.01, .doubt = "the discs still press on each other: their speeds and fragments are not final",
              .reason = "discs that have parted have 0", .remedy = "give a longer stop.least_time and stop.end_time",
              .after = pressing),
    CONDITION(
        "load",
        .number = "the number of times that a wave crosses the block while its sides move at full speed, up to the "
                  "first break (uniaxial) or to failure (compression),",
        .bound = 3, .least = true,
        .doubt = "the load is not quasi-static: inertia of the block is measured, not its stiffness",
        .reason =
            "blocks of three heights and stiffnesses, both directions, disorder 0 to 1: from 3 on Young's modulus is "
            "within 3.5 %, Poisson's ratio within 0.05; a square lattice is off by 24 % at 0.7 and by any "
            "factor below. The number counts 1.5 times after a ramp of two crossings or more: within 1.3 % "
            "and 0.01 then",
        .remedy = "lower loading.rate; where no beam breaks, raise loading.strain_end, else threshold.strain",
        .results = "young_modulus poisson_ratio", .before = crossings, .after = crossings_made),
    CONDITION(
        "rapid", .number = "the number of times that a wave crosses the block until it fails", .bound = 10,
        .least = true, .doubt = "the block fails before waves have spread the load: it seems stronger",
        .reason =
            "blocks of 12 x 20 grains (4 seeds) are 5, 11 and 15 % stronger at 10, 7 and 5.5 than at 70 to 80; "
            "those of 25 x 40 grains (2 seeds) 2, 11 and 18 % at 7, 5 and 4 than at 14, where they may be "
            "8 % stronger than at 30; free to slide, 15 and 7 % at 8 and 15 than at 65, pulled 4 % at 6 than at 30",
        .remedy = "lower loading.rate", .results = "strength failure_strain upright_share end_triangle_share",
        .if_so = "the block fails", .before = crossings_at_most, .after = crossings_to_failure),
    CONDITION(
        "quiet",
        .number = "the longer of stop.quiet_time and stop.least_time over the time in which a wave crosses the body",
        .bound = 1, .least = true, .doubt = "the run may end before waves have come to all beams",
        .reason = "after that time all of the body has been loaded once", .remedy = "leave both out", .before = quiet),
    CONDITION("broken", .number = "the share of the beams that broke before half of the strain at failure",
              .bound = 0.01, .doubt = "the block is no longer whole where its slope is taken",
              .reason = "12 x 20 grains: a share of 0.006 moves Young's modulus by 0.1 %, Poisson's ratio by 0.01",
              .remedy = "raise the thresholds, or lower loading.rate", .results = "young_modulus poisson_ratio",
              .withheld = true, .after = sloped),
    CONDITION("amplitude", .number = "loading.strain_end", .bound = 0.1,
              .doubt = "the stress does not grow in proportion to so large a strain: the slope is a mean over it",
              .reason = "uniaxial at 10 %: 1.7 % off for Young's modulus, 5 % for Poisson's ratio; 6 % at 40 %",
              .remedy = "lower loading.strain_end", .results = "young_modulus poisson_ratio", .before = amplitude),
    CONDITION("curved", .number = "the change of Young's modulus between the halves of the strains", .bound = 0.1,
              .doubt = "the stress does not grow in proportion to the strain: the block may have buckled",
              .reason = "the mean slope is then 5 % off; waves change it by up to 9 % at three crossings",
              .remedy = "lower loading.strain_end", .results = "young_modulus poisson_ratio", .after = curved),
    CONDITION("event", .number = "the last stress over the largest one", .bound = 0.9,
              .doubt = "the block has not failed: the largest stress so far is no strength", .reason = "our choice",
              .remedy = "raise loading.strain_end",
              .results = "strength failure_strain upright_share end_triangle_share", .withheld = true,
              .after = unbroken),
    CONDITION("elastic", .fact = "no beam of the block broke",
              .doubt = "the largest stress is that of the last strain or of a wave, and no strength",
              .reason = "a strength is a failure",
              .remedy = "set threshold.breaking: true, and raise loading.strain_end until beams break",
              .results = "strength failure_strain", .withheld = true, .absent = true, .after = whole),
    {0},
};
