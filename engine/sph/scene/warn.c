/* Warnings that follow from the inputs before a run. The limits are measured: tests/extremes/map.md. */
#include <math.h>

#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "engine/warnings.h"

/* Without much viscosity the energy drifts at smaller steps, too. */
static const double largest_cfl = 0.5, largest_undamped_cfl = 0.2, least_viscosity = 0.5;
/* Densities of bodies that touch: without volume weights the energy drifts by 1 % in some runs from 3.1 on. */
static const double largest_contrast = 3;
/* Compression that four layers of piston hold (tests/verification/sph_palpha_plate.md). */
static const double largest_compression = 1.8;

double sph_warn_contrast(const struct sph_inputs *in) {
  if (!sph_derived_has_projectile(in) || in->method.volume_weights)
    return 1;
  const double target = sph_derived_density(&in->target), projectile = sph_derived_density(&in->projectile);
  return fmax(target, projectile) / fmin(target, projectile);
}

/* Without the gradient correction a plate's shock is 2.5 % too weak at 0.9, 5 % at 0.85 and 20 % at 0.7. */
static const double least_smoothing = 0.9;

/* Distance of nearest neighbours at rest over the spacing. Of irregular bodies, the distance from which all particles
 * hang together: 1.07 with 300 particles, 1.11 with 10 000. */
static double nearest_spacings(const struct sph_inputs *in) {
  return in->target.lattice == SPH_LATTICE_CUBIC ? 1 : 1.122462048309373;
}

/* Distance over the spacing up to which particles at rest belong together. */
static double reach_spacings(const struct sph_inputs *in) {
  return in->fragments.link_length * in->fidelity.smoothing;
}

/* Compression of the exact shock; NaN without one. */
static double compression(const struct sph_inputs *in) {
  struct sph_plane_shock exact;
  if (in->kind != SPH_PISTON || sph_plane_shock(&in->target.material, in->piston.speed, &exact, NULL) ||
      !exact.has_shock)
    return (double)NAN;
  return exact.shock.density / exact.first_density;
}

unsigned sph_warn_inputs(const struct sph_inputs *in, FILE *out) {
  const double contrast = sph_warn_contrast(in), compressed = compression(in);
  const double most = in->viscosity.alpha < least_viscosity ? largest_undamped_cfl : largest_cfl;
  unsigned set = 0;
  if (in->fidelity.cfl > most)
    set |= WARNINGS_STEP;
  if (contrast > largest_contrast)
    set |= WARNINGS_CONTRAST;
  if (compressed > largest_compression)
    set |= WARNINGS_PISTON;
  if (in->fidelity.smoothing < least_smoothing && !in->method.gradient_correction)
    set |= WARNINGS_KERNEL;
  if (reach_spacings(in) <= nearest_spacings(in))
    set |= WARNINGS_LINKS;
  if (!out)
    return set;
  if (set & WARNINGS_STEP)
    fprintf(out,
            "step: fidelity.cfl %g is above %g with viscosity.alpha %g: energy may drift; give a cfl of %g, or more "
            "viscosity\n",
            in->fidelity.cfl, most, in->viscosity.alpha, most == largest_cfl ? 0.3 : 0.15);
  if (set & WARNINGS_CONTRAST)
    fprintf(
        out,
        "contrast: the densities of target and projectile differ by a factor of %.3g, above %g: energy may drift; set "
        "method.volume_weights: true\n",
        contrast, largest_contrast);
  if (set & WARNINGS_PISTON)
    fprintf(
        out,
        "piston: the shock compresses the plate %.3g-fold, and above %g-fold matter leaks through the piston: lower "
        "piston.speed\n",
        compressed, largest_compression);
  if (set & WARNINGS_KERNEL)
    fprintf(
        out,
        "kernel: fidelity.smoothing %g is below %g without method.gradient_correction: stresses and wave speeds are "
        "too small; give 1.13, or set method.gradient_correction: true\n",
        in->fidelity.smoothing, least_smoothing);
  if (set & WARNINGS_LINKS)
    fprintf(out,
            "links: particles up to %.4g spacings apart belong together (fragments.link_length times "
            "fidelity.smoothing), but nearest neighbours stand %.4g apart: a whole body counts as many fragments; give "
            "a link_length of %.2g\n",
            reach_spacings(in), nearest_spacings(in), 1.36 / in->fidelity.smoothing);
  return set;
}
