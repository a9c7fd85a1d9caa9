/* Progress of a campaign on stderr: on a terminal one line redrawn at most ten times a second, otherwise a plain line
 * per 5 % or per minute, so that a batch log stays short. Colour follows NO_COLOR, TERM=dumb and `--color`. */
#ifndef CLAST_CAMPAIGN_TERMINAL_PROGRESS_H
#define CLAST_CAMPAIGN_TERMINAL_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct progress_state {
  int64_t done; /* runs finished, found ones included */
  int64_t failed, running;
  int64_t total;           /* at least this many (exactly, without `until`) */
  bool total_is_minimum;   /* `until`: more may come */
  double rate;             /* runs/s of this invocation; NaN = not known yet */
  double seconds_left;     /* NaN = not known yet */
  const char *quantity;    /* the main quantity's name */
  double mean, half_width; /* of it over the runs so far, 95 %; NaN = none yet, or runs of several points */
};

enum progress_style { PROGRESS_PLAIN, PROGRESS_BAR };

struct progress;
/* PROGRESS_BAR when `out` is a terminal that can (TERM set and not dumb). */
enum progress_style progress_style_of(FILE *out);
/* `out` is borrowed. columns: width of the terminal, 0 = ask it. NULL when memory is out. */
struct progress *progress_create(FILE *out, enum progress_style style, bool colour, int columns);
/* now: seconds of any monotonic clock. Draws only when it is time to, or when `last`. */
void progress_update(struct progress *progress, const struct progress_state *state, double now, bool last);
/* A line for a person that does not get mixed up with the bar. */
void progress_note(struct progress *progress, const char *text);
void progress_free(struct progress *progress); /* ends the bar's line. NULL is fine */

/* "2 min 05 s", "3 h 20 min", "0.4 s"; "?" for NaN. Returns length as snprintf. */
int progress_duration(double seconds, char *buffer, size_t size);

#endif
