/* Fuzz target: a fields file (HDF5) with some bytes changed is read as the pictures do. Nothing crashes, and the number
 * of rows returned fits into memory. */
#include <unistd.h>

#include "analysis/pictures/snapshot_read.h"
#include "engine/snapshot_file.h"
#include "tests/fuzz/edits.h"
#include "tests/support/store_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* HDF5 leaks memory when a damaged file causes an error (seen with 1.10.8). */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libhdf5\n";
}

/* HDF5 takes sizes from a damaged file and requests exabytes. This allocation must fail as it does without a sanitizer.
 */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void) {
  return "allocator_may_return_null=1:max_allocation_size_mb=1000";
}

static void must(bool truth) {
  if (!truth)
    abort();
}

enum { ROWS = 300 };
static char path[64];

static void put_away(void) {
  unlink(path);
}

static struct edits_file seed(void) {
  struct snapshot_file *file = NULL;
  struct fixture_inputs inputs;
  struct error error;
  static double points[3 * ROWS];
  static int64_t owners[ROWS];
  for (int i = 0; i < ROWS; i++) {
    points[3 * i] = fixture_random(1, (uint64_t)i);
    owners[i] = i / 7;
  }
  const struct engine_kind fake = {.name = "fake",
                                   .doc = "Made-up numbers.",
                                   .results_version = 3,
                                   .inputs = &fixture_inputs_table,
                                   .results = &fixture_inputs_table};
  const struct outcome outcome = {.time = 0.5};
  field_defaults(&fixture_inputs_table, &inputs);
  snprintf(path, sizeof path, "%s/clast-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : ".");
  int descriptor = mkstemp(path);
  must(descriptor >= 0);
  close(descriptor);
  atexit(put_away);
  must(snapshot_file_open(&fake, 7, &inputs, &outcome, &inputs, &file, &error) == STATUS_OK);
  snapshot_file_data(file, "VTKHDF/Points", SNAPSHOT_FILE_REAL, ROWS, 3, points, "m", "where");
  snapshot_file_data(file, "VTKHDF/PointData/fragment", SNAPSHOT_FILE_INTEGER, ROWS, 0, owners, "1", "fragment");
  must(snapshot_file_save(file, path, &error) == STATUS_OK);
  snapshot_file_close(file);
  return edits_read(path);
}

static void read_rows(struct snapshot_read *file, const char *name, size_t width, enum snapshot_read_kind kind) {
  size_t rows = 0;
  char *values = snapshot_read_rows(file, name, width, kind, &rows);
  must(values || rows == 0);
  volatile char sum = 0; /* every byte can be read */
  for (size_t i = 0; i < rows * (width ? width : 1) * 8; i++)
    sum = (char)(sum + values[i]);
  free(values);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  static struct edits_file whole;
  static struct error error;
  struct snapshot_read *file = NULL;
  char text[64];
  double real = 0;
  long long integer = 0;
  if (!whole.bytes)
    whole = seed();
  edits_write(&whole, bytes, size, path);
  error.message[0] = 0;
  status code = snapshot_read_open(path, &file, &error);
  must(code == STATUS_OK || (error.message[0] && !file));
  if (code != STATUS_OK)
    return 0;
  snapshot_read_has(file, "VTKHDF/PointData");
  read_rows(file, "VTKHDF/Points", 3, SNAPSHOT_READ_REAL);
  read_rows(file, "VTKHDF/PointData/fragment", 0, SNAPSHOT_READ_INTEGER);
  snapshot_read_text(file, "run", "engine", text, sizeof text);
  snapshot_read_real(file, "run", "time", &real);
  snapshot_read_integer(file, "run", "seed", &integer);
  snapshot_read_close(file);
  return 0;
}
