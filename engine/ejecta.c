/* Sums over bins of speed. */
#include "engine/ejecta.h"

#include <math.h>

#include "engine/bins.h"

void ejecta_add(struct ejecta *ejecta, double speed, double mass, double momentum) {
  if (!isfinite(speed))
    return;
  int bin = bins_of(speed); /* of 0: BINS_NONE, below all */
  bin = bin < EJECTA_FIRST ? 0 : bin - EJECTA_FIRST;
  struct ejecta_bin *at = &ejecta->bin[bin < EJECTA_BINS ? bin : EJECTA_BINS - 1];
  at->mass += mass;
  at->momentum += momentum;
}

void ejecta_sum(struct ejecta *ejecta) {
  for (int i = EJECTA_BINS - 2; i >= 0; i--) {
    ejecta->bin[i].mass += ejecta->bin[i + 1].mass;
    ejecta->bin[i].momentum += ejecta->bin[i + 1].momentum;
  }
}
