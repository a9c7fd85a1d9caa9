#include "engine/sph/relax.h"

status sph_relax_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                      struct error *error) {
  (void)lattice;
  (void)shape;
  (void)points;
  return status_fail(error, STATUS_CONTENT, "irregular and graded lattices come with the next landing");
}
