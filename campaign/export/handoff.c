/* One run for other programs: fragments for N-body codes, particles for SPH codes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "analysis/pictures/snapshot_read.h"
#include "campaign/export/export.h"
#include "engine/snapshot_file.h"
#include "schemas/file.h"
#include "schemas/memory.h"

#define PARTICLE(name) "VTKHDF/PointData/" name

/* A column of the file of `width` numbers a row; rows it must have are `n`. Owned by the caller; NULL: not there. */
static double *read_column(struct snapshot_read *file, const char *name, size_t width, size_t n) {
  size_t rows = 0;
  double *values = snapshot_read_rows(file, name, width, SNAPSHOT_READ_REAL, &rows);
  if (values && rows == n)
    return values;
  free(values);
  return NULL;
}

/* ---- fragments ---- */

struct bodies {
  size_t n;
  size_t dimensions; /* 2: masses are kg per metre of thickness, spins have one component */
  double *mass, *radius, *position, *velocity, *spin, *elements; /* owned */
  double without;                                                /* mass of particles that are in no fragment, kg */
};

static void free_bodies(struct bodies *b) {
  double *const all[] = {b->mass, b->radius, b->position, b->velocity, b->spin, b->elements};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
    free(all[i]);
}

/* Adds the volume of each particle to its fragment, and the mass of those that are in none, such as a projectile's. */
static bool add_volumes(struct snapshot_read *file, struct bodies *b) {
  size_t n = 0, labels = 0;
  OWNED double *mass = snapshot_read_rows(file, PARTICLE("mass"), 0, SNAPSHOT_READ_REAL, &n);
  OWNED double *density = read_column(file, PARTICLE("density"), 0, n);
  OWNED int64_t *label = snapshot_read_rows(file, PARTICLE("fragment"), 0, SNAPSHOT_READ_INTEGER, &labels);
  if (!mass || !density || !label || labels != n)
    return false;
  for (size_t i = 0; i < n; i++)
    if (label[i] >= 0 && (size_t)label[i] < b->n)
      b->radius[label[i]] += mass[i] / density[i];
    else
      b->without += mass[i];
  return true;
}

static bool read_radii(struct snapshot_read *file, struct bodies *b) {
  const double pi = acos(-1);
  OWNED double *density = b->dimensions == 2 ? read_column(file, "inputs/grain.density", 0, 1) : NULL;
  b->radius = calloc(b->n + 1, sizeof *b->radius);
  if (!b->radius || (b->dimensions == 2 ? !density : !add_volumes(file, b)))
    return false;
  for (size_t i = 0; i < b->n; i++)
    b->radius[i] = density ? sqrt(b->mass[i] / (pi * *density)) : cbrt(b->radius[i] * 3 / (4 * pi));
  return true;
}

static bool read_bodies(struct snapshot_read *file, struct bodies *b) {
  b->mass = snapshot_read_rows(file, "fragments/mass", 0, SNAPSHOT_READ_REAL, &b->n);
  b->position = b->mass ? read_column(file, "fragments/position", 3, b->n) : NULL;
  b->dimensions = b->position ? 3 : 2;
  if (b->mass && !b->position)
    b->position = read_column(file, "fragments/position", 2, b->n);
  b->velocity = read_column(file, "fragments/velocity", b->dimensions, b->n);
  b->spin = read_column(file, "fragments/spin", b->dimensions == 3 ? 3 : 0, b->n);
  b->elements = read_column(file, "fragments/count", 0, b->n);
  return b->mass && b->position && b->velocity && b->spin && b->elements && read_radii(file, b);
}

static void put(FILE *out, double value, const char *before) {
  fputs(before, out);
  if (isfinite(value)) /* the spin of few particles is not known */
    fprintf(out, "%.17g", value);
}

static void write_csv(FILE *out, const struct bodies *b) {
  fputs(b->dimensions == 3 ? "mass [kg],radius [m],x [m],y [m],z [m],vx [m/s],vy [m/s],vz [m/s],spin_x [rad/s],"
                             "spin_y [rad/s],spin_z [rad/s],elements\n"
                           : "mass [kg/m],radius [m],x [m],y [m],vx [m/s],vy [m/s],spin [rad/s],elements\n",
        out);
  for (size_t i = 0; i < b->n; i++) {
    put(out, b->mass[i], "");
    put(out, b->radius[i], ",");
    for (size_t d = 0; d < b->dimensions; d++)
      put(out, b->position[i * b->dimensions + d], ",");
    for (size_t d = 0; d < b->dimensions; d++)
      put(out, b->velocity[i * b->dimensions + d], ",");
    for (size_t d = 0; d < (b->dimensions == 3 ? 3 : 1); d++)
      put(out, b->spin[b->dimensions == 3 ? 3 * i + d : i], ",");
    put(out, b->elements[i], ",");
    fputc('\n', out);
  }
}

/* A line per body: mass, radius, position, velocity (REBOUND, Simulation.add_particles_ascii). */
static void write_rebound(FILE *out, const struct bodies *b) {
  for (size_t i = 0; i < b->n; i++) {
    put(out, b->mass[i], "");
    put(out, b->radius[i], " ");
    for (size_t d = 0; d < 3; d++)
      put(out, b->position[3 * i + d], " ");
    for (size_t d = 0; d < 3; d++)
      put(out, b->velocity[3 * i + d], " ");
    fputc('\n', out);
  }
}

static status read_fragments(struct snapshot_read *file, const char *fields, bool csv, struct bodies *b,
                             struct error *error) {
  if (!read_bodies(file, b))
    return snapshot_read_refuse(fields, error);
  return csv || b->dimensions == 3
             ? STATUS_OK
             : status_fail(error, STATUS_CONTENT,
                           "%s: its body is in the plane, and its masses are per metre: REBOUND needs kg. Write a .csv",
                           fields);
}

