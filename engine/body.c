#include "engine/body.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "engine/snapshot_read.h"

struct raw {
  size_t points, cells, offsets, ids, fragments, grains, beams, alive;
  double *point, *alive_value, *beam;
  int64_t *offset, *id, *fragment, *grain;
};

static bool take_cells(const struct raw *raw, struct body *body) {
  if (!raw->point || !raw->offset || !raw->id || !raw->fragment || raw->offsets < 2 ||
      raw->offsets != raw->fragments + 1 || raw->offset[0] != 0 || raw->offset[raw->offsets - 1] != (int64_t)raw->ids)
    return false;
  size_t cells = raw->fragments;
  body->first_vertex = malloc((cells + 1) * sizeof *body->first_vertex);
  body->vertex = malloc((raw->ids ? raw->ids : 1) * sizeof *body->vertex);
  body->fragment = malloc(cells * sizeof *body->fragment);
  if (!body->first_vertex || !body->vertex || !body->fragment)
    return false;
  for (size_t i = 0; i <= cells; i++) {
    if (raw->offset[i] < 0 || raw->offset[i] > (int64_t)raw->ids || (i && raw->offset[i] < raw->offset[i - 1]))
      return false;
    body->first_vertex[i] = (uint32_t)raw->offset[i];
  }
  for (size_t i = 0; i < raw->ids; i++) {
    if (raw->id[i] < 0 || raw->id[i] >= (int64_t)raw->points)
      return false;
    for (size_t k = 0; k < 2; k++) {
      body->vertex[i][k] = raw->point[3 * (size_t)raw->id[i] + k];
      if (!isfinite(body->vertex[i][k]))
        return false;
    }
  }
  for (size_t i = 0; i < cells; i++) {
    if (raw->fragment[i] < 0 || raw->fragment[i] > FIELDS_READ_LARGEST)
      return false;
    body->fragment[i] = (uint32_t)raw->fragment[i];
  }
  body->cells = cells;
  return true;
}

/* Beams name grains; cells name the grain they are the outline of. Without beams there are no cracks. */
static bool take_cracks(const struct raw *raw, struct body *body) {
  if (!raw->beam || !raw->alive_value || !raw->grain || raw->beams != raw->alive || raw->grains != body->cells)
    return true;
  int64_t most = -1;
  for (size_t i = 0; i < raw->grains; i++)
    most = raw->grain[i] > most ? raw->grain[i] : most;
  if (most < 0 || most > FIELDS_READ_LARGEST)
    return false;
  uint32_t *cell = malloc(((size_t)most + 1) * sizeof *cell);
  body->crack = malloc((raw->beams ? raw->beams : 1) * sizeof *body->crack);
  if (!cell || !body->crack) {
    free(cell);
    return false;
  }
  memset(cell, 0xFF, ((size_t)most + 1) * sizeof *cell);
  for (size_t i = 0; i < raw->grains; i++)
    if (raw->grain[i] >= 0)
      cell[raw->grain[i]] = (uint32_t)i;
  for (size_t i = 0; i < raw->beams; i++) {
    double a = raw->beam[2 * i], b = raw->beam[2 * i + 1];
    if (raw->alive_value[i] != 0 || !(a >= 0 && a <= (double)most && b >= 0 && b <= (double)most))
      continue;
    uint32_t first = cell[(size_t)a], second = cell[(size_t)b];
    if (first != UINT32_MAX && second != UINT32_MAX && body->fragment[first] == body->fragment[second]) {
      body->crack[body->cracks][0] = first;
      body->crack[body->cracks++][1] = second;
    }
  }
  free(cell);
  return true;
}

static bool read_file(struct snapshot_read *file, struct body *body) {
  struct raw raw = {0};
  raw.point = snapshot_read_rows(file, "/VTKHDF/Points", 3, FIELDS_READ_REAL, &raw.points);
  raw.id = snapshot_read_rows(file, "/VTKHDF/Connectivity", 0, FIELDS_READ_INTEGER, &raw.ids);
  raw.offset = snapshot_read_rows(file, "/VTKHDF/Offsets", 0, FIELDS_READ_INTEGER, &raw.offsets);
  raw.fragment = snapshot_read_rows(file, "/VTKHDF/CellData/fragment", 0, FIELDS_READ_INTEGER, &raw.fragments);
  raw.grain = snapshot_read_rows(file, "/VTKHDF/CellData/grain", 0, FIELDS_READ_INTEGER, &raw.grains);
  raw.beam = snapshot_read_rows(file, "/beams/grains", 2, FIELDS_READ_REAL, &raw.beams);
  raw.alive_value = snapshot_read_rows(file, "/beams/alive", 0, FIELDS_READ_REAL, &raw.alive);
  bool good = take_cells(&raw, body) && take_cracks(&raw, body);
  free(raw.point);
  free(raw.id);
  free(raw.offset);
  free(raw.fragment);
  free(raw.grain);
  free(raw.beam);
  free(raw.alive_value);
  return good;
}

status body_read(const char *path, struct body *body, struct error *error) {
  *body = (struct body){0};
  struct snapshot_read *file;
  status code = snapshot_read_open(path, &file, error);
  if (code)
    return code;
  bool good = read_file(file, body);
  snapshot_read_close(file);
  if (good)
    return STATUS_OK;
  body_clear(body);
  return status_fail(error, STATUS_CONTENT,
                     "%s is no fields file of clast, or it is damaged; `clast simulate --fields` and "
                     "`clast replay --fields` write such files",
                     path);
}

void body_clear(struct body *body) {
  free(body->first_vertex);
  free(body->vertex);
  free(body->fragment);
  free(body->crack);
  *body = (struct body){0};
}
