/* Reads definitions, makes their rows, and writes them as JSON. */
#include "engine/command/definition.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/blake2s.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/rows.h"
#include "schemas/unit.h"

enum { TEXTS = 1 << 17, NAME = 48 };

/* ---- rows of the section ---- */

#define SETTING(path_, kind_, unit_, ...) ROW_OF(definition_settings, path_, path_, kind_, unit_, __VA_ARGS__)
static const struct field setting_rows[] = {
    SETTING(program, FIELD_TEXT, NULL, .flags = FIELD_REQUIRED,
            .doc = "The program: a name that is looked for in PATH, or a file with a slash, relative to the scene."),
    SETTING(version, FIELD_TEXT, NULL, .flags = FIELD_REQUIRED,
            .doc = "Version of the program. It is part of a run's identity: change it when the program changes."),
    SETTING(output, FIELD_TEXT, NULL, .text = "stdout",
            .doc = "Where results are read: a file that the program writes, JSON or CSV by its ending; stdout: the "
                   "JSON that it prints."),
    SETTING(same_bits, FIELD_BOOLEAN, NULL, .maximum = 1,
            .doc = "The program gives the same bits for the same inputs and seed, so `clast replay` demands them."),
    SETTING(limits.time, FIELD_REAL, "s", .number = 3600, .maximum = 1e9, .flags = FIELD_ABOVE_MINIMUM,
            .doc = "Longest time of a run by the clock."),
    SETTING(limits.memory, FIELD_REAL, "B", .number = NAN, .minimum = 1 << 20, .maximum = 0x1p60,
            .flags = FIELD_MAY_BE_OFF, .doc = "Largest address space of each process of a run; off: no limit."),
    SETTING(limits.output, FIELD_REAL, "B", .number = 1e8, .minimum = 1000, .maximum = 0x1p60,
            .doc = "Largest size of each file that a run writes, also of what it prints."),
    SETTING(fragments.file, FIELD_TEXT, NULL, .text = "",
            .doc = "File with the fragments' masses: JSON, CSV or, with another ending, numbers between blanks. "
                   "Default: the output."),
    SETTING(fragments.name, FIELD_TEXT, NULL, .text = "", .doc = "Key (of JSON) or column (of CSV) of the masses."),
    SETTING(fragments.unit, FIELD_TEXT, NULL, .text = "kg", .doc = "Unit in which the program writes masses."),
    SETTING(fragments.element_mass, FIELD_REAL, "kg", .number = NAN, .maximum = 1e30,
            .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM,
            .doc = "Mass of the smallest piece that the program can tell, such as one grain: single pieces are "
                   "unresolved, and exponents leave them out. off: the lightest fragment of a run."),
    SETTING(fragments.complete_mass, FIELD_REAL, "kg", .maximum = 1e30,
            .doc = "The spectrum of fragments is complete from this mass on. Exponents begin midway between this "
                   "element and the next, as masses may be whole numbers of elements."),
    SETTING(fragments.dust_mass, FIELD_REAL, "kg", .maximum = 1e30, .doc = "Lighter fragments are dust."),
};
static const struct field_table settings_table = FIELD_TABLE(setting_rows, struct definition_settings, "command",
                                                             "A program, its inputs and its results.");

enum { REAL_INPUT, COUNT_INPUT, SWITCH_INPUT, CHOICE_INPUT, INPUT_KINDS };
static FIELD_WORDS(
    kinds,
    INPUT_KINDS, [REAL_INPUT] = "real", [COUNT_INPUT] = "count", [SWITCH_INPUT] = "switch", [CHOICE_INPUT] = "choice");
enum { NO_RESOLUTION, LARGER, SMALLER, RESOLUTIONS };
static FIELD_WORDS(resolutions, RESOLUTIONS, [NO_RESOLUTION] = "none", [LARGER] = "larger", [SMALLER] = "smaller");

