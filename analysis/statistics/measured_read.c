/* Reads a measured spectrum. The file may come from an untrusted source: every cell is checked. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/measured.h"
#include "engine/grow.h"
#include "schemas/file.h"
#include "schemas/unit.h"

enum { LINE = 4096, CELL = 128, MOST_ROWS = 10000000 };

enum count_kind { SINGLE, COUNTS, CUMULATIVE };

struct row {
  double mass, number;
};

struct reading {
  const char *path;
  size_t line;
  struct spectrum_size size;
  int place, number;   /* indices of columns; `number` is -1: no such column */
  bool named, by_size; /* the header line was read; fragments are given by size */
  enum count_kind kind;
  char unit[CELL], complete[CELL];
  struct row *rows;
  size_t count, room;
  struct measured *out;
};

static status refuse(const struct reading *r, struct error *error, const char *what, const char *text) {
  return status_fail(error, STATUS_CONTENT, "%s:%zu: %s '%.80s'", r->path, r->line, what, text);
}

static char *trim(char *text) {
  text += strspn(text, " \t\r\n\"");
  size_t n = strlen(text);
  while (n > 0 && strchr(" \t\r\n\"", text[n - 1]))
    text[--n] = '\0';
  return text;
}

/* "# density: 2.7 g/cm^3" */
static status take_remark(struct reading *r, char *text, struct error *error) {
  char *colon = strchr(text, ':');
  if (!colon)
    return STATUS_OK;
  *colon = '\0';
  const char *key = trim(text), *value = trim(colon + 1);
  if (strcmp(key, "source") == 0)
    snprintf(r->out->source, sizeof r->out->source, "%s", value);
  if (strcmp(key, "complete from") == 0)
    snprintf(r->complete, sizeof r->complete, "%s", value);
  if (strcmp(key, "density") != 0)
    return STATUS_OK;
  if (unit_read(value, "kg/m^3", &r->size.density, error) || !(r->size.density > 0))
    return refuse(r, error, "the density needs a number and a unit, such as 2.7 g/cm^3, not", value);
  return STATUS_OK;
}

/* Splits a line at commas, semicolons or tabs. Returns the number of cells. */
static int split(char *line, char *cells[], int most) {
  int count = 0;
  for (char *from = line; from && count < most; count++) {
    char *end = from + strcspn(from, ",;\t");
    char *next = *end ? end + 1 : NULL;
    *end = '\0';
    cells[count] = trim(from);
    from = next;
  }
  return count;
}

/* Meanings of column names. */
static const struct meaning {
  const char *name;
  enum { MASS, SIZE, NUMBER } of;
  enum count_kind kind;
} meanings[] = {{"mass", MASS, SINGLE},
                {"size", SIZE, SINGLE},
                {"diameter", SIZE, SINGLE},
                {"count", NUMBER, COUNTS},
                {"cumulative", NUMBER, CUMULATIVE}};

static const struct meaning *find_meaning(const char *name) {
  for (size_t k = 0; k < sizeof meanings / sizeof meanings[0]; k++)
    if (strcmp(name, meanings[k].name) == 0)
      return &meanings[k];
  return NULL;
}

/* Reads "mass (g)" as the name of column i. Among columns of masses and sizes the first one counts. */
static void take_name(struct reading *r, int i, const char *cell) {
  char name[CELL], unit[CELL] = "";
  if (sscanf(cell, "%127[^(](%127[^)])", name, unit) < 1)
    return;
  const struct meaning *meaning = find_meaning(trim(name));
  if (!meaning)
    return;
  if (meaning->of == NUMBER) {
    r->number = i;
    r->kind = meaning->kind;
    return;
  }
  if (r->place >= 0)
    return;
  r->place = i;
  r->by_size = meaning->of == SIZE;
  const char *usual = r->by_size ? "m" : "kg";
  snprintf(r->unit, sizeof r->unit, "%s", *unit ? unit : usual);
}

static status take_names(struct reading *r, int count, char *const cells[], struct error *error) {
  r->place = r->number = -1;
  for (int i = 0; i < count; i++)
    take_name(r, i, cells[i]);
  if (r->place < 0)
    return refuse(r, error,
                  "the first line names the columns: mass (g) or size (mm), alone or with count or cumulative; not",
                  cells[0]);
  if (r->by_size && !(r->size.density > 0))
    return status_fail(error, STATUS_CONTENT,
                       "%s:%zu: sizes need a density: add a line `# density: 2.7 g/cm^3` above the names", r->path,
                       r->line);
  return STATUS_OK;
}

