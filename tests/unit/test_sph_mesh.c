/* Bodies from shape files. A box as a mesh must equal a box: the same particles to rounding, distances, gaps and places
 * of impact. In bodies that only a mesh can describe, flaws are uniform, and a projectile starts outside of them. */
#define CHECK_OWN_MAIN

#include "engine/mesh/mesh.h"
#include "engine/random.h"
#include "engine/scene.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/body/flaws.h"
#include "engine/sph/scene/derived.h"
#include "tests/support/check.h"

static const char box_file[] = "v 0 0 0\nv 0 0 3\nv 0 2 0\nv 0 2 3\nv 1 0 0\nv 1 0 3\nv 1 2 0\nv 1 2 3\n"
                               "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
/* An L: 2 x 1 x 2 with the quarter x > 1, z > 1 cut out. Its centre of mass is at x = 5/6, y = 1/2, z = 5/6. */
static const char l_file[] = "v 0 0 0\nv 2 0 0\nv 2 0 1\nv 1 0 1\nv 1 0 2\nv 0 0 2\n"
                             "v 0 1 0\nv 2 1 0\nv 2 1 1\nv 1 1 1\nv 1 1 2\nv 0 1 2\n"
                             "f 1 2 3 4\nf 1 4 5 6\nf 7 10 9 8\nf 7 12 11 10\n"
                             "f 1 7 8 2\nf 2 8 9 3\nf 3 9 10 4\nf 4 10 11 5\nf 5 11 12 6\nf 6 12 7 1\n";

static const double unit_length = 0.01;
static const struct mesh_file *box_mesh, *l_mesh;
static struct sph_shape box, as_mesh, l_shape;

static int set_up(void **state) {
  (void)state;
  if (mesh_files_add("box", box_file, strlen(box_file), &box_mesh, &error) ||
      mesh_files_add("L", l_file, strlen(l_file), &l_mesh, &error)) {
    print_error("%s\n", error.message);
    return 1;
  }
  box = (struct sph_shape){.kind = SPH_SHAPE_BOX, .centre = {0.1, 0.2, -0.3}, .side = {0.01, 0.02, 0.03}};
  as_mesh = (struct sph_shape){.kind = SPH_SHAPE_MESH,
                               .centre = {0.1, 0.2, -0.3},
                               .mesh = box_mesh->mesh,
                               .unit = unit_length};
  l_shape = (struct sph_shape){.kind = SPH_SHAPE_MESH, .mesh = l_mesh->mesh, .unit = unit_length};
  return 0;
}

static void near(double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance))
    print_error("%.17g is not %.17g\n", value, expected);
  assert_true(fabs(value - expected) <= tolerance);
}

static void draw(uint64_t item, double scale, double p[3]) {
  uint64_t bits[4];
  random_bits(5, RANDOM_FLAW_PLACE, 0, item, bits);
  for (int k = 0; k < 3; k++)
    p[k] = scale * (2 * random_uniform(bits[k]) - 1);
}

TEST(same_as_a_box) {
  near(sph_shape_volume(&as_mesh), sph_shape_volume(&box), 1e-20);
  near(sph_shape_thinnest(&as_mesh), sph_shape_thinnest(&box), 1e-15);
  near(sph_shape_thinnest(&box), fmin(box.side[0], fmin(box.side[1], box.side[2])), 0);
  const struct sph_shape ring = {.kind = SPH_SHAPE_CYLINDER, .radius = 3, .inner_radius = 2, .length = 1.5};
  near(sph_shape_thinnest(&ring), 1, 0);
  double q[2][3], n[2][3];
  for (uint64_t i = 0; i < 2000; i++) {
    double p[3], d[3];
    draw(i, 0.02, p);
    draw(10000 + i, 1, d);
    for (int k = 0; k < 3; k++)
      p[k] += box.centre[k];
    assert_int_equal(sph_shape_inside(&as_mesh, p), sph_shape_inside(&box, p));
    near(sph_shape_distance(&as_mesh, p, n[0]), sph_shape_distance(&box, p, n[1]), 1e-15);
    near(n[0][0] * n[1][0] + n[0][1] * n[1][1] + n[0][2] * n[1][2], 1, 1e-9);
    near(sph_shape_reach(&as_mesh, d), sph_shape_reach(&box, d), 1e-15);
  }
  assert_true(sph_shape_top(&as_mesh, q[0], n[0]) && sph_shape_top(&box, q[1], n[1]));
  for (int k = 0; k < 3; k++) {
    near(q[0][k], q[1][k], 1e-14);
    near(n[0][k], n[1][k], 1e-12);
  }
}

