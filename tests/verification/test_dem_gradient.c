/* Forces and torques of whole small bodies against differences of an energy written independently from the paper, in
 * long double, with other methods: beams from their chords by atan2, overlaps by cutting polygons. Every force term of
 * engine/dem between the two at once: bonded, broken, never bonded and removed grains, held ones, both laws, all CPU
 * classes, turned as a whole, from slight to deep overlaps. */
#include "tests/verification/dem_fixture.h"

#include "engine/cpu_class.h"
#include "engine/dem/step/system_layout.h"

enum { GRAINS = 9, PAIRS = GRAINS * (GRAINS - 1) / 2, MOST = 40 };

struct place {
  long double x, y, angle;
};

struct polygon {
  int count;
  long double x[MOST], y[MOST];
};

struct model {
  const struct dem_tessellation *t;
  struct dem_inputs in;
  bool beam[PAIRS], present[GRAINS]; /* beam: by pair of the tessellation */
};

static struct polygon outline(const struct dem_tessellation *t, uint32_t grain, const struct place *at) {
  struct polygon p = {.count = (int)(t->first_vertex[grain + 1] - t->first_vertex[grain])};
  const long double c = cosl(at->angle), s = sinl(at->angle);
  for (int v = 0; v < p.count; v++) {
    const struct dem_point *q = &t->vertex[t->first_vertex[grain] + (uint32_t)v];
    const long double x = (long double)q->x - t->centroid[grain].x, y = (long double)q->y - t->centroid[grain].y;
    p.x[v] = at->x + c * x - s * y;
    p.y[v] = at->y + s * x + c * y;
  }
  return p;
}

static long double overlap_area(const struct model *m, uint32_t i, uint32_t j, const struct place *at) {
  struct polygon p = outline(m->t, i, &at[i]);
  const struct polygon q = outline(m->t, j, &at[j]);
  for (int k = 0; k < q.count && p.count; k++) {
    const int n = (k + 1) % q.count;
    const long double ex = q.x[n] - q.x[k], ey = q.y[n] - q.y[k];
    struct polygon cut = {0};
    for (int v = 0; v < p.count; v++) {
      const int w = (v + 1) % p.count;
      const long double a = ex * (p.y[v] - q.y[k]) - ey * (p.x[v] - q.x[k]);
      const long double b = ex * (p.y[w] - q.y[k]) - ey * (p.x[w] - q.x[k]);
      if (a >= 0)
        cut.x[cut.count] = p.x[v], cut.y[cut.count++] = p.y[v];
      if ((a >= 0) != (b >= 0)) {
        cut.x[cut.count] = p.x[v] + a / (a - b) * (p.x[w] - p.x[v]);
        cut.y[cut.count++] = p.y[v] + a / (a - b) * (p.y[w] - p.y[v]);
      }
    }
    p = cut;
  }
  long double twice = 0;
  for (int v = 0; v < p.count; v++) {
    const int w = (v + 1) % p.count;
    twice += (p.x[v] - p.x[0]) * (p.y[w] - p.y[0]) - (p.y[v] - p.y[0]) * (p.x[w] - p.x[0]);
  }
  return twice / 2;
}

/* Timoshenko beam as textbooks write it: EI/l [ (4+P) a^2 + 2 (2-P) a b + (4+P) b^2 ] / (2 (1+P)) with P = 12 EI/(G S
 * l^2), G = E/2 (K99: b = 2a), I = S^3/12; angles from the chord. */
