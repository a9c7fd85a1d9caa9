/* Shape files of the bodies: table shape_file. The inputs of a point hold the SHA-256 of the file. */
#ifndef CLAST_DB_STORE_SHAPES_H
#define CLAST_DB_STORE_SHAPES_H

#include "db/sql.h"
#include "db/store/store.h"

/* Adds the files of a scene that the store lacks, within the open batch. */
status shapes_add(struct store *store, const struct scene *scene, struct error *error);
/* Makes the files of a run's scene known (engine/mesh/mesh.h), so that its scene can be read; run_id 0: all files of
 * the store. STATUS_CONTENT: a file is damaged. */
status shapes_load(struct store *store, int64_t run_id, struct error *error);
/* Adds the files of the attached store `other` that `main` lacks. */
status shapes_merge(sqlite3 *db, struct error *error);

#endif
