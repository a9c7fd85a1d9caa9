/* Reads a design from a CSV file into axes of equal length. */
#include "campaign/document/campaign_read.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "engine/grow.h"
#include "schemas/csv.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

enum { LARGEST = 16 << 20, MOST_REPORTS = 10, CELL = 256 };

struct reading {
  struct campaign *campaign;
  document_node *node; /* the document's node that names the file */
  struct csv csv;
  char folder[LIMITS_PATH];     /* of the file of points: files that its cells name are looked for there */
  const char *units[CSV_CELLS]; /* units of the columns; "" for none */
  size_t capacity;              /* capacity of every axis and of the lines */
  int reports;
};

/* Reports an error of the item that was read last. */
static bool wrong(struct reading *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool wrong(struct reading *r, const char *format, ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (r->reports++ < MOST_REPORTS)
    document_report(r->node, "design.file", "%s:%lld: %s", r->campaign->design.file, (long long)r->csv.line, text);
  return false;
}

/* Opens the file of points. False: reported. */
static bool open_points(struct reading *r, const char *folder) {
  const char *name = r->campaign->design.file;
  char path[LIMITS_PATH];
  struct stat facts;
  struct error error;
  const bool alone = name[0] == '/' || !folder;
  const int length = snprintf(path, sizeof path, "%s%s%s", alone ? "" : folder, alone ? "" : "/", name);
  const int got = length < (int)sizeof path ? stat(path, &facts) : (errno = ENAMETOOLONG, -1);
  if (got != 0)
    document_report(r->node, "design.file", "cannot open '%s': %s; it is looked for beside the campaign's file", path,
                    strerror(errno));
  else if (!S_ISREG(facts.st_mode) || facts.st_size > LARGEST)
    document_report(r->node, "design.file", "'%s' is no plain file of up to %d MiB", path, LARGEST >> 20);
  else if (csv_open(&r->csv, path, "file of points", &error) == STATUS_OK) {
    const char *slash = strrchr(path, '/');
    snprintf(r->folder, sizeof r->folder, "%.*s", slash ? (int)(slash - path) : 0, path);
    return true;
  } else
    document_report(r->node, "design.file", "%s", error.message);
  return false;
}

static bool add_column(struct reading *r, size_t column) {
  struct campaign *campaign = r->campaign;
  struct error error = {0};
  char *name = r->csv.cells[column].text;
  if (!*name)
    return wrong(r,
                 "column %zu has no name; write the file without row names (R: row.names = FALSE, pandas: index=False)",
                 column + 1);
  const char *unit = r->units[column] = csv_take_unit(name);
  const struct field *row = field_find_in(campaign->scene->kind->inputs, name, campaign->scene->inputs, &error);
  if (!row)
    return wrong(r, "%s", error.message);
  if (row->flags & FIELD_FILE)
    return wrong(r, "%s: a shape file cannot be varied: write a scene for each shape", row->path);
  if (campaign_axis(campaign, row->path))
    return wrong(r, "two columns for %s", row->path);
  if (*unit && row->kind != FIELD_REAL)
    return wrong(r, "%s has no unit; leave [%s] out", row->path, unit);
  campaign->axes[campaign->axis_count++] = (struct design_axis){.row = row,
                                                                .kind = DESIGN_AXIS_LEVELS,
                                                                .lower = -HUGE_VAL,
                                                                .upper = HUGE_VAL};
  return true;
}

static bool read_header(struct reading *r) {
  bool good = true;
  r->campaign->axes = calloc(r->csv.count, sizeof *r->campaign->axes);
  if (!r->campaign->axes) {
    document_report_memory(r->node, "design.file");
    return false;
  }
  for (size_t column = 0; column < r->csv.count && r->reports < MOST_REPORTS; column++)
    good &= add_column(r, column);
  return good;
}

/* A material that is no built-in one is a file. */
static bool in_folder(struct reading *r, const struct field *row, struct field_value *value) {
  if (row->kind != FIELD_TEXT || !row->choices || field_is_choice(row, value->text))
    return true;
  OWNED char *whole = file_name_in(r->folder, value->text);
  if (!whole || strlen(whole) >= FIELD_TEXT_SIZE)
    return wrong(r, "%s: the name of this file is too long with its folder", row->path);
  field_copy_text(value->text, whole);
  return true;
}

/* A bare number gets the column's unit. */
static bool read_cell(struct reading *r, size_t column) {
  struct design_axis *axis = &r->campaign->axes[column];
  struct csv_cell *cell = &r->csv.cells[column];
  struct error error = {0};
  char text[2 * CELL];
  const bool number = axis->row->kind == FIELD_REAL || axis->row->kind == FIELD_INTEGER;
  if (!*cell->text)
    return wrong(r, "%s: the cell is empty", axis->row->path);
  if (strlen(cell->text) >= CELL)
    return wrong(r, "%s: a cell of more than %d bytes", axis->row->path, CELL - 1);
  if (number && !csv_number(&r->csv, cell))
    return wrong(r, "%s: %s", axis->row->path, r->csv.wrong);
  const char *unit = unit_is_bare(cell->text) ? r->units[column] : "";
  snprintf(text, sizeof text, "%s%s%.200s", cell->text, *unit ? " " : "", unit);
  struct field_value *value = &axis->levels[r->campaign->design.points];
  const status code = strcmp(unit, "1") == 0 /* fractions, for inputs that require percent */
                          ? field_parse_si(axis->row, cell->text, value, &error)
                          : field_parse(axis->row, text, value, &error);
  return code == STATUS_OK ? in_folder(r, axis->row, value) : wrong(r, "%s", error.message);
}

static bool reserve(struct reading *r) {
  struct campaign *campaign = r->campaign;
  if ((size_t)campaign->design.points < r->capacity)
    return true;
  const size_t capacity = r->capacity ? 2 * r->capacity : 64;
  if (!grow_block(&campaign->point_lines, capacity * sizeof *campaign->point_lines))
    return false;
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (!grow_block(&campaign->axes[i].levels, capacity * sizeof *campaign->axes[i].levels))
      return false;
  r->capacity = capacity;
  return true;
}

/* One record, one point. */
static void read_point(struct reading *r) {
  struct campaign *campaign = r->campaign;
  bool good = true;
  if (!reserve(r)) {
    r->reports = MOST_REPORTS;
    document_report_memory(r->node, "design.file");
    return;
  }
  for (size_t a = 0; a < campaign->axis_count; a++)
    good &= read_cell(r, a);
  if (!good)
    return;
  campaign->point_lines[campaign->design.points++] = r->csv.line;
  for (size_t i = 0; i < campaign->axis_count; i++)
    campaign->axes[i].level_count = (size_t)campaign->design.points;
}

/* Goes on after a wrong line, so that one report has the first MOST_REPORTS errors. */
static bool read_items(struct reading *r) {
  enum csv_item item;
  while (r->reports < MOST_REPORTS && (item = csv_next(&r->csv)) != CSV_END)
    switch (item) {
    case CSV_NAMES:
      if (!read_header(r))
        return false;
      break;
    case CSV_RECORD: read_point(r); break;
    case CSV_WRONG:
      wrong(r, "%s", r->csv.wrong);
      if (r->csv.count == 0)
        return false; /* the names */
      break;
    default: break; /* a remark */
    }
  if (r->reports == 0 && r->campaign->design.points == 0)
    return wrong(r, "no points: expected a header of input paths, and a line for each point");
  return r->reports == 0;
}

bool campaign_points_read(document_node *node, const char *folder, struct campaign *campaign) {
  OWNED struct reading *r = memory_small(1, sizeof *r); /* too large for the stack of a thread */
  bool good = false;
  r->campaign = campaign;
  r->node = node;
  if (open_points(r, folder)) {
    text_sha256(r->csv.bytes, r->csv.size, campaign->points_sha256);
    good = read_items(r);
    csv_close(&r->csv);
  }
  return good;
}
