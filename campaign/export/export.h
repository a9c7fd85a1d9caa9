/* What `clast export` writes besides a copy of the store. */
#pragma once

#include "campaign/terminal/table.h"
#include "db/store/store.h"

/* Writes the rows of a view (runs, points, ...; NULL: the bits) into a file; path NULL: to standard output. The file is
 * written under a temporary name and renamed: a file with its final name is complete. A pipe or a device (/dev/stdout)
 * is written directly. format: TABLE_CSV or TABLE_JSON_LINES. */
status export_files_write(struct store *store, const char *path, const char *view, enum table_format format,
                          struct error *error);

/* A CSV file of each view, and column_doc.csv, in the folder, which is made. */
status export_files_folder(struct store *store, const char *folder, struct error *error);

/* ---- an RO-Crate 1.1 of the profile Process Run Crate 0.5, for an archive ---- */

struct export_crate_options {
  const char *folder;  /* must not exist, or be empty */
  const char *license; /* URL or sentence; NULL: not chosen */
  const char *author;  /* "Name" or "Name <URL>"; NULL: not told */
};

/* Writes the store, the campaigns' files, tables as CSV, and ro-crate-metadata.json, last. The columns of the tables
 * are explained in column_doc.csv. STATUS_IO: the folder cannot be written, or is not empty. */
status export_crate(struct store *store, const char *store_path, const struct export_crate_options *options,
                    struct error *error);
