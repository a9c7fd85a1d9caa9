/* Meshes: the result of each format, volumes and insides against plain geometry, and every refusal with its line. */
#include <unistd.h>

#include "engine/mesh/mesh.h"
#include "engine/random.h"
#include "tests/support/check.h"

/* A unit cube from (1, 2, 3) on, of squares, with every form of a corner. */
static const char cube[] = "# cube\no box\nmtllib a.mtl\n"
                           "v 1 2 3\nv 1 2 4\nv 1 3 3\nv 1 3 4 1.0\nv 2 2 3\nv 2 2 4\nv 2 3 3\nv 2 3 4\n"
                           "vt 0 0\nvn 0 0 1\ns off\n"
                           "f 1 2 4 3\nf 5/1 7/1 8/1 6/1\nf 1//1 5//1 6//1 2//1\nf -6/1/1 -5 -1 -2\n"
                           "f 1 3 7 5\r\n\tf 2 6 8 4 # last\n";
static const char
    tetrahedron[] = "solid four faces\n"
                    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 6 0\nvertex 6 0 0\nendloop\nendfacet\n"
                    "FACET NORMAL 0 0 0\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 6 0 0\nVERTEX 0 0 6\nENDLOOP\nENDFACET\n"
                    "facet normal 0 0 0 outer loop vertex 0 0 0 vertex -0 0 6 vertex 0 6 0 endloop endfacet\n"
                    "facet normal 0 0 0\nouter loop\nvertex 6 0 0\nvertex 0 6 0\nvertex 0 0 6e0\nendloop\nendfacet\n"
                    "endsolid four faces\n";

static struct mesh *read_text(const char *text) {
  struct mesh *mesh;
  const status code = mesh_read("shape", text, strlen(text), &mesh, &error);
  if (code)
    print_error("%s\n", error.message);
  assert_int_equal(code, STATUS_OK);
  return mesh;
}

static void near(double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance))
    print_error("%.17g is not %.17g\n", value, expected);
  assert_true(fabs(value - expected) <= tolerance);
}

TEST(cube_in_all_forms) {
  MESH *m = read_text(cube);
  assert_int_equal(m->faces, 12);
  near(m->volume, 1, 1e-15);
  near(m->area, 6, 1e-14);
  for (int k = 0; k < 3; k++) {
    near(m->centre[k], 1.5 + k, 1e-15);
    near(m->low[k], -0.5, 1e-15);
    near(m->high[k], 0.5, 1e-15);
  }
  double point[3], normal[3];
  /* The line from the centre meets the diagonal of the upper square, the edge of two faces. */
  assert_true(mesh_top(m, point, normal));
  near(point[2], 0.5, 1e-15);
  near(normal[2], 1, 1e-15);
  near(mesh_reach(m, (const double[3]){1, 1, 1}), 1.5, 1e-15);
  near(mesh_distance(m, (const double[3]){0.8, 0.9, 0}, normal), 0.5, 1e-15); /* from an edge */
  near(normal[0], 0.6, 1e-15);
  near(normal[1], 0.8, 1e-15);
  near(mesh_distance(m, (const double[3]){0.1, 0, 0.2}, normal), -0.3, 1e-15);
  near(normal[2], 1, 1e-15);
}

TEST(tetrahedron_of_words) {
  MESH *m = read_text(tetrahedron);
  near(m->volume, 36, 1e-13);
  for (int k = 0; k < 3; k++)
    near(m->centre[k], 1.5, 1e-14);
}

/* ---- a ball of many faces, in every format ---- */

enum { RINGS = 24, AROUND = 48, BALL = 2 * AROUND * (RINGS - 1) };

struct corner {
  float at[3];
};

static struct corner on_ball(int ring, int around) {
  const double polar = M_PI * ring / RINGS, turn = 2 * M_PI * (around % AROUND) / AROUND;
  if (ring == 0 || ring == RINGS)
    return (struct corner){{0, 0, ring ? -1 : 1}};
  return (struct corner){{(float)(sin(polar) * cos(turn)), (float)(sin(polar) * sin(turn)), (float)cos(polar)}};
}

