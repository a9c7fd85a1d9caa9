/* Compares a measured spectrum with simulated ones: Kolmogorov's distance and a likelihood, above the complete mass. */
#include "analysis/statistics/statistics.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "engine/grow.h"
#include "engine/random.h"
#include "schemas/csv.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

void measured_release(struct measured *measured) {
  free(measured->mass);
  free(measured->above);
  *measured = (struct measured){0};
}

/* N(>= mass[i]) for a sieve table: the mass of a class over its mean mass, that of equal masses per decade; of the last
 * class, which has no upper end, over its lower one. whole: kg of the body that shares are of. */
static double number_above(const struct measured *measured, double whole, size_t i) {
  const double *mass = measured->mass, *above = measured->above, scale = measured->shares ? whole : 1;
  double sum = 0;
  for (; i < measured->n; i++) {
    const bool last = i + 1 == measured->n;
    if (mass[i] > 0 && (last || mass[i + 1] > mass[i]))
      sum += scale * (last ? above[i] / mass[i]
                           : (above[i] - above[i + 1]) * log(mass[i + 1] / mass[i]) / (mass[i + 1] - mass[i]));
  }
  return sum;
}

/* The bin of threshold i: N(>= m) there, or the density up to the next threshold. The last class has no upper end, so
 * it has no density. */
static struct pooled_bin bin_of(const struct measured *measured, const struct pooled_form *form, double whole,
                                size_t i) {
  const bool last = i + 1 == measured->n;
  const double above = measured->weighed ? number_above(measured, whole, i) : measured->above[i];
  struct pooled_bin bin = {.lower = spectrum_size_of(&form->size, measured->mass[i]), .half_width = NAN};
  if (form->cumulative || last) {
    bin.count = (int64_t)llround(above);
    bin.upper = form->cumulative ? bin.lower : 0;
    bin.value = form->cumulative ? above : 0;
    return bin;
  }
  const double inside = above - (measured->weighed ? number_above(measured, whole, i + 1) : measured->above[i + 1]);
  bin.count = (int64_t)llround(inside);
  bin.upper = spectrum_size_of(&form->size, measured->mass[i + 1]);
  bin.value = inside / (bin.upper - bin.lower);
  return bin;
}

/* Each bin gets the empty ones below it. Without them only bins that chance has filled would be drawn, and lie above
 * the mean of many runs. Above the last fragment nothing is known. */
static void take_empty_bins(size_t count, struct pooled_bin *bins, double complete) {
  for (size_t b = 0; b < count; b++) {
    const double first = complete > 0 ? complete : bins[0].lower, from = b > 0 ? fmax(bins[b - 1].upper, first) : first;
    if (!(from < bins[b].lower))
      continue;
    bins[b].value *= (bins[b].upper - bins[b].lower) / (bins[b].upper - from);
    bins[b].lower = from;
  }
}

/* Single fragments are binned like simulated ones; thresholds are their own bins. */
status measured_bins(const struct measured *measured, const struct pooled_form *form, double whole,
                     struct pooled_bin **bins, size_t *count, struct error *error) {
  const struct pooled_form one = {.cumulative = form->cumulative, .size = form->size};
  *count = 0;
  *bins = NULL;
  if (measured->single && !form->cumulative) {
    const size_t first[2] = {0, measured->n};
    const struct pooled_runs runs = {1, first, measured->mass};
    TRY(pooled_spectrum(&runs, &one, bins, count, error));
    take_empty_bins(*count, *bins, spectrum_size_of(&form->size, measured->complete));
    return STATUS_OK;
  }
  TRY(memory_array(bins, measured->n, sizeof **bins, "a measured spectrum", error));
  for (size_t i = 0; i < measured->n; i++) {
    if (i > 0 && measured->mass[i] == measured->mass[i - 1])
      continue; /* equal masses: only the first has the right N(>= m) */
    const struct pooled_bin bin = bin_of(measured, form, whole, i);
    if (bin.value > 0 && bin.lower > 0)
      (*bins)[(*count)++] = bin;
  }
  return STATUS_OK;
}

/* Ascending masses, a part of a sorted array. `above` (NULL: numbers are compared) has n + 1 sums: of the masses from
 * the i-th on. */
struct sorted {
  size_t n;
  const double *mass, *above;
};

