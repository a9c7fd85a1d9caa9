/* Flaws are drawn until every particle has one. */
#include "engine/sph/body/flaws.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "engine/random.h"
#include "engine/sph/body/kd_tree.h"

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
  struct sph_flaws *flaws = calloc(1, sizeof *flaws);
  if (!flaws)
    return NULL;
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

static status check_law(const struct sph_flaw_law *law, struct error *error) {
  const double m = law->weibull.m, k = law->weibull.k, volume = law->volume;
  if (m > 0 && k > 0 && volume > 0 && isfinite(m + k + volume))
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "flaws need a positive m, k and volume, not m %g, k %g m^-3, volume %g m^3.", m, k, volume);
}

static status draw_all(struct drawn *d, sph_flaws_owner owner, void *context, uint64_t most, struct error *error) {
  const struct sph_flaw_law *law = d->law;
  const size_t n = d->n;
  status code = check_law(law, error);
  if (code)
    return code;
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
  code = draw(d, owner, context, most, error);
  if (code)
    return code;
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
  struct drawn d = {.law = law, .n = n, .without = n, .has = calloc(n ? n : 1, 1)};
  if (!d.has)
    return status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", n);
  status code = draw_all(&d, owner, context, most, error);
  if (code)
    goto cleanup;
  *out = sort_by_particle(&d);
  if (!*out)
    code = status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", d.count);
cleanup:
  free(d.flaw);
  free(d.has);
  return code;
}

void sph_flaws_free(struct sph_flaws *flaws) {
  if (!flaws)
    return;
  free(flaws->first);
  free(flaws->log_strain);
  sph_cells_free(flaws->cells);
  free(flaws);
}

/* ---- flaws as points in a shape ---- */

struct places {
  const struct sph_shape *shape;
  const struct sph_middle *middle;
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
  if (places->middle && sph_bodies_beyond(places->middle, point))
    return SPH_FLAWS_NOBODY;
  const size_t i = sph_kd_tree_find(places->nearest, point);
  if (places->exempt && places->exempt[i])
    return SPH_FLAWS_NOBODY;
  return places->cells ? places->cells->of[i] : i;
}

/* Marks the particles in the ends of the body. NULL without memory. */
static unsigned char *find_ends(const struct sph_particles *p, struct sph_range range,
                                const struct sph_middle *middle) {
  unsigned char *exempt = malloc(range.n);
  for (size_t i = 0; exempt && i < range.n; i++) {
    const size_t k = range.first + i;
    exempt[i] = sph_bodies_beyond(middle, (double[3]){p->x[k], p->y[k], p->z[k]});
  }
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

/* The owners of flaws, and their shares of the volume. */
struct owners {
  struct sph_cells *cells;   /* NULL: particles */
  unsigned char *ends;       /* by particle: in the ends of the body; NULL: none is */
  unsigned char *ends_cells; /* by cell: all of its particles are in the ends */
  double *share;             /* by owner; NULL: equal */
  struct sph_kd_tree *nearest;
};

/* The arrays of the owners; `unequal`: their shares differ. False: no memory. */
static bool find_marks(const struct sph_particles *p, struct sph_range range, const struct sph_middle *middle,
                       bool unequal, struct owners *o) {
  if (middle) {
    o->ends = find_ends(p, range, middle);
    if (!o->ends)
      return false;
  }
  if (middle && o->cells) {
    o->ends_cells = exempt_cells(o->cells, o->ends);
    if (!o->ends_cells)
      return false;
  }
  if (unequal)
    o->share = find_shares(p, range, o->cells);
  return o->share || !unequal;
}

static status find_owners(const struct sph_flaw_law *law, const struct sph_particles *p, struct sph_range range,
                          const struct sph_middle *middle, struct owners *o, struct error *error) {
  if (law->cell_width > 0) {
    const status code = sph_cells_make(law->seed, law->body, law->cell_width, p, range, &o->cells, error);
    if (code)
      return code;
  }
  if (!find_marks(p, range, middle, o->cells || is_graded(p, range), o))
    return status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", range.n);
  return sph_kd_tree_create(range.n, p->x + range.first, p->y + range.first, p->z + range.first, &o->nearest, error);
}

status sph_flaws_place(const struct sph_flaw_law *law, const struct sph_shape *shape, const struct sph_particles *p,
                       struct sph_range range, const struct sph_middle *middle, struct sph_flaws **out,
                       struct error *error) {
  *out = NULL;
  struct owners owners = {0};
  struct sph_flaw_law full = *law;
  status code = sph_shape_check(shape, error);
  if (code)
    return code;
  if (!range.n)
    return status_fail(error, STATUS_CONTENT, "a body of no particles has no flaws.");
  code = find_owners(law, p, range, middle, &owners, error);
  if (code)
    goto cleanup;
  const size_t n = owners.cells ? owners.cells->count : range.n;
  full.volume = sph_shape_volume(shape) / (law->solid_ratio > 0 ? law->solid_ratio : 1);
  full.number = (uint64_t)ceil((double)n * (log((double)n) + 0.5772156649015329));
  full.exempt = owners.cells ? owners.ends_cells : owners.ends;
  full.share = owners.share;
  struct places places = {shape, middle, owners.nearest, owners.ends, owners.cells, law->seed, law->body};
  code = sph_flaws_make(&full, n, nearest_particle, &places, 0, out, error);
  if (code)
    goto cleanup;
  (*out)->particles = range.n;
  (*out)->cells = owners.cells;
  owners.cells = NULL;
cleanup:
  sph_kd_tree_free(owners.nearest);
  sph_cells_free(owners.cells);
  free(owners.ends);
  free(owners.ends_cells);
  free(owners.share);
  return code;
}
