/* Fields files of particles: HDF5's own calls and our reader read what was written; the layout is the one that VTK and
 * ParaView open; truncated, changed and foreign files are refused. Also pictures from such files: with a folder as
 * argument they stay there. */
#define CHECK_OWN_MAIN
#include <sys/stat.h>
#include <unistd.h>

#include <cairo.h>
#include <hdf5.h>

#include "analysis/pictures/picture.h"
#include "engine/random.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/inputs.h"
#include "engine/sph/sph.h"
#include "tests/support/check.h"
#include "tests/support/sweep.h"

static char folder[256];
static bool keep_pictures; /* to look at */
static const char *at(const char *name) {
  static char path[4][512];
  static int turn;
  char *here = path[turn = (turn + 1) % 4];
  snprintf(here, sizeof path[0], "%s/%s", folder, name);
  return here;
}

/* A shattered sphere: an undamaged core, shells of spalls, dust between and at the place of the impact, a projectile.
 */
static struct sph_particles *shattered(double count) {
  struct sph_body body[2] = {{.shape = {.kind = SPH_SHAPE_SPHERE, .radius = 0.03},
                              .density = 2700,
                              .h_over_spacing = NAN},
                             {.shape = {.kind = SPH_SHAPE_SPHERE, .radius = 0.004, .centre = {0.012, 0, 0.041}},
                              .density = 1185,
                              .h_over_spacing = NAN}};
  body[0].lattice = (struct sph_lattice){.kind = SPH_LATTICE_HEXAGONAL, .particles = count};
  body[1].lattice = (struct sph_lattice){.kind = SPH_LATTICE_CUBIC, .particles = count / 60, .body = 1};
  struct sph_particles *p;
  struct sph_range range[2];
  OK(sph_bodies_make(body, 2, SPH_WITH_STRESS | SPH_WITH_DAMAGE | SPH_WITH_DISTENTION, &p, range, &error));
  for (size_t i = 0; i < p->n; i++) {
    double r[3] = {p->x[i] / 0.03, p->y[i] / 0.03, p->z[i] / 0.03},
           size = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    double cells = sin(9 * r[0] + 1) + sin(8 * r[1]) + sin(9 * r[2] + 2),
           hit = hypot(hypot(r[0] - 0.3, r[1]), r[2] - 0.95);
    double crack = fabs(size - 0.66) < 0.05 || fabs(cells) < 0.3 ? 1 : 0.3 * random_draw(4, 900, i, 0);
    if (size < 0.61)
      crack = 0.1 * random_draw(4, 900, i, 0);
    if (hit < 0.55)
      crack = 1;
    p->damage_cbrt[i] = p->body[i] ? 0 : cbrt(crack);
    p->pressure[i] = p->body[i] ? 2e9 : 3e8 * cos(6 * size) * exp(-3 * hit) - 5e6 * (size < 0.6);
    p->energy[i] = 1e5 * exp(-5 * hit);
    for (int k = 0; k < 6; k++)
      p->stress[k][i] = 1e6 * (k + 1) + (double)i;
    double out = p->body[i] ? 0 : hit < 0.55 ? 60 * (0.6 - hit) * (random_draw(4, 900, i, 1) + 0.2) : 0;
    p->vx[i] = 10 * r[0] + 300 * out * (r[0] - 0.3);
    p->vy[i] = 10 * r[1] + 300 * out * r[1];
    p->vz[i] = 10 * r[2] + 300 * out * (r[2] + 0.2);
    p->x[i] += 2e-5 * p->vx[i];
    p->y[i] += 2e-5 * p->vy[i];
    p->z[i] += 2e-5 * p->vz[i];
    p->distention[i] = 1 + 0.5 * size;
    p->rest_distention[i] = 1 + 0.4 * size;
  }
  return p;
}

