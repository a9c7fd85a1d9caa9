/* A run from its set-up to its end: steps, checks of energy and speed, stop rules. */
#include "engine/dem/run/run.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

double dem_run_closed(const struct dem_ledger *l) {
  return l->kinetic + l->beam + l->contact + l->broken_beam + l->damping + l->friction - l->external_work;
}

void dem_run_momentum(const struct dem_run *run, double momentum[2], double *magnitude) {
  momentum[0] = momentum[1] = *magnitude = 0;
  for (uint32_t i = 0; i < run->tessellation->cell_count; i++) {
    struct dem_grain g = dem_system_grain(run->system, i);
    if (!g.present)
      continue;
    if (!(run->held[i] & 1))
      momentum[0] += g.mass * g.vx;
    if (!(run->held[i] & 2))
      momentum[1] += g.mass * g.vy;
    *magnitude += g.mass * hypot(g.vx, g.vy);
  }
}

void dem_run_end(struct dem_run *run, int stop, int outcome_state, const char *format, ...) {
  if (run->state.finished && (stop != DEM_STOP_FAULT || run->state.stop == DEM_STOP_FAULT))
    return;
  run->state.finished = 1;
  run->state.stop = stop;
  run->state.outcome_state = outcome_state;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(run->state.message, sizeof run->state.message, format, arguments);
  va_end(arguments);
}

static void held_force(const struct dem_run *run, double force[2]) {
  force[0] = force[1] = 0;
  const uint32_t *layers[2] = {run->lower, run->upper};
  const size_t counts[2] = {run->lower_count, run->upper_count};
  for (int l = 0; l < 2; l++)
    for (size_t k = 0; k < counts[l]; k++) {
      double fx, fy, torque;
      dem_system_force(run->system, layers[l][k], &fx, &fy, &torque);
      if (run->held[layers[l][k]] & 1)
        force[0] += fx;
      if (run->held[layers[l][k]] & 2)
        force[1] += fy;
    }
}

/* Largest distance that a grain may move in one step, in mean diameters. A faster grain can pass through a neighbour
 * without a step in which they overlap, and the energy ledger would not show it. */
static const double largest_way = 0.5;

/* The fastest grain, or the first one that is not finite. */
static uint32_t fastest_grain(const struct dem_run *run, double *speed) {
  uint32_t fastest = 0;
  *speed = 0;
  for (uint32_t i = 0; i < run->tessellation->cell_count; i++) {
    struct dem_grain g = dem_system_grain(run->system, i);
    const double v = g.present ? hypot(g.vx, g.vy) : 0;
    if (v > *speed || !isfinite(v + g.x + g.y)) {
      fastest = i;
      *speed = v;
    }
    if (!isfinite(v + g.x + g.y))
      break;
  }
  return fastest;
}

static void check_speed(struct dem_run *run) {
  double speed;
  const uint32_t grain = fastest_grain(run, &speed);
  const double way = speed * run->inputs.fidelity.time_step / run->grain_diameter;
  if (run->inputs.contact.law != DEM_CONTACT_OFF && way > largest_way)
    dem_run_end(run, DEM_STOP_FAULT, OUTCOME_TIME_STEP,
                "at %.6g s grain %u moves by %.3g grain diameters in a time step and could pass through others unseen: "
                "give a fidelity.time_step below %.3g s",
                dem_system_time(run->system), (unsigned)grain, way, run->inputs.fidelity.time_step * largest_way / way);
}

status dem_run_create(const struct dem_inputs *inputs, uint64_t seed, struct dem_run **out, struct error *error) {
  *out = NULL;
  status code = dem_inputs_check(inputs, error);
  if (code)
    return code;
  struct dem_run *run = calloc(1, sizeof *run);
  if (!run)
    return status_fail(error, STATUS_MEMORY, "no memory for a run");
  run->inputs = *inputs;
  run->seed = seed;
  run->charge = UINT32_MAX;
  struct dem_ledger ledger;
  double magnitude;
  if ((code = dem_protocol_body(inputs, seed, &run->tessellation, error)) ||
      (code = dem_system_create(run->tessellation, &run->inputs, seed, &run->system, error)))
    goto cleanup;
  run->held = calloc(run->tessellation->cell_count, 1);
  if (!run->held) {
    code = status_fail(error, STATUS_MEMORY, "no memory for %zu grains", run->tessellation->cell_count);
    goto cleanup;
  }
  double area = 0;
  for (uint32_t i = 0; i < run->tessellation->cell_count; i++)
    area += run->tessellation->area[i];
  run->grain_diameter = sqrt(4 / M_PI * area / (double)run->tessellation->cell_count);
  run->stable_time_step = dem_system_stable_time_step(run->system);
  if (isnan(run->stable_time_step)) {
    code = status_fail(error, STATUS_MEMORY, "no memory for the longest time step of %zu grains",
                       run->tessellation->cell_count);
    goto cleanup;
  }
  run->passing_speed = dem_describe_passing_speed(inputs);
  if (inputs->fidelity.time_step > run->stable_time_step) {
    code = status_fail(
        error, STATUS_CONTENT,
        "fidelity.time_step is %.4g s, but with fidelity.integrator %s this body is unstable above %.4g s: "
        "give a shorter step, at most half of that for good energy",
        inputs->fidelity.time_step, inputs->fidelity.integrator == DEM_GEAR ? "gear" : "verlet", run->stable_time_step);
    goto cleanup;
  }
  if ((code = dem_protocol_start(run, error)))
    goto cleanup;
  ledger = dem_system_ledger(run->system);
  run->state.closed_start = dem_run_closed(&ledger);
  dem_run_momentum(run, run->state.momentum_start, &magnitude);
  check_speed(run);
  *out = run;
  run = NULL;
cleanup:
  dem_run_free(run);
  return code;
}

