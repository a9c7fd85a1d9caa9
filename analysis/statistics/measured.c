/* Compares a measured spectrum with simulated ones: Kolmogorov's distance and a likelihood, above the complete mass. */
#include "analysis/statistics/measured.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "schemas/file.h"
#include "schemas/unit.h"

void measured_release(struct measured *measured) {
  free(measured->mass);
  free(measured->above);
  *measured = (struct measured){0};
}

/* The bin of threshold i: N(>= m) there, or the density up to the next threshold. The last class has no upper end, so
 * it has no density. */
static struct pooled_bin bin_of(const struct measured *measured, const struct pooled_form *form, size_t i) {
  const bool last = i + 1 == measured->n;
  const double above = measured->above[i];
  struct pooled_bin bin = {.lower = spectrum_size_of(&form->size, measured->mass[i]), .half_width = NAN};
  if (form->cumulative || last) {
    bin.count = (int64_t)llround(above);
    bin.upper = form->cumulative ? bin.lower : 0;
    bin.value = form->cumulative ? above : 0;
    return bin;
  }
  const double inside = above - measured->above[i + 1];
  bin.count = (int64_t)llround(inside);
  bin.upper = spectrum_size_of(&form->size, measured->mass[i + 1]);
  bin.value = inside / (bin.upper - bin.lower);
  return bin;
}

/* Single fragments are binned like simulated ones; thresholds are their own bins. */
status measured_bins(const struct measured *measured, const struct pooled_form *form, struct pooled_bin **bins,
                     size_t *count, struct error *error) {
  const struct pooled_form one = {.cumulative = form->cumulative, .size = form->size};
  *count = 0;
  if (measured->single && !form->cumulative) {
    const size_t first[2] = {0, measured->n};
    const struct pooled_runs runs = {1, first, measured->mass};
    return pooled_spectrum(&runs, &one, bins, count, error);
  }
  *bins = calloc(measured->n + 1, sizeof **bins);
  if (!*bins)
    return status_fail(error, STATUS_MEMORY, "no memory for a measured spectrum");
  for (size_t i = 0; i < measured->n; i++) {
    if (i > 0 && measured->mass[i] == measured->mass[i - 1])
      continue; /* equal masses: only the first has the right N(>= m) */
    const struct pooled_bin bin = bin_of(measured, form, i);
    if (bin.value > 0)
      (*bins)[(*count)++] = bin;
  }
  return STATUS_OK;
}

/* Ascending masses, a part of a sorted array. */
struct sorted {
  size_t n;
  const double *mass;
};

/* The number of masses of at least `mass`; with `beyond`, of more than `mass`. */
static double at_least(const struct sorted *sorted, double mass, bool beyond) {
  size_t low = 0, high = sorted->n;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (beyond ? sorted->mass[middle] > mass : sorted->mass[middle] >= mass)
      high = middle;
    else
      low = middle + 1;
  }
  return (double)(sorted->n - low);
}

/* Two shares of fragments above a mass, and their greatest difference so far. `own`: a run that is excluded from the
 * pool, or NULL. */
struct distance {
  const struct sorted *pool, *own;
  double whole, most; /* fragments of the pool */
};

static void look_at(struct distance *d, double mass, bool beyond, double share) {
  const double rest = at_least(d->pool, mass, beyond) - (d->own ? at_least(d->own, mass, beyond) : 0);
  d->most = fmax(d->most, fabs(rest / d->whole - share));
}

/* Distance of a sample of single masses: the shares differ most just before or after one of its masses. */
static double distance_of_sample(const struct sorted *sample, const struct sorted *pool, bool own) {
  struct distance d = {pool, own ? sample : NULL, (double)pool->n - (own ? (double)sample->n : 0), 0};
  for (size_t i = 0; i < sample->n; i++) {
    const double mass = sample->mass[i];
    look_at(&d, mass, false, at_least(sample, mass, false) / (double)sample->n);
    look_at(&d, mass, true, at_least(sample, mass, true) / (double)sample->n);
  }
  return d.most;
}

/* Distance of a run, evaluated at thresholds. */
static double distance_at(const struct measured *at, size_t first, const struct sorted *run,
                          const struct sorted *pool) {
  struct distance d = {pool, run, (double)(pool->n - run->n), 0};
  for (size_t i = first; i < at->n; i++)
    look_at(&d, at->mass[i], false, at_least(run, at->mass[i], false) / (double)run->n);
  return d.most;
}

static double measured_distance(const struct measured *m, size_t first, const struct sorted *pool) {
  if (m->single)
    return distance_of_sample(&(struct sorted){m->n - first, m->mass + first}, pool, false);
  struct distance d = {pool, NULL, (double)pool->n, 0};
  for (size_t i = first; i < m->n; i++)
    look_at(&d, m->mass[i], false, m->above[i] / m->above[first]);
  return d.most;
}

