/* The points of a campaign, one after the other; warnings about them; a list of them as a document. */
#include "campaign/document/campaign.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "campaign/terminal/words.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

status campaign_walk_begin(struct campaign_walk *walk, const struct campaign *campaign, struct error *error) {
  *walk = (struct campaign_walk){.campaign = campaign};
  TRY(memory_array(&walk->values, campaign->axis_count, sizeof *walk->values, "the points of a campaign", error));
  return design_create((enum design_kind)campaign->design.kind, campaign->axes, campaign->axis_count,
                       (uint64_t)campaign->design.points, (uint64_t)campaign->design.seed, &walk->design, error);
}

void campaign_walk_end(struct campaign_walk *walk) {
  design_free(walk->design);
  free(walk->values);
  walk->design = NULL;
  walk->values = NULL;
}

bool campaign_walk_next(struct campaign_walk *walk) {
  return design_next(walk->design, walk->values);
}

struct scene *campaign_walk_scene(const struct campaign_walk *walk, struct error *error) {
  const struct campaign *campaign = walk->campaign;
  struct scene *scene = campaign_point_scene(campaign, walk->values, error);
  for (size_t i = 0; !scene && error->status != STATUS_MEMORY && i < campaign->axis_count; i++) {
    const struct field *row = campaign->axes[i].row;
    char value[FIELD_TEXT_SIZE];
    field_show(row, &walk->values[i], value, sizeof value);
    text_append(error->message, sizeof error->message, "%s%s %s%s", i ? ", " : " (at ", row->path, value,
                i + 1 == campaign->axis_count ? ")" : "");
  }
  return scene;
}

/* ---- Collects the engine's warnings about the first points of a campaign ---- */

enum { LOOKED_AT = 1000, LINE = 500, KEPT = 8 };

/* A number that the scene gives for its own material and that others keep. */
struct kept {
  const struct field *row;
  char number[64], others[LINE]; /* "granite 1.31 MPa, ..." */
};

/* Points with the inputs of an earlier one, which are one point with it, though the document gives another value. */
struct twins {
  uint8_t (*identity)[16];   /* of each new point; owned */
  struct field_value *value; /* its values of the axes; owned */
  size_t seen, again, count; /* new points; points that are one with those; of them with other values */
  char pairs[LINE];          /* "target.material.name ./b.yaml as ./a.yaml, ..." */
};

struct doubts {
  size_t points, count[CONDITION_MOST];
  double number[CONDITION_MOST];    /* of the worst point with this warning */
  bool differ[CONDITION_MOST];      /* this number differs between the points */
  char worst[CONDITION_MOST][LINE]; /* the engine's text for it */
  struct kept kept[KEPT];
  char partly[LINE]; /* the engine's remark about inputs that are given in part */
};

/* Is `other`, up to a comma, in the list? */
static bool has_other(const char *others, const char *other) {
  const size_t length = strlen(other);
  for (const char *at = others; (at = strstr(at, other)); at++)
    if ((at == others || at[-1] == ' ') && (at[length] == ',' || at[length] == '\0'))
      return true;
  return false;
}

static void add_kept(struct doubts *doubts, const struct scene *scene) {
  if (!*doubts->partly && scene->kind->remark)
    scene->kind->remark(scene->inputs, scene->given, doubts->partly, sizeof doubts->partly);
  for (struct scene_kept found = {0}; scene_next_kept(scene, &found);) {
    char value[FIELD_TEXT_SIZE], other[2 * FIELD_TEXT_SIZE];
    size_t k = 0;
    while (k < KEPT && doubts->kept[k].row && doubts->kept[k].row != found.row)
      k++;
    if (k == KEPT)
      return;
    struct kept *kept = &doubts->kept[k];
    field_show(found.row, &found.number, value, sizeof value);
    snprintf(kept->number, sizeof kept->number, "%.60s", value);
    field_show(found.row, &found.without, value, sizeof value);
    other[0] = 0;
    text_append(other, sizeof other, "%s: %s", found.material.text, value);
    if (!has_other(kept->others, other) && strlen(kept->others) + strlen(other) < LINE - 8)
      text_append(kept->others, sizeof kept->others, "%s%s", kept->row ? ", " : "", other);
    kept->row = found.row;
  }
}

/* The engine writes its lines in the order of the bits. */
static void add(struct doubts *doubts, const struct scene *scene) {
  OWNED char *text = NULL;
  FILE *out = text_open(&text);
  doubts->points++;
  add_kept(doubts, scene);
  const condition_set set = condition_before(scene->kind->conditions, scene->inputs, out);
  const char *line = text_close_small(out, &text);
  for (size_t k = 0; k < CONDITION_MOST; k++) {
    if (!(set >> k & 1))
      continue;
    const size_t length = strcspn(line, "\n");
    const struct condition *condition = &scene->kind->conditions[k];
    const double number = condition->before(scene->inputs), before = doubts->number[k];
    const bool other = doubts->count[k]++ > 0 && !condition->fact && number != before;
    doubts->differ[k] |= other;
    if (doubts->count[k] == 1 || (other && (condition->least ? number < before : number > before))) {
      doubts->number[k] = number;
      snprintf(doubts->worst[k], sizeof doubts->worst[k], "%.*s", (int)length, line);
    }
    line += length + (line[length] != 0);
  }
}

