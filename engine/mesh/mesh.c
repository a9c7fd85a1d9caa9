/* Makes a mesh from its file, with all checks in order. Volume, centre of mass, extent, the point where a line leaves
 * the mesh, and the list of files that were read. */

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "engine/fragments.h"
#include "engine/grow.h"
#include "engine/mesh/build.h"
#include "engine/vector3.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/text.h"

/* Least share of its box that a body fills (drawing points from a smaller one takes too long); largest coordinate, in
 * units of the file. */
static const double least_share = 1e-3, largest_coordinate = 1e15;

status mesh_refuse(const struct mesh_soup *soup, size_t line, struct error *error, const char *format, ...) {
  char text[512], place[64] = "";
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (line && soup->numbered)
    snprintf(place, sizeof place, " face %zu:", line);
  else if (line)
    snprintf(place, sizeof place, "%zu:", line);
  return status_fail(error, STATUS_CONTENT, "%.3000s:%s %s", soup->name, place, text);
}

static status no_memory(const char *name, struct error *error) {
  return status_fail(error, STATUS_MEMORY, "no memory for the shape file %.3000s", name);
}

status mesh_soup_vertex(struct mesh_soup *soup, size_t line, const double place[3], struct error *error) {
  for (int k = 0; k < 3; k++)
    if (!(fabs(place[k]) <= largest_coordinate))
      return mesh_refuse(soup, line, error, "the coordinate %g is not finite, or above %g: mend the file", place[k],
                         largest_coordinate);
  if (soup->vertices >= 3 * (size_t)MESH_MOST_FACES)
    return mesh_refuse(soup, line, error, "more than %d vertices: take a coarser model", 3 * MESH_MOST_FACES);
  if (!grow_room(&soup->vertex, &soup->vertex_room, soup->vertices + 1, sizeof *soup->vertex))
    return no_memory(soup->name, error);
  for (int k = 0; k < 3; k++)
    soup->vertex[soup->vertices][k] = place[k] + 0.0; /* -0 becomes 0 */
  soup->vertices++;
  return STATUS_OK;
}

status mesh_soup_face(struct mesh_soup *soup, size_t line, const uint32_t corners[3], struct error *error) {
  if (soup->faces >= MESH_MOST_FACES)
    return mesh_refuse(soup, line, error, "more than %d triangles: take a coarser model", MESH_MOST_FACES);
  size_t lines = soup->face_room;
  if (!grow_room(&soup->line, &lines, soup->faces + 1, sizeof *soup->line) ||
      !grow_room(&soup->face, &soup->face_room, soup->faces + 1, sizeof *soup->face))
    return no_memory(soup->name, error);
  memcpy(soup->face[soup->faces], corners, sizeof *soup->face);
  soup->line[soup->faces++] = (uint32_t)line;
  return STATUS_OK;
}

/* ---- from the faces of a file to a closed surface ---- */

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
  OWNED struct place *places = malloc((soup->vertices + 1) * sizeof *places);
  OWNED uint32_t *same = malloc((soup->vertices + 1) * sizeof *same);
  if (!places || !same)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu vertices", soup->vertices);
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
  return STATUS_OK;
}

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
  OWNED struct edge *edges = malloc(count * sizeof *edges);
  if (!edges)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu edges", count);
  for (size_t f = 0; f < soup->faces; f++)
    for (size_t c = 0; c < 3; c++) {
      const uint32_t from = soup->face[f][c], to = soup->face[f][(c + 1) % 3];
      edges[3 * f + c] = from < to ? (struct edge){from, to, (uint32_t)f, true}
                                   : (struct edge){to, from, (uint32_t)f, false};
    }
  qsort(edges, count, sizeof *edges, compare_edges);
  for (size_t i = 0, next; i < count; i = next) {
    for (next = i + 1; next < count && edges[next].low == edges[i].low && edges[next].high == edges[i].high;)
      next++;
    TRY(check_edge(soup, &edges[i], next - i, error));
  }
  return STATUS_OK;
}

/* ---- measures ---- */

static void find_box(struct mesh *m) {
  for (int k = 0; k < 3; k++) {
    m->low[k] = INFINITY;
    m->high[k] = -INFINITY;
  }
  for (size_t f = 0; f < m->faces; f++) /* vertices without a face do not count */
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) {
        m->low[k] = fmin(m->low[k], m->vertex[m->face[f][c]][k]);
        m->high[k] = fmax(m->high[k], m->vertex[m->face[f][c]][k]);
      }
}

static void shift(struct mesh *m, const double by[3]) {
  for (size_t v = 0; v < m->vertices; v++)
    vector3_subtract(m->vertex[v], by, m->vertex[v]);
  vector3_subtract(m->low, by, m->low);
  vector3_subtract(m->high, by, m->high);
  for (int k = 0; k < 3; k++)
    m->centre[k] += by[k];
}

