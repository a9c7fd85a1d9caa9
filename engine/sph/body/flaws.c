/* Flaws are drawn until every particle has one. */
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
  size_t particle;
  double log_strain;
};

/* Flaws in the order of drawing. */
struct drawn {
  const struct sph_flaw_law *law;
  size_t n; /* particles */
  struct placed *flaw;
  size_t count, capacity;
  unsigned char *has; /* by particle: a flaw, or none allowed */
  size_t without;     /* number of particles without one */
  double log_kv;
  double gamma; /* cumulative unit exponentials */
};

static bool push(struct drawn *d, size_t particle, double rank) {
  if (!grow_room(&d->flaw, &d->capacity, d->count + 1, sizeof *d->flaw))
    return false;
  d->flaw[d->count++] = (struct placed){particle, (log(rank) - d->log_kv) / d->law->weibull.m};
  return true;
}

/* Counting sort by particle. It keeps the order of drawing, which is that of ascending strain. */
static struct sph_flaws *sort_by_particle(const struct drawn *d) {
  struct sph_flaws *flaws = memory_small(1, sizeof *flaws);
  flaws->particles = d->n;
  flaws->count = d->count;
  flaws->first = calloc(d->n + 2, sizeof *flaws->first);
  flaws->log_strain = malloc((d->count ? d->count : 1) * sizeof *flaws->log_strain);
  if (!flaws->first || !flaws->log_strain) {
    sph_flaws_free(flaws);
    return NULL;
  }
  size_t *next = flaws->first + 1;
  for (size_t f = 0; f < d->count; f++)
    next[d->flaw[f].particle + 1]++;
  for (size_t i = 1; i <= d->n; i++)
    next[i] += next[i - 1];
  for (size_t f = 0; f < d->count; f++)
    flaws->log_strain[next[d->flaw[f].particle]++] = d->flaw[f].log_strain;
  return flaws;
}

/* Draws flaws in the order of their strength. */
static status draw(struct drawn *d, sph_flaws_owner owner, void *context, uint64_t most, struct error *error) {
  const struct sph_flaw_law *law = d->law;
  for (uint64_t f = 0; law->number ? f < law->number : d->without && f < most; f++) {
    double rank = (double)(f + 1);
    if (law->draw == SPH_FLAWS_POISSON) {
      d->gamma -= log1p(-random_draw(law->seed, RANDOM_FLAW_STRENGTH, law->body, f));
      rank = d->gamma;
    }
    const size_t i = owner ? owner(context, f)
                           : (size_t)(random_draw(law->seed, RANDOM_FLAW_PLACE, law->body, f) * (double)d->n);
    if (i == SPH_FLAWS_NOBODY)
      continue;
    if (!push(d, i, rank))
      return status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", d->count);
    d->without -= !d->has[i];
    d->has[i] = 1;
  }
  return STATUS_OK;
}

/* Gives each particle without a flaw the first one that it would get if drawing went on. */
static status draw_rest(struct drawn *d, struct error *error) {
  const struct sph_flaw_law *law = d->law;
  const double last = law->draw == SPH_FLAWS_POISSON ? d->gamma : (double)law->number;
  for (size_t i = 0; i < d->n; i++) {
    if (d->has[i])
      continue;
    const double wait = -log1p(-random_draw(law->seed, RANDOM_FLAW_STRENGTH, law->body, ~(uint64_t)i));
    if (!push(d, i, last + wait * (law->share ? 1 / law->share[i] : (double)d->n)))
      return status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", d->count);
  }
  return STATUS_OK;
}

