/* Names of files in documents and on the command line. */
#ifndef CLAST_ENGINE_FILE_NAME_H
#define CLAST_ENGINE_FILE_NAME_H

#include <stdbool.h>

/* Does a word name a document's file, and not something built in? It has a slash, or ends in .yaml, .yml or .json. */
bool file_name_is_document(const char *word);

/* The name of a file that stands in a folder, malloc'd; NULL without memory. An absolute name stays as it is, and so
 * does any name without a folder (NULL or empty: the current one). */
char *file_name_in(const char *folder, const char *name);

#endif
