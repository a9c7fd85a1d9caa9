/* Computes one run, and encodes tasks and results as bytes. */
#include "campaign/scheduler/run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/farm/farm.h"
#include "engine/grow.h"
#include "engine/restart.h"
#include "engine/threads.h"
#include "schemas/file.h"
#include "schemas/memory.h"

/* The encodings begin with these marks. All ranks of a farm run one binary, so arrays of structs are sent as they are
 * in memory. The marks, the sizes and the hashes of the tables find anything else. */
#define TASK_MARK   "clast task 3"
#define RESULT_MARK "clast result 4"

void run_result_clear(struct run_result *result) {
  free(result->result);
  free(result->fragments);
  *result = (struct run_result){0};
}

/* Makes the folder of the fields file if it is missing. Both are on the disk before the run's row. */
static status write_snapshot(const struct engine_kind *kind, void *run, const char *path, struct error *error) {
  const char *slash = strrchr(path, '/');
  if (slash && slash != path) {
    char folder[LIMITS_PATH];
    snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
    TRY(file_folder(folder, error));
  }
  return kind->write_snapshot(run, path, error);
}

static void invalid(const struct engine_kind *kind, struct run_result *result, const struct error *why) {
  field_defaults(&outcome_table, &result->outcome);
  result->outcome.state = OUTCOME_INVALID;
  snprintf(result->outcome.message, sizeof result->outcome.message, "%.*s", FIELD_TEXT_SIZE - 1, why->message);
  result->result = memory_small(1, kind->results->size);
  field_defaults(kind->results, result->result);
}

/* Goes on from the request's restart file. *run is NULL when the request names none or the file does not exist. */
static status resume(const struct run_request *request, void **run, struct error *error) {
  uint64_t seed = 0;
  *run = NULL;
  if (!request->restart_path)
    return STATUS_OK;
  status code = restart_peek(request->restart_path, &seed, error);
  if (code != STATUS_OK)
    return code == STATUS_MISSING ? STATUS_OK : code;
  if (seed != request->seed)
    return status_fail(error, STATUS_CONTENT,
                       "the restart file '%s' is of seed %llu, not %llu: ask for seed %llu, or name another file",
                       request->restart_path, (unsigned long long)seed, (unsigned long long)request->seed,
                       (unsigned long long)seed);
  return restart_load(request->kind, request->inputs, request->restart_path, run, error);
}

static status step_to_end(const struct engine_kind *kind, void *run, run_watch watch, void *context, uint64_t block,
                          struct error *error) {
  if (!watch)
    block = UINT64_C(1) << 62;
  for (bool finished = false;;) {
    status code = watch ? watch(context, kind, run, error) : STATUS_OK;
    if (code != STATUS_OK || finished)
      return code;
    code = kind->step(run, block, &finished, error);
    if (code != STATUS_OK)
      return code;
  }
}

/* Makes results and estimates of a run that has ended. On an error the caller clears *result. */
static status finish(const struct engine_kind *kind, void *run, struct run_result *result, struct error *error) {
  result->result = memory_small(1, kind->results->size);
  TRY(kind->finish(run, &result->outcome, result->result, &result->fragments, &result->fragment_count, error));
  if (result->fragment_count == 0)
    return STATUS_OK;
  result->estimate_count = ESTIMATES_COUNT;
  return estimates_make(result->fragment_count, result->fragments, result->outcome.complete_mass, result->estimates,
                        error);
}

status run_simulate(const struct run_request *request, run_watch watch, void *context, uint64_t block,
                    struct run_result *result, struct error *error) {
  const struct engine_kind *kind = request->kind;
  struct error why = {0};
  void *run = NULL;
  *result = (struct run_result){0};
  TRY(resume(request, &run, error));
  status code = STATUS_OK;
  if (!run) {
    code = kind->prepare(request->inputs, request->seed, &run, &why);
    if (code == STATUS_CONTENT) {
      invalid(kind, result, &why);
      return STATUS_OK;
    }
    if (code != STATUS_OK)
      return status_fail(error, code, "%s", why.message);
  }

  code = step_to_end(kind, run, watch, context, block, error);
  if (code == STATUS_OK)
    code = finish(kind, run, result, error);
  if (code != STATUS_OK)
    run_result_clear(result);
  else if (request->fields_path)
    code = write_snapshot(kind, run, request->fields_path, error);
  kind->free(run);
  return code;
}