/* The faces of a ball of meridians and parallels, three corners each. */
static void make_ball(struct corner faces[BALL][3]) {
  size_t n = 0;
  for (int i = 0; i < RINGS; i++)
    for (int j = 0; j < AROUND; j++) {
      const struct corner a = on_ball(i, j), b = on_ball(i + 1, j), c = on_ball(i + 1, j + 1), d = on_ball(i, j + 1);
      if (i + 1 < RINGS) {
        faces[n][0] = a, faces[n][1] = b, faces[n][2] = c;
        n++;
      }
      if (i > 0) {
        faces[n][0] = a, faces[n][1] = c, faces[n][2] = d;
        n++;
      }
    }
  assert_int_equal(n, BALL);
}

/* Formats: 0 OBJ, 1 STL as text, 2 binary STL. malloc'd. */
static char *write_ball(int format, bool inside_out, size_t *size) {
  static struct corner faces[BALL][3];
  char *text = NULL;
  FILE *out = open_memstream(&text, size);
  assert_non_null(out);
  make_ball(faces);
  const uint32_t count = BALL;
  char head[80] = "solid but binary";
  if (format == 1)
    fputs("solid ball\n", out);
  if (format == 2) {
    fwrite(head, 1, sizeof head, out);
    fwrite(&count, 4, 1, out);
  }
  for (size_t f = 0; f < BALL; f++) {
    if (format == 1)
      fputs("facet normal 0 0 0\nouter loop\n", out);
    if (format == 2)
      fwrite((const float[3]){0}, 4, 3, out);
    for (size_t c = 0; c < 3; c++) {
      const float *at = faces[f][inside_out ? 2 - c : c].at;
      if (format == 2)
        fwrite(at, 4, 3, out);
      else
        fprintf(out, "%s %.9g %.9g %.9g\n", format ? "vertex" : "v", (double)at[0], (double)at[1], (double)at[2]);
    }
    if (format == 0)
      fputs("f -3 -2 -1\n", out);
    if (format == 1)
      fputs("endloop\nendfacet\n", out);
    if (format == 2)
      fwrite("\0", 1, 2, out);
  }
  if (format == 1)
    fputs("endsolid ball\n", out);
  fclose(out);
  return text;
}

/* Texts have 9 digits of the floats. */
TEST(formats_agree) {
  MESH *first = NULL;
  for (int format = 0; format < 3; format++)
    for (int inside_out = 0; inside_out < 2; inside_out++) {
      size_t size;
      struct mesh *m = NULL;
      OWNED char *bytes = write_ball(format, inside_out, &size);
      OK(mesh_read("ball", bytes, size, &m, &error));
      near(m->volume, 4 * M_PI / 3, 0.02 * 4 * M_PI / 3);
      near(m->area, 4 * M_PI, 0.01 * 4 * M_PI);
      if (!first) {
        first = m;
        continue;
      }
      near(m->volume, first->volume, 1e-7);
      mesh_free(m);
    }
}

/* Inside and distance of the ball against its chords: faces lie between the radii r and 1. */
/* Bytes behind the last face, as some programs write them, are not read, and the mesh knows their number. */
TEST(binary_file_with_a_tail) {
  static const char tail[] = "\0exported by a program\n";
  size_t size;
  struct mesh *plain, *longer;
  OWNED char *bytes = write_ball(2, false, &size);
  OK(mesh_read("ball", bytes, size, &plain, &error));
  assert_int_equal(plain->tail, 0);
  bytes = realloc(bytes, size + sizeof tail);
  memcpy(bytes + size, tail, sizeof tail);
  for (size_t more = 1; more <= sizeof tail; more++) {
    OK(mesh_read("ball", bytes, size + more, &longer, &error));
    assert_int_equal(longer->tail, more);
    assert_int_equal(longer->faces, plain->faces);
    assert_memory_equal(longer->vertex, plain->vertex, plain->vertices * sizeof *plain->vertex);
    mesh_free(longer);
  }
  mesh_free(plain);
}

/* A backslash joins the next line of an OBJ file. Comments end with their line, and places in messages count all. */
TEST(obj_lines_go_on) {
  MESH *m = read_text("# made in C:\\models\\\n"
                      "v 0 \\\n 0 0\nv 6\\\r\n 0 \\  \n\\\n 0\nv 0 6 0\nv 0 0 6 # C:\\\n"
                      "f 1 3 \\\n2\nf 1\\\n 2\\\n 4\nf 1 4 3\nf \\\n2 3 4");
  assert_int_equal(m->faces, 4);
  near(m->volume, 36, 1e-13);
}

