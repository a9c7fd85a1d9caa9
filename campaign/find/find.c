/* The request of `clast find`, and its rounds as a series of campaigns. */
#include "campaign/find/find.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/accuracy.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

/* ---- places of the bracket ---- */

double find_unit(const struct find *find, const char **shown) {
  struct unit unit;
  const struct field *row = find->input;
  const bool percent = row->flags & FIELD_PERCENT, angle = row->unit && strcmp(row->unit, "rad") == 0;
  *shown = find->axis.unit;
  if (**shown && unit_parse(*shown, &unit, NULL) == STATUS_OK)
    return unit.factor;
  *shown = percent ? "%" : angle ? "deg" : row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
  return percent ? 0.01 : angle ? M_PI / 180 : 1;
}

void find_value(const struct find *find, double x, struct field_value *value) {
  const double low = find->from, high = find->to;
  const double exact = find->logarithmic ? low * pow(high / low, x) : low + (high - low) * x;
  *value = (struct field_value){.kind = find->input->kind};
  if (value->kind == FIELD_INTEGER) {
    value->integer = (int64_t)round(exact);
    return;
  }
  char text[FIND_TEXT];
  const char *unit;
  const double scale = find_unit(find, &unit);
  const double step = pow(10, floor(log10((find->logarithmic ? exact : high - low) / scale)) - 4);
  snprintf(text, sizeof text, "%.12g %s", round(exact / scale / step) * step, unit); /* as a person would write it */
  if (unit_read(text, find->input->unit, &value->number, NULL) != STATUS_OK)
    value->number = exact;
  value->number = x <= 0 ? low : x >= 1 ? high : fmin(fmax(value->number, low), high);
}

double find_place(const struct find *find, const struct field_value *value) {
  const double number = field_number(value);
  return find->logarithmic ? log(number / find->from) / log(find->to / find->from)
                           : (number - find->from) / (find->to - find->from);
}

double find_widest(const struct find *find) {
  struct field_value low, high;
  find_value(find, find->found.low, &low);
  find_value(find, find->found.high, &high);
  const double width = field_number(&high) - field_number(&low), share = find->found.high - find->found.low;
  if (find->input->kind == FIELD_INTEGER && width <= 1)
    return share;
  return find->relative ? find->within : find->within / width * share;
}

/* ---- the request ---- */

/* An axis with one value is part of the scene. */
static bool varies(const struct design_axis *axis) {
  return axis->kind == DESIGN_AXIS_LINKED || axis->level_count != 1;
}

/* The input nearest to a mistyped name: of those that the campaign varies, else of those with an effect in its scene.
 * NULL: none is near. */
static const char *nearest_input(const struct campaign *campaign, const char *name) {
  const struct scene *scene = campaign->scene;
  const struct field_table *inputs = scene->kind->inputs;
  struct text_guess guess = {0};
  for (int all = 0; all <= 1 && !guess.nearest; all++) {
    guess = text_guess(name);
    for (size_t i = 0; i < inputs->count; i++) {
      const struct field *row = &inputs->rows[i];
      const struct design_axis *axis = campaign_axis(campaign, row->path);
      if (all ? field_is_active(inputs, row, scene->inputs) : axis && varies(axis))
        field_guess_path(row->path, &guess);
    }
  }
  return guess.nearest;
}

static status find_input(struct find *find, const char *name, struct error *error) {
  const struct campaign *campaign = find->campaign;
  const struct design_axis *only = NULL;
  size_t count = 0;
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (varies(&campaign->axes[i])) {
      only = &campaign->axes[i];
      count++;
    }
  if (!name && count != 1)
    return status_fail(error, STATUS_USAGE, "the campaign varies %zu inputs: name one with --input", count);
  const struct scene *scene = campaign->scene;
  find->input = name ? field_find_in(scene->kind->inputs, name, scene->inputs, error) : only->row;
  const bool unknown = !find->input && !field_ending(scene->kind->inputs, name, NULL);
  const char *nearest = unknown ? nearest_input(campaign, name) : NULL;
  if (nearest)
    return status_fail(error, STATUS_USAGE, "--input %s: no input has this name; did you mean '%s'?", name, nearest);
  if (!find->input)
    return STATUS_USAGE;
  if (!field_is_number(find->input))
    return status_fail(error, STATUS_USAGE, "--input %s: not a number, so nothing can be between two of its values",
                       find->input->path);
  return STATUS_OK;
}

/* The inputs of `set` in the campaign's scene. */
static status find_set(const struct find *find, const struct option_list *set, const struct field **rows,
                       struct error *error) {
  char path[FIELD_TEXT_SIZE];
  const char *value;
  const struct scene *scene = find->campaign->scene;
  for (size_t i = 0; i < set->count; i++) {
    TRY(campaign_change_split(set->items[i], path, &value, error));
    rows[i] = field_find_in(scene->kind->inputs, path, scene->inputs, error);
    if (!rows[i])
      return STATUS_USAGE;
  }
  return STATUS_OK;
}

