/* From the faces of a file to a closed surface. */
#include <stdlib.h>
#include <string.h>

#include "engine/mesh/build.h"

/* ---- one vertex for all that are equal ---- */

struct place {
  double at[3];
  uint32_t vertex;
};

static int compare_places(const void *a, const void *b) {
  const struct place *p = a, *q = b;
  for (int k = 0; k < 3; k++)
    if (p->at[k] != q->at[k])
      return p->at[k] < q->at[k] ? -1 : 1;
  return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

/* The vertex with the lowest number stands for all that are equal. */
static status merge_vertices(struct mesh_soup *soup, struct error *error) {
  struct place *places = malloc((soup->vertices + 1) * sizeof *places);
  uint32_t *same = malloc((soup->vertices + 1) * sizeof *same);
  if (!places || !same) {
    free(places);
    free(same);
    return status_fail(error, STATUS_MEMORY, "no memory for %zu vertices", soup->vertices);
  }
  for (size_t v = 0; v < soup->vertices; v++) {
    memcpy(places[v].at, soup->vertex[v], sizeof places[v].at);
    places[v].vertex = (uint32_t)v;
  }
  qsort(places, soup->vertices, sizeof *places, compare_places);
  for (size_t i = 0; i < soup->vertices; i++) {
    const bool again = i > 0 && memcmp(places[i].at, places[i - 1].at, sizeof places[i].at) == 0;
    same[places[i].vertex] = again ? same[places[i - 1].vertex] : places[i].vertex;
  }
  for (size_t f = 0; f < soup->faces; f++)
    for (int c = 0; c < 3; c++)
      soup->face[f][c] = same[soup->face[f][c]];
  free(places);
  free(same);
  return STATUS_OK;
}

/* ---- faces ---- */

static status check_faces(const struct mesh_soup *soup, struct error *error) {
  for (size_t f = 0; f < soup->faces; f++) {
    const uint32_t *corner = soup->face[f];
    const double *a = soup->vertex[corner[0]], *b = soup->vertex[corner[1]], *c = soup->vertex[corner[2]];
    double n[3], squares = 0;
    for (int k = 0; k < 3; k++) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      n[k] = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
      squares += n[k] * n[k];
    }
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0] || !(squares > 0))
      return mesh_refuse(soup, soup->line[f], error,
                         "the face has no area: remove such faces (MeshLab: Remove Zero Area Faces, Merge Close "
                         "Vertices)");
  }
  return STATUS_OK;
}

/* ---- edges ---- */

struct edge {
  uint32_t low, high, face;
  bool rises; /* from the lower vertex to the higher one */
};

static int compare_edges(const void *a, const void *b) {
  const struct edge *p = a, *q = b;
  if (p->low != q->low)
    return p->low < q->low ? -1 : 1;
  if (p->high != q->high)
    return p->high < q->high ? -1 : 1;
  return p->face < q->face ? -1 : p->face > q->face;
}

/* One edge that belongs to `count` faces. */
static status check_edge(const struct mesh_soup *soup, const struct edge *edge, size_t count, struct error *error) {
  const double *a = soup->vertex[edge->low], *b = soup->vertex[edge->high];
  const size_t line = soup->line[edge->face];
  if (count == 1)
    return mesh_refuse(soup, line, error,
                       "the surface is open: the edge of this face from (%g, %g, %g) to (%g, %g, %g) has no second "
                       "face; close the hole (MeshLab: Merge Close Vertices, Close Holes)",
                       a[0], a[1], a[2], b[0], b[1], b[2]);
  if (count > 2)
    return mesh_refuse(soup, line, error,
                       "the edge of this face from (%g, %g, %g) to (%g, %g, %g) has %zu faces, and two are allowed: "
                       "remove doubled faces (MeshLab: Repair Non Manifold Edges)",
                       a[0], a[1], a[2], b[0], b[1], b[2], count);
  if (edge[0].rises == edge[1].rises)
    return mesh_refuse(soup, line, error,
                       "this face and that of %s %u turn opposite ways, so that one of their normals points inwards: "
                       "turn all normals outwards (MeshLab: Re-Orient All Faces Coherently)",
                       soup->numbered ? "number" : "line", soup->line[edge[1].face]);
  return STATUS_OK;
}

static status check_edges(const struct mesh_soup *soup, struct error *error) {
  const size_t count = 3 * soup->faces;
  struct edge *edges = malloc(count * sizeof *edges);
  if (!edges)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu edges", count);
  for (size_t f = 0; f < soup->faces; f++)
    for (size_t c = 0; c < 3; c++) {
      const uint32_t from = soup->face[f][c], to = soup->face[f][(c + 1) % 3];
      edges[3 * f + c] = from < to ? (struct edge){from, to, (uint32_t)f, true}
                                   : (struct edge){to, from, (uint32_t)f, false};
    }
  qsort(edges, count, sizeof *edges, compare_edges);
  status code = STATUS_OK;
  for (size_t i = 0, next; i < count && !code; i = next) {
    for (next = i + 1; next < count && edges[next].low == edges[i].low && edges[next].high == edges[i].high;)
      next++;
    code = check_edge(soup, &edges[i], next - i, error);
  }
  free(edges);
  return code;
}

status mesh_closed_make(struct mesh_soup *soup, struct error *error) {
  TRY(merge_vertices(soup, error));
  status code = check_faces(soup, error);
  return code ? code : check_edges(soup, error);
}
