/* Field tables: one row per quantity. No other list repeats these names.
 *
 * A table is a plain `static const struct field rows[]` beside the struct it describes, with offsetof. From it come:
 * YAML reading and its errors, defaults, `clast explain PATH`, JSON Schemas, resolved JSON, the identity of a run, SQL
 * columns, HDF5 attributes and the versioned byte encoding that serves pipe, MPI and store.
 *
 * Paths are dotted ("grain.young_modulus"); a YAML document nests them as mappings. Values inside a struct are SI. C
 * types by kind: FIELD_REAL double, FIELD_INTEGER int64_t, FIELD_BOOLEAN bool, FIELD_CHOICE int (index into choices),
 * FIELD_TEXT char[FIELD_TEXT_SIZE] (inline, so that a struct is copied by assignment). */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "schemas/status.h"
#include "schemas/text.h"

enum field_kind { FIELD_REAL, FIELD_INTEGER, FIELD_BOOLEAN, FIELD_CHOICE, FIELD_TEXT };
enum { FIELD_TEXT_SIZE = 256 };

enum field_flags {
  FIELD_REQUIRED = 1,      /* no default: a document must contain it */
  FIELD_MAY_BE_OFF = 2,    /* FIELD_REAL only: the keyword `off` is accepted; stored as NaN, see field_is_off() */
  FIELD_ABOVE_MINIMUM = 4, /* minimum itself is out of range */
  FIELD_BELOW_MAXIMUM = 8, /* maximum itself is out of range */
  FIELD_DERIVED = 16,      /* inputs only: when not given, it follows from other inputs (engine_kind.complete). `number`
                            * is a placeholder until then, and the doc text says what it follows from */
  FIELD_PERCENT = 32,   /* FIELD_REAL of unit "1": a strain or share that users give in percent and that may exceed 1. A
                           number without % is refused */
  FIELD_FILE = 64,      /* FIELD_TEXT of inputs: a scene's document names a file, and the value is its SHA-256
                         * (engine/scene.h) */
  FIELD_ANY_UNIT = 128, /* FIELD_REAL of unit "1": a number with any unit, turned into SI. Who knows the right unit
                           reads the text again */
};

struct field {
  const char *path; /* dotted, lower_case words */
  enum field_kind kind;
  const char *unit;           /* SI: "m", "kg/m^3", "1", "rad"; NULL for non-numbers */
  size_t offset;              /* offsetof in the struct the table describes */
  double minimum, maximum;    /* inclusive unless flagged; -HUGE_VAL / HUGE_VAL for none. Integers too */
  double number;              /* default of REAL/INTEGER/BOOLEAN (0/1)/CHOICE (index); NAN with MAY_BE_OFF = off */
  const char *text;           /* default of TEXT */
  const char *const *choices; /* NULL-terminated, for CHOICE. For TEXT: names of built-in documents; any other value is
                               * the name of a user's document, and the identity has the last choice in its place */
  const char *choice_docs;    /* optional, one sentence per choice, separated by '\n' */
  unsigned flags;
  const char *when; /* NULL, or "path=value|value" (a choice, boolean or integer of the same table, itself active): the
                       row is active only then; a value given otherwise is refused. In a nest the path is relative to
                       the table that the condition is written in: "/path" begins at the outermost table, "../path" one
                       word of the nest's path further out (outside of everything there is no condition) */
  const char *absent; /* inputs that came later, of any kind: the value that earlier runs had without the input, in SI
                       * ("0", "off", "false", a choice). The identity leaves the row out while it has this value, so
                       * those runs are still found. It must change no bit of them, and never changes itself: the
                       * default may, this may not. NULL: the row was always there */
  const char *doc;    /* meaning, one or more sentences */
  const char *source; /* paper and equation, or NULL */
  const char *label;  /* name on the axis of a chart, in lower case, without unit; NULL: field_label() makes one */
  int main_rank; /* results only: place among the main results, from 1; 0: not a main result. Old stores keep the CHECK
                  * and the index of table run that they were made with: an upgrade in db/store/store.c could renew
                  * them */
  /* A nest: the rows of another table in place of this row, until FIELD_TABLE_AT_START() puts them there. Its path
   * comes before theirs (NULL: nothing does), its offset is added to theirs, and its flags to theirs. FIELD_DERIVED
   * takes the place of their FIELD_REQUIRED. `when` is for those of them that have none. `doc` follows their docs,
   * `choice_docs` those of choices, where it is given. Kind, unit, range and default are not used. */
  const struct field_table *nest;
  const char *only;        /* "NAME": only the rows of this section; "!NAME": all others; NULL: all */
  const struct field *own; /* rows ended by one without a path: their default, and `text`, `when` and `doc` where given,
                            * take the place of those of the nest's row with this path. NULL: none */
};

struct field_table {
  const struct field *rows;
  size_t count;
  size_t size;      /* sizeof the struct described */
  const char *name; /* "dem scene", for messages */
  const char *doc;
  const char *lacking, *instead; /* NULL, or a word of paths that people expect, and what the table has instead */
};
/* More members may follow: .lacking = ... */
#define FIELD_TABLE(rows_, type_, name_, ...)                                                                          \
  { .rows = rows_, .count = sizeof rows_ / sizeof rows_[0], .size = sizeof(type_), .name = name_, .doc = __VA_ARGS__ }

