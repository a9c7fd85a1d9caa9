/* Reads results and masses as JSON, CSV and plain numbers. A program's files are not trusted: links, pipes and devices
 * are refused, sizes are bounded, and every number is checked. */
#include "engine/command/definition.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/grow.h"
#include "schemas/csv.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

struct masses {
  struct fragment *list;
  size_t count, capacity;
};

struct reading {
  const struct definition *d;
  const char *folder;
  double *values;
  struct masses masses;
  const char **not_finite;
  struct error *error;
};

/* A regular file of the folder. */
static status read_file(const struct reading *r, const char *name, char **text, size_t *size) {
  char path[LIMITS_PATH];
  struct stat about;
  const double most = r->d->settings.limits.output;
  *text = NULL;
  snprintf(path, sizeof path, "%s/%s", r->folder, name);
  const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0)
    return status_fail(r->error, STATUS_CONTENT, "the program wrote no file %.100s: %s", name, strerror(errno));
  if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode) || (double)about.st_size > most) {
    close(file);
    return status_fail(r->error, STATUS_CONTENT, "%.100s is no plain file of at most %.3g B (limits: output)", name,
                       most);
  }
  *size = 0;
  *text = malloc((size_t)about.st_size + 1);
  ssize_t n = 0;
  while (*text && *size < (size_t)about.st_size && (n = read(file, *text + *size, (size_t)about.st_size - *size)) > 0)
    *size += (size_t)n;
  close(file);
  if (!*text)
    return status_fail(r->error, STATUS_MEMORY, "no memory for %.100s", name);
  (*text)[*size] = '\0';
  return STATUS_OK;
}

/* A number in `unit` as SI. NaN and infinity are numbers here. False: it is none. */
static bool number_of(const char *text, const char *unit, double *si) {
  char *end = NULL, with_unit[FIELD_TEXT_SIZE + 80];
  const double x = text && *text ? strtod(text, &end) : 0;
  if (!end || *end || strchr(text, 'x') || strchr(text, 'X'))
    return false;
  *si = x;
  if (!isfinite(x) || !*unit)
    return true;
  snprintf(with_unit, sizeof with_unit, "%.70s %s", text, unit);
  return unit_read(with_unit, unit, si, NULL) == STATUS_OK;
}

/* "line 3" of `name`; line 0: none. */
static status no_number(const struct reading *r, const char *file, long long line, const char *what, const char *text) {
  char place[40] = "";
  if (line)
    snprintf(place, sizeof place, ", line %lld", line);
  return status_fail(r->error, STATUS_CONTENT, "%.100s%s: expected a number for %.60s, got '%.60s'", file, place, what,
                     text ? text : "");
}

static status take_result(struct reading *r, size_t i, const char *file, long long line, const char *text) {
  const struct definition_result *result = &r->d->result[i];
  const char *unit = *result->written_in ? result->written_in : result->unit;
  const char *path = r->d->result_rows[i].path;
  const bool si = strcmp(unit, "1") == 0;
  if (text && (strcmp(text, "null") == 0 || strcmp(text, "off") == 0))
    return STATUS_OK; /* it does not apply */
  if (!number_of(text, si ? "" : unit, &r->values[i]))
    return no_number(r, file, line, path, text);
  if (!isfinite(r->values[i]) && !**r->not_finite)
    *r->not_finite = path;
  return STATUS_OK;
}

static status take_mass(struct reading *r, const char *file, long long line, const char *text) {
  struct masses *m = &r->masses;
  double mass = 0;
  if (!number_of(text, r->d->settings.fragments.unit, &mass))
    return no_number(r, file, line, "a mass", text);
  if (mass <= 0)
    return status_fail(r->error, STATUS_CONTENT, "%.100s: a fragment has the mass %.60s, which is not above 0", file,
                       text);
  if (!isfinite(mass) && !**r->not_finite)
    *r->not_finite = "a fragment's mass";
  if (!grow_room(&m->list, &m->capacity, m->count + 1, sizeof *m->list) || m->count >= UINT32_MAX)
    return status_fail(r->error, STATUS_MEMORY, "no memory for the fragments");
  m->list[m->count] = (struct fragment){.mass = mass, .first = (uint32_t)m->count};
  m->count++;
  return STATUS_OK;
}

/* ---- JSON ---- */

