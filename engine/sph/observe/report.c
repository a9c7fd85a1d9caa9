/* From the final state to the outcome, the results and the fragments. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/mesh/mesh.h"
#include "engine/sph/material/material.h"
#include "engine/sph/modules/module.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "engine/vector3.h"

/* `link_h` of the inputs; parts of a rod count as separate when each is more than 1/ROD_PARTS of it. */
enum { ROD_PARTS = 100 };

/* The fragments of `particles`: those of the run as they are now, or as they were at the start. */
static status fragments_of(const struct sph_run *run, const struct sph_particles *particles, double static_strength,
                           bool layer, struct sph_fragments *out, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  if (!sph_derived_cracks(&in->target)) /* other damage is no crack */
    static_strength = NAN;
  const struct sph_fragments_body bodies[SPH_RUN_BODIES] = {
      {.static_strength = static_strength},
      {.left_out = sph_derived_has_intruder(in), .static_strength = static_strength},
  };
  struct sph_fragments_options options = sph_fragments_default();
  options.damage = in->fragments.damage;
  options.link_length = in->fragments.link_length;
  options.layer_width = in->fragments.layer_width;
  options.layer = layer;
  options.whole_shear = !sph_modules_damage_scales_shear(&in->target, in);
  options.h = in->fragments.link_h == SPH_LINK_H_INITIAL ? run->start->h : NULL;
  memcpy(options.periodic, run->periodic, sizeof options.periodic);
  options.bodies = bodies;
  options.body_count = (size_t)run->body_count;
  return sph_fragments_find(particles, &options, out, error);
}

status sph_report_fragments(const struct sph_run *run, double static_strength, bool layer, struct sph_fragments *out,
                            struct error *error) {
  return fragments_of(run, run->now, static_strength, layer, out, error);
}

static status find_gaps(struct sph_run *run, struct error *error) {
  const size_t bodies = (size_t)run->body_count - sph_derived_has_intruder(&run->inputs);
  size_t pieces = bodies;
  for (size_t k = 0; k < bodies; k++) /* a surface from a file may have several parts */
    pieces += run->shape[k].mesh ? run->shape[k].mesh->parts - 1 : 0;
  SPH_FRAGMENTS found = {0};
  TRY(fragments_of(run, run->start, NAN, true, &found, error));
  run->has_gaps = found.count > pieces;
  return STATUS_OK;
}

