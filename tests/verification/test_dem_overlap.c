/* Overlap of convex polygons against an independent brute force: Sutherland & Hodgman (1974) in long double, on a
 * million pairs of every awkward kind; and the windows of bonded pairs against the general overlap. */
#include "tests/verification/dem_fixture.h"

enum { MOST = 80 };

struct polygon {
  int count;
  long double x[MOST], y[MOST];
};

/* Cut `p` by the line through (x, y) along (ex, ey), keeping the left. */
static struct polygon cut(const struct polygon *p, long double x, long double y, long double ex, long double ey) {
  struct polygon out = {0};
  for (int v = 0; v < p->count; v++) {
    const int w = (v + 1) % p->count;
    const long double a = ex * (p->y[v] - y) - ey * (p->x[v] - x), b = ex * (p->y[w] - y) - ey * (p->x[w] - x);
    if (a >= 0) {
      out.x[out.count] = p->x[v];
      out.y[out.count++] = p->y[v];
    }
    if ((a >= 0) != (b >= 0)) {
      const long double t = a / (a - b);
      out.x[out.count] = p->x[v] + t * (p->x[w] - p->x[v]);
      out.y[out.count++] = p->y[v] + t * (p->y[w] - p->y[v]);
    }
  }
  return out;
}

static long double brute_area(const struct dem_ring *a, const struct dem_ring *b) {
  struct polygon p = {.count = (int)a->count};
  for (int v = 0; v < p.count; v++)
    p.x[v] = a->x[v], p.y[v] = a->y[v];
  for (size_t k = 0; k < b->count && p.count; k++)
    p = cut(&p, b->x[k], b->y[k], (long double)b->x[k + 1] - b->x[k], (long double)b->y[k + 1] - b->y[k]);
  long double twice = 0;
  for (int v = 0; v < p.count; v++) {
    const int w = (v + 1) % p.count;
    twice += (p.x[v] - p.x[0]) * (p.y[w] - p.y[0]) - (p.y[v] - p.y[0]) * (p.x[w] - p.x[0]);
  }
  return twice / 2;
}

static void close_ring(struct dem_ring *r) {
  for (size_t v = r->count; v < DEM_MAX_VERTICES + DEM_BLOCK; v++)
    r->x[v] = r->x[0], r->y[v] = r->y[0];
}

/* Vertices on an ellipse at sorted random angles: convex, from fat to a needle. */
static void random_ring(uint64_t *seed, struct dem_ring *r, double thin, double x, double y, double turn) {
  r->count = 3 + (size_t)(4.5 * (1.0 + fixture_random(seed)));
  double angle = 0.0, angles[16], total = 0.0;
  for (size_t v = 0; v < r->count; v++)
    total += angles[v] = 0.1 + 1.0 + fixture_random(seed);
  for (size_t v = 0; v < r->count; v++) {
    angle += angles[v] * 2.0 * M_PI / total;
    const double px = cos(angle), py = thin * sin(angle);
    r->x[v] = x + cos(turn) * px - sin(turn) * py;
    r->y[v] = y + sin(turn) * px + cos(turn) * py;
  }
  close_ring(r);
}

static void move_ring(struct dem_ring *r, double dx, double dy) {
  for (size_t v = 0; v < DEM_MAX_VERTICES + DEM_BLOCK; v++)
    r->x[v] += dx, r->y[v] += dy;
}

enum { KINDS = 9 };

