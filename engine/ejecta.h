/* Mass and momentum of the ejecta of an impact over their speed: rows of table ejecta. */
#pragma once

/* The bins of engine/bins.h from 1e-6 to 1e6 m/s. Slower matter is in the first of them, faster in the last. */
enum { EJECTA_FIRST = -60, EJECTA_BINS = 120 };

struct ejecta {
  struct ejecta_bin {
    double mass;     /* kg */
    double momentum; /* kg m/s, along the outward normal */
  } bin[EJECTA_BINS];
};

/* Adds matter of this speed (m/s). A speed that is not finite has no bin. */
void ejecta_add(struct ejecta *ejecta, double speed, double mass, double momentum);
/* Makes each bin the sum of itself and of all faster ones: mass and momentum above the bin's lower edge. */
void ejecta_sum(struct ejecta *ejecta);