static struct sph_fragments pieces_of(const struct sph_particles *p) {
  const struct sph_fragments_body bodies[2] = {{false, NAN}, {true, NAN}};
  struct sph_fragments_options options = sph_fragments_default();
  struct sph_fragments pieces;
  options.link_length = 1.2;
  options.bodies = bodies;
  options.body_count = 2;
  assert_int_equal(sph_fragments_find(p, &options, &pieces, NULL), STATUS_OK);
  return pieces;
}

static status write_file(const char *path, const struct sph_particles *p, const struct sph_fragments *pieces,
                         const uint32_t *flaws, struct error *e) {
  static struct sph_inputs inputs;
  static struct sph_results results;
  const struct outcome outcome = {.time = 2.5e-5};
  struct snapshot_file *file;
  field_defaults(&sph_inputs, &inputs);
  field_defaults(&sph_results, &results);
  assert_int_equal(snapshot_file_open(&sph_engine, 7, &inputs, &outcome, &results, &file, e), STATUS_OK);
  sph_snapshot_particles(file, p, pieces, flaws);
  status code = snapshot_file_save(file, path, e);
  snapshot_file_close(file);
  return code;
}

static void read_doubles(hid_t file, const char *name, size_t rows, size_t width, double *values) {
  hsize_t size[2] = {0, 0};
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
  assert_int_equal(H5Sget_simple_extent_ndims(space), width ? 2 : 1);
  H5Sget_simple_extent_dims(space, size, NULL);
  assert_int_equal(size[0], rows);
  assert_true(!width || size[1] == width);
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  H5Sclose(space);
  H5Dclose(set);
}