static bool is_set(const struct option_list *set, const struct field *const *rows, const struct field *row) {
  size_t i = 0;
  while (i < set->count && rows[i] != row)
    i++;
  return i < set->count;
}

/* The scene of the campaign with `set`. Only the input may have several values. */
static status find_base(struct find *find, const struct option_list *set, struct error *error) {
  const struct campaign *campaign = find->campaign;
  OWNED struct field_value *values = NULL;
  OWNED const struct field **rows = memory_small(set->count + 1, sizeof(const struct field *));
  TRY(memory_array(&values, campaign->axis_count + 1, sizeof *values, "a point", error));
  TRY(find_set(find, set, rows, error));
  for (size_t i = 0; i < campaign->axis_count; i++) {
    const struct design_axis *axis = &campaign->axes[i];
    if (axis->row != find->input && varies(axis) && !is_set(set, rows, axis->row))
      return status_fail(error, STATUS_USAGE,
                         "the campaign varies %s as well as %s, and a crossing is along one input: --set %s=VALUE",
                         axis->row->path, find->input->path, axis->row->path);
    if (axis->level_count)
      values[i] = axis->levels[0];
    else if (axis->kind != DESIGN_AXIS_LINKED)
      design_axis_quantile(axis, 0.5, &values[i]);
  }
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (campaign->axes[i].kind == DESIGN_AXIS_LINKED)
      design_axis_follow(&campaign->axes[i], &values[campaign->axes[i].linked], 0, &values[i]);
  find->base = campaign_point_scene(campaign, values, error);
  return find->base ? option_set_inputs(find->base, set, error) : STATUS_CONTENT;
}

static status read_end(const struct field *row, const char *option, const char *text, double *end,
                       struct error *error) {
  struct field_value value;
  struct error why;
  if (!text)
    return STATUS_OK;
  if (field_parse(row, text, &value, &why) != STATUS_OK)
    return status_fail(error, STATUS_USAGE, "--%s %s: %s", option, text, why.message);
  *end = field_number(&value);
  return STATUS_OK;
}

static status find_bracket(struct find *find, const struct find_request *request, struct error *error) {
  const struct field *row = find->input;
  const struct design_axis *axis = campaign_axis(find->campaign, row->path);
  find->from = find->to = NAN;
  for (size_t i = 0; axis && i < axis->level_count; i++) {
    find->from = fmin(find->from, field_number(&axis->levels[i]));
    find->to = fmax(find->to, field_number(&axis->levels[i]));
  }
  if (axis && (axis->kind == DESIGN_AXIS_UNIFORM || axis->kind == DESIGN_AXIS_LOG_UNIFORM)) {
    find->from = axis->a;
    find->to = axis->b;
  }
  TRY(read_end(row, "from", request->from, &find->from, error));
  TRY(read_end(row, "to", request->to, &find->to, error));
  if (isnan(find->from) || isnan(find->to))
    return status_fail(error, STATUS_USAGE,
                       "the campaign has no range of %s: give --from and --to, its least and "
                       "largest value",
                       row->path);
  if (!(find->from < find->to))
    return status_fail(error, STATUS_USAGE, "--from must be less than --to, in %s", row->path);
  find->logarithmic = find->from > 0 && find->to / find->from >= 20; /* as the axes of charts */
  return STATUS_OK;
}

/* A number above 0 in this unit. */
static status read_above_zero(const char *option, const char *text, const char *unit, double *number,
                              struct error *error) {
  struct error why = {.message = "expected a number above 0"};
  if (unit_read_whole(text, unit, number, &why) != STATUS_OK || !(*number > 0))
    return status_fail(error, STATUS_USAGE, "--%s %s: %s", option, text, why.message);
  return STATUS_OK;
}

struct field find_level_row(const struct find *find) {
  struct field real = *find->quantity.row;
  real.kind = FIELD_REAL;
  real.unit = ask_result_unit(&real, find->base->kind->dimensions);
  return real;
}

