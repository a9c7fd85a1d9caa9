/* `clast merge TARGET SOURCE...`: merges stores from several machines into one. */
#include "campaign/commands/commands.h"

/* Adds one source. *differing counts the runs that both stores have with different results. */
static status merge_source(struct store *store, const char *target, const char *source, int64_t *differing,
                           struct error *error) {
  int64_t added = 0;
  char source_word[TEXT_WORD], target_word[TEXT_WORD];
  *differing = 0;
  TRY(store_merge(store, source, &added, differing, error));
  fprintf(stderr, "%s: %" PRId64 " run%s added\n", source, added, text_plural(added));
  const int64_t excluded = store_merge_excluded(store, false), here = store_merge_excluded(store, true);
  if (excluded)
    fprintf(stderr,
            "clast: warning: %s excludes %" PRId64
            " run%s that count%s in %s: `clast exclude %s` lists them with their "
            "reasons, `clast exclude %s RUN --reason TEXT` excludes one here, too\n",
            source, excluded, text_plural(excluded), excluded == 1 ? "s" : "", target, text_word(source, source_word),
            text_word(target, target_word));
  if (here)
    fprintf(stderr,
            "clast: %" PRId64
            " run%s of %s stay%s excluded in %s: `clast exclude %s` lists them, `clast exclude %s RUN "
            "--undo` counts one again\n",
            here, text_plural(here), source, here == 1 ? "s" : "", target, text_word(target, target_word),
            text_word(target, target_word));
  if (*differing)
    fprintf(stderr,
            "clast: warning: %s: %" PRId64 " run%s that %s has too gave other results there; those of %s were kept. "
            "Runs are the same bits on one binary and CPU class only: `clast replay STORE RUN` tells which store can "
            "be computed again here\n",
            source, *differing, text_plural(*differing), target, target);
  return STATUS_OK;
}

/* Inputs in which campaigns of one scene differ become varied inputs, as when they are run into one store: tables show
 * them. A value that follows from other inputs in all campaigns is left out: it differs because those do. */
static status show_inputs(struct store *store, const char *target, struct error *error) {
  const struct field *rows[LIMITS_AXES_OF_POOL];
  char names[1024] = "";
  size_t count = 0;
  ANSWER different = ask_campaign_different_inputs(store, error);
  while (answer_next(&different) && count < LIMITS_AXES_OF_POOL) {
    const struct engine_kind *kind = engine_find(answer_text(&different, 0), NULL);
    const struct field *row = kind ? field_find(kind->inputs, answer_text(&different, 1), NULL) : NULL;
    if (!row || (count > 0 && rows[count - 1] == row) || scheduler_follows(answer_text(&different, 2), row))
      continue;
    rows[count++] = row;
    text_append(names, sizeof names, "%s%s", *names ? ", " : "", row->path);
  }
  TRY(answer_end(&different));
  for (size_t i = 0; i < count; i++)
    TRY(scheduler_show_input(store, rows[i], error));
  if (count == 0)
    return STATUS_OK;
  char numbers[ASK_CAMPAIGN_NUMBERS] = "", word[TEXT_WORD];
  TRY(ask_campaign_namesakes(store, NULL, numbers, sizeof numbers, error));
  fprintf(
      stderr,
      "clast: warning: campaigns of one scene, or forms of one campaign, differ in %s: %s of %s from now on (--by). "
      "`clast stats %s --campaign %.*s` takes one campaign alone%s%s%s\n",
      names, count == 1 ? "it is a varied input" : "they are varied inputs", target, text_word(target, word),
      *numbers ? (int)strcspn(numbers, ",") : (int)strlen("NAME"), *numbers ? numbers : "NAME",
      *numbers ? "; campaigns " : "", numbers, *numbers ? " have one name" : "");
  return STATUS_OK;
}

static status merge(struct store *store, const struct command_line *line, int64_t *disagreeing, struct error *error) {
  for (size_t i = 1; i < line->count; i++) {
    int64_t differing;
    TRY(merge_source(store, line->arguments[0], line->arguments[i], &differing, error));
    *disagreeing += differing;
  }
  TRY(show_inputs(store, line->arguments[0], error));
  return pooling_store(store, 0, error);
}

/* A missing source, or one that is no store, is told before the target is made. */
static status check_sources(const struct command_line *line, struct error *error) {
  for (size_t i = 1; i < line->count; i++) {
    struct store *source = NULL;
    TRY(store_open_reader(line->arguments[i], &source, error));
    TRY(store_close(source, error));
  }
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  struct store *store = NULL;
  int64_t disagreeing = 0;
  char warning[512] = "";
  TRY(check_sources(line, error));
  TRY(store_open_writer(line->arguments[0], &store, warning, sizeof warning, error));
  if (*warning)
    fprintf(stderr, "clast: %s\n", warning);
  status code = merge(store, line, &disagreeing, error);
  status closed = store_close(store, code ? NULL : error);
  if (code || closed)
    return code ? code : closed;
  if (disagreeing)
    return status_fail(error, STATUS_CONTENT, "merged, but %" PRId64 " run%s disagree between the stores", disagreeing,
                       text_plural(disagreeing));
  return STATUS_OK;
}

COMMAND(merge, "the store", "TARGET SOURCE...", .run = run);
