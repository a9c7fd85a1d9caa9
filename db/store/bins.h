/* Table bin: the edges of every mass bin that a store uses, so that spectra can be read without the program. */
#ifndef CLAST_DB_STORE_BINS_H
#define CLAST_DB_STORE_BINS_H

#include "db/sql.h"

/* Add what is missing between the lowest and the highest bin, ends included. Within the caller's transaction. */
status bins_cover(sqlite3 *db, int lowest, int highest, struct error *error);
/* The same for whatever table spectrum holds. */
status bins_cover_spectrum(sqlite3 *db, struct error *error);

#endif
