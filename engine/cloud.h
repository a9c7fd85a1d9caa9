/* Particles in space, read back from a fields file of any engine whose points carry a smoothing length: what pictures
 * of cuts and of fragments are drawn from. The file may come from anywhere: every size, number and index is checked. */
#ifndef CLAST_ENGINE_CLOUD_H
#define CLAST_ENGINE_CLOUD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

struct cloud {
  size_t n;
  double (*position)[3]; /* m, finite */
  double *size;          /* m, cube root of a particle's volume: above 0 */
  double *mass;          /* kg, above 0 */
  int64_t *fragment;     /* number of its fragment by descending mass; -1: none (a projectile); below n */
  int64_t *part;         /* 0 core, 1 veneer, 2 dust, 3 left out */
  char engine[32];
  long long seed;
  double time; /* s; NaN when the file does not say */
};

/* Is this a file of particles? False also when it cannot be read: then the reader that is tried next says why. */
bool cloud_in_file(const char *path);
/* STATUS_MISSING: no such file; STATUS_CONTENT: no fields file of particles, or damaged; STATUS_MEMORY. *cloud is empty
 * then. */
status cloud_read(const char *path, struct cloud *cloud, struct error *error);
/* One more column of the particles ("damage", "pressure", ...): n values, malloc'd, with unit and meaning as the file
 * gives them (cut to their sizes). STATUS_CONTENT when the file has none such: the message lists what it has. */
status cloud_read_column(const char *path, const struct cloud *cloud, const char *name, double **values, char unit[32],
                         char meaning[128], struct error *error);
/* One column of the profile along the axis that a run has kept ("depth", "distention", "damage", "pressure",
 * "velocity"): *rows values, malloc'd, as above. STATUS_CONTENT when there is none such. */
status cloud_read_axis(const char *path, const char *name, double **values, size_t *rows, char unit[32],
                       struct error *error);
void cloud_clear(struct cloud *cloud);

#endif
