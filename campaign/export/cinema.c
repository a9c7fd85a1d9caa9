/* Draws the pictures of a Cinema database and writes its table. */
#include "campaign/export/export.h"

#include <inttypes.h>
#include <stdio.h>

#include "campaign/charts/charts.h"
#include "db/ask/ask.h"
#include "schemas/file.h"
#include "schemas/limits.h"
#include "schemas/memory.h"

enum { WIDTH = 600 };

struct cinema {
  struct store *store;
  const char *folder;
  struct table *table;
  int64_t point; /* point whose spectrum is drawn */
  bool spectrum; /* the point has a spectrum */
  size_t rows, not_drawn;
};

/* Draws the spectrum of a point. A point without fragments has none. */
static status draw_spectrum(struct cinema *cinema, int64_t point, struct error *error) {
  char path[LIMITS_PATH];
  snprintf(path, sizeof path, "%s/point%" PRId64 ".png", cinema->folder, point);
  const struct spectrum_choice choice = {.pool = {.point = point}};
  const struct picture_page page = {.path = path, .width = WIDTH};
  const status code = spectrum_curves_draw(cinema->store, &choice, &(struct spectrum_drawing){.page = &page}, error);
  cinema->spectrum = code == STATUS_OK;
  return code == STATUS_USAGE ? STATUS_OK : code;
}

static void file_cell(struct cinema *cinema, bool there, const char *kind, int64_t number) {
  char name[64];
  snprintf(name, sizeof name, "%s%" PRId64 ".png", kind, number);
  table_text(cinema->table, there ? name : NULL);
}

/* Draws a run, and the spectrum of its point if the run is the first of it; then writes their row. `runs`: run_id,
 * point_id, ..., fields. */
static status write_run(struct cinema *cinema, const struct answer *runs, struct error *error) {
  const int64_t run = answer_integer(runs, 0), point = answer_integer(runs, 1);
  const size_t fields = answer_count(runs) - 1;
  char path[LIMITS_PATH];
  if (point != cinema->point)
    TRY(draw_spectrum(cinema, point, error));
  cinema->point = point;
  snprintf(path, sizeof path, "%s/run%" PRId64 ".png", cinema->folder, run);
  OWNED char *file = ask_run_fields(runs, fields);
  if (!file)
    return status_fail(error, STATUS_MEMORY, "no memory for the runs");
  const status code = picture_draw(file, path, &(struct picture_choice){.width = WIDTH}, error);
  if (code == STATUS_IO)
    return code;
  cinema->rows++;
  cinema->not_drawn += code != STATUS_OK;
  for (size_t i = 0; i < fields; i++) {
    const struct query_value value = answer_value(runs, i);
    table_value(cinema->table, &value);
  }
  file_cell(cinema, code == STATUS_OK, "run", run);
  file_cell(cinema, cinema->spectrum, "point", point);
  return STATUS_OK;
}

/* Writes the table, and during this draws the pictures that it names. */
static status write_table(struct cinema *cinema, FILE *out, struct error *error) {
  TABLE table = table_new(TABLE_CSV, out);
  ANSWER runs = ask_run_kept(cinema->store, error);
  cinema->table = table;
  for (size_t i = 0; i + 1 < answer_count(&runs); i++)
    table_column(table, answer_name(&runs, i), NULL);
  table_columns(table, (const char *const[]){"FILE", "FILE_spectrum", NULL});
  while (answer_next(&runs))
    TRY(write_run(cinema, &runs, error));
  TRY(answer_end(&runs));
  TRY(table_end(table, error));
  if (cinema->rows > 0)
    return STATUS_OK;
  return status_fail(error, STATUS_USAGE,
                     "no run of the store has its fields kept, so there is nothing to draw: give the campaign keep: "
                     "{fields: first 1} and run it again");
}

status cinema_write(struct store *store, const char *folder, struct error *error) {
  char path[LIMITS_PATH];
  struct file_output file;
  TRY(file_folder(folder, error));
  if (snprintf(path, sizeof path, "%s/data.csv", folder) >= (int)sizeof path - 64)
    return status_fail(error, STATUS_USAGE, "the folder's name is too long");
  TRY(file_begin(&file, path, "table", error));
  struct cinema cinema = {.store = store, .folder = folder};
  const status code = file_end(&file, write_table(&cinema, file.out, error), error);
  if (!code && cinema.not_drawn > 0)
    fprintf(stderr, "clast: %zu of %zu runs have no picture: their fields files are gone or damaged\n",
            cinema.not_drawn, cinema.rows);
  return code;
}