TEST(what_is_written_is_what_is_read) {
  SPH_PARTICLES *p = shattered(6000);
  OWNED_BY(sph_fragments_clear) struct sph_fragments pieces = pieces_of(p);
  OWNED uint32_t *flaws = malloc(p->n * sizeof *flaws);
  size_t n = p->n;
  OWNED double *values = malloc(9 * (n + 1) * sizeof *values);
  for (size_t i = 0; i < n; i++)
    flaws[i] = (uint32_t)(i % 17);
  OK(write_file(at("a.hdf"), p, &pieces, flaws, &error));
  hid_t file = H5Fopen(at("a.hdf"), H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(file >= 0);
  read_doubles(file, "VTKHDF/Points", n, 3, values);
  for (size_t i = 0; i < n; i++)
    assert_true(values[3 * i] == p->x[i] && values[3 * i + 1] == p->y[i] && values[3 * i + 2] == p->z[i]);
  read_doubles(file, "VTKHDF/PointData/velocity", n, 3, values);
  for (size_t i = 0; i < n; i++)
    assert_true(values[3 * i] == p->vx[i] && values[3 * i + 1] == p->vy[i] && values[3 * i + 2] == p->vz[i]);
  const struct {
    const char *name;
    const double *column;
  } scalars[] = {{"mass", p->mass},          {"density", p->density},       {"energy", p->energy},
                 {"smoothing_length", p->h}, {"distention", p->distention}, {"rest_distention", p->rest_distention}};
  for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++) {
    char name[100];
    snprintf(name, sizeof name, "VTKHDF/PointData/%s", scalars[k].name);
    read_doubles(file, name, n, 0, values);
    assert_memory_equal(values, scalars[k].column, n * sizeof *values);
    assert_true(H5Aexists_by_name(file, name, "units", H5P_DEFAULT) > 0 &&
                H5Aexists_by_name(file, name, "long_name", H5P_DEFAULT) > 0);
  }
  size_t masked = 0;
  read_doubles(file, "VTKHDF/PointData/pressure", n, 0, values);
  for (size_t i = 0; i < n; i++) {
    const double damage = pow(p->damage_cbrt[i], 3), pressure = p->pressure[i];
    masked += isnan(values[i]) != 0;
    if (pressure < 0 && damage > 0.99) /* broken matter bears no tension */
      assert_true(isnan(values[i]));
    else
      assert_true(fabs(values[i] - (pressure < 0 ? (1 - damage) * pressure : pressure)) <= 1e-9 * fabs(pressure));
  }
  assert_true(masked > 0 && masked < n / 2);
  read_doubles(file, "VTKHDF/PointData/damage", n, 0, values);
  for (size_t i = 0; i < n; i++)
    assert_true(values[i] == p->damage_cbrt[i] * p->damage_cbrt[i] * p->damage_cbrt[i]);
  read_doubles(file, "VTKHDF/PointData/deviator", n, 9, values);
  for (size_t i = 0; i < n; i++) /* S x, S y, S z: symmetric, row by row */
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        static const int which[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
        assert_true(values[9 * i + (size_t)(3 * a + b)] == p->stress[which[a][b]][i]);
      }
  read_doubles(file, "VTKHDF/PointData/fragment", n, 0, values);
  for (size_t i = 0; i < n; i++)
    assert_true(values[i] == (pieces.label[i] == UINT32_MAX ? -1 : (double)pieces.label[i]));
  read_doubles(file, "VTKHDF/PointData/flaws", n, 0, values);
  for (size_t i = 0; i < n; i++)
    assert_true(values[i] == flaws[i]);
  read_doubles(file, "VTKHDF/PointData/body", n, 0, values);
  assert_true(values[0] == 0 && values[n - 1] == 1);
  read_doubles(file, "fragments/spin", pieces.count, 3, values);
  assert_true(values[1] == pieces.fragments[0].spin[1]);
  H5Fclose(file);

  OWNED_BY(picture_cloud_clear) struct picture_cloud cloud;
  OK(picture_cloud_read(at("a.hdf"), &cloud, &error));
  assert_true(picture_cloud_in_file(at("a.hdf")));
  assert_int_equal(cloud.n, n);
  assert_string_equal(cloud.engine, "sph");
  assert_int_equal(cloud.seed, 7);
  assert_true(cloud.time == 2.5e-5);
  for (size_t i = 0; i < n; i++) {
    assert_true(cloud.position[i][1] == p->y[i] && cloud.mass[i] == p->mass[i] && cloud.part[i] == pieces.part[i]);
    assert_true(cloud.size[i] == cbrt(p->mass[i] / p->density[i]));
  }
  double *column;
  char unit[32];
  OK(picture_cloud_read_column(at("a.hdf"), &cloud, "pressure", &column, unit, &error));
  for (size_t i = 0; i < n; i++)
    assert_true(isnan(column[i]) || column[i] >= fmin(p->pressure[i], 0));
  assert_string_equal(unit, "Pa");
  free(column);
  const char *const bad[] = {"colour", "", "../Points", "deviator", "."};
  for (size_t k = 0; k < 5; k++) {
    assert_int_equal(picture_cloud_read_column(at("a.hdf"), &cloud, bad[k], &column, unit, &error), STATUS_CONTENT);
    assert_non_null(strstr(error.message, "damage, pressure"));
    assert_null(column);
  }
  struct picture_body body; /* its cells are no polygons */
  assert_int_equal(picture_fragments_read(at("a.hdf"), &body, &error), STATUS_CONTENT);
  assert_int_equal(body.cells, 0);
  unlink(at("a.hdf"));
}