static void make_pair(uint64_t *seed, int kind, struct dem_ring ring[2]) {
  random_ring(seed, &ring[0], kind == 1 ? 1e-3 : 0.7, 0.0, 0.0, M_PI * fixture_random(seed));
  switch (kind) {
  case 0: /* anyhow */
  case 1: /* needles */
    random_ring(seed, &ring[1], kind ? 1e-3 : 0.6, fixture_random(seed), fixture_random(seed),
                M_PI * fixture_random(seed));
    break;
  case 2: /* the same polygon, moved by almost nothing: sides nearly parallel */
    ring[1] = ring[0];
    move_ring(&ring[1], 1e-9 * fixture_random(seed), 1e-9 * fixture_random(seed));
    break;
  case 3: /* the same polygon */ ring[1] = ring[0]; break;
  case 4: { /* mirrored at one of its sides: touching along a whole side; then pushed in by a sliver */
    const size_t k = (size_t)((double)ring[0].count * 0.4999 * (1.0 + fixture_random(seed)));
    const double x = ring[0].x[k], y = ring[0].y[k], ex = ring[0].x[k + 1] - x, ey = ring[0].y[k + 1] - y;
    const double l = ex * ex + ey * ey,
                 depth = fixture_random(seed) < 0.0 ? 0.0 : pow(10.0, -7.0 + 5.0 * fixture_random(seed));
    ring[1].count = ring[0].count;
    for (size_t v = 0; v < ring[0].count; v++) {
      const double px = ring[0].x[ring[0].count - 1 - v] - x, py = ring[0].y[ring[0].count - 1 - v] - y;
      const double d = (px * ey - py * ex) / l;
      ring[1].x[v] = x + px - 2.0 * d * ey - depth * ey / sqrt(l);
      ring[1].y[v] = y + py + 2.0 * d * ex + depth * ex / sqrt(l);
    }
    close_ring(&ring[1]);
    break;
  }
  case 5: /* one inside the other */
    random_ring(seed, &ring[1], 0.5, 0.0, 0.0, M_PI * fixture_random(seed));
    for (size_t v = 0; v < DEM_MAX_VERTICES + DEM_BLOCK; v++)
      ring[1].x[v] *= 0.2, ring[1].y[v] *= 0.2;
    break;
  case 6: /* a corner of one on a corner of the other */
    random_ring(seed, &ring[1], 0.6, 0.0, 0.0, M_PI * fixture_random(seed));
    move_ring(&ring[1], ring[0].x[0] - ring[1].x[1], ring[0].y[0] - ring[1].y[1]);
    break;
  case 7: /* equal squares on a grid: exactly coinciding and collinear sides */
    for (int k = 0; k < 2; k++) {
      ring[k].count = 4;
      const double x = k ? 0.25 * floor(5.0 * fixture_random(seed)) : 0.0,
                   y = k ? 0.25 * floor(5.0 * fixture_random(seed)) : 0.0;
      for (size_t v = 0; v < 4; v++) {
        ring[k].x[v] = x + (v == 1 || v == 2);
        ring[k].y[v] = y + (v >= 2);
      }
      close_ring(&ring[k]);
    }
    break;
  default: /* the same, turned: the coincidences hold to rounding only */
    make_pair(seed, 7, ring);
    const double turn = M_PI * fixture_random(seed), c = cos(turn), s = sin(turn);
    for (int k = 0; k < 2; k++)
      for (size_t v = 0; v < DEM_MAX_VERTICES + DEM_BLOCK; v++) {
        const double x = ring[k].x[v], y = ring[k].y[v];
        ring[k].x[v] = c * x - s * y, ring[k].y[v] = s * x + c * y;
      }
  }
}

static void area_is_brute_forces(const struct dem_kernels *kernels, int pairs) {
  uint64_t seed = 3;
  double worst[KINDS] = {0}, largest = 0.0;
  for (int n = 0; n < pairs; n++) {
    static struct dem_ring ring[2], kept[2];
    const int kind = n % KINDS;
    make_pair(&seed, kind, ring);
    memcpy(kept, ring, sizeof ring);
    struct dem_overlap overlap = {0};
    kernels->overlap(ring, &overlap);
    const double exact = (double)brute_area(&kept[0], &kept[1]), area = overlap.apart ? 0.0 : 0.5 * overlap.twice_area;
    largest = fmax(largest, exact);
    worst[kind] = fmax(worst[kind], fabs(area - exact));
    /* Sides are of order one. Where sides cross at an angle a, each outline finds the crossing to 1e-16 / a along the
     * side (a down to 1e-4 or so); for sides in one line the tolerance that decides this adds 1e-12 x their extent
     * and length, 2 and 6. */
    fixture_near(area, exact, kind >= 2 && kind != 5 && kind != 6 ? 2e-11 : 1e-12, "area");
  }
  print_message("          %s: worst error by kind:", kernels->name);
  for (int k = 0; k < KINDS; k++)
    print_message(" %.1e", worst[k]);
  print_message("\n");
  assert_true(largest > 1.0);
}

