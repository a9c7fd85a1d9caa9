/* Reads the studies of a campaign's points from the store, and takes the one that decides. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "campaign/converge/accuracy_finding.h"
#include "engine/grow.h"

const struct knob *accuracy_knob(const struct campaign *campaign, const char *name) {
  return engine_knob(campaign->scene->kind, name, NULL);
}

const struct convergence_row *accuracy_rows(const struct accuracy_finding *finding, int64_t point, size_t *count) {
  size_t from = 0;
  while (from < finding->row_count && finding->rows[from].base_point != point)
    from++;
  *count = 0;
  while (from + *count < finding->row_count && finding->rows[from + *count].base_point == point)
    ++*count;
  return finding->rows + from;
}

double accuracy_work(const struct scene *scene) {
  return scene->kind->work ? scene->kind->work(scene->inputs) : 1;
}

static status out_of_memory(struct error *error) {
  return status_fail(error, STATUS_MEMORY, "no memory for the studies of a campaign");
}

static status read_rows(struct accuracy_finding *finding, struct error *error) {
  ANSWER levels = ask_convergence_levels(finding->store, 0, finding->campaign->scene->kind->results_version,
                                         finding->quantity.column, true, error);
  for (struct convergence_row row; ask_convergence_next(&levels, &row);) {
    if (!grow_room(&finding->rows, &finding->row_room, finding->row_count + 1, sizeof row))
      return out_of_memory(error);
    finding->rows[finding->row_count++] = row;
  }
  return answer_end(&levels);
}

/* The points of the campaign, and what a run of each takes by its study or its runs. */
static status read_places(struct accuracy_finding *finding, struct error *error) {
  CAMPAIGN_WALK walk = {0};
  size_t count;
  TRY(campaign_walk_begin(&walk, finding->campaign, error));
  for (int i = 0; i < ACCURACY_POINTS && campaign_walk_next(&walk); i++) {
    struct error ignored;
    SCENE scene = campaign_walk_scene(&walk, &ignored);
    if (!grow_room(&finding->places, &finding->place_room, finding->place_count + 1, sizeof *finding->places))
      return out_of_memory(error);
    struct accuracy_place *place = &finding->places[finding->place_count++];
    *place = (struct accuracy_place){.work = scene ? accuracy_work(scene) : (double)NAN, .own_s = NAN};
    if (scene)
      TRY(store_point_find(finding->store, scene, &place->point, error));
    place->scene = scene;
    scene = NULL;
  }
  finding->accuracy->point_s = finding->campaign->accuracy_time / (double)design_points(walk.design);
  ANSWER runs = ask_run_costs(finding->store, finding->campaign->scene->kind->results_version, error);
  while (answer_next(&runs))
    for (size_t i = 0; i < finding->place_count; i++)
      if (finding->places[i].point == answer_integer(&runs, 0))
        finding->places[i].own_s = answer_real(&runs, 1);
  for (size_t i = 0; i < finding->place_count; i++) {
    const struct convergence_row *rows = accuracy_rows(finding, finding->places[i].point, &count);
    for (size_t r = 0; finding->places[i].point && r < count; r++)
      if (rows[r].base && rows[r].cpu > 0)
        finding->places[i].own_s = rows[r].cpu;
  }
  return answer_end(&runs);
}

/* The parts of the scene that was studied and of its levels. */
static status read_parts(struct accuracy_finding *finding, struct error *error) {
  ANSWER parts = ask_parts(finding->store, finding->point, finding->scene->kind->results_version,
                           finding->quantity.column, error);
  finding->part_count = 0;
  for (struct ask_part part; ask_parts_next(&parts, &part);) {
    if (!grow_room(&finding->parts, &finding->part_room, finding->part_count + 1, sizeof *finding->parts))
      return out_of_memory(error);
    finding->parts[finding->part_count++] = (struct accuracy_row_part){.part = part,
                                                                       .knob = accuracy_knob(finding->campaign,
                                                                                             part.knob),
                                                                       .finest = strtod(part.finest, NULL)};
  }
  return answer_end(&parts);
}

/* Makes the options of the study of a scene. */
static status take_study(struct accuracy_finding *finding, const struct scene *scene, int64_t point,
                         struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  free(accuracy->options);
  *accuracy = (struct accuracy){.path = accuracy->path, .point_s = accuracy->point_s};
  finding->scene = scene;
  finding->point = point;
  TRY(read_parts(finding, error));
  return accuracy_choose_options(finding, error);
}