void dem_run_free(struct dem_run *run) {
  if (!run)
    return;
  dem_system_free(run->system);
  dem_tessellation_free(run->tessellation);
  free(run->held);
  free(run->lower);
  free(run->upper);
  free(run->left);
  free(run->right);
  free(run->sample);
  free(run);
}

/* Energy put in so far; a drift is measured relative to it. */
static double input_now(const struct dem_run *run, const struct dem_ledger *ledger) {
  return run->state.energy_input + fabs(ledger->external_work);
}

static void end_not_finite(struct dem_run *run, const char *quantity) {
  double speed;
  const uint32_t grain = fastest_grain(run, &speed);
  dem_run_end(run, DEM_STOP_FAULT, OUTCOME_NOT_FINITE,
              "%s is no longer finite at %.6g s; grain %u is the fastest, at %.3g m/s: give a shorter "
              "fidelity.time_step, or less contact damping",
              quantity, dem_system_time(run->system), (unsigned)grain, speed);
}

static void check_energy(struct dem_run *run) {
  struct dem_ledger ledger = dem_system_ledger(run->system);
  double closed = dem_run_closed(&ledger), input = input_now(run, &ledger);
  if (!isfinite(closed)) {
    end_not_finite(run, "the energy");
    return;
  }
  double drift = fabs(closed - run->state.closed_start), bound = run->inputs.fidelity.energy_bound;
  /* Under a load the work starts from zero: check once the sides move at their full speed. */
  if (dem_inputs_loaded(&run->inputs) && dem_system_time(run->system) < run->inputs.loading.ramp)
    return;
  if (field_is_off(bound) || !(input > 0) || drift <= bound * input)
    return;
  double speed;
  const uint32_t grain = fastest_grain(run, &speed);
  dem_run_end(run, DEM_STOP_FAULT, OUTCOME_ENERGY,
              "at %.6g s the energy ledger has drifted by %.3g of the energy put in, above fidelity.energy_bound "
              "%.3g; grain %u is the fastest, at %.3g m/s: give a shorter fidelity.time_step, or less contact damping",
              dem_system_time(run->system), drift / input, bound, (unsigned)grain, speed);
}

void dem_run_look(struct dem_run *run) {
  check_energy(run);
  check_speed(run);
}

static void check_stop(struct dem_run *run) {
  double time = dem_system_time(run->system), last = dem_system_last_break(run->system);
  double half_step = 0.5 * run->inputs.fidelity.time_step;
  if (dem_inputs_loaded(&run->inputs))
    return; /* loading.c ends these runs */
  const struct dem_break *log;
  bool broke = dem_system_breaks(run->system, &log) > 0;
  double least = fmin(run->inputs.stop.least_time, run->inputs.stop.end_time);
  if (broke && time >= least - half_step && time - last >= run->inputs.stop.quiet_time - half_step)
    dem_run_end(run, DEM_STOP_QUIET, OUTCOME_COMPLETED, "%s", "");
  else if (time >= run->inputs.stop.end_time - half_step) {
    if (broke)
      dem_run_end(run, DEM_STOP_END_TIME, OUTCOME_END_TIME,
                  "beams still broke %.3g s before the hard end: raise stop.end_time", time - last);
    else /* nothing has broken: there is no fracture that could go on */
      dem_run_end(run, DEM_STOP_END_TIME, OUTCOME_COMPLETED, "%s", "");
  }
}

status dem_run_advance(struct dem_run *run, uint64_t max_steps, struct error *error) {
  double dt = run->inputs.fidelity.time_step;
  bool is_loaded = dem_inputs_loaded(&run->inputs);
  for (uint64_t k = 0; k < max_steps && !run->state.finished; k++) {
    if (is_loaded)
      dem_loading_drive(run);
    const bool stepped = dem_system_step(run->system);
    if (!stepped && dem_system_lacks_memory(run->system))
      return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu grains",
                         run->tessellation->cell_count);
    if (!stepped) {
      end_not_finite(run, "a position or velocity");
      return STATUS_OK;
    }
    if (is_loaded) {
      double force[2];
      held_force(run, force);
      for (int d = 0; d < 2; d++) {
        run->state.impulse[d] += 0.5 * dt * (force[d] + run->state.force_before[d]);
        run->state.force_before[d] = force[d];
      }
      dem_loading_record(run);
    }
    check_stop(run);
    if (dem_system_steps(run->system) % DEM_RUN_LOOKS == 0 || run->state.finished)
      dem_run_look(run);
  }
  return STATUS_OK;
}