/* The node at a path "a.b". NULL: there is none. */
static document_node *at_path(document_node *node, const char *path) {
  while (node && *path) {
    char word[FIELD_TEXT_SIZE];
    snprintf(word, sizeof word, "%.*s", (int)strcspn(path, "."), path);
    node = document_kind(node) == DOCUMENT_MAPPING ? document_key(node, word) : NULL;
    path += strcspn(path, ".");
    path += *path == '.';
  }
  return node;
}

static status no_key(struct reading *r, size_t i, const char *file, document_node *root) {
  char there[256] = "";
  for (size_t k = 0; k < document_count(root); k++) {
    const char *name = NULL;
    document_item(root, k, &name);
    text_append(there, sizeof there, "%s%.60s", k ? ", " : "", name);
  }
  text_make_plain(there, "");
  return status_fail(r->error, STATUS_CONTENT, "%.100s has no key `%.100s` for the result %.60s; its keys: %s", file,
                     r->d->result[i].name, r->d->result_rows[i].path, there);
}

static status json_results(struct reading *r, const char *file, document_node *root) {
  document_node *trouble = document_key(root, "error");
  const char *words = trouble ? document_scalar(trouble) : NULL;
  if (trouble && !(words && (!*words || strcmp(words, "null") == 0 || strcmp(words, "false") == 0)))
    return status_fail(r->error, STATUS_CONTENT, "%.100s has the key `error`: %.300s", file, words ? words : "");
  for (size_t i = 0; i < r->d->result_count; i++) {
    document_node *node = at_path(root, r->d->result[i].name);
    if (!node)
      return no_key(r, i, file, root);
    TRY(take_result(r, i, file, 0, document_scalar(node)));
  }
  return STATUS_OK;
}

static status json_masses(struct reading *r, const char *file, document_node *root) {
  const char *name = r->d->settings.fragments.name;
  document_node *list = at_path(root, name);
  if (!list || document_kind(list) != DOCUMENT_SEQUENCE)
    return status_fail(r->error, STATUS_CONTENT, "%.100s has no list `%.100s` of fragment masses", file, name);
  for (size_t i = 0; i < document_count(list); i++)
    TRY(take_mass(r, file, 0, document_scalar(document_item(list, i, NULL))));
  return STATUS_OK;
}

static status read_json(struct reading *r, const char *file, const char *text, size_t size, bool results, bool masses) {
  DOCUMENT document = NULL;
  struct error why;
  char begins[40];
  const char *from = text + strspn(text, " \t\r\n");
  const status parsed = document_parse(file, text, size, &document, &why);
  if (!*from)
    return status_fail(r->error, STATUS_CONTENT, "%.100s is empty: expected JSON", file);
  if (parsed == STATUS_CONTENT && *from != '{') { /* the reader of YAML expects other words */
    snprintf(begins, sizeof begins, "%.*s", (int)strcspn(from, "\n"), from);
    text_make_plain(begins, "");
    return status_fail(r->error, parsed, "%.100s is no JSON: it begins with '%s', not with {", file, begins);
  }
  if (parsed)
    return status_fail(r->error, parsed, "%.100s is no JSON: %.500s", file, why.message);
  TRY(document_verdict(document, r->error)); /* a name that is given twice */
  document_node *root = document_root(document);
  if (results)
    TRY(json_results(r, file, root));
  return masses ? json_masses(r, file, root) : STATUS_OK;
}

/* ---- CSV: results in the last record, masses in all ---- */

static status find_column(const struct reading *r, const struct csv *csv, const char *file, const char *name,
                          size_t *column) {
  bool found = false;
  for (size_t i = 0; i < csv->count; i++) {
    if (strcmp(csv->cells[i].text, name) != 0)
      continue;
    if (found)
      return status_fail(r->error, STATUS_CONTENT, "%.100s has two columns `%.100s`", file, name);
    found = true;
    *column = i;
  }
  if (found)
    return STATUS_OK;
  return status_fail(r->error, STATUS_CONTENT, "%.100s has no column `%.100s`; its first line must name the columns",
                     file, name);
}