/* How far a study is from what is wanted: the one that needs most decides, of equal ones that with the larger error. */
static double need_of(const struct accuracy *accuracy, double *error) {
  const bool none = accuracy->chosen == accuracy->count;
  const struct accuracy_option *option = &accuracy->options[none ? accuracy->reference : accuracy->chosen];
  *error = accuracy->count ? accuracy_resolution(option) : -1;
  if (accuracy->count == 0)
    return -1;
  if (!isnan(accuracy->point_s))
    return none ? HUGE_VAL : option->total;
  return none ? 1e200 * *error / option->within : option->cpu_s;
}

/* Takes of the studies of the campaign's scene and of its points the one that needs most, and names its point. */
static status read_studies(struct accuracy_finding *finding, struct error *error) {
  const struct campaign *campaign = finding->campaign;
  struct accuracy *accuracy = finding->accuracy;
  const struct accuracy_place *widest = NULL;
  struct accuracy_place own = {.scene = campaign->scene};
  double most = -1, largest = -1, error_there;
  size_t count, studied = 0;
  TRY(store_point_find(finding->store, campaign->scene, &own.point, error));
  for (size_t i = 0; i < finding->place_count; i++)
    if (finding->places[i].point == own.point)
      own.scene = NULL; /* it is one of the points */
  for (size_t i = 0; i <= finding->place_count; i++) {
    const struct accuracy_place *place = i == 0 ? &own : &finding->places[i - 1];
    accuracy_rows(finding, place->point, &count);
    if (!place->scene || !place->point || count == 0)
      continue;
    TRY(take_study(finding, place->scene, place->point, error));
    studied += place != &own;
    const double need = need_of(accuracy, &error_there);
    if (convergence_order(need, error_there, most, largest) <= 0)
      continue;
    most = need;
    largest = error_there;
    widest = place;
  }
  if (!widest)
    return STATUS_OK;
  TRY(take_study(finding, widest->scene, widest->point, error));
  char inputs[256];
  if (widest == &own && finding->place_count > 1)
    snprintf(accuracy->place, sizeof accuracy->place, "the scene with its own values of what varies");
  else if (finding->place_count > 1)
    snprintf(accuracy->place, sizeof accuracy->place, "point %zu, %s", (size_t)(widest - finding->places) + 1,
             design_axis_show_point(campaign->axis_count, campaign->axes, widest->scene->inputs, inputs,
                                    sizeof inputs));
  accuracy->some_studied = studied < finding->place_count;
  return accuracy_learn(finding, error);
}

/* Names the studied point at which the chosen setting is farthest from the accuracy, if one misses it. */
static void name_widest(const struct accuracy_finding *finding) {
  const struct campaign *campaign = finding->campaign;
  struct accuracy *accuracy = finding->accuracy;
  const struct accuracy_option *chosen = &accuracy->options[accuracy->chosen];
  double most = 1;
  for (size_t i = 0; accuracy->chosen < accuracy->count && i < finding->place_count; i++) {
    const struct accuracy_place *place = &finding->places[i];
    size_t count;
    const struct convergence_row *rows = accuracy_rows(finding, place->point, &count);
    for (size_t r = 0; place->point && place->point != finding->point && r < count; r++) {
      const bool is = chosen->own
                          ? rows[r].base
                          : strcmp(rows[r].knob, chosen->knob) == 0 && strcmp(rows[r].setting, chosen->setting) == 0;
      const double within = accuracy_allowed(campaign, rows[r].mean);
      const double need = rows[r].error / (isnan(within) ? chosen->error : within);
      char inputs[256], told[UNCERTAINTY_TEXT], unit[CAMPAIGN_UNIT];
      if (!is || rows[r].n == 0 || !(need > most))
        continue;
      most = need;
      snprintf(accuracy->widest_point, sizeof accuracy->widest_point,
               "point %zu, %s, was studied, too, and its error is larger: %s%s with the mean %.3g", i + 1,
               design_axis_show_point(campaign->axis_count, campaign->axes, place->scene->inputs, inputs,
                                      sizeof inputs),
               study_show_error(rows[r].error, rows[r].at_least, told),
               campaign_unit(campaign, campaign->accuracy_quantity, unit), rows[r].mean);
    }
  }
}

