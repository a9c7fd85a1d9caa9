/* Restart files: what the next step depends on, for the same binary; written under a temporary name and renamed.
 *
 *   8 bytes magic, u64 version, u64 seed, u64 length of the identity text, the text (results_version and all inputs),
 *   u64 size + struct sph_state, u64 count + samples, u64 size + state of the system, u64 FNV-1a of all before it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/sph.h"
#include "engine/sph/run.h"
#include "engine/whole_file.h"

static const char magic[8] = "CLASTSPH";
enum { RESTART_VERSION = 1 };

static char *identity(const struct sph_inputs *inputs) {
  char *rows = field_identity(&sph_inputs, inputs), *text = NULL;
  size_t size = rows ? strlen(rows) + 64 : 0;
  if (rows && (text = malloc(size)))
    snprintf(text, size, "sph results_version=%d\n%s", sph_engine.results_version, rows);
  free(rows);
  return text;
}

struct bytes {
  unsigned char *at;
  size_t size, used; /* used: written, or read so far */
};

static void put(struct bytes *b, const void *from, size_t size) {
  memcpy(b->at + b->used, from, size);
  b->used += size;
}
static void put_number(struct bytes *b, uint64_t number) { put(b, &number, sizeof number); }

static bool get(struct bytes *b, void *to, size_t size) {
  if (b->size - b->used < size)
    return false;
  memcpy(to, b->at + b->used, size);
  b->used += size;
  return true;
}
static bool get_exactly(struct bytes *b, uint64_t number) {
  uint64_t came;
  return get(b, &came, sizeof came) && came == number;
}

static uint64_t checksum(const unsigned char *at, size_t size) {
  uint64_t hash = 0xcbf29ce484222325U;
  for (size_t k = 0; k < size; k++)
    hash = (hash ^ at[k]) * 0x100000001b3U;
  return hash;
}

status sph_restart_save(struct sph_run *run, const char *path, struct error *error) {
  char *text = identity(&run->inputs);
  size_t system = sph_system_state_size(run->system), samples = run->state.samples * sizeof *run->sample;
  struct bytes b = {0};
  if (text) {
    b.size = sizeof magic + 8 * 6 + strlen(text) + sizeof run->state + samples + system + 8;
    b.at = malloc(b.size);
  }
  if (!b.at) {
    free(text);
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  }
  put(&b, magic, sizeof magic);
  put_number(&b, RESTART_VERSION);
  put_number(&b, run->seed);
  put_number(&b, strlen(text));
  put(&b, text, strlen(text));
  put_number(&b, sizeof run->state);
  put(&b, &run->state, sizeof run->state);
  put_number(&b, samples);
  if (samples)
    put(&b, run->sample, samples);
  put_number(&b, system);
  sph_system_state_save(run->system, b.at + b.used);
  b.used += system;
  put_number(&b, checksum(b.at, b.used));
  status code = whole_file_write(path, "restart file", b.at, b.used, error);
  free(b.at);
  free(text);
  return code;
}

status sph_restart_load(const struct sph_inputs *inputs, const char *path, struct sph_run **out, struct error *error) {
  *out = NULL;
  struct bytes b = {0};
  struct sph_run *run = NULL;
  char *text = NULL;
  uint64_t seed, size, length;
  char head[sizeof magic];
  status code = whole_file_read(path, "restart file", &b.at, &b.size, error);
  if (code)
    goto cleanup;
  if (b.size < sizeof magic + 8 || !get(&b, head, sizeof head) || memcmp(head, magic, sizeof magic) != 0) {
    code = status_fail(error, STATUS_CONTENT, "'%s' is no restart file of engine sph", path);
    goto cleanup;
  }
  memcpy(&size, b.at + b.size - 8, 8);
  if (size != checksum(b.at, b.size - 8)) {
    code = status_fail(error, STATUS_CONTENT, "the restart file '%s' is damaged or cut short: start the run afresh", path);
    goto cleanup;
  }
  text = identity(inputs);
  if (!text) {
    code = status_fail(error, STATUS_MEMORY, "no memory to read '%s'", path);
    goto cleanup;
  }
  if (!get_exactly(&b, RESTART_VERSION) || !get(&b, &seed, 8) || !get(&b, &length, 8) || length != strlen(text) ||
      b.size - b.used < length || memcmp(b.at + b.used, text, length) != 0) {
    code = status_fail(error, STATUS_CONTENT,
                       "the restart file '%s' belongs to another scene or another version of clast: start the run afresh",
                       path);
    goto cleanup;
  }
  b.used += length;
  if ((code = sph_run_create(inputs, seed, &run, error)))
    goto cleanup;
  bool fits = get_exactly(&b, sizeof run->state) && get(&b, &run->state, sizeof run->state) && get(&b, &size, 8) &&
              size == run->state.samples * sizeof *run->sample && run->state.samples <= run->sample_capacity &&
              (size == 0 || get(&b, run->sample, size)) && get(&b, &size, 8) && size == b.size - b.used - 8 &&
              sph_system_state_load(run->system, b.at + b.used, size);
  if (!fits) {
    code = status_fail(error, STATUS_CONTENT,
                       "the restart file '%s' was written by another build of clast: start the run afresh", path);
    goto cleanup;
  }
  *out = run;
  run = NULL;
cleanup:
  sph_run_free(run);
  free(text);
  free(b.at);
  return code;
}
