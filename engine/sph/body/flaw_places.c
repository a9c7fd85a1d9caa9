#include "engine/sph/body/flaw_places.h"

#include <math.h>
#include <stdlib.h>

#include "engine/random.h"
#include "engine/sph/body/kd_tree.h"

struct places {
  const struct sph_shape *shape;
  const struct sph_middle *middle;
  const struct sph_kd_tree *nearest;
  const unsigned char *exempt;
  uint64_t seed, body;
};

void sph_flaw_places_point(uint64_t seed, uint64_t body, uint64_t flaw, const struct sph_shape *shape,
                           double point[3]) {
  uint64_t bits[4];
  random_bits(seed, RANDOM_FLAW_PLACE, body, flaw, bits);
  sph_shape_place(shape, (double[3]){random_uniform(bits[0]), random_uniform(bits[1]), random_uniform(bits[2])}, point);
}

static size_t owner(void *context, uint64_t flaw) {
  const struct places *places = context;
  double point[3];
  sph_flaw_places_point(places->seed, places->body, flaw, places->shape, point);
  if (places->middle && sph_bodies_beyond(places->middle, point))
    return SPH_FLAWS_NOBODY;
  const size_t i = sph_kd_tree_find(places->nearest, point);
  return places->exempt && places->exempt[i] ? SPH_FLAWS_NOBODY : i;
}

status sph_flaw_places_make(const struct sph_flaw_law *law, const struct sph_shape *shape,
                            const struct sph_particles *p, struct sph_range range, const struct sph_middle *middle,
                            struct sph_flaws **out, struct error *error) {
  *out = NULL;
  const size_t n = range.n, first = range.first;
  unsigned char *exempt = NULL;
  double *share = NULL;
  struct sph_kd_tree *nearest = NULL;
  struct sph_flaw_law full = *law;
  status code = sph_shape_check(shape, error);
  if (code)
    goto cleanup;
  if (!n) {
    code = status_fail(error, STATUS_CONTENT, "a body of no particles has no flaws.");
    goto cleanup;
  }
  full.volume = sph_shape_volume(shape) / (p->distention ? p->distention[first] : 1);
  bool graded = false;
  for (size_t i = 1; i < n && !graded; i++)
    graded = p->mass[first + i] != p->mass[first];
  if (middle) {
    exempt = malloc(n);
    if (!exempt)
      code = status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", n);
    for (size_t i = 0; i < n && exempt; i++)
      exempt[i] = sph_bodies_beyond(middle, (double[3]){p->x[first + i], p->y[first + i], p->z[first + i]});
  }
  if (graded) {
    share = malloc(n * sizeof *share);
    if (!share)
      code = status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", n);
    for (size_t i = 0; i < n && share; i++)
      share[i] = p->mass[first + i] / range.mass;
    full.number = (uint64_t)ceil((double)n * (log((double)n) + 0.5772156649015329));
  }
  if (code)
    goto cleanup;
  full.exempt = exempt;
  full.share = share;
  code = sph_kd_tree_create(n, p->x + first, p->y + first, p->z + first, &nearest, error);
  if (code)
    goto cleanup;
  struct places places = {shape, middle, nearest, exempt, law->seed, law->body};
  code = sph_flaws_make(&full, n, owner, &places, 0, out, error);
cleanup:
  sph_kd_tree_free(nearest);
  free(exempt);
  free(share);
  return code;
}