/* Normal to a face, outwards; its length is twice the face's area. */
static void area_vector(const struct mesh *m, const uint32_t corner[3], double n[3]) {
  double ab[3], ac[3];
  vector3_subtract(m->vertex[corner[1]], m->vertex[corner[0]], ab);
  vector3_subtract(m->vertex[corner[2]], m->vertex[corner[0]], ac);
  vector3_cross(ab, ac, n);
}

/* Volume, area and centre of mass, of the tetrahedra between the faces and the origin. A surface that is inside out is
 * turned. */
static void measure(struct mesh *m) {
  double moment[3] = {0};
  for (size_t f = 0; f < m->faces; f++) {
    const double *a = m->vertex[m->face[f][0]], *b = m->vertex[m->face[f][1]], *c = m->vertex[m->face[f][2]];
    double n[3], d[3];
    area_vector(m, m->face[f], n);
    vector3_cross(b, c, d);
    const double six = vector3_dot(a, d);
    m->volume += six / 6;
    m->area += 0.5 * sqrt(vector3_dot(n, n));
    for (int k = 0; k < 3; k++)
      moment[k] += six / 24 * (a[k] + b[k] + c[k]);
  }
  for (int k = 0; k < 3; k++)
    moment[k] /= m->volume;
  if (m->volume < 0)
    for (size_t f = 0; f < m->faces; f++) {
      const uint32_t first = m->face[f][0];
      m->face[f][0] = m->face[f][1];
      m->face[f][1] = first;
    }
  m->volume = fabs(m->volume);
  bool within = true; /* rounding only, else */
  for (int k = 0; k < 3; k++)
    within = within && moment[k] >= m->low[k] && moment[k] <= m->high[k];
  if (within)
    shift(m, moment);
}

/* Parts of the solid: surfaces of joined faces that enclose a volume. A cavity encloses a negative one. */
static status count_parts(struct mesh *m, const char *name, struct error *error) {
  OWNED uint32_t *parent = malloc(m->vertices * sizeof *parent);
  OWNED double *volume = calloc(m->vertices, sizeof *volume); /* by the surface's lowest vertex */
  if (!parent || !volume)
    return no_memory(name, error);
  for (size_t v = 0; v < m->vertices; v++)
    parent[v] = (uint32_t)v;
  for (size_t f = 0; f < m->faces; f++)
    for (int corner = 1; corner < 3; corner++)
      fragments_join(parent, m->face[f][0], m->face[f][corner]);
  for (size_t f = 0; f < m->faces; f++) {
    const uint32_t surface = fragments_root(parent, m->face[f][0]);
    double b[3], c[3], d[3]; /* from a point of the surface: no volume of other places adds its rounding */
    vector3_subtract(m->vertex[m->face[f][1]], m->vertex[surface], b);
    vector3_subtract(m->vertex[m->face[f][2]], m->vertex[surface], c);
    vector3_cross(b, c, d);
    volume[surface] += vector3_dot(m->vertex[m->face[f][0]], d) - vector3_dot(m->vertex[surface], d);
  }
  for (size_t v = 0; v < m->vertices; v++)
    m->parts += volume[v] > 0;
  return STATUS_OK;
}

static status check_size(const struct mesh *m, const struct mesh_soup *soup, struct error *error) {
  double box = 1;
  for (int k = 0; k < 3; k++)
    box *= m->high[k] - m->low[k];
  if (!(m->volume > 0) || !isnormal(m->volume) || !isfinite(box))
    return mesh_refuse(soup, 0, error, "the surface encloses a volume of %g: it must enclose a body", m->volume);
  if (!(m->volume > least_share * box))
    return mesh_refuse(soup, 0, error,
                       "the body fills only %.2g of the box around it, and %g is the least: turn it along the axes, or "
                       "take a thicker one",
                       m->volume / box, least_share);
  return STATUS_OK;
}

/* Merges equal vertices, checks that every edge has two faces that turn opposite ways and every face an area, and takes
 * vertices and faces from the soup. */
static status build(struct mesh *m, struct mesh_soup *soup, struct error *error) {
  TRY(merge_vertices(soup, error));
  TRY(check_faces(soup, error));
  TRY(check_edges(soup, error));
  m->vertices = soup->vertices;
  m->faces = soup->faces;
  m->tail = soup->tail;
  m->vertex = soup->vertex;
  m->face = soup->face;
  soup->vertex = NULL;
  soup->face = NULL;
  find_box(m);
  double middle[3];
  for (int k = 0; k < 3; k++)
    middle[k] = 0.5 * (m->low[k] + m->high[k]);
  shift(m, middle); /* far from the origin volumes would cancel */
  measure(m);
  TRY(check_size(m, soup, error));
  TRY(count_parts(m, soup->name, error));
  return mesh_search_make(m, soup, error);
}