static status csv_records(struct reading *r, struct csv *csv, const char *file, bool results, bool masses) {
  size_t column[DEFINITION_ROWS + 1] = {0};
  bool named = false, any = false;
  for (enum csv_item item; (item = csv_next(csv)) != CSV_END;) {
    if (item == CSV_WRONG)
      return status_fail(r->error, STATUS_CONTENT, "%.100s, line %lld: %s", file, (long long)csv->line, csv->wrong);
    if (item == CSV_NAMES) {
      named = true;
      for (size_t i = 0; results && i < r->d->result_count; i++)
        TRY(find_column(r, csv, file, r->d->result[i].name, &column[i]));
      if (masses)
        TRY(find_column(r, csv, file, r->d->settings.fragments.name, &column[DEFINITION_ROWS]));
    }
    if (item != CSV_RECORD)
      continue;
    any = true;
    for (size_t i = 0; results && i < r->d->result_count; i++) {
      r->values[i] = NAN;
      TRY(take_result(r, i, file, (long long)csv->line, csv->cells[column[i]].text));
    }
    if (masses)
      TRY(take_mass(r, file, (long long)csv->line, csv->cells[column[DEFINITION_ROWS]].text));
  }
  return !named || (results && !any)
             ? status_fail(r->error, STATUS_CONTENT, "%.100s has no %s", file, named ? "values" : "columns")
             : STATUS_OK;
}

static status read_csv(struct reading *r, const char *file, const char *text, size_t size, bool results, bool masses) {
  OWNED struct csv *csv = memory_small(1, sizeof *csv);
  struct error why;
  status code = csv_text(csv, file, text, size, &why);
  if (code)
    return status_fail(r->error, code, "%.500s", why.message);
  code = csv_records(r, csv, file, results, masses);
  csv_close(csv);
  return code;
}

/* ---- all of it ---- */

static status read_numbers(struct reading *r, const char *file, char *text) {
  long long line = 1;
  for (char *at = text; *at;) {
    line += *at == '\n';
    const size_t length = strcspn(at, " \t\r\n");
    char next = at[length];
    if (length == 0) {
      at++;
      continue;
    }
    at[length] = '\0';
    TRY(take_mass(r, file, line, at));
    at[length] = next;
    at += length;
  }
  return STATUS_OK;
}

static status read_one(struct reading *r, const char *file, bool results, bool masses) {
  OWNED char *text = NULL;
  size_t size = 0;
  TRY(read_file(r, file, &text, &size));
  if (text_ends_in(file, ".csv"))
    return read_csv(r, file, text, size, results, masses);
  if (!results && !text_ends_in(file, ".json") && strcmp(file, "stdout") != 0)
    return read_numbers(r, file, text);
  return read_json(r, file, text, size, results, masses);
}

static int by_mass(const void *a, const void *b) {
  const struct fragment *x = a, *y = b;
  return x->mass != y->mass ? (x->mass < y->mass ? 1 : -1) : (x->first > y->first) - (x->first < y->first);
}

status output_read(const struct definition *d, const char *folder, double *values, struct fragment **fragments,
                   size_t *count, const char **not_finite, struct error *error) {
  struct reading r = {.d = d, .folder = folder, .values = values, .not_finite = not_finite, .error = error};
  const char *output = d->settings.output, *file = d->settings.fragments.file;
  const bool masses = *file || d->settings.fragments.name[0], together = !*file || strcmp(file, output) == 0;
  status code = STATUS_OK;
  *not_finite = "";
  if (d->result_count > 0 || together)
    code = read_one(&r, output, true, masses && together);
  if (code == STATUS_OK && masses && !together)
    code = read_one(&r, file, false, true);
  *fragments = r.masses.list;
  *count = r.masses.count;
  double element = d->settings.fragments.element_mass;
  if (*count > 0)
    qsort(*fragments, *count, sizeof **fragments, by_mass);
  if (*count > 0 && field_is_off(element))
    element = (*fragments)[*count - 1].mass;
  for (size_t i = 0; i < *count; i++)
    (*fragments)[i].count = (uint32_t)fmin(fmax(round((*fragments)[i].mass / element), 1), UINT32_MAX);
  return code;
}

void output_last_words(const char *folder, const char *name, char *words, size_t size) {
  char path[LIMITS_PATH];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  words[0] = '\0';
  const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  const off_t length = file < 0 ? 0 : lseek(file, 0, SEEK_END);
  const off_t from = length > (off_t)size - 1 ? length - (off_t)size + 1 : 0;
  const ssize_t n = length > 0 ? pread(file, words, size - 1, from) : 0;
  if (file >= 0)
    close(file);
  words[n > 0 ? n : 0] = '\0';
  text_make_plain(words, "");
  for (size_t end = strlen(words); end > 0 && words[end - 1] == ' '; end--)
    words[end - 1] = '\0';
}