static long double beam_energy(const struct model *m, size_t pair, const struct place *at) {
  const uint32_t i = m->t->pair[pair][0], j = m->t->pair[pair][1];
  const struct dem_point *a = &m->t->centroid[i], *b = &m->t->centroid[j];
  const long double x0 = (long double)b->x - a->x, y0 = (long double)b->y - a->y, l0 = hypotl(x0, y0);
  const long double x = at[j].x - at[i].x, y = at[j].y - at[i].y, l = hypotl(x, y);
  const long double e = m->in.beam.young_modulus, s = m->t->side[pair], inertia = s * s * s / 12;
  /* the chord's rotation, on the branch next to the first grain's */
  const long double chord = atan2l(x0 * y - y0 * x, x0 * x + y0 * y), turn = 2 * acosl(-1.0L);
  const long double phi = chord + turn * roundl((at[i].angle - chord) / turn);
  const long double t1 = at[i].angle - phi, t2 = at[j].angle - phi, shear = 12 * e * inertia / (e / 2 * s * l0 * l0);
  return e * s / l0 * (l - l0) * (l - l0) / 2 +
         e * inertia / l0 * ((4 + shear) * (t1 * t1 + t2 * t2) + 2 * (2 - shear) * t1 * t2) / (2 * (1 + shear));
}

/* Coefficient of the contact of grains i and j, 0 if there is none: kappa, or Y / L_c. */
static long double contact_of(const struct model *m, uint32_t i, uint32_t j) {
  const struct dem_tessellation *t = m->t;
  const double di = sqrt(4.0 * t->area[i] / M_PI), dj = sqrt(4.0 * t->area[j] / M_PI);
  double side = 0.0;
  bool bonded = false;
  for (size_t p = 0; p < t->pair_count; p++)
    if (t->pair[p][0] == i && t->pair[p][1] == j)
      side = t->side[p], bonded = m->beam[p];
  if (!m->present[i] || !m->present[j] || (bonded && !m->in.contact.bonded))
    return 0;
  const long double law = m->in.grain.young_modulus * (0.5L / di + 0.5L / dj);
  return m->in.contact.law == DEM_CONTACT_PRINTED ? law : law / dem_assemble_reference_side(side, di, dj);
}

/* Potential of beams and, for the conservative law, of contacts. */
static long double energy(const struct model *m, const struct place *at) {
  long double sum = 0;
  for (size_t p = 0; p < m->t->pair_count; p++)
    if (m->beam[p])
      sum += beam_energy(m, p, at);
  for (uint32_t i = 0; i < GRAINS && m->in.contact.law == DEM_CONTACT_CONSERVATIVE; i++)
    for (uint32_t j = i + 1; j < GRAINS; j++) {
      const long double kappa = contact_of(m, i, j), area = kappa > 0 ? overlap_area(m, i, j, at) : 0;
      sum += kappa * area * area / 2;
    }
  return sum;
}

static long double *freedom(struct place *at, size_t k) {
  struct place *g = &at[k / 3];
  return k % 3 == 0 ? &g->x : k % 3 == 1 ? &g->y : &g->angle;
}

/* Generalised forces f[3 grain + k]: the energy's central differences and, for the printed law, Y A / L_c along the
 * unit vector of the area's gradient (the force acts in the contact line's middle, as the gradient's torque does). */
static void expected_forces(const struct model *m, struct place *at, long double cell, long double f[3 * GRAINS]) {
  for (size_t k = 0; k < 3 * GRAINS; k++) {
    /* 1e-8: truncation below 1e-14, rounding 1e-19/1e-8 */
    const long double step = k % 3 == 2 ? 1e-8L : 1e-8L * cell, here = *freedom(at, k);
    *freedom(at, k) = here + step;
    const long double up = energy(m, at);
    *freedom(at, k) = here - step;
    const long double down = energy(m, at);
    *freedom(at, k) = here;
    f[k] = (down - up) / (2 * step);
  }
  if (m->in.contact.law != DEM_CONTACT_PRINTED)
    return;
  for (uint32_t i = 0; i < GRAINS; i++)
    for (uint32_t j = i + 1; j < GRAINS; j++) {
      const long double law = contact_of(m, i, j), area = law > 0 ? overlap_area(m, i, j, at) : 0;
      if (!(area > 0))
        continue;
      long double slope[6];
      for (size_t k = 0; k < 6; k++) {
        const size_t which = 3 * (k < 3 ? i : j) + k % 3;
        const long double step = k % 3 == 2 ? 1e-8L : 1e-8L * cell, here = *freedom(at, which);
        *freedom(at, which) = here + step;
        const long double up = overlap_area(m, i, j, at);
        *freedom(at, which) = here - step;
        slope[k] = (up - overlap_area(m, i, j, at)) / (2 * step);
        *freedom(at, which) = here;
      }
      const long double chord = hypotl(slope[0], slope[1]);
      for (size_t k = 0; k < 6 && chord > 0; k++)
        f[3 * (k < 3 ? i : j) + k % 3] -= law * area * slope[k] / chord;
    }
}

