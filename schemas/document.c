/* Opening, closing and walking through a document. */
#include "schemas/document.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "schemas/document_tree.h"
#include "schemas/file.h"

/* A document that holds a copy of the text; NULL without memory. */
static struct document *create(const char *name, const char *text, size_t size) {
  struct document *document = calloc(1, sizeof *document);
  if (!document)
    return NULL;
  document->name = strdup(name);
  document->text = malloc(size + 1);
  document->size = size;
  if (!document->name || !document->text) {
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
  const status code = document_guard(document) ? document_build(document) : STATUS_CONTENT;
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

/* "first\nsecond", where either may be NULL; frees both. Returns the first one alone when memory runs out. */
static char *join(char *first, char *second) {
  char *both = NULL;
  if (!first || !second)
    return first ? first : second;
  const size_t size = strlen(first) + strlen(second) + 2;
  both = malloc(size);
  if (both)
    snprintf(both, size, "%s\n%s", first, second);
  free(second);
  if (!both)
    return first;
  free(first);
  return both;
}

static char *own_report(struct document *document) {
  return document->error_count ? document_report_text(document) : NULL;
}

/* The reports of a document and of its included documents, one after the other. */
static char *whole_report(struct document *document) {
  char *text = own_report(document);
  for (struct document *other = document->included; other; other = other->next_included)
    text = join(text, own_report(other));
  return text;
}

status document_finish(struct document *document, const char **report) {
  *report = NULL;
  const size_t errors = document->error_count + document->foreign_errors;
  if (errors == 0)
    return STATUS_OK;
  free(document->report);
  document->report = whole_report(document);
  *report = document->report ? document->report : "no memory for the report of errors";
  for (const struct document *other = document; other;
       other = other == document ? other->included : other->next_included)
    if (other->no_memory)
      return STATUS_MEMORY;
  return document->elsewhere == errors ? STATUS_USAGE : STATUS_CONTENT;
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
