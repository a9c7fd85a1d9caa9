/* Blocks between two moving sides: elastic moduli (K99 section 3.1) and the compressive strength test (section 3.2).
 *
 * The grains of the lower and upper row are the sides. They move apart or together at a speed that grows from zero with
 * constant acceleration during `ramp` and is constant from then on. Uniaxial load: they may slide along x, but neither
 * turn nor leave their line ("the boundaries parallel to the loading are free"). Compression: x and rotation are held
 * too, the confined ends of K99's figure 7.
 *
 * Stress is the mean of the forces on both sides over the block's first width, strain the change of their distance over
 * its first value; the curve has their means over the steps between two samples. The strength is no such mean: the
 * samples depend on the strain at which the run ends. */
#include <math.h>
#include <stdlib.h>

#include "engine/dem/run/run.h"

enum { SAMPLES = 2000 };

static double sense(const struct dem_run *run) {
  return run->inputs.kind == DEM_UNIAXIAL && run->inputs.loading.direction == DEM_EXTENSION ? 1 : -1;
}

static double mean(const struct dem_run *run, const uint32_t *grain, size_t count, bool x) {
  double sum = 0;
  for (size_t k = 0; k < count; k++) {
    struct dem_grain g = dem_system_grain(run->system, grain[k]);
    sum += x ? g.x : g.y;
  }
  return sum / (double)count;
}

static status allocate(struct dem_run *run, struct error *error) {
  const size_t n = run->tessellation->cell_count;
  const double steps = ceil(dem_inputs_end_time(&run->inputs) / run->inputs.fidelity.time_step);
  run->sample_interval = (uint64_t)fmax(1, floor(steps / SAMPLES));
  run->sample_capacity = (size_t)(1.1 * steps / (double)run->sample_interval) + 8;
  run->sample = calloc(run->sample_capacity, sizeof *run->sample);
  run->lower = malloc(4 * n * sizeof *run->lower); /* one block for the four lists */
  if (run->sample && run->lower) {
    run->upper = run->lower + n;
    run->left = run->upper + n;
    run->right = run->left + n;
    return STATUS_OK;
  }
  return status_fail(error, STATUS_MEMORY, "no memory for the sides of %zu grains", n);
}

/* A grain of the middle half, away from the held sides, may be one of those at which the width is measured. */
static void add_to_gauge(struct dem_run *run, uint32_t grain) {
  const struct dem_tessellation *t = run->tessellation;
  const uint32_t rows = (uint32_t)run->inputs.body.rows, columns = (uint32_t)run->inputs.body.columns;
  if (t->grid_y[grain] < rows / 4 || t->grid_y[grain] >= rows - rows / 4)
    return;
  if (t->grid_x[grain] == 0)
    run->left[run->left_count++] = grain;
  if (t->grid_x[grain] == columns - 1)
    run->right[run->right_count++] = grain;
}

status dem_loading_start(struct dem_run *run, struct error *error) {
  const struct dem_tessellation *t = run->tessellation;
  const uint32_t rows = (uint32_t)run->inputs.body.rows;
  const unsigned freedoms = run->inputs.kind == DEM_COMPRESSION ? 7 : 6;
  TRY(allocate(run, error));
  for (uint32_t c = 0; c < t->cell_count; c++) {
    const bool lower = t->grid_y[c] == 0, upper = t->grid_y[c] == rows - 1;
    if (lower)
      run->lower[run->lower_count++] = c;
    if (upper)
      run->upper[run->upper_count++] = c;
    if (!lower && !upper) {
      add_to_gauge(run, c);
      continue;
    }
    run->held[c] = (unsigned char)freedoms;
    dem_system_hold(run->system, c, freedoms);
  }
  run->gauge_length = mean(run, run->upper, run->upper_count, false) - mean(run, run->lower, run->lower_count, false);
  run->gauge_width = mean(run, run->right, run->right_count, true) - mean(run, run->left, run->left_count, true);
  run->section = (uint32_t)run->inputs.body.columns * run->inputs.grain.spacing;
  return STATUS_OK;
}

