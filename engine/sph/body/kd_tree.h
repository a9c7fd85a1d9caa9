/* Finds the nearest of n points, by a k-d tree. Memory is proportional to n, however uneven the points are. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

struct sph_kd_tree; /* opaque */

/* The coordinates are copied. n from 1 to below 2^32. STATUS_MEMORY. */
status sph_kd_tree_create(size_t n, const double *x, const double *y, const double *z, struct sph_kd_tree **out,
                          struct error *error);
void sph_kd_tree_free(struct sph_kd_tree *nearest); /* NULL is fine */

/* The nearest point's index; of two at the same distance the lower one. */
size_t sph_kd_tree_find(const struct sph_kd_tree *nearest, const double point[3]);
/* The nearest point except `self`; SIZE_MAX when there is no other. */
size_t sph_kd_tree_other(const struct sph_kd_tree *nearest, const double point[3], size_t self);
/* Finds the points within `radius`. Writes at most `capacity` indices, returns the number of points. They are not
 * sorted, but their order is always the same. */
size_t sph_kd_tree_within(const struct sph_kd_tree *nearest, const double point[3], double radius, uint32_t *out,
                          size_t capacity);
/* Appends the points within `radius` of a point, and then of its images in a box that is periodic where a length is
 * above 0, to *list behind *total. The points lie in the box there. *list is malloc'd and grows. False: no memory. */
bool sph_kd_tree_list(const struct sph_kd_tree *nearest, const double point[3], const double length[3], double radius,
                      uint32_t **list, size_t *capacity, size_t *total);

/* Sorts particles along Hilbert's curve: particles that are near in space are then near in memory, and consecutive
 * particles fill a compact region. Deterministic: ties are sorted by id. */

/* order[k] is the index of the particle at place k. Distant particles cost nothing extra, because there is no grid.
 * STATUS_MEMORY. */
status sph_hilbert_find(size_t n, const double *x, const double *y, const double *z, uint32_t *order,
                        struct error *error);