static status find_level(struct find *find, const struct find_request *request, struct error *error) {
  const char *name = request->quantity ? request->quantity : find->campaign->quantity;
  struct ask_specimens_quantity *quantity = &find->quantity;
  quantity->kind = ASK_SPECIMENS_RESULT;
  quantity->row = campaign_quantity(find->base->kind, name, &quantity->of_outcome, error);
  if (!quantity->row)
    return STATUS_USAGE;
  if (!request->level)
    return status_fail(error, STATUS_USAGE, "--level is missing: the value of %s that is looked for",
                       quantity->row->path);
  const struct field real = find_level_row(find);
  TRY(read_end(&real, "level", request->level, &find->level, error));
  find->share = NAN;
  if (!request->share)
    return STATUS_OK;
  TRY(read_above_zero("share", request->share, "1", &find->share, error));
  return find->share < 1 ? STATUS_OK
                         : status_fail(error, STATUS_USAGE, "--share %s: expected a share of the runs between 0 and 1",
                                       request->share);
}

static status read_request(const struct find_request *request, const char *path, struct find *find,
                           struct error *error) {
  TRY(campaign_load(path, &find->campaign, error));
  struct campaign *campaign = find->campaign;
  if (request->store)
    snprintf(campaign->store, sizeof campaign->store, "%s", request->store);
  TRY(find_input(find, request->input, error));
  TRY(find_bracket(find, request, error));
  option_words(path, &request->set, request->store, find->words, sizeof find->words);
  if (!launch_other_rank())
    TRY(accuracy_settle(campaign, find->words, campaign->store, request->launch.quiet ? ACCURACY_SILENT : ACCURACY_NOTE,
                        NULL, error));
  TRY(find_base(find, &request->set, error));
  TRY(find_level(find, request, error));
  find->relative = strchr(request->within, '%');
  TRY(read_above_zero("within", request->within, find->relative ? "1" : find->input->unit, &find->within, error));
  driver_list_reference(campaign, path, find->reference, sizeof find->reference);
  find->most = (size_t)request->most_runs;
  find->axis = (struct design_axis){.row = find->input};
  const struct design_axis *axis = campaign_axis(campaign, find->input->path);
  if (axis)
    memcpy(find->axis.unit, axis->unit, sizeof axis->unit);
  find->limits = *campaign;
  find->limits.axes = &find->axis;
  find->limits.axis_count = 1;
  find->limits.independent = true; /* equal seeds would move all places alike, which no place can tell */
  TRY(memory_array(&find->doubtful, find->most, sizeof *find->doubtful, "the runs of a search", error));
  TRY(memory_array(&find->x, find->most, sizeof *find->x, "the runs of a search", error));
  return memory_array(&find->y, find->most, sizeof *find->y, "the runs of a search", error);
}

static void clear(struct find *find) {
  scene_free(find->base);
  campaign_free(find->campaign);
  free(find->x);
  free(find->y);
  free(find->doubtful);
}

/* ---- a round as a campaign ---- */

/* The next round's places, each once: whole numbers and six digits may meet; and its runs at each, fewer in a last
 * round that the rest of the runs cannot fill. None left: 0. */
static void choose_places(struct find *find) {
  double next[CROSSING_FIRST];
  size_t count = CROSSING_FIRST;
  for (size_t i = 0; i < count; i++)
    next[i] = (double)i / (CROSSING_FIRST - 1);
  find->each = CROSSING_RUNS;
  if (find->runs > 0) {
    count = CROSSING_PLACES;
    find->each = crossing_next(&find->found, find->runs, next);
  }
  find->places = 0;
  for (size_t i = 0; i < count; i++) {
    struct field_value *value = &find->place[find->places];
    find_value(find, next[i], value);
    find->places += find->places == 0 || field_number(value) != field_number(value - 1);
  }
  const size_t rest = (find->most - find->runs) / find->places;
  find->each = find->each < rest ? find->each : rest;
}

void find_name(const struct find *find, char *name, size_t size) {
  snprintf(name, size, "%.120s find %.120s", find->campaign->name, find->input->path);
}

static status make_campaign(const struct find *find, struct campaign **out, struct error *error) {
  TRY(driver_list_begin(&find->limits, find->base, 1, find->places, out, error));
  struct campaign *campaign = *out;
  campaign->axes[0].row = find->input;
  memcpy(campaign->axes[0].unit, find->axis.unit, sizeof find->axis.unit);
  memcpy(campaign->axes[0].levels, find->place, find->places * sizeof *find->place);
  campaign->per_point = (int64_t)find->each;
  campaign->first_seed += (int64_t)find->runs; /* a place that comes again has new seeds */
  find_name(find, campaign->name, sizeof campaign->name);
  return driver_list_end(campaign, find->reference, "Written by clast find: a round of its runs.", error);
}

static status next_round(void *context, const struct scheduler *scheduler, struct campaign **campaign,
                         struct error *error) {
  (void)scheduler;
  struct find *find = context;
  if (find->answered)
    return STATUS_OK;
  choose_places(find);
  find->answered = find->each == 0;
  return find->answered ? STATUS_OK : make_campaign(find, campaign, error);
}