TEST(overlap_baseline) {
  area_is_brute_forces(&dem_kernels_baseline, getenv("CLAST_FULL") ? 1000000 : 100000);
}

TEST(overlap_best_class) {
  area_is_brute_forces(dem_kernels_choose(), 1000000);
}

/* Points where the outlines cross. */
static int crossings(const struct dem_ring ring[2], long double *px, long double *py) {
  int found = 0;
  for (size_t a = 0; a < ring[0].count; a++)
    for (size_t b = 0; b < ring[1].count; b++) {
      const long double ax = ring[0].x[a], ay = ring[0].y[a], bx = ring[1].x[b], by = ring[1].y[b];
      const long double ex = ring[0].x[a + 1] - ax, ey = ring[0].y[a + 1] - ay;
      const long double fx = ring[1].x[b + 1] - bx, fy = ring[1].y[b + 1] - by, across = ex * fy - ey * fx;
      const long double t = ((bx - ax) * fy - (by - ay) * fx) / across, u = ((bx - ax) * ey - (by - ay) * ex) / across;
      if (t >= 0 && t <= 1 && u >= 0 && u <= 1) {
        px[found] = ax + t * ex;
        py[found++] = ay + t * ey;
      }
    }
  return found;
}

/* The chord is the gradient of the area: move the first polygon, turn it, and compare differences of brute-force area.
 */
TEST(chord_is_the_gradient) {
  uint64_t seed = 5;
  int met = 0, chords = 0;
  for (int n = 0; n < 20000; n++) {
    static struct dem_ring ring[2], moved[2];
    make_pair(&seed, 0, ring);
    struct dem_overlap o = {0};
    memcpy(moved, ring, sizeof ring);
    dem_kernels_choose()->overlap(moved, &o);
    if (o.apart)
      continue;
    met++;
    const double step = 1e-7;
    double change[3];
    for (int k = 0; k < 3; k++) {
      double side[2];
      for (int up = 0; up < 2; up++) {
        const double d = up ? step : -step;
        memcpy(moved, ring, sizeof ring);
        if (k < 2)
          move_ring(&moved[0], k == 0 ? d : 0.0, k == 1 ? d : 0.0);
        else
          for (size_t v = 0; v < DEM_MAX_VERTICES + DEM_BLOCK; v++) { /* turn about the sums' origin */
            const double x = ring[0].x[v] - o.origin_x, y = ring[0].y[v] - o.origin_y;
            moved[0].x[v] = o.origin_x + cos(d) * x - sin(d) * y;
            moved[0].y[v] = o.origin_y + sin(d) * x + cos(d) * y;
          }
        side[up] = (double)brute_area(&moved[0], &moved[1]);
      }
      change[k] = (side[1] - side[0]) / (2.0 * step);
    }
    /* A vertex that passes a side within the step changes the slope by at most step x cot(angle): 1e-5 for our shapes.
     */
    fixture_near(change[0], o.chord_y, 2e-5, "dA/dx");
    fixture_near(change[1], -o.chord_x, 2e-5, "dA/dy");
    fixture_near(change[2], -o.moment, 4e-5, "dA/dangle");
    long double px[MOST], py[MOST];
    if (crossings(ring, px, py) != 2)
      continue;
    /* One chord: the tensor and the moment give its middle, across and along. */
    const double length = hypot(o.chord_x, o.chord_y), tx = o.chord_x / length, ty = o.chord_y / length;
    const double mx = (double)(px[0] + px[1]) / 2 - o.origin_x, my = (double)(py[0] + py[1]) / 2 - o.origin_y;
    fixture_near(length, hypot((double)(px[1] - px[0]), (double)(py[1] - py[0])), 1e-13, "chord");
    if (length < 1e-3)
      continue;
    chords++;
    const double across = (-ty * (o.xx * tx + o.xy * ty) + tx * (o.xy * tx + o.yy * ty)) / length;
    fixture_near(o.moment / length, mx * tx + my * ty, 1e-11, "middle along"); /* 1e-14 over the shortest chord */
    fixture_near(across, -mx * ty + my * tx, 1e-11, "middle across");
  }
  assert_true(met > 5000 && chords > 1000);
}

