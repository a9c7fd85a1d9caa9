/* Opening, closing and walking through a document. */
#include "schemas/document.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "schemas/document_tree.h"

status document_parse(const char *name, const char *text, size_t size, struct document **out, struct error *error) {
  *out = NULL;
  if (size > DOCUMENT_LARGEST)
    return status_fail(error, STATUS_CONTENT, "%s: error: larger than %d MiB; no input of clast is that large", name,
                       DOCUMENT_LARGEST >> 20);
  if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) { /* byte order mark */
    text += 3;
    size -= 3;
  }

  struct document *document = calloc(1, sizeof *document);
  if (document) {
    document->name = strdup(name);
    document->text = malloc(size + 1);
    document->size = size;
  }
  if (!document || !document->name || !document->text) {
    document_free(document);
    return status_fail(error, STATUS_MEMORY, "%s: no memory for %zu bytes", name, size);
  }
  memcpy(document->text, text, size);
  document->text[size] = 0;
  status code = document_guard(document) ? document_build(document) : STATUS_CONTENT;
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

status document_open(const char *path, struct document **out, struct error *error) {
  *out = NULL;
  status code = STATUS_IO;
  char *text = NULL;
  int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (file < 0) {
    if (errno == ENOENT || errno == ENOTDIR)
      return status_fail(error, STATUS_MISSING, "%s: there is no such file", path);
    return status_fail(error, STATUS_IO, "%s: cannot be opened: %s", path, strerror(errno));
  }
  struct stat facts;
  if (fstat(file, &facts) == 0 && S_ISDIR(facts.st_mode)) {
    status_fail(error, STATUS_IO, "%s: is a folder; name a file in it", path);
    goto cleanup;
  }
  text = malloc(DOCUMENT_LARGEST + 2);
  if (!text) {
    code = status_fail(error, STATUS_MEMORY, "%s: no memory to read it", path);
    goto cleanup;
  }
  size_t size = 0;
  while (size <= DOCUMENT_LARGEST) {
    ssize_t got = read(file, text + size, DOCUMENT_LARGEST + 1 - size);
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0) {
      status_fail(error, STATUS_IO, "%s: cannot be read: %s", path, strerror(errno));
      goto cleanup;
    }
    if (got == 0)
      break;
    size += (size_t)got;
  }
  code = document_parse(path, text, size, out, error);
cleanup:
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

/* The reports of a document and of those that it includes, one after the other. */
static char *whole_report(struct document *document) {
  char *text = document->error_count ? document_report_text(document) : NULL;
  for (struct document *other = document->included; other; other = other->next_included) {
    char *more = other->error_count ? document_report_text(other) : NULL, *both = NULL;
    if (!more || !text) {
      text = text ? text : more;
      continue;
    }
    const size_t size = strlen(text) + strlen(more) + 2;
    both = malloc(size);
    if (both)
      snprintf(both, size, "%s\n%s", text, more);
    free(both ? text : more);
    free(both ? more : NULL);
    text = both ? both : text;
  }
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
  if (mapping->kind != DOCUMENT_MAPPING)
    return NULL;
  for (size_t i = 0; i < mapping->count; i++) {
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