/* Adds the runs of a place of this round. */
static status read_place(struct find *find, struct store *store, const struct field_value *place, struct error *error) {
  struct campaign round = find->limits;
  struct error invalid = {0};
  int64_t point = 0;
  SCENE scene = campaign_point_scene_from(find->base, &find->limits, place, &invalid);
  round.first_seed += (int64_t)find->runs;
  if (scene)
    TRY(store_point_find(store, scene, &point, error));
  double *y = find->y + find->runs + (size_t)(place - find->place) * find->each;
  double *x = find->x + (y - find->y), value;
  for (size_t r = 0; r < find->each; r++) {
    x[r] = find_place(find, place);
    y[r] = NAN;
  }
  if (!point)
    return STATUS_OK;
  uint64_t seed;
  struct ask_doubts doubts = {0};
  ANSWER runs = ask_specimens(store, point, scene->kind, &find->quantity, error);
  for (; ask_specimens_next(&runs, &find->quantity, &seed, &value, &doubts); doubts = (struct ask_doubts){0})
    for (size_t r = 0; r < find->each; r++)
      if (campaign_seed(&round, scene, (int64_t)r) == seed) {
        y[r] = value;
        find->doubtful[y + r - find->y] = doubts.doubtful > 0;
        ask_doubts_add(&find->doubts, &doubts);
      }
  return answer_end(&runs);
}

static void tell(const struct find *find) {
  char low[FIND_TEXT], high[FIND_TEXT], text[3 * FIND_TEXT];
  snprintf(text, sizeof text, "%zu runs", find->runs);
  const bool none = find->found.kind == CROSSING_ABOVE || find->found.kind == CROSSING_BELOW;
  if (!none && find->found.low < find->found.high)
    snprintf(text, sizeof text, "%zu runs: between %s and %s", find->runs,
             find_show_within(find, find->found.low, find->found.low, find->found.high, low),
             find_show_within(find, find->found.high, find->found.low, find->found.high, high));
  find->note(find->note_context, text);
}

static status add_round(struct find *find, struct store *store, struct error *error) {
  for (size_t i = 0; i < find->places; i++)
    TRY(read_place(find, store, &find->place[i], error));
  find->runs += find->places * find->each;
  const struct crossing_data data = {.n = find->runs,
                                     .x = find->x,
                                     .y = find->y,
                                     .level = find->level,
                                     .share = find->share};
  const status code = crossing_find(&data, &find->found, error);
  if (code != STATUS_OK) {
    uncertainty_doubts(&find->doubts, stderr); /* why runs have no result */
    return code;
  }
  find->failed = find->runs - find->found.n;
  const struct crossing *found = &find->found; /* widths at runs that grow by a factor are enough */
  const bool grown = find->widths == 0 || 5 * find->runs >= 7 * find->width[find->widths - 1].runs;
  if (found->kind == CROSSING_FOUND && grown && find->widths < FIND_WIDTHS)
    find->width[find->widths++] = (struct find_width){find->runs, found->high - found->low};
  find->answered = find->narrow = crossing_is_answer(&find->found, find_widest(find));
  return STATUS_OK;
}

static status end_round(void *context, const struct scheduler *scheduler, struct error *error) {
  struct find *find = context;
  TRY(add_round(find, scheduler->store, error));
  tell(find);
  return STATUS_OK;
}

/* ---- from the document to the answer ---- */

static status run_rounds(struct find *find, const struct find_request *request, const struct command_line *line,
                         struct error *error) {
  LAUNCH launch = {0};
  TRY(launch_begin(&launch, &find->limits, &request->launch, line, error));
  const struct series series = {.context = find, .limits = &find->limits, .next = next_round, .done = end_round};
  find->note = launch_note;
  find->note_context = &launch.notes;
  if (launch.manager && !launch.notes.quiet)
    fprintf(
        stderr,
        "clast: at most %zu runs, %d at first; `clast plan` tells what a run costs. They are campaigns of their own "
        "in %s; questions leave out points that only these campaigns have\n",
        find->most, FIND_FEWEST_RUNS, find->limits.store);
  const status code = launch_series(&launch, &series, true, error);
  if (!launch.manager || code != STATUS_OK)
    return code;
  TRY(find_print(find, line->format, launch.notes.quiet, error));
  return request->picture ? find_print_picture(find, request->picture, &request->chart, error) : STATUS_OK;
}

status find_launch(const struct find_request *request, const struct command_line *line, struct error *error) {
  OWNED struct find *find = memory_small(1, sizeof *find);
  status code = read_request(request, line->arguments[0], find, error);
  if (code == STATUS_OK)
    code = engine_ready(find->base->kind, find->base->inputs, error);
  if (code == STATUS_OK)
    code = run_rounds(find, request, line, error);
  clear(find);
  return code;
}
