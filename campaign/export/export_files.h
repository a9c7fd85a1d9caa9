/* Text files of a store, for `clast export`. */
#ifndef CLAST_CAMPAIGN_EXPORT_EXPORT_FILES_H
#define CLAST_CAMPAIGN_EXPORT_EXPORT_FILES_H

#include "campaign/terminal/table.h"
#include "db/store/store.h"

/* Writes the rows of a view (runs, points, ...; NULL: the bits) into a file; path NULL: to standard output. The file is
 * written under a temporary name and renamed: a file with its final name is complete. A pipe or a device (/dev/stdout)
 * is written directly. */
status export_files_write(struct store *store, const char *path, const char *view, enum table_format format,
                          struct error *error);

/* runs.csv, points.csv, spectra.csv, estimates.csv and column_doc.csv in the folder, which is made. */
status export_files_folder(struct store *store, const char *folder, struct error *error);

#endif
