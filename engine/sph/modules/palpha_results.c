/* The results of module palpha : mean distention, what an impact compacts, and the distention
 * behind the fronts of a plate. */
#include "engine/sph/modules/palpha_results.h"

#include <math.h>

#include "engine/sph/material/derived.h"
#include "engine/sph/observe/observe.h"

#define RESULTS sph_palpha_results

static const struct field rows[] = {
    RESULT_REAL(mean_distention, mean_distention, "1", 1,
                .doc = "Mean distention of the target at the end, weighted by mass, at zero pressure. 1 is solid; off "
                       "without pores.",
                .source = "Jutzi, Benz & Michel 2008"),
    RESULT_SHARE(compaction.mass_fraction, compaction.mass_fraction,
                 .doc =
                     "Impact: mass share of the target that was compacted: its distention at zero pressure fell from "
                     "1.01 or more to below 1.01. Off without pores.",
                 .source = "Jutzi & Benz, figure 2"),
    RESULT_REAL(compaction.volume, compaction.volume, "m^3", 0,
                .doc = "Impact: volume that the retained matter lost as its pores closed; off without pores."),
    RESULT_REAL(compaction.depth, compaction.depth, "m", 0,
                .doc = "Impact: depth at the start of the deepest compacted particle near the axis; off without "
                       "pores."),
    RESULT_REAL(compaction.reach, compaction.reach, "m", 0,
                .doc = "Impact: largest distance from the point of impact at which matter lost a hundredth of its "
                       "pores; off without pores."),
    RESULT_REAL(shock.distention, shock, "1", 1,
                .doc = "Piston: mean distention behind the shock, in the same region; off without pores."),
    RESULT_REAL(shock.distention_exact, shock_exact, "1", 1,
                .doc = "Piston: distention behind the shock by the jump conditions and the crush curve."),
    RESULT_REAL(precursor.distention, precursor, "1", 1, .doc = "Piston: mean distention between precursor and shock."),
    RESULT_REAL(precursor.distention_exact, precursor_exact, "1", 1,
                .doc = "Piston: distention behind the precursor on the elastic branch."),
};
const struct field_table sph_palpha_results = SPH_MODULE_TABLE(sph_palpha_results, rows);

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
  results->palpha.compaction.mass_fraction = sph_results_share(mass, o->mass);
  results->palpha.compaction.volume = sph_results_finite(closed_volume);
  results->palpha.compaction.depth = depth;
  results->palpha.compaction.reach = reach;
}

static void report_fronts(const struct sph_run *run, struct sph_results *r) {
  struct sph_plate_regions regions = sph_plate_regions(run);
  if (run->exact.has_shock) {
    r->palpha.shock = sph_plate_mean(run, run->now->distention, regions.shock);
    r->palpha.shock_exact = run->exact.shock.distention;
  }
  if (run->exact.has_precursor) {
    r->palpha.precursor = sph_plate_mean(run, run->now->distention, regions.precursor);
    r->palpha.precursor_exact = run->exact.precursor.distention;
  }
}

void sph_palpha_results_report(const struct sph_run *run, struct sph_results *results) {
  const struct sph_material *target = &run->inputs.target.material;
  results->palpha.mean_distention = mean_distention(run);
  if (run->inputs.kind == SPH_PISTON)
    report_fronts(run, results);
  const struct sph_crater_options crater = sph_report_crater_options(run);
  if (run->inputs.kind == SPH_IMPACT && crater.count && crater.spacing > 0 && sph_derived_solid_ratio(target) > 1)
    sph_palpha_results_compaction(run->start, run->now, &crater, sph_derived_solid_ratio(target), results);
}
