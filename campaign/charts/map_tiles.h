/* The tiles of `clast map`: a quantity over two inputs. */
#ifndef CLAST_CAMPAIGN_CHARTS_MAP_TILES_H
#define CLAST_CAMPAIGN_CHARTS_MAP_TILES_H

#include "campaign/charts/quantity.h"
#include "campaign/terminal/chart_option.h"

/* Reads the quantity over x and y and draws it. STATUS_USAGE: too many tiles, unknown names. */
status map_tiles_draw(struct store *store, const char *x, const char *y, const char *quantity,
                      const struct picture_page *page, struct error *error);

#endif
