/* Documents: opening, closing, walking through the tree, and changing it. */

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "schemas/document_tree.h"
#include "schemas/file.h"
#include "schemas/memory.h"

/* A document that holds a copy of the text; NULL without memory. */
static struct document *create(const char *name, const char *text, size_t size) {
  struct document *document = calloc(1, sizeof *document);
  if (!document)
    return NULL;
  document->name = memory_small_text(name);
  document->text = malloc(size + 1);
  document->size = size;
  if (!document->text) {
    document_free(document);
    return NULL;
  }
  memcpy(document->text, text, size);
  document->text[size] = 0;
  return document;
}

status document_parse(const char *name, const char *text, size_t size, struct document **out, struct error *error) {
  *out = NULL;
  if (size > DOCUMENT_LARGEST)
    return status_fail(error, STATUS_CONTENT, "%s: error: larger than %d MiB; no input of clast is that large", name,
                       DOCUMENT_LARGEST >> 20);
  if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) { /* byte order mark */
    text += 3;
    size -= 3;
  }
  struct document *document = create(name, text, size);
  if (!document)
    return status_fail(error, STATUS_MEMORY, "%s: no memory for %zu bytes", name, size);
  const status code = document_build(document);
  if (code == STATUS_OK) {
    *out = document;
    return STATUS_OK;
  }

  const char *report = NULL;
  if (code == STATUS_CONTENT)
    document_finish(document, &report);
  status_fail(error, code, "%s", report ? report : "no memory to read a document");
  document_free(document);
  return code;
}

/* Reads at most one byte more than the size limit of a document. */
static status read_text(int file, const char *path, char *text, size_t *size, struct error *error) {
  for (*size = 0; *size <= DOCUMENT_LARGEST;) {
    const ssize_t got = read(file, text + *size, DOCUMENT_LARGEST + 1 - *size);
    if (got == 0)
      break;
    if (got > 0)
      *size += (size_t)got;
    else if (errno != EINTR)
      return status_fail(error, STATUS_IO, "%s: cannot be read: %s", path, strerror(errno));
  }
  return STATUS_OK;
}

static status open_file(const char *path, int *file, struct error *error) {
  struct stat facts;
  *file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (*file < 0 && (errno == ENOENT || errno == ENOTDIR))
    return status_fail(error, STATUS_MISSING, "%s: there is no such file", path);
  if (*file < 0)
    return status_fail(error, STATUS_IO, "%s: cannot be opened: %s", path, strerror(errno));
  if (fstat(*file, &facts) != 0 || !S_ISDIR(facts.st_mode))
    return STATUS_OK;
  close(*file);
  return status_fail(error, STATUS_IO, "%s: is a folder; name a file in it", path);
}

status document_open(const char *path, struct document **out, struct error *error) {
  *out = NULL;
  int file;
  size_t size = 0;
  TRY(file_input(path, error));
  TRY(open_file(path, &file, error));
  char *text = malloc(DOCUMENT_LARGEST + 2);
  status code = text ? read_text(file, path, text, &size, error)
                     : status_fail(error, STATUS_MEMORY, "%s: no memory to read it", path);
  if (!code)
    code = document_parse(path, text, size, out, error);
  free(text);
  close(file);
  return code;
}

void document_free(struct document *document) {
  if (!document)
    return;
  for (document_node *node = document->nodes, *next; node; node = next) {
    next = node->next;
    free(node->pairs);
    free(node);
  }
  for (size_t i = 0; i < document->error_count && i < DOCUMENT_MOST_ERRORS; i++)
    free(document->errors[i].message);
  free(document->name);
  free(document->origin);
  for (struct document *other = document->included, *next; other; other = next) {
    next = other->next_included;
    document_free(other);
  }
  free(document->text);
  free(document->report);
  free(document);
}

/* A document, then its included ones. */
static const struct document *after(const struct document *document, const struct document *other) {
  return other == document ? document->included : other->next_included;
}

/* The reports of a document and of its included documents, one after the other. */
static char *whole_report(struct document *document) {
  char *text = NULL;
  FILE *out = text_open(&text);
  const char *between = "";
  for (struct document *other = document; other; other = (struct document *)after(document, other)) {
    if (!other->error_count)
      continue;
    OWNED char *report = document_report_text(other);
    fprintf(out, "%s%s", between, report);
    between = "\n";
  }
  return text_close_small(out, &text);
}

status document_finish(struct document *document, const char **report) {
  *report = NULL;
  const size_t errors = document->error_count + document->foreign_errors;
  if (errors == 0)
    return STATUS_OK;
  free(document->report);
  document->report = whole_report(document);
  *report = document->report;
  for (const struct document *other = document; other; other = after(document, other))
    if (other->no_memory)
      return STATUS_MEMORY;
  return document->elsewhere == errors ? STATUS_USAGE : STATUS_CONTENT;
}