static status write_fragments(const char *target, bool csv, const struct bodies *b, struct error *error) {
  struct file_output output;
  TRY(file_begin(&output, target, "fragments", error));
  (csv ? write_csv : write_rebound)(output.out, b);
  return file_end(&output, STATUS_OK, error);
}

/* ---- particles in the layout of miluphcuda ---- */

/* Data sets of miluphcuda's input (its file io.cu), and those of a fields file. */
static const struct column {
  const char *theirs, *ours;
  size_t width;
  bool may_lack; /* the modules of a run decide */
  const char *units, *long_name;
} columns[] = {
    {"x", "VTKHDF/Points", 3, false, "m", "position"},
    {"v", PARTICLE("velocity"), 3, false, "m s-1", "velocity"},
    {"m", PARTICLE("mass"), 0, false, "kg", "mass"},
    {"rho", PARTICLE("density"), 0, false, "kg m-3", "density"},
    {"p", PARTICLE("pressure"), 0, false, "Pa", "pressure that acts; 0 where broken matter is under tension"},
    {"e", PARTICLE("energy"), 0, false, "J kg-1", "specific internal energy"},
    {"sml", PARTICLE("smoothing_length"), 0, false, "m", "reach of the particle: twice clast's smoothing length"},
    {"material_type", PARTICLE("body"), 0, false, "1", "0 the target, 1 the projectile"},
    {"deviatoric_stress", PARTICLE("deviator"), 9, true, "Pa", "deviatoric stress, undamaged"},
    {"DIM_root_of_damage_tensile", PARTICLE("damage"), 0, true, "1", "cube root of the damage"},
    {"alpha_jutzi", PARTICLE("distention"), 0, true, "1", "distention"},
};

/* The number as miluphcuda has it. */
static double theirs(const struct column *column, double value) {
  if (strcmp(column->theirs, "sml") == 0)
    return 2 * value;
  if (strcmp(column->theirs, "DIM_root_of_damage_tensile") == 0)
    return cbrt(value);
  return isnan(value) ? 0 : value;
}

static status read_particles(struct snapshot_read *file, const char *fields, struct snapshot_file **out,
                             struct error *error) {
  size_t n = 0;
  double time = 0;
  OWNED double *place = snapshot_read_rows(file, columns[0].ours, 3, SNAPSHOT_READ_REAL, &n);
  OWNED double *mass = read_column(file, PARTICLE("mass"), 0, n);
  if (!place || !mass || !snapshot_read_real(file, "run", "time", &time))
    return status_fail(error, STATUS_CONTENT, "%s has no particles: give a fields file of the engine sph", fields);
  TRY(snapshot_file_open_plain(out, error));
  snapshot_file_data(*out, "time", SNAPSHOT_FILE_REAL, 1, 0, &time, "s", "simulated time");
  for (size_t k = 0; k < sizeof columns / sizeof columns[0]; k++) {
    const size_t width = columns[k].width ? columns[k].width : 1;
    OWNED double *values = read_column(file, columns[k].ours, columns[k].width, n);
    if (!values && !columns[k].may_lack)
      return snapshot_read_refuse(fields, error);
    for (size_t i = 0; values && i < n * width; i++)
      values[i] = theirs(&columns[k], values[i]);
    if (values)
      snapshot_file_data(*out, columns[k].theirs, SNAPSHOT_FILE_REAL, n, columns[k].width, values, columns[k].units,
                         columns[k].long_name);
  }
  return STATUS_OK;
}

/* ---- both ---- */

static void read_doubts(struct snapshot_read *file, struct ask_doubts *doubts) {
  char engine[64] = "", words[FIELD_TEXT_SIZE] = "";
  if (snapshot_read_text(file, "run", "engine", engine, sizeof engine) &&
      snapshot_read_text(file, "outcome", "warnings", words, sizeof words))
    ask_doubts_run(doubts, engine, words, OUTCOME_DEFAULT, 1);
}

status export_run(const char *fields, const char *target, struct error *error) {
  struct snapshot_read *file = NULL;
  const char *ending = strrchr(target, '.');
  const bool csv = ending && strcasecmp(ending, ".csv") == 0, rebound = ending && strcasecmp(ending, ".txt") == 0;
  const bool particles = ending && (strcasecmp(ending, ".h5") == 0 || strcasecmp(ending, ".hdf5") == 0);
  if (!csv && !rebound && !particles)
    return status_fail(error, STATUS_USAGE,
                       "\"%.64s\": its ending must be .csv (fragments), .txt (fragments for REBOUND) or .h5 (particles "
                       "for miluphcuda)",
                       target);
  struct bodies bodies = {0};
  struct snapshot_file *out = NULL;
  struct ask_doubts doubts = {0};
  TRY(file_claim(target, "output", error));
  TRY(snapshot_read_open(fields, &file, error));
  status code = particles ? read_particles(file, fields, &out, error)
                          : read_fragments(file, fields, csv, &bodies, error);
  read_doubts(file, &doubts);
  if (!snapshot_read_close(file) && code == STATUS_OK)
    code = snapshot_read_refuse(fields, error);
  if (code == STATUS_OK)
    code = particles ? snapshot_file_save(out, target, error) : write_fragments(target, csv, &bodies, error);
  if (code == STATUS_OK && bodies.without > 0)
    fprintf(stderr, "clast: %.3g kg in no fragment, such as those of a projectile, are left out: a .h5 has them\n",
            bodies.without);
  if (code == STATUS_OK) /* other programs have no place for marks */
    uncertainty_doubts(&doubts, stderr);
  snapshot_file_close(out);
  free_bodies(&bodies);
  return code;
}
