/* The section `command` of a scene: a program, how it takes inputs and where it leaves results. Each definition is an
 * engine of its own name "command" with its own rows. It lives as long as the process. */
#pragma once

#include "engine/engine.h"
#include "engine/fragments.h"
#include "schemas/document.h"

enum { DEFINITION_ROWS = 48, DEFINITION_WORDS = 64, DEFINITION_FILES = 16, DEFINITION_CODES = 16 };

struct definition_settings { /* has rows */
  char program[FIELD_TEXT_SIZE], version[FIELD_TEXT_SIZE], output[FIELD_TEXT_SIZE];
  bool same_bits;
  struct {
    double time, memory, output; /* s, B (off: none), B */
  } limits;
  struct {
    char file[FIELD_TEXT_SIZE], name[FIELD_TEXT_SIZE], unit[FIELD_TEXT_SIZE];
    double element_mass, complete_mass, dust_mass; /* kg */
  } fragments;
};

struct definition_input { /* has rows */
  int kind, resolution;
  char unit[FIELD_TEXT_SIZE], written_in[FIELD_TEXT_SIZE], doc[FIELD_TEXT_SIZE];
};

struct definition_result { /* has rows */
  char unit[FIELD_TEXT_SIZE], written_in[FIELD_TEXT_SIZE], name[FIELD_TEXT_SIZE], doc[FIELD_TEXT_SIZE];
};

struct definition_file {
  char *name, *text;
  bool is_template;
};

/* The first members of the inputs of every definition: they tell which program a run needs. */
struct definition_program {
  char digest[FIELD_TEXT_SIZE], version[FIELD_TEXT_SIZE];
};

struct definition {
  struct engine_kind kind;
  struct field_table inputs, results;
  struct field *input_rows, *result_rows; /* input_rows: first those of struct definition_program */
  struct knob knobs[DEFINITION_ROWS + 2];
  struct definition_settings settings;
  struct definition_input *input; /* of each input row behind the first two */
  struct definition_result *result;
  char *words[DEFINITION_WORDS]; /* arguments */
  struct definition_file files[DEFINITION_FILES];
  size_t input_count, result_count, word_count, file_count, code_count;
  struct {
    int code, state; /* exit code, enum outcome_state */
  } codes[DEFINITION_CODES];
  char *place;  /* the program's file if the scene names one with a slash; else NULL. No part of the identity */
  char *stored; /* the section as JSON for stores: without the place. One text has one definition */
  char *whole;  /* the same with the place, for workers */
  char digest[33];
  bool takes_seed; /* a word or a template has {{seed}} or {{small_seed}} */
  struct definition *next;
};

extern const struct field_table definition_base; /* inputs of the engine without a scene */
extern const struct field_table *const definition_sections[];

/* Reads the section; an equal one of before is found again. Functions come from `base`. NULL: errors were reported to
 * the document. */
const struct engine_kind *definition_read(document_node *root, const char *folder, const struct engine_kind *base);
/* The same from `whole` of another process. NULL: *error says why. */
const struct engine_kind *definition_read_task(const char *text, size_t size, const struct engine_kind *base,
                                               struct error *error);
/* The definition of these inputs. STATUS_CONTENT: the digest of its program is of none. */
status definition_of(const void *inputs, const struct definition **out, struct error *error);

/* Writes `text` with the value of each {{name}} in its place. */
void definition_fill(const struct definition *definition, const char *text, const void *inputs, uint64_t seed,
                     FILE *out);

/* ---- what a program wrote (output.c) ---- */

/* Reads results (into `values`, one for each result row) and masses from the files in `folder`. *fragments: by
 * descending mass, malloc'd, owned by the caller, also after an error. *not_finite is the name of the first result or
 * mass that is NaN or infinite; "": there is none. STATUS_CONTENT: what is wrong in which file and line;
 * STATUS_MEMORY. */
status output_read(const struct definition *definition, const char *folder, double *values, struct fragment **fragments,
                   size_t *count, const char **not_finite, struct error *error);

/* The last words of a text file, in one line; empty: none. */
void output_last_words(const char *folder, const char *name, char *words, size_t size);
