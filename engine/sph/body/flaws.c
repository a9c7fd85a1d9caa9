#include "engine/sph/body/flaws.h"

#include <math.h>
#include <stdlib.h>

#include "engine/random.h"

struct placed {
  size_t particle;
  double log_strain;
};

struct pile {
  struct placed *item;
  size_t count, capacity;
};

static int push(struct pile *pile, struct placed item) {
  if (pile->count == pile->capacity) {
    size_t capacity = pile->capacity ? 2 * pile->capacity : 1024;
    struct placed *grown = realloc(pile->item, capacity * sizeof *grown);
    if (!grown)
      return 0;
    pile->item = grown;
    pile->capacity = capacity;
  }
  pile->item[pile->count++] = item;
  return 1;
}

/* Counting sort by particle keeps the order of drawing, which is ascending strain. */
static struct sph_flaws *gather(const struct pile *pile, size_t n) {
  struct sph_flaws *flaws = calloc(1, sizeof *flaws);
  if (!flaws)
    return NULL;
  flaws->particles = n;
  flaws->count = pile->count;
  flaws->first = calloc(n + 2, sizeof *flaws->first);
  flaws->log_strain = malloc((pile->count ? pile->count : 1) * sizeof *flaws->log_strain);
  if (!flaws->first || !flaws->log_strain) {
    sph_flaws_free(flaws);
    return NULL;
  }
  size_t *next = flaws->first + 1;
  for (size_t f = 0; f < pile->count; f++)
    next[pile->item[f].particle + 1]++;
  for (size_t i = 1; i <= n; i++)
    next[i] += next[i - 1];
  for (size_t f = 0; f < pile->count; f++)
    flaws->log_strain[next[pile->item[f].particle]++] = pile->item[f].log_strain;
  return flaws;
}

status sph_flaws_make(const struct sph_flaw_law *law, size_t n, sph_flaws_owner owner, void *context, uint64_t most,
                      struct sph_flaws **out, struct error *error) {
  *out = NULL;
  struct pile pile = {0};
  unsigned char *has = calloc(n ? n : 1, 1);
  status code = STATUS_OK;
  if (!has) {
    code = status_fail(error, STATUS_MEMORY, "no memory for the flaws of %zu particles", n);
    goto cleanup;
  }
  if (!(law->weibull.m > 0 && law->weibull.k > 0 && law->volume > 0) ||
      !isfinite(law->weibull.m + law->weibull.k + law->volume)) {
    code = status_fail(error, STATUS_CONTENT,
                       "flaws need a positive m, k and volume, not m %g, k %g m^-3, volume %g m^3.", law->weibull.m,
                       law->weibull.k, law->volume);
    goto cleanup;
  }
  const double log_kv = log(law->weibull.k) + log(law->volume);
  double gamma = 0; /* cumulative unit exponentials */
  size_t without = n;
  if (law->exempt)
    for (size_t i = 0; i < n; i++)
      without -= has[i] = law->exempt[i] != 0;
  if (n && !without) {
    code = status_fail(error, STATUS_CONTENT, "all %zu particles of a body lie where it shall have no flaws.", n);
    goto cleanup;
  }
  if (!most)
    most = 64 * (uint64_t)((double)n * (1 + log((double)n + 1)));
  for (uint64_t f = 0; law->number ? f < law->number : without && f < most; f++) {
    double rank = (double)(f + 1);
    if (law->draw == SPH_FLAWS_POISSON) {
      gamma -= log1p(-random_draw(law->seed, RANDOM_FLAW_STRENGTH, law->body, f));
      rank = gamma;
    }
    size_t i = owner ? owner(context, f)
                     : (size_t)(random_draw(law->seed, RANDOM_FLAW_PLACE, law->body, f) * (double)n);
    if (i == SPH_FLAWS_NOBODY)
      continue;
    if (!push(&pile, (struct placed){i, (log(rank) - log_kv) / law->weibull.m})) {
      code = status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", pile.count);
      goto cleanup;
    }
    without -= !has[i];
    has[i] = 1;
  }
  if (law->number)
    for (size_t i = 0; i < n && !code; i++) {
      if (has[i])
        continue;
      const double wait = -log1p(-random_draw(law->seed, RANDOM_FLAW_STRENGTH, law->body, ~(uint64_t)i));
      const double last = law->draw == SPH_FLAWS_POISSON ? gamma : (double)law->number;
      const double rank = last + wait * (law->share ? 1 / law->share[i] : (double)n);
      if (!push(&pile, (struct placed){i, (log(rank) - log_kv) / law->weibull.m}))
        code = status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", pile.count);
    }
  else if (without) {
    code =
        status_fail(error, STATUS_CONTENT,
                    "%zu of %zu particles got no flaw within %llu flaws: their sizes differ too much for one flaw each",
                    without, n, (unsigned long long)most);
  }
  if (code)
    goto cleanup;
  *out = gather(&pile, n);
  if (!*out)
    code = status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", pile.count);
cleanup:
  free(pile.item);
  free(has);
  return code;
}

void sph_flaws_free(struct sph_flaws *flaws) {
  if (!flaws)
    return;
  free(flaws->first);
  free(flaws->log_strain);
  free(flaws);
}