struct variant {
  const char *name;
  bool no_bonds, broken, removed, held, bonded_contact;
};

static const struct variant variants[] = {{"bonded", .bonded_contact = true},
                                          {"no contact on bonded", .bonded_contact = false},
                                          {"half broken", .broken = true, .bonded_contact = true},
                                          {"half broken, contact of the others only", .broken = true},
                                          {"never bonded", .no_bonds = true, .bonded_contact = true},
                                          {"one removed", .removed = true, .bonded_contact = true},
                                          {"some held", .held = true, .bonded_contact = true}};

static double compare(const struct variant *v, int law, double size, double turned, uint64_t seed) {
  const double cell = 0.01;
  struct dem_tessellation *t = NULL;
  const struct dem_lattice lattice =
      {.outline = DEM_OUTLINE_BLOCK, .spacing = cell, .disorder = 1.0, .columns = 3, .rows = 3, .seed = seed};
  OK(dem_tessellation_make(&lattice, &t, &error));
  assert_int_equal(t->cell_count, GRAINS);
  if (v->no_bonds)
    t->pair_count = 0;
  struct model m = {.t = t, .in = fixture_inputs()};
  m.in.contact.law = law;
  m.in.contact.bonded = v->bonded_contact;
  DEM_SYSTEM *s = fixture_create(t, &m.in);
  for (size_t p = 0; p < t->pair_count; p++)
    m.beam[p] = true;
  for (uint32_t i = 0; i < GRAINS; i++)
    m.present[i] = true;
  if (v->removed) {
    dem_system_remove(s, 4);
    m.present[4] = false;
    for (size_t p = 0; p < t->pair_count; p++)
      m.beam[p] = t->pair[p][0] != 4 && t->pair[p][1] != 4;
  }
  for (size_t p = 0; p < t->pair_count && v->broken; p += 2) {
    dem_breaking_cut(s, (int32_t)p);
    m.beam[p] = false;
  }
  for (uint32_t i = 0; i < 3 && v->held;
       ++i) /* the force that holds a grain is not a force of its neighbours: the same forces are reported */
    dem_system_hold(s, i, 1u << i | 4u);
  struct place at[GRAINS];
  uint64_t random = seed * 77 + 5;
  /* turned as a whole in several moves: a chord may turn by less than half a turn between evaluations */
  for (int move = 0; move < 8; move++) {
    const double angle = turned * (move + 1) / 8.0;
    for (uint32_t i = 0; i < GRAINS; i++) {
      const double x = t->centroid[i].x + (move == 7 ? cell * size * fixture_random(&random) : 0.0);
      const double y = t->centroid[i].y + (move == 7 ? cell * size * fixture_random(&random) : 0.0);
      const double more = move == 7 ? size * fixture_random(&random) : 0.0;
      fixture_place(s, i, cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y, angle + more);
      at[i] = (struct place){s->c.x[i], s->c.y[i], s->c.angle[i]};
    }
    fixture_evaluate(s);
  }
  long double f[3 * GRAINS];
  expected_forces(&m, at, cell, f);
  double largest = 0.0, worst = 0.0;
  for (uint32_t i = 0; i < GRAINS; i++) {
    double got[3];
    dem_system_force(s, i, &got[0], &got[1], &got[2]);
    for (size_t k = 0; k < 3; k++) {
      const double arm = k == 2 ? cell : 1.0;
      largest = fmax(largest, fabs((double)f[3 * i + k]) / arm);
      worst = fmax(worst, fabs(got[k] - (double)f[3 * i + k]) / arm);
    }
  }
  if (law == DEM_CONTACT_CONSERVATIVE) {
    const double here = (double)energy(&m, at);
    fixture_near(fixture_potential(s), here, 1e-8 * fabs(here), v->name);
  }
  assert_true(largest > 0.0 || v->no_bonds);
  dem_tessellation_free(t);
  return largest > 0.0 ? worst / largest : worst;
}

