/* Fuzz target: any bytes as a shape file. An accepted shape is a body with a volume, an inside and distances. */
#include <math.h>
#include <stdlib.h>

#include "engine/mesh/mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void must(bool truth) {
  if (!truth)
    abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  struct mesh *mesh = NULL;
  struct error error;
  error.message[0] = 0;
  const status code = mesh_read("fuzz", bytes, size, &mesh, &error);
  must(code == STATUS_OK ? mesh != NULL : code == STATUS_CONTENT && error.message[0] && !mesh);
  if (!mesh)
    return 0;
  must(mesh->volume > 0 && isfinite(mesh->volume) && isfinite(mesh->area) && mesh->faces >= 4);
  const double up[3] = {0, 0, 1};
  double point[3], normal[3], largest = 0;
  for (int k = 0; k < 3; k++) {
    must(mesh->low[k] < mesh->high[k]);
    largest = fmax(largest, mesh->high[k] - mesh->low[k]);
  }
  must(mesh_reach(mesh, up) >= 0);
  (void)mesh_top(mesh, point, normal);
  for (int i = 0; i < 27; i++) {
    const int step[3] = {i % 3, i / 3 % 3, i / 9};
    for (int k = 0; k < 3; k++)
      point[k] = mesh->low[k] + (0.13 + 0.37 * step[k]) * (mesh->high[k] - mesh->low[k]);
    const double distance = mesh_distance(mesh, point, normal);
    must(fabs(distance) < 2 * largest && (distance < 0 || distance == 0 || !mesh_inside(mesh, point)));
    must(isfinite(normal[0]) && isfinite(normal[1]) && isfinite(normal[2]));
  }
  mesh_free(mesh);
  return 0;
}
