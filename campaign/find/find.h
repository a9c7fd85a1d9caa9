/* `clast find`: where a result crosses a level along one input. Rounds of runs, each a campaign of the store, are
 * chosen by analysis/inference/crossing.h. The rounds depend only on the document and the request, so that a repeated
 * command finds its runs in the store and goes on. */
#pragma once

#include "analysis/inference/crossing.h"
#include "campaign/charts/charts.h"
#include "campaign/launch/launch.h"

enum { FIND_WIDTHS = 24 };
enum { FIND_FEWEST_RUNS = CROSSING_FIRST * CROSSING_RUNS, FIND_MOST_RUNS = 5000 };

struct find_request { /* as on the command line; texts may be NULL */
  struct launch_options launch;
  struct option_list set;
  const char *quantity, *level, *share, *input, *from, *to, *within, *store, *picture;
  int64_t most_runs;
  struct chart_options chart;
};

struct find {
  struct campaign *campaign; /* owned */
  struct campaign limits;    /* what every round has; borrows from the campaign. Its one axis is the input */
  struct design_axis axis;
  struct scene *base; /* owned: the scene of every run but for the input */
  char reference[2 * FIELD_TEXT_SIZE];
  char words[1000]; /* the campaign's file and the options that choose its scene and store, for a command */
  const struct field *input;
  struct ask_specimens_quantity quantity;
  double level, share; /* SI; share: NaN for the mean */
  double from, to;     /* SI */
  bool logarithmic;
  double within; /* widest interval of an answer: SI, or a share of the bracket */
  bool relative;

  /* The runs so far. Owned. */
  size_t most, runs, failed;
  double *x, *y;
  bool *doubtful;
  struct crossing found;
  struct ask_doubts doubts;
  struct find_width {
    size_t runs;
    double width; /* of the interval after them, a share of the bracket */
  } width[FIND_WIDTHS];
  size_t widths;
  bool answered, narrow; /* no more rounds; the interval is as narrow as asked, or there is another answer */

  /* The round under way. */
  struct field_value place[CROSSING_FIRST];
  size_t places, each;
  void (*note)(void *context, const char *text);
  void *note_context;
};

/* Widest interval of an answer as a share of the bracket, for the interval found. An interval between neighbouring
 * whole numbers cannot become narrower. */
double find_widest(const struct find *find);

/* Value of the input at a place of the bracket, as a document can show it (to 1e-4 of the bracket's decade), and back.
 */
void find_value(const struct find *find, double x, struct field_value *value);
/* The unit in which places are round: the campaign's, else per cent, degrees or SI; and one of it in SI. */
double find_unit(const struct find *find, const char **shown);
double find_place(const struct find *find, const struct field_value *value);

/* The row of the level: a real number, as the mean of whole numbers need not be one, in the unit of tables. */
struct field find_level_row(const struct find *find);

/* The name of the rounds of all searches along the input. */
void find_name(const struct find *find, char *name, size_t size);

/* Reads the request, runs the rounds and, on rank 0, prints the answer. STATUS_USAGE: wrong input, level or bracket. */
status find_launch(const struct find_request *request, const struct command_line *line, struct error *error);

/* ---- find_print.c ---- */

/* For people a sentence and a table of the runs along the input. For programs a row per crossing. quiet: no remarks but
 * on runs in doubt. */
status find_print(const struct find *find, enum table_format format, bool quiet, struct error *error);
status find_print_picture(const struct find *find, const char *path, const struct chart_options *chart,
                          struct error *error);
/* A value of the input as people read it. */
enum { FIND_TEXT = 96 };
/* With the digits that a range of places allows, two of its width; its own ends are rounded outwards. */
const char *find_show_within(const struct find *find, double x, double low, double high, char text[FIND_TEXT]);
