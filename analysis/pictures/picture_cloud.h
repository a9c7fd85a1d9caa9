/* Particles in space, and their reader: the data of picture_particles().
 *
 * A fields file may come from an untrusted source, so the reader checks every size, number and index. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_CLOUD_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_CLOUD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

/* A particle's role: unbroken, in the damaged layer at its fragment's surface, a single broken particle, or in a body
 * that has no fragments (a projectile). The numbers are those of the file. */
enum picture_part { PICTURE_CORE, PICTURE_LAYER, PICTURE_DUST, PICTURE_LEFT_OUT, PICTURE_PARTS };

struct picture_cloud {
  size_t n;
  double (*position)[3]; /* m, finite */
  double *size;          /* m, cube root of a particle's volume: above 0 */
  double *mass;          /* kg, above 0 */
  int64_t *fragment;     /* number of its fragment by descending mass, below n; negative: none */
  int64_t *part;         /* enum picture_part */
  double *value;         /* values that colour the particles; NULL: coloured by fragment */
  char engine[32];       /* name of the engine that wrote the file */
  long long seed;
  double time; /* s; NaN: the file does not say */
};

/* True for a file of particles. False also for a file that cannot be read. */
bool picture_cloud_in_file(const char *path);

/* Reads all members except `value`. *cloud owns its arrays; free them with picture_cloud_clear(). STATUS_MISSING: there
 * is no such file. STATUS_CONTENT: the file is no fields file of particles, or it is damaged. STATUS_MEMORY. After an
 * error *cloud is empty. */
status picture_cloud_read(const char *path, struct picture_cloud *cloud, struct error *error);

/* Reads one more column ("damage", "pressure", ...): n values in *values (malloc'd), and the unit as the file gives it,
 * cut to its size. STATUS_CONTENT when the file has no such column: the message lists the columns that it has. */
status picture_cloud_read_column(const char *path, const struct picture_cloud *cloud, const char *name, double **values,
                                 char unit[32], struct error *error);

/* Reads one column of the profile along the axis ("depth", "distention", "damage", "pressure", "velocity"): *rows
 * values in *values (malloc'd), and their unit. STATUS_CONTENT when the file has no such column. */
status picture_cloud_read_axis(const char *path, const char *name, double **values, size_t *rows, char unit[32],
                               struct error *error);
void picture_cloud_clear(struct picture_cloud *cloud);

#endif
