/* Reading a YAML 1.2 (core schema) document into a struct through its field table, with all errors of the
 * file in one report:
 *     file:line:col: error: path: what was expected, what came, what to do
 *       the line
 *       ^~~~
 * Refused: unknown keys (the nearest known one is named), duplicate keys, a second document, NUL bytes, invalid UTF-8,
 * aliases inside what they refer to, more than 4 MiB, nesting deeper than 32, values out of range or of the wrong
 * dimension.
 *
 * Opaque over libfyaml: no other folder includes <libfyaml.h>. */
#pragma once

#include "schemas/field.h"

struct document;                            /* owns the text and the tree */
typedef struct document_node document_node; /* borrowed from its document */

/* STATUS_MISSING when the file does not exist, STATUS_IO when unreadable (a directory, permission), STATUS_CONTENT when
 * it is not a YAML mapping: *error holds the located report. */
status document_open(const char *path, struct document **out, struct error *error);
status document_parse(const char *name, const char *text, size_t size, struct document **out, struct error *error);
void document_free(struct document *document); /* NULL is fine */
/* A document that frees itself where its block is left: DOCUMENT document = NULL; */
#define DOCUMENT __attribute__((cleanup(document_release))) struct document *
void document_release(struct document **document); /* for DOCUMENT */

/* From now on, numbers without a unit are in SI. For documents that the program wrote, or that it accepted before units
 * were required. */
void document_take_si(struct document *document);

const char *document_text(const struct document *document); /* the file as read, NUL-terminated */

/* Sets the value of a key as if the file contained it. keys[0] is at the root; keys[1] (NULL: none) is in the mapping
 * keys[0], which is made when absent. `origin` names the source ("command line"): errors about the value begin with it.
 * Call before the document is read. STATUS_CONTENT: keys[0] exists and is no mapping; STATUS_MEMORY. */
status document_change_put(struct document *document, const char *const keys[2], const char *value, const char *origin,
                           struct error *error);
/* Takes keys out of a mapping, as if the file did not contain them. NULL or no mapping: does nothing. A
 * document_change_put must follow, or document_change_text() has them still. */
void document_drop(document_node *mapping, const char *const *keys);
bool document_is_put(const document_node *node); /* is it a value of document_change_put? */
/* The document as text that document_parse reads to the same values; the caller frees it. It is the file as read or,
 * after document_change_put, the values without comments. NULL: no memory. */
char *document_change_text(const struct document *document);

/* Copies the contents of `other` (a mapping) into a section. The section is a mapping, or a scalar that becomes one.
 * Keys that the section already has stay unchanged; keys of `other` in leave_out (NULL: none) are not copied. The
 * section's document owns `other` from now on and reports errors about its values, with their places in `other`. False:
 * no memory. */
bool document_graft(document_node *section, struct document *other, const char *const *leave_out);
/* Adds a key with a plain word as value to the section, unless it has the key. A scalar becomes a mapping. */
bool document_graft_word(document_node *section, const char *key, const char *word);
void document_graft_drop(document_node *mapping, const char *key); /* removes the key */

enum document_kind { DOCUMENT_SCALAR, DOCUMENT_SEQUENCE, DOCUMENT_MAPPING };

document_node *document_root(struct document *document);
enum document_kind document_kind(const document_node *node);
const char *document_scalar(document_node *node);                     /* NULL unless a scalar; plain or quoted text */
document_node *document_key(document_node *mapping, const char *key); /* NULL when absent; marks the key as seen */
size_t document_count(const document_node *node);                     /* items of a sequence, pairs of a mapping */
document_node *document_item(document_node *node, size_t index,
                             const char **key); /* *key is set for mappings (may be NULL) */

/* Reads one scalar node through a row (unit, range, choice). False: an error was reported. */
bool document_value(document_node *node, const struct field *row, struct field_value *value);

/* Reads the nested mapping `node` into *object (which already holds defaults) through the table. Keys listed in `also`
 * (NULL-terminated, may be NULL) belong to the caller and are skipped; every other unknown key is reported. `when`
 * conditions are judged after all keys are read. Returns false when an error was reported. */
bool document_read(document_node *node, const struct field_table *table, const char *const *also, void *object);
/* The same. given[i] (NULL is fine) tells whether the document gives row i, with a valid or invalid value. `complete`
 * (NULL is fine) is called after all keys are read and before conditions are judged: it derives the values that were
 * not given. */
typedef void (*document_complete)(void *object, const bool *given);
bool document_read_given(document_node *node, const struct field_table *table, const char *const *also, void *object,
                         bool *given, document_complete complete);

/* Adds a located error about a node (or a key of it). Errors are counted; the report is ordered by line. */
void document_report(document_node *node, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The message of a call that failed, as an error about the node. */
void document_report_error(document_node *node, const char *path, const struct error *error);
/* Memory ran out at the node. The status of the document is STATUS_MEMORY then, also after document_report_error of a
 * call with that status. */
void document_report_memory(document_node *node, const char *path);
/* Reports every key of the mapping that is neither in `known` (NULL-terminated, may be NULL) nor marked as seen by a
 * call above. */
void document_unknown_keys(document_node *mapping, const char *path, const char *const *known);

/* STATUS_OK when no error was reported; else STATUS_CONTENT with the whole report in *report (owned by the document).
 * STATUS_USAGE when all errors are about values of document_change_put, STATUS_MEMORY when memory ran out. */
status document_finish(struct document *document, const char **report);
/* The same with the report as the message of *error. */
status document_verdict(struct document *document, struct error *error);
