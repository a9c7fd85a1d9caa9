/* Cells that crack as one (module crack_cell): which particles share a cell, the flaws of a cell, the values that its
 * particles share, and identical bits after a restart. The body is a cube under tension along z, whose ends are held.
 */
#include "engine/sph/body/flaws.h"
#include "engine/sph/material/material.h"
#include "engine/sph/step/system.h"
#include "tests/support/sph_solid.h"

static const double side = 0.01, load = 1e-3; /* m; strain: more than twice the threshold of the weakest flaw */

static struct solid_case pulled(double width, uint64_t seed, struct sph_flaws **flaws) {
  struct solid_case c = solid_pulled_cube(side, load);
  const struct sph_flaw_law law = {.weibull = c.physics[0].material.weibull,
                                   .draw = SPH_FLAWS_POISSON,
                                   .seed = seed,
                                   .cell_width = width};
  OK(sph_flaws_place(&law, &c.body[0].shape, c.particles, c.range[0], INFINITY, flaws, &error));
  c.parameters.in.crack_cell.width = width;
  c.physics[0].flaws = *flaws;
  return c;
}

/* Two particles of a cell are no farther apart than the diagonal of a cube. There are as many cells as whole cubes and
 * cubes cut by the surface. Each cell has a particle. The same seed gives the same cells, another seed other cells. */
TEST(cubes) {
  struct sph_flaws *flaws;
  struct sph_cells *cells[3];
  const double width = side / 4;
  struct solid_case c = pulled(0, 1, &flaws);
  const struct sph_particles *p = c.particles;
  for (uint64_t k = 0; k < 3; k++)
    OK(sph_flaws_cells(1 + k % 2, 0, width, p, c.range[0], &cells[k], &error));
  assert_true(cells[0]->count > 64 && cells[0]->count < 216); /* the cube is cut by a turned grid */
  OWNED unsigned char *seen = calloc(cells[0]->count, 1);
  for (size_t i = 0; i < p->n; i++) {
    seen[cells[0]->of[i]] = 1;
    for (size_t j = 0; j < i; j++)
      if (cells[0]->of[i] == cells[0]->of[j])
        assert_true(hypot(hypot(p->x[i] - p->x[j], p->y[i] - p->y[j]), p->z[i] - p->z[j]) <= sqrt(3) * width);
  }
  assert_null(memchr(seen, 0, cells[0]->count));
  assert_memory_not_equal(cells[0]->of, cells[1]->of, p->n * sizeof *cells[0]->of);
  assert_memory_equal(cells[0]->of, cells[2]->of, p->n * sizeof *cells[0]->of);
  for (int k = 0; k < 3; k++)
    free(cells[k]);
  sph_flaws_free(flaws);
  solid_end(&c);
}

/* The weakest flaw of a cell follows Weibull's law of its volume: k V eps_1^m is an exponential number of mean 1. Cells
 * of 300 seeds, each weighted alike: the mean of n such numbers scatters by n^(-1/2). */
TEST(weakest_flaw) {
  const struct sph_weibull_material law = solid_basalt().weibull;
  double sum = 0, count = 0;
  for (uint64_t seed = 1; seed <= 300; seed++) {
    struct sph_flaws *flaws;
    struct solid_case c = pulled(side / 2, seed, &flaws);
    const struct sph_cells *cells = flaws->cells;
    OWNED double *volume = calloc(cells->count, sizeof *volume);
    assert_int_equal(flaws->particles, c.particles->n);
    for (size_t i = 0; i < c.particles->n; i++)
      volume[cells->of[i]] += side * side * side / (double)c.particles->n;
    for (size_t k = 0; k < cells->count; k++) {
      assert_true(flaws->first[k + 1] > flaws->first[k]);
      sum += law.k * volume[k] * exp(law.m * flaws->log_strain[flaws->first[k]]);
      count++;
    }
    sph_flaws_free(flaws);
    solid_end(&c);
  }
  assert_true(count > 2000);
  assert_true(fabs(sum / count - 1) < 4 / sqrt(count));
}

