/* Finds the point of each member and the values of its runs. */
#include "campaign/fit/fit_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Values of one point and one quantity by replicate. */
struct taking {
  const struct observed_datum *datum;
  const uint64_t *seeds;
  double *values;
  size_t count;
};

static void take(void *context, uint64_t seed, double value) {
  const struct taking *taking = context;
  for (size_t r = 0; r < taking->count; r++)
    if (taking->seeds[r] == seed)
      taking->values[r] = fit_transform(taking->datum, value);
}

/* The scene of a member of the shot. NULL with *error. */
static struct scene *scene_of(const struct fit *fit, const double *z, struct error *error) {
  const struct campaign *campaign = fit->campaign;
  struct campaign shot = *campaign;
  struct field_value *values = calloc(campaign->axis_count, sizeof *values);
  if (!values) {
    status_fail(error, STATUS_MEMORY, "no memory for a point");
    return NULL;
  }
  shot.scene = fit->observed->shots[fit->shot].scene;
  for (size_t i = 0; i < fit->inputs; i++)
    fit_value(fit, i, z[i], &values[fit->axis[i]]);
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (campaign->axes[i].kind == DESIGN_AXIS_LINKED)
      design_axis_follow(&campaign->axes[i], &values[campaign->axes[i].linked], 0, &values[i]);
  struct scene *scene = campaign_point_scene(&shot, values, error);
  free(values);
  return scene;
}

/* Reads the values of the shot's data at a point of the store; point 0: it has none. */
static status read_data(const struct fit *fit, struct store *store, const struct scene *scene, int64_t point,
                        const uint64_t *seeds, size_t count, double *values, size_t stride, struct error *error) {
  status code = STATUS_OK;
  for (size_t k = 0; code == STATUS_OK && k < fit->observed->datum_count; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    if (datum->shot != fit->shot)
      continue;
    const struct taking taking = {datum, seeds, values + k * stride, count};
    for (size_t r = 0; r < count; r++)
      taking.values[r] = NAN;
    if (point)
      code = ask_specimens(store, point, scene->kind, &datum->ask, take, (void *)&taking, error);
  }
  return code;
}

/* Reads `count` replicates of the shot's data at z; the values of datum k begin at values + k * stride. A point that
 * cannot be run has no values. */
static status read_point(const struct fit *fit, struct store *store, const double *z, bool independent, size_t count,
                         double *values, size_t stride, struct error *error) {
  struct error invalid = {0};
  struct campaign own = *fit->campaign;
  struct scene *scene = scene_of(fit, z, &invalid);
  uint64_t *seeds = calloc(count, sizeof *seeds);
  int64_t point = 0;
  status code = seeds ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a point");
  own.independent = independent;
  for (size_t r = 0; seeds && scene && r < count; r++)
    seeds[r] = campaign_seed(&own, scene, (int64_t)r);
  if (code == STATUS_OK && scene)
    code = store_point_find(store, scene, &point, error);
  if (code == STATUS_OK)
    code = read_data(fit, store, scene, point, seeds, count, values, stride, error);
  free(seeds);
  scene_free(scene);
  return code;
}

status fit_values_read(struct fit *fit, struct store *store, const double *z, struct error *error) {
  const size_t d = fit->observed->datum_count, r = fit->replicates;
  status code = STATUS_OK;
  for (size_t j = 0; code == STATUS_OK && j < fit->members; j++)
    code = read_point(fit, store, z + j * fit->inputs, fit->campaign->independent, r,
                      fit->values + (fit->points + j) * d * r, r, error);
  return code;
}

status fit_values_check(struct fit *fit, struct store *store, const double *z, struct error *error) {
  const size_t d = fit->observed->datum_count, n = (size_t)fit->observed->shots[fit->shot].specimens;
  double *values = calloc(n * d, sizeof *values);
  status code = values ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a check");
  for (size_t j = 0; code == STATUS_OK && j < fit->proposed; j++) {
    code = read_point(fit, store, z + j * fit->inputs, true, n, values, n, error);
    for (size_t k = 0; code == STATUS_OK && k < d; k++) {
      if (fit->observed->data[k].shot != fit->shot)
        continue;
      double sum = 0;
      for (size_t r = 0; r < n; r++)
        sum += values[k * n + r];
      fit->specimens[j * d + k] = sum / (double)n;
    }
  }
  free(values);
  return code;
}

struct surfaces_runs fit_values_runs(const struct fit *fit, double *packed) {
  const size_t d = fit->observed->datum_count, r = fit->replicates;
  for (size_t i = 0; i < fit->points; i++)
    for (size_t k = 0; k < d; k++)
      memcpy(packed + (k * fit->points + i) * r, fit->values + (i * d + k) * r, r * sizeof *packed);
  return (struct surfaces_runs){.points = fit->points,
                                .inputs = fit->inputs,
                                .outputs = d,
                                .replicates = r,
                                .z = fit->z,
                                .values = packed,
                                .shared_seeds = !fit->campaign->independent};
}