/* FIELD_TABLE_AT_START(table, source): builds `table`, a variable of the file, before main() begins: the flat table of
 * one with nests, rows in the order of the source. It is constant from then on. The process ends with STATUS_MEMORY
 * when memory is refused. */
#define FIELD_TABLE_AT_START(table_, source_)                                                                          \
  __attribute__((constructor)) static void start_##table_(void) {                                                      \
    field_table_start(&source_, &table_);                                                                              \
  }
void field_table_start(const struct field_table *source, struct field_table *table);

/* The words of an enum, each by its number: `static FIELD_WORDS(kinds, KINDS, [FIRST] = "first", [SECOND] = "second");`
 * makes the array `kinds` for .choices. KINDS is the last member of the enum, the number of the others. The build fails
 * if a number has no word, or a word no number. FIELD_WORDS_HERE is the array itself, for use inside a row. */
#define FIELD_WORDS(name, count, ...)                                                                                  \
  const char *const name[] = {__VA_ARGS__, [count] = NULL};                                                            \
  _Static_assert(FIELD_WORDS_FIT(count, __VA_ARGS__), "each number of the enum has one word")
#define FIELD_WORDS_HERE(count, ...)                                                                                   \
  ((const char *const[(count) + 1 + 0 *sizeof(struct {                                                                 \
                        _Static_assert(FIELD_WORDS_FIT(count, __VA_ARGS__), "each number of the enum has one word");   \
                        char unused;                                                                                   \
                      })]){__VA_ARGS__})
/* As many words as numbers, and none beyond the last number. -Woverride-init finds a number with two words. */
#define FIELD_WORDS_FIT(count, ...)                                                                                    \
  (FIELD_WORDS_GIVEN(__VA_ARGS__, 16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1) == (count) &&                 \
   sizeof((const char *const[]){__VA_ARGS__}) == (count) * sizeof(const char *))
#define FIELD_WORDS_GIVEN(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, given, ...) given

/* A value without its row: a value on a sweep axis, or a value that the store writes. */
struct field_value {
  enum field_kind kind;
  double number;              /* REAL (NaN = off), BOOLEAN 0/1, CHOICE index */
  int64_t integer;            /* INTEGER */
  char text[FIELD_TEXT_SIZE]; /* TEXT; for CHOICE the choice's name too */
};

size_t field_choice_count(const struct field *row);
bool field_is_choice(const struct field *row, const char *text); /* is it one of the row's choices? */
bool field_is_off(double value);                                 /* value of a FIELD_MAY_BE_OFF row */
bool field_is_share(const struct field *row);                    /* a real number from 0 to 1 */

/* Exact path, or unique suffix after a dot ("strain" for "threshold.strain"), or the path as the name of a column
 * ("threshold_strain"). NULL: *error has STATUS_CONTENT and names the nearest known paths (or the candidates of an
 * ambiguous suffix). */
const struct field *field_find(const struct field_table *table, const char *path, struct error *error);

/* Offers every path of the table, and every trailing part of it, to the guess: "young_modulos" finds
 * "grain.young_modulus". */
void field_guess(const struct field_table *table, struct text_guess *guess);
/* The same of one path. */
void field_guess_path(const char *path, struct text_guess *guess);
/* The nearest path of one table; false when none is near. A last word without a fault counts more than letters: a wrong
 * section "impact.radius" gives all that end so, "target.radius' or 'projectile.radius". */
enum { FIELD_NEAR_SIZE = 600 };
bool field_nearest(const struct field_table *table, const char *path, char near[FIELD_NEAR_SIZE]);

/* The length of the word behind the first `length` bytes of row i's path, where these are those of `prefix` and no
 * earlier row has the same word there; else 0. */
size_t field_first_word(const struct field_table *table, size_t i, const char *prefix, size_t length);
/* The words that follow a section's path in the table, each once and between two of `quote`: "'a', 'b'". */
void field_members(const struct field_table *table, const char *section, const char *quote, char *text, size_t size);

bool field_is_number(const struct field *row);        /* a real or a whole one */
double field_number(const struct field_value *value); /* of such a row */

/* A path as the name of a column: dots become underscores. */
void field_column_name(const char *path, char *name, size_t size);
/* The row whose path has this name as a column; NULL: none. */
const struct field *field_of_column(const struct field_table *table, const char *column);

/* The name of a row on the axis of a chart: its label, else the last two words of its path ("young modulus", "charge
 * energy"). */
void field_label(const struct field *row, char *label, size_t size);
/* The same for a path without a row. */
void field_label_path(const char *path, char *label, size_t size);
/* A unit for people: "kg/mÂ³" for "kg/m^3"; empty for "1" and NULL. */
void field_label_unit(const char *unit, char *text, size_t size);

