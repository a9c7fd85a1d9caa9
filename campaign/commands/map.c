/* `clast map STORE PICTURE`: a quantity over two varied inputs, as a picture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "analysis/pictures/picture.h"
#include "campaign/commands/commands.h"
#include "campaign/commands/quantity.h"

enum { WIDTH = 900, MOST_GROUPS = 10000 };

struct options {
  const char *x, *y, *quantity;
};

struct map {
  struct quantity quantity;
  double (*points)[3]; /* x, y, value */
  size_t count;
  double widest; /* half width of the widest interval; 0: there is none */
};

static bool is_number(const struct query_value *value) {
  return value->kind == QUERY_REAL || value->kind == QUERY_INTEGER;
}

static status add(void *context, const struct quantity_row *row, struct error *error) {
  struct map *map = context;
  if (map->count == MOST_GROUPS)
    return status_fail(error, STATUS_USAGE, "a map of more than %d points cannot be read", MOST_GROUPS);
  if (!is_number(&row->input[0]) || !is_number(&row->input[1]))
    return STATUS_OK; /* off, or does not apply: it has no place on an axis of numbers */

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

static status draw(struct store *store, const struct options *options, const char *path, struct error *error) {
  struct map map = {.points = malloc(MOST_GROUPS * sizeof *map.points)};
  if (!map.points)
    return status_fail(error, STATUS_MEMORY, "out of memory");

  const struct quantity_choice choice = {.axis = {options->x, options->y},
                                         .name = options->quantity,
                                         .newest = true,
                                         .refusal = "a map needs two different inputs (--x, --y) and one quantity"};
  const struct quantity *quantity = &map.quantity;
  status code = quantity_read(store, &choice, &map.quantity, add, &map, error);
  if (code == STATUS_OK) {
    char title[ASK_GROUP_POOLED + 256], interval[64] = "";
    if (map.widest > 0)
      snprintf(interval, sizeof interval, " (at most \xc2\xb1 %.2g, 95 %%)", map.widest);
    snprintf(title, sizeof title, "%s%s, %s over seeds%s%s%s", quantity->exponent ? "exponent " : "", options->quantity,
             quantity->exponent ? "pooled" : "mean", *quantity->pooled ? " and " : "", quantity->pooled, interval);
    code = picture_map(path, WIDTH, title, options->quantity, quantity->column[0], quantity->column[1], map.count,
                       (const double(*)[3])map.points, error);
  }
  if (code == STATUS_OK)
    quantity_tell_resolution(store, options->quantity, quantity->pooled);
  free(map.points);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (!options->x || !options->y)
    return status_fail(error, STATUS_USAGE, "a map needs --x and --y, two inputs that the campaign varied");

  struct store *store = NULL;
  status code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = draw(store, options, line->arguments[1], error);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    QUANTITY_AXIS_OPTION(struct options, x),
    OPTION_ROW_TEXT("y", 'y', "AXIS", struct options, y, NULL, "Varied input on the vertical axis."),
    QUANTITY_OPTION(struct options, quantity),
};

const struct command map_command = {
    .name = "map",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over two varied inputs as a picture",
    .doc = "Draws the mean of a result over seeds, or an exponent fitted to the runs of a point, as a tile for every\n"
           "pair of values of two varied inputs. A pair without a usable run is crossed out. The title tells\n"
           "the widest 95 % interval. The ending chooses the\n"
           "format: .png or .svg.",
    .examples = "clast map out.db map.png -x strain -y angle\nclast map out.db beta.svg -x strain -y angle -q beta",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
