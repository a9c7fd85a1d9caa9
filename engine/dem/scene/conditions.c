/* Conditions under which results of engine dem are valid (engine/condition.h). */
#include <math.h>

#include "engine/condition.h"
#include "engine/dem/run/run.h"

static const struct dem_run *run_of(const struct condition_run *r) {
  return r->run;
}

/* ---- the integration ---- */

static double drift(const struct condition_run *r) {
  return r->outcome->energy_error;
}

static double step_before(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return in->fidelity.time_step / dem_describe_stable_step(in);
}

static double step_after(const struct condition_run *r) {
  return run_of(r)->inputs.fidelity.time_step / run_of(r)->stable_time_step;
}

static double damping(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return dem_describe_damping(in) * in->fidelity.time_step;
}

static double angular(const struct condition_run *r) {
  return ((const struct dem_results *)r->results)->angular_momentum_error;
}

/* ---- contacts ---- */

/* Fastest approach that the inputs themselves set up, m/s: of a charge, six equal neighbours that share its energy. */
static double closing_speed(const struct dem_inputs *in) {
  const double grain = in->grain.density * in->grain.spacing * in->grain.spacing;
  switch ((enum dem_kind)in->kind) {
  case DEM_DISC_EXPLOSION: return sqrt(2 * in->charge.energy / (6 * grain));
  case DEM_BLOCK_IMPACT: return in->impact.speed;
  case DEM_DISC_COLLISION: return in->collision.speed;
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

static double passing_after(const struct condition_run *r) {
  const struct dem_run *run = run_of(r);
  return run->passing_speed > 0 ? dem_system_fastest_approach(run->system) / run->passing_speed : (double)NAN;
}

/* Energy that contacts gave without having taken it: a lower bound with the printed law, where what contacts still
 * store hides a part. */
static double gain(const struct condition_run *r) {
  const struct dem_results *results = r->results;
  const struct dem_ledger ledger = dem_system_ledger(run_of(r)->system);
  return (ledger.begun - fmin(ledger.contact, 0)) / results->energy_input;
}

/* One of friction and tangential damping without the other. */
static double alone(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return in->contact.law != DEM_CONTACT_OFF && (in->contact.friction > 0) != (in->contact.tangential_damping > 0);
}

/* ---- what a result needs to have happened ---- */

/* s, in which a wave crosses a free body. */
static double crossing(const struct dem_inputs *in) {
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  const double longest = in->kind == DEM_BLOCK_IMPACT
                             ? fmax((double)in->body.columns, (double)in->body.rows) * in->grain.spacing
                             : in->body.diameter;
  return longest / compression;
}

/* The time at which a wave has crossed the body once after the hit, over the simulated time; of a run in which nothing
 * broke. Circles round two discs stand three grains apart at the start. */
static double unfinished(const struct condition_run *r) {
  const struct dem_run *run = run_of(r);
  const struct dem_inputs *in = &run->inputs;
  const struct dem_results *results = r->results;
  if (dem_inputs_loaded(in) || results->broken > 0)
    return NAN;
  const double gap = in->kind == DEM_DISC_COLLISION ? 3 * in->grain.spacing / in->collision.speed : 0;
  return (gap + crossing(in)) / r->outcome->time;
}

static double quiet(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return dem_inputs_loaded(in) ? (double)NAN : fmax(in->stop.quiet_time, in->stop.least_time) / crossing(in);
}

/* Crossings of the block by a wave while the sides move at full speed, up to a strain. */
static double crossings_to(const struct dem_inputs *in, double strain) {
  if (!dem_inputs_loaded(in))
    return NAN;
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  const bool pulled = in->kind == DEM_UNIAXIAL && in->loading.direction == DEM_EXTENSION;
  const double height = (double)in->body.rows * in->grain.spacing;
  const double duration = strain / in->loading.rate - in->loading.ramp / 2;
  return fmax(0, duration) * (pulled ? extension : compression) / height;
}

static double crossings(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return crossings_to(in, in->loading.strain_end);
}

/* Of a block that failed, up to its failure. */
static double crossings_to_failure(const struct condition_run *r) {
  const struct dem_inputs *in = r->inputs;
  const double strain = ((const struct dem_results *)r->results)->failure_strain;
  return in->kind == DEM_COMPRESSION && strain > 0 ? crossings_to(in, strain) : crossings(in);
}

/* The last stress over the largest one: near 1 the block still bears its load. */
static double unbroken(const struct condition_run *r) {
  const struct dem_run *run = run_of(r);
  const size_t samples = run->state.frame.samples;
  if (run->inputs.kind != DEM_COMPRESSION || samples == 0)
    return NAN;
  return -run->sample[samples - 1].stress / run->state.stress_peak;
}

const struct condition dem_conditions[] = {
    CONDITION("drift", .number = "the error of the energy ledger, over the energy put in,",
              .bound = CONDITION_LARGEST_DRIFT, .doubt = "numerical errors made or lost more than 1 % of the energy",
              .reason = "our choice; the scene's fidelity.energy_bound may allow more",
              .remedy = "give a shorter fidelity.time_step", .after = drift),
    CONDITION(
        "passing",
        .number =
            "the speed at which grains without a beam meet, over the speed at which they pass through each other,",
        .bound = 1, .doubt = "no overlap stores that much energy, so the model has no answer",
        .reason = "energy of the largest overlap (engine/dem/README.md)",
        .remedy = "lower the speed, or raise grain.young_modulus", .before = passing_before, .after = passing_after),
    CONDITION("step", .number = "fidelity.time_step over the longest stable step", .bound = 0.25,
              .doubt = "energy may drift",
              .reason = "Verlet's energy drifts by 1 % in some runs from 0.28 on (tests/extremes/map.md)",
              .remedy = "give a fidelity.time_step of a tenth of the stable step", .before = step_before,
              .after = step_after),
    CONDITION("turn", .number = "the error of the angular momentum", .bound = 0.01,
              .doubt = "bodies turn by numerical errors", .reason = "our choice, as for the energy ledger",
              .remedy = "give a shorter fidelity.time_step", .after = angular),
    CONDITION("damping", .number = "contact damping times fidelity.time_step", .bound = 0.05,
              .doubt = "the integrator does not resolve the damping",
              .reason = "some runs drift by 1 % from 0.1 on (tests/extremes/map.md)",
              .remedy = "give a shorter fidelity.time_step, or less damping", .before = damping),
    CONDITION("gain", .number = "the energy that contacts gave without having taken it, over the energy put in,",
              .bound = CONDITION_LARGEST_DRIFT,
              .doubt = "contact.law printed and contact.bonded false can make energy, which the ledger books as work",
              .reason = "as for the energy ledger", .remedy = "set contact.law: conservative and contact.bonded: true",
              .after = gain),
    CONDITION("effect", .number = "one of contact.friction and contact.tangential_damping without the other",
              .bound = 0, .doubt = "it has no effect: friction bounds the force of tangential damping",
              .reason = "K99 eq. 4", .remedy = "give both, or none", .results = "", .before = alone),
    CONDITION("early", .number = "the time that a wave needs to cross the body after the hit, over the simulated time,",
              .bound = 1, .doubt = "the run ended before anything could break",
              .reason = "a body can break from the hit until a wave has crossed it",
              .remedy = "give a longer stop.end_time", .after = unfinished),
    CONDITION("load", .number = "the number of times that a wave crosses the block while its sides move at full speed",
              .bound = 3, .least = true,
              .doubt = "the load is not quasi-static: inertia of the block is measured, not its stiffness",
              .reason = "Young's modulus of a square lattice, measured on 28 loads: within 2.1 % from 3 on, within 5 % "
                        "from 2.2 on, "
                        "off by 24 % at 0.7 and by any factor below",
              .remedy = "lower loading.rate, or raise loading.strain_end",
              .results = "young_modulus poisson_ratio strength failure_strain upright_share end_triangle_share",
              .before = crossings, .after = crossings_to_failure),
    CONDITION(
        "quiet",
        .number = "the longer of stop.quiet_time and stop.least_time over the time in which a wave crosses the body",
        .bound = 1, .least = true, .doubt = "the run may end before waves have come to all beams",
        .reason = "after that time all of the body has been loaded once", .remedy = "leave both out", .before = quiet),
    CONDITION("event", .number = "the last stress over the largest one", .bound = 0.9,
              .doubt = "the block has not failed: the largest stress so far is no strength", .reason = "our choice",
              .remedy = "raise loading.strain_end",
              .results = "strength failure_strain upright_share end_triangle_share", .withheld = true,
              .after = unbroken),
    {0},
};
