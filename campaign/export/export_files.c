/* Writes views and bits of a store as text. */
#include "campaign/export/export_files.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "campaign/terminal/rows.h"

static const char *const exported[] = {"runs", "points", "spectra", "estimates", "column_doc"};

static status write_rows(struct store *store, const char *view, enum table_format format, FILE *out,
                         struct error *error) {
  struct rows rows;
  if (!view)
    return store_dump(store, out, error);
  const struct query_sink sink = rows_sink(&rows, store, format, out);
  return rows_end(&rows, ask_columns_view(store, view, &sink, error), error);
}

status export_files_write(struct store *store, const char *path, const char *view, enum table_format format,
                          struct error *error) {
  struct stat there;
  if (!path)
    return write_rows(store, view, format, stdout, error);
  const bool in_place = stat(path, &there) == 0 && !S_ISREG(there.st_mode) && !S_ISDIR(there.st_mode);
  char temporary[4096];
  if (snprintf(temporary, sizeof temporary, "%s%s", path, in_place ? "" : ".part") >= (int)sizeof temporary)
    return status_fail(error, STATUS_USAGE, "the target's name is too long");
  FILE *out = fopen(temporary, "w");
  if (!out)
    return status_fail(error, STATUS_IO, "cannot write %s: %s", temporary, strerror(errno));
  status code = write_rows(store, view, format, out, error);
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

status export_files_folder(struct store *store, const char *folder, struct error *error) {
  if (mkdir(folder, 0777) && errno != EEXIST)
    return status_fail(error, STATUS_IO, "cannot make the folder %s: %s", folder, strerror(errno));
  status code = STATUS_OK;
  for (size_t i = 0; !code && i < sizeof exported / sizeof exported[0]; i++) {
    char path[4096];
    if (snprintf(path, sizeof path, "%s/%s.csv", folder, exported[i]) >= (int)sizeof path)
      return status_fail(error, STATUS_USAGE, "the folder's name is too long");
    code = export_files_write(store, path, exported[i], TABLE_CSV, error);
  }
  return code;
}
