/* Files that a scene's inputs name (FIELD_FILE): shape files of bodies. In the inputs a file is the SHA-256 of what it
 * holds, so that a run's identity follows from that. engine/mesh/files.h has the bytes. */
#ifndef CLAST_ENGINE_SCENE_FILES_H
#define CLAST_ENGINE_SCENE_FILES_H

#include "engine/mesh/files.h"
#include "schemas/document.h"

enum { SCENE_FILES_MOST = 4 }; /* inputs of one engine with FIELD_FILE */

/* Reads the files that a document names and puts their SHA-256 in place of the names. A SHA-256 stays, if the file has
 * been read before: in the scene of a store. Names are relative to `folder` (NULL: the current one). Call it before the
 * document is read; errors go into its report. */
void scene_files_take(document_node *root, const struct field_table *inputs, const char *folder);
/* The same for one value, of --set. STATUS_MISSING, STATUS_IO, STATUS_CONTENT. */
status scene_files_set(const struct field *row, struct field_value *value, struct error *error);
/* The files of the active inputs; their number. What nobody has read is left out. */
size_t scene_files_of(const struct field_table *inputs, const void *object,
                      const struct mesh_file *files[SCENE_FILES_MOST]);

#endif
