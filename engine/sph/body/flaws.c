/* Drawing flaws, finding their owners, and the lists of thresholds that the loops read. */
#include "engine/sph/body/flaws.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "engine/random.h"
#include "engine/sph/body/kd_tree.h"
#include "schemas/memory.h"

/* Sorts the particles of a body into the cubes of a turned grid. */

struct place {
  int64_t cube[3];
  uint32_t particle;
};

static int by_cube(const void *a, const void *b) {
  const struct place *p = a, *q = b;
  for (int d = 0; d < 3; d++)
    if (p->cube[d] != q->cube[d])
      return p->cube[d] < q->cube[d] ? -1 : 1;
  return (p->particle > q->particle) - (p->particle < q->particle);
}

/* Finds the cube of each particle. `shift` is in cube widths. */
static void find_cubes(const struct sph_particles *p, struct sph_range range, const double frame[3][3], double width,
                       const double shift[3], struct place *place) {
  for (size_t i = 0; i < range.n; i++) {
    const size_t k = range.first + i;
    place[i].particle = (uint32_t)i;
    for (int d = 0; d < 3; d++) {
      const double along = frame[d][0] * p->x[k] + frame[d][1] * p->y[k] + frame[d][2] * p->z[k];
      place[i].cube[d] = (int64_t)fmax(-1e18, fmin(1e18, floor(along / width + shift[d])));
    }
  }
}

status sph_flaws_cells(uint64_t seed, uint64_t body, double width, const struct sph_particles *p,
                       struct sph_range range, struct sph_cells **out, struct error *error) {
  double frame[3][3], shift[3];
  struct sph_cells *cells = *out = malloc(sizeof *cells + range.n * sizeof *cells->of);
  OWNED struct place *place = malloc((range.n + 1) * sizeof *place);
  if (!cells || !place) {
    free(cells);
    *out = NULL;
    return status_fail(error, STATUS_MEMORY, "no memory for the cells of %zu particles", range.n);
  }
  *cells = (struct sph_cells){.particles = range.n, .of = (uint32_t *)(cells + 1)};
  random_rotation(seed, RANDOM_CELL, body, 0, frame);
  for (int d = 0; d < 3; d++)
    shift[d] = random_draw(seed, RANDOM_CELL, body, 1 + (uint64_t)d);
  find_cubes(p, range, frame, width, shift, place);
  qsort(place, range.n, sizeof *place, by_cube);
  for (size_t i = 0; i < range.n; i++) {
    cells->count += i == 0 || memcmp(place[i].cube, place[i - 1].cube, sizeof place[i].cube) != 0;
    cells->of[place[i].particle] = (uint32_t)(cells->count - 1);
  }
  return STATUS_OK;
}

struct placed {
  size_t owner;
  double log_strain;
};

/* Flaws in the order of drawing, of owners: particles or cells. */
struct drawn {
  const struct sph_flaw_law *law;
  size_t n;            /* owners */
  const double *share; /* by owner: part of the body's volume; NULL: 1/n */
  unsigned char *has;  /* by owner: a flaw, or none allowed */
  struct placed *flaw;
  size_t count, capacity;
  double log_kv;
};

static status push(struct drawn *d, size_t owner, double rank, struct error *error) {
  if (!grow_room(&d->flaw, &d->capacity, d->count + 1, sizeof *d->flaw))
    return status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", d->count);
  d->flaw[d->count++] = (struct placed){owner, (log(rank) - d->log_kv) / d->law->weibull.m};
  d->has[owner] = 1;
  return STATUS_OK;
}

/* Counting sort by owner. It keeps the order of drawing, which is that of ascending strain. */
static struct sph_flaws *sort_by_owner(const struct drawn *d) {
  struct sph_flaws *flaws = memory_small(1, sizeof *flaws);
  flaws->particles = d->n;
  flaws->count = d->count;
  flaws->first = calloc(d->n + 2, sizeof *flaws->first);
  flaws->log_strain = malloc(d->count * sizeof *flaws->log_strain);
  if (!flaws->first || !flaws->log_strain) {
    sph_flaws_free(flaws);
    return NULL;
  }
  size_t *next = flaws->first + 1;
  for (size_t f = 0; f < d->count; f++)
    next[d->flaw[f].owner + 1]++;
  for (size_t i = 1; i <= d->n; i++)
    next[i] += next[i - 1];
  for (size_t f = 0; f < d->count; f++)
    flaws->log_strain[next[d->flaw[f].owner]++] = d->flaw[f].log_strain;
  return flaws;
}

