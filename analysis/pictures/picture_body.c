/* Reading a body of polygons from a fields file. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "analysis/pictures/snapshot_read.h"

/* The columns of the file, with their lengths; NULL: the file lacks the column. */
struct columns {
  size_t points, ids, offsets, fragments, grains, beams, alives;
  double *point, *alive, *beam;
  int64_t *id, *offset, *fragment, *grain;
};

static void read_columns(struct snapshot_read *file, struct columns *c) {
  c->point = snapshot_read_rows(file, "/VTKHDF/Points", 3, SNAPSHOT_READ_REAL, &c->points);
  c->id = snapshot_read_rows(file, "/VTKHDF/Connectivity", 0, SNAPSHOT_READ_INTEGER, &c->ids);
  c->offset = snapshot_read_rows(file, "/VTKHDF/Offsets", 0, SNAPSHOT_READ_INTEGER, &c->offsets);
  c->fragment = snapshot_read_rows(file, "/VTKHDF/CellData/fragment", 0, SNAPSHOT_READ_INTEGER, &c->fragments);
  c->grain = snapshot_read_rows(file, "/VTKHDF/CellData/grain", 0, SNAPSHOT_READ_INTEGER, &c->grains);
  c->beam = snapshot_read_rows(file, "/beams/grains", 2, SNAPSHOT_READ_REAL, &c->beams);
  c->alive = snapshot_read_rows(file, "/beams/alive", 0, SNAPSHOT_READ_REAL, &c->alives);
}

static void free_columns(struct columns *c) {
  free(c->point);
  free(c->id);
  free(c->offset);
  free(c->fragment);
  free(c->grain);
  free(c->beam);
  free(c->alive);
}

/* The offsets must rise from 0 to the number of vertices. */
static bool take_first_vertices(const struct columns *c, struct picture_body *body) {
  if (c->offset[0] != 0 || c->offset[body->cells] != (int64_t)c->ids)
    return false;

  for (size_t i = 0; i <= body->cells; i++) {
    if (i && c->offset[i] < c->offset[i - 1])
      return false;
    body->first_vertex[i] = (uint32_t)c->offset[i];
  }
  return true;
}

static bool take_vertices(const struct columns *c, struct picture_body *body) {
  for (size_t i = 0; i < c->ids; i++) {
    if (c->id[i] < 0 || c->id[i] >= (int64_t)c->points)
      return false;
    const double *point = &c->point[3 * (size_t)c->id[i]];
    if (!isfinite(point[0]) || !isfinite(point[1]))
      return false;
    memcpy(body->vertex[i], point, sizeof body->vertex[i]);
  }
  return true;
}

static bool take_fragments(const struct columns *c, struct picture_body *body) {
  for (size_t i = 0; i < body->cells; i++) {
    if (c->fragment[i] < 0 || c->fragment[i] > SNAPSHOT_READ_LARGEST)
      return false;
    body->fragment[i] = (uint32_t)c->fragment[i];
  }
  return true;
}

static bool take_cells(const struct columns *c, struct picture_body *body) {
  const bool there = c->point && c->offset && c->id && c->fragment;
  if (!there || c->fragments == 0 || c->offsets != c->fragments + 1)
    return false;

  body->cells = c->fragments;
  body->first_vertex = malloc((body->cells + 1) * sizeof *body->first_vertex);
  body->vertex = malloc((c->ids + 1) * sizeof *body->vertex);
  body->fragment = malloc(body->cells * sizeof *body->fragment);
  if (!body->first_vertex || !body->vertex || !body->fragment)
    return false;

  return take_first_vertices(c, body) && take_vertices(c, body) && take_fragments(c, body);
}

/* Collects broken beams between two grains of the same fragment. */
static void take_broken_beams(const struct columns *c, const uint32_t *cell, size_t grains, struct picture_body *body) {
  for (size_t i = 0; i < c->beams; i++) {
    const double a = c->beam[2 * i], b = c->beam[2 * i + 1], end = (double)grains;
    const bool known = a >= 0 && a < end && b >= 0 && b < end;
    if (c->alive[i] != 0 || !known)
      continue;
    uint32_t first = cell[(size_t)a], second = cell[(size_t)b];
    if (first == UINT32_MAX || second == UINT32_MAX || body->fragment[first] != body->fragment[second])
      continue;
    body->crack[body->cracks][0] = first;
    body->crack[body->cracks++][1] = second;
  }
}

static int64_t last_grain(const struct columns *c) {
  int64_t last = -1;
  for (size_t i = 0; i < c->grains; i++)
    last = c->grain[i] > last ? c->grain[i] : last;
  return last;
}

/* The cell of each grain, UINT32_MAX for none. The caller frees it. */
static uint32_t *cells_by_grain(const struct columns *c, size_t grains) {
  uint32_t *cell = malloc(grains * sizeof *cell);
  if (!cell)
    return NULL;
  memset(cell, 0xFF, grains * sizeof *cell);
  for (size_t i = 0; i < c->grains; i++)
    if (c->grain[i] >= 0)
      cell[c->grain[i]] = (uint32_t)i;
  return cell;
}

/* Beams refer to grains, and each cell names the grain that it outlines. A file without beams has no cracks. */
static bool take_cracks(const struct columns *c, struct picture_body *body) {
  const bool there = c->beam && c->alive && c->grain;
  if (!there || c->beams != c->alives || c->grains != body->cells)
    return true;

  const int64_t last = last_grain(c);
  if (last < 0 || last > SNAPSHOT_READ_LARGEST)
    return false;
  const size_t grains = (size_t)last + 1;
  uint32_t *cell = cells_by_grain(c, grains);
  body->crack = malloc((c->beams + 1) * sizeof *body->crack);
  const bool good = cell && body->crack;
  if (good)
    take_broken_beams(c, cell, grains, body);
  free(cell);
  return good;
}

status picture_body_read(const char *path, struct picture_body *body, struct error *error) {
  *body = (struct picture_body){0};
  struct snapshot_read *file;
  TRY(snapshot_read_open(path, &file, error));

  struct columns columns = {0};
  read_columns(file, &columns);
  bool good = snapshot_read_close(file) && take_cells(&columns, body) && take_cracks(&columns, body);
  free_columns(&columns);
  if (good)
    return STATUS_OK;

  picture_body_clear(body);
  return snapshot_read_refuse(path, error);
}

void picture_body_clear(struct picture_body *body) {
  free(body->first_vertex);
  free(body->vertex);
  free(body->fragment);
  free(body->crack);
  *body = (struct picture_body){0};
}
