/* Warnings that follow from the inputs before a run. The limits are measured: tests/extremes/map.md. */
#include <math.h>

#include "engine/mesh/mesh.h"
#include "engine/outcome.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"

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

/* Of the exact fronts in a plate: compression by the shock, and the time at which the first one reaches the far side,
 * s. NaN where there is none. */
static void fronts(const struct sph_inputs *in, double *compression, double *arrival) {
  struct sph_plane_shock exact;
  *compression = *arrival = NAN;
  if (in->kind != SPH_PISTON || sph_plane_shock(&in->target.material, in->piston.speed, &exact, NULL))
    return;
  if (exact.has_shock)
    *compression = exact.shock.density / exact.first_density;
  *arrival = in->target.width / (exact.has_precursor ? exact.precursor.speed : exact.shock.speed);
}

/* Bytes that the shape files of the bodies have behind their last triangles. */
static size_t unread(const struct sph_inputs *in) {
  const struct sph_shape target = sph_derived_target(in), projectile = sph_derived_projectile(in);
  return (target.mesh ? target.mesh->tail : 0) +
         (sph_derived_has_projectile(in) && projectile.mesh ? projectile.mesh->tail : 0);
}

static double largest_step(const struct sph_inputs *in) {
  return in->viscosity.alpha < least_viscosity ? largest_undamped_cfl : largest_cfl;
}

static void tell(const struct sph_inputs *in, unsigned set, double compressed, double arrival, FILE *out) {
  const double most = largest_step(in);
  if (set & WARNINGS_STEP)
    fprintf(out,
            "step: fidelity.cfl %g is above %g with viscosity.alpha %g: energy may drift; give a cfl of %g, or more "
            "viscosity\n",
            in->fidelity.cfl, most, in->viscosity.alpha, most == largest_cfl ? 0.3 : 0.15);
  if (set & WARNINGS_CONTRAST)
    fprintf(out,
            "contrast: the densities of target and projectile differ by a factor of %.3g, above %g: energy may drift; "
            "set method.volume_weights: true\n",
            sph_warn_contrast(in), largest_contrast);
  if (set & WARNINGS_PISTON)
    fprintf(out,
            "piston: the shock compresses the plate %.3g-fold, and above %g-fold matter leaks through the piston: "
            "lower piston.speed\n",
            compressed, largest_compression);
  if (set & WARNINGS_KERNEL)
    fprintf(out,
            "kernel: fidelity.smoothing %g is below %g without method.gradient_correction: stresses and wave speeds "
            "are too small; give 1.13, or set method.gradient_correction: true\n",
            in->fidelity.smoothing, least_smoothing);
  if (set & WARNINGS_ARRIVAL)
    fprintf(out,
            "arrival: a wave reaches the far side of the plate at %.4g s, and speeds and plateaus are wrong after "
            "that: give a stop.end_time below, or a larger target.width\n",
            arrival);
  if (set & WARNINGS_LINKS)
    fprintf(
        out,
        "links: particles up to %.4g spacings apart belong together (fragments.link_length times fidelity.smoothing), "
        "but nearest neighbours stand %.4g apart: a whole body counts as many fragments; give a link_length of %.2g\n",
        reach_spacings(in), nearest_spacings(in), 1.36 / in->fidelity.smoothing);
  if (set & WARNINGS_TAIL)
    fprintf(out,
            "tail: the shape file has %zu byte%s behind its last triangle, which are not read: if they are a second "
            "body, write each body into a file of its own\n",
            unread(in), unread(in) == 1 ? "" : "s");
}

unsigned sph_warn_inputs(const struct sph_inputs *in, FILE *out) {
  double compressed, arrival;
  fronts(in, &compressed, &arrival);
  unsigned set = 0;
  if (in->fidelity.cfl > largest_step(in))
    set |= WARNINGS_STEP;
  if (sph_warn_contrast(in) > largest_contrast)
    set |= WARNINGS_CONTRAST;
  if (compressed > largest_compression)
    set |= WARNINGS_PISTON;
  if (in->fidelity.smoothing < least_smoothing && !in->gradient_correction.on)
    set |= WARNINGS_KERNEL;
  if (in->stop.end_time > arrival)
    set |= WARNINGS_ARRIVAL;
  if (reach_spacings(in) <= nearest_spacings(in))
    set |= WARNINGS_LINKS;
  if (unread(in))
    set |= WARNINGS_TAIL;
  if (out)
    tell(in, set, compressed, arrival, out);
  return set;
}