void dem_loading_drive(struct dem_run *run) {
  double time = dem_system_now(run->system)->time, ramp = run->inputs.loading.ramp;
  /* the speed in the middle of the step: its sum is then exact for a linear rise */
  double share = ramp > 0 ? fmin((time + 0.5 * run->inputs.fidelity.time_step) / ramp, 1) : 1;
  double speed = 0.5 * sense(run) * run->inputs.loading.rate * run->gauge_length * share;
  for (size_t k = 0; k < run->lower_count; k++)
    dem_system_drive(run->system, run->lower[k], 0, -speed, 0);
  for (size_t k = 0; k < run->upper_count; k++)
    dem_system_drive(run->system, run->upper[k], 0, speed, 0);
}

static double
strain_now(const struct dem_run *run) { /* all grains of a side keep their line: one grain of each is enough */
  double upper = dem_system_grain(run->system, run->upper[0]).y - run->tessellation->centroid[run->upper[0]].y;
  double lower = dem_system_grain(run->system, run->lower[0]).y - run->tessellation->centroid[run->lower[0]].y;
  return (upper - lower) / run->gauge_length;
}

static void sample(struct dem_run *run) {
  struct dem_state *s = &run->state;
  double n = (double)s->summed;
  const struct dem_break *log;
  struct dem_sample point = {.time = dem_system_now(run->system)->time,
                             .strain = s->strain_sum / n,
                             .stress = s->stress_sum / n,
                             .lateral_strain = (mean(run, run->right, run->right_count, true) -
                                                mean(run, run->left, run->left_count, true)) /
                                                   run->gauge_width -
                                               1,
                             .broken = dem_system_breaks(run->system, &log)};
  if (s->frame.samples < run->sample_capacity)
    run->sample[s->frame.samples++] = point;
  s->summed = 0;
  s->stress_sum = s->strain_sum = 0;
  if (run->inputs.kind == DEM_COMPRESSION && !field_is_off(run->inputs.loading.residual) && point.broken > 0 &&
      sense(run) * point.stress < run->inputs.loading.residual * s->stress_peak)
    frame_end(&run->state.frame, DEM_STOP_FAILURE, OUTCOME_COMPLETED, "%s", "");
}

void dem_loading_record(struct dem_run *run) {
  struct dem_state *s = &run->state;
  double lower = 0, upper = 0, fx, fy, torque;
  for (size_t k = 0; k < run->lower_count; k++) {
    dem_system_force(run->system, run->lower[k], &fx, &fy, &torque);
    lower += fy;
  }
  for (size_t k = 0; k < run->upper_count; k++) {
    dem_system_force(run->system, run->upper[k], &fx, &fy, &torque);
    upper += fy;
  }
  const double strain = strain_now(run);
  const double stress = 0.5 * (lower - upper) / run->section; /* a stretched body pulls its sides inwards */
  s->stress_sum += stress;
  s->strain_sum += strain;
  if (sense(run) * stress > s->stress_peak) {
    s->stress_peak = sense(run) * stress;
    s->strain_peak = sense(run) * strain;
    s->time_peak = dem_system_now(run->system)->time;
  }
  if (++s->summed == run->sample_interval)
    sample(run);
  if (sense(run) * strain >= run->inputs.loading.strain_end * (1 - 1e-9))
    frame_end(&run->state.frame, DEM_STOP_STRAIN, OUTCOME_COMPLETED, "%s", "");
}

/* Slope of y against x by least squares with an intercept, over samples with lowest <= |strain| <= highest. NaN below 3
 * samples. */
