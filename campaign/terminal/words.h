/* Sentences for people, in lines that a terminal shows whole. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

/* A paragraph in lines of at most 100 columns, behind `head` and as far indented. */
void words_print(FILE *out, const char *head, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* From now on, all that is printed on stderr has lines of at most 100 columns, or the terminal's if that is narrower.
 * Commands in `...` stay whole, so that they can be copied. So do the place before an error, "FILE:LINE:COL: error: ",
 * which programs read, and the lines of a document below it. stderr has no fileno() from now on.
 *
 * apart: a launcher such as mpirun forwards stdout and stderr apart, so that the legend of a table could get into the
 * middle of it. Between a table and words there are then 0.2 s, in which the launcher forwards the first. */
void words_wrap_stderr(bool apart);

/* Call before a table for people is printed on stdout, and flush stdout after it. */
void words_before_table(void);