/* Reads "0.5" in the unit of the column, or "0.5 g", as a mass in kg. */
static status read_mass(const struct reading *r, const char *text, const char *unit, double *mass,
                        struct error *error) {
  char quantity[2 * CELL + 2];
  double place;
  snprintf(quantity, sizeof quantity, "%.127s %s", text, unit);
  const status code = unit_read(quantity, r->by_size ? "m" : "kg", &place, error);
  if (code || !(place > 0))
    return refuse(r, error, r->by_size ? "expected a size above 0, not" : "expected a mass above 0, not", quantity);
  *mass = r->by_size ? spectrum_size_mass(&r->size, place) : place;
  if (!(*mass > 0) || !isfinite(*mass)) /* the cube of a size can exceed the range of a double */
    return refuse(r, error, "no fragment has the mass of", quantity);
  return STATUS_OK;
}

static status take_row(struct reading *r, int count, char *const cells[], struct error *error) {
  struct row row = {.number = 1};
  if (r->place >= count || r->number >= count)
    return refuse(r, error, "the line has too few cells; it begins with", cells[0]);
  status code = read_mass(r, cells[r->place], r->unit, &row.mass, error);
  if (code)
    return code;
  if (r->number >= 0) {
    char *end;
    row.number = strtod(cells[r->number], &end);
    if (end == cells[r->number] || *end || !(row.number >= 0) || !isfinite(row.number))
      return refuse(r, error, "expected a number of fragments, not", cells[r->number]);
  }
  if (r->count == MOST_ROWS)
    return status_fail(error, STATUS_CONTENT, "%s: more than %d rows", r->path, MOST_ROWS);
  if (!grow_room(&r->rows, &r->room, r->count + 1, sizeof *r->rows))
    return status_fail(error, STATUS_MEMORY, "%s: no memory for its rows", r->path);
  r->rows[r->count++] = row;
  return STATUS_OK;
}

/* The first line that is no remark names the columns; the next ones are rows. */
static status take_line(struct reading *r, char *text, struct error *error) {
  char *cells[64];
  if (r->line == 1 && strncmp(text, "\xef\xbb\xbf", 3) == 0)
    text += 3;
  text = trim(text);
  if (*text == '\0')
    return STATUS_OK;
  if (*text == '#')
    return take_remark(r, text + 1, error);
  const int count = split(text, cells, 64);
  if (r->named)
    return take_row(r, count, cells, error);
  r->named = true;
  return take_names(r, count, cells, error);
}

static status read_lines(struct reading *r, FILE *file, struct error *error) {
  char line[LINE];
  while (fgets(line, sizeof line, file)) {
    r->line++;
    if (strlen(line) == sizeof line - 1)
      return status_fail(error, STATUS_CONTENT, "%s:%zu: the line is too long", r->path, r->line);
    const status code = take_line(r, line, error);
    if (code)
      return code;
  }
  if (ferror(file))
    return status_fail(error, STATUS_IO, "%s: cannot be read: %s", r->path, strerror(errno));
  if (r->count == 0)
    return status_fail(error, STATUS_CONTENT, "%s: there is no row with a fragment", r->path);
  return STATUS_OK;
}

static int ascending(const void *a, const void *b) {
  return sample_ascending(&((const struct row *)a)->mass, &((const struct row *)b)->mass);
}

/* Converts rows into N(>= m) at ascending masses. */
static status take_rows(struct reading *r, struct error *error) {
  struct measured *out = r->out;
  out->single = r->kind == SINGLE;
  out->mass = malloc(r->count * sizeof *out->mass);
  out->above = malloc(r->count * sizeof *out->above);
  if (!out->mass || !out->above)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for its rows", r->path);
  out->n = r->count;
  qsort(r->rows, r->count, sizeof *r->rows, ascending);
  double above = 0;
  for (size_t i = r->count; i-- > 0;) {
    if (r->kind == CUMULATIVE && r->rows[i].number < above)
      return status_fail(error, STATUS_CONTENT,
                         "%s: the cumulative number at %g kg is below that of a larger mass; it counts from this mass "
                         "upwards",
                         r->path, r->rows[i].mass);
    above = r->kind == CUMULATIVE ? r->rows[i].number : above + r->rows[i].number;
    out->mass[i] = r->rows[i].mass;
    out->above[i] = above;
  }
  if (!(above > 0))
    return status_fail(error, STATUS_CONTENT, "%s: there is no fragment in it", r->path);
  if (!isfinite(above))
    return status_fail(error, STATUS_CONTENT, "%s: there are more fragments than a number can hold in it", r->path);
  return STATUS_OK;
}

status measured_read(const char *path, const struct spectrum_size *size, struct measured *out, struct error *error) {
  *out = (struct measured){0};
  struct reading r = {.path = path, .size = *size, .kind = SINGLE, .out = out};
  TRY(file_input(path, error));
  FILE *file = fopen(path, "r");
  if (!file)
    return status_fail(error, errno == ENOENT ? STATUS_MISSING : STATUS_IO, "%s: %s", path, strerror(errno));
  status code = read_lines(&r, file, error);
  fclose(file);
  if (code == STATUS_OK && *r.complete)
    code = read_mass(&r, r.complete, "", &out->complete, error);
  if (code == STATUS_OK)
    code = take_rows(&r, error);
  free(r.rows);
  if (code)
    measured_release(out);
  return code;
}
