/* The files that a command reads and writes, and the one way to put an output in place.
 *
 * An output is written under another name beside it, FILE.unfinished, flushed to the disk and renamed: at any instant
 * FILE is the old file or the whole new one, also after a power cut; the new one if its writer had gone on. A process
 * that is killed while it writes leaves FILE.unfinished; the next write of FILE removes it. While another process
 * writes FILE.unfinished, the name is FILE.PID-K.unfinished. A pipe, a device or an open file (/dev/stdout) is written
 * directly.
 *
 * No output replaces what people cannot compute again in a moment:
 *   - an SQLite database, such as a store; nor a name that SQLite uses beside one (-journal, -wal, -shm),
 *   - the fields of a stored run: STORE-fields/<identity>.h5,
 *   - a file that this command reads, under any of its names; file_input() knows them,
 *   - a document: a file with the ending .yaml, .yml or .json that is not the JSON Lines of an export. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "schemas/status.h"

/* Endings of the files that SQLite keeps beside a database and writes or deletes: "-journal", "-wal", "-shm", NULL. */
extern const char *const file_companions[];
/* Does the name end in one of them? Such a name cannot be that of a store. */
bool file_is_companion(const char *path);

/* Notes that this command reads the file `path`. Everything that opens an input calls it before. STATUS_IO: the file is
 * claimed as an output and not yet written. STATUS_OK also for a file that does not exist, a pipe or a device. */
status file_input(const char *path, struct error *error);

/* Reads a whole file. *bytes is malloc'd and owned by the caller; `what` names the file's purpose in messages ("restart
 * file"). STATUS_MISSING, STATUS_IO (also for a folder or a device, which may never end), STATUS_MEMORY. */
status file_read(const char *path, const char *what, unsigned char **bytes, size_t *size, struct error *error);

/* Before a command computes: checks that an output can be written when it has ended. STATUS_IO: the file may not be
 * replaced, or the system's reason (no permission, no such folder). STATUS_USAGE: another output has the same name. An
 * existing file does not change. */
status file_claim(const char *path, const char *what, struct error *error);
/* STATUS_IO when an output may not replace this file. file_begin() and file_end() check it, too. */
status file_may_replace(const char *path, const char *what, struct error *error);

struct file_output {
  FILE *out;              /* the caller writes here */
  const char *what;       /* borrowed */
  char *path, *temporary; /* temporary: name of the file that is being written; path, if it is written directly */
};

/* Begins an output. The caller calls file_end() after STATUS_OK only. STATUS_IO as file_claim(). */
status file_begin(struct file_output *file, const char *path, const char *what, struct error *error);
/* Ends it: with the status `code` STATUS_OK the file is put in place, else it is removed and FILE stays as it was. A
 * message of STATUS_IO gets the name of the file if it lacks it. Returns `code`, or STATUS_IO. */
status file_end(struct file_output *file, status code, struct error *error);
/* Writes a whole file: both in one. */
status file_write(const char *path, const char *what, const void *bytes, size_t size, struct error *error);

/* Makes a folder, unless it exists; a new one outlives a power cut. STATUS_IO. */
status file_folder(const char *path, struct error *error);

/* Is the word the name of a document file, and not of a built-in document? It has a slash, or ends in .yaml, .yml or
 * .json. */
bool file_name_is_document(const char *word);
bool file_name_ends(const char *word); /* in .yaml, .yml or .json */

/* Joins a folder and a file name; malloc'd, NULL without memory. An absolute name does not change, nor does any name
 * when `folder` is NULL or empty (the current folder). */
char *file_name_in(const char *folder, const char *name);
