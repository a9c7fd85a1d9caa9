/* Reading particles from a fields file. */
#include "analysis/pictures/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/snapshot_read.h"
#include "schemas/memory.h"

#define COLUMN "VTKHDF/PointData/"

/* Columns that an error message lists when a column is missing. */
static const char *const offered[] = {"damage",          "pressure",         "density", "energy", "distention",
                                      "rest_distention", "smoothing_length", "flaws",   "mass"};

static bool has_particles(struct snapshot_read *file) {
  return snapshot_read_has(file, "VTKHDF") && snapshot_read_has(file, "VTKHDF/PointData");
}

bool picture_cloud_in_file(const char *path) {
  struct snapshot_read *file;
  if (snapshot_read_open(path, &file, NULL))
    return false;
  bool found = has_particles(file) && snapshot_read_has(file, COLUMN "smoothing_length");
  snapshot_read_close(file);
  return found;
}

/* The reason why particle i cannot be drawn; NULL: none. */
static const char *refuse_particle(const struct picture_cloud *cloud, size_t i) {
  for (int d = 0; d < 3; d++)
    if (!(fabs(cloud->position[i][d]) < 1e30)) /* so that sums and squares of positions stay finite */
      return "a position is not finite";
  if (!(cloud->mass[i] > 0 && isfinite(cloud->mass[i]) && cloud->size[i] > 0 && isfinite(cloud->size[i])))
    return "a mass or density is not positive";
  if (cloud->fragment[i] < -1 || cloud->fragment[i] >= (int64_t)cloud->n)
    return "a fragment's number is out of range";
  if (cloud->part[i] < 0 || cloud->part[i] >= PICTURE_PARTS)
    return "a particle's part is none of core, layer, single";
  return NULL;
}

/* The reason why the particles of a file are refused; NULL: they were read. */
static const char *read_particles(struct snapshot_read *file, struct picture_cloud *cloud) {
  size_t masses, densities, fragments, parts;
  cloud->position = snapshot_read_rows(file, "VTKHDF/Points", 3, SNAPSHOT_READ_REAL, &cloud->n);
  cloud->mass = snapshot_read_rows(file, COLUMN "mass", 0, SNAPSHOT_READ_REAL, &masses);
  cloud->size = snapshot_read_rows(file, COLUMN "density", 0, SNAPSHOT_READ_REAL, &densities);
  cloud->fragment = snapshot_read_rows(file, COLUMN "fragment", 0, SNAPSHOT_READ_INTEGER, &fragments);
  cloud->part = snapshot_read_rows(file, COLUMN "part", 0, SNAPSHOT_READ_INTEGER, &parts);
  if (!cloud->position || !cloud->mass || !cloud->size || !cloud->fragment || !cloud->part)
    return "positions, masses, densities or fragments cannot be read";
  if (masses != cloud->n || densities != cloud->n || fragments != cloud->n || parts != cloud->n)
    return "its columns differ in length";

  for (size_t i = 0; i < cloud->n; i++) {
    cloud->size[i] = cbrt(cloud->mass[i] / cloud->size[i]); /* `size` held the density before */
    const char *why = refuse_particle(cloud, i);
    if (why)
      return why;
  }
  return NULL;
}

/* A particle and its mass and density, sorted by mass. */
struct weighed {
  double mass, density; /* the mass comes first: sample_ascending() sorts by it */
  size_t particle;
};

static int by_density(const void *a, const void *b) {
  const struct weighed *p = a, *q = b;
  return (p->density > q->density) - (p->density < q->density);
}

/* Matter that has expanded to the least density would look like boulders. A particle is drawn at most MOST times as
 * large, in volume, as one of its mass in dense matter: the upper quartile of the density. */
static void limit_sizes(struct picture_cloud *cloud) {
  static const double MOST = 1.5, ALIKE = 1.05;
  OWNED struct weighed *list = malloc((cloud->n + 1) * sizeof *list);
  if (!list)
    return; /* drawn as they are */
  for (size_t i = 0; i < cloud->n; i++)
    list[i] = (struct weighed){cloud->mass[i], cloud->mass[i] / pow(cloud->size[i], 3), i};
  qsort(list, cloud->n, sizeof *list, sample_ascending); /* by mass */
  for (size_t from = 0, end; from < cloud->n; from = end) {
    for (end = from + 1; end < cloud->n && list[end].mass <= ALIKE * list[end - 1].mass;)
      end++;
    qsort(list + from, end - from, sizeof *list, by_density);
    const double dense = list[from + 3 * (end - from) / 4].density;
    for (size_t k = from; k < end; k++)
      cloud->size[list[k].particle] = fmin(cloud->size[list[k].particle], cbrt(MOST * list[k].mass / dense));
  }
}