/* A disc's bonded contacts by windows against the same disc with every contact in the general overlap. */
static void windows_agree(double disorder) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01, disorder, 3);
  struct dem_inputs in = fixture_inputs();
  in.beam.young_modulus = 0.0;
  const double sizes[] = {1e-6, 1e-4, 1e-2, 0.1, 0.3, 0.6};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
    for (int friction = 0; friction < 2; friction++) {
      in.fidelity.time_step = 1e-6;
      in.contact.normal_damping = friction ? 1e3 : 0.0;
      in.contact.tangential_damping = friction ? 1e3 : 0.0;
      in.contact.friction = friction ? 0.5 : 0.0;
      DEM_SYSTEM *window = fixture_create(t, &in), *general = fixture_create(t, &in);
      for (size_t pair = 0; pair < general->pair_count; pair++) {
        general->windowed[pair] = 0;
        const int32_t lane = general->pair_lane[pair];
        general->bond[lane / DEM_BLOCK].stiffness[lane % DEM_BLOCK] = 0.0;
      }
      uint64_t seed = 7 + k;
      for (uint32_t i = 0; i < t->cell_count; i++) {
        const double dx = 0.01 * sizes[k] * fixture_random(&seed), dy = 0.01 * sizes[k] * fixture_random(&seed);
        const double angle = sizes[k] * fixture_random(&seed), spin = 100.0 * fixture_random(&seed);
        for (int which = 0; which < 2; which++) {
          struct dem_system *s = which ? general : window;
          fixture_place(s, i, t->centroid[i].x + dx, t->centroid[i].y + dy, angle);
          if (friction) /* seen by damping as it is, since nothing moves in the step */
            s->c.spin[i] = spin;
        }
      }
      if (friction) {
        for (size_t i = 0; i < t->cell_count; i++)
          for (int which = 0; which < 2; which++) {
            struct dem_system *s = which ? general : window;
            s->c.mobility_x[i] = s->c.mobility_y[i] = s->c.mobility_angle[i] = 0.0;
          }
        /* one step of 1e-30 s keeps positions */
        in.fidelity.time_step = 1e-30;
        assert_true(dem_system_step(window) && dem_system_step(general));
      } else {
        fixture_evaluate(window);
        fixture_evaluate(general);
      }
      double largest = 0.0, worst = 0.0;
      for (size_t i = 0; i < t->cell_count; i++) {
        largest = fmax(largest, hypot(general->c.fx[i], general->c.fy[i]));
        worst = fmax(worst, hypot(general->c.fx[i] - window->c.fx[i], general->c.fy[i] - window->c.fy[i]));
        worst = fmax(worst, fabs(general->c.torque[i] - window->c.torque[i]) / 0.01);
      }
      print_message(
          "          motion %.0e of a cell: %zu of %zu pairs left to the general overlap, worst force error %.1e\n",
          sizes[k], window->general_count, t->pair_count, worst / largest);
      assert_true(largest > 0.0);
      /* the same overlap by two roundings: 1e-16 of a coordinate over the smallest overlaps, 1e-6 of a cell deep */
      assert_true(worst <= 1e-8 * largest);
    }
}

TEST(windows_are_exact) {
  windows_agree(1.0);
}

/* A square lattice squeezed along x: sides in one line everywhere, to rounding; each contact has the force of its face.
 */