/* The number, or the sum, of masses of at least `mass`; with `beyond`, of more than `mass`. */
static double at_least(const struct sorted *sorted, double mass, bool beyond) {
  size_t low = 0, high = sorted->n;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (beyond ? sorted->mass[middle] > mass : sorted->mass[middle] >= mass)
      high = middle;
    else
      low = middle + 1;
  }
  return sorted->above ? sorted->above[low] : (double)(sorted->n - low);
}

static double whole_of(const struct sorted *sorted) {
  return sorted->above ? sorted->above[0] : (double)sorted->n;
}

/* Two shares of fragments above a mass, and their greatest difference so far. `own`: a run that is excluded from the
 * pool, or NULL. */
struct distance {
  const struct sorted *pool, *own;
  double whole, most; /* of the pool: number or mass of its fragments */
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
  struct distance d = {pool, run, whole_of(pool) - whole_of(run), 0};
  for (size_t i = first; i < at->n; i++)
    look_at(&d, at->mass[i], false, at_least(run, at->mass[i], false) / whole_of(run));
  return d.most;
}

static double measured_distance(const struct measured *m, size_t first, const struct sorted *pool) {
  if (m->single)
    return distance_of_sample(&(struct sorted){m->n - first, m->mass + first, NULL}, pool, false);
  struct distance d = {pool, NULL, whole_of(pool), 0};
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
  const struct sorted mine = {m->n - first, m->mass + first, NULL};
  const int begin = spectrum_bin(from), end = spectrum_bin(m->mass[m->n - 1]);
  const double whole = (double)pool->n + 0.5 * (double)(end - begin + 1);
  for (int bin = begin; bin <= end; bin++)
    sum += class_likelihood(bin_class(&mine, bin, from, bin == begin, bin == end), pool, whole);
  return sum;
}

/* Copies the masses of at least `from` of some runs into `room`, ascending; with `weighed` their sums follow. */
static struct sorted sort_runs(const struct pooled_runs *runs, size_t count, const size_t *which, double from,
                               bool weighed, double *room) {
  size_t n = 0;
  for (size_t k = 0; k < count; k++)
    for (size_t i = runs->first[which[k]]; i < runs->first[which[k] + 1]; i++)
      if (runs->masses[i] >= from && isfinite(runs->masses[i]))
        room[n++] = runs->masses[i];
  qsort(room, n, sizeof *room, sample_ascending);
  if (!weighed)
    return (struct sorted){n, room, NULL};
  double *above = room + n;
  above[n] = 0;
  for (size_t i = n; i-- > 0;)
    above[i] = above[i + 1] + room[i];
  return (struct sorted){n, room, above};
}

/* Are some runs, joined, at least as far from the others as what was measured? */
static bool is_far(const struct measured *m, size_t first, const struct sorted *joined, const struct sorted *pool,
                   double distance) {
  return (m->single ? distance_of_sample(joined, pool, true) : distance_at(m, first, joined, pool)) >= distance;
}

/* Share of draws of `together` runs that are far. `which` holds the numbers of all runs, in any order. */
static double share_of_draws(const struct measured *m, size_t first, const struct pooled_runs *runs,
                             const struct sorted *pool, double *room, size_t *which,
                             const struct measured_match *match) {
  enum { DRAWS = 1000 };
  size_t far = 0, drawn = 0;
  for (uint64_t d = 0; d < DRAWS; d++) {
    for (size_t k = 0; k < match->together; k++) { /* the first steps of a shuffle */
      const size_t other = k + (size_t)(random_draw(0, RANDOM_RESAMPLE, d, k) * (double)(runs->count - k));
      const size_t one = which[k];
      which[k] = which[other];
      which[other] = one;
    }
    const struct sorted joined = sort_runs(runs, match->together, which, match->from, m->weighed, room);
    if (joined.n < 2 || joined.n == pool->n)
      continue;
    drawn++;
    far += is_far(m, first, &joined, pool, match->distance);
  }
  return drawn ? (double)far / (double)drawn : (double)NAN;
}

/* Share of single runs that are far. */
static double share_of_runs(const struct measured *m, size_t first, const struct pooled_runs *runs,
                            const struct sorted *pool, double *room, const struct measured_match *match) {
  size_t far = 0;
  for (size_t r = 0; r < runs->count; r++) {
    const struct sorted run = sort_runs(runs, 1, &r, match->from, m->weighed, room);
    if (run.n >= 2 && run.n < pool->n)
      far += is_far(m, first, &run, pool, match->distance);
  }
  return (double)far / (double)match->judged;
}

