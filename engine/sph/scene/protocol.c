/* Bodies, and their places and motion at the start. */
#include <math.h>
#include <stdlib.h>

#include "engine/sph/material/palpha.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "schemas/memory.h"

enum { Z = 2 };

/* In a collision both bodies are targets. */
static const struct sph_body_inputs *inputs_of(const struct sph_run *run, int body) {
  return body == 1 && sph_derived_has_projectile(&run->inputs) ? &run->inputs.projectile : &run->inputs.target;
}

static struct sph_body body_of(const struct sph_run *run, const struct sph_body_inputs *b,
                               const struct sph_shape *shape, uint64_t number, double spacing) {
  const struct sph_inputs *in = &run->inputs;
  return (struct sph_body){
      .shape = *shape,
      .lattice = {.kind = b->lattice,
                  .particles = NAN,
                  .spacing = spacing,
                  .turned = b->turned,
                  .seed = run->seed,
                  .body = number},
      .density = sph_derived_density(b),
      .h_over_spacing = in->fidelity.smoothing,
  };
}

/* Two slabs that repeat along their axes. */
static void place_slabs(struct sph_run *run) {
  const struct sph_inputs *in = &run->inputs;
  for (int b = 0; b < 2; b++) {
    run->shape[b] = sph_derived_target(in);
    run->shape[b].centre[0] = (b ? 1 : -1) * (in->target.radius + in->collision.gap / 2);
    run->shape[b].centre[Z] = run->shape[b].length / 2;
  }
  run->periodic[Z] = run->shape[0].length;
}

/* The plate begins at x = 0, the piston is in front of it; the periodic box begins at 0. */
static void place_plate(struct sph_run *run) {
  run->shape[0] = sph_derived_target(&run->inputs);
  run->shape[1] = sph_derived_piston(&run->inputs);
  run->shape[0].centre[0] = run->shape[0].side[0] / 2;
  run->shape[1].centre[0] = -run->shape[1].side[0] / 2;
  for (int k = 1; k < 3; k++) {
    run->periodic[k] = run->shape[0].side[k];
    run->shape[0].centre[k] = run->shape[1].centre[k] = run->periodic[k] / 2;
  }
}

/* The arrays that the modules of the bodies need, and those of the protocol. */
static int arrays_of(const struct sph_inputs *in) {
  const struct sph_column_set columns = sph_describe_columns(in);
  int arrays = sph_system_columns_arrays(&columns);
  if (in->kind == SPH_STRETCH || in->kind == SPH_PISTON)
    arrays |= SPH_WITH_HELD;
  if (in->target.shape == SPH_SHAPE_BOX && in->sides.far == SPH_FAR_DAMPED)
    arrays |= SPH_WITH_DAMPING;
  return arrays;
}

static status make_bodies(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  double spacing = sph_derived_spacing(in);
  struct sph_body body[SPH_RUN_BODIES];
  body[0] = body_of(run, &in->target, &run->shape[0], 0, spacing);
  if (in->kind == SPH_COLLISION || in->kind == SPH_PISTON) {
    body[1] = body_of(run, &in->target, &run->shape[1], 1, spacing);
    for (int k = 0; k < 3; k++)
      body[0].lattice.periodic[k] = body[1].lattice.periodic[k] = !isnan(run->periodic[k]);
  } else {
    body[0].lattice.particles = (double)in->fidelity.particles;
    if (sph_derived_has_projectile(in)) {
      body[1] = body_of(run, &in->projectile, &run->shape[1], 1,
                        sph_derived_fine_spacing(in) * in->fidelity.projectile_spacing);
      if (in->fidelity.graded)
        body[0].lattice.grading = sph_derived_grading(in, &run->shape[0]);
    }
  }
  return sph_bodies_make(body, (size_t)run->body_count, arrays_of(in), &run->start, run->range, error);
}

/* The first longitudinal mode of a free bar: v_z = v sin(pi z/L), antisymmetric, with no strain at the ends. The sides
 * move by Poisson's ratio. */
static void ring(struct sph_run *run) {
  struct sph_particles *p = run->start;
  double speed = run->inputs.vibration.speed, k = M_PI / run->inputs.target.length;
  double ratio = run->inputs.target.strength ? sph_material_poisson_ratio(&run->inputs.target.material) : 0;
  for (size_t i = 0; i < p->n; i++) {
    double aside = -ratio * k * speed * cos(k * p->z[i]);
    p->vz[i] += speed * sin(k * p->z[i]);
    p->vx[i] += aside * p->x[i];
    p->vy[i] += aside * p->y[i];
  }
}

