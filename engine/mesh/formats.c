/* The formats of shape files: OBJ (its vertices and polygons), and STL as text and in binary. What a face looks like in
 * the file does not matter afterwards. Normals in the file are not read: the order of the corners decides. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "engine/mesh/build.h"
#include "schemas/text.h"

static const char blanks[] = " \t\r\v\f";

/* Reads a number and moves *at behind it. False: there is none. */
static bool number(const char **at, double *value) {
  char *end;
  *value = strtod(*at, &end);
  if (end == *at || (*end && !strchr(" \t\r\v\f\n", *end)))
    return false;
  *at = end;
  return true;
}

/* ---- OBJ ---- */

/* A corner, such as 7, 7/1, 7//3 or -1 (the last vertex so far). */
static status read_corner(const struct mesh_soup *soup, size_t line, const char **at, uint32_t *corner,
                          struct error *error) {
  char *end;
  const long long there = (long long)soup->vertices;
  long long index = strtoll(*at, &end, 10);
  if (end == *at || (*end && !strchr(" \t\r\v\f\n/", *end)))
    return mesh_refuse(soup, line, error, "expected a face as numbers of vertices, got \"%.20s\"", *at);
  if (index < 0 && index >= -there)
    index += there + 1;
  if (index < 1 || index > there)
    return mesh_refuse(soup, line, error, "the face has vertex %lld, and %lld are given above it", index, there);
  *corner = (uint32_t)(index - 1);
  *at = end + strcspn(end, " \t\r\v\f\n");
  return STATUS_OK;
}

/* A polygon is cut into triangles from its first corner on. */
static status read_polygon(struct mesh_soup *soup, size_t line, const char *at, struct error *error) {
  uint32_t corner[3];
  size_t count = 0;
  for (;;) {
    at += strspn(at, blanks);
    if (!*at || *at == '\n' || *at == '#')
      break;
    uint32_t next = 0;
    TRY(read_corner(soup, line, &at, &next, error));
    if (count < 2) {
      corner[count++] = next;
      continue;
    }
    corner[2] = next;
    TRY(mesh_soup_face(soup, line, corner, error));
    corner[1] = next;
    count++;
  }
  return count < 3 ? mesh_refuse(soup, line, error, "a face has %zu corners: it needs three", count) : STATUS_OK;
}

/* One line, whose first word begins at `at`. */
static status read_obj_line(struct mesh_soup *soup, size_t line, const char *at, struct error *error) {
  static const char *const ignored[] = {"", "vt", "vn", "vp", "o", "g", "s", "l", "p", "usemtl", "mtllib", NULL};
  const size_t length = strcspn(at, " \t\r\v\f\n");
  char word[8] = "";
  double place[3];
  if (length < sizeof word)
    memcpy(word, at, length);
  if (strcmp(word, "v") == 0) {
    at++;
    if (!number(&at, &place[0]) || !number(&at, &place[1]) || !number(&at, &place[2]))
      return mesh_refuse(soup, line, error, "expected three numbers behind v");
    return mesh_soup_vertex(soup, line, place, error);
  }
  if (strcmp(word, "f") == 0)
    return read_polygon(soup, line, at + 1, error);
  const bool fits = length < sizeof word;
  if (*at == '#' || (fits && text_is_one_of(word, ignored)))
    return STATUS_OK;
  return mesh_refuse(soup, line, error, "\"%.*s\" begins no line of an OBJ file, and no STL file begins so",
                     (int)(length < 20 ? length : 20), at);
}

/* The end of the line at `at`. A backslash at its end joins the next line to it: backslash and line end become blanks,
 * and *lines counts the lines that were joined. A comment ends with its line (it may name a Windows folder). */
static char *end_of_line(char *at, size_t *lines) {
  for (;;) {
    char *end = at + strcspn(at, "\n"), *last = end;
    while (last > at && strchr(blanks, last[-1]))
      last--;
    if (!*end || last == at || last[-1] != '\\' || memchr(at, '#', (size_t)(end - at)))
      return end;
    memset(last - 1, ' ', (size_t)(end - last) + 2);
    ++*lines;
    at = end + 1;
  }
}

static status read_obj(struct mesh_soup *soup, char *text, struct error *error) {
  size_t line = 1, lines;
  for (char *at = text; *at; line += lines) {
    lines = 1;
    const char *end = end_of_line(at, &lines);
    TRY(read_obj_line(soup, line, at + strspn(at, blanks), error));
    at += end - at + (*end != 0);
  }
  return STATUS_OK;
}

/* ---- STL as text ---- */

struct words {
  const char *at;
  size_t line;
};

static void skip_blanks(struct words *w) {
  for (; *w->at && strchr(" \t\r\v\f\n", *w->at); w->at++)
    w->line += *w->at == '\n';
}

