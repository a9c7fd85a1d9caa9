/* What `clast export` writes besides a copy of the store. */
#pragma once

#include "campaign/terminal/table.h"
#include "db/store/store.h"

/* EXPORT_TABULAR: the varied inputs (SI units) and the main results of each run, or their means of each point (view
 * "points"), as a tabular file of Dakota, annotated: eval_id is the number of the run or point. */
enum export_format { EXPORT_CSV, EXPORT_JSON_LINES, EXPORT_TABULAR };

/* Writes the rows of a view (runs, points, ...; NULL: the bits) into a file; path NULL: to standard output. The file is
 * written under a temporary name and renamed: a file with its final name is complete. A pipe or a device (/dev/stdout)
 * is written directly. */
status export_files_write(struct store *store, const char *path, const char *view, enum export_format format,
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

/* ---- one run for other programs ---- */

/* Reads a fields file and writes, by the ending of `target`: fragments as CSV (.csv) or as the lines that REBOUND reads
 * (.txt), particles as the HDF5 of miluphcuda, which OpenSPH reads, too (.h5). STATUS_USAGE: another ending.
 * STATUS_CONTENT: the file has no such bodies, or is damaged. STATUS_IO, STATUS_MISSING, STATUS_MEMORY. */
status export_run(const char *fields, const char *target, struct error *error);