status picture_cloud_read(const char *path, struct picture_cloud *cloud, struct error *error) {
  *cloud = (struct picture_cloud){.time = NAN};
  struct snapshot_read *file;
  TRY(snapshot_read_open(path, &file, error));

  const char *why = read_particles(file, cloud);
  if (!why)
    limit_sizes(cloud);
  if (!why && !snapshot_read_text(file, "run", "engine", cloud->engine, sizeof cloud->engine))
    why = "its engine has no name that can be shown";
  snapshot_read_integer(file, "run", "seed", &cloud->seed);
  if (!snapshot_read_real(file, "run", "time", &cloud->time))
    cloud->time = NAN;
  if (!snapshot_read_close(file))
    why = "HDF5 crashes on it";
  if (!why)
    return STATUS_OK;

  picture_cloud_clear(cloud);
  return status_fail(error, STATUS_CONTENT, "%s is no fields file of particles, or it is damaged: %s", path, why);
}

/* Is the name a single link, which leads to no other group? */
static bool is_name(const char *name) {
  return strlen(name) < 40 && !strpbrk(name, "/.");
}

/* Closes the file after reading one column. */
static status close_column(struct snapshot_read *file, const char *path, double **values, status code,
                           struct error *error) {
  if (snapshot_read_close(file))
    return code;

  free(*values);
  *values = NULL;
  return snapshot_read_refuse(path, error);
}

status picture_cloud_read_column(const char *path, const struct picture_cloud *cloud, const char *name, double **values,
                                 char unit[32], struct error *error) {
  *values = NULL;
  struct snapshot_read *file;
  TRY(snapshot_read_open(path, &file, error));
  status code = STATUS_OK;
  char at[96];
  size_t rows = 0;
  snprintf(at, sizeof at, COLUMN "%.40s", name);
  double *read = is_name(name) && has_particles(file) ? snapshot_read_rows(file, at, 0, SNAPSHOT_READ_REAL, &rows)
                                                      : NULL;
  if (read && rows == cloud->n && snapshot_read_text(file, at, "units", unit, 32)) {
    *values = read;
  } else {
    char known[256] = "";
    free(read);
    for (size_t k = 0; k < sizeof offered / sizeof *offered; k++) {
      snprintf(at, sizeof at, COLUMN "%s", offered[k]);
      if (snapshot_read_has(file, at))
        text_append(known, sizeof known, "%s%s", *known ? ", " : "", offered[k]);
    }
    code = status_fail(error, STATUS_CONTENT, "%s has no '%s' for each particle; it has %s", path, name, known);
  }
  return close_column(file, path, values, code, error);
}

status picture_cloud_read_axis(const char *path, const char *name, double **values, size_t *rows, char unit[32],
                               struct error *error) {
  *values = NULL;
  *rows = 0;
  struct snapshot_read *file;
  TRY(snapshot_read_open(path, &file, error));
  status code = STATUS_OK;
  char at[96];
  snprintf(at, sizeof at, "axis/%.40s", name);
  bool kept = snapshot_read_has(file, "axis");
  if (kept && is_name(name))
    *values = snapshot_read_rows(file, at, 0, SNAPSHOT_READ_REAL, rows);
  if (*values)
    code = snapshot_read_text(file, at, "units", unit, 32) ? STATUS_OK : snapshot_read_refuse(path, error);
  else if (!kept)
    code = status_fail(error, STATUS_CONTENT, "%s has no profile: only runs with an impact or a piston keep one", path);
  else
    code = status_fail(error, STATUS_CONTENT,
                       "%s has no '%s' along the axis; it has distention, damage, pressure, velocity", path, name);
  return close_column(file, path, values, code, error);
}

void picture_cloud_clear(struct picture_cloud *cloud) {
  free(cloud->position);
  free(cloud->size);
  free(cloud->mass);
  free(cloud->fragment);
  free(cloud->part);
  free(cloud->value);
  *cloud = (struct picture_cloud){0};
}
