/* Computes one run, and encodes tasks and results as bytes. */
#include "campaign/scheduler/run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/farm/farm.h"
#include "engine/restart.h"
#include "engine/scene.h"
#include "engine/threads.h"
#include "schemas/file.h"
#include "schemas/limits.h"

/* The encodings begin with these marks. All ranks of a farm run one binary, so arrays of structs are sent as they are
 * in memory. The marks, the sizes and the hashes of the tables find anything else. */
#define TASK_MARK   "clast task 2"
#define RESULT_MARK "clast result 3"

void run_result_clear(struct run_result *result) {
  free(result->result);
  free(result->fragments);
  *result = (struct run_result){0};
}

/* Makes the folder of the fields file if it is missing. Both are on the disk before the run's row. */
static status write_snapshot(const struct engine_kind *kind, void *run, const char *path, struct error *error) {
  const char *slash = strrchr(path, '/');
  if (slash && slash != path) {
    char *folder = strndup(path, (size_t)(slash - path));
    const status code = folder ? file_folder(folder, error)
                               : status_fail(error, STATUS_MEMORY, "no memory for the name of a folder");
    free(folder);
    if (code != STATUS_OK)
      return code;
  }
  return kind->write_snapshot(run, path, error);
}

static status invalid(const struct engine_kind *kind, struct run_result *result, const struct error *why,
                      struct error *error) {
  field_defaults(&outcome_table, &result->outcome);
  result->outcome.state = OUTCOME_INVALID;
  snprintf(result->outcome.message, sizeof result->outcome.message, "%.*s", FIELD_TEXT_SIZE - 1, why->message);
  result->result = calloc(1, kind->results->size);
  if (!result->result)
    return status_fail(error, STATUS_MEMORY, "no memory for the result");
  field_defaults(kind->results, result->result);
  return STATUS_OK;
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
  result->result = calloc(1, kind->results->size);
  if (!result->result)
    return status_fail(error, STATUS_MEMORY, "no memory for the result");
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
    if (code == STATUS_CONTENT)
      return invalid(kind, result, &why, error);
    if (code != STATUS_OK)
      return status_fail(error, code, "%s", why.message);
  }

  code = step_to_end(kind, run, watch, context, block, error);
  if (code != STATUS_OK)
    goto cleanup;
  code = finish(kind, run, result, error);
  if (code != STATUS_OK)
    run_result_clear(result);
  else if (request->fields_path)
    code = write_snapshot(kind, run, request->fields_path, error);
cleanup:
  kind->free(run);
  return code;
}

/* Writes bytes. A first pass with bytes = NULL counts them. */
struct writer {
  uint8_t *bytes;
  size_t size;
};
static void put(struct writer *writer, const void *data, size_t size) {
  if (writer->bytes && size)
    memcpy(writer->bytes + writer->size, data, size);
  writer->size += size;
}
static void put_count(struct writer *writer, uint64_t count) {
  put(writer, &count, sizeof count);
}
static void put_text(struct writer *writer, const char *text) {
  put_count(writer, strlen(text));
  put(writer, text, strlen(text));
}
static void put_object(struct writer *writer, const struct field_table *table, const void *object) {
  size_t size = field_encoded_size(table, object);
  put_count(writer, size);
  if (writer->bytes)
    field_encode(table, object, writer->bytes + writer->size);
  writer->size += size;
}

