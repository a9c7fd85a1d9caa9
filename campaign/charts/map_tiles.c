/* Collects the tiles of a map and draws them. */
#include "campaign/charts/charts.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_GROUPS = 10000 };

struct map_tiles {
  struct quantity quantity;
  double (*points)[3]; /* x, y, value */
  size_t count;
  double widest; /* half width of the widest interval, in the quantity's unit; 0: there is none */
};

static bool is_number(const struct query_value *value) {
  return value->kind == QUERY_REAL || value->kind == QUERY_INTEGER;
}

static status add(void *context, const struct quantity_row *row, struct error *error) {
  struct map_tiles *map = context;
  if (map->count == MOST_GROUPS)
    return status_fail(error, STATUS_USAGE, "a map has at most %d points: choose axes with fewer values", MOST_GROUPS);
  if (!is_number(&row->input[0]) || !is_number(&row->input[1]))
    return STATUS_OK; /* off, or does not apply: an axis of numbers cannot show it */

  const double x = row->input[0].real;
  const double y = row->input[1].real;
  for (size_t i = 0; map->quantity.exponent && i < map->count; i++)
    if (map->points[i][0] == x && map->points[i][1] == y)
      return status_fail(error, STATUS_USAGE,
                         "several points share %s = %g and %s = %g: their exponents are not averaged",
                         map->quantity.column[0], x, map->quantity.column[1], y);

  double *point = map->points[map->count++];
  point[0] = x;
  point[1] = y;
  point[2] = row->value;
  map->widest = fmax(map->widest, row->upper - row->value); /* NaN: no interval */
  return STATUS_OK;
}

static status draw(struct store *store, const struct map_tiles *map, const struct picture_page *page,
                   struct error *error) {
  const struct quantity *quantity = &map->quantity;
  char x[CHARTS_LABEL], y[CHARTS_LABEL], z[CHARTS_LABEL];
  char title[ASK_GROUP_POOLED + 400], caption[1100], pooled[ASK_GROUP_POOLED], intervals[600], resolution[400];
  status code = charts_axis(store, quantity->column[0], x, error);
  if (code == STATUS_OK)
    code = charts_axis(store, quantity->column[1], y, error);
  if (code == STATUS_OK)
    code = charts_axis(store, quantity->name, z, error);
  if (code)
    return code;
  charts_labels(quantity->pooled, pooled, sizeof pooled);
  snprintf(title, sizeof title, "%s: %s%s%s", z, quantity->exponent ? "fit to all runs of a point" : "mean over seeds",
           *pooled ? " and " : "", pooled);
  title[0] = (char)toupper((unsigned char)title[0]);
  charts_intervals(quantity->pooled, intervals, sizeof intervals);
  charts_resolution(store, quantity->name, "", resolution, sizeof resolution);
  if (map->widest > 0)
    snprintf(caption, sizeof caption, "At most \xc2\xb1 %.2g: %s; %s", map->widest, intervals, resolution);
  else
    snprintf(caption, sizeof caption, "No interval: one run a point; %s", resolution);
  return picture_map(page, &(struct picture_words){title, caption, x, y}, z, map->count,
                     (const double(*)[3])map->points, error);
}

status map_tiles_draw(struct store *store, const char *x, const char *y, const char *quantity,
                      const struct picture_page *page, struct error *error) {
  struct map_tiles map = {.points = malloc(MOST_GROUPS * sizeof *map.points)};
  if (!map.points)
    return status_fail(error, STATUS_MEMORY, "out of memory");

  const struct quantity_choice choice = {.axis = {x, y},
                                         .name = quantity,
                                         .newest = true,
                                         .refusal = "a map needs two different inputs (--x, --y) and one quantity"};
  status code = quantity_read(store, &choice, &map.quantity, add, &map, error);
  if (code == STATUS_OK)
    code = draw(store, &map, page, error);
  if (code == STATUS_OK)
    quantity_tell_resolution(store, quantity, map.quantity.pooled);
  free(map.points);
  return code;
}