static void compare_runs(const struct measured *m, size_t first, const struct pooled_runs *runs,
                         const struct sorted *pool, double *room, size_t *which, struct measured_match *out) {
  double sum = 0;
  for (size_t r = 0; r < runs->count; r++) {
    which[r] = r;
    const struct sorted run = sort_runs(runs, 1, &r, out->from, m->weighed, room);
    sum += (double)run.n;
    out->judged += run.n >= 2 && run.n < pool->n;
  }
  out->simulated = sum / (double)runs->count;
  const double times = floor(out->fragments / out->simulated); /* NaN for a sieve table */
  if (out->simulated > 0 && out->simulated < MATCH_SMALL && times >= 2) {
    out->needed = (size_t)fmin(fmax(MATCH_GROUPS * times, MATCH_RUNS), MATCH_MOST);
    if (runs->count >= out->needed)
      out->together = (size_t)times;
  }
  if (out->judged < out->needed || !isfinite(out->distance))
    return;
  out->share = out->together > 1 ? share_of_draws(m, first, runs, pool, room, which, out)
                                 : share_of_runs(m, first, runs, pool, room, out);
}

status measured_compare(const struct measured *measured, const struct pooled_runs *runs, double complete,
                        struct measured_match *out, struct error *error) {
  const size_t all = runs->count ? runs->first[runs->count] : 0;
  size_t first = 0;
  complete = fmax(fmax(complete, measured->complete), 0); /* fmax ignores a NaN */
  while (first < measured->n && measured->mass[first] < complete)
    first++;
  *out = (struct measured_match){complete, 0, NAN, NAN, NAN, NAN, 0, MATCH_RUNS, 1};
  if (first == measured->n || !(measured->above[first] > 0))
    return STATUS_OK;
  if (!measured->single || !(complete > 0))
    out->from = measured->mass[first];
  out->fragments = measured->weighed ? (double)NAN : measured->above[first];
  OWNED double *masses = NULL;
  TRY(memory_array(&masses, 2 * (2 * all + 1), sizeof *masses, "a measured spectrum", error));
  OWNED size_t *which = NULL;
  TRY(memory_array(&which, runs->count + 1, sizeof *which, "a measured spectrum", error));
  const struct pooled_runs one = {1, (const size_t[]){0, all}, runs->masses};
  const struct sorted pool = sort_runs(&one, 1, (const size_t[]){0}, out->from, measured->weighed, masses);
  const size_t left = measured->n - first;
  if (pool.n > 0 && left > 1 && !(out->fragments < 2)) { /* one fragment or class has no shape */
    out->distance = measured_distance(measured, first, &pool);
    out->log_likelihood = measured->weighed ? (double)NAN : log_likelihood(measured, first, out->from, &pool);
  }
  compare_runs(measured, first, runs, &pool, masses + 2 * all + 1, which, out);
  return STATUS_OK;
}

/* ---- Reads a measured spectrum. The file may come from an untrusted source: every cell is checked. ---- */

enum { MOST_ROWS = 10000000 };

/* What the second column says about the fragments of a row. */
enum amount { SINGLE, COUNT, COUNT_ABOVE, RETAINED, RETAINED_ABOVE, PASSING };

struct row {
  double mass, amount; /* the mass comes first: sample_ascending() sorts by it */
  int64_t line;        /* of the file */
};

struct reading {
  const char *path;
  struct csv csv;
  struct spectrum_size size;
  size_t place, amount; /* indices of columns */
  bool by_size;         /* fragments are given by size */
  bool has_density;     /* a remark has it */
  enum amount kind;
  const char *place_unit, *amount_unit, *amount_name; /* parts of the file */
  const char *complete;                               /* "# complete from", and its line */
  int64_t complete_line;
  struct row *rows;
  size_t count, room;
  struct measured *out;
};

enum { NO_COLUMN = CSV_CELLS };

static status refuse(const struct reading *r, struct error *error, const char *what, const char *text) {
  return status_fail(error, STATUS_CONTENT, "%s:%lld: %s '%.80s'", r->path, (long long)r->csv.line, what, text);
}

static char *trim(char *text) {
  text += strspn(text, " \t\"");
  size_t n = strlen(text);
  while (n > 0 && strchr(" \t\"", text[n - 1]))
    text[--n] = '\0';
  return text;
}

