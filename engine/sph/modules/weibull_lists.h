/* The flaws of one body, as thresholds of strain per particle. Exact: every threshold of every particle, ascending.
 * Compact: (lowest, exponent, number) per particle, with
 *   n(eps) = min(total, floor((eps/lowest)^q)),  q = ln(total)/ln(highest/lowest),
 * a power law that counts 1 at the lowest and all at the highest threshold; so codes of this kind save memory (Benz &
 * Asphaug 1994). A threshold beyond the range of a double is infinite (it never opens) or 0. */
#ifndef CLAST_ENGINE_SPH_MODULES_WEIBULL_LISTS_H
#define CLAST_ENGINE_SPH_MODULES_WEIBULL_LISTS_H

#include <stdbool.h>

#include "engine/sph/body/flaws.h"

struct sph_weibull_lists; /* opaque; body->prepared[SPH_MODULE_weibull] */

double sph_weibull_lowest(const struct sph_weibull_lists *lists, size_t particle);
uint32_t sph_weibull_total(const struct sph_weibull_lists *lists, size_t particle);
/* Number of open flaws; the same for every strain with bracket[0] <= strain < bracket[1]. */
uint32_t sph_weibull_active(const struct sph_weibull_lists *lists, size_t particle, double strain, double bracket[2]);

#endif