/* Reads bytes. Missing or unexpected bytes set `good` to false, and all later reads give zero. */
struct reader {
  const uint8_t *bytes;
  size_t left;
  bool good;
};
static const uint8_t *take(struct reader *reader, uint64_t size) {
  if (!reader->good || size > reader->left) {
    reader->good = false;
    return NULL;
  }
  const uint8_t *here = reader->bytes;
  reader->bytes += size;
  reader->left -= (size_t)size;
  return here;
}
static uint64_t take_count(struct reader *reader) {
  uint64_t count = 0;
  const uint8_t *bytes = take(reader, sizeof count);
  if (bytes)
    memcpy(&count, bytes, sizeof count);
  return count;
}
static bool take_text(struct reader *reader, char *text, size_t size) {
  uint64_t length = take_count(reader);
  const uint8_t *bytes = take(reader, length);
  if (!bytes || length >= size)
    return reader->good = false;
  memcpy(text, bytes, (size_t)length);
  text[length] = '\0';
  return true;
}
static void take_mark(struct reader *reader, const char *mark) {
  char text[32];
  if (!take_text(reader, text, sizeof text) || strcmp(text, mark) != 0)
    reader->good = false;
}
static void take_object(struct reader *reader, const struct field_table *table, void *object) {
  uint64_t size = take_count(reader);
  const uint8_t *bytes = take(reader, size);
  if (bytes && (!object || field_decode(table, bytes, (size_t)size, object) != size))
    reader->good = false;
}

static void write_task(struct writer *writer, const struct run_request *request) {
  put_text(writer, TASK_MARK);
  put_text(writer, request->kind->name);
  put_count(writer, request->seed);
  put_text(writer, request->fields_path ? request->fields_path : "");
  put_object(writer, request->kind->inputs, request->inputs);

  const struct mesh_file *files[SCENE_FILES_MOST]; /* another process has not read them */
  const size_t count = scene_files_of(request->kind->inputs, request->inputs, files);
  put_count(writer, count);
  for (size_t i = 0; i < count; i++) {
    put_count(writer, files[i]->size);
    put(writer, files[i]->bytes, files[i]->size);
  }
}

uint8_t *run_encode_task(const struct run_request *request, size_t *size) {
  struct writer writer = {0};
  write_task(&writer, request);
  writer = (struct writer){.bytes = malloc(writer.size)};
  if (writer.bytes)
    write_task(&writer, request);
  *size = writer.size;
  return writer.bytes;
}

static void write_result(struct writer *writer, const struct engine_kind *kind, const struct run_result *result) {
  put_text(writer, RESULT_MARK);
  put_object(writer, &outcome_table, &result->outcome);
  put_object(writer, kind->results, result->result);
  put_count(writer, sizeof(struct fragment));
  put_count(writer, result->fragment_count);
  put(writer, result->fragments, result->fragment_count * sizeof(struct fragment));
  put_count(writer, sizeof(struct estimate));
  put_count(writer, result->estimate_count);
  put(writer, result->estimates, result->estimate_count * sizeof(struct estimate));
  put_text(writer, result->fields_digest);
  put_count(writer, result->unwritten.status);
  put_text(writer, result->unwritten.status != STATUS_OK ? result->unwritten.message : "");
}

static uint8_t *encode_result(const struct engine_kind *kind, const struct run_result *result, size_t *size) {
  struct writer writer = {0};
  write_result(&writer, kind, result);
  writer = (struct writer){.bytes = malloc(writer.size)};
  if (writer.bytes)
    write_result(&writer, kind, result);
  *size = writer.size;
  return writer.bytes;
}

/* Reads how many structs follow. The other process must have the same struct size, and send at most `most`. */
static size_t take_array_count(struct reader *reader, size_t size, size_t most) {
  const uint64_t their_size = take_count(reader), count = take_count(reader);
  if (their_size != size || count > most)
    reader->good = false;
  return reader->good ? (size_t)count : 0;
}

/* False: no memory. */
static bool take_fragments(struct reader *reader, struct run_result *result) {
  const size_t one = sizeof(struct fragment), count = take_array_count(reader, one, reader->left / one);
  const uint8_t *bytes = take(reader, count * one);
  if (!bytes || count == 0)
    return true;
  result->fragments = malloc(count * one);
  if (!result->fragments)
    return false;
  memcpy(result->fragments, bytes, count * one);
  result->fragment_count = count;
  return true;
}

static void take_estimates(struct reader *reader, struct run_result *result) {
  const size_t one = sizeof(struct estimate), count = take_array_count(reader, one, ESTIMATES_COUNT);
  const uint8_t *bytes = take(reader, count * one);
  if (!bytes)
    return;
  memcpy(result->estimates, bytes, count * one);
  result->estimate_count = count;
}

