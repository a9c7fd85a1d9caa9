/* `clast export STORE TARGET`: one compact file for hand-over, or a folder of CSV files. */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"

struct options {
  bool csv, bits;
};

static const char *const exported[] = {"runs", "points", "spectra", "estimates", "column_doc"};

static status write_view(struct store *store, const char *view, FILE *out, struct error *error) {
  struct rows rows;
  const struct query_sink sink = rows_sink(&rows, store, TABLE_CSV, out);
  return rows_end(&rows, ask_columns_view(store, view, &sink, error), error);
}

/* Written under a temporary name and renamed: a file with its final name is whole. A pipe or a device (/dev/stdout) is
 * written itself. view NULL: the bits. */
static status export_text(struct store *store, const char *path, const char *view, struct error *error) {
  struct stat there;
  const bool in_place = stat(path, &there) == 0 && !S_ISREG(there.st_mode) && !S_ISDIR(there.st_mode);
  char temporary[4096];
  if (snprintf(temporary, sizeof temporary, "%s%s", path, in_place ? "" : ".part") >= (int)sizeof temporary)
    return status_fail(error, STATUS_USAGE, "the target's name is too long");
  FILE *out = fopen(temporary, "w");
  if (!out)
    return status_fail(error, STATUS_IO, "cannot write %s: %s", temporary, strerror(errno));
  status code = view ? write_view(store, view, out, error) : store_dump(store, out, error);
  if (fclose(out) && !code)
    code = status_fail(error, STATUS_IO, "cannot write %s: %s", temporary, strerror(errno));
  if (in_place)
    return code;
  if (!code && rename(temporary, path))
    code = status_fail(error, STATUS_IO, "cannot write %s: %s", path, strerror(errno));
  if (code)
    remove(temporary);
  return code;
}

static status export_folder(struct store *store, const char *folder, struct error *error) {
  if (mkdir(folder, 0777) && errno != EEXIST)
    return status_fail(error, STATUS_IO, "cannot make the folder %s: %s", folder, strerror(errno));
  status code = STATUS_OK;
  for (size_t i = 0; !code && i < sizeof exported / sizeof exported[0]; i++) {
    char path[4096];
    if (snprintf(path, sizeof path, "%s/%s.csv", folder, exported[i]) >= (int)sizeof path)
      return status_fail(error, STATUS_USAGE, "the folder's name is too long");
    code = export_text(store, path, exported[i], error);
  }
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *target = line->arguments[1];
  struct store *store = NULL;
  if (options->csv && options->bits)
    return status_fail(error, STATUS_USAGE, "--csv and --bits exclude each other");
  status code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = options->csv    ? export_folder(store, target, error)
         : options->bits ? export_text(store, target, NULL, error)
                         : store_export(store, target, error);
  if (!code)
    fprintf(stderr, "%s written\n", target);
  store_close(store, NULL);
  return code;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_FLAG("csv", 0, struct options, csv,
                    "Write a folder of CSV files: runs, points, spectra, estimates, and column_doc with the meaning "
                    "and unit of each "
                    "column."),
    OPTION_ROW_FLAG("bits", 0, struct options, bits,
                    "Write every value that does not depend on where and when a run was computed, as text in the order "
                    "of identities. "
                    "Two stores of one campaign give the same file, however they were computed."),
};

const struct command export_command = {
    .name = "export",
    .group = "the store",
    .arguments = "STORE TARGET",
    .summary = "one compact file for hand-over, or a folder of CSV files",
    .doc =
        "Writes a compact copy of the store as one SQLite file, also while a campaign is running; or with --csv its\n"
        "views as CSV files in a folder. It never overwrites a store. It does overwrite CSV and bits files.",
    .examples = "clast export out.db handover.db\nclast export out.db tables --csv",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, option_rows),
    .run = run,
};