/* VTKHDF 1.0: what ParaView 5.11 and VTK 9.1 require. */
TEST(layout_is_what_vtk_reads) {
  SPH_PARTICLES *p = shattered(6000); /* enough for the compressed columns */
  OWNED_BY(sph_fragments_clear) struct sph_fragments pieces = pieces_of(p);
  assert_int_equal(write_file(at("v.hdf"), p, &pieces, NULL, NULL), STATUS_OK);
  hid_t file = H5Fopen(at("v.hdf"), H5F_ACC_RDONLY, H5P_DEFAULT),
        attribute = H5Aopen_by_name(file, "VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT);
  hid_t type = H5Aget_type(attribute);
  char text[32] = "";
  assert_int_equal(H5Tis_variable_str(type), 0);
  assert_int_equal(H5Tget_cset(type), H5T_CSET_ASCII);
  assert_int_equal(H5Tget_size(type), strlen("UnstructuredGrid"));
  H5Aread(attribute, type, text);
  assert_string_equal(text, "UnstructuredGrid");
  H5Tclose(type);
  H5Aclose(attribute);
  int64_t version[2] = {9, 9}, one = 0;
  attribute = H5Aopen_by_name(file, "VTKHDF", "Version", H5P_DEFAULT, H5P_DEFAULT);
  hid_t space = H5Aget_space(attribute);
  assert_int_equal(H5Sget_simple_extent_npoints(space), 2);
  H5Sclose(space);
  H5Aread(attribute, H5T_NATIVE_INT64, version);
  H5Aclose(attribute);
  assert_true(version[0] == 1 && version[1] == 0);
  const char *const counts[] = {"VTKHDF/NumberOfPoints", "VTKHDF/NumberOfCells", "VTKHDF/NumberOfConnectivityIds"};
  for (int k = 0; k < 3; k++) {
    hid_t set = H5Dopen2(file, counts[k], H5P_DEFAULT);
    H5Dread(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &one);
    H5Dclose(set);
    assert_int_equal(one, p->n);
  }
  OWNED double *values = malloc((p->n + 1) * sizeof *values);
  read_doubles(file, "VTKHDF/Connectivity", p->n, 0, values);
  assert_true(values[0] == 0 && values[p->n - 1] == (double)p->n - 1);
  read_doubles(file, "VTKHDF/Offsets", p->n + 1, 0, values);
  assert_true(values[0] == 0 && values[p->n] == (double)p->n);
  read_doubles(file, "VTKHDF/Types", p->n, 0, values);
  for (size_t i = 0; i < p->n; i++)
    assert_true(values[i] == 1); /* VTK_VERTEX */
  hid_t set = H5Dopen2(file, "VTKHDF/Types", H5P_DEFAULT);
  type = H5Dget_type(set);
  assert_true(H5Tequal(type, H5T_NATIVE_UCHAR) > 0);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(file);
  unlink(at("v.hdf"));
}

static void copy_file(const char *from, const char *to, long keep) {
  FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
  OWNED char *bytes = malloc((size_t)keep + 1);
  assert_int_equal(fread(bytes, 1, (size_t)keep, in), keep);
  fwrite(bytes, 1, (size_t)keep, out);
  fclose(in);
  fclose(out);
}

/* Replaces a data set of a good file by another. */
static void replace(const char *path, const char *name, hid_t type, int rank, hsize_t rows, hsize_t width,
                    const void *values) {
  hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), space, layout = H5Pcreate(H5P_DATASET_CREATE);
  hsize_t size[2] = {rows, width}, chunk[2] = {1000, width ? width : 1};
  H5Ldelete(file, name, H5P_DEFAULT);
  space = H5Screate_simple(rank, size, NULL);
  if (!values)
    H5Pset_chunk(layout, rank, chunk); /* declares a large size, stores nothing */
  hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  assert_true(set >= 0);
  if (values)
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(set);
  H5Pclose(layout);
  H5Sclose(space);
  H5Fclose(file);
}