/* There is no study that starts from the settings of this campaign. They may be a level of another one. */
static status no_study(const struct accuracy_finding *finding, const char *store, struct error *error) {
  const char *quantity = finding->campaign->accuracy_quantity, *path = finding->accuracy->path;
  char level[300] = "";
  for (size_t i = 0; !finding->quantity.row && i < finding->place_count; i++)
    if (finding->places[i].own_s > 0)
      return status_fail(error, STATUS_CONTENT,
                         "accuracy: %s has runs of this campaign and no %s with a setting of theirs: too few fragments "
                         "break off. Take another quantity, or make a study with more seeds: `clast converge %s "
                         "--quantity %s --seeds 32`",
                         store, quantity, path, quantity);
  for (size_t r = 0; r < finding->row_count && !*level; r++)
    for (size_t i = 0; i < finding->place_count && !*level; i++)
      if (finding->places[i].point && finding->rows[r].point == finding->places[i].point)
        snprintf(level, sizeof level, ". They are the level %.64s = %.64s of one that starts from other settings",
                 finding->rows[r].knob, finding->rows[r].setting);
  return status_fail(error, STATUS_CONTENT,
                     "accuracy: %s%s has no study of %s %s%s. Make it: `clast converge %s --quantity %s`", store,
                     access(store, F_OK) == 0 ? "" : " does not exist yet, so it", quantity,
                     *level ? "that starts from the settings of this campaign" : "for this campaign", level, path,
                     quantity);
}

/* No setting has a result. Where runs at the scene's own settings are withheld, a study would be, too: says why. */
static status no_result(const struct accuracy_finding *finding, const char *store, struct error *error) {
  struct ask_doubts doubts = {0};
  char why[1200] = "";
  const char *quantity = finding->campaign->accuracy_quantity, *path = finding->accuracy->path;
  for (size_t i = 0; i < finding->place_count; i++)
    if (finding->places[i].point)
      TRY(ask_doubts(finding->store, &(struct ask_doubts_choice){.point = finding->places[i].point}, finding->results,
                     &doubts, error));
  if (doubts.withheld == 0)
    return no_study(finding, store, error);
  for (size_t k = 0; k < doubts.count; k++) {
    const struct condition *row = doubts.word[k].row;
    if (row && row->withheld)
      text_append(why, sizeof why, ". %s: %s (`clast explain %s`)", row->word, row->remedy ? row->remedy : row->doubt,
                  row->word);
  }
  return status_fail(error, STATUS_CONTENT,
                     "accuracy: %s has no %s for this campaign: with its own settings, %lld of %lld runs are "
                     "withheld%s. Then study it: `clast converge %s --quantity %s`",
                     store, quantity, (long long)doubts.withheld, (long long)doubts.runs, why, path, quantity);
}

void accuracy_clear(struct accuracy *accuracy) {
  free(accuracy->options);
  *accuracy = (struct accuracy){0};
}

static void release(struct accuracy_finding *finding) {
  for (size_t i = 0; i < finding->place_count; i++)
    scene_free(finding->places[i].scene);
  free(finding->places);
  free(finding->rows);
  free(finding->parts);
}

status accuracy_find(const struct campaign *campaign, const char *path, const char *store_path,
                     struct accuracy *accuracy, struct error *error) {
  __attribute__((cleanup(release))) struct accuracy_finding finding = {.campaign = campaign, .accuracy = accuracy};
  STORE store = NULL;
  *accuracy = (struct accuracy){.path = path, .point_s = NAN};
  const status code = store_open_reader(store_path, &store, error);
  if (code == STATUS_MISSING)
    return no_study(&finding, store_path, error);
  TRY(code);
  finding.store = store;
  if (study_quantity_find(campaign->scene->kind, campaign->accuracy_quantity, &finding.quantity, error) != STATUS_OK)
    return STATUS_CONTENT;
  TRY(ask_doubts_results(store, finding.quantity.column, finding.results, error));
  TRY(read_rows(&finding, error));
  TRY(read_places(&finding, error));
  TRY(read_studies(&finding, error));
  if (accuracy->count == 0)
    return no_result(&finding, store_path, error);
  if (accuracy->chosen == accuracy->count && isnan(accuracy->point_s))
    accuracy_advise(&finding);
  name_widest(&finding);
  return STATUS_OK;
}
