/* Reads both sides of a comparison and walks along them. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "schemas/memory.h"

struct ask_pairs_group { /* the runs of one point */
  char *list;            /* "path = value" of each input that a side varies, with SEPARATOR: a value may have a comma */
  char *inputs;          /* the same for readers, with ", " */
  char label[ASK_POOL_LABEL];
  int64_t point;
  struct ask_pairs_group *partner; /* of the other side; NULL: none */
  struct difference difference;    /* from this group of the first side to its partner */
  size_t first, count;             /* in `values` */
  size_t runs;                     /* that have a value or, of an exponent, that count */
  double exponent;                 /* of the runs together; NaN: of another quantity */
  const char *untold;              /* why tables for people show no exponent; NULL: they show it */
  struct ask_doubts doubts;
};
#define SEPARATOR '\n' /* char(10) in SQL */

/* The values of a column of the runs that count, of the newest results_version, ordered by inputs, point and seed. An
 * input that only the other side varies tells by its value which points are common. */
static struct answer ask_values(struct store *store, const struct ask_pairs_side side[2], const char *column,
                                struct error *error) {
  return answer_to(
      store, error,
      "WITH varied AS MATERIALIZED (SELECT point_id, (SELECT group_concat(v, char(10)) FROM (SELECT path || ' = ' || "
      "CAST(value AS TEXT) AS v FROM point_input i WHERE i.point_id = p.point_id AND path IN (SELECT value FROM "
      "json_each(%Q) UNION SELECT value FROM json_each(%Q)) ORDER BY path)) AS inputs FROM point p)\nSELECT inputs, "
      "point_id, seed, \"%w\" FROM runs JOIN varied USING (point_id) WHERE counts = 1 AND results_version = (SELECT "
      "max(results_version) FROM run WHERE counts = 1) ORDER BY inputs, point_id, seed, replicate",
      side[0].axes, side[1].axes, column);
}

/* The list with ", " for each SEPARATOR, which the caller frees; NULL: no memory. */
static char *readable(const char *list) {
  char *text = NULL;
  FILE *out = text_open(&text);
  for (; *list; list++)
    fputs(*list == SEPARATOR ? ", " : (const char[]){*list, '\0'}, out);
  return text_close(out, &text);
}

/* Adds a run to its point, which is the last one or a new one. */
static status add_run(struct ask_pairs_side *side, const struct answer *row, struct error *error) {
  const int64_t point = answer_integer(row, 1);
  if (side->group_count == 0 || side->groups[side->group_count - 1].point != point) {
    TRY(grow_or_fail(&side->groups, &side->group_room, side->group_count + 1, sizeof *side->groups, "the runs", error));
    struct ask_pairs_group *group = &side->groups[side->group_count++];
    *group = (struct ask_pairs_group){.point = point, .first = side->value_count, .exponent = NAN};
    group->list = strdup(side->one_point ? "" : answer_text(row, 0));
    group->inputs = group->list ? readable(group->list) : NULL;
    if (!group->inputs)
      return status_fail(error, STATUS_MEMORY, "no memory for the runs");
  }
  TRY(grow_or_fail(&side->values, &side->value_room, side->value_count + 1, sizeof *side->values, "the runs", error));
  side->values[side->value_count++] = (struct difference_value){answer_integer(row, 2), answer_real(row, 3)};
  side->groups[side->group_count - 1].count++;
  side->groups[side->group_count - 1].runs++;
  return STATUS_OK;
}

static int by_point(const void *a, const void *b) {
  const struct ask_pairs_group *p = a, *q = b;
  return (p->point > q->point) - (p->point < q->point);
}

static int by_seed(const void *a, const void *b) {
  const struct difference_value *p = a, *q = b;
  return (p->seed > q->seed) - (p->seed < q->seed);
}

/* Adds the contributions of a point's runs to its exponent, in the order of their seeds; none where the exponent has no
 * interval. where: SQL that chooses runs; NULL: all. */