/* A decimal comma of a remark: it separates no cells, so it is read as in quotes, whatever mark the cells have. */
static status take_comma(struct reading *r, char *value, struct error *error) {
  struct csv_cell cell = {.text = value, .quoted = true};
  const char mark = r->csv.mark;
  r->csv.mark = '\0';
  const bool good = csv_number(&r->csv, &cell);
  r->csv.mark = mark;
  return good ? STATUS_OK
              : status_fail(error, STATUS_CONTENT, "%s:%lld: %s", r->path, (long long)r->csv.line, r->csv.wrong);
}

/* "# density: 2.7 g/cm^3" */
static status take_remark(struct reading *r, char *text, struct error *error) {
  char *colon = strchr(text, ':');
  if (!colon)
    return STATUS_OK;
  *colon = '\0';
  const char *key = trim(text);
  char *value = trim(colon + 1);
  if (strcmp(key, "source") == 0)
    snprintf(r->out->source, sizeof r->out->source, "%s", value);
  const bool complete = strcmp(key, "complete from") == 0;
  if (!complete && strcmp(key, "density") != 0)
    return STATUS_OK;
  TRY(take_comma(r, value, error));
  if (complete) {
    r->complete = value;
    r->complete_line = r->csv.line;
    return STATUS_OK;
  }
  double density;
  if (unit_is_bare(value) || unit_read(value, "kg/m^3", &density, error) || !(density > 0))
    return refuse(r, error, "the density needs a number and a unit, such as 2.7 g/cm^3, not", value);
  if (r->has_density && density != r->size.density)
    return refuse(r, error, "another density is above this one; leave out", value);
  r->has_density = true;
  r->size.density = density;
  return STATUS_OK;
}

/* The names that laboratories use, in lower case with single spaces. "percent" and "%" in a name are its unit. */
static const struct meaning {
  enum { MASS, SIZE, AMOUNT, LABEL } of;
  enum amount kind;
  const char *const *names;
} meanings[] = {
    {MASS, SINGLE, (const char *const[]){"mass", "fragment mass", "m", NULL}},
    {SIZE, SINGLE,
     (const char *const[]){"size", "diameter", "fragment size", "particle size", "grain size", "sieve", "sieve size",
                           "sieve opening", "aperture", "aperture size", "sieve aperture", "opening", "d", NULL}},
    {AMOUNT, COUNT,
     (const char *const[]){"count", "counts", "number", "n", "frequency", "number of fragments", "fragments",
                           "fragment count", "number of particles", "particle count", NULL}},
    {AMOUNT, COUNT_ABOVE,
     (const char *const[]){"cumulative", "cumulative count", "cumulative number", "count above", "number above",
                           "n(>m)", "n(>=m)", "n(>d)", "n(>=d)", "n(>l)", "n(>=l)", NULL}},
    {AMOUNT, RETAINED,
     (const char *const[]){"retained", "mass retained", "weight retained", "retained mass", "retained weight",
                           "mass in class", "mass per class", "class mass", "mass fraction", "mass share", NULL}},
    {AMOUNT, RETAINED_ABOVE,
     (const char *const[]){"cumulative retained", "cumulative mass retained", "cumulative weight retained",
                           "retained cumulative", "mass above", "coarser", "oversize", "cumulative oversize", NULL}},
    {AMOUNT, PASSING,
     (const char *const[]){"passing", "cumulative passing", "mass passing", "weight passing", "cumulative mass passing",
                           "finer", "finer by mass", "finer by weight", "undersize", "cumulative undersize",
                           "cumulative finer", NULL}},
    {LABEL, SINGLE,
     (const char *const[]){"name", "label", "id", "no", "no.", "nr", "sample", "specimen", "fragment", "remark",
                           "remarks", "note", "notes", "comment", NULL}},
};

/* "Cumulative % passing" becomes "cumulative passing"; *percent is then true. Words are those between blanks, '_' and
 * '-'. */
static void plain_name(const char *name, char *out, size_t size, bool *percent) {
  static const char between[] = " \t\r\n_-";
  *out = '\0';
  *percent = false;
  for (name += strspn(name, between); *name; name += strspn(name, between)) {
    const size_t length = strcspn(name, between);
    if ((length == 1 && *name == '%') || (length == 7 && strncasecmp(name, "percent", 7) == 0))
      *percent = true;
    else
      text_append(out, size, "%s%.*s", *out ? " " : "", (int)(length < size ? length : size), name);
    name += length;
  }
  for (; *out; out++)
    *out = (char)tolower((unsigned char)*out);
}