static void print_line(const char *text, const char *before, FILE *out) {
  if (out == stderr)
    fprintf(out, "%s%s\n", before, text); /* wrapped on a terminal, see words.h */
  else
    words_print(out, before, "%s", text);
}

static void print(const struct doubts *doubts, const char *before, bool counted, FILE *out) {
  for (size_t k = 0; k < CONDITION_MOST; k++) {
    if (doubts->count[k] == 0)
      continue;
    char text[LINE + 64] = "";
    if (counted)
      text_append(text, sizeof text, "%zu of %zu points%s: ", doubts->count[k], doubts->points,
                  doubts->differ[k] ? ", at worst" : "");
    text_append(text, sizeof text, "%s", doubts->worst[k]);
    print_line(text, before, out);
  }
}

static void print_kept(const struct doubts *doubts, const char *before, FILE *out) {
  if (*doubts->partly)
    print_line(doubts->partly, before, out);
  for (size_t k = 0; k < KEPT && doubts->kept[k].row; k++) {
    const struct kept *kept = &doubts->kept[k];
    char text[2 * LINE + 300] = "";
    text_append(
        text, sizeof text,
        "%s: the scene gives %s for its own material, and other materials keep it. Their own value would be "
        "%s. Write the value for each material in `vary`: {linked: ..., values: [...]} (campaign/README.md, A rock of "
        "your own)",
        kept->row->path, kept->number, kept->others);
    print_line(text, before, out);
  }
}

void campaign_tell_kept(const struct scene *scene, const char *before, FILE *out) {
  struct doubts doubts = {0};
  add_kept(&doubts, scene);
  print_kept(&doubts, before, out);
}

void campaign_warn_scene(const struct scene *scene, const char *before, FILE *out) {
  struct doubts doubts = {0};
  add(&doubts, scene);
  print(&doubts, before, false, out);
  print_kept(&doubts, before, out);
}

/* Adds what tells two equal points apart in the document, such as the names of two files with the same values. A point
 * that is given twice, as by a design for sensitivities, is no pair. */
static void add_pair(struct twins *twins, const struct campaign *campaign, const struct field_value *value,
                     const struct field_value *earlier) {
  bool differ = false;
  for (size_t a = 0; a < campaign->axis_count; a++) {
    const struct field *row = campaign->axes[a].row;
    char own[FIELD_TEXT_SIZE], other[FIELD_TEXT_SIZE], pair[3 * FIELD_TEXT_SIZE];
    if (field_same_value(row, &value[a], &earlier[a]))
      continue;
    differ = true;
    field_show(row, &value[a], own, sizeof own);
    field_show(row, &earlier[a], other, sizeof other);
    snprintf(pair, sizeof pair, "%s %s as %s", row->path, own, other);
    if (!has_other(twins->pairs, pair) && strlen(twins->pairs) + strlen(pair) < LINE - 8)
      text_append(twins->pairs, LINE, "%s%s", *twins->pairs ? ", " : "", pair);
  }
  twins->count += differ;
}

/* Has no earlier point the inputs of this one? */
static bool is_new(struct twins *twins, const struct campaign_walk *walk, const struct scene *scene) {
  const size_t axes = walk->campaign->axis_count;
  uint8_t *own = twins->identity[twins->seen];
  scene_identity(scene, 0, own);
  for (size_t i = 0; i < twins->seen; i++)
    if (memcmp(twins->identity[i], own, sizeof twins->identity[i]) == 0) {
      twins->again++;
      add_pair(twins, walk->campaign, walk->values, twins->value + i * axes);
      return false;
    }
  memcpy(twins->value + twins->seen++ * axes, walk->values, axes * sizeof *twins->value);
  return true;
}

static void print_twins(const struct twins *twins, const char *before, FILE *out) {
  char text[LINE + 200];
  const size_t all = twins->seen + twins->again;
  if (twins->count == 0)
    return;
  snprintf(text, sizeof text, "%zu of %s%zu points have the values of an earlier one, and are one point with it: %s",
           twins->count, all < LOOKED_AT ? "" : "the first ", all, twins->pairs);
  print_line(text, before, out);
}