void sph_flaws_free(struct sph_flaws *flaws) {
  if (!flaws)
    return;
  free(flaws->first);
  free(flaws->log_strain);
  free(flaws->cells);
  free(flaws);
}

/* ---- flaws as points in a shape ---- */

#define NOBODY ((size_t)-1)

struct places {
  const struct sph_shape *shape;
  double half;
  const struct sph_kd_tree *nearest;
  const unsigned char *exempt;
  const struct sph_cells *cells; /* NULL: particles own flaws */
};

void sph_flaws_point(uint64_t seed, uint64_t body, uint64_t flaw, const struct sph_shape *shape, double point[3]) {
  uint64_t bits[4], draw = 0;
  double uniform[3];
  do { /* repeats for meshes only: a mesh fills at least a thousandth of its box */
    random_bits(seed, RANDOM_FLAW_PLACE, body, flaw + (draw++ << 40), bits);
    for (int k = 0; k < 3; k++)
      uniform[k] = random_uniform(bits[k]);
  } while (!sph_shape_place(shape, uniform, point));
}

/* The owner of flaw `flaw`; NOBODY where its place has none. */
static size_t owner_of(const struct places *places, const struct sph_flaw_law *law, uint64_t flaw) {
  double point[3];
  sph_flaws_point(law->seed, law->body, flaw, places->shape, point);
  if (fabs(point[2]) > places->half)
    return NOBODY;
  const size_t i = sph_kd_tree_find(places->nearest, point);
  if (places->exempt[i])
    return NOBODY;
  return places->cells ? places->cells->of[i] : i;
}

/* Draws flaws in the order of their strength. Then gives each owner without a flaw the first one that it would get if
 * drawing went on. */
static status draw(struct drawn *d, const struct places *places, struct error *error) {
  const struct sph_flaw_law *law = d->law;
  const uint64_t number = (uint64_t)ceil((double)d->n * (log((double)d->n) + 0.5772156649015329));
  double rank = 0;
  for (uint64_t f = 0; f < number; f++) {
    if (law->draw == SPH_FLAWS_POISSON)
      rank -= log1p(-random_draw(law->seed, RANDOM_FLAW_STRENGTH, law->body, f));
    else
      rank = (double)(f + 1);
    const size_t owner = owner_of(places, law, f);
    if (owner != NOBODY)
      TRY(push(d, owner, rank, error));
  }
  for (size_t i = 0; i < d->n; i++) {
    if (d->has[i])
      continue;
    const double wait = -log1p(-random_draw(law->seed, RANDOM_FLAW_STRENGTH, law->body, ~(uint64_t)i));
    TRY(push(d, i, rank + wait * (d->share ? 1 / d->share[i] : (double)d->n), error));
  }
  return STATUS_OK;
}

/* Marks the particles in the ends of the body. NULL without memory. */
static unsigned char *find_ends(const struct sph_particles *p, struct sph_range range, double half) {
  unsigned char *exempt = malloc(range.n);
  for (size_t i = 0; exempt && i < range.n; i++)
    exempt[i] = fabs(p->z[range.first + i]) > half;
  return exempt;
}

static bool is_graded(const struct sph_particles *p, struct sph_range range) {
  for (size_t i = 1; i < range.n; i++)
    if (p->mass[range.first + i] != p->mass[range.first])
      return true;
  return false;
}

/* Shares of the body's mass. NULL without memory. */
static double *find_shares(const struct sph_particles *p, struct sph_range range, const struct sph_cells *cells) {
  double *share = calloc(cells ? cells->count : range.n, sizeof *share);
  for (size_t i = 0; share && i < range.n; i++)
    share[cells ? cells->of[i] : i] += p->mass[range.first + i] / range.mass;
  return share;
}