TEST(damaged_and_foreign_files_are_refused) {
  SPH_PARTICLES *p = shattered(500);
  OWNED_BY(sph_fragments_clear) struct sph_fragments pieces = pieces_of(p);
  struct picture_cloud cloud;
  size_t n = p->n;
  char good[512], bad[512];
  snprintf(good, sizeof good, "%s", at("good.hdf"));
  snprintf(bad, sizeof bad, "%s", at("bad.hdf"));
  assert_int_equal(write_file(good, p, &pieces, NULL, NULL), STATUS_OK);
  struct stat info;
  assert_int_equal(stat(good, &info), 0);
  for (long k = 0; k < 24; k++) {
    copy_file(good, bad, (long)info.st_size * k / 24);
    assert_int_equal(picture_cloud_read(bad, &cloud, &error), STATUS_CONTENT);
    assert_true(cloud.n == 0 && !cloud.position);
  }
#ifdef __SANITIZE_ADDRESS__ /* HDF5 1.10 itself reads beyond its buffers in damaged headers */
  const uint64_t damages = 0;
#else
  const uint64_t damages = 300;
#endif
  for (uint64_t k = 0; k < damages; k++) { /* bytes changed anywhere: refused or read, never a crash */
    copy_file(good, bad, (long)info.st_size);
    FILE *file = fopen(bad, "r+b");
    for (uint64_t b = 0; b < 4; b++) { /* half of them in the head, where the structure is */
      double draw = random_draw(k, 900, b, 0);
      fseek(file, (long)(draw < 0.5 ? draw * 8000 : (draw - 0.5) * 2 * (double)(info.st_size - 1)), SEEK_SET);
      fputc((int)(256 * random_draw(k, 900, b, 1)), file);
    }
    fclose(file);
    status code = picture_cloud_read(bad, &cloud, &error);
    assert_true(code == STATUS_OK || code == STATUS_CONTENT);
    picture_cloud_clear(&cloud);
  }
  OWNED double *wild = calloc(3 * n, sizeof *wild);
  OWNED int64_t *number = calloc(n, sizeof *number);
#define REFUSED(words)                                                                                                 \
  do {                                                                                                                 \
    assert_int_equal(picture_cloud_read(bad, &cloud, &error), STATUS_CONTENT);                                         \
    if (!strstr(error.message, words))                                                                                 \
      fail_msg("not '%s': %s", words, error.message);                                                                  \
    copy_file(good, bad, (long)info.st_size);                                                                          \
  } while (0)
  copy_file(good, bad, (long)info.st_size);
  OK(picture_cloud_read(bad, &cloud, &error));
  picture_cloud_clear(&cloud);
  wild[7] = NAN;
  replace(bad, "VTKHDF/Points", H5T_NATIVE_DOUBLE, 2, n, 3, wild);
  REFUSED("not finite");
  replace(bad, "VTKHDF/PointData/density", H5T_NATIVE_DOUBLE, 1, n, 0, wild);
  REFUSED("not positive");
  replace(bad, "VTKHDF/PointData/mass", H5T_NATIVE_DOUBLE, 1, n - 1, 0, p->mass);
  REFUSED("differ in length");
  number[n - 1] = (int64_t)n;
  replace(bad, "VTKHDF/PointData/fragment", H5T_NATIVE_INT64, 1, n, 0, number);
  REFUSED("out of range");
  number[n - 1] = -2;
  replace(bad, "VTKHDF/PointData/fragment", H5T_NATIVE_INT64, 1, n, 0, number);
  REFUSED("out of range");
  number[n - 1] = 4;
  replace(bad, "VTKHDF/PointData/part", H5T_NATIVE_INT64, 1, n, 0, number);
  REFUSED("none of core");
  replace(bad, "VTKHDF/Points", H5T_NATIVE_DOUBLE, 2, 99000000, 3, NULL); /* a file of 100 kB that declares 2.4 GB */
  REFUSED("cannot be read");
  replace(bad, "VTKHDF/Points", H5T_NATIVE_DOUBLE, 2, n, 2, wild);
  REFUSED("cannot be read");
  replace(bad, "VTKHDF/Points", H5T_NATIVE_DOUBLE, 1, n, 0, wild);
  REFUSED("cannot be read");
  FILE *text = fopen(bad, "wb");
  fputs("this is no HDF5 file\n", text);
  fclose(text);
  assert_int_equal(picture_cloud_read(bad, &cloud, &error), STATUS_CONTENT);
  assert_false(picture_cloud_in_file(bad));
  unlink(bad);
  assert_int_equal(picture_cloud_read(bad, &cloud, &error), STATUS_MISSING);
  assert_int_equal(write_file(at("no/such/folder/x.hdf"), p, &pieces, NULL, &error), STATUS_IO);
  unlink(good);
}