#define MEMBER(struct_, path_, kind_, ...) ROW_OF(struct_, path_, path_, kind_, NULL, __VA_ARGS__)
static const struct field input_rows[] = {
    MEMBER(definition_input, kind, FIELD_CHOICE, .choices = kinds, .doc = "What the input's values are."),
    MEMBER(definition_input, unit, FIELD_TEXT, .text = "1", .when = "kind=real", .doc = "Its SI unit."),
    MEMBER(definition_input, written_in, FIELD_TEXT, .text = "", .when = "kind=real",
           .doc = "Unit of the number that the program gets. Default: the SI unit."),
    MEMBER(definition_input, resolution, FIELD_CHOICE, .choices = resolutions, .when = "kind=real|count",
           .doc = "A knob of `clast converge`: the model is finer with larger or with smaller values."),
    MEMBER(definition_input, doc, FIELD_TEXT, .flags = FIELD_REQUIRED, .doc = "Its meaning."),
};
static const struct field_table input_table = FIELD_TABLE(input_rows, struct definition_input, "input of a command",
                                                          "An input of the program.");
static const char *const input_also[] = {"default", "least", "most", "choices", NULL};

static const struct field result_rows[] = {
    MEMBER(definition_result, unit, FIELD_TEXT, .text = "1", .doc = "Its SI unit."),
    MEMBER(definition_result, written_in, FIELD_TEXT, .text = "",
           .doc = "Unit in which the program writes it. Default: the SI unit."),
    MEMBER(definition_result, name, FIELD_TEXT, .text = "",
           .doc = "Its key (of JSON; a.b is b in a) or column (of CSV, last line). Default: the name of the result."),
    MEMBER(definition_result, doc, FIELD_TEXT, .flags = FIELD_REQUIRED, .doc = "Its meaning."),
};
static const struct field_table result_table = FIELD_TABLE(result_rows, struct definition_result, "result of a command",
                                                           "A result of the program.");

const struct field_table *const definition_sections[] = {&settings_table, &input_table, &result_table, NULL};

static const struct field program_rows[] = {
    ROW_OF(definition_program, program.digest, digest, FIELD_TEXT, NULL, .text = "",
           .doc = "Digest of the scene's section `command`: program, arguments, files, and how results are read."),
    ROW_OF(definition_program, program.version, version, FIELD_TEXT, NULL, .text = "",
           .doc = "Version of the program, from the scene's section `command`."),
};
enum { PROGRAM_ROWS = sizeof program_rows / sizeof program_rows[0] };
const struct field_table definition_base = FIELD_TABLE(
    program_rows, struct definition_program, "command scene",
    "A scene that runs another program; its section `command` names the other inputs (engine/command/README.md).");

/* ---- reading ---- */

struct reading {
  struct definition *d;
  const char *folder;
  size_t texts; /* bytes of all files */
  bool good;
};

static void wrong(struct reading *r, document_node *node, const char *path, const char *what) {
  document_report(node, path, "%s", what);
  r->good = false;
}

static char *copy_of(const char *text) {
  char *copy = strdup(text);
  if (!copy)
    memory_refused();
  return copy;
}

static bool is_name(const char *name) {
  for (const char *c = name; *c; c++)
    if (!islower((unsigned char)*c) && *c != '_' && !(isdigit((unsigned char)*c) && c > name))
      return false;
  return *name && strlen(name) < NAME;
}

/* Is `unit` coherent SI, and `written` (may be empty) of its dimension? */
static void check_units(struct reading *r, document_node *node, const char *path, const char *unit,
                        const char *written) {
  struct unit si, other;
  struct error error;
  if (unit_parse(unit, &si, &error) || (*written && unit_parse(written, &other, &error))) {
    document_report_error(node, path, &error);
    r->good = false;
  } else if (si.ten != 0 || si.times != 1 || si.per != 1) {
    wrong(r, node, path, "`unit` must be an SI unit without prefix; `written_in` takes the unit of the program");
  } else if (*written && !unit_same_dimension(&si, &other)) {
    wrong(r, node, path, "`unit` and the unit that the program writes have different dimensions");
  }
}

static bool is_list(struct reading *r, document_node *node, const char *path, enum document_kind kind, size_t most) {
  const bool good = document_kind(node) == kind && document_count(node) <= most;
  if (!good) {
    document_report(node, path, "expected a %s of at most %zu items",
                    kind == DOCUMENT_SEQUENCE ? "list [a, b]" : "mapping {a: ...}", most);
    r->good = false;
  }
  return good;
}

