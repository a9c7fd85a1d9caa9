/* What `clast picture` draws: the body of a fields file, or a profile. */
#ifndef CLAST_CAMPAIGN_CHARTS_PICTURE_DRAW_H
#define CLAST_CAMPAIGN_CHARTS_PICTURE_DRAW_H

#include "campaign/terminal/chart_option.h"

/* The options of the command; NULL: not given. */
struct picture_choice {
  const char *caption, *what, *view, *axis, *at;
  struct chart_options chart; /* options of a profile's chart */
  double width;               /* width of a body's picture, pixels; 0: default */
};

/* STATUS_USAGE: options that do not suit the file; also the statuses of analysis/pictures/picture.h. */
status picture_draw(const char *fields, const char *picture, const struct picture_choice *options, struct error *error);

#endif
