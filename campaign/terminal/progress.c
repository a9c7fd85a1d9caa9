/* The progress bar of a terminal, or plain lines for a log. */
#include "campaign/terminal/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "campaign/terminal/table.h"
#include "schemas/memory.h"

#define SOON 2.0 /* s */

struct progress {
  FILE *out;
  enum progress_style style;
  bool colour, drawn;
  int columns;
  double last_time; /* time of the last line or redraw */
  int last_share;   /* twentieths reported so far (plain lines) */
};

static int file_of(FILE *out) {
  return out == stderr ? STDERR_FILENO : fileno(out); /* stderr may be wrapped: words.h */
}

enum progress_style progress_style_of(FILE *out) {
  const char *term = getenv("TERM");
  return isatty(file_of(out)) && term && *term && strcmp(term, "dumb") != 0 ? PROGRESS_BAR : PROGRESS_PLAIN;
}

struct progress *progress_create(FILE *out, enum progress_style style, bool colour, int columns) {
  struct progress *progress = memory_small(1, sizeof *progress);
  *progress = (struct progress){out, style, colour, false, columns, -HUGE_VAL, -1};
  return progress;
}

static int width(const struct progress *progress) {
  struct winsize size;
  if (progress->columns > 0)
    return progress->columns;
  if (ioctl(file_of(progress->out), TIOCGWINSZ, &size) == 0 && size.ws_col >= 20)
    return size.ws_col < 100 ? size.ws_col : 100;
  return 80;
}

void progress_duration(double seconds, char *buffer, size_t size) {
  const long long whole = seconds >= 0 ? llround(fmin(seconds, 1e15)) : 0;
  if (!(seconds >= 0) || isinf(seconds))
    snprintf(buffer, size, "?");
  else if (seconds > 0 && seconds < 0.0995)
    snprintf(buffer, size, "%.2g ms", 1e3 * seconds);
  else if (seconds < 9.95)
    snprintf(buffer, size, "%.1f s", seconds);
  else if (whole < 60)
    snprintf(buffer, size, "%lld s", whole);
  else if (whole < 3600)
    snprintf(buffer, size, "%lld min %02lld s", whole / 60, whole % 60);
  else if (whole < 48 * 3600)
    snprintf(buffer, size, "%lld h %02lld min", whole / 3600, whole / 60 % 60);
  else
    snprintf(buffer, size, "%lld d %02lld h", whole / 86400, whole / 3600 % 24);
}

/* The facts, without bar: "120 of 400 runs, 2 failed, 4 running, 3.1 runs/s, 1 min 30 s left, largest_fraction 0.312 +-
 * 0.008 (seeds, 95 %)" */
static void facts(const struct progress_state *state, char *buffer, size_t size) {
  char left[32], failed[48] = "", rate[48] = "", time[64] = "", mean[128] = "", rule[160] = "";
  progress_duration(state->seconds_left, left, sizeof left);
  if (state->failed)
    snprintf(failed, sizeof failed, ", %lld failed", (long long)state->failed);
  if (state->rate > 0)
    snprintf(rate, sizeof rate, state->rate < 10 ? ", %.2g runs/s" : ", %.0f runs/s", state->rate);
  if (state->seconds_left > 0) /* 0: what runs has taken longer than predicted */
    snprintf(time, sizeof time, ", %s left", left);
  if (state->quantity && isfinite(state->mean.mean)) {
    char both[UNCERTAINTY_TEXT];
    uncertainty_seeds(&state->mean, both);
    snprintf(mean, sizeof mean, ", %.60s %.60s%s", state->quantity, both, state->doubtful ? " !" : "");
  }
  const char *unit = state->unit ? state->unit : "";
  char point[32] = "";
  if (state->point)
    snprintf(point, sizeof point, " at point %lld", (long long)state->point);
  char least[48] = "";
  if (state->reached <= state->asked)
    snprintf(least, sizeof least, " of at least %lld runs", (long long)state->least);
  if (state->reached > 0)
    snprintf(rule, sizeof rule, ", the rule's interval%s \xc2\xb1 %.2g%s (asked %.2g%s%s)", point, state->reached, unit,
             state->asked, unit, least);
  snprintf(buffer, size, "%lld of %s%lld runs%s%s, %d running%s%s%s%s", (long long)state->done,
           state->total_is_minimum ? "at least " : "", (long long)state->total, state->part ? " of this round" : "",
           failed, (int)state->running, rate, time, mean, rule);
}

static double share_of(const struct progress_state *state) {
  return state->total > 0 ? fmin((double)state->done / (double)state->total, 1) : 1;
}

/* Cut to `columns` characters (not bytes: the text holds a plus-minus sign). */
static void cut(char *text, int columns) {
  int seen = 0;
  for (char *c = text; *c; c++) {
    if (((unsigned char)*c & 0xC0) == 0x80)
      continue; /* a continuation byte of UTF-8 */
    if (seen++ == columns) {
      *c = '\0';
      return;
    }
  }
}

static void draw_bar(struct progress *progress, const struct progress_state *state) {
  enum { BAR = 20 };
  char text[512], bar[BAR * 3 + 1] = "";
  int full = (int)floor(share_of(state) * BAR);
  for (int i = 0; i < BAR; i++)
    text_append(bar, sizeof bar, "%s", i < full ? "━" : "╌");
  facts(state, text, sizeof text);
  int room = width(progress) - 1 - BAR - 6; /* the last column stays free: some terminals wrap there */
  cut(text, room > 0 ? room : 0);
  const char *on = progress->colour ? (state->failed ? "\033[33m" : "\033[32m") : "",
             *off = progress->colour ? "\033[0m" : "";
  fprintf(progress->out, "\r\033[K%s%s%s %3d%% %s", on, bar, off, (int)floor(share_of(state) * 100), text);
  fflush(progress->out);
  progress->drawn = true;
}

void progress_update(struct progress *progress, const struct progress_state *state, double now, bool last) {
  if (progress->style == PROGRESS_BAR) {
    if (!last && now - progress->last_time < 0.1)
      return;
    draw_bar(progress, state);
    progress->last_time = now;
    return;
  }
  int share = (int)floor(share_of(state) * 20);
  bool first = progress->last_share < 0; /* the first update prints no line */
  if (first)
    progress->last_time = now;
  const bool soon = state->part && now - progress->last_time < SOON;
  if ((!last || state->part) && (first || soon || share <= progress->last_share) && now - progress->last_time < 60) {
    if (first || share < progress->last_share) /* the next campaign of a study */
      progress->last_share = share;
    return;
  }
  char text[512];
  facts(state, text, sizeof text);
  fprintf(progress->out, "%3d%%  %s\n", (int)floor(share_of(state) * 100), text);
  fflush(progress->out);
  progress->last_share = share;
  progress->last_time = now;
}

void progress_note(struct progress *progress, const char *text) {
  if (progress->drawn)
    fputs("\r\033[K", progress->out);
  progress->drawn = false;
  fprintf(progress->out, "clast: %s\n", text);
  fflush(progress->out);
}

void progress_free(struct progress *progress) {
  if (!progress)
    return;
  if (progress->drawn)
    fputc('\n', progress->out);
  fflush(progress->out);
  free(progress);
}