/* The bytes of a task or a result: the same functions write and read them, so that a layout stands once. Writing,
 * `bytes` grow. Without memory for them, and for missing or unexpected bytes when reading, `good` becomes false, and
 * all later reads give zero. */
struct wire {
  uint8_t *bytes;
  size_t at, size;
  bool reads, good;
};

/* The place of the next `size` bytes. NULL: there is none. */
static uint8_t *next_bytes(struct wire *wire, uint64_t size) {
  wire->good = wire->good && (wire->reads ? size <= wire->size - wire->at
                                          : grow_room(&wire->bytes, &wire->size, wire->at + (size_t)size, 1));
  if (!wire->good)
    return NULL;
  wire->at += (size_t)size;
  return wire->bytes + wire->at - size;
}

/* What was written, malloc'd. NULL: there was no memory. */
static uint8_t *written(struct wire *wire, size_t *size) {
  *size = wire->at;
  if (!wire->good)
    memory_free(&wire->bytes);
  return wire->good ? wire->bytes : NULL;
}

/* Written, or filled when reading. */
static void pass(struct wire *wire, void *data, size_t size) {
  uint8_t *here = next_bytes(wire, size);
  if (here && size)
    memcpy(wire->reads ? data : here, wire->reads ? here : data, size);
}

static uint64_t pass_count(struct wire *wire, uint64_t count) {
  if (wire->reads)
    count = 0;
  pass(wire, &count, sizeof count);
  return count;
}

/* `room`: size of the array. */
static void pass_text(struct wire *wire, char *text, size_t room) {
  const uint64_t length = pass_count(wire, wire->reads ? 0 : strlen(text));
  wire->good = wire->good && length < room;
  if (!wire->reads || wire->good)
    pass(wire, text, (size_t)length);
  if (wire->reads)
    text[wire->good ? length : 0] = '\0';
}

static void pass_mark(struct wire *wire, const char *mark) {
  char text[64];
  snprintf(text, sizeof text, "%s", mark);
  pass_text(wire, text, sizeof text);
  wire->good = wire->good && strcmp(text, mark) == 0;
}

static void pass_object(struct wire *wire, const struct field_table *table, void *object) {
  const uint64_t size = pass_count(wire, wire->reads ? 0 : field_encoded_size(table, object));
  uint8_t *here = next_bytes(wire, size);
  if (here && !wire->reads)
    field_encode(table, object, here);
  else if (here && field_decode(table, here, (size_t)size, object) != size)
    wire->good = false;
}

/* How many structs follow. The other process must have the same struct size, and send at most `most`. */
static size_t pass_array_count(struct wire *wire, size_t count, size_t size, size_t most) {
  const uint64_t their_size = pass_count(wire, size), theirs = pass_count(wire, count);
  wire->good = wire->good && their_size == size && theirs <= most;
  return wire->good ? (size_t)theirs : 0;
}

static void write_task(struct wire *wire, const struct run_request *request) {
  char path[LIMITS_PATH];
  snprintf(path, sizeof path, "%s", request->fields_path ? request->fields_path : "");
  pass_mark(wire, TASK_MARK);
  pass_mark(wire, request->kind->name);
  const char *definition = request->kind->task ? request->kind->task : "";
  pass_count(wire, strlen(definition));
  pass(wire, (void *)definition, strlen(definition));
  pass_count(wire, request->seed);
  pass_text(wire, path, sizeof path);
  pass_object(wire, request->kind->inputs, (void *)request->inputs);

  const struct mesh_file *files[SCENE_FILES_MOST]; /* another process has not read them */
  const size_t count = scene_files_of(request->kind->inputs, request->inputs, files);
  pass_count(wire, count);
  for (size_t i = 0; i < count; i++) {
    pass_count(wire, files[i]->size);
    pass(wire, (void *)files[i]->bytes, files[i]->size);
  }
}

uint8_t *run_encode_task(const struct run_request *request, size_t *size) {
  struct wire wire = {.good = true};
  write_task(&wire, request);
  return written(&wire, size);
}