static void read_bound(document_node *node, const char *key, const struct field *row, double *bound) {
  document_node *given = document_key(node, key);
  struct field_value value;
  const struct field free_row = {.path = key,
                                 .kind = row->kind,
                                 .unit = row->unit,
                                 .minimum = -HUGE_VAL,
                                 .maximum = HUGE_VAL};
  if (given && document_value(given, &free_row, &value))
    *bound = row->kind == FIELD_INTEGER ? (double)value.integer : value.number;
}

static void read_choices(struct reading *r, document_node *node, struct field *row) {
  document_node *list = document_key(node, "choices");
  if (!list) {
    wrong(r, node, row->path, "a choice needs `choices: [a, b]`");
    return;
  }
  if (!is_list(r, list, "choices", DOCUMENT_SEQUENCE, DEFINITION_ROWS))
    return;
  const char **words = memory_small(document_count(list) + 1, sizeof *words);
  for (size_t i = 0; i < document_count(list); i++) {
    const char *word = document_scalar(document_item(list, i, NULL));
    if (!word || !*word || strlen(word) >= NAME || !text_is_plain(word))
      wrong(r, list, "choices", "expected short words");
    words[i] = copy_of(word ? word : "");
  }
  row->choices = words;
}

/* The members of a row that follow from its declaration; the document gives range and default. */
static void make_row(struct reading *r, document_node *node, const char *name, const struct definition_input *in,
                     struct field *row, size_t *size) {
  static const enum field_kind kind[] = {FIELD_REAL, FIELD_INTEGER, FIELD_BOOLEAN, FIELD_CHOICE};
  struct field_value value = {0};
  *row = (struct field){.path = copy_of(name), .kind = kind[in->kind], .offset = *size, .doc = in->doc};
  *size += sizeof(double);
  if (in->kind == REAL_INPUT || in->kind == COUNT_INPUT) {
    row->unit = in->unit;
    row->minimum = in->kind == REAL_INPUT ? -HUGE_VAL : 0;
    row->maximum = in->kind == REAL_INPUT ? HUGE_VAL : 0x1p53;
    read_bound(node, "least", row, &row->minimum);
    read_bound(node, "most", row, &row->maximum);
  } else if (in->kind == SWITCH_INPUT) {
    row->maximum = 1;
  } else {
    read_choices(r, node, row);
  }
  document_node *given = document_key(node, "default");
  if (!given)
    row->flags = FIELD_REQUIRED;
  else if (r->good && document_value(given, row, &value))
    row->number = in->kind == COUNT_INPUT ? (double)value.integer : value.number;
}

static void add_knob(struct definition *d, const struct field *row, int resolution) {
  struct knob *knob = d->knobs;
  while (knob->name)
    knob++;
  *knob = (struct knob){.name = row->path,
                        .group = KNOB_RESOLUTION,
                        .inputs = {{row->path, 1}},
                        .step_power = resolution == LARGER ? -1 : 1,
                        .pairs = true,
                        .meaning = row->doc};
  const double larger[] = {0.25, 0.5, 1, 2}, smaller[] = {4, 2, 1, 0.5};
  memcpy(knob->factors, resolution == LARGER ? larger : smaller, sizeof larger);
}

static bool check_name(struct reading *r, document_node *node, const char *what, const char *name) {
  static const char *const words[] = {"engine", "name",       "source", "settings", "command",
                                      "seed",   "small_seed", "run_id", "program",  NULL};
  const bool form = name && is_name(name);
  if (form && !text_is_one_of(name, words) && !field_find(&outcome_table, name, NULL))
    return true;
  document_report(node, what,
                  form ? "'%.60s' is a word of clast: choose another name"
                       : "'%.60s': a name has small letters, digits and underscores",
                  name ? name : "");
  return r->good = false;
}

