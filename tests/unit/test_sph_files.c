/* Files of a run of engine sph: restart files give the same bits and refuse what is not theirs; fields files explain
 * themselves and hold what the run reports; both are whole or not there. */
#include "tests/run_case.h"

#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/cloud.h"
#include "engine/sph/run.h"

static char folder[] = "/tmp/clast_sph_files_XXXXXX";

static const char *in_folder(const char *name) {
  static char path[200];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder); /* fails when a test or a failed write left anything behind */
}

static struct sph_inputs impact(void) {
  return SPH_CASE("basalt-sphere", "fidelity.particles=700", "stop.end_time=25 us");
}

static void restart_continues_with_the_same_bits(void **state) {
  (void)state;
  const struct sph_inputs cases[] = {
      impact(),
      SPH_CASE("basalt-sphere", "fidelity.particles=500", "stop.end_time=8 us", "fidelity.precision=float", "fidelity.threads=2"),
      SPH_CASE("tensile-rod", "fidelity.particles=600", "stop.end_time=8 us"),
      SPH_CASE("elastic-bar", "fidelity.particles=600", "stop.end_time=12 us"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    void *run, *again;
    bool finished = false;
    struct error error = {0};
    if (sph_engine.prepare(&cases[c], 11, &run, &error)) fail_msg("%s", error.message);
    struct ran straight = run_case_end(&sph_engine, run, 37);
    sph_engine.free(run);
    assert_int_equal(sph_engine.prepare(&cases[c], 11, &run, &error), STATUS_OK);
    uint64_t half = (uint64_t)straight.outcome.steps / 2 + 3; /* amid lists that are reused */
    assert_int_equal(sph_engine.step(run, half, &finished, &error), STATUS_OK);
    if (finished || straight.outcome.steps < 40) fail_msg("case %zu has %lld steps only", c, (long long)straight.outcome.steps);
    if (sph_engine.save(run, in_folder("run.restart"), &error)) fail_msg("%s", error.message);
    sph_engine.free(run);
    if (sph_engine.restore(&cases[c], in_folder("run.restart"), &again, &error)) fail_msg("%s", error.message);
    assert_int_equal(sph_system_steps(((struct sph_run *)again)->system), half);
    run_case_same(&sph_engine, &straight, run_case_end(&sph_engine, again, 37));
    sph_engine.free(again);
    free(straight.fragments);
    unlink(in_folder("run.restart"));
  }
}

static void damaged_or_foreign_restart_is_refused(void **state) {
  (void)state;
  struct sph_inputs inputs = impact(), other = inputs;
  void *run;
  bool finished;
  struct error error = {0};
  char path[200];
  snprintf(path, sizeof path, "%s", in_folder("a.restart"));
  assert_int_equal(sph_engine.prepare(&inputs, 1, &run, NULL), STATUS_OK);
  sph_engine.step(run, 5, &finished, NULL);
  assert_int_equal(sph_engine.save(run, path, NULL), STATUS_OK);
  sph_engine.free(run);
  other.impact.speed *= 1 + 1e-15;
  assert_int_equal(sph_engine.restore(&other, path, &run, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "another scene"));
  assert_null(run);
  struct stat info;
  assert_int_equal(stat(path, &info), 0);
  for (int k = 0; k < 40; k++) { /* one byte changed anywhere */
    off_t at = info.st_size * k / 40;
    FILE *file = fopen(path, "r+b");
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 0x40, file);
    fclose(file);
    assert_int_equal(sph_engine.restore(&inputs, path, &run, &error), STATUS_CONTENT);
    file = fopen(path, "r+b");
    fseek(file, at, SEEK_SET);
    fputc(byte, file);
    fclose(file);
  }
  assert_int_equal(sph_engine.restore(&inputs, path, &run, &error), STATUS_OK);
  sph_engine.free(run);
  assert_int_equal(truncate(path, info.st_size / 2), 0);
  assert_int_equal(sph_engine.restore(&inputs, path, &run, &error), STATUS_CONTENT);
  assert_int_equal(truncate(path, 0), 0);
  assert_int_equal(sph_engine.restore(&inputs, path, &run, &error), STATUS_CONTENT);
  unlink(path);
  assert_int_equal(sph_engine.restore(&inputs, path, &run, &error), STATUS_MISSING);
}

static herr_t described(hid_t at, const char *name, const H5O_info_t *info, void *count) {
  const char *const own[] = {"VTKHDF/Connectivity", "VTKHDF/Offsets", "VTKHDF/Types", "VTKHDF/NumberOf"};
  if (info->type != H5O_TYPE_DATASET) return 0;
  for (int k = 0; k < 4; k++)
    if (strncmp(name, own[k], strlen(own[k])) == 0) return 0;
  hid_t set = H5Dopen2(at, name, H5P_DEFAULT), type = H5Dget_type(set);
  if (H5Aexists(set, "long_name") <= 0) fail_msg("/%s has no long_name", name);
  if (H5Tget_class(type) != H5T_STRING && H5Aexists(set, "units") <= 0) fail_msg("/%s has no units", name);
  H5Tclose(type);
  H5Dclose(set);
  ++*(size_t *)count;
  return 0;
}