static const struct meaning *find_meaning(const char *name) {
  for (size_t k = 0; k < sizeof meanings / sizeof meanings[0]; k++)
    if (text_is_one_of(name, meanings[k].names))
      return &meanings[k];
  return NULL;
}

static status take_name(struct reading *r, size_t i, struct error *error) {
  char name[80], *cell = r->csv.cells[i].text;
  bool percent;
  plain_name(cell, name, sizeof name, &percent);
  const struct meaning *meaning = find_meaning(name); /* "N(>m)" has no unit */
  const char *unit = meaning ? "" : csv_take_unit(cell);
  plain_name(cell, name, sizeof name, &percent);
  if (!meaning)
    meaning = find_meaning(name);
  if (!meaning)
    return refuse(r, error,
                  "no such column: name mass (g) or size (mm), alone or with count, cumulative (the number from this "
                  "mass or size on), retained (g), cumulative retained (%), passing (%); and name, id, note; not",
                  cell);
  if (meaning->of == LABEL)
    return STATUS_OK;
  const bool amount = meaning->of == AMOUNT;
  size_t *const place = amount ? &r->amount : &r->place;
  if (*place != NO_COLUMN && !amount && (meaning->of == SIZE) != r->by_size)
    return refuse(r, error,
                  "a mass beside a size: name it retained (g) if it is the mass on a sieve; leave the size out if it "
                  "is the mass of a fragment; not",
                  cell);
  if (*place != NO_COLUMN)
    return refuse(r, error, "two columns say the same; leave out", cell);
  *place = i;
  if (!amount) {
    r->by_size = meaning->of == SIZE;
    r->place_unit = unit;
    return STATUS_OK;
  }
  r->kind = meaning->kind;
  r->amount_name = cell;
  r->amount_unit = *unit || !percent ? unit : "%";
  const bool counts = r->kind == COUNT || r->kind == COUNT_ABOVE;
  if (counts && *r->amount_unit && strcmp(r->amount_unit, "1") != 0)
    return refuse(r, error, "a number of fragments has no unit; not", r->amount_unit);
  return STATUS_OK;
}

static status take_names(struct reading *r, struct error *error) {
  r->place = r->amount = NO_COLUMN;
  for (size_t i = 0; i < r->csv.count; i++)
    TRY(take_name(r, i, error));
  if (r->place == NO_COLUMN)
    return refuse(r, error, "the first line names the columns: mass (g) or size (mm), alone or with count; not",
                  r->csv.cells[0].text);
  if (r->by_size && !(r->size.density > 0))
    return status_fail(error, STATUS_CONTENT,
                       "%s:%lld: sizes need a density: add a line `# density: 2.7 g/cm^3` above the names", r->path,
                       (long long)r->csv.line);
  return STATUS_OK;
}

enum { QUANTITY = 300 };

/* Gives a bare number the unit of its column. */
static status add_unit(const struct reading *r, const char *text, const char *unit, char quantity[QUANTITY],
                       struct error *error) {
  const bool bare = unit_is_bare(text), fraction = strcmp(unit, "1") == 0;
  if (bare && !*unit)
    return refuse(r, error, "a number without a unit; write mass (g), size (mm), retained (%) above the column, not",
                  text);
  snprintf(quantity, QUANTITY, "%.120s%s%.120s", text, bare && !fraction ? " " : "", bare && !fraction ? unit : "");
  return STATUS_OK;
}

/* The unit of a mass: kg, or also kg/m of a two-dimensional scene. */
static const char *mass_unit(const struct reading *r, const char *quantity) {
  double ignored;
  return r->size.dimensions == 2 && unit_read(quantity, "kg/m", &ignored, NULL) == STATUS_OK ? "kg/m" : "kg";
}