static void read_inputs(struct reading *r, document_node *list) {
  struct definition *d = r->d;
  size_t size = sizeof(struct definition_program);
  if (list && !is_list(r, list, "command.inputs", DOCUMENT_MAPPING, DEFINITION_ROWS))
    return;
  const size_t count = list ? document_count(list) : 0;
  d->input_rows = memory_small(count + PROGRAM_ROWS, sizeof *d->input_rows);
  d->input = memory_small(count + 1, sizeof *d->input);
  memcpy(d->input_rows, program_rows, sizeof program_rows);
  for (size_t i = 0; i < count; i++) {
    const char *name = NULL;
    document_node *node = document_item(list, i, &name);
    struct definition_input *in = &d->input[i];
    struct field *row = &d->input_rows[PROGRAM_ROWS + i];
    field_defaults(&input_table, in);
    if (!check_name(r, node, "command.inputs", name))
      return;
    r->good = document_read(node, &input_table, input_also, in) && r->good;
    if (!r->good)
      return;
    check_units(r, node, name, in->unit, in->written_in);
    if (r->good)
      make_row(r, node, name, in, row, &size);
    if (r->good && in->resolution)
      add_knob(d, row, in->resolution);
  }
  d->input_count = count;
  d->inputs = (struct field_table){.rows = d->input_rows,
                                   .count = count + PROGRAM_ROWS,
                                   .size = size,
                                   .name = definition_base.name,
                                   .doc = "The inputs that the scene's section `command` names."};
}

static void read_results(struct reading *r, document_node *list) {
  struct definition *d = r->d;
  if (list && !is_list(r, list, "command.results", DOCUMENT_MAPPING, DEFINITION_ROWS))
    return;
  const size_t count = list ? document_count(list) : 0;
  d->result_rows = memory_small(count + 1, sizeof *d->result_rows);
  d->result = memory_small(count + 1, sizeof *d->result);
  for (size_t i = 0; i < count; i++) {
    const char *name = NULL;
    document_node *node = document_item(list, i, &name);
    struct definition_result *result = &d->result[i];
    field_defaults(&result_table, result);
    if (!check_name(r, node, "command.results", name))
      return;
    r->good = document_read(node, &result_table, NULL, result) && r->good;
    if (!r->good)
      return;
    check_units(r, node, name, result->unit, result->written_in);
    if (!result->name[0])
      field_copy_text(result->name, name);
    d->result_rows[i] = (struct field){.path = copy_of(name),
                                       .kind = FIELD_REAL,
                                       .unit = result->unit,
                                       .offset = i * sizeof(double),
                                       .minimum = -HUGE_VAL,
                                       .maximum = HUGE_VAL,
                                       .number = NAN,
                                       .flags = FIELD_MAY_BE_OFF,
                                       .doc = result->doc};
  }
  d->result_count = count;
  d->results = (struct field_table){.rows = d->result_rows,
                                    .count = count,
                                    .size = (count + 1) * sizeof(double),
                                    .name = "command result",
                                    .doc = "The results that the scene's section `command` names."};
}

/* ---- placeholders ---- */

/* The next {{name}} of the text: its beginning, and its name. NULL: there is none. */
static const char *next_place(const char *text, char name[NAME]) {
  for (const char *at = text; (at = strstr(at, "{{")); at += 2) {
    const size_t length = strspn(at + 2, "abcdefghijklmnopqrstuvwxyz_0123456789");
    if (length == 0 || length >= NAME || strncmp(at + 2 + length, "}}", 2) != 0)
      continue;
    snprintf(name, NAME, "%.*s", (int)length, at + 2);
    return at;
  }
  return NULL;
}

static const struct field *row_of(const struct definition *d, const char *name) {
  for (size_t i = 0; i < d->input_count; i++)
    if (strcmp(d->input_rows[PROGRAM_ROWS + i].path, name) == 0)
      return &d->input_rows[PROGRAM_ROWS + i];
  return NULL;
}

static void check_places(struct reading *r, document_node *node, const char *path, const char *text) {
  char name[NAME];
  for (const char *at = text; r->good && (at = next_place(at, name)); at++)
    if (strcmp(name, "seed") == 0 || strcmp(name, "small_seed") == 0) {
      r->d->takes_seed = true;
    } else if (!row_of(r->d, name)) {
      document_report(node, path, "{{%s}} is no input of the command; known are its inputs, seed and small_seed", name);
      r->good = false;
    }
}