/* Holds both ends. Both grips must contain particles. */
static status grip(struct sph_run *run, struct error *error) {
  const double length = run->inputs.stretch.grip;
  bool below = false, above = false;
  sph_bodies_hold(run->start, run->range[0], run->inputs.target.length / 2 - length,
                  SPH_HELD_X | SPH_HELD_Y | SPH_HELD_Z);
  for (size_t i = 0; i < run->range[0].n; i++)
    if (run->start->held[i])
      *(run->start->z[i] < 0 ? &below : &above) = true;
  return below && above ? STATUS_OK
                        : status_fail(error, STATUS_CONTENT,
                                      "a grip of %.4g m holds no particle (they are %.4g m apart): raise stretch.grip "
                                      "or fidelity.particles",
                                      length, run->range[0].spacing);
}

/* The piston is held matter. The distance of its layers is that of the compressed plate behind the shock: compressed
 * matter would slip through layers at their distance at rest, and the piston would drive it too slowly. Particles of a
 * lattice move along x only, as in a plane flow: otherwise rounding errors grow, and rows that a strong shock has
 * pushed together buckle. */
static status push(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  struct sph_particles *p = run->start;
  struct sph_plane_shock exact;
  TRY(sph_plane_shock(&in->target.material, in->piston.speed, &exact, error));

  const double behind = exact.has_shock ? exact.shock.density : exact.precursor.density;
  const double v[3] = {in->piston.speed, 0, 0};
  sph_bodies_move(p, run->range[1], v);
  for (size_t i = run->range[1].first; i < p->n; i++) {
    p->x[i] *= exact.first_density / behind; /* its face is at x = 0 */
    p->held[i] = SPH_HELD_X | SPH_HELD_Y | SPH_HELD_Z;
  }
  for (size_t i = 0; i < run->range[0].n && in->target.lattice != SPH_LATTICE_IRREGULAR; i++)
    p->held[i] = SPH_HELD_Y | SPH_HELD_Z;
  return STATUS_OK;
}

static status set_in_motion(struct sph_run *run, const double flight[3], struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  const double spin[3] = {0, 0, in->target.spin};
  double v[3] = {0, 0, 0};
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT:
    for (int k = 0; k < 3; k++)
      v[k] = in->impact.speed * flight[k];
    sph_bodies_move(run->start, run->range[1], v);
    if (in->target.spin != 0)
      sph_bodies_spin(run->start, run->range[0], spin);
    break;
  case SPH_STRETCH:
    sph_bodies_stretch(run->start, run->range[0], in->stretch.rate,
                       in->target.strength ? sph_material_poisson_ratio(&in->target.material) : 0);
    return grip(run, error);
  case SPH_VIBRATION: ring(run); break;
  case SPH_COLLISION:
    for (int b = 0; b < 2; b++) {
      v[0] = (b ? -0.5 : 0.5) * in->collision.speed;
      sph_bodies_move(run->start, run->range[b], v);
    }
    break;
  case SPH_PISTON: return push(run, error);
  case SPH_KINDS: break;
  }
  return STATUS_OK;
}

static status make_flaws(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  const bool has_ends = in->kind == SPH_STRETCH && in->stretch.flaw_free > 0;
  const double half = has_ends ? in->target.length / 2 - in->stretch.flaw_free : (double)INFINITY;
  for (int b = 0; b < run->body_count; b++) {
    const struct sph_body_inputs *body = inputs_of(run, b);
    if (!sph_derived_cracks(body))
      continue;
    struct sph_flaw_law law = {.weibull = body->material.weibull,
                               .solid_ratio = sph_material_solid_ratio(&body->material),
                               .draw = in->weibull.draw,
                               .cell_width = in->crack_cell.width,
                               .seed = run->seed,
                               .body = (uint64_t)b};
    TRY(sph_flaws_place(&law, &run->shape[b], run->start, run->range[b], half, &run->flaws[b], error));
    run->flaw_count += run->flaws[b]->count;
  }
  return STATUS_OK;
}

/* A damping layer. A wave that crosses it and returns keeps exp(-rate depth/(3 c)) of its amplitude: damping acts on
 * the kinetic half of its energy, and the rate grows as the square of the depth. 10.5 c/depth leaves 3 %. */
static status damp(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  if (!run->start->damping)
    return STATUS_OK;
  sph_bodies_damp(run->start, run->range[0], &run->shape[0], in->sides.depth,
                  10.5 * sph_derived_wave_speed(&in->target) / in->sides.depth);
  for (size_t i = 0; i < run->range[0].n; i++)
    if (run->start->damping[i] > 0)
      return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "a damping layer of %.4g m holds no particle (they are %.4g m apart): raise sides.depth or "
                     "fidelity.particles, or set sides.far: free",
                     in->sides.depth, run->range[0].spacing);
}