/* Where the outlines of two grains cross; the number of crossings. */
static int crossings(const struct model *m, uint32_t i, uint32_t j, const struct place *at, long double x[2],
                     long double y[2]) {
  const struct polygon p = outline(m->t, i, &at[i]), q = outline(m->t, j, &at[j]);
  int count = 0;
  for (int a = 0; a < p.count; a++)
    for (int b = 0; b < q.count; b++) {
      const int c = (a + 1) % p.count, d = (b + 1) % q.count;
      const long double ex = p.x[c] - p.x[a], ey = p.y[c] - p.y[a], fx = q.x[d] - q.x[b], fy = q.y[d] - q.y[b];
      const long double gx = q.x[b] - p.x[a], gy = q.y[b] - p.y[a], det = ex * fy - ey * fx;
      const long double u = (gx * fy - gy * fx) / det, v = (gx * ey - gy * ex) / det;
      if (u < 0 || u >= 1 || v < 0 || v >= 1)
        continue;
      if (count < 2)
        x[count] = p.x[a] + u * ex, y[count] = p.y[a] + u * ey;
      count++;
    }
  return count;
}

/* K99 eqs 2-6 with the signs that take energy out, at the middle of the contact line P1 P2, for grains in motion. */
TEST(damping_and_friction_as_written) {
  int compared = 0;
  for (int law = DEM_CONTACT_CONSERVATIVE; law <= DEM_CONTACT_PRINTED; law++)
    for (int bonded = 0; bonded < 2; bonded++)
      for (uint64_t seed = 1; seed <= 12; seed++) {
        const double cell = 0.01;
        struct dem_tessellation *t = NULL;
        const struct dem_lattice lattice =
            {.outline = DEM_OUTLINE_BLOCK, .spacing = cell, .disorder = 1.0, .columns = 3, .rows = 3, .seed = seed};
        OK(dem_tessellation_make(&lattice, &t, &error));
        if (!bonded)
          t->pair_count = 0;
        struct model m = {.t = t, .in = fixture_inputs()};
        m.in.contact.law = law;
        m.in.beam.young_modulus = 0.0;
        m.in.contact.normal_damping = 3e4, m.in.contact.tangential_damping = 2e4, m.in.contact.friction = 0.4,
        m.in.contact.damping_bonded = true;
        m.in.fidelity.time_step = 1e-30; /* nothing moves in the step */
        DEM_SYSTEM *s = fixture_create(t, &m.in);
        struct place at[GRAINS];
        uint64_t random = seed;
        for (uint32_t i = 0; i < GRAINS; i++) {
          m.present[i] = true;
          fixture_place(s, i, t->centroid[i].x + 0.1 * cell * fixture_random(&random),
                        t->centroid[i].y + 0.1 * cell * fixture_random(&random), 0.1 * fixture_random(&random));
          at[i] = (struct place){s->c.x[i], s->c.y[i], s->c.angle[i]};
          dem_system_set_velocity(s, i, 5.0 * fixture_random(&random), 5.0 * fixture_random(&random),
                                  500.0 * fixture_random(&random));
          s->c.mobility_x[i] = s->c.mobility_y[i] = s->c.mobility_angle[i] = 0.0;
        }
        assert_true(dem_system_step(s));
        long double f[3 * GRAINS] = {0}, largest = 0;
        bool simple = true;
        for (uint32_t i = 0; i < GRAINS; i++)
          for (uint32_t j = i + 1; j < GRAINS; j++) {
            const long double coefficient = contact_of(&m, i, j), area = overlap_area(&m, i, j, at);
            long double x[2], y[2];
            const int count = crossings(&m, i, j, at, x, y);
            if (count == 0 && !(area > 0))
              continue;
            if (count != 2)
              simple = false;
            if (!simple)
              continue;
            const long double chord = hypotl(x[1] - x[0], y[1] - y[0]), mx = (x[0] + x[1]) / 2, my = (y[0] + y[1]) / 2;
            const long double tx = (x[1] - x[0]) / chord, ty = (y[1] - y[0]) / chord;
            long double nx = -ty, ny = tx; /* towards i: the direction in which the overlap shrinks */
            struct place moved[GRAINS];
            memcpy(moved, at, sizeof at);
            moved[i].x += 1e-9L * cell * nx, moved[i].y += 1e-9L * cell * ny;
            if (overlap_area(&m, i, j, moved) > area)
              nx = -nx, ny = -ny;
            const long double ux = (s->c.vx[j] - s->c.spin[j] * (my - at[j].y)) -
                                   (s->c.vx[i] - s->c.spin[i] * (my - at[i].y));
            const long double uy = (s->c.vy[j] + s->c.spin[j] * (mx - at[j].x)) -
                                   (s->c.vy[i] + s->c.spin[i] * (mx - at[i].x));
            const long double mass = (long double)s->mass[i] * s->mass[j] / (s->mass[i] + s->mass[j]);
            const long double elastic = coefficient * area * (law == DEM_CONTACT_PRINTED ? 1 : chord);
            const long double normal = fmaxl(0, elastic + mass * m.in.contact.normal_damping * (ux * nx + uy * ny));
            const long double slip = ux * tx + uy * ty;
            const long double friction = copysignl(fminl(mass * m.in.contact.tangential_damping * fabsl(slip),
                                                         m.in.contact.friction * normal),
                                                   slip);
            const long double fx = normal * nx + friction * tx, fy = normal * ny + friction * ty;
            f[3 * i] += fx, f[3 * i + 1] += fy, f[3 * i + 2] += (mx - at[i].x) * fy - (my - at[i].y) * fx;
            f[3 * j] -= fx, f[3 * j + 1] -= fy, f[3 * j + 2] -= (mx - at[j].x) * fy - (my - at[j].y) * fx;
          }
        for (size_t k = 0; k < 3 * GRAINS; k++)
          largest = fmaxl(largest, fabsl(f[k]) / (k % 3 == 2 ? cell : 1));
        for (uint32_t i = 0; i < GRAINS && simple; i++) /* grains are 1e-11 of themselves smaller than their cells */
          for (size_t k = 0; k < 3; k++) {
            double got[3];
            dem_system_force(s, i, &got[0], &got[1], &got[2]);
            fixture_near(got[k], (double)f[3 * i + k], 1e-8 * (double)largest * (k == 2 ? cell : 1.0), "force");
          }
        compared += simple;
        dem_tessellation_free(t);
      }
  print_message("          %d of 48 bodies have two crossings at every contact\n", compared);
  assert_true(compared >= 12);
}