enum { DRAWS = SANITIZED ? 40 : 200 };

TEST(same_gaps_as_a_box) {
  struct sph_shape others[] = {
      {.kind = SPH_SHAPE_SPHERE, .radius = 0.006},
      {.kind = SPH_SHAPE_CYLINDER, .radius = 0.004, .length = 0.01, .axis = {1, 2, 3}},
      {.kind = SPH_SHAPE_BOX, .side = {0.004, 0.02, 0.01}},
      l_shape,
  };
  int apart = 0, together = 0;
  for (uint64_t i = 0; i < DRAWS; i++) {
    struct sph_shape *other = &others[i % 4];
    draw(i, 0.03, other->centre);
    for (int k = 0; k < 3; k++)
      other->centre[k] += box.centre[k];
    const double gap = sph_shape_gap(&as_mesh, other), of_box = sph_shape_gap(&box, other);
    assert_int_equal(gap < 0, of_box < 0);
    if (!(of_box > 0)) {
      together++;
      continue;
    }
    const double tolerance = i % 4 == 3 ? 1e-4 * 0.04 : 2e-6 * 0.04; /* the search between meshes is coarser */
    near(gap, of_box, tolerance);
    near(sph_shape_gap(other, &as_mesh), gap, tolerance);
    apart++;
  }
  assert_true(apart > DRAWS / 4 && together > DRAWS / 20);
  struct sph_shape inside = {.kind = SPH_SHAPE_BOX, .centre = {0.1, 0.2, -0.3}, .side = {1e-3, 1e-3, 1e-3}};
  assert_true(sph_shape_gap(&as_mesh, &inside) < 0);
  inside.side[0] = inside.side[1] = inside.side[2] = 1; /* around it */
  assert_true(sph_shape_gap(&as_mesh, &inside) < 0);
}

TEST(same_particles_as_a_box) {
  for (uint64_t seed = 1; seed <= 6; seed++) {
    struct sph_points of_box, of_mesh;
    const struct sph_lattice lattice = {.kind = seed % 2 ? SPH_LATTICE_HEXAGONAL : SPH_LATTICE_CUBIC,
                                        .particles = 500 * (double)seed,
                                        .turned = true,
                                        .seed = seed};
    OK(sph_lattice_fill(&lattice, &box, &of_box, &error));
    OK(sph_lattice_fill(&lattice, &as_mesh, &of_mesh, &error));
    assert_int_equal(of_box.n, of_mesh.n);
    near((double)of_mesh.n, lattice.particles, 0.005 * lattice.particles);
    for (size_t i = 0; i < of_box.n; i++) {
      near(of_mesh.x[i], of_box.x[i], 1e-13);
      near(of_mesh.y[i], of_box.y[i], 1e-13);
      near(of_mesh.z[i], of_box.z[i], 1e-13);
    }
    sph_lattice_empty(&of_box);
    sph_lattice_empty(&of_mesh);
  }
}

/* Lattices, irregular and graded points of the L: all are inside, their mass is exact, and each third has its share. */
TEST(an_l_is_filled) {
  for (int kind = 0; kind < 4; kind++) {
    struct sph_body body = {.shape = l_shape, .density = 2700, .h_over_spacing = NAN};
    body.lattice = (struct sph_lattice){.kind = kind < 3 ? kind : SPH_LATTICE_IRREGULAR,
                                        .particles = 3000,
                                        .turned = kind < 2,
                                        .seed = 3};
    if (kind == 3)
      body.lattice.grading = (struct sph_grading){.fine = 7e-4,
                                                  .point = {-0.003, 0, 0.0117},
                                                  .radius = 2e-3,
                                                  .growth = NAN};
    SPH_PARTICLES *p = NULL;
    struct sph_range range;
    OK(sph_bodies_make(&body, 1, 0, &p, &range, &error));
    double mass = 0, third[3] = {0};
    for (size_t i = 0; i < p->n; i++) {
      const double at[3] = {p->x[i], p->y[i], p->z[i]};
      /* Lattices are scaled and shifted a little after they are cut; a particle reaches half a spacing. */
      assert_true(sph_shape_distance(&l_shape, at, NULL) < 0.05 * range.spacing);
      const bool right = at[0] > unit_length / 6, high = at[2] > unit_length / 6;
      third[right ? 1 : high ? 2 : 0] += p->mass[i] / range.mass;
      mass += p->mass[i];
    }
    near(mass, 2700 * 3e-6, 1e-12);
    near((double)p->n, 3000, 0.01 * 3000);
    for (int k = 0; k < 3; k++)
      near(third[k], 1. / 3, 0.02);
  }
}

