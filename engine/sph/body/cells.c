/* Sorts the particles of a body into the cubes of a turned grid. */
#include "engine/sph/body/cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/random.h"

struct place {
  int64_t cube[3];
  uint32_t particle;
};

static int by_cube(const void *a, const void *b) {
  const struct place *p = a, *q = b;
  for (int d = 0; d < 3; d++)
    if (p->cube[d] != q->cube[d])
      return p->cube[d] < q->cube[d] ? -1 : 1;
  return (p->particle > q->particle) - (p->particle < q->particle);
}

/* Finds the cube of each particle. `shift` is in cube widths. */
static void find_cubes(const struct sph_particles *p, struct sph_range range, const double frame[3][3], double width,
                       const double shift[3], struct place *place) {
  for (size_t i = 0; i < range.n; i++) {
    const size_t k = range.first + i;
    place[i].particle = (uint32_t)i;
    for (int d = 0; d < 3; d++) {
      const double along = frame[d][0] * p->x[k] + frame[d][1] * p->y[k] + frame[d][2] * p->z[k];
      place[i].cube[d] = (int64_t)fmax(-1e18, fmin(1e18, floor(along / width + shift[d])));
    }
  }
}

status sph_cells_make(uint64_t seed, uint64_t body, double width, const struct sph_particles *p, struct sph_range range,
                      struct sph_cells **out, struct error *error) {
  double frame[3][3], shift[3];
  struct sph_cells *cells = calloc(1, sizeof *cells);
  struct place *place = malloc((range.n ? range.n : 1) * sizeof *place);
  if (cells)
    cells->of = malloc((range.n ? range.n : 1) * sizeof *cells->of);
  *out = NULL;
  if (!cells || !cells->of || !place) {
    sph_cells_free(cells);
    free(place);
    return status_fail(error, STATUS_MEMORY, "no memory for the cells of %zu particles", range.n);
  }
  random_rotation(seed, RANDOM_CELL, body, 0, frame);
  for (int d = 0; d < 3; d++)
    shift[d] = random_draw(seed, RANDOM_CELL, body, 1 + (uint64_t)d);
  find_cubes(p, range, frame, width, shift, place);
  qsort(place, range.n, sizeof *place, by_cube);
  cells->particles = range.n;
  for (size_t i = 0; i < range.n; i++) {
    cells->count += i == 0 || memcmp(place[i].cube, place[i - 1].cube, sizeof place[i].cube) != 0;
    cells->of[place[i].particle] = (uint32_t)(cells->count - 1);
  }
  free(place);
  *out = cells;
  return STATUS_OK;
}

void sph_cells_free(struct sph_cells *cells) {
  if (!cells)
    return;
  free(cells->of);
  free(cells);
}
