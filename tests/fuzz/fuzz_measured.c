/* Fuzz target: any bytes as the CSV file of a measured spectrum (`clast spectrum --with`). An accepted file has
 * ascending masses and decreasing numbers, and can be drawn and compared with runs. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "analysis/statistics/statistics.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void must(bool truth) {
  if (!truth)
    abort();
}

static char path[64];

static void put_away(void) {
  unlink(path);
}

static void write_file(const uint8_t *bytes, size_t size) {
  if (!path[0]) {
    snprintf(path, sizeof path, "%s/clast-fuzz-XXXXXX", access("/dev/shm", W_OK) == 0 ? "/dev/shm" : ".");
    const int descriptor = mkstemp(path);
    must(descriptor >= 0);
    close(descriptor);
    atexit(put_away);
  }
  FILE *out = fopen(path, "wb");
  must(out && fwrite(bytes, 1, size, out) == size && fclose(out) == 0);
}

static void judge(const struct measured *m) {
  must(m->n > 0 && (m->mass[0] > 0 || (m->weighed && m->mass[0] == 0)) && isfinite(m->mass[m->n - 1]) &&
       m->above[0] > 0 && isfinite(m->above[0]));
  must(m->complete >= 0 && isfinite(m->complete) && m->above[m->n - 1] >= 0);
  for (size_t i = 1; i < m->n; i++)
    must(m->mass[i] >= m->mass[i - 1] && m->above[i] <= m->above[i - 1]);
}

/* Three runs of four fragments between 1 mg and 1 kg. */
static void compare(const struct measured *m) {
  static const double masses[] = {1, 0.1, 1e-3, 1e-6, 0.5, 0.2, 3e-3, 1e-5, 0.3, 0.05, 1e-4, 1e-6};
  static const size_t first[] = {0, 4, 8, 12};
  const struct pooled_runs runs = {3, first, masses};
  struct measured_match match;
  struct pooled_bin *bins = NULL;
  struct error error;
  size_t count = 0;
  error.message[0] = 0;
  if (measured_compare(m, &runs, fmax(m->complete, 1e-6), &match, &error) == STATUS_OK)
    must(isnan(match.distance) || (match.distance >= 0 && match.distance <= 1));
  else
    must(error.message[0]);
  for (int cumulative = 0; cumulative < 2; cumulative++) {
    const struct pooled_form form = {.cumulative = cumulative};
    if (measured_bins(m, &form, 1, &bins, &count, &error) == STATUS_OK)
      for (size_t i = 0; i < count; i++)
        must(bins[i].value >= 0 && bins[i].upper >= bins[i].lower);
    free(bins);
    bins = NULL;
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  static const struct spectrum_size by_mass = {0, 3};
  struct measured measured;
  struct error error;
  error.message[0] = 0;
  write_file(bytes, size);
  const status code = measured_read(path, &by_mass, &measured, &error);
  if (code) {
    must(code == STATUS_CONTENT && error.message[0] && !measured.mass && !measured.above);
    return 0;
  }
  judge(&measured);
  compare(&measured);
  measured_release(&measured);
  return 0;
}
