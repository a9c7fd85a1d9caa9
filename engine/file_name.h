/* Names of files in documents and on the command line. */
#ifndef CLAST_ENGINE_FILE_NAME_H
#define CLAST_ENGINE_FILE_NAME_H

#include <stdbool.h>

/* Is the word the name of a document file, and not of a built-in document? It has a slash, or ends in .yaml, .yml or
 * .json. */
bool file_name_is_document(const char *word);

/* Joins a folder and a file name; malloc'd, NULL without memory. An absolute name does not change, nor does any name
 * when `folder` is NULL or empty (the current folder). */
char *file_name_in(const char *folder, const char *name);

#endif
