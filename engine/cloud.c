#include "engine/cloud.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/snapshot_read.h"

#define POINTS "VTKHDF/Points"
#define COLUMN "VTKHDF/PointData/"

static const char *const columns[] = {"damage",          "pressure",         "density", "energy", "distention",
                                      "rest_distention", "smoothing_length", "flaws",   "mass"};

static status damaged(const char *path, const char *what, struct error *error) {
  return status_fail(error, STATUS_CONTENT, "%s is no fields file of particles, or it is damaged: %s", path, what);
}

bool cloud_in_file(const char *path) {
  struct snapshot_read *file;
  if (snapshot_read_open(path, &file, NULL))
    return false;
  bool found = snapshot_read_has(file, "VTKHDF") && snapshot_read_has(file, "VTKHDF/PointData") &&
               snapshot_read_has(file, COLUMN "smoothing_length");
  snapshot_read_close(file);
  return found;
}

static const char *take(struct snapshot_read *file, struct cloud *cloud) {
  size_t points, masses, densities, fragments, parts;
  double *density = snapshot_read_rows(file, COLUMN "density", 0, FIELDS_READ_REAL, &densities);
  const char *why = NULL;
  cloud->position = snapshot_read_rows(file, POINTS, 3, FIELDS_READ_REAL, &points);
  cloud->mass = snapshot_read_rows(file, COLUMN "mass", 0, FIELDS_READ_REAL, &masses);
  cloud->fragment = snapshot_read_rows(file, COLUMN "fragment", 0, FIELDS_READ_INTEGER, &fragments);
  cloud->part = snapshot_read_rows(file, COLUMN "part", 0, FIELDS_READ_INTEGER, &parts);
  cloud->size = calloc(points + 1, sizeof *cloud->size);
  cloud->n = points;
  if (!density || !cloud->position || !cloud->mass || !cloud->fragment || !cloud->part || !cloud->size)
    why = "positions, masses, densities or fragments cannot be read";
  else if (masses != points || densities != points || fragments != points || parts != points)
    why = "its columns differ in length";
  for (size_t i = 0; !why && i < points; i++) {
    for (int d = 0; d < 3; d++)
      if (!(fabs(cloud->position[i][d]) < 1e30)) /* sums and squares of these stay finite */
        why = "a position is not finite";
    cloud->size[i] = cbrt(cloud->mass[i] / density[i]);
    if (!(cloud->mass[i] > 0 && isfinite(cloud->mass[i]) && cloud->size[i] > 0 && isfinite(cloud->size[i])))
      why = "a mass or density is not positive";
    if (cloud->fragment[i] < -1 || cloud->fragment[i] >= (int64_t)points)
      why = "a fragment's number is out of range";
    if (cloud->part[i] < 0 || cloud->part[i] > 3)
      why = "a particle's part is none of core, veneer, dust";
  }
  free(density);
  return why;
}

status cloud_read(const char *path, struct cloud *cloud, struct error *error) {
  *cloud = (struct cloud){.time = NAN};
  struct snapshot_read *file;
  status code = snapshot_read_open(path, &file, error);
  if (code)
    return code;
  const char *why = take(file, cloud);
  snapshot_read_text(file, "run", "engine", cloud->engine, sizeof cloud->engine);
  snapshot_read_integer(file, "run", "seed", &cloud->seed);
  if (!snapshot_read_real(file, "run", "time", &cloud->time))
    cloud->time = NAN;
  snapshot_read_close(file);
  if (!why)
    return STATUS_OK;
  cloud_clear(cloud);
  return damaged(path, why, error);
}

status cloud_read_column(const char *path, const struct cloud *cloud, const char *name, double **values, char unit[32],
                         char meaning[128], struct error *error) {
  struct snapshot_read *file;
  char at[96], known[256] = "";
  size_t rows = 0;
  *values = NULL;
  status code = snapshot_read_open(path, &file, error);
  if (code)
    return code;
  snprintf(at, sizeof at, COLUMN "%s", name);
  if (strlen(name) < 40 && !strchr(name, '/') && !strchr(name, '.') && snapshot_read_has(file, "VTKHDF") &&
      snapshot_read_has(file, "VTKHDF/PointData"))
    *values = snapshot_read_rows(file, at, 0, FIELDS_READ_REAL, &rows);
  if (!*values || rows != cloud->n) {
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) {
      snprintf(at, sizeof at, COLUMN "%s", columns[k]);
      if (snapshot_read_has(file, at))
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", *known ? ", " : "", columns[k]);
    }
    free(*values);
    *values = NULL;
    code = status_fail(error, STATUS_CONTENT, "%s has no '%s' for each particle; it has %s", path, name, known);
  } else {
    snapshot_read_text(file, at, "units", unit, 32);
    snapshot_read_text(file, at, "long_name", meaning, 128);
  }
  snapshot_read_close(file);
  return code;
}

status cloud_read_axis(const char *path, const char *name, double **values, size_t *rows, char unit[32],
                       struct error *error) {
  struct snapshot_read *file;
  char at[96];
  *values = NULL;
  *rows = 0;
  status code = snapshot_read_open(path, &file, error);
  if (code)
    return code;
  snprintf(at, sizeof at, "axis/%.40s", name);
  if (!snapshot_read_has(file, "axis"))
    code = status_fail(error, STATUS_CONTENT, "%s has no profile: runs with an impact or a piston keep one", path);
  else if (strchr(name, '/') || strchr(name, '.') ||
           !(*values = snapshot_read_rows(file, at, 0, FIELDS_READ_REAL, rows)))
    code = status_fail(error, STATUS_CONTENT,
                       "%s has no '%s' along the axis; it has distention, damage, pressure, velocity", path, name);
  else
    snapshot_read_text(file, at, "units", unit, 32);
  snapshot_read_close(file);
  return code;
}

void cloud_clear(struct cloud *cloud) {
  free(cloud->position);
  free(cloud->size);
  free(cloud->mass);
  free(cloud->fragment);
  free(cloud->part);
  *cloud = (struct cloud){0};
}
