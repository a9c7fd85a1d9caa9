/* Writes views and bits of a store as text. */
#include "campaign/export/export.h"

#include "db/ask/ask.h"
#include "schemas/file.h"
#include "schemas/limits.h"

static const char *const exported[] = {"runs", "points", "spectra", "estimates", "column_doc"};

static status write_rows(struct store *store, const char *view, enum table_format format, FILE *out,
                         struct error *error) {
  return view ? table_answer(ask_columns_view(store, view, error), false, format, out)
              : store_export_digests(store, out, error);
}

status export_files_write(struct store *store, const char *path, const char *view, enum table_format format,
                          struct error *error) {
  struct file_output file;
  if (!path)
    return write_rows(store, view, format, stdout, error);
  TRY(file_begin(&file, path, "rows", error));
  return file_end(&file, write_rows(store, view, format, file.out, error), error);
}

status export_files_folder(struct store *store, const char *folder, struct error *error) {
  enum { TABLES = sizeof exported / sizeof exported[0] };
  char path[TABLES][LIMITS_PATH];
  TRY(file_folder(folder, error));
  for (size_t i = 0; i < TABLES; i++) { /* all before the first is written */
    if (snprintf(path[i], sizeof path[i], "%s/%s.csv", folder, exported[i]) >= (int)sizeof path[i])
      return status_fail(error, STATUS_USAGE, "the folder's name is too long");
    TRY(file_may_replace(path[i], "table", error));
  }
  for (size_t i = 0; i < TABLES; i++)
    TRY(export_files_write(store, path[i], exported[i], TABLE_CSV, error));
  return STATUS_OK;
}