static status read_exponent(struct store *store, enum exponent_method method, enum estimates_window window,
                            const char *where, struct ask_pairs_side *side, struct ask_pairs_group *group,
                            struct error *error) {
  POINT_DATA point = {0};
  OWNED double *contribution = NULL;
  TRY(point_read_where(store, group->point, 0, where, &point, error));
  const size_t runs = point.runs.count;
  TRY(memory_array(&contribution, runs, sizeof *contribution, "the runs", error));
  TRY(grow_or_fail(&side->values, &side->value_room, side->value_count + runs, sizeof *side->values, "the runs",
                   error));
  TRY(point_exponent_of_runs(&point, method, window, contribution, error));
  group->first = side->value_count;
  group->count = runs > 0 && isfinite(contribution[0]) ? runs : 0;
  for (size_t r = 0; r < group->count; r++)
    side->values[side->value_count++] = (struct difference_value){(int64_t)point.seed[r], contribution[r]};
  qsort(side->values + group->first, group->count, sizeof *side->values, by_seed);
  return STATUS_OK;
}

/* Puts the contributions in place of the values. */
static status read_exponents(struct store *store, enum exponent_method method, enum estimates_window window,
                             struct ask_pairs_side *side, struct error *error) {
  side->value_count = 0;
  for (size_t i = 0; i < side->group_count; i++) {
    struct pooled_exponent fit;
    struct ask_pairs_group *group = &side->groups[i];
    TRY(read_exponent(store, method, window, NULL, side, group, error));
    TRY(point_exponent(store, group->point, 0, method, window, 0.95, &fit, error));
    group->untold = pooled_exponent_untold(&fit);
    group->exponent = fit.fit.beta;
  }
  return STATUS_OK;
}

/* The values of side k. */
static status read_values(struct store *const of_sides[2], struct ask_pairs *pairs, int k, struct error *error) {
  struct store *store = of_sides[k];
  const char *quantity = pairs->quantity;
  struct ask_pairs_side *side = &pairs->side[k];
  char column[ASK_GROUP_NAME];
  bool exponent;
  enum exponent_method method;
  enum estimates_window window;
  TRY(estimates_named(quantity, &exponent, &method, &window, error));
  if (exponent)
    snprintf(column, sizeof column, "seed"); /* every run has one */
  else
    TRY(ask_group_quantity(store, quantity, column, error));
  ANSWER answer = ask_values(store, pairs->side, column, error);
  while (answer_next(&answer))
    if (!isnan(answer_real(&answer, 3)))
      TRY(add_run(side, &answer, error));
  TRY(answer_end(&answer));
  TRY(ask_run_excluded_count(store, &side->excluded, error));
  TRY(ask_run_missing(store, &side->missing, &side->wanted, error));
  side->left_out = ask_choice_left_out(store);
  for (size_t i = 0; i < side->group_count; i++) {
    struct ask_pairs_group *group = &side->groups[i];
    TRY(ask_points_label(store, of_sides[0], group->point, group->label, sizeof group->label, error));
    TRY(ask_doubts(store, &(struct ask_doubts_choice){.point = group->point},
                   exponent ? OUTCOME_NAME(mean_fragment_mass) : column, &group->doubts, error));
  }
  return exponent ? read_exponents(store, method, window, side, error) : STATUS_OK;
}

static status open_side(const char *operand, struct ask_choice choice, struct ask_pairs_side *side,
                        struct store **store, struct error *error) {
  ask_choose_operand(operand, side->path, sizeof side->path, &choice);
  side->one_point = choice.point > 0;
  side->choice = choice;
  TRY(store_open_reader(side->path, store, error));
  TRY(ask_choose(*store, &choice, error));
  if (choice.campaign)
    TRY(ask_campaign_namesakes(*store, choice.campaign, side->namesakes, sizeof side->namesakes, error));
  ANSWER axes = answer_to(*store, error, "SELECT json_group_array(path) FROM axis");
  if (answer_next(&axes))
    side->axes = strdup(answer_text(&axes, 0));
  TRY(answer_end(&axes));
  return side->axes ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the inputs");
}

/* The first group of the same inputs that has no partner yet; NULL: none. Groups are in the order of their inputs. */
static struct ask_pairs_group *partner_of(const struct ask_pairs_group *group, struct ask_pairs_side *side) {
  size_t low = 0, high = side->group_count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (strcmp(side->groups[middle].list, group->list) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < side->group_count && strcmp(side->groups[low].list, group->list) == 0; low++)
    if (!side->groups[low].partner)
      return &side->groups[low];
  return NULL;
}

