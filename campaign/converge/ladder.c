/* Makes the levels of a knob, sorts them and finds the reference. */
#include "campaign/converge/ladder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

struct making {
  const struct knob *knob;
  const struct scene *base;
  const struct field *rows[KNOB_INPUTS]; /* NULL: the knob has no such input in this scene */
  struct field_value own[KNOB_INPUTS];
  struct ladder *ladder;
  FILE *notes;
};

/* The knob's inputs that are active in the scene and not off. The first one must be; others may be missing. */
static status find_inputs(struct making *making, struct error *error) {
  const struct field_table *table = making->base->kind->inputs;
  for (size_t i = 0; i < KNOB_INPUTS && making->knob->inputs[i].path; i++) {
    const struct field *row = field_find(table, making->knob->inputs[i].path, error);
    if (!row)
      return STATUS_CONTENT;
    char why[256] = "off";
    const bool active = field_is_active(table, row, making->base->inputs);
    if (active)
      field_get(row, making->base->inputs, &making->own[i]);
    else
      field_describe_inactive(table, row, making->base->inputs, why, sizeof why);
    if (active && !(row->flags & FIELD_MAY_BE_OFF && field_is_off(making->own[i].number)))
      making->rows[i] = making->knob->inputs[i].given && !making->base->given[row - table->rows] ? NULL : row;
    else if (i == 0)
      return status_fail(error, STATUS_CONTENT, "%s does not apply: %s is %s", making->knob->name, row->path, why);
  }
  return STATUS_OK;
}

static void print_setting(const struct field *row, const struct field_value *value, char *text, size_t size) {
  char number[32];
  switch (row->kind) {
  case FIELD_REAL:
    field_print_number(value->number, number);
    snprintf(text, size, "%s", number);
    break;
  case FIELD_INTEGER: snprintf(text, size, "%lld", (long long)value->integer); break;
  case FIELD_BOOLEAN: snprintf(text, size, "%s", value->number != 0 ? "true" : "false"); break;
  case FIELD_CHOICE:
  case FIELD_TEXT: snprintf(text, size, "%.63s", value->text); break;
  }
}

/* The scene's other inputs of the knob follow the first one. */
static status set_inputs(const struct making *making, const struct field_value *first, struct scene *scene,
                         struct error *error) {
  status code = scene_set(scene, making->rows[0]->path, first, error);
  const double factor = field_is_number(making->rows[0]) ? field_number(first) / field_number(&making->own[0]) : 1;
  for (size_t i = 1; code == STATUS_OK && i < KNOB_INPUTS; i++) {
    if (!making->rows[i])
      continue;
    struct field_value value = making->own[i];
    const double change = pow(factor, making->knob->inputs[i].power);
    value.number *= change;
    value.integer = llround((double)value.integer * change);
    code = scene_set(scene, making->rows[i]->path, &value, error);
  }
  return code == STATUS_OK ? scene_check(scene, error) : code;
}

/* Why a scene does not have the spacing that its setting stands for (malloc'd); "": it has. */
static char *why_unkept(const struct knob *knob, const struct scene *scene) {
  char *why = NULL;
  FILE *out = text_open(&why);
  if (knob->tell_unkept)
    knob->tell_unkept(scene->inputs, out);
  return text_close_small(out, &why);
}

bool ladder_is_kept(const struct knob *knob, const struct scene *scene) {
  OWNED char *why = why_unkept(knob, scene);
  return !*why;
}

/* Leaves a level out, with a note, when it does not keep what its setting says; where the scene's own one does not
 * either, all stay. */
static bool is_unkept(const struct making *making, const struct ladder_level *level) {
  OWNED char *why = level->base || !ladder_is_kept(making->knob, making->base) ? NULL
                                                                               : why_unkept(making->knob, level->scene);
  if (why && *why && making->notes)
    fprintf(making->notes, "%s = %s is left out%s\n", making->rows[0]->path, level->setting, why);
  return why && *why;
}

/* Adds a level unless it is there already. One that the scene refuses becomes a note. */
static status add_level(struct making *making, const struct field_value *value, struct error *error) {
  struct ladder *ladder = making->ladder;
  struct ladder_level level = {.step = NAN};
  print_setting(making->rows[0], value, level.setting, sizeof level.setting);
  for (size_t i = 0; i < ladder->count; i++)
    if (strcmp(ladder->level[i].setting, level.setting) == 0)
      return STATUS_OK;
  if (ladder->count == KNOB_LEVELS)
    return status_fail(error, STATUS_USAGE, "more than %d levels of %s", KNOB_LEVELS, making->knob->name);

  level.base = field_same_value(making->rows[0], value, &making->own[0]);
  if (making->knob->step_power != 0)
    level.step = pow(field_number(value), making->knob->step_power);
  level.scene = scene_copy(making->base);
  struct error why = {0};
  if (!level.base && set_inputs(making, value, level.scene, &why) != STATUS_OK) {
    fprintf(making->notes, "%s = %s is left out: %s\n", making->rows[0]->path, level.setting, why.message);
    scene_free(level.scene);
    return STATUS_OK;
  }
  if (is_unkept(making, &level)) {
    scene_free(level.scene);
    return STATUS_OK;
  }
  ladder->level[ladder->count++] = level;
  return STATUS_OK;
}

