/* Beams against exact answers: the 6x6 stiffness, the energy's gradient, a cantilever, the square lattice. */
#include "tests/verification/dem_fixture.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

static const double h = 0.01;

static void set(struct dem_system *s, size_t freedom, double value) {
  double *const column[3] = {s->c.x, s->c.y, s->c.angle};
  column[freedom % 3][freedom / 3] += value;
  s->now.ready = 0;
}

static double force(const struct dem_system *s, size_t freedom) {
  const double *const column[3] = {s->c.fx, s->c.fy, s->c.torque};
  return column[freedom % 3][freedom / 3];
}

/* K = -dF/du by central differences at the current state; angles are scaled by `arm` so that all entries are N/m. */
static void stiffness(struct dem_system *s, size_t freedoms, double arm, double *k) {
  const double step = 1e-7 * h; /* central: error 1e-14 relative from the third derivative, 1e-9 from rounding */
  for (size_t a = 0; a < freedoms; a++) {
    const double unit = a % 3 == 2 ? 1.0 / arm : 1.0;
    for (int sign = -1; sign <= 1; sign += 2) {
      set(s, a, sign * step * unit);
      fixture_evaluate(s);
      for (size_t b = 0; b < freedoms; b++)
        k[b * freedoms + a] = (sign < 0 ? 0.0 : k[b * freedoms + a]) -
                              sign * force(s, b) * (b % 3 == 2 ? 1.0 / arm : 1.0);
      if (sign < 0)
        for (size_t b = 0; b < freedoms; b++)
          k[b * freedoms + a] = force(s, b) * (b % 3 == 2 ? 1.0 / arm : 1.0);
      set(s, a, -sign * step * unit);
    }
    for (size_t b = 0; b < freedoms; b++)
      k[b * freedoms + a] /= 2.0 * step;
  }
}

/* Two bonded squares: the stiffness is Timoshenko's, symmetric, three zero modes, none negative. */
TEST(stiffness_is_timoshenko) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_OFF;
  DEM_SYSTEM *s = fixture_create(t, &in);
  double k[36];
  stiffness(s, 6, h, k);
  /* b = 2a is G = E/2; phi = 12 EI/(G S l^2) = 2 for a square beam. */
  const double e = in.beam.young_modulus, l = h, side = h, i = side * side * side / 12.0,
               phi = 12.0 * e * i / (0.5 * e * side * l * l);
  const double axial = e * side / l, q = 12.0 * e * i / (l * l * l * (1.0 + phi)), near = (4.0 + phi) / 12.0,
               far = (2.0 - phi) / 12.0;
  const double expected[6][6] = {/* x1 y1 a1 x2 y2 a2, angles times l */
                                 {axial, 0, 0, -axial, 0, 0},
                                 {0, q, q / 2, 0, -q, q / 2},
                                 {0, q / 2, q * near, 0, -q / 2, q * far},
                                 {-axial, 0, 0, axial, 0, 0},
                                 {0, -q, -q / 2, 0, q, -q / 2},
                                 {0, q / 2, q * far, 0, -q / 2, q * near}};
  for (size_t a = 0; a < 36; a++) /* 1e-6: rounding of forces over the step, 1e-16 / 1e-7 and some */
    fixture_near(k[a], expected[a / 6][a % 6], 1e-6 * axial, "stiffness");
  gsl_matrix_view m = gsl_matrix_view_array(k, 6, 6);
  gsl_vector *values = gsl_vector_alloc(6);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(6);
  gsl_eigen_symm(&m.matrix, values, work);
  int zero = 0;
  for (size_t a = 0; a < 6; a++) {
    assert_true(gsl_vector_get(values, a) > -1e-6 * axial);
    zero += gsl_vector_get(values, a) < 1e-6 * axial;
  }
  assert_int_equal(zero, 3);
  gsl_eigen_symm_free(work);
  gsl_vector_free(values);
}

/* Force = -dU/du at large deformations, and momentum and angular momentum balance there. */
TEST(force_is_the_energys_gradient) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_OFF;
  DEM_SYSTEM *s = fixture_create(t, &in);
  uint64_t seed = 1;
  for (int trial = 0; trial < 50; trial++) {
    const double turn = 3.0 * fixture_random(&seed);
    fixture_place(s, 0, 0.2 * h * fixture_random(&seed), 0.2 * h * fixture_random(&seed),
                  turn + 0.3 * fixture_random(&seed));
    fixture_place(s, 1, h * cos(turn) + 0.2 * h * fixture_random(&seed),
                  h * sin(turn) + 0.2 * h * fixture_random(&seed), turn + 0.3 * fixture_random(&seed));
    fixture_evaluate(s);
    double f[6], largest = 0.0;
    for (size_t a = 0; a < 6; a++) {
      f[a] = force(s, a);
      largest = fmax(largest, fabs(f[a]) / (a % 3 == 2 ? h : 1.0));
    }
    for (size_t a = 0; a < 6; a++) {
      const double step = a % 3 == 2 ? 1e-5 : 1e-5 * h;
      set(s, a, step);
      fixture_evaluate(s);
      const double up = fixture_potential(s);
      set(s, a, -2.0 * step);
      fixture_evaluate(s);
      const double down = fixture_potential(s);
      set(s, a, step);
      /* central difference: truncation (1e-5)^2 and rounding 1e-16/1e-5, of forces that are E h times strains of 0.1 */
      fixture_near(f[a], -(up - down) / (2.0 * step), 1e-7 * in.beam.young_modulus * h * (a % 3 == 2 ? h : 1.0),
                   "gradient");
    }
    fixture_near(f[0] + f[3], 0.0, 0.0, "momentum");
    const double about = s->c.x[0] * f[1] - s->c.y[0] * f[0] + f[2] + s->c.x[1] * f[4] - s->c.y[1] * f[3] + f[5];
    fixture_near(about, 0.0, 1e-14 * largest * h * 10.0, "angular momentum"); /* some roundings of l F */
  }
}

