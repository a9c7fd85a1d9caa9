/* Computes one task of the farm: the same code in process, in children, over MPI and in `clast simulate`. A task holds
 * the engine's name, its encoded inputs, the seed and the files to keep. The answer is one versioned encoding of
 * outcome, engine results, fragments and estimates, made from the field tables. */
#pragma once

#include "analysis/statistics/statistics.h"
#include "db/store/store.h"
#include "engine/scene.h"

struct run_request {
  const struct engine_kind *kind;
  const void *inputs; /* kind->inputs->size bytes */
  uint64_t seed;
  const char *fields_path;  /* HDF5 file to write at the end, or NULL */
  const char *restart_path; /* restart file, in process only; if it exists, the run goes on from it. Or NULL */
};

struct run_result {
  struct outcome outcome;
  void *result;               /* owned: kind->results->size bytes */
  struct fragment *fragments; /* owned: by descending mass */
  size_t fragment_count;
  struct estimate estimates[ESTIMATES_COUNT];
  size_t estimate_count;                 /* 0 for a run without fragments */
  char fields_digest[STORE_DIGEST_SIZE]; /* from run_work: of the fields file that was written; else "" */
  struct error unwritten; /* from run_work: why the fields file could not be written; STATUS_OK: it was written, or
                             was not requested */
};

/* Called before the first step and after each block of steps, for snapshots or a progress line. A status other than
 * STATUS_OK ends the run with that status. */
typedef status (*run_watch)(void *context, const struct engine_kind *kind, void *run, struct error *error);

/* Prepares a run, steps it to its end, and makes results and estimates. `watch` may be NULL; else it is called every
 * `block` steps. An invalid combination of inputs (STATUS_CONTENT of prepare) is a result, OUTCOME_INVALID, not an
 * error: the same seed would fail the same way again. main() has called analysis_init(). On an error *result is empty,
 * except when only the fields file could not be written: then it holds the results (result->result is not NULL), and
 * the caller must clear it. */
status run_simulate(const struct run_request *request, run_watch watch, void *context, uint64_t block,
                    struct run_result *result, struct error *error);
void run_result_clear(struct run_result *result);
/* A result that is cleared where its block is left: RUN_RESULT result = {0}; */
#define RUN_RESULT __attribute__((cleanup(run_result_clear))) struct run_result

/* malloc'd; NULL when memory is out. */
uint8_t *run_encode_task(const struct run_request *request, size_t *size);
/* STATUS_INTERNAL when the bytes are another version's or damaged. */
status run_decode_result(const struct engine_kind *kind, const uint8_t *bytes, size_t size, struct run_result *result,
                         struct error *error);

/* The farm_work of clast: runs a task. If the fields file cannot be written, the results are still encoded, with the
 * reason in `unwritten`. */
status run_work(const uint8_t *task, size_t task_size, uint8_t **result, size_t *result_size, struct error *error);

/* ---- provenance ----
 *
 * Facts about this program and machine, kept with every session of a store: version, commit (with its dirty flag),
 * compiler, flags, libraries, cpu model and class (bits are promised for one binary on one class), host, ranks, slots,
 * command line. Provenance, not identity. */

/* A JSON object, malloc'd; NULL when memory is out. argv may be NULL. */
char *provenance_json(int ranks, int slots, int argc, char *const *argv);

/* Names the build that computed a session, from the session's facts: "clast 0.9, commit abc, gcc 12". Writes "" for
 * this build, or when the facts are empty or do not name a build. */
enum { PROVENANCE_BUILD_SIZE = 320 };
void provenance_other_build(const char *version, const char *commit, const char *compiler,
                            char text[PROVENANCE_BUILD_SIZE]);