static struct difference difference_of(const struct ask_pairs_side side[2], const struct ask_pairs_group *a,
                                       const struct ask_pairs_group *b) {
  return sample_difference(a->count, side[0].values + a->first, b->count, side[1].values + b->first, 0.95);
}

/* SQL that chooses the seeds that both groups have. NULL: no memory. */
static char *common_seeds(const struct ask_pairs_side side[2], const struct ask_pairs_group *a,
                          const struct ask_pairs_group *b) {
  const struct difference_value *first = side[0].values + a->first, *second = side[1].values + b->first;
  char *text = NULL;
  FILE *out = text_open(&text);
  for (size_t i = 0, j = 0; i < a->count && j < b->count;) {
    const int64_t seed = first[i].seed, other = second[j].seed;
    if (seed == other)
      fprintf(out, "%s%lld", ftell(out) > 0 ? ", " : "seed IN (", (long long)seed);
    i += seed <= other;
    j += other <= seed;
  }
  fputs(")", out);
  return text_close(out, &text);
}

/* The exponents of the common seeds alone, where the difference is of pairs: what a run contributes depends on all runs
 * of the fit, also on those without a partner. */
static status compare_common(struct store *const store[2], struct ask_pairs_side side[2], const char *quantity,
                             struct ask_pairs_group *first, struct error *error) {
  struct ask_pairs_group group[2] = {*first, *first->partner};
  struct difference *difference = &first->difference;
  bool exponent;
  enum exponent_method method;
  enum estimates_window window;
  TRY(estimates_named(quantity, &exponent, &method, &window, error));
  if (!exponent || difference->pairs == 0 ||
      (difference->pairs == difference->side[0].n && difference->pairs == difference->side[1].n))
    return STATUS_OK;
  OWNED char *where = common_seeds(side, &group[0], &group[1]);
  if (!where)
    return status_fail(error, STATUS_MEMORY, "no memory for the runs");
  for (int k = 0; k < 2; k++)
    TRY(read_exponent(store[k], method, window, where, &side[k], &group[k], error));
  const struct difference common = difference_of(side, &group[0], &group[1]);
  if (common.side[0].n == 0 || common.side[1].n == 0)
    *difference = common; /* no interval */
  difference->difference = common.difference;
  difference->half_width = common.half_width;
  return STATUS_OK;
}

static status pair_groups(struct store *const store[2], struct ask_pairs *pairs, struct error *error) {
  struct ask_pairs_side *side = pairs->side;
  for (size_t i = 0; i < side[0].group_count; i++) {
    struct ask_pairs_group *first = &side[0].groups[i];
    first->partner = partner_of(first, &side[1]);
    if (!first->partner)
      continue;
    pairs->found++;
    first->partner->partner = first;
    first->difference = difference_of(side, first, first->partner);
    TRY(compare_common(store, side, pairs->quantity, first, error));
  }
  return STATUS_OK;
}

status ask_pairs_read(const char *first, const char *second, const char *quantity, const struct ask_choice *choice,
                      struct ask_pairs **out, struct error *error) {
  ASK_PAIRS pairs = memory_small(1, sizeof *pairs);
  *out = NULL;
  pairs->quantity = quantity;
  STORE a = NULL;
  STORE b = NULL;
  TRY(open_side(first, *choice, &pairs->side[0], &a, error));
  TRY(open_side(second, *choice, &pairs->side[1], &b, error));
  TRY(ask_quantity_main(a, pairs->main, &pairs->quantity, error));
  for (int k = 0; k < 2; k++) {
    TRY(read_values((struct store *const[]){a, b}, pairs, k, error));
    if (pairs->side[k].group_count == 0)
      return status_fail(error, STATUS_USAGE, "%s: no run that counts has a value of %s that is not withheld",
                         k ? second : first, pairs->quantity);
  }
  if (pairs->side[0].one_point != pairs->side[1].one_point)
    return status_fail(error, STATUS_USAGE, "compare a point with a point (STORE:1), or all points with all points");
  qsort(pairs->side[0].groups, pairs->side[0].group_count, sizeof *pairs->side[0].groups, by_point);
  TRY(pair_groups((struct store *const[]){a, b}, pairs, error));
  *out = pairs;
  pairs = NULL;
  return STATUS_OK;
}