status mesh_read(const char *name, const void *bytes, size_t size, struct mesh **out, struct error *error) {
  *out = NULL;
  struct mesh_soup soup = {.name = name};
  if (size > MESH_MOST_BYTES)
    return mesh_refuse(&soup, 0, error, "the file has %zu MB, and %d MB is the most: take a coarser model", size >> 20,
                       MESH_MOST_BYTES >> 20);
  OWNED char *text = malloc(size + 1);
  if (!text)
    return no_memory(name, error);
  if (size)
    memcpy(text, bytes, size);
  text[size] = 0;
  struct mesh *mesh = memory_small(1, sizeof *mesh);
  status code = mesh_formats_read(&soup, text, size, error);
  if (!code)
    code = build(mesh, &soup, error);
  free(soup.vertex);
  free(soup.face);
  free(soup.line);
  if (code)
    mesh_free(mesh);
  else
    *out = mesh;
  return code;
}

void mesh_free(struct mesh *mesh) {
  if (!mesh)
    return;
  mesh_search_free(mesh);
  free(mesh->vertex);
  free(mesh->face);
  free(mesh);
}

void mesh_normal(const struct mesh *m, uint32_t face, double n[3]) {
  area_vector(m, m->face[face], n);
  const double length = sqrt(vector3_dot(n, n));
  for (int k = 0; k < 3; k++)
    n[k] /= length;
}

double mesh_reach(const struct mesh *m, const double direction[3]) {
  double reach = -INFINITY;
  for (size_t f = 0; f < m->faces; f++)
    for (int c = 0; c < 3; c++)
      reach = fmax(reach, vector3_dot(m->vertex[m->face[f][c]], direction));
  return reach;
}

/* ---- shape files that were read ---- */

struct entry {
  struct entry *next;
  struct mesh_file file;
};

static struct entry *entries; /* entries are only added at the head: pointers to files stay valid */

const struct mesh_file *mesh_files_find(const char *hash) {
  for (const struct entry *e = entries; e; e = e->next)
    if (strcmp(e->file.hash, hash) == 0)
      return &e->file;
  return NULL;
}

/* Takes ownership of the bytes. */
static status add(const char *name, unsigned char *bytes, size_t size, const struct mesh_file **out,
                  struct error *error) {
  char hash[MESH_HASH_SIZE];
  text_sha256(bytes, size, hash);
  *out = mesh_files_find(hash);
  if (*out) {
    free(bytes);
    return STATUS_OK;
  }
  struct entry *entry = memory_small(1, sizeof *entry);
  const status code = mesh_read(name, bytes, size, &entry->file.mesh, error);
  if (code) {
    free(entry);
    free(bytes);
    return code;
  }
  memcpy(entry->file.hash, hash, sizeof hash);
  entry->file.bytes = bytes;
  entry->file.size = size;
  entry->next = entries;
  entries = entry;
  *out = &entry->file;
  return STATUS_OK;
}

status mesh_files_add(const char *name, const void *bytes, size_t size, const struct mesh_file **out,
                      struct error *error) {
  unsigned char *copy = malloc(size + 1);
  if (!copy)
    return no_memory(name, error);
  if (size)
    memcpy(copy, bytes, size);
  return add(name, copy, size, out, error);
}

/* A device or a pipe may never end, and a large file is not read at all. */
static status look(const char *path, struct error *error) {
  struct stat about;
  if (stat(path, &about) != 0)
    return STATUS_OK; /* opening it reports the reason */
  if (!S_ISREG(about.st_mode))
    return status_fail(error, STATUS_IO, "%.3000s: is no regular file: name a shape file (STL or OBJ)", path);
  if (about.st_size > MESH_MOST_BYTES)
    return status_fail(error, STATUS_CONTENT,
                       "%.3000s: the file has %lld MB, and %d MB is the most: take a coarser model", path,
                       (long long)(about.st_size >> 20), MESH_MOST_BYTES >> 20);
  return STATUS_OK;
}

status mesh_files_open(const char *name, const char *folder, const struct mesh_file **out, struct error *error) {
  OWNED char *path = file_name_in(folder, name);
  unsigned char *bytes = NULL;
  size_t size = 0;
  *out = NULL;
  if (!path)
    return status_fail(error, STATUS_MEMORY, "no memory for the name of a file");
  TRY(look(path, error));
  TRY(file_input(path, error));
  TRY(file_read(path, "shape file", &bytes, &size, error));
  return add(path, bytes, size, out, error);
}
