/* Charts by gnuplot: a template, its words and numbers, and the data. The functions are for picture.c only.
 *
 * The templates are analysis/pictures/templates/NAME.gp. They are compiled in. A chart becomes a script (its variables,
 * then frame.gp, then the template) and a file of numbers in a separate folder, where gnuplot runs. The script holds
 * text from users, such as the names of campaigns, only as quoted strings that gnuplot does not interpret, and it names
 * only files of that folder. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

/* Output of a chart. */
struct picture_page {
  const char *path;
  double width;
  bool keep_script; /* keep NAME.gp and NAME.dat beside NAME.png, so that gnuplot can draw it again */
};
/* The words of a chart; NULL: none. Long ones are cut into lines. */
struct picture_words {
  const char *title, *caption; /* caption: a line under the title, in small letters */
  const char *x, *y;           /* names of the axes with their units */
};

struct chart; /* opaque */

/* `template`: "lines" for templates/lines.gp. Sets the title, the line under it and the names of both
 * axes, cut into lines that fit the page. Template and page are borrowed until the chart is drawn. */
struct chart *chart_new(const char *template, const struct picture_page *page, const struct picture_words *words);
/* Sets a variable of the script. Text: line ends stay, other control characters become blanks, bytes that are no UTF-8
 * become '?'. NULL is "". */
void chart_text(struct chart *chart, const char *name, const char *text);
void chart_number(struct chart *chart, const char *name, double value);
/* Sets an array of `count` texts; gnuplot's first index is 1. texts[i] may be NULL. */
void chart_texts(struct chart *chart, const char *name, size_t count, const char *const *texts);
/* Sets an array of `count` numbers. */
void chart_numbers(struct chart *chart, const char *name, size_t count, const double *values);
/* Sets the legend of `count` labels below the frame (array `label`), with its number of columns and the lines of its
 * longest label. Returns its height in pixels. */
double chart_legend(struct chart *chart, size_t count, const char *const *labels);
/* Sets the names of `count` bars (array `place`): in lines that fit, or turned where a word does not. Returns the
 * height in pixels that they take beyond one line. */
double chart_places(struct chart *chart, size_t count, const char *const *places);

/* The number of characters of a UTF-8 text, not of bytes. */
size_t chart_letters(const char *text);

/* Numbers of the data file. A value that is not finite is written as NaN. chart_block_end ends a block: the template
 * reads block b by `index b`, from 0. chart_columns writes a comment that names the columns. */
void chart_columns(struct chart *chart, const char *names);
void chart_row(struct chart *chart, size_t count, const double *values);
void chart_block_end(struct chart *chart);

/* Draws and frees the chart. The file appears under its name only when it is complete. height: pixels for the width of
 * the page. STATUS_MISSING: no gnuplot on this machine. STATUS_USAGE: the file name's ending is not known. STATUS_IO.
 */
status chart_draw(struct chart *chart, double height, struct error *error);

/* The compiled-in templates (generated at build time); an entry with NULL ends the list. */
struct chart_template {
  const char *name, *text;
};
extern const struct chart_template chart_templates[];
