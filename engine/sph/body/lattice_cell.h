/* Shared by lattice.c, lattice_cut.c and irregular.c: unit cells, and memory for places. */
#ifndef CLAST_ENGINE_SPH_BODY_LATTICE_CELL_H
#define CLAST_ENGINE_SPH_BODY_LATTICE_CELL_H

#include "engine/sph/body/lattice.h"

/* A right-angled cell with particles at `basis` (fractions of its sides). Lengths are in spacings: the hexagonal
 * lattice's neighbours are 2^(1/6) apart, its rows sqrt(3)/2 and its layers sqrt(2/3) of that. */
struct sph_lattice_cell {
  double side[3]; /* distance of particles in a row, of rows, of layers */
  int period[3];  /* particles in a row, rows, layers until the lattice repeats */
  int count;
  double basis[4][3];
};

/* The period of a lattice along a direction, in spacings. */
static inline double sph_lattice_cell_period(const struct sph_lattice_cell *cell, int direction) {
  return cell->side[direction] * cell->period[direction];
}

/* Memory for n places. STATUS_MEMORY. */
status sph_lattice_allocate(struct sph_points *points, size_t n, struct error *error);
/* The refusal of a body that has no room for its particles. */
status sph_lattice_too_thin(double wanted, double spacing, struct error *error);

/* lattice_cut.c: the places of a lattice that are inside a shape, about `wanted` of them. */
status sph_lattice_cut_fill(const struct sph_lattice *lattice, const struct sph_lattice_cell *cell,
                            const struct sph_shape *shape, double wanted, struct sph_points *points,
                            struct error *error);

#endif