/* Takes the word if it comes next. */
static bool take(struct words *w, const char *word) {
  skip_blanks(w);
  const size_t length = strlen(word);
  if (strncasecmp(w->at, word, length) != 0 || (w->at[length] && !strchr(" \t\r\v\f\n", w->at[length])))
    return false;
  w->at += length;
  return true;
}

static bool take_numbers(struct words *w, double out[3]) {
  for (int k = 0; k < 3; k++) {
    skip_blanks(w);
    if (!number(&w->at, &out[k]))
      return false;
  }
  return true;
}

static status expected(const struct mesh_soup *soup, struct words *w, const char *what, struct error *error) {
  skip_blanks(w);
  if (!*w->at)
    return mesh_refuse(soup, w->line, error, "the file ends where %s is expected: it was cut short", what);
  return mesh_refuse(soup, w->line, error, "expected %s, got \"%.*s\"", what, (int)strcspn(w->at, "\r\n") % 20, w->at);
}

static status read_facet(struct mesh_soup *soup, struct words *w, struct error *error) {
  double place[3];
  uint32_t corner[3];
  skip_blanks(w);
  const size_t line = w->line;
  if (!take(w, "facet") || !take(w, "normal") || !take_numbers(w, place))
    return expected(soup, w, "\"facet normal\" and three numbers", error);
  if (!take(w, "outer") || !take(w, "loop"))
    return expected(soup, w, "\"outer loop\"", error);
  for (int c = 0; c < 3; c++) {
    if (!take(w, "vertex") || !take_numbers(w, place))
      return expected(soup, w, "\"vertex\" and three numbers", error);
    corner[c] = (uint32_t)soup->vertices;
    TRY(mesh_soup_vertex(soup, w->line, place, error));
  }
  if (!take(w, "endloop") || !take(w, "endfacet"))
    return expected(soup, w, "\"endloop\" and \"endfacet\"", error);
  return mesh_soup_face(soup, line, corner, error);
}

static status read_stl_text(struct mesh_soup *soup, const char *text, struct error *error) {
  struct words w = {text, 1};
  while (take(&w, "solid")) {
    w.at += strcspn(w.at, "\n"); /* its name */
    while (!take(&w, "endsolid")) {
      TRY(read_facet(soup, &w, error));
    }
    w.at += strcspn(w.at, "\n");
  }
  skip_blanks(&w);
  return *w.at ? expected(soup, &w, "\"solid\" or the end", error) : STATUS_OK;
}

/* ---- STL in binary: 80 bytes, the number of faces, 50 bytes per face, little-endian ---- */

enum { HEAD = 84, EACH = 50 };

static uint32_t word_at(const char *bytes) {
  const unsigned char *b = (const unsigned char *)bytes;
  return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double float_at(const char *bytes) {
  const uint32_t bits = word_at(bytes);
  float value;
  memcpy(&value, &bits, sizeof value);
  return (double)value;
}

static status read_stl_binary(struct mesh_soup *soup, const char *bytes, size_t size, struct error *error) {
  soup->numbered = true;
  const uint64_t count = size >= HEAD ? word_at(bytes + 80) : 0, wanted = HEAD + EACH * count;
  if (size < wanted)
    return mesh_refuse(soup, 0, error,
                       "a binary STL file of %llu faces has %llu bytes, and this one has %zu: it was cut short or "
                       "damaged",
                       (unsigned long long)count, (unsigned long long)wanted, size);
  soup->tail = size - (size_t)wanted;
  for (size_t f = 0; f < count; f++) {
    uint32_t corner[3];
    for (size_t c = 0; c < 3; c++) {
      const char *at = bytes + HEAD + EACH * f + 12 * (c + 1);
      corner[c] = (uint32_t)soup->vertices;
      TRY(mesh_soup_vertex(soup, f + 1, (double[3]){float_at(at), float_at(at + 4), float_at(at + 8)}, error));
    }
    TRY(mesh_soup_face(soup, f + 1, corner, error));
  }
  return STATUS_OK;
}

/* A binary file has a NUL in the number of its faces, as files of more than 2^24 faces are refused; a text has none. */
status mesh_formats_read(struct mesh_soup *soup, char *text, size_t size, struct error *error) {
  struct words w = {text, 1};
  if (strlen(text) < size)
    TRY(read_stl_binary(soup, text, size, error));
  else if (take(&w, "solid"))
    TRY(read_stl_text(soup, text, error));
  else
    TRY(read_obj(soup, text, error));
  return soup->faces ? STATUS_OK : mesh_refuse(soup, 0, error, "the file has no faces: expected an STL or OBJ file");
}
