/* The reader of fields files reads no data from outside of the file. It refuses links and storage that lead elsewhere,
 * and types and shapes that clast never writes. */
#define CHECK_OWN_MAIN
#include <hdf5.h>
#include <unistd.h>

#include "analysis/pictures/snapshot_read.h"
#include "engine/snapshot_file.h"
#include "tests/support/run_case.h"
#include "tests/support/store_fixture.h"

enum { ROWS = 300 };
#define POINTS "VTKHDF/Points"

static char good[] = "/tmp/clast-read-good-XXXXXX", bad[] = "/tmp/clast-read-bad-XXXXXX";
static double points[3 * ROWS];

static const struct engine_kind fake = {.name = "fake",
                                        .doc = "Made-up numbers.",
                                        .results_version = 3,
                                        .inputs = &fixture_inputs_table,
                                        .results = &fixture_inputs_table};

static void write_file(const char *path) {
  struct snapshot_file *file = NULL;
  struct fixture_inputs inputs;
  const struct outcome outcome = {.time = 0.5};
  field_defaults(&fixture_inputs_table, &inputs);
  OK(snapshot_file_open(&fake, 7, &inputs, &outcome, &inputs, &file, &error));
  snapshot_file_data(file, POINTS, SNAPSHOT_FILE_REAL, ROWS, 3, points, "m", "where");
  OK(snapshot_file_save(file, path, &error));
  snapshot_file_close(file);
}

/* The reader's result for `path`. */
static void look(const char *path, bool *rows, bool *time) {
  struct snapshot_read *file;
  size_t count;
  double value = 0;
  OK(snapshot_read_open(path, &file, &error));
  OWNED double *read = snapshot_read_rows(file, POINTS, 3, SNAPSHOT_READ_REAL, &count);
  *rows = read;
  *time = snapshot_read_real(file, "run", "time", &value);
  assert_true(snapshot_read_close(file));
}

static hid_t open_without(const char *name) {
  unlink(bad); /* the process has read it, and no output replaces an input */
  write_file(bad);
  hid_t file = H5Fopen(bad, H5F_ACC_RDWR, H5P_DEFAULT);
  assert_true(file >= 0);
  assert_true(H5Ldelete(file, name, H5P_DEFAULT) >= 0);
  return file;
}

TEST(links_that_lead_elsewhere_are_refused) {
  bool rows, time;
  write_file(good);
  look(good, &rows, &time);
  assert_true(rows && time);
  const char *const names[] = {"VTKHDF", POINTS, "run"};
  for (size_t k = 0; k < 6; k++) {
    const char *name = names[k % 3];
    hid_t file = open_without(name);
    if (k < 3)
      assert_true(H5Lcreate_external(good, name, file, name, H5P_DEFAULT, H5P_DEFAULT) >= 0);
    else /* to itself */
      assert_true(H5Lcreate_soft(name, file, name, H5P_DEFAULT, H5P_DEFAULT) >= 0);
    H5Fclose(file);
    look(bad, &rows, &time);
    assert_int_equal(rows, k % 3 == 2);
    assert_int_equal(time, k % 3 != 2);
  }
}

/* Replaces the points with a data set. Closes all handles that it is given. */
static void refuse(hid_t type, hid_t space, hid_t layout) {
  bool rows, time;
  hid_t file = open_without(POINTS);
  hid_t set = H5Dcreate2(file, POINTS, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  assert_true(set >= 0);
  H5Dclose(set);
  H5Fclose(file);
  H5Pclose(layout);
  H5Sclose(space);
  H5Tclose(type);
  look(bad, &rows, &time);
  assert_false(rows);
  assert_true(time);
}

static hid_t shape(int rank, hsize_t rows, hsize_t width) {
  return H5Screate_simple(rank, (hsize_t[]){rows, width, 1}, NULL);
}

static hid_t layout(void) {
  return H5Pcreate(H5P_DATASET_CREATE);
}

static hid_t real(void) {
  return H5Tcopy(H5T_NATIVE_DOUBLE);
}

TEST(storage_outside_of_the_file_is_refused) {
  hid_t raw = layout(), virtual = layout(), space = shape(2, ROWS, 3);
  H5Pset_external(raw, "/etc/passwd", 0, sizeof points);
  refuse(real(), shape(2, ROWS, 3), raw);
  H5Pset_virtual(virtual, space, good, POINTS, space);
  H5Sclose(space);
  refuse(real(), shape(2, ROWS, 3), virtual);
}

TEST(strange_types_and_shapes_are_refused) {
  hid_t pair = H5Tcreate(H5T_COMPOUND, 16);
  H5Tinsert(pair, "x", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(pair, "y", 8, H5T_NATIVE_DOUBLE);
  refuse(pair, shape(2, ROWS, 3), layout());
  refuse(H5Tvlen_create(H5T_NATIVE_DOUBLE), shape(2, ROWS, 3), layout());
  refuse(real(), shape(3, ROWS, 3), layout());
  refuse(real(), shape(1, ROWS, 0), layout());
  refuse(real(), shape(2, ROWS, 2), layout());
  const hsize_t rows[] = {1000000000000000, 50000000}; /* none is stored */
  for (int k = 0; k < 2; k++) {
    hid_t chunks = layout();
    H5Pset_chunk(chunks, 2, (hsize_t[]){k ? 40000000 : 1000, 3});
    refuse(real(), shape(2, rows[k], 3), chunks);
  }
}

int main(void) {
  close(mkstemp(good));
  close(mkstemp(bad));
  int failed = check_run(NULL, NULL);
  unlink(good);
  unlink(bad);
  return failed;
}