static void write_value(const struct definition *d, const struct field *row, const void *inputs, FILE *out) {
  const char *written = d->input[row - d->input_rows - PROGRAM_ROWS].written_in;
  struct field_value value;
  struct unit unit;
  char text[FIELD_TEXT_SIZE];
  field_get(row, inputs, &value);
  if (row->kind == FIELD_REAL && *written && unit_parse(written, &unit, NULL) == STATUS_OK)
    value.number = value.number * unit.per / unit.times * (unit.ten < 0 ? pow(10, -unit.ten) : 1) /
                   (unit.ten > 0 ? pow(10, unit.ten) : 1);
  if (row->kind == FIELD_REAL)
    field_print_number(value.number, text);
  else if (row->kind == FIELD_INTEGER)
    snprintf(text, sizeof text, "%" PRId64, value.integer);
  else
    snprintf(text, sizeof text, "%s", row->kind == FIELD_CHOICE ? value.text : value.number != 0 ? "true" : "false");
  fputs(text, out);
}

void definition_fill(const struct definition *d, const char *text, const void *inputs, uint64_t seed, FILE *out) {
  char name[NAME];
  for (const char *place; (place = next_place(text, name)); text = place + strlen(name) + 4) {
    const struct field *row = row_of(d, name);
    fwrite(text, 1, (size_t)(place - text), out);
    if (row)
      write_value(d, row, inputs, out);
    else
      fprintf(out, "%" PRIu64, strcmp(name, "seed") == 0 ? seed : 1 + seed % 899999999);
  }
  fputs(text, out);
}

/* ---- arguments, files, exit codes ---- */

static void read_words(struct reading *r, document_node *list) {
  if (!list || !is_list(r, list, "command.arguments", DOCUMENT_SEQUENCE, DEFINITION_WORDS))
    return;
  for (size_t i = 0; i < document_count(list); i++) {
    document_node *node = document_item(list, i, NULL);
    const char *word = document_scalar(node);
    if (!word) {
      wrong(r, node, "command.arguments", "expected a word or a number; put {{name}} in quotes: \"{{name}}\"");
      return;
    }
    r->d->words[r->d->word_count++] = copy_of(word);
    check_places(r, node, "command.arguments", word);
  }
}

/* The path of a file in or below the scene's folder: a scene from a stranger must not copy others into a store. NULL:
 * it is elsewhere, or there is none. */
static char *path_in_folder(const char *folder, const char *name) {
  OWNED char *base = folder ? realpath(*folder ? folder : ".", NULL) : NULL;
  OWNED char *path = folder ? file_name_in(folder, name) : NULL;
  char *real = path ? realpath(path, NULL) : NULL;
  const size_t length = base ? strlen(base) : 0;
  if (real && base && strncmp(real, base, length) == 0 && (real[length] == '/' || length == 1))
    return real;
  free(real);
  return NULL;
}

/* The text of such a file. */
static char *text_of(struct reading *r, document_node *node, const char *name) {
  struct error error;
  OWNED char *path = path_in_folder(r->folder, name);
  unsigned char *bytes = NULL;
  size_t size = 0;
  if (!path) {
    document_report(node, "command.files", "there is no file %.200s in the folder of the scene", name);
    r->good = false;
    return copy_of("");
  }
  if (file_read(path, "file of the command", &bytes, &size, &error)) {
    document_report_error(node, "command.files", &error);
    r->good = false;
    return copy_of("");
  }
  for (size_t i = 0, length; i < size; i += length) {
    length = text_utf8_length((const char *)bytes + i, size - i);
    const uint32_t c = length ? text_utf8_character((const char *)bytes + i, length) : 0;
    if (!(c == '\n' || c == '\r' || c == '\t' || (c >= 0x20 && (c < 0x7f || c > 0x9f)))) { /* a store holds the text */
      wrong(r, node, "command.files", "the file is no plain text in UTF-8; name it in an argument instead");
      break;
    }
  }
  char *text = strndup((const char *)bytes, size);
  free(bytes);
  if (!text)
    memory_refused();
  return text;
}

