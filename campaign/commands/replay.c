/* `clast replay STORE RUN`: computes a stored run again and compares every bit. */
#include "campaign/commands/commands.h"
#include "campaign/one_run/one_run.h"

struct options {
  const char *fields;
};

/* Prints the table of differences. For people it is left out when nothing differs. */
static status print_differences(struct store *store, int64_t run_id, const struct engine_kind *kind,
                                const struct run_result *result, enum table_format format,
                                struct replay_compare *comparison, struct error *error) {
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"result", "stored", "recomputed", NULL});
  TRY(replay_compare(store, run_id, kind, result, table, comparison, error));
  return table_for_people(format) && comparison->different == 0 ? STATUS_OK : table_end(table, error);
}

/* Explains the result of the comparison to people. */
static void tell(int64_t run_id, const struct ask_run *stored, const struct replay_compare *comparison,
                 size_t fragments) {
  char build[PROVENANCE_BUILD_SIZE];
  provenance_other_build(stored->version, stored->commit, stored->compiler, build);
  if (*build)
    fprintf(stderr, "run %" PRId64 " was made by another build (%s); both make results version %" PRId64 "\n", run_id,
            build, stored->results_version);
  if (comparison->absent)
    fprintf(stderr, "clast: %zu result%s not compared: the program that stored the run did not store %s\n",
            comparison->absent, comparison->absent == 1 ? "" : "s", comparison->absent_names);
  if (comparison->different == 0)
    fprintf(stderr, "run %" PRId64 ": %zu results and %zu fragment masses agree to the last bit\n", run_id,
            comparison->compared - 1, fragments);
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const int64_t run_id = strtoll(line->arguments[1], NULL, 10);
  __attribute__((cleanup(ask_run_release))) struct ask_run stored = {0};
  SCENE scene = NULL;
  RUN_RESULT result = {0};
  struct replay_compare comparison = {0};
  TRY(ask_run_read(store, run_id, &stored, error));
  TRY(replay_compute(&stored, run_id, options->fields, &scene, &result, error));
  TRY(print_differences(store, run_id, scene->kind, &result, line->format, &comparison, error));
  tell(run_id, &stored, &comparison, result.fragment_count);
  const bool promised = !scene->kind->definition || scene->kind->same_bits;
  TRY(replay_verdict(store, run_id, &stored, &comparison, promised, error));
  if (comparison.different && !promised)
    fprintf(stderr, "clast: %zu of %zu results differ; the scene's program promises no bits (same_bits)\n",
            comparison.different, comparison.compared);
  if (options->fields && result.outcome.state == OUTCOME_INVALID)
    fprintf(stderr, "clast: the run is invalid and has no fields: %s is not written\n", options->fields);
  return STATUS_OK;
}

static status check(const struct command_line *line, struct error *error) {
  const char *number = line->arguments[1];
  if (strspn(number, "0123456789") != strlen(number))
    return status_fail(error, STATUS_USAGE, "RUN is a number (run_id in the store), got \"%.64s\"", number);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_OUTPUT(OPTION_OUTPUT, "fields", 0, "FILE.h5", struct options, fields),
};

COMMAND(replay, "the store", "STORE RUN", .computes = true, COMMAND_OPTIONS(struct options, rows), .has_table = true,
        .check = check, .ask = ask);
