/* Progress of a campaign on stderr: on a terminal one line redrawn at most ten times a second, otherwise a plain line
 * per 5 % or per minute, so that a batch log stays short. Colour follows NO_COLOR, TERM=dumb and `--color`. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "analysis/statistics/statistics.h"

struct progress_state {
  int64_t done; /* finished runs, including those found in the store */
  int64_t failed, running;
  int64_t total;              /* least number of runs (exact without `until`) */
  bool total_is_minimum;      /* `until`: the total may grow */
  double rate;                /* runs/s of this invocation; NaN = not known yet */
  double seconds_left;        /* NaN = not known yet */
  const char *quantity;       /* the main quantity's name */
  struct sample_summary mean; /* of `quantity` over the runs so far; without an interval for runs of several points */
  double reached, asked; /* half width of the stopping rule's interval, the widest of the open points; 0: no rule */
  int64_t least;         /* runs that the rule asks for, however narrow its interval */
  int64_t point;         /* the point of that interval; 0: the only one */
  const char *unit;      /* of both, with a blank before it; NULL: none */
  bool doubtful;         /* some of these runs are in doubt: "!" behind the mean */
  bool part;             /* one of several campaigns, as of a study: plain lines come two seconds apart or later */
};

enum progress_style { PROGRESS_PLAIN, PROGRESS_BAR };

struct progress;
/* PROGRESS_BAR when `out` is a terminal that can redraw a line (TERM set and not dumb). */
enum progress_style progress_style_of(FILE *out);
/* `out` is borrowed. columns: width of the terminal, 0 = ask it. Never NULL. */
struct progress *progress_create(FILE *out, enum progress_style style, bool colour, int columns);
/* now: seconds of any monotonic clock. Draws only when it is time to, or when `last`. */
void progress_update(struct progress *progress, const struct progress_state *state, double now, bool last);
/* Prints a line for a person without disturbing the bar. */
void progress_note(struct progress *progress, const char *text);
void progress_free(struct progress *progress); /* ends the bar's line. NULL is fine */

/* "2 min 05 s", "3 h 20 min", "0.4 s"; "?" for NaN. */
void progress_duration(double seconds, char *buffer, size_t size);
