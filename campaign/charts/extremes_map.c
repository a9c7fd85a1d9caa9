/* Makes rows of tiles from the rows of a store. Inputs with more than ten values are divided into ten ranges. */
#include "campaign/charts/charts.h"

#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "db/ask/ask.h"
#include "schemas/memory.h"

enum { TILES = 10, MOST_ROWS = 400, NAME = 128 };

struct value {
  char text[24];
  double runs[3];
};
struct row { /* one input of one campaign */
  char campaign[NAME], path[NAME];
  size_t count;
  struct value *value; /* ascending; owned */
  struct picture_margin_tile tile[TILES];
};
struct collecting {
  struct row *row;
  size_t count;
};

static status add_value(struct row *row, const struct answer *runs, struct error *error) {
  if ((row->count & (row->count + 1)) == 0) { /* 1, 3, 7...: grows */
    struct value *grown = realloc(row->value, (2 * row->count + 1) * sizeof *grown);
    if (!grown)
      return status_fail(error, STATUS_MEMORY, "no memory for the values of %s", row->path);
    row->value = grown;
  }
  struct value *value = &row->value[row->count++];
  if (answer_value(runs, 2).kind == QUERY_TEXT)
    snprintf(value->text, sizeof value->text, "%s", answer_text(runs, 2));
  else
    snprintf(value->text, sizeof value->text, "%.8g", answer_real(runs, 2)); /* keeps 1.0000001 different from 1 */
  for (size_t c = 0; c < 3; c++)
    value->runs[c] = answer_real(runs, 3 + c);
  return STATUS_OK;
}

static status add_row(struct collecting *all, const struct answer *runs, struct error *error) {
  const char *campaign = answer_text(runs, 0), *path = answer_text(runs, 1);
  struct row *last = all->count ? &all->row[all->count - 1] : NULL;
  if (last && !strncmp(last->campaign, campaign, NAME - 1) && !strncmp(last->path, path, NAME - 1))
    return add_value(last, runs, error);
  if (all->count == MOST_ROWS)
    return status_fail(error, STATUS_USAGE, "more than %d varied inputs in one picture", MOST_ROWS);
  struct row *row = &all->row[all->count++];
  snprintf(row->campaign, sizeof row->campaign, "%s", campaign);
  snprintf(row->path, sizeof row->path, "%s", path);
  return add_value(row, runs, error);
}

/* Makes a tile per value or per range of values. The tile of a range shows the range's first value. */
static size_t make_tiles(struct row *row) {
  const size_t tiles = row->count < TILES ? row->count : TILES;
  for (size_t v = 0; v < row->count; v++) {
    const size_t t = v * tiles / row->count;
    struct picture_margin_tile *tile = &row->tile[t];
    if (!tile->text[0] && row->count <= TILES)
      snprintf(tile->text, sizeof tile->text, "%s", row->value[v].text);
    else if (!tile->text[0])
      snprintf(tile->text, sizeof tile->text, "from %.3g", strtod(row->value[v].text, NULL));
    for (int c = 0; c < 3; c++)
      tile->runs[c] += row->value[v].runs[c];
  }
  return tiles;
}

static status draw(const struct collecting *all, const char *path, double width, struct error *error) {
  OWNED struct picture_margin *margin = calloc(all->count + 1, sizeof *margin);
  if (!margin)
    return status_fail(error, STATUS_MEMORY, "no memory for the picture");
  for (size_t k = 0; k < all->count; k++) {
    struct row *row = &all->row[k];
    const bool begins = k == 0 || strcmp(row->campaign, all->row[k - 1].campaign) != 0;
    margin[k] = (struct picture_margin){.heading = begins ? row->campaign : NULL, .label = row->path};
    margin[k].count = make_tiles(row);
    margin[k].tile = row->tile;
  }
  return picture_margins(path, width, "Safe, warned and refused runs by input (SI units)", all->count, margin, error);
}

status extremes_map_draw(struct store *store, const char *path, double width, struct error *error) {
  struct collecting all = {.row = calloc(MOST_ROWS, sizeof *all.row)};
  if (!all.row)
    return status_fail(error, STATUS_MEMORY, "no memory for the picture");
  ANSWER runs = ask_campaign_values(store, error);
  status code = STATUS_OK;
  while (code == STATUS_OK && answer_next(&runs))
    code = add_row(&all, &runs, error);
  if (code == STATUS_OK)
    code = answer_end(&runs);
  if (code == STATUS_OK)
    code = draw(&all, path, width, error);
  for (size_t k = 0; k < all.count; k++)
    free(all.row[k].value);
  free(all.row);
  return code;
}
