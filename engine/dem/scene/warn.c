/* Warnings that follow from the inputs before a run. The limits are measured: tests/extremes/map.md. */
#include <math.h>

#include "engine/dem/run/run.h"

/* Verlet's energy drifts by 1 % in some runs from 0.28 of the longest stable step on. */
static const double largest_step = 0.25;
/* Damping over a time step: some runs drift by 1 % from 0.1 on. */
static const double largest_damping = 0.05;

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

double dem_warn_stable_step(const struct dem_inputs *in) {
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  const double verlet = 0.74 * in->grain.spacing / compression; /* 15 us of the paper's disc */
  return in->fidelity.integrator == DEM_GEAR ? 0.27 * verlet : verlet;
}

double dem_warn_damping(const struct dem_inputs *in) {
  if (in->contact.law == DEM_CONTACT_OFF)
    return 0;
  const double sliding = in->contact.friction > 0 ? in->contact.tangential_damping : 0; /* Coulomb bounds it */
  return fmax(in->contact.normal_damping, sliding);
}

unsigned dem_warn_known(const struct dem_inputs *in, double stable_step) {
  unsigned set = 0;
  if (in->fidelity.time_step > largest_step * stable_step)
    set |= WARNINGS_STEP;
  if (dem_warn_damping(in) * in->fidelity.time_step > largest_damping)
    set |= WARNINGS_DAMPING;
  return set;
}

unsigned dem_warn_inputs(const struct dem_inputs *in, FILE *out) {
  const double step = in->fidelity.time_step, stable = dem_warn_stable_step(in);
  const double passing = dem_describe_passing_speed(in), closing = closing_speed(in), damping = dem_warn_damping(in);
  unsigned set = dem_warn_known(in, stable);
  if (passing > 0 && closing > passing)
    set |= WARNINGS_PASSING;
  if (!out)
    return set;
  if (set & WARNINGS_STEP)
    fprintf(
        out,
        "step: fidelity.time_step %.3g s is above %g of the longest stable step, about %.2g s here: energy may drift; "
        "give %.2g s\n",
        step, largest_step, stable, 0.1 * stable);
  if (set & WARNINGS_DAMPING)
    fprintf(
        out,
        "damping: %.3g /s of contact damping over a time step of %.3g s is above %g: give a time step of %.2g s, or "
        "less damping\n",
        damping, step, largest_damping, largest_damping / damping);
  if (set & WARNINGS_PASSING)
    fprintf(out,
            "passing: grains meet at about %.3g m/s; above %.3g m/s they pass through each other: lower the speed, or "
            "raise grain.young_modulus\n",
            closing, passing);
  return set;
}
