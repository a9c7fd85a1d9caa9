/* Fields files of engine dem describe their contents. */
#define CHECK_OWN_MAIN
#include "tests/support/run_case.h"

#include <unistd.h>

#include "engine/dem/run/run.h"
#include "tests/support/fields_file.h"
#include "tests/support/folder.h"

static struct dem_inputs small(bool gear) {
  return DEM_CASE("disc-explosion", "body.diameter=12 cm", "charge.energy=4 kJ/m", "stop.end_time=1 ms",
                  "contact.normal_damping=1e3 1/s", "contact.tangential_damping=1e3 1/s", "contact.friction=0.5",
                  gear ? "fidelity.integrator=gear" : "fidelity.integrator=verlet", "threshold.modulus=10");
}

static size_t rows(hid_t file, const char *name) {
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  hid_t space = H5Dget_space(set);
  hsize_t size[2] = {0, 0};
  H5Sget_simple_extent_dims(space, size, NULL);
  H5Sclose(space);
  H5Dclose(set);
  return size[0];
}

TEST(fields_describe_themselves) {
  struct dem_inputs cases[2] = {small(false),
                                DEM_CASE("compression", "body.columns=8", "body.rows=10", "loading.rate=20 1/s",
                                         "loading.ramp=0.5 ms", "loading.strain_end=3 %")};
  for (int c = 0; c < 2; c++) {
    void *run;
    char path[200];
    snprintf(path, sizeof path, "%s", in_folder("fields.hdf"));
    assert_int_equal(dem_engine.prepare(&cases[c], 5, &run, NULL), STATUS_OK);
    struct ran ran = run_case_end(&dem_engine, run, 1000);
    OK(dem_engine.write_snapshot(run, path, &error));
    size_t n = ((struct dem_run *)run)->tessellation->cell_count,
           beams = ((struct dem_run *)run)->tessellation->pair_count;
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    assert_int_equal(rows(file, "grains/position"), n);
    assert_int_equal(rows(file, "beams/strain"), beams);
    assert_int_equal(rows(file, "breaks/time"), ran.results.dem.broken);
    assert_int_equal(rows(file, "fragments/mass"), ran.count);
    assert_int_equal(rows(file, "VTKHDF/Offsets"), ran.results.dem.grains + 1);
    assert_int_equal(rows(file, "VTKHDF/Types"), ran.results.dem.grains);
    assert_true(H5Lexists(file, "curve", H5P_DEFAULT) == (c == 1));
    assert_true(fields_file_scalar(file, "outcome/time") == ran.outcome.time);
    assert_true(fields_file_scalar(file, "results/broken_share") == ran.results.dem.broken_share);
    assert_true(fields_file_scalar(file, "inputs/grain.density") == 5000);
    assert_true(fields_file_described(file) > dem_results.count + outcome_table.count);
    /* outlines: their areas are the grains' masses over the density */
    OWNED double *point = malloc(3 * rows(file, "VTKHDF/Points") * sizeof *point), *mass = malloc(n * sizeof *mass);
    OWNED int64_t *offset = malloc((n + 1) * sizeof *offset);
    hid_t set = H5Dopen2(file, "VTKHDF/Points", H5P_DEFAULT);
    H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, point);
    H5Dclose(set);
    set = H5Dopen2(file, "VTKHDF/Offsets", H5P_DEFAULT);
    H5Dread(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, offset);
    H5Dclose(set);
    set = H5Dopen2(file, "VTKHDF/CellData/mass", H5P_DEFAULT);
    H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, mass);
    H5Dclose(set);
    for (int64_t k = 0; k < ran.results.dem.grains; k++) {
      double area = 0;
      for (int64_t p = offset[k]; p < offset[k + 1]; p++) {
        int64_t q = p + 1 < offset[k + 1] ? p + 1 : offset[k];
        area += 0.5 * (point[3 * p] * point[3 * q + 1] - point[3 * q] * point[3 * p + 1]);
      }
      assert_true(fabs(area * 5000 / mass[k] - 1) <
                  1e-9); /* cross products of coordinates up to metres: 1e-16 / 1e-4 */
    }
    free(ran.fragments);
    H5Fclose(file);
    unlink(path);
    dem_engine.free(run);
  }
}

int main(void) {
  return check_run(make_folder, remove_folder);
}
