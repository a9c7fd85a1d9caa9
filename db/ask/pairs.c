/* Reads both sides of a comparison and walks along them. */
#include "db/ask/pairs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "db/ask/points.h"
#include "db/ask/values.h"
#include "engine/grow.h"

struct group { /* the runs of one point */
  char *inputs;
  int64_t point;
  size_t first, count; /* in `values` */
};
struct side {
  bool one_point;
  struct group *groups;
  struct difference_value *values;
  size_t group_count, group_room, value_count, value_room;
};
struct ask_pairs {
  struct side side[2];
};

static status take(void *context, const struct ask_values_row *row, struct error *error) {
  struct side *side = context;
  if (isnan(row->value))
    return STATUS_OK;
  if (side->group_count == 0 || side->groups[side->group_count - 1].point != row->point_id) {
    char *inputs = strdup(side->one_point ? "" : row->inputs);
    if (!inputs || !grow_room(&side->groups, &side->group_room, side->group_count + 1, sizeof *side->groups)) {
      free(inputs);
      return status_fail(error, STATUS_MEMORY, "no memory for the points");
    }
    side->groups[side->group_count++] = (struct group){inputs, row->point_id, side->value_count, 0};
  }
  if (!grow_room(&side->values, &side->value_room, side->value_count + 1, sizeof *side->values))
    return status_fail(error, STATUS_MEMORY, "no memory for the runs");
  side->values[side->value_count++] = (struct difference_value){row->seed, row->value};
  side->groups[side->group_count - 1].count++;
  return STATUS_OK;
}

static status read_side(const char *operand, const char *quantity, struct side *side, struct error *error) {
  char path[4096], column[ASK_GROUP_NAME];
  struct ask_values_choice choice = {0};
  const char *colon = strrchr(operand, ':');
  snprintf(path, sizeof path, "%s", operand);
  if (colon && access(operand, F_OK) != 0) {
    snprintf(path, sizeof path, "%.*s", (int)(colon - operand), operand);
    char *end = NULL;
    choice.point = strtoll(colon + 1, &end, 10);
    if (*end || choice.point < 1)
      choice = (struct ask_values_choice){.campaign = colon + 1};
  }
  side->one_point = choice.point > 0;
  struct store *store = NULL;
  status code = store_open_reader(path, &store, error);
  if (code)
    return code;
  code = ask_points_known(store, choice.point, error);
  if (code == STATUS_OK)
    code = ask_group_quantity(store, quantity, column, error);
  if (code == STATUS_OK)
    code = ask_values(store, &choice, column, take, side, error);
  store_close(store, NULL);
  if (code == STATUS_OK && side->group_count == 0)
    code = status_fail(error, STATUS_USAGE, "%s: no run that counts has a value of %s", operand, quantity);
  return code;
}

status ask_pairs_read(const char *first, const char *second, const char *quantity, struct ask_pairs **out,
                      struct error *error) {
  struct ask_pairs *pairs = calloc(1, sizeof *pairs);
  *out = NULL;
  if (!pairs)
    return status_fail(error, STATUS_MEMORY, "no memory for a comparison");
  status code = read_side(first, quantity, &pairs->side[0], error);
  if (code == STATUS_OK)
    code = read_side(second, quantity, &pairs->side[1], error);
  if (code == STATUS_OK && pairs->side[0].one_point != pairs->side[1].one_point)
    code = status_fail(error, STATUS_USAGE, "compare a point with a point (STORE:1), or all points with all points");
  if (code) {
    ask_pairs_free(pairs);
    return code;
  }
  *out = pairs;
  return STATUS_OK;
}

void ask_pairs_free(struct ask_pairs *pairs) {
  for (int k = 0; pairs && k < 2; k++) {
    for (size_t i = 0; i < pairs->side[k].group_count; i++)
      free(pairs->side[k].groups[i].inputs);
    free(pairs->side[k].groups);
    free(pairs->side[k].values);
  }
  free(pairs);
}

/* Both sides are in the order of their inputs. */
status ask_pairs_each(const struct ask_pairs *pairs,
                      status (*each)(void *context, const struct ask_pairs_row *row, struct error *error),
                      void *context, struct error *error) {
  const struct side *a = &pairs->side[0], *b = &pairs->side[1];
  size_t found = 0;
  for (size_t i = 0, j = 0; i < a->group_count && j < b->group_count;) {
    const struct group *first = &a->groups[i], *second = &b->groups[j];
    const int order = strcmp(first->inputs, second->inputs);
    i += order <= 0;
    j += order >= 0;
    if (order)
      continue;
    const struct ask_pairs_row row = {{first->point, second->point},
                                      first->inputs,
                                      difference_between(first->count, a->values + first->first, second->count,
                                                         b->values + second->first, 0.95)};
    const status code = each(context, &row, error);
    if (code)
      return code;
    found++;
  }
  if (found == 0)
    return status_fail(error, STATUS_USAGE,
                       "no point of A has the varied inputs of a point of B (%s; %s): name two points, STORE:POINT",
                       a->groups[0].inputs, b->groups[0].inputs);
  return STATUS_OK;
}