void ask_pairs_free(struct ask_pairs *pairs) {
  for (int k = 0; pairs && k < 2; k++) {
    for (size_t i = 0; i < pairs->side[k].group_count; i++) {
      free(pairs->side[k].groups[i].list);
      free(pairs->side[k].groups[i].inputs);
    }
    free(pairs->side[k].axes);
    free(pairs->side[k].groups);
    free(pairs->side[k].values);
  }
  free(pairs);
}

void ask_pairs_drop(struct ask_pairs **pairs) {
  ask_pairs_free(*pairs);
}

bool ask_pairs_next(struct ask_pairs *pairs, struct ask_pairs_row *row) {
  const struct ask_pairs_side *a = &pairs->side[0];
  while (pairs->at < a->group_count) {
    const struct ask_pairs_group *first = &a->groups[pairs->at++], *second = first->partner;
    if (!second)
      continue;
    *row = (struct ask_pairs_row){{first->point, second->point},     first->inputs,
                                  {first->label, second->label},     first->difference,
                                  {&first->doubts, &second->doubts}, {first->runs, second->runs},
                                  {first->untold, second->untold},   {first->exponent, second->exponent}};
    return true;
  }
  return false;
}

enum { NAMED = 5 /* most inputs with values in a message */, NAME_SETS = 20 /* most that are compared */ };

/* The next input, "path = value", of a list; NULL: none. */
static const char *next_input(const char *list, const char *input, size_t *length) {
  if (input && !input[*length])
    return NULL;
  input = input ? input + *length + 1 : list;
  *length = strcspn(input, (const char[]){SEPARATOR, '\0'});
  return *length ? input : NULL;
}

struct fixed {         /* of a side */
  struct scene *scene; /* of its first point, or of the chosen one */
  char *varied;        /* paths: axes of the store, and those in which these points differ */
  char *campaign;      /* name of the chosen one, or of the first of those that have it as their name */
};

struct apart { /* the inputs that differ */
  const struct field **rows;
  size_t count, room;
  FILE *out;
};

/* point: 0: all. */
static status read_fixed(const struct ask_pairs_side *side, int64_t point, struct fixed *fixed, struct error *error) {
  STORE store = NULL;
  TRY(store_open_reader(side->path, &store, error));
  TRY(ask_choose(store, &side->choice, error));
  ANSWER answer = answer_to(
      store, error,
      "WITH its AS MATERIALIZED (SELECT DISTINCT point_id FROM runs WHERE counts AND %lld IN (0, point_id)) SELECT "
      "(SELECT scene FROM point WHERE "
      "point_id = (SELECT min(point_id) FROM its)), (SELECT group_concat(path, ' ') FROM (SELECT path FROM axis UNION "
      "SELECT path FROM point_input JOIN its USING (point_id) GROUP BY path HAVING count(DISTINCT value) > 1 OR "
      "count(*) < (SELECT count(*) FROM its))), (SELECT name FROM campaign ORDER BY campaign_id)",
      (long long)point);
  if (answer_next(&answer)) {
    TRY(scene_parse_json("stored scene", answer_text(&answer, 0), &fixed->scene, error));
    fixed->varied = strdup(answer_text(&answer, 1));
    fixed->campaign = strdup(answer_text(&answer, 2));
  }
  TRY(answer_end(&answer));
  return fixed->varied && fixed->campaign ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the inputs");
}

/* Writes both values of an input that differs, that no side varies, and that follows from no other; notes it. */
static status write_input(const struct fixed side[2], const struct field *row, struct apart *apart,
                          struct error *error) {
  char shown[2][FIELD_TEXT_SIZE] = {"none", "none"};
  bool follows = true;
  for (size_t i = 0; i < apart->count; i++)
    if (apart->rows[i] == row)
      return STATUS_OK;
  for (int k = 0; k < 2; k++) {
    const struct scene *scene = side[k].scene;
    struct field_value value;
    if (text_has_word(side[k].varied, row->path))
      return STATUS_OK;
    if (!field_is_active(scene->kind->inputs, row, scene->inputs))
      continue;
    follows = follows && (row->flags & FIELD_DERIVED) && scene_follows(scene, row);
    field_get(row, scene->inputs, &value);
    field_show(row, &value, shown[k], sizeof shown[k]);
  }
  if (follows || strcmp(shown[0], shown[1]) == 0)
    return STATUS_OK;
  TRY(grow_or_fail(&apart->rows, &apart->room, apart->count + 1, sizeof *apart->rows, "the inputs", error));
  apart->rows[apart->count++] = row;
  if (apart->count <= NAMED)
    fprintf(apart->out, "%s%s (%s, %s)", ftell(apart->out) > 0 ? ", " : "", row->path, shown[0], shown[1]);
  return STATUS_OK;
}