/* `files: [model.py]` reads files, `files: {model.in: "text"}` holds them. */
static void read_files(struct reading *r, document_node *list, const char *path, bool is_template) {
  struct definition *d = r->d;
  if (!list)
    return;
  const bool named = document_kind(list) == DOCUMENT_SEQUENCE;
  if (!is_list(r, list, path, named ? DOCUMENT_SEQUENCE : DOCUMENT_MAPPING, DEFINITION_FILES - d->file_count))
    return;
  for (size_t i = 0; r->good && i < document_count(list); i++) {
    const char *name = NULL;
    document_node *node = document_item(list, i, &name);
    const char *word = document_scalar(node), *slash = named && word ? strrchr(word, '/') : NULL;
    if (named)
      name = slash ? slash + 1 : word;
    if (!word || !name || !*name || strchr(name, '/') || name[0] == '.' || strlen(name) >= FIELD_TEXT_SIZE ||
        strcmp(name, "stdout") == 0 || strcmp(name, "stderr") == 0) {
      wrong(r, node, path, "expected names of files, or {name: text}; not stdout, stderr or a name with a first point");
      return;
    }
    for (size_t k = 0; k < d->file_count; k++)
      if (strcmp(d->files[k].name, name) == 0)
        wrong(r, node, path, "two files have this name");
    char *text = named ? text_of(r, node, word) : copy_of(word);
    d->files[d->file_count++] = (struct definition_file){copy_of(name), text, is_template};
    r->texts += strlen(text);
    if (r->texts > TEXTS)
      wrong(r, node, path, "files of more than 128 KiB in all; name large ones in an argument instead");
    if (is_template)
      check_places(r, node, path, text);
  }
}

static void read_codes(struct reading *r, document_node *list) {
  const struct field *state = field_find(&outcome_table, "state", NULL);
  if (!list || !is_list(r, list, "command.exit_codes", DOCUMENT_MAPPING, DEFINITION_CODES))
    return;
  for (size_t i = 0; i < document_count(list); i++) {
    const char *key = NULL;
    document_node *node = document_item(list, i, &key);
    struct field_value value;
    char *end = NULL;
    const long code = key ? strtol(key, &end, 10) : -1;
    if (code < 0 || code > 255 || end == key || *end)
      wrong(r, node, "command.exit_codes", "expected exit codes from 0 to 255 with a state, such as {3: end-time}");
    else if (document_value(node, state, &value)) {
      r->d->codes[r->d->code_count].code = (int)code;
      r->d->codes[r->d->code_count++].state = (int)value.number;
    } else
      r->good = false;
  }
}

/* ---- the section as text ---- */

static void write_list(const struct definition *d, bool templates, FILE *out) {
  const char *before = "";
  for (size_t i = 0; i < d->file_count; i++)
    if (d->files[i].is_template == templates) {
      fputs(before, out);
      text_json_string(d->files[i].name, out);
      fputc(':', out);
      text_json_string(d->files[i].text, out);
      before = ",";
    }
}

static void write_input(const struct definition *d, size_t i, FILE *out) {
  const struct field *row = &d->input_rows[PROGRAM_ROWS + i];
  struct field_value value;
  char number[32];
  fprintf(out, "%s\"%s\":{", i ? "," : "", row->path);
  field_json_members(&input_table, &d->input[i], out);
  if (!(row->flags & FIELD_REQUIRED)) {
    field_default(row, &value);
    fputs(",\"default\":", out);
    field_json_value(row, &value, out);
  }
  const bool number_row = row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
  for (int most = 0; number_row && most < 2; most++) {
    const double bound = most ? row->maximum : row->minimum;
    field_print_number(bound, number);
    if (isfinite(bound))
      fprintf(out, ",\"%s\":%s", most ? "most" : "least", number);
  }
  for (size_t k = 0; row->choices && row->choices[k]; k++) {
    fputs(k ? "," : ",\"choices\":[", out);
    text_json_string(row->choices[k], out);
  }
  fputs(row->choices ? "]}" : "}", out);
}