status run_decode_result(const struct engine_kind *kind, const uint8_t *bytes, size_t size, struct run_result *result,
                         struct error *error) {
  struct reader reader = {bytes, size, true};
  *result = (struct run_result){0};
  result->result = calloc(1, kind->results->size);
  if (!result->result)
    return status_fail(error, STATUS_MEMORY, "no memory for a result");
  take_mark(&reader, RESULT_MARK);
  take_object(&reader, &outcome_table, &result->outcome);
  take_object(&reader, kind->results, result->result);
  if (!take_fragments(&reader, result)) {
    run_result_clear(result);
    return status_fail(error, STATUS_MEMORY, "no memory for a result");
  }
  take_estimates(&reader, result);
  take_text(&reader, result->fields_digest, sizeof result->fields_digest);
  result->unwritten.status = (status)take_count(&reader);
  take_text(&reader, result->unwritten.message, sizeof result->unwritten.message);
  if (reader.good && reader.left == 0)
    return STATUS_OK;
  run_result_clear(result);
  return status_fail(error, STATUS_INTERNAL,
                     "a worker's answer cannot be read: it was damaged, or comes from another version of clast");
}

/* Reads the files of the inputs into the list of this process. */
static status take_files(struct reader *reader, struct error *error) {
  for (uint64_t left = take_count(reader); left > 0 && reader->good; left--) {
    const uint64_t size = take_count(reader);
    const uint8_t *bytes = take(reader, size);
    const struct mesh_file *file;
    if (bytes)
      TRY(mesh_files_add("a task's shape file", bytes, (size_t)size, &file, error));
  }
  return STATUS_OK;
}

/* Reads a task; the caller frees the inputs. */
static status decode_task(const uint8_t *task, size_t size, struct run_request *request, void **inputs,
                          char *fields_path, size_t path_size, struct error *error) {
  struct reader reader = {task, size, true};
  char name[64];
  take_mark(&reader, TASK_MARK);
  take_text(&reader, name, sizeof name);
  request->seed = take_count(&reader);
  take_text(&reader, fields_path, path_size);
  if (reader.good) {
    request->kind = engine_find(name, error);
    if (!request->kind)
      return STATUS_INTERNAL;
    *inputs = calloc(1, request->kind->inputs->size);
    if (!*inputs)
      return status_fail(error, STATUS_MEMORY, "no memory for the inputs");
    take_object(&reader, request->kind->inputs, *inputs);
    TRY(take_files(&reader, error));
  }
  if (!reader.good || reader.left)
    return status_fail(error, STATUS_INTERNAL, "the task cannot be read: it comes from another version of clast");
  request->inputs = *inputs;
  request->fields_path = *fields_path ? fields_path : NULL;
  return STATUS_OK;
}

status run_work(const uint8_t *task, size_t task_size, uint8_t **result, size_t *result_size, struct error *error) {
  struct run_request request = {0};
  struct run_result values = {0};
  char fields_path[LIMITS_PATH];
  void *inputs = NULL;
  *result = NULL;
  *result_size = 0;
  status code = decode_task(task, task_size, &request, &inputs, fields_path, sizeof fields_path, error);
  if (code != STATUS_OK)
    goto cleanup;
  if (request.kind->threads)
    farm_allow_memory(threads_stacks(*request.kind->threads(inputs) - 1));
  code = run_simulate(&request, NULL, NULL, 0, &values, error);
  if (code != STATUS_OK && !values.result)
    goto cleanup;
  if (code == STATUS_OK && request.fields_path && values.outcome.state != OUTCOME_INVALID)
    code = store_digest_fields(request.fields_path, values.fields_digest, error);
  if (code != STATUS_OK && error)
    values.unwritten = *error;
  values.unwritten.status = code;
  code = STATUS_OK;
  *result = encode_result(request.kind, &values, result_size);
  if (!*result)
    code = status_fail(error, STATUS_MEMORY, "no memory for the result");
cleanup:
  run_result_clear(&values);
  free(inputs);
  return code;
}
