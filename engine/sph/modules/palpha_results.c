/* The results of module palpha (palpha.h has their rows): mean distention, what an impact compacts, and the distention
 * behind the fronts of a plate. */
#include "engine/sph/modules/palpha_results.h"

#include <math.h>

#include "engine/sph/material/derived.h"
#include "engine/sph/observe/observe.h"

static const double compacted = 1.01; /* distention below which matter counts as compacted */

/* Of the target, by mass. */
static double mean_distention(const struct sph_run *run) {
  const struct sph_particles *p = run->now;
  double mass = 0, distention = 0;
  for (size_t i = 0; i < run->targets; i++) {
    mass += p->mass[i];
    distention += p->mass[i] * p->rest_distention[i];
  }
  return mass > 0 ? sph_results_finite(distention / mass) : (double)NAN;
}

/* By the distention at P = 0. Fractured matter is under (undamaged) tension, which opens the pores of the elastic
 * branch again; at rest only permanently closed pores count. */
void sph_palpha_results_compaction(const struct sph_particles *start, const struct sph_particles *now,
                                   const struct sph_crater_options *o, double initial, struct sph_results *results) {
  const double top = sph_crater_top(start, o, 2);
  double ejecta_volume = 0, mass = 0, closed_volume = 0, depth = 0, reach = 0;
  for (size_t i = o->first; i < o->first + o->count; i++) {
    double alpha = now->rest_distention[i], alpha_start = start->distention[i];
    double closed = (alpha_start - alpha) / alpha_start;
    double volume = start->mass[i] / start->density[i];
    bool crushed = closed > 0 && alpha < compacted && alpha_start >= compacted;
    if (crushed)
      mass += now->mass[i];
    if (sph_crater_is_ejected(now, i, o)) {
      ejecta_volume += volume;
      continue;
    }
    closed_volume += fmax(closed, 0) * volume; /* the volume of the solid does not change */
    if (crushed && sph_crater_off_axis(start, i, o) < 2 * o->spacing)
      depth = fmax(depth, top - start->z[i]);
    if (closed > 0 && alpha_start - alpha > 0.01 * (initial - 1))
      reach = fmax(reach, hypot(sph_crater_off_axis(start, i, o), top - start->z[i]));
  }
  results->crater.compaction_share = sph_results_share(closed_volume, closed_volume + ejecta_volume);
  results->compaction.mass_fraction = sph_results_share(mass, o->mass);
  results->compaction.volume = sph_results_finite(closed_volume);
  results->compaction.depth = depth;
  results->compaction.reach = reach;
}

static void report_fronts(const struct sph_run *run, struct sph_results *r) {
  struct sph_plate_regions regions = sph_plate_regions(run);
  if (run->exact.has_shock) {
    r->shock.distention = sph_plate_mean(run, run->now->distention, regions.shock);
    r->shock.distention_exact = run->exact.shock.distention;
  }
  if (run->exact.has_precursor) {
    r->precursor.distention = sph_plate_mean(run, run->now->distention, regions.precursor);
    r->precursor.distention_exact = run->exact.precursor.distention;
  }
}

void sph_palpha_results(const struct sph_run *run, struct sph_results *results) {
  const struct sph_material *target = &run->inputs.target.material;
  results->mean_distention = mean_distention(run);
  if (run->inputs.kind == SPH_PISTON)
    report_fronts(run, results);
  const struct sph_crater_options crater = sph_report_crater_options(run);
  if (run->inputs.kind == SPH_IMPACT && crater.count && crater.spacing > 0 && sph_derived_solid_ratio(target) > 1)
    sph_palpha_results_compaction(run->start, run->now, &crater, sph_derived_solid_ratio(target), results);
}
