/* The inside of a document, shared by the document_*.c files only. */
#pragma once

#include "schemas/document.h"

enum {
  DOCUMENT_LARGEST = 4 << 20, /* bytes */
  DOCUMENT_DEEPEST = 32,
  DOCUMENT_MOST_NODES = 1 << 20, /* each use of an alias counts, which stops a "billion laughs" attack */
  DOCUMENT_MOST_ANCHORS = 1000,
  DOCUMENT_MOST_ERRORS = 100, /* errors kept with their text; further ones are only counted */
};

struct document_pair {
  document_node *key; /* NULL in a sequence */
  document_node *value;
  bool seen;
};

struct document_node {
  struct document *document;
  struct document_node *next;  /* all nodes, for freeing */
  document_node *parent, *key; /* NULL at the root; the key is NULL in a list */
  enum document_kind kind;
  bool plain;        /* scalar without quotes: the core schema gives it a type */
  bool put;          /* from document_change_put: not part of the text */
  bool faulty;       /* an error about it was already reported: readers skip it */
  size_t start, end; /* bytes in the text */
  struct document_pair *pairs;
  size_t count, capacity;
  char text[]; /* text of a scalar */
};

struct document_error {
  size_t start, end, order;
  bool put; /* about a value of document_change_put, which has no place in the text */
  char *message;
};

struct document {
  char *name, *text;
  char *origin;                         /* source of the values of document_change_put, or NULL */
  size_t size, node_count, error_count; /* error_count may be larger than the number kept */
  size_t elsewhere;                     /* errors among these about values of document_change_put */
  bool changed;                         /* document_change_put was called */
  struct document *included, *next_included,
      *owner;            /* document_graft: documents that this one includes, and the document that includes it */
  size_t foreign_errors; /* errors of the included documents */
  document_node *root, *nodes;
  struct document_error errors[DOCUMENT_MOST_ERRORS];
  char *report;
  bool no_memory; /* document_report_memory was called */
  bool si;        /* numbers without a unit are in SI */
};

/* Makes a node that belongs to the document but is not part of its text; NULL: no memory. */
document_node *document_node_make(struct document *document, enum document_kind kind, const char *text, size_t length);
/* Adds a value at the end of a list (key NULL) or mapping. False: no memory. */
bool document_node_append(document_node *to, document_node *key, document_node *value);
/* The pair of a mapping with this key, faulty or not; NULL when there is none. */
struct document_pair *document_node_find(const document_node *mapping, const char *key);

/* The offset of the first byte that is not well-formed UTF-8 or begins a control character other than tab and line
 * ends; size when there is none. */
size_t document_guard_text(const char *text, size_t size);

/* Turns the text into the tree. STATUS_CONTENT when no tree could be made; the errors are reported. Bytes that must
 * never reach libfyaml or a terminal (NUL, invalid UTF-8, control characters, tabs as indentation) make none. Duplicate
 * keys, tags and undefined aliases are reported too, but leave a tree: the status is STATUS_OK. */
status document_build(struct document *document);

/* Reports an error about bytes [start, end) of the text. */
void document_report_at(struct document *document, size_t start, size_t end, const char *path, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
size_t document_report_line(const struct document *document, size_t offset); /* counted from 1 */
char *document_report_text(struct document *document);                       /* malloc'd, sorted by line */

/* The whole path of a node in its document, such as "vary.grain.density[2]"; empty at the root. */
const char *document_value_path(const document_node *node, char *path, size_t size);
/* The kind of a node in words, for messages: "a list", "nothing", "keys and values". */
const char *document_value_what(const document_node *node);
bool document_value_is_null(const document_node *node); /* a plain scalar that the core schema calls null */