static unsigned char pixel(const char *path, double x,
                           double y) { /* mean brightness round a place; x and y are fractions of width and height */
  cairo_surface_t *surface = cairo_image_surface_create_from_png(path);
  assert_int_equal(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  int stride = cairo_image_surface_get_stride(surface), sum = 0;
  const unsigned char *data = cairo_image_surface_get_data(surface);
  int column = (int)(x * cairo_image_surface_get_width(surface)),
      line = (int)(y * cairo_image_surface_get_height(surface));
  for (int j = -4; j <= 4; j++)
    for (int i = -4; i <= 4; i++)
      sum += data[(line + j) * stride + 4 * (column + i) + 1];
  cairo_surface_destroy(surface);
  return (unsigned char)(sum / 81);
}

TEST(pictures) {
  struct sph_particles *p = shattered(keep_pictures ? 60000 : 8000);
  OWNED_BY(sph_fragments_clear) struct sph_fragments pieces = pieces_of(p);
  assert_int_equal(write_file(at("p.hdf"), p, &pieces, NULL, NULL), STATUS_OK);
  OWNED_BY(picture_cloud_clear) struct picture_cloud cloud;
  OK(picture_cloud_read(at("p.hdf"), &cloud, &error));
  char numbers[200], unit[32];
  picture_particles_numbers(&cloud, numbers, sizeof numbers);
  assert_non_null(strstr(numbers, "of the mass"));
  struct picture_look look = {.view = PICTURE_CUT,
                              .axis = 1,
                              .plane = 0,
                              .title = "A shattered sphere",
                              .subtitle = numbers};
  const struct {
    const char *file, *column;
    enum picture_view view;
    int axis;
  } wanted[] = {{"cut-damage.png", "damage", PICTURE_CUT, 1},
                {"cut-pressure.png", "pressure", PICTURE_CUT, 1},
                {"cut-fragment.png", NULL, PICTURE_CUT, 1},
                {"apart.png", NULL, PICTURE_APART, 1},
                {"outside-damage.png", "damage", PICTURE_OUTSIDE, 1},
                {"cut-distention.png", "distention", PICTURE_CUT, 2},
                {"outside.svg", NULL, PICTURE_CUT, 0}};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
    OWNED double *column = NULL;
    if (wanted[k].column)
      OK(picture_cloud_read_column(at("p.hdf"), &cloud, wanted[k].column, &column, unit, &error));
    cloud.value = column;
    look.view = wanted[k].view;
    look.axis = wanted[k].axis;
    look.quantity = wanted[k].column;
    look.unit = unit;
    OK(picture_particles(at(wanted[k].file), 900, &cloud, &look, &error));
  }
  cloud.value = NULL;
  /* the core of the damage picture is light, the crater dark; paper all round is white */
  if (!keep_pictures) {
    assert_true(pixel(at("cut-damage.png"), 0.40, 0.55) > 150);
    assert_true(pixel(at("cut-damage.png"), 0.99, 0.99) == 255);
  }
  look.plane = 5;
  look.view = PICTURE_CUT;
  assert_int_equal(picture_particles(at("none.png"), 900, &cloud, &look, &error), STATUS_USAGE);
  assert_non_null(strstr(error.message, "meets no particle"));
  look.plane = 0;
  assert_int_equal(picture_particles(at("none.jpg"), 900, &cloud, &look, &error), STATUS_USAGE);
  struct picture_cloud none = {0};
  assert_int_equal(picture_particles(at("none.png"), 900, &none, &look, &error), STATUS_USAGE);
  for (size_t k = 0; !keep_pictures && k < sizeof wanted / sizeof *wanted; k++)
    assert_int_equal(unlink(at(wanted[k].file)), 0);
  sph_particles_free(p);
  unlink(at("p.hdf"));
}

int main(int argc, char **argv) {
  keep_pictures = argc > 1;
  snprintf(folder, sizeof folder, "%s", keep_pictures ? argv[1] : "/tmp/clast_sph_fields_XXXXXX");
  if (!keep_pictures && !mkdtemp(folder))
    return 1;
  int failed = check_run(NULL, NULL);
  if (!keep_pictures && sweep(folder, NULL))
    return 1;
  return failed;
}