/* All particles of a cell have the same damage, to the bit, the mean stress of the cell, and the rate of damage c_g/R_s
 * with R_s of its volume. Some cells break. */
TEST(shared) {
  struct sph_flaws *flaws;
  struct solid_case c = pulled(side / 4, 1, &flaws);
  const size_t n = c.particles->n, cells = flaws->cells->count;
  solid_start(&c);
  for (int step = 0; step < 30; step++)
    solid_step(&c, INFINITY);
  const struct sph_system *s = c.system;
  OWNED double *damage = malloc(cells * sizeof *damage), *pressure = malloc(cells * sizeof *pressure);
  size_t broken = 0, different = 0;
  memset(damage, 0xff, cells * sizeof *damage); /* NaN */
  for (size_t i = 0; i < n; i++) {
    const size_t k = flaws->cells->of[s->id[i]];
    if (isnan(damage[k])) {
      damage[k] = s->c.damage[i];
      pressure[k] = s->c.crack_pressure[i];
      broken += damage[k] > 0;
    }
    assert_true(s->c.damage[i] == damage[k] && s->c.crack_pressure[i] == pressure[k]);
    different += s->c.pressure[i] != pressure[k];
  }
  assert_true(broken > cells / 10 && broken < cells);
  assert_true(different > n / 2);
  for (size_t k = 0; k < cells; k++) { /* the end of the step has changed densities by less than 1e-3 since */
    double sum = 0, volume = 0, largest = 0, at_start = 0, rate = NAN;
    for (size_t i = 0; i < n; i++)
      if (flaws->cells->of[s->id[i]] == k) {
        const double own = s->c.mass[i] / s->c.density[i];
        sum += own * s->c.pressure[i];
        volume += own;
        at_start += c.particles->mass[s->id[i]] / c.particles->density[s->id[i]];
        rate = s->c.crack_rate[i];
        largest = fmax(largest, fabs(s->c.pressure[i]));
      }
    assert_true(fabs(sum / volume - pressure[k]) < 1e-3 * largest);
    const double radius = cbrt(3 * at_start / (4 * M_PI));
    assert_true(fabs(rate * radius / sph_material_crack_speed(&c.physics[0].material) - 1) < 1e-12); /* rounding */
  }
  sph_flaws_free(flaws);
  solid_end(&c);
}

/* Cells of one particle act like particles: the same flaws up to rounding, and the same damage. */
TEST(one_particle_each) {
  struct sph_flaws *flaws[2];
  struct solid_case c[2] = {pulled(0, 3, &flaws[0]), pulled(1e-5, 3, &flaws[1])};
  assert_int_equal(flaws[1]->cells->count, c[1].particles->n);
  assert_int_equal(flaws[0]->count, flaws[1]->count);
  for (int k = 0; k < 2; k++) {
    solid_start(&c[k]);
    for (int step = 0; step < 20; step++)
      solid_step(&c[k], INFINITY);
  }
  const struct sph_system *a = c[0].system, *b = c[1].system;
  size_t broken = 0;
  for (size_t i = 0; i < a->n; i++) {
    assert_int_equal(a->id[i], b->id[i]);
    assert_true(fabs(a->c.damage[i] - b->c.damage[i]) < 1e-9);
    broken += a->c.damage[i] > 0;
  }
  assert_true(broken > 100);
  for (int k = 0; k < 2; k++) {
    sph_flaws_free(flaws[k]);
    solid_end(&c[k]);
  }
}

/* The same bits after a restart while cells break, and with two threads. */
TEST(same_bits) {
  struct sph_flaws *flaws;
  struct solid_case c = pulled(side / 4, 1, &flaws), again = c;
  again.parameters.in.fidelity.threads = 2;
  solid_start(&c);
  for (int step = 0; step < 10; step++)
    solid_step(&c, INFINITY);
  solid_resume(&again, c.system);
  for (int step = 0; step < 10; step++) {
    solid_step(&c, INFINITY);
    solid_step(&again, INFINITY);
  }
  solid_same(&c, &again);
  sph_system_free(again.system);
  sph_flaws_free(flaws);
  solid_end(&c);
}
