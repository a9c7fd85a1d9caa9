/* Records of stretch, vibration and piston during a run, at equal intervals of simulated time. */
#include <math.h>
#include <stdlib.h>

#include "engine/sph/modules/modules.h"
#include "engine/sph/observe/observe.h"

enum { SAMPLES = 400 }; /* over the whole run: a sample costs about a tenth of a step */

status sph_protocol_record_start(struct sph_run *run, struct error *error) {
  if (run->inputs.kind != SPH_STRETCH && run->inputs.kind != SPH_VIBRATION && run->inputs.kind != SPH_PISTON)
    return STATUS_OK;
  status code = run->inputs.kind == SPH_PISTON ? sph_plate_start(run, error) : STATUS_OK;
  if (code)
    return code;
  run->sample_interval = run->inputs.stop.end_time / SAMPLES;
  run->sample_capacity = SAMPLES + 2;
  run->sample = calloc(run->sample_capacity, sizeof *run->sample);
  return run->sample ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for %zu samples", run->sample_capacity);
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
  const double time = sph_system_time(run->system);
  if (!run->sample)
    return;

  const bool due = time >= (double)state->frame.samples * run->sample_interval &&
                   state->frame.samples < run->sample_capacity;
  if (!due && !is_at_peak(run, time))
    return;

  const struct sph_particles *p = sph_run_read(run);
  struct sph_sample sample = {.time = time, .damage = sph_system_damage(run->system, NULL)};
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
