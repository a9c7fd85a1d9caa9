/* Making a run, advancing it step by step, and ending it. */
#include "engine/sph/run/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/scene/derived.h"
#include "schemas/memory.h"

enum { LOOK_INTERVAL = 8 }; /* steps between two checks of the damage */

double sph_run_closed(const struct sph_ledger *l) {
  return l->kinetic + l->internal + l->contact + l->damped - l->work_of_held;
}

double sph_run_energy_available(const struct sph_run *run, const struct sph_ledger *ledger) {
  const double input = run->state.frame.energy_input + fabs(ledger->work_of_held), *p = run->state.momentum_start;
  if (!sph_run_keeps_momentum(run))
    return input;
  double mass = 0;
  for (size_t i = 0; i < run->start->n; i++)
    mass += run->start->mass[i];
  return fmax(input - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / (2 * mass), 0);
}

bool sph_run_keeps_momentum(const struct sph_run *run) {
  return !run->start->held && !run->start->damping;
}

double sph_run_extent(const struct sph_run *run) {
  const double diagonal[3] = {0.57735026918962576, 0.57735026918962576, 0.57735026918962576};
  return sph_shape_reach(&run->shape[0], diagonal);
}

const struct sph_particles *sph_run_read(struct sph_run *run) {
  sph_system_read(run->system, run->now);
  return run->now;
}

/* ---- building ---- */

static status make_system(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  struct sph_body_physics physics[SPH_RUN_BODIES];
  for (int b = 0; b < run->body_count; b++) {
    const struct sph_body_inputs *body = b == 1 && sph_derived_has_projectile(in) ? &in->projectile : &in->target;
    physics[b] = sph_derived_physics(body, run->flaws[b]);
  }
  struct sph_domain domain = SPH_DOMAIN_OPEN;
  domain.spacing_over_h = run->range[0].nearest / run->range[0].h;
  memcpy(domain.periodic, run->periodic, sizeof domain.periodic);
  return sph_system_create(run->start, (size_t)run->body_count, physics, in, &domain, &run->system, error);
}

/* ---- advancing ---- */

/* Fracture is over when the mean damage grows by less than stop.quiet_growth during stop.quiet_time, in all bodies
 * together and in each: the mean of all does not show a pebble under a boulder. */
static void look_at_damage(struct sph_run *run) {
  struct sph_state *state = &run->state;
  const size_t bodies = (size_t)run->body_count;
  const double time = run->system->now.time;
  const bool begins = isnan(state->first_damage);
  for (size_t k = 0; k <= bodies; k++) { /* 0: all */
    const double damage = sph_system_damage(run->system, k > 0 ? k - 1 : 0, k > 0 ? k : bodies);
    if (k == 0 && begins) {
      if (!(damage > 0))
        return;
      state->first_damage = time;
    }
    if (begins || damage - state->quiet_damage[k] >= run->inputs.stop.quiet_growth) {
      state->quiet_damage[k] = damage;
      state->quiet_since = time;
    }
  }
  if (time - state->quiet_since >= run->inputs.stop.quiet_time)
    frame_end(&state->frame, SPH_STOP_QUIET, OUTCOME_COMPLETED, "%s", "");
}

/* The particle whose speed is largest, by its id; its speed, m/s. */
static size_t fastest_particle(void *run, double *speed) {
  const struct sph_particles *p = sph_run_read(run);
  size_t fastest = 0;
  *speed = 0;
  for (size_t i = 0; i < p->n; i++) {
    const double v = sqrt(p->vx[i] * p->vx[i] + p->vy[i] * p->vy[i] + p->vz[i] * p->vz[i]);
    if (!(v <= *speed)) {
      fastest = i;
      *speed = v;
    }
  }
  return fastest;
}

/* The remedy against a drift, by its cause. */
static const char *remedy(void *of, double drift) {
  const struct sph_run *run = of;
  if (isnan(drift))
    return "lower fidelity.cfl";
  const struct condition *contrast = condition_find(sph_conditions, "contrast");
  if (condition_broken(contrast, contrast->before(&run->inputs)))
    return "bodies differ much in density: set method.volume_weights: true";
  const struct sph_ledger ledger = sph_system_ledger(run->system);
  if (fabs(ledger.clamped) > drift / 2)
    return "most is energy.clamped, of cold matter: raise the bound, or take more particles";
  return "lower fidelity.cfl, or take more particles";
}

static struct frame_energy energy_of(void *of) {
  const struct sph_run *run = of;
  const struct sph_ledger ledger = sph_system_ledger(run->system);
  return (struct frame_energy){.closed = sph_run_closed(&ledger),
                               .input = sph_run_energy_available(run, &ledger),
                               .bound = run->inputs.fidelity.energy_bound};
}