/* Fills every row: its default, or zero or NaN if it is required. Members without a row do not change. */
void field_defaults(const struct field_table *table, void *object);
/* The row that decides whether this one is active; NULL when it has no condition, or a condition on an unknown row. */
const struct field *field_controller(const struct field_table *table, const struct field *row);
/* The next row behind `after` (NULL: the first one) whose path ends with the whole words of `suffix`; NULL: none. */
const struct field *field_ending(const struct field_table *table, const char *suffix, const struct field *after);
/* field_find() of an object's input: where several paths end like this, the only one that has an effect in the object.
 */
const struct field *field_find_in(const struct field_table *table, const char *path, const void *object,
                                  struct error *error);
bool field_is_active(const struct field_table *table, const struct field *row, const void *object);
/* The first row with an unmet condition, from this row up through its controlling rows; *other is the row in that
 * condition. NULL when the row is active. The rows of a circular chain are inactive. */
const struct field *field_unmet(const struct field_table *table, const struct field *row, const void *object,
                                const struct field **other);

/* The reason why a row is inactive: "used only when charge.kind is disc or ring, which is none"; empty text when it is
 * active. */
void field_describe_inactive(const struct field_table *table, const struct field *row, const void *object, char *text,
                             size_t size);

/* The row's default; a required row has zero or NaN. */
void field_default(const struct field *row, struct field_value *value);
void field_get(const struct field *row, const void *object, struct field_value *value);
/* Two values of one row; NaN (off) equals NaN. */
bool field_same_value(const struct field *row, const struct field_value *a, const struct field_value *b);
/* Checks kind and range, then stores (-0 becomes 0). A REAL row accepts INTEGER values, an INTEGER row whole REAL
 * values. A choice is given by name in `text` (also of kind TEXT) or, with empty text, by index. STATUS_CONTENT with a
 * message that names the path, the range and the value. */
status field_set(const struct field *row, void *object, const struct field_value *value, struct error *error);
/* Stores a value that is known to be valid for the row. */
void field_set_unchecked(const struct field *row, void *object, const struct field_value *value);
/* The same without storing: *out is `value`, converted to the row's kind. */
status field_set_value(const struct field *row, const struct field_value *value, struct field_value *out,
                       struct error *error);
/* The unit that users see after the row's numbers: "%", "m/s"; empty for a plain number. */
const char *field_shown_unit(const struct field *row);
/* Must a user write a unit after a number of this row? (0 needs none.) */
bool field_needs_unit(const struct field *row);
/* Reads text as a user types it: "5 km/s", "off", "true", a choice. Dimension, unit and range are checked. */
status field_parse(const struct field *row, const char *text, struct field_value *value, struct error *error);
/* The same for text that the program wrote: a number without a unit is in SI. */
status field_parse_si(const struct field *row, const char *text, struct field_value *value, struct error *error);
/* The accepted range of a number's row: "above 0 m", "at least 1 and at most 12". */
void field_describe_range(const struct field *row, char *text, size_t size);
/* The accepted words of a choice's row: "weak, strong or off". */
void field_describe_choices(const struct field *row, char *text, size_t size);
/* The values of the row's condition as words, "disc or ring", into `out`. */
void field_describe_condition(const struct field *row, FILE *out);
/* Text as a row stores it: cut to FIELD_TEXT_SIZE - 1 bytes, the rest zero. NULL is empty. */
void field_copy_text(char to[FIELD_TEXT_SIZE], const char *from);

/* Shortest decimal text that reads back as the same double: "5000", "0.05", "1e30"; "off" for NaN. */
void field_print_number(double number, char text[32]);
/* Human text of a value, SI with unit ("5000 m/s", "3 %" of a row in percent), shortest digits that round-trip. */
void field_print(const struct field *row, const struct field_value *value, char *buffer, size_t size);
/* The same with six digits, and angles in degrees. */
void field_show(const struct field *row, const struct field_value *value, char *buffer, size_t size);

/* Resolved object as JSON text (nested, active rows only, shortest round-trip numbers, "off" as "off"). The caller
 * frees it. Never NULL: without memory the process ends (schemas/memory.h). */
char *field_json(const struct field_table *table, const void *object);
/* Parts of that text, for a caller that writes the outer object: the members without braces; one value. */
void field_json_members(const struct field_table *table, const void *object, FILE *out);
void field_json_value(const struct field *row, const struct field_value *value, FILE *out);
/* Canonical identity text: sorted lines `path=%a\n` of the active rows (text and choices by name), without those that
 * have their value of absence. The caller frees it. Never NULL, as above. */
char *field_identity(const struct field_table *table, const void *object);
/* `clast explain`: one row, or every row under a prefix ("" = all), as text for people. Results have no defaults.
 * Returns how many rows. */
size_t field_explain(const struct field_table *table, const char *prefix, bool results, FILE *out);

/* Table-driven byte encoding: little-endian, rows in table order, preceded by a hash of the table's names and kinds, so
 * that a reader with other rows refuses the bytes instead of misreading them. */
size_t field_encoded_size(const struct field_table *table, const void *object);
size_t field_encode(const struct field_table *table, const void *object, uint8_t *bytes);
/* Returns the number of bytes read; 0 when they are truncated or from another table. Members without a row do not
 * change. */
size_t field_decode(const struct field_table *table, const uint8_t *bytes, size_t size, void *object);