/* Reads "0.5" in the unit of the column, or "0.5 g", as a mass in kg. */
static status read_mass(const struct reading *r, const char *text, const char *unit, double *mass,
                        struct error *error) {
  char quantity[QUANTITY];
  double place;
  TRY(add_unit(r, text, unit, quantity, error));
  const char *expected = r->by_size ? "m" : mass_unit(r, quantity);
  const status code = unit_read(quantity, expected, &place, error);
  r->out->bodies |= r->size.dimensions == 2 && strcmp(expected, "kg") == 0;
  if (code == STATUS_OK && r->kind >= RETAINED && place == 0) { /* below the finest sieve */
    *mass = 0;
    return STATUS_OK;
  }
  if (code || !(place > 0)) {
    char why[sizeof error->message] = "";
    if (code && error)
      snprintf(why, sizeof why, ": %.300s", error->message);
    return status_fail(error, STATUS_CONTENT, "%s:%lld: expected a %s above 0, not '%.80s'%s", r->path,
                       (long long)r->csv.line, r->by_size ? "size" : "mass", quantity, why);
  }
  *mass = r->by_size ? spectrum_size_mass(&r->size, place) : place;
  if (!(*mass > 0) || !isfinite(*mass)) /* the cube of a size can exceed the range of a double */
    return refuse(r, error, "no fragment has the mass of", quantity);
  return STATUS_OK;
}

/* "# complete from": a mass, or a size where the column has sizes. */
static status read_complete(struct reading *r, struct error *error) {
  double *mass = &r->out->complete;
  r->csv.line = r->complete_line;
  if (r->by_size && !unit_is_bare(r->complete) &&
      unit_read(r->complete, mass_unit(r, r->complete), mass, NULL) == STATUS_OK && *mass > 0)
    return STATUS_OK;
  return read_mass(r, r->complete, "", mass, error);
}

/* A number of fragments, a mass in kg, or a share of the mass. */
static status read_amount(struct reading *r, const char *text, double *amount, struct error *error) {
  struct unit unit, mass, of_length;
  char quantity[QUANTITY];
  if (r->kind == COUNT || r->kind == COUNT_ABOVE) {
    const size_t whole = strspn(text, "0123456789");
    if (whole > 0 && whole <= 3 && *text != '0' && text[whole] == '.' && strlen(text) == whole + 4)
      return refuse(r, error, "a number of fragments, or a separator of thousands; not", text);
    if (!unit_is_bare(text) || unit_read(text, "1", amount, error) || !(*amount >= 0))
      return refuse(r, error, "expected a number of fragments, not", text);
    return STATUS_OK;
  }
  TRY(unit_parse("kg", &mass, error));
  TRY(unit_parse("kg/m", &of_length, error));
  if (*r->amount_unit && unit_parse(r->amount_unit, &unit, error))
    return refuse(r, error, "the unit of masses is g, kg or %, not", r->amount_unit);
  const bool weighed = *r->amount_unit && (unit_same_dimension(&unit, &mass) ||
                                           (r->size.dimensions == 2 && unit_same_dimension(&unit, &of_length)));
  r->out->shares = !weighed;
  if (weighed && r->kind == PASSING)
    return refuse(r, error, "the mass that passes is given in % of the whole, not in", r->amount_unit);
  TRY(add_unit(r, text, r->amount_unit, quantity, error));
  if (unit_read(quantity, weighed ? mass_unit(r, quantity) : "1", amount, error))
    return refuse(r, error, "expected a mass of fragments, not", quantity);
  if (!(*amount >= 0) || (!weighed && *amount > 1))
    return refuse(r, error, weighed ? "expected a mass of 0 or more, not" : "expected a share from 0 to 100 %, not",
                  quantity);
  if (r->kind == PASSING)
    *amount = 1 - *amount;
  return STATUS_OK;
}

static status take_row(struct reading *r, struct error *error) {
  struct row row = {.amount = 1, .line = r->csv.line};
  struct csv_cell *place = &r->csv.cells[r->place], *amount = r->kind == SINGLE ? NULL : &r->csv.cells[r->amount];
  if (!csv_number(&r->csv, place) || (amount && !csv_number(&r->csv, amount)))
    return status_fail(error, STATUS_CONTENT, "%s:%lld: %s", r->path, (long long)r->csv.line, r->csv.wrong);
  const bool pan = r->kind >= RETAINED && strcasecmp(place->text, "pan") == 0;
  if (!pan)
    TRY(read_mass(r, place->text, r->place_unit, &row.mass, error));
  if (amount)
    TRY(read_amount(r, amount->text, &row.amount, error));
  if (r->count == MOST_ROWS)
    return status_fail(error, STATUS_CONTENT, "%s: more than %d rows", r->path, MOST_ROWS);
  TRY(grow_or_fail(&r->rows, &r->room, r->count + 1, sizeof *r->rows, r->path, error));
  r->rows[r->count++] = row;
  return STATUS_OK;
}