static double norm(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double largest_share(const struct sph_fragments *found) {
  return sph_results_share(found->count ? found->fragments[0].mass : 0, found->mass);
}

static status find_largest_share(const struct sph_run *run, double static_strength, double *share,
                                 struct error *error) {
  SPH_FRAGMENTS found = {0};
  TRY(sph_report_fragments(run, static_strength, true, &found, error));
  *share = largest_share(&found);
  return STATUS_OK;
}

/* Is the k-th fragment heavy enough to have a shape and a motion of its own? */
static bool is_measured(const struct sph_fragments *found, size_t k) {
  return k < found->count && found->fragments[k].count >= SPH_FRAGMENTS_MEASURED;
}

/* M_1/M by three rules. `found`: by the rules of the inputs. */
static status report_largest(const struct sph_run *run, const struct sph_fragments *found, struct sph_results *results,
                             struct error *error) {
  double strength = run->inputs.fragments.static_strength;
  results->largest.bare_fraction = sph_results_share(found->core_largest, found->mass);
  results->largest.veneer_fraction = largest_share(found);
  if (!run->inputs.fragments.veneer)
    TRY(find_largest_share(run, strength, &results->largest.veneer_fraction, error));
  results->largest.dynamic_fraction = results->largest.veneer_fraction;
  if (!field_is_off(strength))
    TRY(find_largest_share(run, NAN, &results->largest.dynamic_fraction, error));

  results->largest.axis_middle = sph_results_finite(found->axis_ratio[0]);
  results->largest.axis_short = sph_results_finite(found->axis_ratio[1]);
  if (is_measured(found, 0))
    results->largest.speed = sph_results_finite(norm(found->fragments[0].velocity));
  return STATUS_OK;
}

static void report_second(const struct sph_run *run, const struct sph_fragments *found, struct sph_results *results) {
  if (found->count < 2)
    return;
  const struct fragment *f = &found->fragments[1];
  results->second.mass = f->mass;
  if (run->inputs.kind != SPH_IMPACT || !is_measured(found, 1))
    return;

  double centre[3] = {0, 0, 0}, away[3];
  for (size_t k = 0; k < found->count; k++)
    for (int d = 0; d < 3; d++)
      centre[d] += found->fragments[k].mass * found->fragments[k].position[d] / found->mass;
  for (int d = 0; d < 3; d++)
    away[d] = f->position[d] - centre[d];
  double cosine = away[2] / norm(away); /* with the line from the target's centre to the point of impact */
  if (cosine > 1)                       /* not fmin(), which turns NaN into 1 */
    cosine = 1;
  if (cosine < -1)
    cosine = -1;
  results->second.angle = sph_results_finite(acos(cosine));
}

/* The largest fragment is left out: it is what is left of the body, with the body's shape. */
static void report_shapes(const struct sph_fragments *found, struct sph_results *results) {
  double middle = 0, shortest = 0;
  results->shapes.shaped = 0;
  for (size_t k = 1; k < found->count; k++) {
    const double *length = found->fragments[k].length;
    if (!(length[0] > 0))
      continue;
    results->shapes.shaped++;
    middle += length[1] / length[0];
    shortest += length[2] / length[0];
  }
  results->shapes.b_over_a = sph_results_share(middle, (double)results->shapes.shaped);
  results->shapes.c_over_a = sph_results_share(shortest, (double)results->shapes.shaped);
}

/* Means over the target by mass. */
static void report_damage(const struct sph_run *run, struct sph_results *results) {
  const struct sph_particles *p = run->now;
  double mass = 0, damage = 0, undamaged = 0;
  for (size_t i = 0; i < run->targets; i++) {
    double d = sph_particles_damage(p, i);
    mass += p->mass[i];
    damage += p->mass[i] * d;
    undamaged += d < run->inputs.fragments.damage ? p->mass[i] : 0;
  }
  results->mean_damage = sph_results_share(damage, mass);
  results->undamaged_fraction = sph_results_share(undamaged, mass);
}

static status report_stretch(const struct sph_run *run, struct sph_results *results, struct error *error) {
  SPH_FRAGMENTS found = {0};
  TRY(sph_report_fragments(run, NAN, false, &found, error));
  size_t parts = 0;
  for (size_t k = 0; k < found.count; k++)
    parts += found.fragments[k].mass * ROD_PARTS > found.mass;
  results->cracks = parts ? (double)parts - 1 : 0;
  if (run->state.peak_stress > 0) {
    results->peak.stress = run->state.peak_stress;
    results->peak.strain = run->state.peak_strain;
    results->peak.time = run->state.peak_time;
  }
  return STATUS_OK;
}

static double rebound(const struct sph_run *run) {
  double speed[SPH_RUN_BODIES] = {0, 0};
  for (int b = 0; b < SPH_RUN_BODIES; b++) {
    double mass = 0;
    for (size_t i = run->range[b].first; i < run->range[b].first + run->range[b].n; i++) {
      speed[b] += run->now->mass[i] * run->now->vx[i];
      mass += run->now->mass[i];
    }
    speed[b] /= mass;
  }
  return sph_results_finite((speed[1] - speed[0]) / run->inputs.collision.speed);
}

/* The axis of an oblique impact is not followed. */
struct sph_crater_options sph_report_crater_options(const struct sph_run *run) {
  const struct sph_inputs *in = &run->inputs;
  double point[3];
  struct sph_crater_options options = {.first = run->range[0].first,
                                       .count = run->range[0].n,
                                       .mass = run->range[0].mass,
                                       .spacing = sph_derived_fine_spacing(in),
                                       .graded = in->fidelity.graded,
                                       .ejection_speed = in->crater.ejection_speed,
                                       .escape_speed = in->crater.escape_speed};
  sph_bodies_face(&run->shape[0], point, options.frame);
  for (int k = 0; k < 2; k++)
    options.axis[k] = vector3_dot(point, options.frame[k]);
  return options;
}

/* kg m/s, along the outward normal, of the projectile's matter that moves outwards and escapes: a body that rebounds
 * may be slower than crater.ejection_speed. */
static double carried_back(const struct sph_run *run, const struct sph_crater_options *options) {
  double sum = 0;
  for (size_t i = run->range[1].first; i < run->range[1].first + run->range[1].n; i++) {
    const double outwards = sph_crater_outwards(run->now, i, options);
    if (outwards > 0 && !(sph_crater_speed(run->now, i) < options->escape_speed))
      sum += run->now->mass[i] * outwards;
  }
  return sum;
}

/* The results that only one protocol has. */
static status report_protocol(const struct sph_run *run, struct sph_results *results, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  struct sph_crater_options options;
  switch (in->kind) {
  case SPH_STRETCH: return report_stretch(run, results, error);
  case SPH_IMPACT:
    options = sph_report_crater_options(run);
    TRY(sph_crater_measure(run->start, run->now, &options, results, error));
    results->ejecta.momentum_enhancement = sph_results_finite(
        1 + (results->ejecta.momentum + carried_back(run, &options)) /
                (run->range[1].mass * in->impact.speed * cos(in->impact.angle)));
    return STATUS_OK;
  case SPH_COLLISION: results->rebound = rebound(run); return STATUS_OK;
  case SPH_PISTON: sph_plate_report(run, results); return STATUS_OK;
  case SPH_VIBRATION: /* half a period between two crossings of zero */
    if (run->state.crossings > 1)
      results->frequency = (double)(run->state.crossings - 1) /
                           (2 * (run->state.crossing_last - run->state.crossing_first));
    return STATUS_OK;
  default: return STATUS_OK;
  }
}

/* The scale of momentum errors: the larger sum of momenta, at the start or now. Bodies that stop each other do not make
 * a small error look large. */
static double momentum_scale(const struct sph_run *run, const struct sph_ledger *ledger) {
  return fmax(ledger->momentum_scale, run->state.momentum_scale_start);
}

/* Energies, clamps and the error of angular momentum. `input`: energy put in, J. */
static void report_ledger(const struct sph_run *run, const struct sph_ledger *ledger, double input,
                          struct sph_results *results) {
  results->energy.kinetic = sph_results_finite(ledger->kinetic);
  results->energy.internal = sph_results_finite(ledger->internal);
  results->energy.damped = sph_results_finite(ledger->damped);
  results->energy.work_of_held = sph_results_finite(ledger->work_of_held);
  results->energy.clamped = sph_results_finite(ledger->clamped);
  results->energy_input = sph_results_finite(input);
  results->clamped_share = sph_results_share(fabs(ledger->clamped), sph_run_energy_available(run, ledger));

  double change[3];
  for (int k = 0; k < 3; k++) { /* it is conserved about axis k where both other directions are open */
    const bool conserved = isnan(run->periodic[(k + 1) % 3]) && isnan(run->periodic[(k + 2) % 3]);
    change[k] = conserved ? ledger->angular_momentum[k] - run->state.angular_start[k] : 0;
  }
  double scale = fmax(norm(run->state.angular_start), momentum_scale(run, ledger) * sph_run_extent(run));
  if (sph_run_keeps_momentum(run))
    results->angular_momentum_error = sph_results_share(norm(change), scale);
}

static void report_steps(const struct sph_run *run, const struct sph_ledger *ledger, struct sph_results *results) {
  double steps = (double)run->system->now.steps;
  const uint64_t *by = run->state.limited;
#define TIME_STEP_LIMIT(NAME, member, doc)                                                                             \
  results->limited.member = sph_results_share((double)by[SPH_LIMIT_##NAME], steps);
#include "engine/sph/modules/declarations.h"
  results->density_held_share = sph_results_share((double)ledger->density_held, steps * (double)run->start->n);
  results->neighbours = sph_results_finite(run->system->now.neighbours);
}

#define SPH_MODULE_REPORT
#include "engine/sph/modules/declarations.h"

/* The results of modules that a body of the run has. */
static void report_modules(const struct sph_run *run, struct sph_results *results) {
  struct sph_module_set modules = {0};
  for (size_t b = 0; b < run->system->body_count; b++)
    set_unite(modules.word, run->system->solid[b].modules.word, SPH_MODULES);
#define MODULE_REPORT(name)                                                                                            \
  if (set_has(modules.word, SPH_MODULE_##name))                                                                        \
    name##_report(run, results);
#include "engine/sph/modules/declarations.h"
}

static status fill_results(const struct sph_run *run, const struct sph_ledger *ledger, double input,
                           const struct sph_fragments *found, struct sph_results *results, struct error *error) {
  field_defaults(&sph_results, results); /* every quantity is off or zero */
  results->stop_reason = run->state.frame.stop;
  results->particles = (int64_t)run->targets;
  results->projectile_particles = (int64_t)(run->start->n - run->targets);
  results->flaws = (int64_t)run->flaw_count;
  results->target_mass = found->mass;
  if (sph_derived_has_projectile(&run->inputs)) {
    double speed = run->inputs.impact.speed;
    results->projectile_mass = run->range[1].mass;
    results->specific_energy = sph_results_finite(0.5 * run->range[1].mass * speed * speed / run->range[0].mass);
  }
  const bool quiet = run->state.frame.stop == SPH_STOP_QUIET, broke = !isnan(run->state.first_damage);
  results->fracture_ceased = quiet || (run->state.frame.stop == SPH_STOP_END_TIME && !broke);
  results->first_damage = run->state.first_damage;
  if (quiet)
    results->cease_time = run->state.quiet_since;
  report_damage(run, results);
  report_second(run, found, results);
  report_shapes(found, results);
  report_ledger(run, ledger, input, results);
  report_steps(run, ledger, results);
  TRY(report_largest(run, found, results, error));
  TRY(report_protocol(run, results, error));
  report_modules(run, results);
  return STATUS_OK;
}

/* kg, the heaviest particle of all fragments, or of those after the largest one. */
static double heaviest(const struct sph_run *run, const struct sph_fragments *found, bool off) {
  double most = 0;
  for (size_t i = 0; i < run->targets; i++)
    if (!off || found->label[i] > 0)
      most = fmax(most, run->now->mass[i]);
  return most;
}

static void fill_outcome(const struct sph_run *run, const struct sph_ledger *ledger, double input,
                         const struct sph_fragments *found, struct outcome *outcome) {
  *outcome = frame_outcome(&run->frame,
                           isfinite(run->state.smallest_step) ? run->state.smallest_step : run->system->now.last_step);
  const double n = (double)run->targets; /* as if all were the heaviest */
  const double mass = sph_derived_is_graded(&run->inputs) ? n * heaviest(run, found, false) : found->mass;
  const struct outcome_small small = {.dust = run->inputs.fragments.dust_mass,
                                      .complete = (SPH_FRAGMENTS_COMPLETE - 0.5) * mass / n};
  outcome_fragments(outcome, found->count, found->fragments, &small);

  double change[3], translation = 0;
  for (int k = 0; k < 3; k++)
    change[k] = ledger->momentum[k] - run->state.momentum_start[k];
  for (size_t k = 0; k < found->count; k++) {
    double v = norm(found->fragments[k].velocity);
    translation += 0.5 * found->fragments[k].mass * v * v;
  }
  outcome->energy_error = sph_results_share(fabs(sph_run_closed(ledger) - run->state.frame.closed_start),
                                            sph_run_energy_available(run, ledger));
  outcome->kinetic_energy_share = sph_results_share(translation, input);
  outcome->momentum_error = sph_run_keeps_momentum(run) ? sph_results_share(norm(change), momentum_scale(run, ledger))
                                                        : (double)NAN;
}

status sph_report_finish(void *of, struct outcome *outcome, void *results, struct fragment **fragments, size_t *count,
                         struct error *error) {
  struct sph_run *run = of;
  *fragments = NULL;
  *count = 0;
  sph_run_read(run);
  const struct sph_inputs *in = &run->inputs;
  SPH_FRAGMENTS found = {0};
  TRY(sph_report_fragments(run, in->fragments.static_strength, in->fragments.veneer, &found, error));

  struct sph_ledger ledger = sph_system_ledger(run->system);
  double input = run->state.frame.energy_input + fabs(ledger.work_of_held);
  TRY(fill_results(run, &ledger, input, &found, results, error));
  fill_outcome(run, &ledger, input, &found, outcome);
  TRY(find_gaps(run, error));
  run->heaviest_off = heaviest(run, &found, true);
  const struct condition_run end = {run, in, outcome, results, !run->state.frame.finished};
  condition_after(sph_conditions, &end, outcome->warnings, sizeof outcome->warnings);
  *fragments = found.fragments;
  *count = found.count;
  found.fragments = NULL;
  return STATUS_OK;
}
