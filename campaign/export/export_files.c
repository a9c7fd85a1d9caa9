/* Writes views and bits of a store as text. */
#include "campaign/export/export_files.h"

#include "campaign/export/part_file.h"
#include "campaign/terminal/rows.h"

static const char *const exported[] = {"runs", "points", "spectra", "estimates", "column_doc"};

static status write_rows(struct store *store, const char *view, enum table_format format, FILE *out,
                         struct error *error) {
  return view ? rows_print(ask_columns_view(store, view, error), false, format, out) : store_dump(store, out, error);
}

status export_files_write(struct store *store, const char *path, const char *view, enum table_format format,
                          struct error *error) {
  struct part_file file;
  if (!path)
    return write_rows(store, view, format, stdout, error);
  status code = part_file_open(&file, path, error);
  if (code)
    return code;
  code = write_rows(store, view, format, file.out, error);
  return part_file_close(&file, code, error);
}

status export_files_folder(struct store *store, const char *folder, struct error *error) {
  status code = part_file_folder(folder, error);
  for (size_t i = 0; !code && i < sizeof exported / sizeof exported[0]; i++) {
    char path[4096];
    if (snprintf(path, sizeof path, "%s/%s.csv", folder, exported[i]) >= (int)sizeof path)
      return status_fail(error, STATUS_USAGE, "the folder's name is too long");
    code = export_files_write(store, path, exported[i], TABLE_CSV, error);
  }
  return code;
}