static double slope(const struct dem_run *run, bool lateral, double lowest, double highest) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t k = 0; k < run->state.frame.samples; k++) {
    const struct dem_sample *p = &run->sample[k];
    if (fabs(p->strain) < lowest || fabs(p->strain) > highest || p->time < run->inputs.loading.ramp)
      continue;
    double y = lateral ? p->lateral_strain : p->stress;
    n += 1;
    sx += p->strain;
    sy += y;
    sxx += p->strain * p->strain;
    sxy += p->strain * y;
  }
  return n >= 3 ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : (double)NAN;
}

/* K99 figure 8 as numbers: upright cracks, and intact triangles on the confined ends. Counts breaks up to the largest
 * stress. */
static void pattern(const struct dem_run *run, struct dem_results *results) {
  const struct dem_tessellation *t = run->tessellation;
  double width = run->section, height = (double)run->inputs.body.rows * run->inputs.grain.spacing;
  const struct dem_break *log;
  size_t breaks = dem_system_breaks(run->system, &log);
  double beams[2] = {0}, broken[2] = {0}, upright = 0, all = 0; /* by [inside the triangles] */
  for (size_t p = 0; p < t->pair_count + breaks; p++) {
    bool is_break = p >= t->pair_count;
    if (is_break && log[p - t->pair_count].time > run->state.time_peak)
      continue;
    const uint32_t *pair = t->pair[is_break ? log[p - t->pair_count].beam : p];
    struct dem_point a = t->centroid[pair[0]], b = t->centroid[pair[1]];
    double x = 0.5 * (a.x + b.x), y = 0.5 * (a.y + b.y);
    double depth = fmin(y, height - y); /* from the nearer end; 45 degrees: as far from the middle as from the apex */
    int inside = fabs(x - width / 2) < width / 2 - depth;
    if (!is_break) {
      beams[inside] += 1;
      continue;
    }
    broken[inside] += 1;
    all += 1;
    uint32_t common[2];
    struct dem_point side;
    upright += dem_tessellation_side(t, pair[0], pair[1], common, &side) &&
               fabs(side.x) < 0.57735026918962576 * fabs(side.y); /* within 30 degrees of the load */
  }
  results->upright_share = all > 0 ? upright / all : (double)NAN;
  results->end_triangle_share = broken[0] > 0 && beams[1] > 0 ? (broken[1] / beams[1]) / (broken[0] / beams[0])
                                                              : (double)NAN;
}

double dem_loading_slope_end(const struct dem_run *run) {
  if (run->inputs.kind == DEM_COMPRESSION)
    return 0.5 * run->state.strain_peak;
  for (size_t k = 0; k < run->state.frame.samples; k++)
    if (run->sample[k].broken > 0)
      return k > 0 ? fabs(run->sample[k - 1].strain) : 0;
  return run->inputs.loading.strain_end;
}

/* From a tenth of the strain that a block bears whole, or of its failure strain, on, after the first vibrations. */
static double slope_begin(const struct dem_run *run) {
  return (run->inputs.kind == DEM_COMPRESSION ? 0.2 : 0.1) * dem_loading_slope_end(run);
}

double dem_loading_bend(const struct dem_run *run) {
  const double begin = slope_begin(run), end = dem_loading_slope_end(run), middle = (begin + end) / 2;
  return fabs(slope(run, false, middle, end) / slope(run, false, begin, middle) - 1);
}

void dem_loading_results(const struct dem_run *run, struct dem_results *results) {
  const struct dem_state *s = &run->state;
  if (s->frame.samples == 0)
    return;
  results->final_strain = fabs(run->sample[s->frame.samples - 1].strain);
  const double lowest = slope_begin(run), highest = dem_loading_slope_end(run);
  results->young_modulus = slope(run, false, lowest, highest);
  results->poisson_ratio = -slope(run, true, lowest, highest);
  results->strength = s->stress_peak;
  results->failure_strain = s->strain_peak;
  if (run->inputs.kind == DEM_COMPRESSION)
    pattern(run, results);
}
