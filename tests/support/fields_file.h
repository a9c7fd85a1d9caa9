/* Reads fields files with HDF5 in a test. Any error fails the test. */
#pragma once

#include <hdf5.h>

#include "tests/support/run_case.h"

UNUSED static double fields_file_scalar(hid_t file, const char *name) {
  double value = NAN;
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0);
  H5Dclose(set);
  return value;
}

static herr_t fields_file_look(hid_t at, const char *name, const H5O_info_t *info, void *count) {
  const char *const own[] = {"VTKHDF/Connectivity", "VTKHDF/Offsets", "VTKHDF/Types", "VTKHDF/NumberOf"};
  if (info->type != H5O_TYPE_DATASET)
    return 0;
  for (int k = 0; k < 4; k++)
    if (strncmp(name, own[k], strlen(own[k])) == 0)
      return 0;
  hid_t set = H5Dopen2(at, name, H5P_DEFAULT), type = H5Dget_type(set);
  if (H5Aexists(set, "long_name") <= 0)
    fail_msg("/%s has no long_name", name);
  if (H5Tget_class(type) != H5T_STRING && H5Aexists(set, "units") <= 0)
    fail_msg("/%s has no units", name);
  H5Tclose(type);
  H5Dclose(set);
  ++*(size_t *)count;
  return 0;
}

/* Checks that every data set except VTK's own states its meaning, and every number its unit. Returns their count. */
UNUSED static size_t fields_file_described(hid_t file) {
  size_t count = 0;
  assert_true(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, fields_file_look, &count, H5O_INFO_BASIC) >= 0);
  return count;
}