static status draw_all(struct drawn *d, sph_flaws_owner owner, void *context, uint64_t most, struct error *error) {
  const struct sph_flaw_law *law = d->law;
  const size_t n = d->n;
  const double m = law->weibull.m, k = law->weibull.k, volume = law->volume;
  if (!(m > 0 && k > 0 && volume > 0 && isfinite(m + k + volume)))
    return status_fail(error, STATUS_CONTENT,
                       "flaws need a positive m, k and volume, not m %g, k %g m^-3, volume %g m^3.", m, k, volume);
  d->log_kv = log(law->weibull.k) + log(law->volume);
  for (size_t i = 0; law->exempt && i < n; i++) {
    d->has[i] = law->exempt[i] != 0;
    d->without -= d->has[i];
  }
  if (n && !d->without)
    return status_fail(
        error, STATUS_CONTENT,
        "all %zu particles of a body lie in its flaw-free ends: shorten stretch.flaw_free or raise fidelity.particles.",
        n);

  if (!most)
    most = 64 * (uint64_t)((double)n * (1 + log((double)n + 1)));
  TRY(draw(d, owner, context, most, error));
  if (law->number)
    return draw_rest(d, error);
  if (d->without)
    return status_fail(
        error, STATUS_CONTENT,
        "%zu of %zu particles got no flaw within %llu flaws: their sizes differ too much for one flaw each", d->without,
        n, (unsigned long long)most);
  return STATUS_OK;
}

status sph_flaws_make(const struct sph_flaw_law *law, size_t n, sph_flaws_owner owner, void *context, uint64_t most,
                      struct sph_flaws **out, struct error *error) {
  *out = NULL;
  OWNED unsigned char *has = calloc(n ? n : 1, 1);
  if (!has)
    return status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", n);
  struct drawn d = {.law = law, .n = n, .without = n, .has = has};
  status code = draw_all(&d, owner, context, most, error);
  if (!code && !(*out = sort_by_particle(&d)))
    code = status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", d.count);
  free(d.flaw);
  return code;
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

struct places {
  const struct sph_shape *shape;
  double half;
  const struct sph_kd_tree *nearest;
  const unsigned char *exempt;
  const struct sph_cells *cells; /* NULL: particles own flaws */
  uint64_t seed, body;
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

static size_t nearest_particle(void *context, uint64_t flaw) {
  const struct places *places = context;
  double point[3];
  sph_flaws_point(places->seed, places->body, flaw, places->shape, point);
  if (fabs(point[2]) > places->half)
    return SPH_FLAWS_NOBODY;
  const size_t i = sph_kd_tree_find(places->nearest, point);
  if (places->exempt[i])
    return SPH_FLAWS_NOBODY;
  return places->cells ? places->cells->of[i] : i;
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

/* Cells of which all particles are exempt. NULL without memory. */
static unsigned char *exempt_cells(const struct sph_cells *cells, const unsigned char *exempt) {
  unsigned char *out = malloc(cells->count);
  if (!out)
    return NULL;
  memset(out, 1, cells->count);
  for (size_t i = 0; i < cells->particles; i++)
    if (!exempt[i])
      out[cells->of[i]] = 0;
  return out;
}

status sph_flaws_place(const struct sph_flaw_law *law, const struct sph_shape *shape, const struct sph_particles *p,
                       struct sph_range range, double half, struct sph_flaws **out, struct error *error) {
  *out = NULL;
  struct sph_flaw_law full = *law;
  OWNED struct sph_cells *cells = NULL; /* the owners of flaws; NULL: particles */
  OWNED struct sph_kd_tree *nearest = NULL;
  if (law->cell_width > 0)
    TRY(sph_flaws_cells(law->seed, law->body, law->cell_width, p, range, &cells, error));
  const bool unequal = cells || is_graded(p, range);
  OWNED unsigned char *ends = find_ends(p, range, half);
  OWNED unsigned char *ends_cells = ends && cells ? exempt_cells(cells, ends) : NULL;
  OWNED double *share = unequal ? find_shares(p, range, cells) : NULL;
  if (!ends || (cells && !ends_cells) || (unequal && !share))
    return status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", range.n);
  TRY(sph_kd_tree_create(range.n, p->x + range.first, p->y + range.first, p->z + range.first, &nearest, error));
  const size_t n = cells ? cells->count : range.n;
  full.volume = sph_shape_volume(shape) / (law->solid_ratio > 0 ? law->solid_ratio : 1);
  full.number = (uint64_t)ceil((double)n * (log((double)n) + 0.5772156649015329));
  full.exempt = cells ? ends_cells : ends;
  full.share = share;
  struct places places = {shape, half, nearest, ends, cells, law->seed, law->body};
  TRY(sph_flaws_make(&full, n, nearest_particle, &places, 0, out, error));
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