status document_verdict(struct document *document, struct error *error) {
  const char *report;
  const status code = document_finish(document, &report);
  return code ? status_fail(error, code, "%s", report) : STATUS_OK;
}

void document_release(struct document **document) {
  document_free(*document);
}

void document_take_si(struct document *document) {
  document->si = true;
}

const char *document_text(const struct document *document) {
  return document->text;
}
document_node *document_root(struct document *document) {
  return document->root;
}
enum document_kind document_kind(const document_node *node) {
  return node->kind;
}
size_t document_count(const document_node *node) {
  return node->count;
}

const char *document_scalar(document_node *node) {
  return node->kind == DOCUMENT_SCALAR && !node->faulty ? node->text : NULL;
}

document_node *document_key(document_node *mapping, const char *key) {
  for (size_t i = 0; mapping->kind == DOCUMENT_MAPPING && i < mapping->count; i++) {
    struct document_pair *pair = &mapping->pairs[i];
    if (pair->key->faulty || strcmp(pair->key->text, key) != 0)
      continue;
    pair->seen = true;
    return pair->value;
  }
  return NULL;
}

document_node *document_item(document_node *node, size_t index, const char **key) {
  if (index >= node->count)
    return NULL;
  if (key)
    *key = node->pairs[index].key ? node->pairs[index].key->text : NULL;
  return node->pairs[index].value;
}

/* ---- nodes ---- */

document_node *document_node_make(struct document *document, enum document_kind kind, const char *text, size_t length) {
  document_node *node = calloc(1, sizeof *node + length + 1);
  if (!node)
    return NULL;
  node->document = document;
  node->kind = kind;
  if (length)
    memcpy(node->text, text, length);
  node->next = document->nodes;
  document->nodes = node;
  document->node_count++;
  return node;
}

bool document_node_append(document_node *to, document_node *key, document_node *value) {
  if (to->count == to->capacity) {
    const size_t capacity = to->capacity ? 2 * to->capacity : 4;
    struct document_pair *pairs = realloc(to->pairs, capacity * sizeof *pairs);
    if (!pairs)
      return false;
    to->pairs = pairs;
    to->capacity = capacity;
  }
  to->pairs[to->count++] = (struct document_pair){.key = key, .value = value};
  value->parent = to;
  value->key = key;
  return true;
}

struct document_pair *document_node_find(const document_node *mapping, const char *key) {
  for (size_t i = 0; i < mapping->count; i++)
    if (strcmp(mapping->pairs[i].key->text, key) == 0)
      return &mapping->pairs[i];
  return NULL;
}

/* ---- putting ---- */

/* A plain node that is not part of the text. Errors about it are about `place`; NULL: about the origin of values that
 * are put. NULL: no memory. */
static document_node *make_plain(struct document *document, enum document_kind kind, const char *text,
                                 const document_node *place) {
  document_node *node = document_node_make(document, kind, text, strlen(text));
  if (!node)
    return NULL;
  node->plain = true;
  node->put = !place;
  node->start = place ? place->start : 0;
  node->end = place ? place->end : 0;
  return node;
}

/* Sets mapping[key]; replaces an existing value. */
static bool set(document_node *mapping, const char *key, document_node *value) {
  document_node *name = make_plain(mapping->document, DOCUMENT_SCALAR, key, NULL);
  if (!name)
    return false;
  struct document_pair *pair = document_node_find(mapping, key);
  if (!pair)
    return document_node_append(mapping, name, value);
  pair->key = name;
  pair->value = value;
  value->parent = mapping;
  value->key = name;
  return true;
}

/* The value at a key of the document, or a new mapping if it is absent or null. The value may be no mapping. NULL: no
 * memory. */
static document_node *section_at(struct document *document, const char *key) {
  const struct document_pair *pair = document_node_find(document->root, key);
  if (pair && !document_value_is_null(pair->value)) /* "set:" without a value */
    return pair->value;
  document_node *section = make_plain(document, DOCUMENT_MAPPING, "", NULL);
  return section && set(document->root, key, section) ? section : NULL;
}

void document_drop(document_node *mapping, const char *const *keys) {
  size_t kept = 0;
  for (size_t i = 0; mapping && mapping->kind == DOCUMENT_MAPPING && i < mapping->count; i++)
    if (!text_is_one_of(mapping->pairs[i].key->text, keys))
      mapping->pairs[kept++] = mapping->pairs[i];
  if (mapping && mapping->kind == DOCUMENT_MAPPING)
    mapping->count = kept;
}

bool document_is_put(const document_node *node) {
  return node->put;
}

