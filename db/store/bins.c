#include "db/store/bins.h"

#include "analysis/statistics/spectrum.h"

status bins_cover(sqlite3 *db, int lowest, int highest, struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(db, "INSERT OR IGNORE INTO bin (bin, lower, upper) VALUES (?1, ?2, ?3)", &statement,
                              "adding bin edges", error);
  for (int bin = lowest; result == STATUS_OK && bin <= highest; bin++) {
    sqlite3_bind_int(statement, 1, bin);
    sqlite3_bind_double(statement, 2, spectrum_edge(bin));
    sqlite3_bind_double(statement, 3, spectrum_edge(bin + 1));
    result = sql_run(statement, "adding bin edges", error);
  }
  sqlite3_finalize(statement);
  return result;
}

status bins_cover_spectrum(sqlite3 *db, struct error *error) {
  int64_t lowest, highest;
  status result = sql_integer(db, "SELECT min(bin) FROM spectrum", 0, &lowest, error);
  if (result == STATUS_OK)
    result = sql_integer(db, "SELECT max(bin) FROM spectrum", -1, &highest, error);
  return result == STATUS_OK ? bins_cover(db, (int)lowest, (int)highest, error) : result;
}
