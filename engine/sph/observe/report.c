/* From the final state to the outcome, the results and the fragments. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/observe/plate.h"
#include "engine/sph/scene/derived.h"

enum { INITIAL_H = 0, PIECE = 100 }; /* a piece of a rod is more than 1/PIECE of it */

status sph_report_pieces(const struct sph_run *run, double static_strength, bool veneer, struct sph_fragments *pieces,
                         struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  const struct sph_fragments_body bodies[SPH_RUN_BODIES] = {
      {.static_strength = static_strength},
      {.left_out = sph_derived_has_intruder(in), .static_strength = static_strength},
  };
  struct sph_fragments_options options = sph_fragments_default();
  options.damage = in->fragments.damage;
  options.link_length = in->fragments.link_length;
  options.veneer = veneer;
  options.h = in->fragments.link_h == INITIAL_H ? run->start->h : NULL;
  memcpy(options.periodic, run->periodic, sizeof options.periodic);
  options.bodies = bodies;
  options.body_count = (size_t)run->body_count;
  return sph_fragments_find(run->now, &options, pieces, error);
}

static double not_infinite(double value) {
  return isfinite(value) ? value : (double)NAN;
}
/* As it is: a part is summed in the order of the whole, so that roundings do not lift it above; a share that is not
 * within 0..1 is an error of the sums, which `clast check` names. */