TEST(ball_inside_and_distance) {
  size_t size;
  MESH *m = NULL;
  OWNED char *bytes = write_ball(2, false, &size);
  OK(mesh_read("ball", bytes, size, &m, &error));
  const double r = cos(M_PI / RINGS) * cos(M_PI / AROUND) - 1e-6;
  int in = 0, thrown = 0;
  for (uint64_t i = 0; i < 100000; i++) {
    uint64_t bits[4];
    double p[3], normal[3], squares = 0;
    random_bits(3, RANDOM_FLAW_PLACE, 0, i, bits);
    for (int k = 0; k < 3; k++) {
      p[k] = 2.2 * random_uniform(bits[k]) - 1.1;
      if (i % 4 == 0) /* also on planes and lines of edges and vertices */
        p[k] = rint(8 * p[k]) / 8;
      squares += p[k] * p[k];
    }
    const double away = sqrt(squares);
    if (away < r || away > 1)
      assert_int_equal(mesh_inside(m, p), away < r);
    const double distance = mesh_distance(m, p, normal);
    assert_true(distance <= away - r + 1e-12 && distance >= away - 1 - 1e-6);
    near(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2], 1, 1e-9);
    in += mesh_inside(m, p);
    thrown++;
  }
  /* The share of the volume; throws on the eighths are not random, so 3 %. */
  near(in * 2.2 * 2.2 * 2.2 / thrown, m->volume, 0.03 * m->volume);
}

/* A cube as OBJ text: scale, offset along x, and the number of vertices before it. */
static void put_cube(FILE *out, double scale, double x, int before, bool inside_out) {
  static const int faces[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}};
  for (int i = 0; i < 8; i++)
    fprintf(out, "v %g %g %g\n", x + scale * (i / 4 - 0.5), scale * (i / 2 % 2 - 0.5), scale * (i % 2 - 0.5));
  for (int f = 0; f < 6; f++) {
    fputc('f', out);
    for (int c = 0; c < 4; c++)
      fprintf(out, " %d", before + faces[f][inside_out ? 3 - c : c]);
    fputc('\n', out);
  }
}

static char *two_cubes(double scale, double x, bool inside_out) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  put_cube(out, 2, 0, 0, false);
  put_cube(out, scale, x, 8, inside_out);
  fclose(out);
  return text;
}

static void refused(const char *text, size_t size, const char *part) {
  struct mesh *mesh;
  const status code = mesh_read("a.obj", text, size, &mesh, &error);
  if (code != STATUS_CONTENT || !strstr(error.message, part))
    print_error("expected \"%s\", got %d: %s\n", part, code, error.message);
  assert_int_equal(code, STATUS_CONTENT);
  assert_non_null(strstr(error.message, part));
  assert_null(mesh);
}

TEST(parts_and_cavities) {
  OWNED char *hollow = two_cubes(1, 0, true), *apart = two_cubes(1, 3, false);
  struct mesh *m = read_text(hollow);
  near(m->volume, 7, 1e-13);
  assert_int_equal(m->parts, 1);
  assert_false(mesh_inside(m, (const double[3]){0, 0.1, 0.2}));
  assert_true(mesh_inside(m, (const double[3]){0.7, 0.1, 0.2}));
  mesh_free(m);
  m = read_text(apart);
  near(m->volume, 9, 1e-13);
  near(m->centre[0], 1. / 3, 1e-14);
  assert_int_equal(m->parts, 2);
  mesh_free(m);

  OWNED char *overlap = two_cubes(1, 0.9, false), *within = two_cubes(1, 0, false), *reversed = two_cubes(1, 3, true);
  refused(overlap, strlen(overlap), "cuts itself");
  refused(within, strlen(within), "cuts itself");
  refused(reversed, strlen(reversed), "inside out");
}