status document_change_put(struct document *document, const char *const keys[2], const char *value, const char *origin,
                           struct error *error) {
  if (!document->origin)
    document->origin = memory_small_text(origin);
  document_node *into = keys[1] ? section_at(document, keys[0]) : document->root;
  if (into && into->kind != DOCUMENT_MAPPING)
    return status_fail(error, STATUS_CONTENT, "%s: `%s` is no mapping, so it cannot hold `%.100s` of %s",
                       document->name, keys[0], keys[1], origin);
  document_node *scalar = make_plain(document, DOCUMENT_SCALAR, value, NULL);
  const char *key = keys[1] ? keys[1] : keys[0];
  if (!into || !scalar || !set(into, key, scalar))
    return status_fail(error, STATUS_MEMORY, "%s: no memory", document->name);
  document->changed = true;
  return STATUS_OK;
}

/* ---- writing ---- */

/* Plain text that means the same inside brackets: words, numbers with units. Other text is quoted. */
#define DIGITS  "0123456789"
#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
static bool stays_plain(const char *text) {
  const size_t length = strlen(text), sign = strspn(text, "-+.") == 1;
  const char *first = sign ? DIGITS : DIGITS LETTERS;
  if (length == sign || !strchr(first, text[sign]))
    return false;
  return strspn(text, DIGITS LETTERS " ._%/^*()+-") == length && text[length - 1] != ' ';
}

static void write_scalar(const document_node *node, FILE *out) {
  if (node->plain && (!*node->text || stays_plain(node->text)))
    fputs(*node->text ? node->text : "null", out);
  else
    text_json_string(node->text, out);
}

static void write_node(const document_node *node, FILE *out) {
  if (node->kind == DOCUMENT_SCALAR) {
    write_scalar(node, out);
    return;
  }
  const bool mapping = node->kind == DOCUMENT_MAPPING;
  fputc(mapping ? '{' : '[', out);
  for (size_t i = 0; i < node->count; i++) {
    fputs(i ? ", " : "", out);
    if (mapping) {
      write_scalar(node->pairs[i].key, out);
      fputs(": ", out);
    }
    write_node(node->pairs[i].value, out);
  }
  fputc(mapping ? '}' : ']', out);
}

char *document_change_text(const struct document *document) {
  if (!document->changed)
    return strdup(document->text);
  char *text = NULL;
  FILE *out = text_open(&text);
  fprintf(out, "# as read, with values of the %s; comments are left out\n", document->origin);
  for (size_t i = 0; i < document->root->count; i++) {
    write_scalar(document->root->pairs[i].key, out);
    fputs(": ", out);
    write_node(document->root->pairs[i].value, out);
    fputc('\n', out);
  }
  return text_close(out, &text);
}

/* ---- contents of another document: a material's file as the material of a body ---- */

/* Values that `to` already has stay unchanged. */
static bool merge(document_node *to, document_node *from, const char *const *leave_out) {
  for (size_t i = 0; i < from->count; i++) {
    document_node *key = from->pairs[i].key, *value = from->pairs[i].value;
    if (text_is_one_of(key->text, leave_out))
      continue;
    const struct document_pair *own = document_node_find(to, key->text);
    const bool sections = own && own->value->kind == DOCUMENT_MAPPING && value->kind == DOCUMENT_MAPPING;
    if (!own && !document_node_append(to, key, value))
      return false;
    if (sections && !merge(own->value, value, NULL))
      return false;
  }
  return true;
}

/* A scalar becomes an empty mapping; a mapping stays unchanged. */
static void make_section(document_node *section) {
  if (section->kind == DOCUMENT_SCALAR)
    section->count = 0;
  section->kind = DOCUMENT_MAPPING;
}

bool document_graft_word(document_node *section, const char *key, const char *word) {
  struct document *document = section->document;
  document_node *name = make_plain(document, DOCUMENT_SCALAR, key, section);
  document_node *value = make_plain(document, DOCUMENT_SCALAR, word, section);
  if (!name || !value)
    return false;
  make_section(section);
  return document_node_find(section, key) || document_node_append(section, name, value);
}

bool document_graft(document_node *section, struct document *other, const char *const *leave_out) {
  struct document *document = section->document;
  other->owner = document;
  other->next_included = document->included;
  document->included = other;
  document->foreign_errors += other->error_count;
  make_section(section);
  return merge(section, other->root, leave_out);
}

void document_graft_drop(document_node *mapping, const char *key) {
  struct document_pair *pair = document_node_find(mapping, key);
  if (!pair)
    return;
  memmove(pair, pair + 1, (size_t)(mapping->pairs + mapping->count - pair - 1) * sizeof *pair);
  mapping->count--;
}