/* Flaws are uniform: each third of the L has its share, within 4 standard deviations. */
TEST(flaws_are_uniform) {
  enum { N = 30000 };
  int third[3] = {0};
  for (uint64_t flaw = 0; flaw < N; flaw++) {
    double p[3];
    sph_flaws_point(7, 0, flaw, &l_shape, p);
    assert_true(sph_shape_inside(&l_shape, p));
    third[p[0] > unit_length / 6 ? 1 : p[2] > unit_length / 6 ? 2 : 0]++;
  }
  for (int k = 0; k < 3; k++)
    near(third[k], N / 3., 4 * sqrt(N * 2 / 9.));
}

/* The projectile touches the plane of the face that is hit, at 60 degrees, and parts of the body above that plane must
 * not overlap it. */
TEST(projectile_starts_clear) {
  char text[512];
  SCENE scene = NULL;
  snprintf(text, sizeof text,
           "engine: sph\nkind: impact\ntarget: {shape: mesh, material: basalt, mesh: {file: %s, unit: 1 cm}}\n"
           "projectile: {shape: sphere, radius: 4 mm, material: basalt}\n"
           "impact: {speed: 100 m/s, angle: 60 deg, gap: 0.5 mm}\nfidelity: {particles: 2000}\n",
           l_mesh->hash);
  OK(scene_parse("L", text, &scene, &error));
  OK(scene_check(scene, &error));
  struct sph_shape shape[2];
  double flight[3];
  OK(sph_derived_aim(scene->inputs, shape, flight, &error));
  assert_true(sph_shape_gap(&shape[0], &shape[1]) >= 0.5e-3 * (1 - 1e-9));
  near(flight[2], -cos(M_PI / 3), 1e-12);
  near(sph_derived_target_mass(scene->inputs), 2700 * 3e-6, 1e-12);
}

/* A scene without its file, or with the hash of a file that was not read, is refused with a remedy. */
TEST(file_is_needed) {
  FILE *file = fopen("box.obj", "w");
  assert_true(file && fputs(box_file, file) >= 0 && fclose(file) == 0);
  static const char *const parts[][2] = {
      {"shape: mesh, mesh: {unit: 1 m}", "target.mesh.file is missing"},
      {"shape: mesh, mesh: {file: ./box.obj}", "target.mesh.unit is missing"},
      {"shape: mesh, mesh: {file: ./no-such.obj, unit: 1 m}", "no-such.obj"},
      {"shape: mesh, mesh: {file: 0000000000000000000000000000000000000000000000000000000000000000, unit: 1 m}",
       "give the name of the file"},
      {"shape: mesh, mesh: {file: [1], unit: 1 m}", "expected the name of a shape file"},
      {"shape: mesh, mesh: {file: /dev/zero, unit: 1 m}", "no regular file"},
      {"shape: sphere, radius: 1 cm, mesh: {unit: 1 m}", "used only when target.shape is mesh"},
  };
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    char text[512];
    struct scene *scene = NULL;
    snprintf(text, sizeof text, "engine: sph\ntarget: {%s}\n", parts[i][0]);
    status code = scene_parse("a", text, &scene, &error);
    if (!code)
      code = scene_check(scene, &error);
    scene_free(scene);
    assert_int_equal(code, STATUS_CONTENT);
    if (!strstr(error.message, parts[i][1]))
      fail_msg("%s", error.message);
  }
  remove("box.obj");
}

int main(void) {
  return check_run(set_up, NULL);
}
