/* Reads requests of the protocol with jansson, and writes its answers. */
#include "campaign/serve/serve.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/terminal/table.h"
#include "schemas/memory.h"

static const char *const statistic_names[SERVE_STATISTICS] = {"mean", "sd", "se", "hw95"};

void serve_request_clear(struct serve_request *request) {
  free(request->inputs);
  *request = (struct serve_request){0};
}

/* Takes `value`. */
static struct serve_answer answer_json(unsigned http, json_t *value) {
  struct serve_answer answer = {http, value ? json_dumps(value, JSON_REAL_PRECISION(17) | JSON_COMPACT) : NULL};
  json_decref(value);
  return answer;
}

struct serve_answer serve_request_error(unsigned http, const char *type, const char *format, ...) {
  char message[2048];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  json_t *text = json_string(message);
  if (!text) /* not UTF-8 */
    text = json_string("the request has bytes that are not UTF-8");
  return answer_json(http, json_pack("{s:{s:s, s:o}}", "error", "type", type, "message", text));
}

/* ---- config ---- */

/* The request has this answer and is no evaluation: false, for the caller to return. */
static bool answered(struct serve_answer *answer, struct serve_answer given) {
  *answer = given;
  return false;
}

static bool refuse(struct serve_answer *answer, const char *message) {
  return answered(answer, serve_request_error(400, "InvalidInput", "%s", message));
}

static bool read_results(const struct serve_model *model, json_t *value, struct serve_config *config,
                         struct serve_answer *answer) {
  struct error error = {0};
  json_t *item;
  size_t i;
  if (!json_is_array(value) || json_array_size(value) == 0 || json_array_size(value) > SERVE_MODEL_RESULTS)
    return refuse(answer, "config.results: expected a list of names of results");
  config->result_count = 0;
  json_array_foreach(value, i, item) {
    const char *name = json_string_value(item);
    if (!name)
      return refuse(answer, "config.results: expected names");
    if (serve_model_result(model, name, &config->results[config->result_count++], &error) != STATUS_OK)
      return refuse(answer, error.message);
  }
  return true;
}

static bool read_statistic(json_t *value, struct serve_config *config, struct serve_answer *answer) {
  const char *name = json_string_value(value);
  for (enum serve_statistic s = SERVE_MEAN; name && s < SERVE_STATISTICS; s++)
    if (strcmp(name, statistic_names[s]) == 0 && config->statistic_count < SERVE_STATISTICS) {
      config->statistics[config->statistic_count++] = s;
      return true;
    }
  return refuse(answer, "config.statistic: expected mean, sd, se or hw95, or a list of them, each once");
}

static bool read_statistics(json_t *value, struct serve_config *config, struct serve_answer *answer) {
  json_t *item;
  size_t i;
  config->statistic_count = 0;
  if (!json_is_array(value))
    return read_statistic(value, config, answer);
  json_array_foreach(value, i, item) if (!read_statistic(item, config, answer)) return false;
  return config->statistic_count > 0 || refuse(answer, "config.statistic: the list is empty");
}

/* A whole number from `least` to `most`. */
static bool read_count(const char *name, json_t *value, int64_t least, int64_t most, int64_t *count,
                       struct serve_answer *answer) {
  const double number = json_is_number(value) ? json_number_value(value) : (double)NAN;
  if (!(number >= (double)least && number <= (double)most) || number != floor(number))
    return answered(answer, serve_request_error(400, "InvalidInput",
                                                "config.%s: expected a whole number from %" PRId64 " to %" PRId64, name,
                                                least, most));
  *count = (int64_t)number;
  return true;
}

static bool read_key(const struct serve_model *model, const char *key, json_t *value, struct serve_config *config,
                     struct serve_answer *answer) {
  if (strcmp(key, "results") == 0)
    return read_results(model, value, config, answer);
  if (strcmp(key, "statistic") == 0)
    return read_statistics(value, config, answer);
  if (strcmp(key, "replicates") == 0)
    return read_count(key, value, 1, SERVE_REQUEST_REPLICATES, &config->count, answer);
  if (strcmp(key, "replicate") == 0) {
    config->single = true;
    return read_count(key, value, 0, INT64_C(1) << 40, &config->first, answer);
  }
  return answered(answer,
                  serve_request_error(400, "InvalidInput",
                                      "config.%s: unknown; known are results, statistic, replicates, replicate", key));
}

