/* Engine `dem`: a run from its set-up to its end (steps, checks of energy and speed, stop rules), and the descriptor.
 */
#include "engine/dem/dem.h"

#include <math.h>
#include <stdlib.h>

#include "engine/dem/run/run.h"
#include "schemas/memory.h"

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

double dem_run_angular_momentum(const struct dem_run *run) {
  double sum = 0;
  for (uint32_t i = 0; i < run->tessellation->cell_count; i++) {
    const struct dem_grain g = dem_system_grain(run->system, i);
    sum += g.present ? g.mass * (g.x * g.vy - g.y * g.vx) + g.moment_of_inertia * g.spin : 0;
  }
  return sum;
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
static size_t fastest_grain(void *of, double *speed) {
  const struct dem_run *run = of;
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

static void check_speed(void *of) {
  struct dem_run *run = of;
  double speed;
  const size_t grain = fastest_grain(run, &speed);
  const double way = speed * run->inputs.fidelity.time_step / run->grain_diameter;
  if (run->inputs.contact.law != DEM_CONTACT_OFF && way > largest_way)
    frame_end(&run->state.frame, DEM_STOP_FAULT, OUTCOME_TIME_STEP,
              "at %.6g s grain %zu moves by %.3g grain diameters in a time step and could pass through others unseen: "
              "give a fidelity.time_step below %.3g s",
              dem_system_now(run->system)->time, grain, way, run->inputs.fidelity.time_step * largest_way / way);
}

static const char *remedy(void *run, double drift) {
  (void)run, (void)drift;
  return "give a shorter fidelity.time_step, or less contact damping";
}

static struct frame_energy energy_of(void *of) {
  struct dem_run *run = of;
  const struct dem_ledger ledger = dem_system_ledger(run->system);
  /* Under a load the work starts from zero: check once the sides move at their full speed. */
  const bool early = dem_inputs_loaded(&run->inputs) && dem_system_now(run->system)->time < run->inputs.loading.ramp;
  return (struct frame_energy){.closed = dem_run_closed(&ledger),
                               .input = run->state.frame.energy_input + fabs(ledger.external_work),
                               .bound = early ? (double)NAN : run->inputs.fidelity.energy_bound};
}

/* The rules of the end. */
static void check_stop(void *of) {
  struct dem_run *run = of;
  double time = dem_system_now(run->system)->time, last = dem_system_now(run->system)->last_break;
  double half_step = 0.5 * run->inputs.fidelity.time_step;
  if (dem_inputs_loaded(&run->inputs))
    return; /* loading.c ends these runs */
  const struct dem_break *log;
  bool broke = dem_system_breaks(run->system, &log) > 0;
  double least = fmin(run->inputs.stop.least_time, run->inputs.stop.end_time);
  if (broke && time >= least - half_step && time - last >= run->inputs.stop.quiet_time - half_step)
    frame_end(&run->state.frame, DEM_STOP_QUIET, OUTCOME_COMPLETED, "%s", "");
  else if (time >= run->inputs.stop.end_time - half_step) {
    if (broke)
      frame_end(&run->state.frame, DEM_STOP_END_TIME, OUTCOME_END_TIME,
                "beams still broke %.3g s before stop.end_time: raise it", time - last);
    else /* nothing has broken: there is no fracture that could go on */
      frame_end(&run->state.frame, DEM_STOP_END_TIME, OUTCOME_COMPLETED, "%s", "");
  }
}

static bool step(void *of) {
  struct dem_run *run = of;
  const double dt = run->inputs.fidelity.time_step;
  const bool is_loaded = dem_inputs_loaded(&run->inputs);
  if (is_loaded)
    dem_loading_drive(run);
  if (!dem_system_step(run->system)) {
    if (!dem_system_lacks_memory(run->system))
      frame_end_not_finite(&run->frame, "a position or velocity");
    return false;
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
  return true;
}

/* Every step checks that all values are finite. */
static const struct frame_kind kind = {.fault = DEM_STOP_FAULT,
                                       .looks = 100,
                                       .member = "grain",
                                       .step = step,
                                       .stop = check_stop,
                                       .look = check_speed,
                                       .energy = energy_of,
                                       .fastest = fastest_grain,
                                       .remedy = remedy};

/* Body, system and motion of a run that has its inputs. */
static status set_up(struct dem_run *run, struct error *error) {
  const struct dem_inputs *in = &run->inputs;
  TRY(dem_protocol_body(in, run->seed, &run->tessellation, error));
  const size_t n = run->tessellation->cell_count;
  TRY(dem_system_create(run->tessellation, in, run->seed, &run->system, error));
  run->held = calloc(n, 1);
  run->stable_time_step = dem_system_stable_time_step(run->system);
  if (!run->held || isnan(run->stable_time_step))
    return status_fail(error, STATUS_MEMORY, "no memory for %zu grains", n);
  double area = 0;
  for (size_t i = 0; i < n; i++)
    area += run->tessellation->area[i];
  run->grain_diameter = sqrt(4 / M_PI * area / (double)n);
  run->passing_speed = dem_describe_passing_speed(in);
  if (in->fidelity.time_step > run->stable_time_step)
    return status_fail(
        error, STATUS_CONTENT,
        "fidelity.time_step is %.4g s, but with fidelity.integrator %s this body is unstable above %.4g s: "
        "give a shorter step, at most half of that for good energy",
        in->fidelity.time_step, in->fidelity.integrator == DEM_GEAR ? "gear" : "verlet", run->stable_time_step);
  TRY(dem_protocol_start(run, error));
  run->threshold_energy = dem_system_threshold_energy(run->system);
  return STATUS_OK;
}

status dem_run_create(const struct dem_inputs *inputs, uint64_t seed, struct dem_run **out, struct error *error) {
  *out = NULL;
  TRY(dem_inputs_check(inputs, error));
  struct dem_run *run = memory_small(1, sizeof *run);
  run->inputs = *inputs;
  run->seed = seed;
  run->charge = UINT32_MAX;
  const status code = set_up(run, error);
  if (code) {
    dem_run_free(run);
    return code;
  }
  double magnitude;
  const struct dem_progress *now = dem_system_now(run->system);
  const struct dem_ledger ledger = dem_system_ledger(run->system);
  run->state.frame.closed_start = dem_run_closed(&ledger);
  run->frame = (struct frame){.kind = &kind,
                              .state = &run->state.frame,
                              .state_size = sizeof run->state,
                              .inputs = &run->inputs,
                              .seed = seed,
                              .time = &now->time,
                              .steps = &now->steps,
                              .failure = "no memory for a step",
                              .end_time = dem_inputs_end_time(inputs),
                              .sample = run->sample,
                              .sample_size = sizeof *run->sample,
                              .sample_capacity = run->sample_capacity};
  dem_run_momentum(run, run->state.momentum_start, &magnitude);
  check_speed(run);
  *out = run;
  return STATUS_OK;
}

void dem_run_free(void *of) {
  struct dem_run *run = of;
  if (!run)
    return;
  dem_system_free(run->system);
  dem_tessellation_free(run->tessellation);
  free(run->held);
  free(run->lower);
  free(run->sample);
  free(run);
}

/* ---- the descriptor ---- */

/* An upper bound per grain: outlines, beams and contacts of the moving system, the tessellation, and the search for
 * fragments at the end. tests/unit/test_dem_engine.c compares it with the built-in scenes. */
enum { BYTES_PER_GRAIN = 4000, BYTES_ANYWAY = 1 << 20 };
enum { BYTES_PER_SQUARE = 80 }; /* of the lattice under a ring, which has squares without a grain */

static size_t memory(const void *inputs) {
  const struct dem_inputs *in = inputs;
  const double empty = 4 * pow(dem_inputs_hole(in) / in->grain.spacing, 2);
  return (size_t)(dem_inputs_grains(in) * BYTES_PER_GRAIN + empty * BYTES_PER_SQUARE) + BYTES_ANYWAY;
}

static double work(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return dem_inputs_grains(in) * dem_inputs_end_time(in) / in->fidelity.time_step;
}

static status prepare(const void *inputs, uint64_t seed, void **run, struct error *error) {
  struct dem_run *made;
  const status code = dem_run_create(inputs, seed, &made, error);
  *run = made;
  return code;
}

static void *copy_system(const void *run, size_t *size) {
  return dem_system_state_copy(((const struct dem_run *)run)->system, size);
}

static status load_system(void *run, const void *bytes, size_t size, struct error *error) {
  const struct dem_run *r = run;
  return dem_system_state_load(r->system, bytes, size) ? STATUS_OK : status_fail(error, STATUS_CONTENT, "%s", "");
}

static const struct knob knobs[] = {
    KNOB("grains", RESOLUTION, .inputs = {{"grain.spacing", 1}, {"body.columns", -1}, {"body.rows", -1}},
         .factors = {2, 1.41, 1, 0.71}, .step_power = 1,
         .meaning = "mean size of a grain: half as many grains each; the sides of a block stay, to a whole grain"),
    KNOB("time_step", RESOLUTION, .inputs = {{"fidelity.time_step", 1}}, KNOB_HALVES, .step_power = 1, .pairs = true,
         .meaning = "time step"),
    KNOB("integrator", RESOLUTION, .inputs = {{"fidelity.integrator"}}, .choices = {"verlet", "gear"}, .pairs = true,
         .meaning = "velocity Verlet, or Gear's method of fifth order"),
    KNOB("stop", RESOLUTION, .inputs = {{"stop.quiet_time", 1}, {"stop.least_time", 1}, {"stop.end_time", 1}},
         .factors = {0.25, 0.5, 1, 2, 4}, .pairs = true,
         .meaning = "how long no beam must break until a run ends; its least time and stop.end_time move with it"),

    KNOB("contact_law", MODEL, .inputs = {{"contact.law"}}, .choices = {"off", "printed", "conservative"},
         .pairs = true, .meaning = "repulsion of overlapping grains"),
    KNOB("contact_bonded", MODEL, .inputs = {{"contact.bonded"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "grains that a beam joins repel each other, too"),
    KNOB("breaking", MODEL, .inputs = {{"threshold.breaking"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "beams may break"),
    KNOB_OF_SETTINGS,
    {.name = NULL},
};

static const char *headline(const void *inputs) {
  switch ((enum dem_kind)((const struct dem_inputs *)inputs)->kind) {
  case DEM_UNIAXIAL: return "young_modulus";
  case DEM_COMPRESSION: return "strength";
  default: return NULL;
  }
}

const struct engine_kind dem_engine = {
    .name = "dem",
    .dimensions = 2,
    .doc =
        "Discrete elements in the plane: a solid of rigid Voronoi grains on breakable Timoshenko beams, with repulsion "
        "of overlapping grains. Kun, D'Addetta, Herrmann & Ramm (1999), with the corrections that `clast explain` "
        "names at each input.",
    /* 2: the reference side of a contact has a floor. 3: contacts that begin with a break (contact.bonded off) are in
     * the ledger; grains too fast for the time step end a run. 4: Gear's first coefficients; thresholds by place;
     * stop.least_time. 5: thresholds of threshold_energy; strength is not an average; range of slopes with breaks.
     * 6: upright_share counts common sides. */
    .results_version = 6,
    .inputs = &dem_inputs,
    .results = &dem_results,
    .knobs = knobs,
    .complete = dem_inputs_complete,
    .check = dem_inputs_check,
    .conditions = dem_conditions,
    .headline = headline,
    .describe = dem_describe_scene,
    .memory = memory,
    .work = work,
    .prepare = prepare,
    .step = frame_step,
    .progress = frame_progress,
    .time = frame_time,
    .finish = dem_report_finish,
    .write_snapshot = dem_snapshot_write,
    .copy_system = copy_system,
    .load_system = load_system,
    .free = dem_run_free,
};
