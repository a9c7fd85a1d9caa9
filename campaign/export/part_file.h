/* A file that has its final name only when it is complete: it is written as NAME.part and renamed. */
#ifndef CLAST_CAMPAIGN_EXPORT_PART_FILE_H
#define CLAST_CAMPAIGN_EXPORT_PART_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "schemas/status.h"

enum { PART_FILE_PATH = 4096 };

struct part_file {
  FILE *out;
  bool in_place; /* a device or a pipe: written directly */
  char path[PART_FILE_PATH], temporary[PART_FILE_PATH + 8];
};

/* STATUS_USAGE: the name is too long; STATUS_IO. */
status part_file_open(struct part_file *file, const char *path, struct error *error);
/* Closes the file. With STATUS_OK it is renamed, else it is removed. With STATUS_IO its name is put before the
 * message of `error`. Returns `code`, or an error of closing or renaming. */
status part_file_close(struct part_file *file, status code, struct error *error);

/* Makes a folder, unless it exists. */
status part_file_folder(const char *folder, struct error *error);

#endif
