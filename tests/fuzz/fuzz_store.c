/* Fuzz target: a store with some bytes changed is read, checked, written and merged. Every failed call gives a message;
 * nothing crashes, and rows merged from a damaged store are complete. */
#include "db/ask/ask.h"
#include "tests/fuzz/edits.h"
#include "tests/support/store_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void must(bool truth) {
  if (!truth)
    abort();
}

static void told(status code, const struct error *error) {
  must(code == STATUS_OK || error->message[0]);
}

static char folder[64], whole[96], damaged[96], target[96];

static void put_away(void) {
  static const char *const ends[] = {"", "-wal", "-shm", "-journal"};
  const char *const paths[] = {whole, damaged, target};
  for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++)
    for (size_t k = 0; k < sizeof ends / sizeof ends[0]; k++) {
      char path[128];
      snprintf(path, sizeof path, "%s%s", paths[i], ends[k]);
      unlink(path);
    }
  rmdir(folder);
}

/* Path of the complete store and of the others: in memory if the machine has a memory file system. */
static struct edits_file seed(void) {
  struct store *store = NULL;
  struct error error;
  snprintf(folder, sizeof folder, "%s/clast-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : ".");
  must(mkdtemp(folder) != NULL);
  snprintf(whole, sizeof whole, "%s/whole.db", folder);
  snprintf(damaged, sizeof damaged, "%s/damaged.db", folder);
  snprintf(target, sizeof target, "%s/target.db", folder);
  atexit(put_away);
  must(store_open_writer(whole, &store, NULL, 0, &error) == STATUS_OK);
  must(fixture_populate(store, 1, 2, 4, false, &error) == STATUS_OK);
  must(store_close(store, &error) == STATUS_OK);
  return edits_read(whole);
}

static char *dump(struct store *store, status *code, struct error *error) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  must(out != NULL);
  *code = store_export_digests(store, out, error);
  fclose(out);
  return text;
}

static void read_it(struct error *error) {
  struct store *store = NULL;
  status code = store_open_reader(damaged, &store, error);
  told(code, error);
  if (code != STATUS_OK)
    return;
  double number = 0;
  told(store_check(store, NULL, NULL, error), error);
  free(dump(store, &code, error));
  told(code, error);
  told(answer_number(store, &number, error, "SELECT sum(beta) FROM estimates"), error);
  ANSWER points = ask_points_rows(store, true, 2, (const char *const[]){"material_m", "material_k"}, error);
  for (struct ask_points_row row; ask_points_next(&points, &row);)
    ;
  told(answer_end(&points), error);
  told(store_close(store, error), error);
}

static void write_on(struct error *error) {
  struct store *store = NULL;
  status code = store_open_writer(damaged, &store, NULL, 0, error);
  told(code, error);
  if (code != STATUS_OK)
    return;
  told(fixture_populate(store, 1, 2, 6, true, error), error);
  told(store_close(store, error), error);
}

static void merge_it(struct error *error) {
  struct store *store = NULL;
  int64_t added = 0, differing = 0;
  unlink(target);
  must(store_open_writer(target, &store, NULL, 0, error) == STATUS_OK);
  status code = store_merge(store, damaged, &added, &differing, error);
  told(code, error);
  must(code == STATUS_OK || added == 0);
  must(store_close(store, error) == STATUS_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  static struct edits_file file;
  static struct error error;
  if (!file.bytes)
    file = seed();
  edits_write(&file, bytes, size, damaged);
  read_it(&error);
  merge_it(&error);
  write_on(&error);
  return 0;
}
