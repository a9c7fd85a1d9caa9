/* Shared by the commands that draw charts: their options, and the names of quantities for people. */
#ifndef CLAST_CAMPAIGN_TERMINAL_CHART_OPTION_H
#define CLAST_CAMPAIGN_TERMINAL_CHART_OPTION_H

#include "analysis/pictures/picture.h"
#include "campaign/terminal/option.h"
#include "db/store/store.h"

struct chart_options {
  bool keep_script;
  const char *templates;
};
/* clang-format off */
#define CHART_OPTIONS(type_, member_)                                                                                  \
  OPTION_ROW_FLAG("keep-script", 0, type_, member_.keep_script,                                                        \
                  "Leave NAME.gp and NAME.dat beside the chart NAME.png: change them, and gnuplot draws it again."),   \
  OPTION_ROW_TEXT("templates", 0, "FOLDER", type_, member_.templates, NULL,                                            \
                  "Draw with the gnuplot templates of this folder: your changed copies of share/clast/templates.")
/* clang-format on */

/* A page of the usual width. */
struct picture_page chart_option_page(const char *path, const struct chart_options *options);

/* The name of a column of the views by its row: "mass share of the largest fragment M₁/M"; of an exponent "exponent β
 * of F(m)". Without a row: the words of the column. */
enum { CHART_OPTION_LABEL = 300 };
void chart_option_label(const char *column, char label[CHART_OPTION_LABEL]);
/* The same with the unit in the store: "impact speed (m/s)". */
status chart_option_axis(struct store *store, const char *column, char label[CHART_OPTION_LABEL], struct error *error);
/* The paths of inputs, separated by ", ", as their names: "impact speed, weibull m". */
void chart_option_labels(const char *paths, char *labels, size_t size);
/* "95 % intervals over seeds", or over points that differ in the pooled inputs (of ask_group; "": none). */
void chart_option_intervals(const char *pooled, char *text, size_t size);
/* Describes the known error of the resolution of a quantity at the points of the store, after `adds` if there is
 * one. */
void chart_option_resolution(struct store *store, const char *quantity, const char *adds, char *text, size_t size);

#endif