static bool step(void *of) {
  struct sph_run *run = of;
  struct sph_state *state = &run->state;
  if (!sph_system_step(run->system, run->inputs.stop.end_time)) {
    const int fault = run->system->fault;
    if (fault != SPH_FAULT_MEMORY)
      frame_end(&state->frame, SPH_STOP_FAULT, fault == SPH_FAULT_TIME_STEP ? OUTCOME_TIME_STEP : OUTCOME_NOT_FINITE,
                "%s", run->system->failure);
    return false;
  }
  const int64_t limiter = run->system->now.limiter;
  state->limited[limiter]++;
  if (limiter != SPH_LIMIT_END)
    state->smallest_step = fmin(state->smallest_step, run->system->now.last_step);
  if (run->sample)
    sph_protocol_record(run);
  return true;
}

/* The rules of the end. */
static void stop(void *of) {
  struct sph_run *run = of;
  const bool can_crack = run->flaw_count > 0;
  const double time = run->system->now.time;
  if (can_crack && run->system->now.steps % LOOK_INTERVAL == 0)
    look_at_damage(run);
  if (time < run->inputs.stop.end_time)
    return;
  if (can_crack && !isnan(run->state.first_damage))
    frame_end(&run->state.frame, SPH_STOP_END_TIME, OUTCOME_END_TIME,
              "damage still grew %.3g s before stop.end_time: raise it", time - run->state.quiet_since);
  else /* nothing has broken: there is no fracture that could go on */
    frame_end(&run->state.frame, SPH_STOP_END_TIME, OUTCOME_COMPLETED, "%s", "");
}

/* Every step checks that all values are finite. */
static const struct frame_kind kind = {.fault = SPH_STOP_FAULT,
                                       .looks = 64,
                                       .member = "particle",
                                       .step = step,
                                       .stop = stop,
                                       .energy = energy_of,
                                       .fastest = fastest_particle,
                                       .remedy = remedy};

/* ---- making ---- */

static void begin(struct sph_run *run) {
  struct sph_ledger ledger = sph_system_ledger(run->system);
  run->state.frame.closed_start = sph_run_closed(&ledger);
  run->state.frame.energy_input = ledger.kinetic;
  memcpy(run->state.momentum_start, ledger.momentum, sizeof ledger.momentum);
  memcpy(run->state.angular_start, ledger.angular_momentum, sizeof ledger.angular_momentum);
  run->state.momentum_scale_start = ledger.momentum_scale;
  run->state.smallest_step = HUGE_VAL;
  run->state.first_damage = NAN;
  run->frame = (struct frame){.kind = &kind,
                              .state = &run->state.frame,
                              .state_size = sizeof run->state,
                              .inputs = &run->inputs,
                              .seed = run->seed,
                              .time = &run->system->now.time,
                              .steps = &run->system->now.steps,
                              .failure = run->system->failure,
                              .end_time = run->inputs.stop.end_time,
                              .sample = run->sample,
                              .sample_size = sizeof *run->sample,
                              .sample_capacity = run->sample_capacity};
}

status sph_run_create(const struct sph_inputs *inputs, uint64_t seed, struct sph_run **out, struct error *error) {
  *out = NULL;
  TRY(sph_inputs_check(inputs, error));
  const double needed = (double)sph_describe_memory(inputs), there = (double)sph_particles_memory();
  if (needed > there)
    return status_fail(error, STATUS_MEMORY, "%.4g particles need about %.3g GB of memory, and there are %.3g GB: %s",
                       sph_derived_particles(inputs), needed / 1e9, there / 1e9, sph_inputs_check_fewer(inputs));
  struct sph_run *run = memory_small(1, sizeof *run);
  run->inputs = *inputs;
  run->seed = seed;
  status code = sph_protocol_bodies(run, error);
  if (!code)
    code = make_system(run, error);
  if (!code)
    code = sph_particles_make(run->start->n, sph_system_columns_arrays(&run->system->columns), &run->now, error);
  if (!code)
    code = sph_protocol_record_start(run, error);
  if (code) {
    sph_run_free(run);
    return code;
  }
  for (int b = 0; b < SPH_RUN_BODIES; b++) { /* the system has its own copies */
    sph_flaws_free(run->flaws[b]);
    run->flaws[b] = NULL;
  }
  begin(run);
  *out = run;
  return STATUS_OK;
}

void sph_run_free(void *of) {
  struct sph_run *run = of;
  if (!run)
    return;
  sph_system_free(run->system);
  sph_particles_free(run->start);
  sph_particles_free(run->now);
  for (int b = 0; b < SPH_RUN_BODIES; b++)
    sph_flaws_free(run->flaws[b]);
  free(run->sample);
  free(run->layer);
  free(run);
}
