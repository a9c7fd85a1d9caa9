/* The stability map of a store as a picture: how many runs are safe, warned and refused, for each value of each varied
 * input. */
#ifndef CLAST_CAMPAIGN_CHARTS_EXTREMES_MAP_H
#define CLAST_CAMPAIGN_CHARTS_EXTREMES_MAP_H

#include "db/store/store.h"

status extremes_map_draw(struct store *store, const char *path, double width, struct error *error);

#endif
