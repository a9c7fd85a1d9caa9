/* Checks that a campaign can be served, and makes scenes from vectors of numbers. */
#include "campaign/serve/serve.h"
#include "schemas/memory.h"

#include <stdlib.h>
#include <string.h>

#include <jansson.h>

static status take_inputs(struct serve_model *model, struct error *error) {
  const struct campaign *campaign = model->campaign;
  if (campaign->axis_count == 0)
    return status_fail(error, STATUS_CONTENT,
                       "the campaign varies nothing, so a server would have no inputs; give `vary`");
  model->inputs = memory_small(campaign->axis_count, sizeof *model->inputs);
  for (size_t i = 0; i < campaign->axis_count; i++) {
    const struct design_axis *axis = &campaign->axes[i];
    if (!field_is_number(axis->row))
      return status_fail(error, STATUS_CONTENT, "vary.%s: inputs of a server are numbers; put this one into `set`",
                         axis->row->path);
    if (axis->kind == DESIGN_AXIS_LINKED && axis->level_count)
      return status_fail(error, STATUS_CONTENT,
                         "vary.%s: an input of a server cannot be linked by `values`; link it by `factor`",
                         axis->row->path);
    if (axis->kind != DESIGN_AXIS_LINKED)
      model->inputs[model->input_count++] = i;
  }
  return STATUS_OK;
}

status serve_model_result(const struct serve_model *model, const char *name, struct serve_result *result,
                          struct error *error) {
  result->row = campaign_quantity(model->campaign->scene->kind, name, &result->of_outcome, error);
  return result->row ? STATUS_OK : STATUS_USAGE;
}

static status take_results(struct serve_model *model, const char *names, struct error *error) {
  char name[FIELD_TEXT_SIZE];
  while (*names) {
    names = text_next_item(names, name, sizeof name);
    if (model->result_count == SERVE_MODEL_RESULTS)
      return status_fail(error, STATUS_USAGE, "--quantity: more than %d results", SERVE_MODEL_RESULTS);
    TRY(serve_model_result(model, name, &model->results[model->result_count], error));
    model->result_count++;
  }
  return model->result_count ? STATUS_OK : status_fail(error, STATUS_USAGE, "--quantity names no result");
}

status serve_model_make(const struct campaign *campaign, const char *results, struct serve_model *model,
                        struct error *error) {
  *model = (struct serve_model){.campaign = campaign};
  TRY(take_inputs(model, error));
  return take_results(model, results ? results : campaign->quantity, error);
}

void serve_model_clear(struct serve_model *model) {
  free(model->inputs);
  *model = (struct serve_model){0};
}

struct scene *serve_model_scene(const struct serve_model *model, const double *inputs, struct error *error) {
  const struct campaign *campaign = model->campaign;
  OWNED struct field_value *values = NULL;
  if (memory_array(&values, campaign->axis_count, sizeof *values, "a point", error))
    return NULL;
  for (size_t i = 0; i < model->input_count; i++) {
    const struct field_value given = {.kind = FIELD_REAL, .number = inputs[i]};
    if (field_set_value(campaign->axes[model->inputs[i]].row, &given, &values[model->inputs[i]], error))
      return NULL;
  }
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (campaign->axes[i].kind == DESIGN_AXIS_LINKED)
      design_axis_follow(&campaign->axes[i], &values[campaign->axes[i].linked], 0, &values[i]);
  return campaign_point_scene(campaign, values, error);
}

static json_t *describe_row(const struct field *row, int dimensions) {
  const char *unit = row->unit ? ask_result_unit(row, dimensions) : "1";
  return json_pack("{s:s, s:s, s:s}", "name", row->path, "unit", unit, "meaning", row->doc);
}

char *serve_model_describe(const struct serve_model *model) {
  json_t *inputs = json_array(), *results = json_array();
  for (size_t i = 0; i < model->input_count; i++)
    json_array_append_new(inputs, describe_row(model->campaign->axes[model->inputs[i]].row, 3));
  for (size_t i = 0; i < model->result_count; i++)
    json_array_append_new(results, describe_row(model->results[i].row, model->campaign->scene->kind->dimensions));
  json_auto_t *whole = json_pack("{s:s, s:s, s:o, s:o}", "model", model->campaign->name, "scene",
                                 model->campaign->scene->name, "inputs", inputs, "results", results);
  return whole ? json_dumps(whole, JSON_INDENT(1)) : NULL;
}