/* Compares a point of each side; 0 and 0: what is the same in all points of a side. */
static status compare_points(const struct ask_pairs *pairs, const int64_t points[2], struct apart *apart,
                             struct error *error) {
  struct fixed side[2] = {{0}};
  status code = STATUS_OK;
  for (int k = 0; k < 2 && !code; k++)
    code = read_fixed(&pairs->side[k], points[k], &side[k], error);
  if (!code && ftell(apart->out) == 0) {
    const char *of[2] = {pairs->side[0].choice.campaign, pairs->side[1].choice.campaign};
    if (of[0] && of[1] && !strcmp(of[0], of[1]) && strcmp(side[0].campaign, side[1].campaign) != 0)
      fprintf(apart->out, "campaign (%s, %s)", side[0].campaign, side[1].campaign); /* of one number */
    if (strcmp(side[0].scene->name, side[1].scene->name) != 0)
      fprintf(apart->out, "%sscene (%s, %s)", ftell(apart->out) > 0 ? ", " : "", side[0].scene->name,
              side[1].scene->name);
  }
  const struct field_table *inputs = code ? NULL : side[0].scene->kind->inputs;
  for (size_t i = 0; !code && side[0].scene->kind == side[1].scene->kind && i < inputs->count; i++)
    code = write_input(side, &inputs->rows[i], apart, error);
  for (int k = 0; k < 2; k++) {
    scene_free(side[k].scene);
    free(side[k].varied);
    free(side[k].campaign);
  }
  return code;
}

/* Of the names among the inputs, such as those of rocks: values that follow from them differ between points. */
static uint64_t hash_names(const char *list) {
  uint64_t hash = TEXT_HASH_START;
  size_t length = 0;
  for (const char *input = NULL; (input = next_input(list, input, &length));) {
    const char *end = strstr(input, " = ");
    if (end && end - input > 5 && strncmp(end - 5, ".name", 5) == 0)
      hash = text_hash(hash, input, length);
  }
  return hash;
}

/* Compares the first pair with each set of names. */
static status compare_pairs(const struct ask_pairs *pairs, struct apart *apart, struct error *error) {
  uint64_t seen[NAME_SETS];
  size_t sets = 0, i = 0;
  if (pairs->found == 0)
    return compare_points(pairs, (const int64_t[]){0, 0}, apart, error);
  for (; i < pairs->side[0].group_count && sets < NAME_SETS; i++) {
    const struct ask_pairs_group *group = &pairs->side[0].groups[i];
    size_t at = 0;
    if (!group->partner)
      continue;
    seen[sets] = hash_names(group->list);
    while (seen[at] != seen[sets])
      at++;
    if (at < sets)
      continue;
    sets++;
    TRY(compare_points(pairs, (const int64_t[]){group->point, group->partner->point}, apart, error));
  }
  return STATUS_OK;
}

status ask_pairs_apart(const struct ask_pairs *pairs, char **text, struct error *error) {
  struct apart apart = {.out = text_open(text)};
  const status code = compare_pairs(pairs, &apart, error);
  if (apart.count > NAMED)
    fprintf(apart.out, " and %zu more inputs", apart.count - NAMED);
  free(apart.rows);
  return text_close(apart.out, text) || code ? code : status_fail(error, STATUS_MEMORY, "no memory for the inputs");
}

status ask_pairs_alone(const struct ask_pairs *pairs, char **text, struct error *error) {
  FILE *out = text_open(text);
  for (int k = 0; k < 2; k++) {
    const struct ask_pairs_side *side = &pairs->side[k];
    const size_t alone = side->group_count - pairs->found;
    if (alone == 0)
      continue;
    fprintf(out, "%s%zu of %zu points of %c", ftell(out) > 0 ? ", " : "", alone, side->group_count, 'a' + k);
    const char *before = " (";
    for (size_t i = 0; alone <= NAMED && i < side->group_count; i++)
      if (!side->groups[i].partner) {
        fprintf(out, "%s%s", before, side->groups[i].label);
        before = "; ";
      }
    fputs(alone <= NAMED ? ")" : "", out);
  }
  return text_close(out, text) ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the points");
}

