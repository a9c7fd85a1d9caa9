/* Reads a design from a CSV file into axes of equal length. */
#include "campaign/document/campaign_points.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "campaign/document/csv.h"
#include "engine/grow.h"
#include "schemas/file.h"
#include "schemas/sha256.h"

enum { LARGEST = 16 << 20, MOST_COLUMNS = 1000, MOST_REPORTS = 10 };

struct reading {
  struct campaign *campaign;
  document_node *node; /* the document's node that names the file */
  char (*units)[64];   /* units of the columns; "" for none */
  size_t capacity;     /* capacity of every axis and of the lines */
  int reports;
};

static bool wrong(struct reading *r, int64_t line, const char *format, ...) __attribute__((format(printf, 3, 4)));
static bool wrong(struct reading *r, int64_t line, const char *format, ...) {
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (r->reports++ < MOST_REPORTS)
    document_report(r->node, "design.file", "%s:%lld: %s", r->campaign->design.file, (long long)line, text);
  return false;
}

/* The file's bytes, malloc'd. NULL: reported. */
static char *load(struct reading *r, const char *folder, size_t *size) {
  const char *name = r->campaign->design.file;
  char path[4096];
  struct stat facts;
  const bool alone = name[0] == '/' || !folder;
  const int length = snprintf(path, sizeof path, "%s%s%s", alone ? "" : folder, alone ? "" : "/", name);
  struct error why;
  if (file_input(path, &why)) {
    document_report(r->node, "design.file", "%s", why.message);
    return NULL;
  }
  FILE *file = length < (int)sizeof path ? fopen(path, "rb") : NULL;
  if (!file) {
    document_report(r->node, "design.file", "cannot open '%s': %s; it is looked for beside the campaign's file", path,
                    strerror(errno));
    return NULL;
  }
  char *text = NULL;
  if (fstat(fileno(file), &facts) != 0 || !S_ISREG(facts.st_mode) || facts.st_size > LARGEST)
    document_report(r->node, "design.file", "'%s' is no plain file of up to %d MiB", path, LARGEST >> 20);
  else if (!(text = malloc((size_t)facts.st_size + 1)))
    document_report_memory(r->node, "design.file");
  else
    *size = fread(text, 1, (size_t)facts.st_size, file);
  fclose(file);
  return text;
}

/* Takes "threshold.angle [deg]" or "threshold.angle (deg)" apart; the path stays in `cell`. */
static void take_unit(char *cell, char unit[64]) {
  const size_t length = strlen(cell);
  const char close = length ? cell[length - 1] : '\0';
  char *open = close == ']' ? strrchr(cell, '[') : close == ')' ? strrchr(cell, '(') : NULL;
  *unit = '\0';
  if (!open)
    return;
  snprintf(unit, 64, "%.*s", (int)(cell + length - 1 - open - 1), open + 1);
  while (open > cell && open[-1] == ' ')
    open--;
  *open = '\0';
}

static bool add_column(struct reading *r, int64_t line, char *cell) {
  struct campaign *campaign = r->campaign;
  struct error error = {0};
  if (campaign->axis_count == MOST_COLUMNS)
    return wrong(r, line, "more than %d columns", MOST_COLUMNS);
  if (!*cell)
    return wrong(r, line,
                 "column %zu has no name; write the file without row names (R: row.names = FALSE, pandas: index=False)",
                 campaign->axis_count + 1);
  take_unit(cell, r->units[campaign->axis_count]);
  const struct field *row = field_find(campaign->scene->kind->inputs, cell, &error);
  if (!row)
    return wrong(r, line, "%s", error.message);
  if (row->flags & FIELD_FILE)
    return wrong(r, line, "%s: a shape file cannot be varied: write a scene for each shape", row->path);
  if (campaign_axis(campaign, row))
    return wrong(r, line, "two columns for %s", row->path);
  if (*r->units[campaign->axis_count] && row->kind != FIELD_REAL)
    return wrong(r, line, "%s has no unit; leave [%s] out", row->path, r->units[campaign->axis_count]);
  campaign->axes[campaign->axis_count++] = (struct design_axis){.row = row,
                                                                .kind = DESIGN_AXIS_LEVELS,
                                                                .lower = -HUGE_VAL,
                                                                .upper = HUGE_VAL};
  return true;
}