TEST(all_forces_are_gradients) {
  static const char *const classes[] = {"baseline", "v3", "v4"};
  static const double sizes[] = {0.02, 0.1, 0.4};
  for (size_t c = 0; c < 3; c++) {
    assert_int_equal(setenv("CLAST_CPU", classes[c], 1), 0);
    if (strcmp(cpu_class_name(cpu_class_choose()), classes[c]) != 0) {
      print_message("          CPU class %s: not on this machine\n", classes[c]);
      continue;
    }
    for (size_t v = 0; v < sizeof variants / sizeof *variants; v++)
      for (int law = DEM_CONTACT_CONSERVATIVE; law <= DEM_CONTACT_OFF; law++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
          for (uint64_t seed = 1; seed <= 4; seed++) {
            const double turned = seed % 2 ? 0.0 : 7.0;
            const double deviation = compare(&variants[v], law, sizes[k], turned, seed);
            /* the grains are 1e-11 smaller than their cells, differences err by 1e-8 where an overlap's shape changes
             */
            if (!(deviation <= 1e-7))
              fail_msg("%s, %s, law %d, motion %g, seed %d: forces differ by %g of the largest", classes[c],
                       variants[v].name, law, sizes[k], (int)seed, deviation);
          }
  }
  assert_int_equal(unsetenv("CLAST_CPU"), 0);
}
