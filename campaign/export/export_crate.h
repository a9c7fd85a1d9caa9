/* A store as an RO-Crate 1.1 of the profile Process Run Crate 0.5, for an archive: `clast export STORE --crate DIR`. */
#ifndef CLAST_CAMPAIGN_EXPORT_EXPORT_CRATE_H
#define CLAST_CAMPAIGN_EXPORT_EXPORT_CRATE_H

#include "db/store/store.h"

struct export_crate_options {
  const char *folder;  /* must not exist, or be empty */
  const char *license; /* URL or sentence; NULL: not chosen */
  const char *author;  /* "Name" or "Name <URL>"; NULL: not told */
};

/* Writes the store, the campaigns' files, tables as CSV, and ro-crate-metadata.json, last. The columns of the tables
 * are explained in column_doc.csv. STATUS_IO: the folder cannot be written, or is not empty. */
status export_crate(struct store *store, const char *store_path, const struct export_crate_options *options,
                    struct error *error);

#endif