/* A beam rotated as a whole, by any angle and several turns, has no forces; exchanging its ends exchanges the forces.
 */
TEST(rotation_and_swap) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_OFF;
  struct dem_system *s = fixture_create(t, &in);
  for (int k = 0; k <= 200; k++) { /* up to 20 rad, so that the unwrapped angle passes pi thrice */
    const double angle = 0.1 * k;
    fixture_place(s, 0, 0.5 * h - 0.5 * h * cos(angle), 0.5 * h - 0.5 * h * sin(angle), angle);
    fixture_place(s, 1, 0.5 * h + 0.5 * h * cos(angle), 0.5 * h + 0.5 * h * sin(angle), angle);
    fixture_evaluate(s);
    for (size_t a = 0; a < 6; a++) /* 20 rad have roundings of 4e-15, times E h (h) */
      fixture_near(force(s, a), 0.0, 1e-13 * in.beam.young_modulus * h * (a % 3 == 2 ? h : 1.0), "rigid rotation");
  }
  dem_system_free(s);
  /* u = (dx, dy, angle) of either end; swap means: turn the picture by 180 degrees. */
  double f[2][6];
  for (int swap = 0; swap < 2; swap++) {
    s = fixture_create(t, &in);
    const double u[2][3] = {{0.01 * h, 0.02 * h, 0.05}, {0.03 * h, -0.01 * h, -0.08}};
    for (uint32_t g = 0; g < 2; g++) {
      const double *v = u[swap ? 1 - g : g], sign = swap ? -1.0 : 1.0;
      fixture_place(s, g, t->centroid[g].x + sign * v[0], t->centroid[g].y + sign * v[1], v[2]);
    }
    fixture_evaluate(s);
    for (size_t a = 0; a < 6; a++)
      f[swap][a] = force(s, a);
    dem_system_free(s);
  }
  for (size_t a = 0; a < 6; a++)
    fixture_near(f[0][a], (a % 3 == 2 ? 1.0 : -1.0) * f[1][(a + 3) % 6],
                 1e-12 * in.beam.young_modulus * h * (a % 3 == 2 ? h : 1.0), "swap");
}

/* 20 beams of 1 cm, S = 1 cm, E 5e9 dyn/cm^2, clamped: P L^3 / 3EI + P L / GS = 6.408e-6 cm per dyn. */
TEST(cantilever) {
  DEM_TESSELLATION *t = fixture_squares(21, 1, h, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_OFF;
  DEM_SYSTEM *s = fixture_create(t, &in);
  const size_t all = 63, n = 60;
  OWNED double *k = calloc(all * all, sizeof *k);
  stiffness(s, all, h, k);
  gsl_matrix *m = gsl_matrix_alloc(n, n);
  gsl_vector *load = gsl_vector_calloc(n), *u = gsl_vector_alloc(n);
  for (size_t a = 0; a < n; a++)
    for (size_t b = 0; b < n; b++)
      gsl_matrix_set(m, a, b, k[(a + 3) * all + b + 3]);
  gsl_vector_set(load, n - 2, 1.0); /* y of the last grain, 1 N per m of thickness */
  gsl_permutation *order = gsl_permutation_alloc(n);
  int sign;
  gsl_linalg_LU_decomp(m, order, &sign);
  gsl_linalg_LU_solve(m, order, load, u);
  /* 1 dyn per cm of thickness is 1e-3 N/m: cm per dyn is 100 x 1e-3 times m per (N/m). */
  const double deflection = gsl_vector_get(u, n - 2) * 0.1;
  const double l = 20.0, e = 5e9, exact = l * l * l / (3.0 * e / 12.0) + l / (0.5 * e);
  fixture_near(exact, 6.408e-6, 0.0005e-6, "the known deflection");
  fixture_near(deflection, exact, 1e-4 * exact, "cantilever"); /* differences' 1e-9 times the condition number, 1e5 */
  gsl_permutation_free(order);
  gsl_vector_free(u);
  gsl_vector_free(load);
  gsl_matrix_free(m);
}

/* A square lattice of squares, pulled: only the beams along the pull act, and K_ext = E. */
TEST(square_lattice_modulus) {
  const uint32_t n = 6;
  DEM_TESSELLATION *t = fixture_squares(n, n, h, 0.0, true);
  const struct dem_inputs in = fixture_inputs(); /* contact is on: pulled grains do not touch */
  DEM_SYSTEM *s = fixture_create(t, &in);
  const double strain = 1e-4;
  for (uint32_t i = 0; i < n * n; i++)
    fixture_place(s, i, t->centroid[i].x, t->centroid[i].y * (1.0 + strain), 0.0);
  fixture_evaluate(s);
  double top = 0.0;
  for (uint32_t i = 0; i < n * n; i++) {
    const double scale = in.beam.young_modulus * h * strain;
    if (i / n > 0 && i / n < n - 1) /* 1e-9: rounding of lengths over the strain */
      fixture_near(s->c.fy[i], 0.0, 1e-9 * scale, "inner grains balance");
    fixture_near(s->c.fx[i], 0.0, 1e-9 * scale, "no force across");
    if (i / n == n - 1)
      top += s->c.fy[i];
  }
  fixture_near(-top / (n * h) / strain, in.beam.young_modulus, 1e-9 * in.beam.young_modulus, "K_ext");
}