/* Checks statistic and replicates: a single replicate has no statistic, and a scatter needs two replicates. */
static bool check_config(const struct serve_config *config, json_t *given, struct serve_answer *answer) {
  if (config->single && json_object_get(given, "replicates"))
    return refuse(answer, "config: replicate (one seed) and replicates (how many) exclude each other");
  if (config->single && json_object_get(given, "statistic"))
    return refuse(answer, "config: one replicate has no statistic");
  if (config->single || config->count >= 2)
    return true;
  for (size_t i = 0; i < config->statistic_count; i++)
    if (config->statistics[i] != SERVE_MEAN)
      return refuse(answer, "config.statistic: a scatter needs two replicates at least");
  return true;
}

static bool read_config(const struct serve_model *model, json_t *root, struct serve_config *config,
                        struct serve_answer *answer) {
  json_t *given = json_object_get(root, "config"), *value;
  const char *key;
  *config = (struct serve_config){.result_count = model->result_count,
                                  .statistic_count = 1,
                                  .count = campaign_replicates_least(model->campaign)};
  memcpy(config->results, model->results, sizeof config->results);
  if (given && !json_is_object(given) && !json_is_null(given))
    return refuse(answer, "config: expected an object");
  json_object_foreach(given, key, value) if (!read_key(model, key, value, config, answer)) return false;
  if (!check_config(config, given, answer))
    return false;
  if (config->single)
    config->count = 1;
  return true;
}

/* ---- the requests ---- */

static bool read_inputs(const struct serve_model *model, json_t *root, struct serve_request *request,
                        struct serve_answer *answer) {
  json_t *outer = json_object_get(root, "input"), *inner = json_array_get(outer, 0), *value;
  size_t i;
  if (!json_is_array(outer) || json_array_size(outer) != 1 || !json_is_array(inner) ||
      json_array_size(inner) != model->input_count)
    return answered(answer,
                    serve_request_error(400, "InvalidInput", "input: expected one vector of %zu numbers in a list",
                                        model->input_count));
  request->inputs = calloc(model->input_count, sizeof *request->inputs);
  if (!request->inputs)
    return answered(answer, serve_request_error(503, "Unavailable", "out of memory"));
  json_array_foreach(inner, i, value) {
    if (!json_is_number(value))
      return refuse(answer, "input: expected numbers");
    request->inputs[i] = json_number_value(value);
  }
  return true;
}

enum call {
  CALL_INFO,
  CALL_DESCRIBE,
  CALL_MODEL_INFO,
  CALL_INPUT_SIZES,
  CALL_OUTPUT_SIZES,
  CALL_EVALUATE,
  CALL_UNSUPPORTED
};
static const struct route {
  const char *path;
  bool get;
  enum call call;
} routes[] = {
    {"/", true, CALL_DESCRIBE},
    {"/Info", true, CALL_INFO},
    {"/ModelInfo", false, CALL_MODEL_INFO},
    {"/InputSizes", false, CALL_INPUT_SIZES},
    {"/OutputSizes", false, CALL_OUTPUT_SIZES},
    {"/Evaluate", false, CALL_EVALUATE},
    {"/Gradient", false, CALL_UNSUPPORTED},
    {"/ApplyJacobian", false, CALL_UNSUPPORTED},
    {"/ApplyHessian", false, CALL_UNSUPPORTED},
};

/* A request with a body that is a JSON object and names the model. */
static bool read_call(const struct serve_model *model, const struct route *route, json_t *root,
                      struct serve_request *request, struct serve_answer *answer) {
  const char *name = json_string_value(json_object_get(root, "name"));
  if (!json_is_object(root) || !name)
    return refuse(answer, "expected a JSON object with the model's name: {\"name\": ...}");
  if (strcmp(name, model->campaign->name) != 0)
    return answered(answer,
                    serve_request_error(400, "ModelNotFound", "there is no model \"%.100s\"; this server has \"%s\"",
                                        name, model->campaign->name));
  if (route->call == CALL_UNSUPPORTED)
    return answered(answer,
                    serve_request_error(400, "UnsupportedFeature",
                                        "%s: runs have no derivatives; this model supports Evaluate", route->path + 1));
  if (route->call == CALL_MODEL_INFO)
    return answered(answer, answer_json(200, json_pack("{s:{s:b, s:b, s:b, s:b}}", "support", "Evaluate", 1, "Gradient",
                                                       0, "ApplyJacobian", 0, "ApplyHessian", 0)));
  if (!read_config(model, root, &request->config, answer))
    return false;
  if (route->call == CALL_EVALUATE)
    return read_inputs(model, root, request, answer);
  if (route->call == CALL_INPUT_SIZES)
    return answered(answer, answer_json(200, json_pack("{s:[I]}", "inputSizes", (json_int_t)model->input_count)));
  json_t *sizes = json_array();
  for (size_t i = 0; i < (request->config.single ? 1 : request->config.statistic_count); i++)
    json_array_append_new(sizes, json_integer((json_int_t)request->config.result_count));
  return answered(answer, answer_json(200, json_pack("{s:o}", "outputSizes", sizes)));
}