static bool read_header(struct reading *r, struct csv *csv) {
  char cell[CSV_CELL];
  const int64_t line = csv->line;
  bool good = true;
  for (bool last = false; !last;) {
    if (!csv_cell(csv, cell, &last))
      return wrong(r, line, "%s", csv->wrong);
    good &= add_column(r, line, cell);
  }
  return good;
}

/* A bare number gets the column's unit. */
static bool read_cell(struct reading *r, size_t column, int64_t line, const char *cell) {
  struct design_axis *axis = &r->campaign->axes[column];
  struct error error = {0};
  char text[CSV_CELL + 64], *end;
  (void)strtod(cell, &end);
  const bool bare = *cell && *end == '\0';
  if (!*cell)
    return wrong(r, line, "%s: the cell is empty", axis->row->path);
  snprintf(text, sizeof text, "%s%s%s", cell, bare && *r->units[column] ? " " : "", bare ? r->units[column] : "");
  const bool plain = bare && strcmp(r->units[column], "1") == 0; /* [1]: fractions, for inputs that require percent */
  struct field_value *value = &axis->levels[r->campaign->design.points];
  const status code = plain ? field_parse_si(axis->row, cell, value, &error)
                            : field_parse(axis->row, text, value, &error);
  if (code != STATUS_OK)
    return wrong(r, line, "%s", error.message);
  return true;
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

/* One line, one point. */
static bool read_point(struct reading *r, struct csv *csv) {
  struct campaign *campaign = r->campaign;
  const int64_t line = csv->line;
  char cell[CSV_CELL];
  bool good = true;
  size_t column = 0;
  if (!reserve(r)) {
    r->reports = MOST_REPORTS;
    document_report_memory(r->node, "design.file");
    return false;
  }
  for (bool last = false; !last; column++) {
    if (!csv_cell(csv, cell, &last))
      return wrong(r, line, "%s", csv->wrong);
    good &= column >= campaign->axis_count || read_cell(r, column, line, cell);
  }
  if (column != campaign->axis_count)
    return wrong(r, line, "%zu cells, but the header has %zu", column, campaign->axis_count);
  if (!good)
    return false;
  campaign->point_lines[campaign->design.points++] = line;
  for (size_t i = 0; i < campaign->axis_count; i++)
    campaign->axes[i].level_count = (size_t)campaign->design.points;
  return true;
}

/* Goes on after an invalid line, so that one report has the first MOST_REPORTS errors. */
static bool read_text(struct reading *r, struct csv *csv) {
  if (csv_record(csv) && !read_header(r, csv))
    return false;
  while (r->reports < MOST_REPORTS && !csv->wrong && csv_record(csv))
    (void)read_point(r, csv);
  if (r->reports == 0 && r->campaign->design.points == 0)
    return wrong(r, csv->line, "no points: expected a header of input paths, and a line for each point");
  return r->reports == 0;
}

bool campaign_points_read(document_node *node, const char *folder, struct campaign *campaign) {
  struct reading r = {.campaign = campaign, .node = node};
  size_t size = 0;
  bool good = false;
  char *text = load(&r, folder, &size);
  campaign->axes = calloc(MOST_COLUMNS, sizeof *campaign->axes);
  r.units = calloc(MOST_COLUMNS, sizeof *r.units);
  if (!campaign->axes || !r.units) {
    document_report_memory(node, "design.file");
  } else if (text) {
    const size_t mark = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0; /* byte order mark */
    struct csv csv = {.text = text + mark, .end = text + size, .line = 1};
    sha256_text(text, size, campaign->points_sha256);
    good = read_text(&r, &csv);
  }
  free(r.units);
  free(text);
  return good;
}