/* By owner: all of its particles are exempt. NULL without memory. */
static unsigned char *exempt_owners(const struct sph_cells *cells, const unsigned char *exempt, size_t particles) {
  unsigned char *out = malloc(particles);
  if (!out)
    return NULL;
  memset(out, 1, particles);
  for (size_t i = 0; i < particles; i++)
    out[cells ? cells->of[i] : i] &= exempt[i];
  return out;
}

status sph_flaws_place(const struct sph_flaw_law *law, const struct sph_shape *shape, const struct sph_particles *p,
                       struct sph_range range, double half, struct sph_flaws **out, struct error *error) {
  *out = NULL;
  const double m = law->weibull.m, k = law->weibull.k;
  const double volume = sph_shape_volume(shape) / (law->solid_ratio > 0 ? law->solid_ratio : 1);
  if (!(m > 0 && k > 0 && volume > 0 && isfinite(m + k + volume)))
    return status_fail(error, STATUS_CONTENT,
                       "flaws need a positive m, k and volume, not m %g, k %g m^-3, volume %g m^3.", m, k, volume);
  OWNED struct sph_cells *cells = NULL; /* the owners of flaws; NULL: particles */
  OWNED struct sph_kd_tree *nearest = NULL;
  if (law->cell_width > 0)
    TRY(sph_flaws_cells(law->seed, law->body, law->cell_width, p, range, &cells, error));
  const size_t n = cells ? cells->count : range.n;
  const bool unequal = cells || is_graded(p, range);
  OWNED unsigned char *ends = find_ends(p, range, half);
  OWNED unsigned char *has = ends ? exempt_owners(cells, ends, range.n) : NULL;
  OWNED double *share = unequal ? find_shares(p, range, cells) : NULL;
  if (!has || (unequal && !share))
    return status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", range.n);
  if (!memchr(has, 0, n))
    return status_fail(
        error, STATUS_CONTENT,
        "all %zu particles of a body lie in its flaw-free ends: shorten stretch.flaw_free or raise fidelity.particles.",
        range.n);
  TRY(sph_kd_tree_create(range.n, p->x + range.first, p->y + range.first, p->z + range.first, &nearest, error));
  struct drawn d = {.law = law, .n = n, .share = share, .has = has, .log_kv = log(k) + log(volume)};
  status code = draw(&d, &(struct places){shape, half, nearest, ends, cells}, error);
  if (!code && !(*out = sort_by_owner(&d)))
    code = status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", d.count);
  free(d.flaw);
  TRY(code);
  (*out)->particles = range.n;
  (*out)->cells = cells;
  cells = NULL;
  return STATUS_OK;
}

/* ---- lists of thresholds ---- */

struct sph_flaws_lists {
  size_t lists, count; /* number of lists (one per owner of flaws); of flaws */
  size_t particles;
  uint32_t *cell; /* by particle: its list; NULL: each has its own */
  /* exact */
  size_t *first;
  double *strain;
  /* compact */
  double *lowest, *exponent;
  uint32_t *total;
};

void sph_flaws_lists_free(void *prepared) {
  struct sph_flaws_lists *w = prepared;
  if (!w)
    return;
  free(w->cell);
  free(w->first);
  free(w->strain);
  free(w->lowest);
  free(w->exponent);
  free(w->total);
  free(w);
}

static bool fill_exact(struct sph_flaws_lists *w, const struct sph_flaws *flaws) {
  w->first = malloc((w->lists + 1) * sizeof *w->first);
  w->strain = malloc((w->count ? w->count : 1) * sizeof *w->strain);
  if (!w->first || !w->strain)
    return false;
  for (size_t i = 0; i <= w->lists; i++)
    w->first[i] = flaws->first[i];
  for (size_t f = 0; f < w->count; f++)
    w->strain[f] = exp(flaws->log_strain[f]);
  return true;
}