static status read_items(struct reading *r, struct error *error) {
  enum csv_item item;
  while ((item = csv_next(&r->csv)) != CSV_END)
    switch (item) {
    case CSV_REMARK: TRY(take_remark(r, r->csv.cells[0].text, error)); break;
    case CSV_NAMES: TRY(take_names(r, error)); break;
    case CSV_RECORD: TRY(take_row(r, error)); break;
    default: return status_fail(error, STATUS_CONTENT, "%s:%lld: %s", r->path, (long long)r->csv.line, r->csv.wrong);
    }
  if (r->count == 0)
    return status_fail(error, STATUS_CONTENT, "%s: there is no row with a fragment", r->path);
  return *r->complete ? read_complete(r, error) : STATUS_OK;
}

/* A column `number` or `n` may count fragments or number the rows. */
static bool numbers_rows(const struct reading *r) {
  if (r->kind != COUNT || r->count < 2 ||
      (strcasecmp(r->amount_name, "number") != 0 && strcasecmp(r->amount_name, "n") != 0))
    return false;
  for (size_t i = 0; i < r->count; i++)
    if (r->rows[i].amount != (double)(i + 1))
      return false;
  return true;
}

/* Converts rows into what is at least as heavy, at ascending masses. */
static status take_rows(struct reading *r, struct error *error) {
  struct measured *out = r->out;
  const bool cumulative = r->kind == COUNT_ABOVE || r->kind == RETAINED_ABOVE || r->kind == PASSING;
  if (numbers_rows(r))
    return status_fail(
        error, STATUS_CONTENT,
        "%s: column '%s' is 1, 2, 3, ...: name it id if it numbers the rows, count if it counts fragments", r->path,
        r->amount_name);
  out->single = r->kind == SINGLE;
  out->weighed = r->kind >= RETAINED;
  TRY(memory_array(&out->mass, r->count, sizeof *out->mass, r->path, error));
  TRY(memory_array(&out->above, r->count, sizeof *out->above, r->path, error));
  out->n = r->count;
  qsort(r->rows, r->count, sizeof *r->rows, sample_ascending); /* by mass */
  double above = 0;
  for (size_t i = r->count; i-- > 0;) {
    if (cumulative && r->rows[i].amount < above)
      return status_fail(error, STATUS_CONTENT,
                         "%s:%lld: '%s' is %s here than on line %lld, which has a larger %s; it counts from its %s %s",
                         r->path, (long long)r->rows[i].line, r->amount_name, r->kind == PASSING ? "larger" : "smaller",
                         (long long)r->rows[i + 1].line, r->by_size ? "size" : "mass", r->by_size ? "size" : "mass",
                         r->kind == PASSING ? "downwards" : "upwards");
    above = cumulative ? r->rows[i].amount : above + r->rows[i].amount;
    out->mass[i] = r->rows[i].mass;
    out->above[i] = above;
  }
  if (!(above > 0))
    return status_fail(error, STATUS_CONTENT, "%s: there is no fragment in it", r->path);
  if (r->kind == RETAINED && r->out->shares && above > 1.01) /* the classes are rounded */
    return status_fail(
        error, STATUS_CONTENT,
        "%s: %.4g %% of the mass are in its classes; name the column cumulative retained (%%) if '%s' is "
        "what a sieve and all coarser ones retain, or give masses, as retained (g)",
        r->path, 100 * above, r->amount_name);
  if (!isfinite(above))
    return status_fail(error, STATUS_CONTENT, "%s: there are more fragments than a number can hold in it", r->path);
  return STATUS_OK;
}

status measured_read(const char *path, const struct spectrum_size *size, struct measured *out, struct error *error) {
  *out = (struct measured){0};
  struct reading r = {.path = path, .size = *size, .complete = "", .out = out};
  TRY(csv_open(&r.csv, path, "measured spectrum", error));
  status code = read_items(&r, error);
  if (code == STATUS_OK)
    code = take_rows(&r, error);
  csv_close(&r.csv);
  free(r.rows);
  if (code)
    measured_release(out);
  return code;
}