/* `program`: its name without folder, or its place. */
static char *write_section(const struct definition *d, const char *program) {
  struct definition_settings settings = d->settings;
  const struct field *state = field_find(&outcome_table, "state", NULL);
  char *text = NULL;
  FILE *out = text_open(&text);
  field_copy_text(settings.program, program);
  fputs("\"command\":{", out);
  field_json_members(&settings_table, &settings, out);
  fputs(",\"arguments\":[", out);
  for (size_t i = 0; i < d->word_count; i++) {
    fputs(i ? "," : "", out);
    text_json_string(d->words[i], out);
  }
  fputs("],\"files\":{", out);
  write_list(d, false, out);
  fputs("},\"templates\":{", out);
  write_list(d, true, out);
  fputs("},\"exit_codes\":{", out);
  for (size_t i = 0; i < d->code_count; i++)
    fprintf(out, "%s\"%d\":\"%s\"", i ? "," : "", d->codes[i].code, state->choices[d->codes[i].state]);
  fputs("},\"inputs\":{", out);
  for (size_t i = 0; i < d->input_count; i++)
    write_input(d, i, out);
  fputs("},\"results\":{", out);
  for (size_t i = 0; i < d->result_count; i++) {
    fprintf(out, "%s\"%s\":{", i ? "," : "", d->result_rows[i].path);
    field_json_members(&result_table, &d->result[i], out);
    fputc('}', out);
  }
  fputs("}}", out);
  return text_close_small(out, &text);
}

static void add_identity(const struct field_table *table, const void *object, const char *name, FILE *out) {
  OWNED char *text = field_identity(table, object);
  fprintf(out, "[%s]\n%s", name, text);
}

/* What decides the results of a run. Words for people, ranges, defaults and limits may change. A new row of a table
 * needs a value of absence, as every input does: else all digests change. */
static void make_digest(struct definition *d) {
  struct definition_settings settings = d->settings;
  uint8_t digest[16];
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open_sized(&text, &size);
  settings.same_bits = false;
  settings.limits.time = settings.limits.memory = settings.limits.output = 0;
  add_identity(&settings_table, &settings, "command", out);
  for (size_t i = 0; i < d->word_count; i++)
    fprintf(out, "argument %zu %s\n", strlen(d->words[i]), d->words[i]);
  for (size_t i = 0; i < d->file_count; i++)
    fprintf(out, "%s %s %zu %s\n", d->files[i].is_template ? "template" : "file", d->files[i].name,
            strlen(d->files[i].text), d->files[i].text);
  for (size_t i = 0; i < d->code_count; i++)
    fprintf(out, "exit code %d %d\n", d->codes[i].code, d->codes[i].state);
  for (size_t i = 0; i < d->input_count; i++) {
    struct definition_input input = d->input[i];
    const struct field *row = &d->input_rows[PROGRAM_ROWS + i];
    input.resolution = NO_RESOLUTION;
    input.doc[0] = '\0';
    add_identity(&input_table, &input, row->path, out);
    for (size_t k = 0; row->choices && row->choices[k]; k++)
      fprintf(out, "choice %s\n", row->choices[k]);
  }
  for (size_t i = 0; i < d->result_count; i++) {
    struct definition_result result = d->result[i];
    result.doc[0] = '\0';
    add_identity(&result_table, &result, d->result_rows[i].path, out);
  }
  text_close_small(out, &text);
  blake2s(text, size, digest);
  text_hex(digest, sizeof digest, d->digest);
  free(text);
}

/* ---- definitions of this process ---- */

static struct definition *first;

static void release(struct definition *d) {
  for (size_t i = 0; d->input_rows && i < d->input_count; i++) {
    const struct field *row = &d->input_rows[PROGRAM_ROWS + i];
    for (size_t k = 0; row->choices && row->choices[k]; k++)
      free((char *)row->choices[k]);
    free((void *)row->choices);
    free((char *)row->path);
  }
  for (size_t i = 0; i < d->result_count; i++)
    free((char *)d->result_rows[i].path);
  for (size_t i = 0; i < d->word_count; i++)
    free(d->words[i]);
  for (size_t i = 0; i < d->file_count; i++) {
    free(d->files[i].name);
    free(d->files[i].text);
  }
  free(d->input_rows);
  free(d->result_rows);
  free(d->input);
  free(d->result);
  free(d->place);
  free(d->stored);
  free(d->whole);
  free(d);
}

/* The file of a program that is named with a slash. */
static void take_place(struct reading *r) {
  struct definition *d = r->d;
  char *program = d->settings.program, *slash = strrchr(program, '/');
  if (!slash)
    return;
  OWNED char *path = file_name_in(r->folder, program);
  d->place = path ? realpath(path, NULL) : NULL;
  if (!d->place)
    d->place = copy_of(path ? path : program);
  OWNED char *name = copy_of(slash + 1);
  field_copy_text(program, name);
}