TEST(windows_of_a_square_lattice) {
  windows_agree(0.0);
  const double h = 0.01, strain = 1e-3;
  DEM_TESSELLATION *t = fixture_squares(6, 6, h, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.beam.young_modulus = 0.0;
  DEM_SYSTEM *s = fixture_create(t, &in);
  for (uint32_t i = 0; i < 36; i++)
    fixture_place(s, i, 77.7 + t->centroid[i].x * (1.0 - strain), 33.3 + t->centroid[i].y, 0.0);
  fixture_evaluate(s);
  const double face = in.grain.young_modulus / (2.0 * h / sqrt(M_PI)) * h * strain * h;
  for (uint32_t i = 0; i < 36;
       ++i) /* overlaps are 1e-3 of a cell, the gap at rest 1e-11; positions of 77 m have roundings of 1e-14 m */
    fixture_near(s->c.fx[i], i % 6 == 0 ? -face : i % 6 == 5 ? face : 0.0, 3e-8 * face, "push of a face");
}

/* Pairs of every shape: a random polygon cut in two along a diagonal, then pushed and turned anyhow. */
TEST(windows_of_odd_shapes) {
  const struct dem_inputs base = fixture_inputs();
  uint64_t seed = 11;
  int windows = 0, generals = 0;
  for (int trial = 0; trial < 20000; trial++) {
    struct dem_ring ring;
    do
      random_ring(&seed, &ring, 0.3 + 0.3 * (1.0 + fixture_random(&seed)), 0.0, 0.0, 3.0 * fixture_random(&seed));
    while (ring.count < 6);
    const size_t cut_at = 2 + (size_t)(trial % (int)(ring.count - 3)); /* the diagonal from corner 0 */
    DEM_TESSELLATION *t = fixture_squares(4, 1, 1.0, 0.0, true);       /* room for 16 corners; two cells are used */
    t->cell_count = 2;
    t->pair_count = 1;
    t->first_vertex[1] = (uint32_t)cut_at + 1;
    t->first_vertex[2] = (uint32_t)ring.count + 2;
    for (size_t v = 0; v <= cut_at; v++)
      t->vertex[v] = (struct dem_point){ring.x[v], ring.y[v]};
    for (size_t v = cut_at; v <= ring.count; v++)
      t->vertex[v + 1] = (struct dem_point){ring.x[v], ring.y[v]};
    for (int k = 0; k < 2; k++) {
      const uint32_t first = t->first_vertex[k], n = t->first_vertex[k + 1] - first;
      double area = 0.0, x = 0.0, y = 0.0;
      for (uint32_t v = 0; v < n; v++) {
        const struct dem_point a = t->vertex[first + v], b = t->vertex[first + (v + 1) % n];
        area += 0.5 * (a.x * b.y - a.y * b.x);
        x += a.x / n, y += a.y / n;
      }
      t->area[k] = area;
      t->polar_moment[k] = area * area;
      t->centroid[k] = (struct dem_point){x, y};
    }
    t->side[0] = hypot(ring.x[cut_at] - ring.x[0], ring.y[cut_at] - ring.y[0]);
    struct dem_inputs in = base;
    in.beam.young_modulus = 0.0;
    DEM_SYSTEM *window = fixture_create(t, &in), *general = fixture_create(t, &in);
    general->windowed[0] = 0;
    general->bond[0].stiffness[0] = 0.0;
    const double size = pow(10.0, -1.0 + fixture_random(&seed));
    const double dx = size * fixture_random(&seed), dy = size * fixture_random(&seed),
                 angle = size * fixture_random(&seed);
    for (int which = 0; which < 2; which++)
      fixture_place(which ? general : window, 1, t->centroid[1].x + dx, t->centroid[1].y + dy, angle);
    fixture_evaluate(window);
    fixture_evaluate(general);
    const double force = hypot(general->c.fx[0], general->c.fy[0]);
    if (force > 0.0)
      ++*(window->general_count ? &generals : &windows);
    /* areas are right to 1e-12, see above, and chords are of order one */
    fixture_near(window->c.fx[0], general->c.fx[0], 1e-9 * force + 1e-11 * general->pair_contact[0].stiffness,
                 "force x");
    fixture_near(window->c.fy[0], general->c.fy[0], 1e-9 * force + 1e-11 * general->pair_contact[0].stiffness,
                 "force y");
    fixture_near(window->c.torque[1], general->c.torque[1], 1e-9 * force + 1e-11 * general->pair_contact[0].stiffness,
                 "torque");
  }
  print_message("          %d contacts by windows, %d by the general overlap\n", windows, generals);
  assert_true(windows > 1000 && generals > 1000);
}