/* Levels by text: the user's, or the choices of the knob. The scene's own may be written with fewer digits. */
static status add_text(struct making *making, const char *text, struct error *error) {
  const struct field_value *own = &making->own[0];
  struct field_value value = {0};
  if (field_parse(making->rows[0], text, &value, error) != STATUS_OK)
    return STATUS_USAGE;
  if (value.kind == FIELD_REAL && fabs(value.number - own->number) < 1e-5 * fabs(own->number))
    value = *own;
  return add_level(making, &value, error);
}

static status add_factors(struct making *making, struct error *error) {
  for (size_t i = 0; i < KNOB_LEVELS && making->knob->factors[i] > 0; i++) {
    struct field_value value = making->own[0];
    if (making->knob->factors[i] != 1) {
      char digits[32];
      snprintf(digits, sizeof digits, "%.4g", value.number * making->knob->factors[i]);
      value.number = strtod(digits, NULL);
      value.integer = llround((double)value.integer * making->knob->factors[i]);
    }
    TRY(add_level(making, &value, error));
  }
  return STATUS_OK;
}

/* ---- named settings ---- */

static double work_of(const struct ladder_level *level) {
  return level->scene->kind->work ? level->scene->kind->work(level->scene->inputs) : 0;
}

static int by_work(const void *a, const void *b) {
  const double x = work_of(a), y = work_of(b);
  return (x > y) - (x < y);
}

/* "draft,reference" among the user's settings, or all. */
static bool is_wanted(const char *settings, const char *name) {
  const size_t length = strlen(name);
  for (const char *from = settings; from; from = strchr(from, ',') ? strchr(from, ',') + 1 : NULL)
    if (strncmp(from, name, length) == 0 && (from[length] == ',' || from[length] == '\0'))
      return true;
  return !settings;
}

static void add_named(struct making *making, const char *name) {
  struct ladder_level level = {.step = NAN, .base = strcmp(name, SCENE_SETTINGS_STANDARD) == 0};
  struct error why = {0};
  snprintf(level.setting, sizeof level.setting, "%s", name);
  level.scene = scene_copy(making->base);
  if (scene_settings_use(level.scene, name, &why) != STATUS_OK || scene_check(level.scene, &why) != STATUS_OK) {
    fprintf(making->notes, "settings %s are left out: %s\n", name, why.message);
    scene_free(level.scene);
    return;
  }
  making->ladder->level[making->ladder->count++] = level;
}

/* The knob of the group `model` that settings turn, or NULL. Such settings, for example the choices of another code,
 * are another model: what they change is no error of the scene's resolution. */
static const struct knob *model_of(const struct scene *scene, const struct scene_settings *settings) {
  for (const struct knob *knob = scene->kind->knobs; knob && knob->name; knob++)
    for (size_t i = 0; knob->group == KNOB_MODEL && i < KNOB_INPUTS && knob->inputs[i].path; i++)
      for (size_t j = 0; j < settings->count; j++)
        if (strcmp(scene->kind->inputs->rows[settings->item[j].row].path, knob->inputs[i].path) == 0)
          return knob;
  return NULL;
}

static status add_all_named(struct making *making, const char *settings, struct error *error) {
  const struct scene *base = making->base;
  struct ladder *ladder = making->ladder;
  if (is_wanted(settings, SCENE_SETTINGS_STANDARD))
    add_named(making, SCENE_SETTINGS_STANDARD);
  for (size_t i = 0; i < base->settings_count; i++) {
    const char *name = base->settings[i].name;
    const struct knob *model = settings ? NULL : model_of(base, &base->settings[i]);
    if (model)
      fprintf(making->notes, "settings %s are left out: another model (%s)\n", name, model->name);
    else if (is_wanted(settings, name))
      add_named(making, name);
  }
  if (ladder->count < 2)
    return status_fail(error, STATUS_CONTENT, "%s has fewer than two named settings (`settings` in its document)",
                       base->name);
  qsort(ladder->level, ladder->count, sizeof *ladder->level, by_work);
  size_t reference = ladder->count - 1;
  for (size_t i = 0; i < ladder->count; i++)
    if (strcmp(ladder->level[i].setting, "reference") == 0)
      reference = i;
  const struct ladder_level last = ladder->level[reference]; /* the reference goes to the end, like the finest level */
  memmove(ladder->level + reference, ladder->level + reference + 1,
          (ladder->count - 1 - reference) * sizeof *ladder->level);
  ladder->level[ladder->count - 1] = last;
  ladder->level[ladder->count - 1].reference = true;
  if (strcmp(last.setting, "reference") != 0 && strcmp(last.setting, SCENE_SETTINGS_STANDARD) != 0)
    fprintf(making->notes, "settings %s take the most work here: the others are compared with them (ref)\n",
            last.setting);
  return STATUS_OK;
}