enum { LOOKED_AT = 300 }; /* points of a side */

static bool has_input(const struct ask_pairs_side *side, const char *input, size_t length) {
  for (size_t i = 0; i < side->group_count && i < LOOKED_AT; i++) {
    size_t other = 0;
    for (const char *at = NULL; (at = next_input(side->groups[i].list, at, &other));)
      if (other == length && strncmp(at, input, length) == 0)
        return true;
  }
  return false;
}

/* Has A a value of this path that B has, too? */
static bool is_common(const struct ask_pairs *pairs, const char *path, size_t path_length) {
  const struct ask_pairs_side *b = &pairs->side[1];
  for (size_t i = 0; i < b->group_count && i < LOOKED_AT; i++) {
    size_t length = 0;
    for (const char *input = NULL; (input = next_input(b->groups[i].list, input, &length));)
      if (strncmp(input, path, path_length) == 0 && input[path_length] == ' ' &&
          has_input(&pairs->side[0], input, length))
        return true;
  }
  return false;
}

static bool has_path(const struct ask_pairs_side *side, const char *path, size_t path_length) {
  size_t length = 0;
  for (const char *input = NULL; (input = next_input(side->groups[0].list, input, &length));)
    if (strncmp(input, path, path_length) == 0 && input[path_length] == ' ')
      return true;
  return false;
}

/* Writes the paths of the inputs that the scene of one side alone has, or of which the sides have no common value, of
 * many the first NAMED; "": each has one. */
static void write_apart(const struct ask_pairs *pairs, char *text, size_t size) {
  size_t length = 0, count = 0;
  *text = '\0';
  for (int k = 1; k >= 0; k--)
    for (const char *input = NULL; (input = next_input(pairs->side[k].groups[0].list, input, &length));) {
      const size_t path = strcspn(input, " ");
      const bool both = has_path(&pairs->side[!k], input, path);
      if ((both && (k == 0 || is_common(pairs, input, path))) || count++ >= NAMED)
        continue;
      text_append(text, size, "%s", *text ? ", " : ": ");
      const char *store = strcmp(pairs->side[0].path, pairs->side[1].path) != 0 ? pairs->side[k].path : k ? "B" : "A";
      if (both)
        text_append(text, size, "no common value of %.*s", (int)path, input);
      else
        text_append(text, size, "only %.64s has %.*s", store, (int)path, input);
    }
  if (count > NAMED)
    text_append(text, size, " and %zu more inputs", count - NAMED);
}

status ask_pairs_end(const struct ask_pairs *pairs, struct error *error) {
  const struct ask_pairs_side *a = &pairs->side[0], *b = &pairs->side[1];
  char apart[NAMED * (FIELD_TEXT_SIZE + 88)], point[2][TEXT_WORD], word[2][TEXT_WORD];
  if (pairs->found > 0)
    return STATUS_OK;
  for (int k = 0; k < 2; k++)
    snprintf(point[k], sizeof point[k], "%s:%lld", pairs->side[k].path, (long long)pairs->side[k].groups[0].point);
  write_apart(pairs, apart, sizeof apart);
  char advice[512] = "Name campaigns that vary the same (STORE:CAMPAIGN)";
  for (int k = 1; k >= 0; k--)
    if (*pairs->side[k].namesakes)
      snprintf(advice, sizeof advice,
               "Campaigns %s of %.64s are called %.64s: give that store alone with --campaign %.*s, the other as "
               "STORE:CAMPAIGN",
               pairs->side[k].namesakes, pairs->side[k].path, pairs->side[k].choice.campaign,
               (int)strcspn(pairs->side[k].namesakes, ","), pairs->side[k].namesakes);
  if (*a->namesakes && strcmp(a->namesakes, b->namesakes) == 0)
    snprintf(advice, sizeof advice,
             "Campaigns %s of %.64s share a name, and so do %s of %.64s: --campaign NUMBER with the stores alone takes "
             "this one of both",
             a->namesakes, a->path, b->namesakes, b->path);
  return status_fail(error, STATUS_USAGE,
                     "no two points have the same varied inputs%s. %s, or two points: `clast compare %s %s`", apart,
                     advice, text_word(point[0], word[0]), text_word(point[1], word[1]));
}