/* False: no memory. */
static bool pass_result(struct wire *wire, const struct engine_kind *kind, struct run_result *result) {
  const size_t fragment = sizeof *result->fragments, estimate = sizeof *result->estimates;
  pass_mark(wire, RESULT_MARK);
  pass_object(wire, &outcome_table, &result->outcome);
  pass_object(wire, kind->results, result->result);
  if (kind->ejecta)
    pass(wire, engine_ejecta(kind, result->result), sizeof(struct ejecta));
  const size_t most = wire->reads ? (wire->size - wire->at) / fragment : SIZE_MAX;
  result->fragment_count = pass_array_count(wire, result->fragment_count, fragment, most);
  if (wire->reads && result->fragment_count > 0) {
    result->fragments = malloc(result->fragment_count * fragment);
    if (!result->fragments)
      return false;
  }
  pass(wire, result->fragments, result->fragment_count * fragment);
  result->estimate_count = pass_array_count(wire, result->estimate_count, estimate, ESTIMATES_COUNT);
  pass(wire, result->estimates, result->estimate_count * estimate);
  pass_text(wire, result->fields_digest, sizeof result->fields_digest);
  result->unwritten.status = (status)pass_count(wire, result->unwritten.status);
  pass_text(wire, result->unwritten.message, sizeof result->unwritten.message);
  return true;
}

status run_decode_result(const struct engine_kind *kind, const uint8_t *bytes, size_t size, struct run_result *result,
                         struct error *error) {
  struct wire wire = {(uint8_t *)bytes, 0, size, true, true};
  *result = (struct run_result){.result = memory_small(1, kind->results->size)};
  const bool has_memory = pass_result(&wire, kind, result);
  if (has_memory && wire.good && wire.at == size)
    return STATUS_OK;
  run_result_clear(result);
  if (!has_memory)
    return status_fail(error, STATUS_MEMORY, "no memory for a result");
  return status_fail(error, STATUS_INTERNAL,
                     "a worker's answer cannot be read: it was damaged, or comes from another version of clast");
}

/* Reads a task; the caller frees the inputs. */
static status decode_task(const uint8_t *task, size_t size, struct run_request *request, void **inputs,
                          char fields_path[LIMITS_PATH], struct error *error) {
  struct wire wire = {(uint8_t *)task, 0, size, true, true};
  char name[64];
  pass_mark(&wire, TASK_MARK);
  pass_text(&wire, name, sizeof name);
  const uint64_t length = pass_count(&wire, 0);
  const uint8_t *definition = next_bytes(&wire, length);
  request->seed = pass_count(&wire, 0);
  pass_text(&wire, fields_path, LIMITS_PATH);
  if (wire.good) {
    request->kind = engine_find(name, error);
    if (request->kind && request->kind->of_task)
      request->kind = request->kind->of_task((const char *)definition, (size_t)length, error);
    if (!request->kind)
      return STATUS_INTERNAL;
    *inputs = memory_small(1, request->kind->inputs->size);
    pass_object(&wire, request->kind->inputs, *inputs);
  }
  for (uint64_t left = pass_count(&wire, 0); left > 0 && wire.good; left--) { /* files that the inputs name */
    const uint64_t bytes = pass_count(&wire, 0);
    const uint8_t *here = next_bytes(&wire, bytes);
    const struct mesh_file *file;
    if (here)
      TRY(mesh_files_add("a task's shape file", here, (size_t)bytes, &file, error));
  }
  if (!wire.good || wire.at != size)
    return status_fail(error, STATUS_INTERNAL, "the task cannot be read: it comes from another version of clast");
  request->inputs = *inputs;
  request->fields_path = *fields_path ? fields_path : NULL;
  return STATUS_OK;
}

status run_work(const uint8_t *task, size_t task_size, uint8_t **result, size_t *result_size, struct error *error) {
  struct run_request request = {0};
  RUN_RESULT values = {0};
  char fields_path[LIMITS_PATH];
  OWNED void *inputs = NULL;
  *result = NULL;
  *result_size = 0;
  TRY(decode_task(task, task_size, &request, &inputs, fields_path, error));
  if (request.kind->threads)
    farm_allow_memory(threads_stacks(*request.kind->threads(inputs) - 1));
  status code = run_simulate(&request, NULL, NULL, 0, &values, error);
  if (code != STATUS_OK && !values.result) {
    if (error->cause == ERROR_TIME_LIMIT)
      farm_end_as(FARM_TIME_LIMIT);
    else if (error->cause == ERROR_CRASH)
      farm_end_as(FARM_CRASHED);
    return code;
  }
  if (code == STATUS_OK && request.fields_path && values.outcome.state != OUTCOME_INVALID)
    code = store_digest_fields(request.fields_path, values.fields_digest, error);
  if (code != STATUS_OK && error)
    values.unwritten = *error;
  values.unwritten.status = code;
  struct wire wire = {.good = true};
  pass_result(&wire, request.kind, &values);
  *result = written(&wire, result_size);
  return *result ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the result");
}