static void make_kind(struct definition *d, const struct engine_kind *base) {
  d->kind = *base;
  d->kind.inputs = &d->inputs;
  d->kind.results = &d->results;
  d->kind.of_scene = NULL;
  d->kind.of_task = NULL;
  d->kind.definition = d->stored;
  d->kind.task = d->whole;
  d->kind.knobs = d->knobs;
  d->kind.single = field_is_off(d->settings.fragments.element_mass)
                       ? "as light as the lightest, as no `fragments: element_mass` is given"
                       : "of one element";
  d->kind.same_bits = d->settings.same_bits;
  struct knob *last = d->knobs;
  while (last->name)
    last++;
  *last = (struct knob)KNOB_OF_SETTINGS;
  d->input_rows[0].text = d->digest;
  d->input_rows[1].text = d->settings.version;
}

const struct engine_kind *definition_read(document_node *root, const char *folder, const struct engine_kind *base) {
  static const char *const also[] = {"arguments", "files", "templates", "inputs", "results", "exit_codes", NULL};
  document_node *node = document_key(root, "command");
  if (!node) {
    document_report(root, "command", "is missing; this section names the program, its inputs and its results");
    return NULL;
  }
  struct definition *d = memory_small(1, sizeof *d);
  struct reading r = {.d = d, .folder = folder, .good = true};
  field_defaults(&settings_table, &d->settings);
  r.good = document_read(node, &settings_table, also, &d->settings);
  if (r.good)
    check_units(&r, node, "command.fragments.unit", "kg", d->settings.fragments.unit);
  if (r.good)
    read_inputs(&r, document_key(node, "inputs"));
  if (r.good)
    read_results(&r, document_key(node, "results"));
  if (r.good) {
    read_words(&r, document_key(node, "arguments"));
    read_files(&r, document_key(node, "files"), "command.files", false);
    read_files(&r, document_key(node, "templates"), "command.templates", true);
    read_codes(&r, document_key(node, "exit_codes"));
  }
  if (r.good && d->result_count == 0 && !d->settings.fragments.name[0] && !d->settings.fragments.file[0])
    wrong(&r, node, "command.results", "are missing, and so are fragments: a run must give one of them");
  if (!r.good) {
    release(d);
    return NULL;
  }
  take_place(&r);
  d->stored = write_section(d, d->settings.program);
  d->whole = write_section(d, d->place ? d->place : d->settings.program);
  struct definition **at = &first;
  for (; *at; at = &(*at)->next)
    if (strcmp((*at)->whole, d->whole) == 0) {
      release(d);
      return &(*at)->kind;
    }
  make_digest(d);
  make_kind(d, base);
  *at = d;
  return &d->kind;
}

const struct engine_kind *definition_read_task(const char *text, size_t size, const struct engine_kind *base,
                                               struct error *error) {
  DOCUMENT document = NULL;
  OWNED char *whole = NULL;
  for (const struct definition *d = first; d; d = d->next) /* slots have those of the process that forked them */
    if (strlen(d->whole) == size && memcmp(d->whole, text, size) == 0)
      return &d->kind;
  if (asprintf(&whole, "{%.*s}", (int)size, text) < 0)
    memory_refused();
  if (document_parse("task", whole, strlen(whole), &document, error))
    return NULL;
  document_take_si(document);
  const struct engine_kind *kind = definition_read(document_root(document), NULL, base);
  const char *report = "";
  if (!kind && document_finish(document, &report))
    status_fail(error, STATUS_INTERNAL, "the task cannot be read: %s", report);
  return kind;
}

/* A definition with a place is preferred: one of a store has none. */
status definition_of(const void *inputs, const struct definition **out, struct error *error) {
  const struct definition_program *program = inputs;
  *out = NULL;
  for (const struct definition *d = first; d; d = d->next)
    if (strcmp(d->digest, program->digest) == 0 && strcmp(d->settings.version, program->version) == 0 &&
        (!*out || (d->place && !(*out)->place)))
      *out = d;
  return *out ? STATUS_OK
              : status_fail(error, STATUS_CONTENT,
                            "program.digest and program.version follow from the scene's section `command`: change "
                            "that section instead");
}
