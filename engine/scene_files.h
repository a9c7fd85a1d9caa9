/* Files that a scene's inputs name (FIELD_FILE): shape files of bodies. The inputs hold the SHA-256 of the file's
 * content, so a run's identity depends on the content. engine/mesh/files.h keeps the bytes. */
#ifndef CLAST_ENGINE_SCENE_FILES_H
#define CLAST_ENGINE_SCENE_FILES_H

#include "engine/mesh/files.h"
#include "schemas/document.h"

enum { SCENE_FILES_MOST = 4 }; /* inputs of one engine with FIELD_FILE */

/* Reads the files that a document names and puts their SHA-256 in place of the names. A value that is already the
 * SHA-256 of a file read before does not change (scenes of a store). Names are relative to `folder` (NULL: the current
 * one). Call it before the document is read; errors go into its report. */
void scene_files_take(document_node *root, const struct field_table *inputs, const char *folder);
/* The same for one value, of --set. STATUS_MISSING, STATUS_IO, STATUS_CONTENT. */
status scene_files_set(const struct field *row, struct field_value *value, struct error *error);
/* Lists the files of the active inputs and returns their number. Files that were not read are left out. */
size_t scene_files_of(const struct field_table *inputs, const void *object,
                      const struct mesh_file *files[SCENE_FILES_MOST]);

#endif
