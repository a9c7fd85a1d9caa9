/* Names of quantities, and the page of a chart. */
#include "campaign/charts/charts.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

enum { WIDTH = 900 };

struct picture_page charts_page(const char *path, const struct chart_options *options) {
  return (struct picture_page){path, WIDTH, options && options->keep_script};
}

void charts_label(const char *column, char label[CHARTS_LABEL]) {
  if (strncmp(column, "beta", 4) == 0 && (column[4] == '\0' || column[4] == '_')) {
    snprintf(label, CHARTS_LABEL, "exponent \xce\xb2 of F(m) ~ m^-\xce\xb2");
    return;
  }
  char plain[256];
  field_column_name(column, plain, sizeof plain);
  const struct field *row = field_of_column(&outcome_table, plain);
  for (int input = 0; input < 2 && !row; input++) {
    const char *name = strncmp(plain, "input_", 6) == 0 ? plain + 6 : plain; /* an input with the name of a result */
    for (size_t i = 0; i < engine_count() && !row; i++)
      row = field_of_column(input ? engine_at(i)->inputs : engine_at(i)->results, input ? name : plain);
  }
  if (row)
    field_label(row, label, CHARTS_LABEL);
  else
    field_label_path(column, label, CHARTS_LABEL);
}

status charts_scene(struct store *store, char scene[CHARTS_LABEL], struct error *error) {
  char names[CHARTS_LABEL];
  *scene = '\0';
  TRY(ask_points_scenes(store, names, sizeof names, error));
  if (*names && !strchr(names, ','))
    text_append(scene, CHARTS_LABEL, ", %s", names);
  return STATUS_OK;
}

status charts_axis(struct store *store, const char *column, char label[CHARTS_LABEL], struct error *error) {
  char shown[96];
  struct ask_column written;
  status code = ask_columns_written(store, column, &written, error);
  charts_label(column, label);
  field_label_unit(written.unit, shown, sizeof shown);
  if (*shown)
    text_append(label, CHARTS_LABEL, " (%s)", shown);
  return code;
}

void charts_labels(const char *paths, char *labels, size_t size) {
  labels[0] = '\0';
  while (*paths) {
    char path[256], label[CHARTS_LABEL];
    paths = text_next_item(paths, path, sizeof path);
    charts_label(path, label);
    text_append(labels, size, "%s%s", *labels ? ", " : "", label);
  }
}

void charts_intervals(const struct ask_group_pooled *pooled, char *text, size_t size) {
  char names[ASK_GROUP_POOLED];
  charts_labels(pooled->inputs, names, sizeof names);
  snprintf(text, size, "95 %% intervals over %s%s%s%s", *names ? "points that differ in " : "seeds", names,
           *names && pooled->single ? " (of a mark of one point: over seeds)" : "",
           *names && pooled->lacks_seeds ? ", without what a seed changes at all points alike" : "");
}

void charts_resolution(struct store *store, const char *quantity, const char *adds, char *text, size_t size) {
  struct ask_resolution resolution;
  char words[UNCERTAINTY_TEXT] = "resolution: not known";
  const char *after = "";
  if (ask_resolution(store, 0, quantity, &resolution, NULL) == STATUS_OK) {
    uncertainty_resolution(&resolution, words);
    if (resolution.studied > 0)
      after = adds;
  }
  snprintf(text, size, "%s%s", words, after);
}

/* Appends ": coarse, early (2 runs)": the words that withhold a value, or those that mark one that is drawn. */
static void append_words(const struct ask_doubts *doubts, bool withheld, int64_t of, char *text, size_t size) {
  const char *before = ":";
  for (size_t k = 0; k < doubts->count; k++) { /* rows of one word can share runs: the most of one of them */
    int64_t runs = 0;
    bool told = false;
    for (size_t i = 0; i < doubts->count; i++) {
      const struct ask_doubt *doubt = &doubts->word[i];
      if (strcmp(doubt->word, doubts->word[k].word) != 0 || (withheld && !(doubt->row && doubt->row->withheld)))
        continue;
      told |= i < k;
      const int64_t these = withheld || doubts->withheld == 0 ? doubt->runs : doubt->runs - doubt->withheld;
      runs = these > runs ? these : runs;
    }
    if (told || runs == 0)
      continue;
    text_append(text, size, "%s %s", before, doubts->word[k].word);
    before = ",";
    if (runs < of)
      text_append(text, size, " (%" PRId64 " run%s)", runs, text_plural(runs));
  }
}

void charts_doubts(struct store *store, const struct ask_doubts *doubts, char *text, size_t size) {
  const int64_t withheld = doubts->withheld, drawn = doubts->runs - withheld, marked = doubts->doubtful - withheld;
  int64_t missing = 0, wanted;
  if (doubts->chosen && *doubts->chosen)
    text_append(text, size, "%sonly %s", *text ? "; " : "", doubts->chosen);
  if (doubts->excluded > 0)
    text_append(text, size, "%s%" PRId64 " run%s excluded", *text ? "; " : "", doubts->excluded,
                doubts->excluded == 1 ? "" : "s");
  if (store && ask_run_missing(store, &missing, &wanted, NULL) == STATUS_OK && missing > 0)
    text_append(text, size, "%s%" PRId64 " of %" PRId64 " runs gave no result", *text ? "; " : "", missing, wanted);
  if (withheld > 0) {
    text_append(text, size, "%swithheld, %" PRId64 " of %" PRId64 " runs", *text ? "; " : "", withheld, doubts->runs);
    append_words(doubts, true, withheld, text, size);
  }
  if (marked > 0) {
    text_append(text, size, "%s! in doubt, %" PRId64 " of %" PRId64 " runs%s", *text ? "; " : "", marked, drawn,
                withheld > 0 ? " drawn" : "");
    append_words(doubts, false, marked, text, size);
  }
}