TEST(refusals) {
  static const struct {
    const char *text, *part;
  } cases[] = {
      {"", "no faces"},
      {"# nothing\n", "no faces"},
      {"v 0 0 0\n", "no faces"},
      {"engine: sph\n", "a.obj:1: \"engine:\" begins no line of an OBJ file"},
      {"v 0 0\n", "a.obj:1: expected three numbers"},
      {"v 0 \\\n0 \\\n0\nv 1 \\\n2\n", "a.obj:4: expected three numbers"},
      {"v 0 0 0\nv 1 0 0\nf 1 2 \\", "got \"\\\""},
      {"v 0 0 1x\n", "a.obj:1: expected three numbers"},
      {"v 0 0 nan\n", "not finite"},
      {"v 0 0 1e30\n", "above 1e+15"},
      {"v 0 0 0\nf 1 1 2\n", "a.obj:2: the face has vertex 2, and 1 are given"},
      {"v 0 0 0\nf 1 0 1\n", "the face has vertex 0"},
      {"v 0 0 0\nf -2 1 1\n", "the face has vertex -2"},
      {"v 0 0 0\nf 1 a 1\n", "got \"a 1"},
      {"v 0 0 0\nf 99999999999999999999 1 1\n", "1 are given"},
      {"v 0 0 0\nv 1 0 0\nf 1 2\n", "has 2 corners"},
      {"v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n", "a.obj:4: the face has no area"},
      {"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no area"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj:4: the surface is open"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n", "that of line 5 turn opposite ways"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\nf 1 2 3\n", "has 3 faces"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n", "encloses a volume of 0"},
      {"solid a\nfacet normal 0 0\n", "a.obj:3: the file ends where"},
      {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 x\n", "a.obj:4: expected \"vertex\""},
      {"solid a\nface\n", "a.obj:2: expected \"facet normal\""},
      {"solid a\nendsolid a\nfacet\n", "a.obj:3: expected \"solid\" or the end"},
      {"v 0 0 0\nv 1e-3 0 0\nv 0 1e-3 0\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", "fills only"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    refused(cases[i].text, strlen(cases[i].text), cases[i].part);
  size_t size;
  OWNED char *bytes = write_ball(2, false, &size);
  refused(bytes, size - 1, "cut short or damaged");
  refused(bytes, 84, "cut short or damaged");
  refused(bytes, 83, "cut short or damaged");
  bytes[84 + 50 * 7 + 12 + 3] = 0x7f; /* the largest exponent */
  bytes[84 + 50 * 7 + 12 + 2] = (char)0x80;
  refused(bytes, size, "a.obj: face 8: the coordinate");
}

/* A ring: the line from its centre meets nothing. */
TEST(ring_is_missed) {
  enum { N = 24 };
  OWNED char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      const double a = 2 * M_PI * i / N, b = 2 * M_PI * j / N, r = 3 + cos(b);
      fprintf(out, "v %.12g %.12g %.12g\n", r * cos(a), r * sin(a), sin(b));
    }
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      fprintf(out, "f %d %d %d %d\n", i * N + j + 1, (i + 1) % N * N + j + 1, (i + 1) % N * N + (j + 1) % N + 1,
              i * N + (j + 1) % N + 1);
  fclose(out);
  MESH *m = read_text(text);
  double point[3], normal[3];
  near(m->volume, 2 * M_PI * M_PI * 3, 0.03 * 2 * M_PI * M_PI * 3);
  assert_false(mesh_top(m, point, normal));
}

TEST(files_by_content) {
  const struct mesh_file *first, *second;
  OK(mesh_files_add("a", cube, sizeof cube - 1, &first, &error));
  OK(mesh_files_add("b", cube, sizeof cube - 1, &second, &error));
  assert_ptr_equal(first, second);
  assert_ptr_equal(mesh_files_find(first->hash), first);
  assert_null(mesh_files_find("cube"));
  assert_int_equal(mesh_files_open("./no-such.obj", NULL, &second, &error), STATUS_MISSING);
  assert_non_null(strstr(error.message, "no-such.obj"));
  assert_int_equal(mesh_files_open("/dev", NULL, &second, &error), STATUS_IO);
  char large[] = "large-XXXXXX";
  const int file = mkstemp(large);
  assert_true(file >= 0 && ftruncate(file, MESH_MOST_BYTES + 1) == 0);
  assert_int_equal(mesh_files_open(large, ".", &second, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "32 MB is the most"));
  close(file);
  unlink(large);
}