/* A class of masses from low to high, and how many measured fragments it has. */
struct mass_class {
  double low, high, measured;
};

/* Class c of single masses: the bins of the spectrum. The first begins at `from`; the last has no upper end. */
static struct mass_class bin_class(const struct sorted *mine, int bin, double from, bool first, bool last) {
  struct mass_class k = {first ? from : spectrum_edge(bin), last ? HUGE_VAL : spectrum_edge(bin + 1), 0};
  k.measured = at_least(mine, k.low, false) - at_least(mine, k.high, false);
  return k;
}

/* The class from threshold i to the next one. */
static struct mass_class threshold_class(const struct measured *m, size_t i) {
  if (i + 1 == m->n)
    return (struct mass_class){m->mass[i], HUGE_VAL, m->above[i]};
  return (struct mass_class){m->mass[i], m->mass[i + 1], m->above[i] - m->above[i + 1]};
}

/* The contribution of class k to the log-likelihood when the fragments are drawn from the pool. */
static double class_likelihood(struct mass_class k, const struct sorted *pool, double whole) {
  const double there = at_least(pool, k.low, false) - (isinf(k.high) ? 0 : at_least(pool, k.high, false));
  return k.measured * log((there + 0.5) / whole);
}

/* Log-likelihood of the measured fragments of at least `from`, which begin at index `first`. */
static double log_likelihood(const struct measured *m, size_t first, double from, const struct sorted *pool) {
  double sum = 0;
  if (!m->single) {
    const double whole = (double)pool->n + 0.5 * (double)(m->n - first);
    for (size_t i = first; i < m->n; i++)
      sum += class_likelihood(threshold_class(m, i), pool, whole);
    return sum;
  }
  const struct sorted mine = {m->n - first, m->mass + first};
  const int begin = spectrum_bin(from), end = spectrum_bin(m->mass[m->n - 1]);
  const double whole = (double)pool->n + 0.5 * (double)(end - begin + 1);
  for (int bin = begin; bin <= end; bin++)
    sum += class_likelihood(bin_class(&mine, bin, from, bin == begin, bin == end), pool, whole);
  return sum;
}

/* Copies the masses of run r of at least `from` into `room`, ascending. */
static struct sorted sort_run(const struct pooled_runs *runs, size_t r, double from, double *room) {
  size_t n = 0;
  for (size_t i = runs->first[r]; i < runs->first[r + 1]; i++)
    if (runs->masses[i] >= from && isfinite(runs->masses[i]))
      room[n++] = runs->masses[i];
  qsort(room, n, sizeof *room, sample_ascending);
  return (struct sorted){n, room};
}

static void compare_runs(const struct measured *m, size_t first, const struct pooled_runs *runs,
                         const struct sorted *pool, double *room, struct measured_match *out) {
  struct sample_moments moments = {0};
  size_t judged = 0, far = 0;
  for (size_t r = 0; r < runs->count; r++) {
    const struct sorted run = sort_run(runs, r, out->from, room);
    sample_add(&moments, (double)run.n);
    if (run.n == 0 || run.n == pool->n)
      continue;
    judged++;
    far += (m->single ? distance_of_sample(&run, pool, true) : distance_at(m, first, &run, pool)) >= out->distance;
  }
  out->simulated = sample_summarise_moments(&moments, 0.95);
  if (judged >= 3)
    out->share = (double)far / (double)judged;
}

status measured_compare(const struct measured *measured, const struct pooled_runs *runs, double complete,
                        struct measured_match *out, struct error *error) {
  const size_t all = runs->count ? runs->first[runs->count] : 0;
  size_t first = 0;
  complete = fmax(fmax(complete, measured->complete), 0); /* fmax ignores a NaN */
  while (first < measured->n && measured->mass[first] < complete)
    first++;
  *out = (struct measured_match){complete, 0, {0, NAN, NAN, NAN, NAN}, NAN, NAN, NAN};
  if (first == measured->n)
    return STATUS_OK;
  if (!measured->single || !(complete > 0))
    out->from = measured->mass[first];
  out->fragments = measured->above[first];
  double *masses = malloc((2 * all + 1) * sizeof *masses);
  if (!masses)
    return status_fail(error, STATUS_MEMORY, "no memory to compare a measured spectrum");
  const struct pooled_runs together = {1, (const size_t[]){0, all}, runs->masses};
  const struct sorted pool = sort_run(&together, 0, out->from, masses);
  if (pool.n > 0) {
    out->distance = measured_distance(measured, first, &pool);
    out->log_likelihood = log_likelihood(measured, first, out->from, &pool);
  }
  compare_runs(measured, first, runs, &pool, masses + all, out);
  free(masses);
  return STATUS_OK;
}

/* ---- Reads a measured spectrum. The file may come from an untrusted source: every cell is checked. ---- */

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
