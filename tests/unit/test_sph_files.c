/* Fields files of engine sph describe their contents and agree with what the run reports. */
#define CHECK_OWN_MAIN
#include "tests/support/run_case.h"

#include <unistd.h>

#include "analysis/pictures/picture.h"
#include "engine/sph/run/run.h"
#include "tests/support/fields_file.h"
#include "tests/support/folder.h"

static struct sph_inputs impact(void) {
  return SPH_CASE("basalt-sphere", "fidelity.particles=700", "stop.end_time=25 us");
}

TEST(fields_hold_what_the_run_reports) {
  struct sph_inputs inputs = impact();
  char path[200];
  void *handle;
  snprintf(path, sizeof path, "%s", in_folder("fields.hdf"));
  assert_int_equal(sph_engine.prepare(&inputs, 5, &handle, NULL), STATUS_OK);
  struct sph_run *run = handle;
  if (sph_engine.write_snapshot(run, path, &error))
    fail_msg("before the first step: %s", error.message);
  struct ran ran = run_case_end(&sph_engine, run, 1000);
  OK(sph_engine.write_snapshot(run, path, &error));
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(fields_file_described(file) > sph_results.count / 2 + outcome_table.count + 20);
  assert_true(fields_file_scalar(file, "outcome/time") == ran.outcome.time && sph_engine.time(run) == ran.outcome.time);
  assert_true(fields_file_scalar(file, "results/largest.veneer_fraction") == ran.results.sph.largest.veneer_fraction);
  H5Fclose(file);
  struct picture_cloud cloud;
  OK(picture_cloud_read(path, &cloud, &error));
  assert_int_equal(cloud.n, run->start->n);
  assert_true(cloud.time == ran.outcome.time && cloud.seed == 5);
  double *column, mass = 0, flaws = 0;
  int64_t singles = 0;
  char unit[32];
  OWNED double *heaviest = calloc(cloud.n, sizeof *heaviest);
  for (size_t i = 0; i < cloud.n; i++) {
    assert_int_equal(cloud.part[i] == 3, i >= run->targets); /* the projectile belongs to no fragment */
    if (cloud.fragment[i] < 0)
      continue;
    mass += cloud.mass[i];
    heaviest[cloud.fragment[i]] += cloud.mass[i];
    singles += cloud.part[i] == 2;
  }
  assert_true(fabs(heaviest[0] / mass - ran.outcome.largest_fraction) < 1e-12); /* sums in another order */
  assert_true(singles > 0 && singles <= ran.outcome.single_count);
  for (size_t f = 0; f < ran.count; f++)
    assert_true(fabs(heaviest[f] - ran.fragments[f].mass) <= 1e-12 * mass);
  OK(picture_cloud_read_column(path, &cloud, "flaws", &column, unit, &error));
  for (size_t i = 0; i < cloud.n; i++) {
    assert_true(i < run->targets ? column[i] >= 1 : column[i] == 0); /* every particle of the target has one */
    flaws += column[i];
  }
  assert_true(flaws == (double)ran.results.sph.flaws);
  free(column);
  free(ran.fragments);
  picture_cloud_clear(&cloud);
  unlink(path);
  sph_engine.free(run);
}

int main(void) {
  return check_run(make_folder, remove_folder);
}
