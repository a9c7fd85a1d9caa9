/* The flaws of one body, ready for the step (weibull_lists.h).
 *
 *   material.weibull.m, material.weibull.k   n(eps) = k eps^m flaws per volume open below the strain eps
 *   fidelity.flaws                           exact or compact lists */
#include "engine/sph/modules/weibull_lists.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/step/system_layout.h"

#define MATERIAL sph_weibull_material
#define INPUTS   sph_weibull_inputs

static const struct field material_rows[] = {
    MATERIAL_REAL(weibull.m, m, "1", NAN, 1, 200, .flags = FIELD_MAY_BE_OFF, .when = "../fracture=auto|on",
                  .doc = "Weibull's m: n(eps) = k eps^m flaws per volume are weaker than the strain eps. Large m: all "
                         "flaws alike. off: no flaws.",
                  .source = "Benz & Asphaug 1995, eq. 11"),
    MATERIAL_REAL(weibull.k, k, "1/m^3", NAN, 1, 1e200, .flags = FIELD_MAY_BE_OFF, .when = "../fracture=auto|on",
                  .doc = "Weibull's k (papers print 1/cm^3, which is 1e6 of these). off: no flaws.",
                  .source = "Benz & Asphaug 1995, eq. 11"),
};
const struct field_table sph_weibull_material = SPH_MODULE_TABLE(sph_weibull_material, material_rows);

static const struct field input_rows[] = {
    INPUT_CHOICE(fracture.draw, draw,
                 FIELD_WORDS_HERE(SPH_FLAW_DRAWS, [SPH_FLAWS_RANKED] = "ranked", [SPH_FLAWS_POISSON] = "poisson"),
                 .number = SPH_FLAWS_POISSON, .when = "target.fracture=auto|on",
                 .choice_docs =
                     "eps_j = (j/kV)^(1/m), as printed: a seed only moves the flaws about, and the scatter is too "
                     "small\n"
                     "the body's flaw strengths are a draw themselves: each seed is a specimen of its own",
                 .doc = "The strengths of the flaws.", .source = "BA95 eq. 20 for `ranked`"),
    INPUT_CHOICE(fidelity.flaws, flaws,
                 FIELD_WORDS_HERE(SPH_FLAW_LISTS, [SPH_FLAWS_EXACT] = "exact", [SPH_FLAWS_COMPACT] = "compact"),
                 .when = "target.fracture=auto|on",
                 .choice_docs = "every flaw is kept\nlowest, highest and number of each particle, a power law between",
                 .doc = "Storage of a particle's flaws."),
};
const struct field_table sph_weibull_inputs = SPH_MODULE_TABLE(sph_weibull_inputs, input_rows);

struct sph_weibull_lists {
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

static void free_prepared(void *prepared) {
  struct sph_weibull_lists *w = prepared;
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

static bool fill_exact(struct sph_weibull_lists *w, const struct sph_flaws *flaws) {
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

static bool fill_compact(struct sph_weibull_lists *w, const struct sph_flaws *flaws) {
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

static bool fill_cells(struct sph_weibull_lists *w, const struct sph_flaws *flaws) {
  if (!flaws->cells)
    return true;
  w->cell = malloc(w->particles * sizeof *w->cell);
  if (w->cell)
    memcpy(w->cell, flaws->cells->of, w->particles * sizeof *w->cell);
  return w->cell != NULL;
}

static status prepare(const struct sph_inputs *inputs, const struct sph_particles *particles, struct sph_solid *body,
                      struct error *error) {
  (void)particles;
  const struct sph_flaws *flaws = body->physics.flaws;
  const bool compact = inputs->weibull.flaws == SPH_FLAWS_COMPACT;
  struct sph_weibull_lists *w = calloc(1, sizeof *w);
  if (w) {
    w->particles = flaws->particles;
    w->lists = flaws->cells ? flaws->cells->count : flaws->particles;
    w->count = flaws->count;
  }
  if (!w || !(compact ? fill_compact : fill_exact)(w, flaws) || !fill_cells(w, flaws)) {
    free_prepared(w);
    return status_fail(error, STATUS_MEMORY, "no memory for %zu flaws", flaws->count);
  }
  body->prepared[SPH_MODULE_weibull] = w;
  return STATUS_OK;
}

static size_t bytes_prepared(const void *prepared) {
  const struct sph_weibull_lists *w = prepared;
  return sizeof *w + (w->cell ? w->particles * sizeof *w->cell : 0) +
         (w->strain ? (w->lists + 1) * sizeof *w->first + w->count * sizeof *w->strain
                    : w->lists * (2 * sizeof *w->lowest + sizeof *w->total));
}

static size_t list_of(const struct sph_weibull_lists *w, size_t particle) {
  return w->cell ? w->cell[particle] : particle;
}

double sph_weibull_lowest(const struct sph_weibull_lists *w, size_t particle) {
  const size_t i = list_of(w, particle);
  if (!w->strain)
    return w->lowest[i];
  return w->first[i] < w->first[i + 1] ? w->strain[w->first[i]] : HUGE_VAL;
}

uint32_t sph_weibull_total(const struct sph_weibull_lists *w, size_t particle) {
  const size_t i = list_of(w, particle);
  return w->strain ? (uint32_t)(w->first[i + 1] - w->first[i]) : w->total[i];
}

static uint32_t active_exact(const struct sph_weibull_lists *w, size_t i, double strain, double bracket[2]) {
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

static uint32_t active_compact(const struct sph_weibull_lists *w, size_t i, double strain, double bracket[2]) {
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

uint32_t sph_weibull_active(const struct sph_weibull_lists *w, size_t particle, double strain, double bracket[2]) {
  return (w->strain ? active_exact : active_compact)(w, list_of(w, particle), strain, bracket);
}

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->flaws != NULL;
}

const struct sph_module sph_weibull_module = {
    .name = "weibull",
    .doc = "Explicit flaws: each particle has its own list of strains at which a flaw opens, or that list's lowest, "
           "number and exponent (compact).",
    .source = "Benz & Asphaug 1995, eqs. 11 and 20",
    .when = "a body whose material has Weibull parameters",
    .on = on,
    .prepare = prepare,
    .free_prepared = free_prepared,
    .bytes_prepared = bytes_prepared,
};