/* ---- the ladder ---- */

static int by_step(const void *a, const void *b) {
  const double x = ((const struct ladder_level *)a)->step, y = ((const struct ladder_level *)b)->step;
  return (x < y) - (x > y);
}

static int by_value(const void *a, const void *b) {
  const double x = strtod(((const struct ladder_level *)a)->setting, NULL);
  const double y = strtod(((const struct ladder_level *)b)->setting, NULL);
  return (x > y) - (x < y);
}

static void sort_levels(struct ladder *ladder) {
  if (ladder->knob->step_power != 0)
    qsort(ladder->level, ladder->count, sizeof *ladder->level, by_step);
  else if (ladder->knob->factors[0] > 0)
    qsort(ladder->level, ladder->count, sizeof *ladder->level, by_value);
}

/* Makes all levels of a knob that sets inputs, in order, and marks the reference: the finest level, but for models the
 * scene's own, which may be missing among the user's settings. */
static status add_all_levels(struct making *making, const char *settings, struct error *error) {
  const struct knob *knob = making->knob;
  struct ladder *ladder = making->ladder;
  TRY(find_inputs(making, error));
  if (settings) {
    char text[64];
    while (ladder_next_word(&settings, text, sizeof text))
      TRY(add_text(making, text, error));
  } else if (knob->factors[0] > 0) {
    TRY(add_factors(making, error));
  } else {
    for (size_t i = 0; i < KNOB_LEVELS && knob->choices[i]; i++)
      TRY(add_text(making, knob->choices[i], error));
    TRY(add_level(making, &making->own[0], error));
  }
  if (ladder->count < 2)
    return status_fail(error, STATUS_CONTENT, "%s has fewer than two levels in this scene", knob->name);
  sort_levels(ladder);
  size_t reference = ladder->count - 1;
  for (size_t i = 0; knob->group == KNOB_MODEL && i < ladder->count; i++)
    if (ladder->level[i].base)
      reference = i;
  ladder->level[reference].reference = true;
  return STATUS_OK;
}

status ladder_make(const struct knob *knob, const struct scene *base, const char *settings, struct ladder *ladder,
                   char **notes, struct error *error) {
  *ladder = (struct ladder){.knob = knob};
  *notes = NULL;
  struct making making = {.knob = knob, .base = base, .ladder = ladder, .notes = text_open(notes)};
  const bool named = knob->group == KNOB_SETTINGS;
  status code = (named ? add_all_named : add_all_levels)(&making, settings, error);
  text_close_small(making.notes, notes);
  if (code != STATUS_OK)
    ladder_clear(ladder);
  return code;
}

status ladder_add_own(struct ladder *ladder, const struct scene *base, struct error *error) {
  struct making making = {.knob = ladder->knob, .base = base, .ladder = ladder};
  const size_t asked = ladder->count;
  if (ladder->knob->group != KNOB_RESOLUTION || asked == KNOB_LEVELS)
    return STATUS_OK;
  TRY(find_inputs(&making, error));
  TRY(add_level(&making, &making.own[0], error));
  if (ladder->count > asked)
    ladder->level[asked].unasked = true;
  sort_levels(ladder);
  return STATUS_OK;
}

status ladder_turn(const struct knob *knob, struct scene *scene, const char *setting, struct error *error) {
  if (knob->group == KNOB_SETTINGS) {
    const status used = scene_settings_use(scene, setting, error);
    return used == STATUS_OK ? scene_check(scene, error) : used;
  }
  struct making making = {.knob = knob, .base = scene};
  struct field_value value = {0};
  TRY(find_inputs(&making, error));
  if (field_parse_si(making.rows[0], setting, &value, error) != STATUS_OK)
    return STATUS_USAGE;
  return field_same_value(making.rows[0], &value, &making.own[0]) ? STATUS_OK
                                                                  : set_inputs(&making, &value, scene, error);
}

void ladder_setting(const struct knob *knob, const struct scene *scene, char *text, size_t size) {
  struct field_value value;
  const struct field *row = field_find(scene->kind->inputs, knob->inputs[0].path, NULL);
  text[0] = '\0';
  if (!row)
    return;
  field_get(row, scene->inputs, &value);
  print_setting(row, &value, text, size);
}

void ladder_clear(struct ladder *ladder) {
  for (size_t i = 0; i < ladder->count; i++)
    scene_free(ladder->level[i].scene);
  ladder->count = 0;
}

bool ladder_next_word(const char **list, char *word, size_t size) {
  if (**list == '\0')
    return false;
  const size_t length = strcspn(*list, ",");
  snprintf(word, size, "%.*s", (int)(length < size ? length : size - 1), *list);
  *list += length + ((*list)[length] == ',');
  return true;
}