static double share(double part, double whole) {
  return whole > 0 ? not_infinite(part / whole) : (double)NAN;
}
static double norm(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
static double largest_mass(const struct sph_fragments *pieces) {
  return pieces->count ? pieces->fragments[0].mass : 0;
}

/* M_1/M by the three recipes; `asked` is the one of the inputs. */
static status variants(const struct sph_run *run, const struct sph_fragments *asked, struct sph_results *results,
                       struct error *error) {
  double strength = run->inputs.fragments.static_strength;
  struct sph_fragments other;
  status code = STATUS_OK;
  results->largest.bare_fraction = share(asked->bare_largest, asked->mass);
  results->largest.veneer_fraction = share(largest_mass(asked), asked->mass);
  if (!run->inputs.fragments.veneer) {
    if ((code = sph_report_pieces(run, strength, true, &other, error)))
      return code;
    results->largest.veneer_fraction = share(largest_mass(&other), other.mass);
    sph_fragments_clear(&other);
  }
  results->largest.dynamic_fraction = results->largest.veneer_fraction;
  if (!field_is_off(strength)) {
    if ((code = sph_report_pieces(run, NAN, true, &other, error)))
      return code;
    results->largest.dynamic_fraction = share(largest_mass(&other), other.mass);
    sph_fragments_clear(&other);
  }
  return code;
}

static void second(const struct sph_run *run, const struct sph_fragments *pieces, struct sph_results *results) {
  if (pieces->count < 2)
    return;
  const struct fragment *f = &pieces->fragments[1];
  results->second.mass = f->mass;
  if (run->inputs.kind != SPH_IMPACT)
    return;
  double centre[3] = {0, 0, 0}, away[3], cosine = 0;
  for (size_t k = 0; k < pieces->count; k++)
    for (int d = 0; d < 3; d++)
      centre[d] += pieces->fragments[k].mass * pieces->fragments[k].position[d] / pieces->mass;
  for (int d = 0; d < 3; d++)
    away[d] = f->position[d] - centre[d];
  for (int d = 0; d < 3; d++)
    cosine += away[d] * run->impact_direction[d] / norm(away);
  results->second.angle = not_infinite(acos(cosine > 1    ? 1
                                            : cosine < -1 ? -1
                                                          : cosine)); /* not of fmin, which makes 1 of NaN */
}

static void damage(const struct sph_run *run, struct sph_results *results) {
  const struct sph_particles *p = run->now;
  double mass = 0, sum = 0, whole = 0, pores = 0;
  for (size_t i = 0; i < run->targets; i++) {
    double d = p->damage_cbrt ? p->damage_cbrt[i] * p->damage_cbrt[i] * p->damage_cbrt[i] : 0;
    mass += p->mass[i];
    sum += p->mass[i] * d;
    pores += p->rest_distention ? p->mass[i] * p->rest_distention[i] : 0;
    whole += d < run->inputs.fragments.damage ? p->mass[i] : 0;
  }
  results->mean_damage = share(sum, mass);
  if (p->rest_distention && mass > 0)
    results->mean_distention = not_infinite(pores / mass);
  results->undamaged_fraction = share(whole, mass);
}

static status stretch(const struct sph_run *run, struct sph_results *results, struct error *error) {
  struct sph_fragments pieces;
  status code = sph_report_pieces(run, NAN, false, &pieces, error);
  if (code)
    return code;
  size_t large = 0;
  for (size_t k = 0; k < pieces.count; k++)
    large += pieces.fragments[k].mass * PIECE > pieces.mass;
  results->cracks = large ? (double)large - 1 : 0;
  sph_fragments_clear(&pieces);
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
  return not_infinite((speed[1] - speed[0]) / run->inputs.collision.speed);
}

/* The impact comes down on z at x = y = 0; an oblique one is not followed. */
struct sph_crater_options sph_report_crater(const struct sph_run *run) {
  const struct sph_inputs *in = &run->inputs;
  return (struct sph_crater_options){.first = run->range[0].first,
                                     .count = run->range[0].n,
                                     .spacing = sph_derived_fine_spacing(in),
                                     .ejection_speed = in->crater.ejection_speed,
                                     .distention = sph_derived_porous(&in->target)
                                                       ? in->target.material.porosity.distention
                                                       : 1};
}

static status crater(const struct sph_run *run, struct sph_results *results, struct error *error) {
  struct sph_crater c;
  struct sph_crater_options options = sph_report_crater(run);
  status code = sph_crater_find(run->start, run->now, &options, &c, error);
  if (code)
    return code;
  results->ejecta.mass_fraction = share(c.ejected_mass, run->range[0].mass);
  results->ejecta.momentum = not_infinite(c.ejected_momentum);
  results->crater.depth = c.depth;
  results->crater.radius = c.radius;
  results->crater.volume = not_infinite(c.volume);
  results->crater.compaction_share = share(c.compaction_volume, c.compaction_volume + c.ejecta_volume);
  if (options.distention > 1) {
    results->compaction.mass_fraction = share(c.compacted_mass, run->range[0].mass);
    results->compaction.volume = not_infinite(c.compaction_volume);
    results->compaction.depth = c.compaction_depth;
    results->compaction.reach = c.compaction_reach;
  }
  return STATUS_OK;
}

static bool closed(const struct sph_run *run) {
  return !run->start->held && !run->start->damping;
}

/* What changes of momentum are measured against: bodies that stop each other must not make a small error look large. */
static double momentum_scale(const struct sph_run *run, const struct sph_ledger *ledger) {
  return fmax(ledger->momentum_scale, run->state.momentum_scale_start);
}

/* Angular momentum about axis k keeps where both other directions are open. */
static double angular_change(const struct sph_run *run, const struct sph_ledger *ledger, int k) {
  const bool keeps = isnan(run->periodic[(k + 1) % 3]) && isnan(run->periodic[(k + 2) % 3]);
  return keeps ? ledger->angular_momentum[k] - run->state.angular_start[k] : 0;
}

static void shares_of_steps(const struct sph_run *run, struct sph_results *results) {
  double steps = (double)sph_system_steps(run->system);
  const uint64_t *by = run->state.limited;
  results->limited.courant = share((double)by[SPH_LIMIT_COURANT], steps);
  results->limited.force = share((double)by[SPH_LIMIT_FORCE], steps);
  results->limited.damage = share((double)by[SPH_LIMIT_DAMAGE], steps);
  results->limited.distention = share((double)by[SPH_LIMIT_DISTENTION], steps);
  results->limited.energy = share((double)by[SPH_LIMIT_ENERGY], steps);
  results->limited.density = share((double)by[SPH_LIMIT_DENSITY], steps);
}

static status fill_results(const struct sph_run *run, const struct sph_ledger *ledger, double input,
                           const struct sph_fragments *pieces, struct sph_results *results, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  field_defaults(&sph_results, results); /* off, zero */
  double steps = (double)sph_system_steps(run->system), change[3];
  results->stop_reason = run->state.stop;
  results->particles = (int64_t)run->targets;
  results->projectile_particles = (int64_t)(run->start->n - run->targets);
  results->flaws = (int64_t)run->flaw_count;
  results->target_mass = pieces->mass;
  if (sph_derived_has_projectile(in)) {
    results->projectile_mass = run->range[1].mass;
    results->specific_energy = not_infinite(0.5 * run->range[1].mass * in->impact.speed * in->impact.speed /
                                            run->range[0].mass);
  }
  bool broke = !isnan(run->state.first_damage);
  results->fracture_ceased = run->state.stop == SPH_STOP_QUIET || (run->state.stop == SPH_STOP_END_TIME && !broke);
  results->first_damage = run->state.first_damage;
  if (run->state.stop == SPH_STOP_QUIET)
    results->cease_time = run->state.quiet_since;
  damage(run, results);
  status code = variants(run, pieces, results, error);
  if (!code && in->kind == SPH_STRETCH)
    code = stretch(run, results, error);
  if (!code && in->kind == SPH_IMPACT)
    code = crater(run, results, error);
  if (code)
    return code;
  results->largest.axis_middle = share(pieces->axis_ratio[0], 1);
  results->largest.axis_short = share(pieces->axis_ratio[1], 1);
  if (pieces->count)
    results->largest.speed = not_infinite(norm(pieces->fragments[0].velocity));
  second(run, pieces, results);
  results->energy.kinetic = not_infinite(ledger->kinetic);
  results->energy.internal = not_infinite(ledger->internal);
  results->energy.damped = not_infinite(ledger->damped);
  results->energy.work_of_held = not_infinite(ledger->work_of_held);
  results->energy.clamped = not_infinite(ledger->clamped);
  results->energy_input = not_infinite(input);
  results->clamped_share = input > 0 ? not_infinite(fabs(ledger->clamped) / input) : (double)NAN;
  results->density_held_share = share((double)ledger->density_held, steps * (double)run->start->n);
  for (int k = 0; k < 3; k++)
    change[k] = angular_change(run, ledger, k);
  double scale = fmax(norm(run->state.angular_start), momentum_scale(run, ledger) * sph_run_extent(run));
  if (closed(run) && scale > 0)
    results->angular_momentum_error = not_infinite(norm(change) / scale);
  shares_of_steps(run, results);
  results->neighbours = not_infinite(sph_system_neighbours(run->system));
  if (run->state.crossings > 1)
    results->frequency = (double)(run->state.crossings - 1) /
                         (2 * (run->state.crossing_last - run->state.crossing_first));
  if (in->kind == SPH_COLLISION)
    results->rebound = rebound(run);
  if (in->kind == SPH_PISTON)
    sph_plate_report(run, results);
  return STATUS_OK;
}

static void fill_outcome(const struct sph_run *run, const struct sph_ledger *ledger, double input,
                         const struct sph_fragments *pieces, struct outcome *outcome) {
  *outcome = (struct outcome){
      .state = run->state.finished ? run->state.outcome_state : OUTCOME_END_TIME,
      .steps = (int64_t)sph_system_steps(run->system),
      .time = sph_system_time(run->system),
      .time_step = isfinite(run->state.smallest_step) ? run->state.smallest_step : sph_system_last_step(run->system),
  };
  snprintf(outcome->message, sizeof outcome->message, "%s",
           run->state.finished ? run->state.message : "not finished: results of a snapshot");
  outcome_fragments(outcome, pieces->count, pieces->fragments);
  double translation = 0, change[3];
  outcome->energy_error = input > 0 ? not_infinite(fabs(sph_run_closed(ledger) - run->state.energy_start) / input)
                                    : (double)NAN;
  for (int k = 0; k < 3; k++)
    change[k] = ledger->momentum[k] - run->state.momentum_start[k];
  const double scale = momentum_scale(run, ledger);
  outcome->momentum_error = closed(run) && scale > 0 ? not_infinite(norm(change) / scale) : (double)NAN;
  for (size_t k = 0; k < pieces->count; k++) {
    double v = norm(pieces->fragments[k].velocity);
    translation += 0.5 * pieces->fragments[k].mass * v * v;
  }
  outcome->kinetic_energy_share = input > 0 ? not_infinite(translation / input) : (double)NAN;
}

status sph_report_finish(struct sph_run *run, struct outcome *outcome, struct sph_results *results,
                         struct fragment **fragments, size_t *count, struct error *error) {
  *fragments = NULL;
  *count = 0;
  struct sph_fragments pieces;
  sph_run_read(run);
  status code = sph_report_pieces(run, run->inputs.fragments.static_strength, run->inputs.fragments.veneer, &pieces,
                                  error);
  if (code)
    return code;
  struct sph_ledger ledger = sph_system_ledger(run->system);
  double input = run->state.energy_input + fabs(ledger.work_of_held);
  code = fill_results(run, &ledger, input, &pieces, results, error);
  if (!code) {
    fill_outcome(run, &ledger, input, &pieces, outcome);
    *fragments = pieces.fragments;
    *count = pieces.count;
    pieces.fragments = NULL;
  }
  sph_fragments_clear(&pieces);
  return code;
}
