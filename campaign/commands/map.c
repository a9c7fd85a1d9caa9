/* `clast map STORE PICTURE`: a quantity over two varied inputs, as a picture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"
#include "db/ask/point.h"

enum {
  WIDTH = 900,
  MOST_GROUPS = 10000,
  MEAN_COLUMN = 7
}; /* x, y, engine, results_version, n, failed, censored, mean */

struct options {
  const char *x, *y, *quantity;
};

struct map {
  struct store *store;
  char name[2][256]; /* column names of the axes */
  double (*points)[3];
  size_t count;
  bool exponent;
  enum exponent_method method;
  enum estimates_window window;
};

static status take_columns(void *context, size_t count, const char *const *names, struct error *error) {
  struct map *map = context;
  if (count <= MEAN_COLUMN || strcmp(names[0], names[1]) == 0)
    return status_fail(error, STATUS_USAGE, "a map needs two different axes");
  for (int i = 0; i < 2; i++)
    snprintf(map->name[i], sizeof map->name[i], "%s", names[i]);
  return STATUS_OK;
}

static status add(struct map *map, const struct query_value *x, const struct query_value *y, double value,
                  struct error *error) {
  if (map->count == MOST_GROUPS)
    return status_fail(error, STATUS_USAGE, "a map of more than %d points cannot be read", MOST_GROUPS);
  if ((x->kind != QUERY_REAL && x->kind != QUERY_INTEGER) || (y->kind != QUERY_REAL && y->kind != QUERY_INTEGER))
    return STATUS_OK; /* off, or does not apply: no place on an axis of numbers */
  for (size_t i = 0; map->exponent && i < map->count; i++)
    if (map->points[i][0] == x->real && map->points[i][1] == y->real)
      return status_fail(error, STATUS_USAGE,
                         "several points share %s = %g and %s = %g: their exponents are not averaged", map->name[0],
                         x->real, map->name[1], y->real);
  map->points[map->count][0] = x->real;
  map->points[map->count][1] = y->real;
  map->points[map->count++][2] = value;
  return STATUS_OK;
}

static status take_group(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  struct map *map = context;
  if (map->exponent)
    return STATUS_OK; /* only the names of the axes were wanted */
  return add(map, &values[0], &values[1], values[MEAN_COLUMN].real, error);
}

static status take_point(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count;
  struct map *map = context;
  struct pooled_exponent out;
  status code = point_exponent(map->store, values[2].integer, 0, map->method, map->window, 0, 0.95, &out, error);
  return code ? code : add(map, &values[0], &values[1], out.fit.beta, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  struct map map = {0};
  if (!options->x || !options->y)
    return status_fail(error, STATUS_USAGE, "a map needs --x and --y, two inputs that the campaign varied");
  status code = estimates_named(options->quantity, &map.exponent, &map.method, &map.window, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &map.store, error);
  if (code)
    return code;
  char by[600], sql[700], title[128];
  snprintf(by, sizeof by, "%s,%s", options->x, options->y);
  map.points = malloc(MOST_GROUPS * sizeof *map.points);
  if (!map.points)
    code = status_fail(error, STATUS_MEMORY, "out of memory");
  struct query_sink groups = {&map, take_columns, take_group}, points = {&map, NULL, take_point};
  if (!code)
    code = ask_group(map.store, by, map.exponent ? "largest_fraction" : options->quantity, &groups, error);
  if (!code && map.exponent) {
    snprintf(sql, sizeof sql, "select distinct \"%s\", \"%s\", point_id from points", map.name[0], map.name[1]);
    code = query_run(map.store, sql, 0, NULL, 0, &points, error);
  }
  bool pool = false;
  if (!code)
    code = rows_pool(map.store, map.name[0], map.name[1], &pool, error);
  snprintf(title, sizeof title, "%s%s, %s over seeds%s", map.exponent ? "exponent " : "", options->quantity,
           map.exponent ? "pooled" : "mean", pool && !map.exponent ? " and other inputs" : "");
  if (!code)
    code = picture_map_points(line->arguments[1], WIDTH, title, options->quantity, map.name[0], map.name[1], map.count,
                              (const double(*)[3])map.points, error);
  free(map.points);
  store_close(map.store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"x", 'x', OPTION_TEXT, "AXIS", offsetof(struct options, x), 0, 0, NULL,
     "Varied input along the bottom: a path or its unique ending."},
    {"y", 'y', OPTION_TEXT, "AXIS", offsetof(struct options, y), 0, 0, NULL, "Varied input along the side."},
    {"quantity", 'q', OPTION_TEXT, "NAME", offsetof(struct options, quantity), 0, 0, "largest_fraction",
     "Result to show: a column of the view runs, or an exponent pooled over the runs of a point: beta, or "
     "beta_METHOD_WINDOW (beta_binned_from_2)."},
};

const struct command map_command = {
    .name = "map",
    .group = "results",
    .arguments = "STORE PICTURE.png",
    .summary = "a quantity over two varied inputs as a picture",
    .doc = "Draws the mean over seeds of a result, or the exponent pooled over seeds, as a tile for every pair of "
           "values of\n"
           "two varied inputs. Pairs without a usable run are crossed. The ending chooses the format, .png or .svg.",
    .examples = "clast map out.db map.png -x strain -y angle\nclast map out.db beta.svg -x strain -y angle -q beta",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
