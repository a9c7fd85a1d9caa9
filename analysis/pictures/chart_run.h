/* Runs gnuplot on a script in a temporary folder and moves the picture out of it. For chart.c only. */
#ifndef CLAST_ANALYSIS_PICTURES_CHART_RUN_H
#define CLAST_ANALYSIS_PICTURES_CHART_RUN_H

#include "analysis/pictures/picture.h"

/* One chart as files: NAME.gp and NAME.dat for the picture NAME.png. */
struct chart_run_files {
  const char *script, *data; /* their contents */
  size_t script_size, data_size;
};
/* The name of the picture without its folder and its ending, for the script. */
void chart_run_stem(const char *path, char *stem, size_t size);
/* Makes a folder beside the picture, writes both files, runs gnuplot there, moves the picture (with page->keep_script
 * the files, too) to its place and removes the folder. Statuses as chart_draw(). */
status chart_run(const struct picture_page *page, const struct chart_run_files *files, struct error *error);

#endif
