/* `clast merge TARGET SOURCE...`: merges stores from several machines into one. */
#include "campaign/commands/commands.h"
#include "campaign/scheduler/scheduler.h"

/* Adds one source. *differing counts the runs that both stores have with different results. */
static status merge_source(struct store *store, const char *target, const char *source, int64_t *differing,
                           struct error *error) {
  int64_t added = 0;
  *differing = 0;
  TRY(store_merge(store, source, &added, differing, error));
  fprintf(stderr, "%s: %" PRId64 " run%s added\n", source, added, text_plural(added));
  const int64_t excluded = store_merge_excluded(store);
  if (excluded)
    fprintf(stderr,
            "clast: warning: %s excludes %" PRId64
            " run%s that count%s in %s: `clast exclude %s` lists them with their "
            "reasons, `clast exclude %s RUN --reason TEXT` excludes one here, too\n",
            source, excluded, text_plural(excluded), excluded == 1 ? "s" : "", target, source, target);
  if (*differing)
    fprintf(stderr,
            "clast: warning: %s: %" PRId64 " run%s that %s has too gave other results there; those of %s were kept. "
            "Runs are the same bits on one binary and CPU class only: `clast replay STORE RUN` tells which store can "
            "be computed again here\n",
            source, *differing, text_plural(*differing), target, target);
  return STATUS_OK;
}

static status merge(struct store *store, const struct command_line *line, int64_t *disagreeing, struct error *error) {
  for (size_t i = 1; i < line->count; i++) {
    int64_t differing;
    TRY(merge_source(store, line->arguments[0], line->arguments[i], &differing, error));
    *disagreeing += differing;
  }
  return pooling_store(store, 0, error);
}

static status run(const struct command_line *line, struct error *error) {
  struct store *store = NULL;
  int64_t disagreeing = 0;
  char warning[512] = "";
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