/* Inputs of a sample that follow each other by chance: `clast sensitivity` asks the same of points that have run. */
static void print_moving(const struct campaign *campaign, const struct twins *twins, const char *before, FILE *out) {
  struct sensitivity_points points = {.points = twins->seen, .most = 1};
  struct sensitivity_point index[LIMITS_AXES_OF_POOL + 1];
  const bool named[LIMITS_AXES_OF_POOL] = {false};
  const struct design_axis *axis[LIMITS_AXES_OF_POOL];
  char text[LINE] = "";
  size_t needed;
  for (size_t a = 0; a < campaign->axis_count && points.inputs < LIMITS_AXES_OF_POOL; a++)
    if (isfinite(design_axis_share(&campaign->axes[a], &twins->value[a])))
      axis[points.inputs++] = &campaign->axes[a];
  if (campaign->design.kind < CAMPAIGN_RANDOM || points.inputs < 2)
    return;
  OWNED double *x = NULL, *value = NULL;
  OWNED size_t *runs = NULL;
  if (memory_array(&x, points.points * points.inputs, sizeof *x, "points", NULL) ||
      memory_array(&value, points.points, sizeof *value, "points", NULL) ||
      memory_array(&runs, points.points, sizeof *runs, "points", NULL))
    return;
  for (size_t i = 0; i < points.points; i++) {
    for (size_t k = 0; k < points.inputs; k++)
      x[i * points.inputs +
        k] = design_axis_share(axis[k], &twins->value[i * campaign->axis_count + (size_t)(axis[k] - campaign->axes)]);
    value[i] = (double)i; /* any results: the verdict rests on the inputs alone */
    runs[i] = 1;
  }
  points.x = x;
  points.named = named;
  points.value = value;
  points.runs = runs;
  if (sensitivity_points(&points, index, &needed, NULL))
    return;
  for (size_t k = 0; k < points.inputs; k++)
    if (index[k].verdict == SENSITIVITY_MOVES)
      text_append(text, sizeof text, "%s%s", *text ? ", " : "", axis[k]->row->path);
  if (!*text)
    return;
  text_append(text, sizeof text,
              " move together in these %zu points by chance: `clast sensitivity` will not tell their effects apart. "
              "Give another design.seed, or more points",
              points.points);
  print_line(text, before, out);
}

void campaign_warn(const struct campaign *campaign, const char *before, FILE *out) {
  struct doubts doubts = {0};
  struct twins twins = {0};
  CAMPAIGN_WALK walk = {0};
  struct error error;
  if (campaign_walk_begin(&walk, campaign, &error) == STATUS_OK &&
      memory_array(&twins.identity, LOOKED_AT, sizeof *twins.identity, "points", &error) == STATUS_OK &&
      memory_array(&twins.value, LOOKED_AT * campaign->axis_count, sizeof *twins.value, "points", &error) == STATUS_OK)
    for (size_t i = 0; i < LOOKED_AT && campaign_walk_next(&walk); i++) {
      SCENE scene = campaign_walk_scene(&walk, &error);
      if (scene && is_new(&twins, &walk, scene))
        add(&doubts, scene);
    }
  print_twins(&twins, before, out);
  if (twins.seen > 0)
    print_moving(campaign, &twins, before, out);
  free(twins.identity);
  free(twins.value);
  print(&doubts, before, doubts.points > 1, out);
  print_kept(&doubts, before, out);
}

/* ---- Writes campaigns of lists. JSON values are YAML ---- */

static void write_value(const struct field *row, const struct field_value *value, FILE *out) {
  fputc(' ', out);
  if (!field_needs_unit(row)) {
    field_json_value(row, value, out);
    return;
  }
  char text[FIELD_TEXT_SIZE];
  field_print(row, value, text, sizeof text);
  text_json_string(text, out);
}

static void write_set(const struct scene *scene, FILE *out) {
  const char *before = "\nset:";
  for (size_t i = 0; i < scene->kind->inputs->count; i++) {
    const struct field *row = &scene->kind->inputs->rows[i];
    struct field_value value;
    if (!scene->overridden[i])
      continue;
    field_get(row, scene->inputs, &value);
    fprintf(out, "%s\n  %s:", before, row->path);
    write_value(row, &value, out);
    before = "";
  }
}

static void write_axes(const struct campaign *campaign, FILE *out) {
  fputs("\ndesign: list\nvary:", out);
  for (size_t i = 0; i < campaign->axis_count; i++) {
    const struct design_axis *axis = &campaign->axes[i];
    fprintf(out, "\n  %s: [", axis->row->path);
    for (size_t l = 0; l < axis->level_count; l++) {
      fputs(l ? "," : "", out);
      write_value(axis->row, &axis->levels[l], out);
    }
    fputs("]", out);
  }
}

char *campaign_write_list(const struct campaign *campaign, const char *scene_reference, const char *comment) {
  char *text = NULL;
  FILE *out = text_open(&text);
  fprintf(out, "# %s\nname: ", comment);
  text_json_string(campaign->name, out);
  fputs("\nscene: ", out);
  text_json_string(scene_reference, out);
  write_set(campaign->scene, out);
  write_axes(campaign, out);
  fprintf(out, "\nquantity: %s\nseeds: {first: %lld, per_point: %lld%s}\nstore: ", campaign->quantity,
          (long long)campaign->first_seed, (long long)campaign->per_point,
          campaign->independent ? ", independent: true" : "");
  text_json_string(campaign->store, out);
  fputs("\n", out);
  return text_close(out, &text);
}