static double scalar(hid_t file, const char *name) {
  double value = NAN;
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0);
  H5Dclose(set);
  return value;
}

static void fields_hold_what_the_run_reports(void **state) {
  (void)state;
  struct sph_inputs inputs = impact();
  struct error error = {0};
  char path[200];
  void *handle;
  snprintf(path, sizeof path, "%s", in_folder("fields.hdf"));
  assert_int_equal(sph_engine.prepare(&inputs, 5, &handle, NULL), STATUS_OK);
  struct sph_run *run = handle;
  if (sph_engine.write_fields(run, path, &error)) fail_msg("before the first step: %s", error.message);
  struct ran ran = run_case_end(&sph_engine, run, 1000);
  if (sph_engine.write_fields(run, path, &error)) fail_msg("%s", error.message);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  size_t datasets = 0;
  assert_true(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, described, &datasets, H5O_INFO_BASIC) >= 0);
  assert_true(datasets > sph_results.count / 2 + outcome_table.count + 20);
  assert_true(scalar(file, "outcome/time") == ran.outcome.time && sph_engine.time(run) == ran.outcome.time);
  assert_true(scalar(file, "results/largest.veneer_fraction") == ran.results.sph.largest.veneer_fraction);
  H5Fclose(file);
  struct cloud cloud;
  if (cloud_read(path, &cloud, &error)) fail_msg("%s", error.message);
  assert_int_equal(cloud.n, run->start->n);
  assert_true(cloud.time == ran.outcome.time && cloud.seed == 5);
  double *column, mass = 0, dust = 0, flaws = 0;
  char unit[32], meaning[128];
  double *heaviest = calloc(cloud.n, sizeof *heaviest);
  for (size_t i = 0; i < cloud.n; i++) {
    assert_int_equal(cloud.part[i] == 3, i >= run->targets); /* the projectile belongs to nothing */
    if (cloud.fragment[i] < 0) continue;
    mass += cloud.mass[i];
    heaviest[cloud.fragment[i]] += cloud.mass[i];
    if (cloud.part[i] == 2) dust += cloud.mass[i];
  }
  assert_true(fabs(heaviest[0] / mass - ran.outcome.largest_fraction) < 1e-12); /* sums in another order */
  assert_true(dust / mass <= ran.outcome.dust_fraction + 1e-12);
  for (size_t f = 0; f < ran.count; f++)
    assert_true(fabs(heaviest[f] - ran.fragments[f].mass) <= 1e-12 * mass);
  assert_int_equal(cloud_read_column(path, &cloud, "flaws", &column, unit, meaning, &error), STATUS_OK);
  for (size_t i = 0; i < cloud.n; i++) {
    assert_true(i < run->targets ? column[i] >= 1 : column[i] == 0); /* every particle of the target has one */
    flaws += column[i];
  }
  assert_true(flaws == (double)ran.results.sph.flaws);
  free(column);
  free(heaviest);
  free(ran.fragments);
  cloud_clear(&cloud);
  unlink(path);
  sph_engine.free(run);
}

static void failed_writes_are_one_error_and_leave_nothing(void **state) {
  (void)state;
  struct sph_inputs inputs = impact();
  void *run;
  struct error error = {0};
  assert_int_equal(sph_engine.prepare(&inputs, 5, &run, NULL), STATUS_OK);
  assert_int_equal(sph_engine.write_fields(run, in_folder("no/such/folder.hdf"), &error), STATUS_IO);
  assert_int_equal(sph_engine.save(run, in_folder("no/such/folder.restart"), &error), STATUS_IO);
  signal(SIGXFSZ, SIG_IGN); /* a disk that fills up: a limit on file size gives the same error at the same place */
  struct rlimit before, limit;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  limit = before;
  limit.rlim_cur = 30000;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
  status fields = sph_engine.write_fields(run, in_folder("full.hdf"), &error);
  status restart = sph_engine.save(run, in_folder("full.restart"), &error);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(fields, STATUS_IO);
  assert_int_equal(restart, STATUS_IO);
  assert_non_null(strstr(error.message, "too large"));
  sph_engine.free(run); /* that nothing is left in the folder, remove_folder sees */
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(restart_continues_with_the_same_bits), cmocka_unit_test(damaged_or_foreign_restart_is_refused),
      cmocka_unit_test(fields_hold_what_the_run_reports), cmocka_unit_test(failed_writes_are_one_error_and_leave_nothing)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