bool serve_request_read(const struct serve_model *model, const char *method, const char *path, const char *body,
                        size_t size, struct serve_request *request, struct serve_answer *answer) {
  const struct route *route = NULL;
  for (size_t i = 0; !route && i < sizeof routes / sizeof routes[0]; i++)
    route = strcmp(path, routes[i].path) == 0 ? &routes[i] : NULL;
  *request = (struct serve_request){0};
  if (!route)
    return answered(answer, serve_request_error(404, "UnsupportedFeature", "there is no %.100s; see GET /", path));
  const bool right = route->get ? strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0
                                : strcmp(method, "POST") == 0;
  if (!right)
    return answered(answer, serve_request_error(405, "InvalidInput", "%s: expected the method %s", path,
                                                route->get ? "GET" : "POST"));
  if (route->call == CALL_DESCRIBE)
    return answered(answer, (struct serve_answer){200, serve_model_describe(model)});
  if (route->call == CALL_INFO)
    return answered(answer, answer_json(200, json_pack("{s:f, s:[s]}", "protocolVersion", 1.0, "models",
                                                       model->campaign->name)));

  json_error_t where;
  json_auto_t *root = json_loadb(body, size, JSON_REJECT_DUPLICATES, &where);
  if (!root)
    return answered(answer, serve_request_error(400, "InvalidInput", "the body is no JSON: line %d: %s", where.line,
                                                where.text));
  const bool evaluate = read_call(model, route, root, request, answer);
  if (!evaluate)
    serve_request_clear(request);
  return evaluate;
}

/* ---- the output ---- */

static double statistic_of(const struct sample_summary *summary, enum serve_statistic statistic) {
  switch (statistic) {
  case SERVE_MEAN: return summary->mean;
  case SERVE_SD: return summary->standard_deviation;
  case SERVE_SE: return summary->standard_error;
  case SERVE_HW95: /* equal shares have a bound only */
    return isnan(summary->half_width) ? fmax(summary->high - summary->mean, summary->mean - summary->low)
                                      : summary->half_width;
  case SERVE_STATISTICS: break;
  }
  return NAN;
}

/* The sentences of conditions that runs behind a number break, a line each; the caller frees them. NULL: no memory. */
static char *sentences_of(const struct ask_doubts *doubts) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  uncertainty_doubts(doubts, out);
  return fclose(out) ? NULL : text;
}

struct serve_answer serve_request_answer(const struct serve_request *request, const double *values,
                                         const struct ask_doubts *doubts) {
  const struct serve_config *config = &request->config;
  const size_t count = (size_t)config->count, vectors = config->single ? 1 : config->statistic_count;
  json_t *output = json_array();
  for (size_t v = 0; v < vectors; v++) {
    json_t *vector = json_array();
    json_array_append_new(output, vector);
    for (size_t k = 0; k < config->result_count; k++) {
      struct sample_summary summary = sample_summarise(count, values + k * count, 0.95);
      const struct sample_range range = sample_range(config->results[k].row);
      sample_in_range(&summary, &range, 0.95);
      const double number = config->single ? values[k] : statistic_of(&summary, config->statistics[v]);
      if (!isfinite(number)) { /* JSON has no NaN and no infinity */
        OWNED char *sentences = sentences_of(&doubts[k]);
        const char *told = sentences ? sentences : "";
        json_decref(output);
        return serve_request_error(500, "InvalidOutput",
                                   "%s has no value here: %zu of %zu runs have one (see `clast query STORE --named "
                                   "failures`, and column state of the view runs)%s%s",
                                   config->results[k].row->path, summary.n, count, *told ? "; " : "", told);
      }
      json_array_append_new(vector, json_real(number));
    }
  }
  json_t *told = json_array();
  bool sound = true;
  for (size_t k = 0; k < config->result_count; k++) {
    OWNED char *sentences = sentences_of(&doubts[k]);
    json_array_append_new(told, json_string(sentences ? sentences : ""));
    sound = sound && doubts[k].doubtful == 0;
  }
  json_t *whole = json_pack("{s:o}", "output", output);
  if (sound)
    json_decref(told);
  else
    json_object_set_new(whole, "doubts", told);
  return answer_json(200, whole);
}