status sph_protocol_bodies(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  double flight[3] = {0, 0, 0};
  status code = STATUS_OK;
  run->body_count = sph_derived_bodies(in);
  for (int k = 0; k < 3; k++)
    run->periodic[k] = NAN;
  if (in->kind == SPH_IMPACT)
    code = sph_derived_aim(in, run->shape, flight, error);
  else if (in->kind == SPH_COLLISION)
    place_slabs(run);
  else if (in->kind == SPH_PISTON)
    place_plate(run);
  else
    run->shape[0] = sph_derived_target(in);
  if (code)
    return code;
  TRY(make_bodies(run, error));

  run->targets = in->kind == SPH_COLLISION ? run->start->n : run->range[0].n;
  for (int b = 0; b < run->body_count; b++) {
    const struct sph_body_physics physics = sph_derived_physics(inputs_of(run, b), NULL);
    sph_modules_set_up(&physics, in, run->start, run->range[b].first, run->range[b].first + run->range[b].n);
  }
  TRY(set_in_motion(run, flight, error));
  TRY(damp(run, error));
  return make_flaws(run, error);
}

/* Records of stretch, vibration and piston during a run, at equal intervals of simulated time. */

status sph_protocol_record_start(struct sph_run *run, struct error *error) {
  if (run->inputs.kind != SPH_STRETCH && run->inputs.kind != SPH_VIBRATION && run->inputs.kind != SPH_PISTON)
    return STATUS_OK;
  if (run->inputs.kind == SPH_PISTON)
    TRY(sph_plate_start(run, error));
  run->sample_interval = run->inputs.stop.end_time / SPH_SAMPLES;
  run->sample_capacity = SPH_SAMPLES + 2;
  run->sample = memory_small(run->sample_capacity, sizeof *run->sample);
  return STATUS_OK;
}

/* Mean axial stress that the damaged solid bears between the grips, weighted by volume. */
static double axial_stress(const struct sph_run *run, const struct sph_particles *p) {
  const bool scales_shear = sph_modules_damage_scales_shear(&run->inputs.target, &run->inputs);
  double half = run->inputs.target.length / 2 - run->inputs.stretch.grip, sum = 0, volume = 0;
  for (size_t i = 0; i < p->n; i++) {
    if (fabs(run->start->z[i]) > half)
      continue;
    double d = p->damage_cbrt ? pow(p->damage_cbrt[i], 3) : 0; /* not sph_particles_damage(): its last bits differ */
    double part = p->mass[i] / p->density[i], shear = scales_shear ? 1 - d : 1;
    double pressure = p->pressure[i] < 0 ? (1 - d) * p->pressure[i] : p->pressure[i];
    sum += part * (-pressure + (p->stress[5] ? shear * p->stress[5][i] : 0));
    volume += part;
  }
  return volume > 0 ? sum / volume : 0;
}

/* Amplitude of the mode that the run started with: projection of the velocities on it, over its value at the start. */
static double mode(const struct sph_run *run, const struct sph_particles *p) {
  double sum = 0, norm = 0;
  for (size_t i = 0; i < p->n; i++) {
    sum += p->mass[i] * p->vz[i] * run->start->vz[i];
    norm += p->mass[i] * run->start->vz[i] * run->start->vz[i];
  }
  return norm > 0 ? sum / norm : 0;
}

static void note_crossing(struct sph_state *state, double value, double time) {
  double before = state->mode_before;
  if (before != 0 && value * before < 0) {
    double when = state->mode_time + (time - state->mode_time) * before / (before - value);
    if (state->crossings++ == 0)
      state->crossing_first = when;
    state->crossing_last = when;
  }
  state->mode_before = value;
  state->mode_time = time;
}

static void note_peak(struct sph_state *state, const struct sph_sample *now) {
  if (!(now->stress > state->peak_stress))
    return;
  state->peak_stress = now->stress;
  state->peak_strain = now->strain;
  state->peak_time = now->time;
}

/* Is the largest stress so far at most one interval old? Then every step looks for a larger one: between two samples of
 * a fast stretch the stress moves by some per cent. The peak is over soon, and other steps cost nothing. */
static bool is_at_peak(const struct sph_run *run, double time) {
  return run->inputs.kind == SPH_STRETCH && run->state.peak_stress > 0 &&
         time - run->state.peak_time <= run->sample_interval;
}

void sph_protocol_record(struct sph_run *run) {
  struct sph_state *state = &run->state;
  const double time = run->system->now.time;
  if (!run->sample)
    return;

  const bool due = time >= (double)state->frame.samples * run->sample_interval &&
                   state->frame.samples < run->sample_capacity;
  if (!due && !is_at_peak(run, time))
    return;

  const struct sph_particles *p = sph_run_read(run);
  struct sph_sample sample = {.time = time, .damage = sph_system_damage(run->system, 0, (size_t)run->body_count)};
  if (run->inputs.kind == SPH_STRETCH) {
    sample.strain = run->inputs.stretch.rate * time;
    sample.stress = axial_stress(run, p);
    note_peak(state, &sample);
  } else if (run->inputs.kind == SPH_PISTON) {
    sph_plate_look(run, p, &sample.front, &sample.precursor);
  } else {
    sample.mode = mode(run, p);
    note_crossing(state, sample.mode, time);
  }
  if (due)
    run->sample[state->frame.samples++] = sample;
}