static bool fill_compact(struct sph_flaws_lists *w, const struct sph_flaws *flaws) {
  const size_t room = w->lists ? w->lists : 1;
  w->lowest = malloc(room * sizeof *w->lowest);
  w->exponent = malloc(room * sizeof *w->exponent);
  w->total = malloc(room * sizeof *w->total);
  if (!w->lowest || !w->exponent || !w->total)
    return false;
  for (size_t i = 0; i < w->lists; i++) {
    const size_t first = flaws->first[i], last = flaws->first[i + 1];
    w->total[i] = (uint32_t)(last - first);
    w->lowest[i] = last > first ? exp(flaws->log_strain[first]) : HUGE_VAL;
    const double span = last > first ? flaws->log_strain[last - 1] - flaws->log_strain[first] : 0;
    w->exponent[i] = span > 0 ? log((double)(last - first)) / span : 0;
  }
  return true;
}

status sph_flaws_lists_make(const struct sph_flaws *flaws, bool compact, void **out, struct error *error) {
  struct sph_flaws_lists *w = memory_small(1, sizeof *w);
  w->particles = flaws->particles;
  w->lists = flaws->cells ? flaws->cells->count : flaws->particles;
  w->count = flaws->count;
  bool enough = (compact ? fill_compact : fill_exact)(w, flaws);
  if (enough && flaws->cells) {
    w->cell = malloc(w->particles * sizeof *w->cell);
    enough = w->cell != NULL;
    if (enough)
      memcpy(w->cell, flaws->cells->of, w->particles * sizeof *w->cell);
  }
  if (!enough) {
    sph_flaws_lists_free(w);
    return status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", flaws->count);
  }
  *out = w;
  return STATUS_OK;
}

static size_t list_of(const struct sph_flaws_lists *w, size_t particle) {
  return w->cell ? w->cell[particle] : particle;
}

double sph_flaws_lowest(const struct sph_flaws_lists *w, size_t particle) {
  const size_t i = list_of(w, particle);
  if (!w->strain)
    return w->lowest[i];
  return w->first[i] < w->first[i + 1] ? w->strain[w->first[i]] : HUGE_VAL;
}

uint32_t sph_flaws_total(const struct sph_flaws_lists *w, size_t particle) {
  const size_t i = list_of(w, particle);
  return w->strain ? (uint32_t)(w->first[i + 1] - w->first[i]) : w->total[i];
}

static uint32_t active_exact(const struct sph_flaws_lists *w, size_t i, double strain, double bracket[2]) {
  const size_t first = w->first[i], last = w->first[i + 1];
  size_t low = first, high = last;
  while (low < high) { /* first flaw stronger than the strain */
    const size_t middle = low + (high - low) / 2;
    if (w->strain[middle] <= strain)
      low = middle + 1;
    else
      high = middle;
  }
  bracket[0] = low > first ? w->strain[low - 1] : -HUGE_VAL;
  bracket[1] = low < last ? w->strain[low] : HUGE_VAL;
  return (uint32_t)(low - first);
}

static uint32_t active_compact(const struct sph_flaws_lists *w, size_t i, double strain, double bracket[2]) {
  const double lowest = w->lowest[i], q = w->exponent[i], total = (double)w->total[i];
  bracket[0] = -HUGE_VAL;
  bracket[1] = lowest;
  if (!(strain >= lowest))
    return 0;
  double open = total;
  if (q > 0 && lowest > 0) { /* else one flaw, all equal, or thresholds of 0: all open at once */
    const double law = floor(pow(strain / lowest, q) * (1 + 1e-12)); /* the highest is reached, not missed */
    open = law < 1 ? 1 : law < total ? law : total;
  }
  bracket[0] = open > 1 && q > 0 ? lowest * pow(open, 1 / q) : lowest;
  bracket[1] = open < total ? lowest * pow(open + 1, 1 / q) : HUGE_VAL;
  return (uint32_t)open;
}

uint32_t sph_flaws_active(const struct sph_flaws_lists *w, size_t particle, double strain, double bracket[2]) {
  return (w->strain ? active_exact : active_compact)(w, list_of(w, particle), strain, bracket);
}
