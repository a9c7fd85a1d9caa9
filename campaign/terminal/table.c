/* Four formats behind one row-by-row interface, and the rows of a question as such a table. */
#include "campaign/terminal/table.h"
#include "campaign/terminal/words.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "db/store/views.h"
#include "engine/grow.h"
#include "schemas/csv.h"
#include "schemas/memory.h"

enum {
  BATCH_ROWS = 500,       /* rows of the table for people that are laid out together */
  COLUMNS_MAXIMUM = 2000, /* SQLite's own limit on columns is 2000 */
  WIDTH = 100,            /* of a table for people, where stdout is no terminal */
  GAP = 2,                /* between columns */
  TEXT_LEAST = 24,        /* a column of texts is not made narrower than this, */
  NAME_LEAST = 16,        /* one of an input, such as a material, not than this, */
  PATH_MOST = 40,         /* and neither than a path in it of up to this width */
};

enum role {
  PLAIN,
  KEY,   /* tells rows apart: repeated in each part of a table in parts, and left out only by leave_out_inputs() */
  MEAN,  /* somebody asked for it: never left out, but it may stand in a further part */
  RARE,  /* left out without --all */
  SAME,  /* the same, if all rows have the same cell; the note has the cell */
  ZERO,  /* the same, if all cells are 0 or missing */
  ERROR, /* half width of an interval, or whether it is weak: stands in the cell of its value */
};

/* Headings for people. */
static const char *const headings[][2] = {{"surplus", "after the rule's stop"},
                                          {"censored", "ended at end_time"},
                                          {"kept", "share of prior"},
                                          {"not_told", "reason for -"},
                                          {"of_means", "share of means"},
                                          {"of_runs", "share of runs"},
                                          {"runs_as_far", "runs as far"},
                                          {"from", "lightest mass"},
                                          {"cutoff_p", "p of cut-off"},
                                          {"open_cutoff_p", "p of cut-off, largest included"},
                                          {"lognormal_p", "p of lognormal"},
                                          {"given_up", "failed at all attempts"},
                                          {"largest_drift", "largest energy error"},
                                          {"silent_drift", "error above 1 % without warning"},
                                          {"rule_unmet", "points that reached seeds.max too early"},
                                          {"frontier", "best"}};

/* What people need of columns with such a name, or with such an ending. */
static const struct {
  const char *name;
  enum role role;
} rules[] = {
    {"point_id", KEY},
    {"run_id", KEY},
    {"campaign", KEY},
    {"engine", SAME},
    {"complete", SAME},
    {"results_version", SAME},
    {"failed", ZERO},
    {"censored", ZERO},
    {"surplus", ZERO},
    {"excluded", ZERO},
    {"failed_attempts", ZERO},
    {"without_result", ZERO},
    {"warned", ZERO},
    {"rule_unmet", ZERO},
    {"last_started", RARE},
    {"last_ended", RARE},
    {"command", RARE},
    {"tillotson_A", RARE},
    {"_mean", MEAN},
    {"mean a", MEAN},
    {"mean b", MEAN},
    {"difference", MEAN},
    {"_sd", RARE},
    {"_se", RARE},
    {"_low95", RARE},
    {"_high95", RARE},
    {"_weak", ZERO},
    {"_resolution", ZERO},
    {"_resolution_verdict", SAME},
};
enum { RULES = sizeof rules / sizeof rules[0] };

struct column {
  char *name, *unit; /* for programs */
  char *head;        /* for people, with the unit */
  enum role role;
  double factor; /* people see numbers over this */
  size_t value;  /* of an ERROR: the column of its value */
  size_t narrow, path;
  size_t width;              /* in the table for people, characters */
  bool input, of_studies;    /* an input of the points, made by table_key(); that only studies vary */
  bool text;                 /* aligned left */
  bool marked;               /* a number has a mark behind it; the others leave its room free */
  struct sample_range range; /* of an ERROR: the values that its value can have */
  bool left_out;             /* people do not see it */
  const char *rest;          /* of the text that is being printed */
};

struct table {
  enum table_format format;
  bool people; /* the format is for people */
  bool asked;  /* the user named the columns */
  FILE *out;
  struct column *columns;
  size_t column_count, cell;
  uint64_t rows;
  struct kept { /* cells for people that are not yet printed */
    char *text;
    size_t digits; /* bytes before the mark */
    double number;
    bool left;
  } * kept;
  size_t kept_count;
  char mark[UNCERTAINTY_TEXT]; /* behind the next cell */
  bool laid_out, out_of_memory, broken, ended;
  int write_error;
};

struct table *table_new(enum table_format format, FILE *out) {
  struct table *table = memory_small(1, sizeof *table);
  table->format = format;
  table->people = table_for_people(format);
  table->out = out;
  return table;
}

bool table_for_people(enum table_format format) {
  return format == TABLE_TEXT || format == TABLE_BARE || format == TABLE_ALL;
}

bool table_broken(const struct table *table) {
  return table->broken;
}

static void fail(struct table *table) {
  table->out_of_memory = true;
  table->broken = true;
}

static char *copy(struct table *table, const char *text) {
  char *made = strdup(text);
  if (!made)
    fail(table);
  return made;
}

static bool ends_in(const char *name, const char *end) {
  const size_t length = strlen(name), tail = strlen(end);
  return length >= tail && strcmp(name + length - tail, end) == 0 && (length == tail || *end == '_');
}

/* The column of the value whose half width has this name: "x" or "x_mean" of "x_hw95" and "x_weak", the last one of
 * "hw95". */
static bool find_value(const struct table *table, const char *name, size_t *value) {
  const size_t stem = ends_in(name, "_hw95") || ends_in(name, "_weak") ? strlen(name) - strlen("_hw95") : 0;
  for (size_t c = table->column_count; c-- > 0;) {
    const char *const other = table->columns[c].name;
    *value = c;
    if (stem ? strncmp(other, name, stem) == 0 && (!other[stem] || strcmp(other + stem, "_mean") == 0)
             : strcmp(name, "hw95") == 0)
      return true;
  }
  return false;
}

static enum role role_of(const struct table *table, const char *name, size_t *value) {
  if (table->asked)
    return MEAN;
  if (find_value(table, name, value))
    return ERROR;
  for (size_t i = 0; i < RULES; i++)
    if (ends_in(name, rules[i].name))
      return rules[i].role;
  return PLAIN;
}

/* A name or a unit can come from a store, too: the heading cannot control the terminal. */
static char *heading(struct table *table, const char *name, const char *unit) {
  char text[512] = "", shown[128] = "";
  text_unit(unit, shown, sizeof shown);
  text_append(text, sizeof text, *shown ? "%s [%s]" : "%s", strcmp(name, "point_id") == 0 ? "point" : name, shown);
  text_make_plain(text, "");
  return copy(table, text);
}

void table_column(struct table *table, const char *name, const char *unit) {
  if (table->broken)
    return;
  if (table->column_count == COLUMNS_MAXIMUM ||
      !grow_block(&table->columns, (table->column_count + 1) * sizeof *table->columns)) {
    fail(table);
    return;
  }
  struct column *columns = table->columns, *column = &columns[table->column_count];
  *column = (struct column){.name = copy(table, name), .factor = 1};
  if (unit && strcmp(unit, "1") != 0 && *unit)
    column->unit = copy(table, unit);
  if (table->people && !table->broken) {
    column->role = role_of(table, name, &column->value);
    const char *head = name;
    for (size_t i = 0; !table->asked && i < sizeof headings / sizeof *headings; i++)
      head = strcmp(name, headings[i][0]) == 0 ? headings[i][1] : head;
    column->head = heading(table, head, column->unit);
  }
  table->column_count++;
  if (column->role == ERROR) {
    char value[256];
    snprintf(value, sizeof value, "%s", columns[column->value].name);
    if (ends_in(value, "_mean"))
      value[strlen(value) - strlen("_mean")] = '\0';
    column->range = views_range(value);
  }
  if (column->role == ERROR && ends_in(columns[column->value].name, "_mean")) { /* "x" is enough above "1 +- 0.1" */
    char *end = strstr(columns[column->value].head, "_mean");
    if (end)
      memmove(end, end + strlen("_mean"), strlen(end + strlen("_mean")) + 1);
  }
}

void table_columns(struct table *table, const char *const *names) {
  for (; *names; names++)
    table_column(table, *names, NULL);
}

void table_key(struct table *table, const struct ask_column *input) {
  table_column(table, input->name, input->unit);
  if (table->broken || !table->people)
    return;
  struct column *column = &table->columns[table->column_count - 1];
  free(column->head);
  column->head = heading(table, *input->word && !table->asked ? input->word : input->name, column->unit);
  column->role = table->asked ? MEAN : KEY;
  column->input = true;
  column->of_studies = input->of_studies;
  column->factor = input->factor;
}

void table_range(struct table *table, struct sample_range range) {
  if (!table->broken)
    table->columns[table->column_count - 1].range = range;
}

void table_interval_columns(struct table *table, const char *value, const char *low, const char *high) {
  table_columns(table, (const char *const[]){value, table->people ? NULL : low, high, NULL});
}

void table_rare(struct table *table) {
  if (!table->broken && table->people)
    table->columns[table->column_count - 1].role = RARE;
}

/* ---- the table for people: which columns, how wide, and the lines of a row ---- */

static size_t width_of(const char *text) {
  return text_characters(text, SIZE_MAX);
}

/* Can a line end behind this character? "M_1" stays whole. */
static bool is_joint(const char *at) {
  return at[0] == '_' && !(at[1] >= '0' && at[1] <= '9');
}

/* Bytes of the first line of a text: it breaks before a blank or behind "_", else anywhere. `whole`: behind "_" only
 * where the line has no blank, as the words of a cell are paths and commands. */
static size_t line_of(const char *text, size_t width, bool whole) {
  size_t at = 0, broken = 0;
  bool blank = false;
  for (size_t used = 0; text[at]; at++) {
    used += (text[at] & 0xC0) != 0x80;
    if (used > width + (text[at] == ' '))
      return broken ? broken : at;
    blank |= text[at] == ' ';
    if (text[at] == ' ' || (is_joint(text + at) && used <= width && !(whole && blank)))
      broken = at + (text[at] == '_');
  }
  return at;
}

/* The narrowest column that breaks no word of a heading. */
static size_t widest_word(const char *head) {
  size_t widest = 0;
  for (size_t word = 0; *head; head++) {
    word = *head == ' ' ? 0 : word + ((*head & 0xC0) != 0x80);
    widest = word > widest ? word : widest;
    word = is_joint(head) ? 0 : word;
  }
  return widest;
}

static bool has_mark(const char *text) {
  const size_t length = strlen(text), mark = strlen(UNCERTAINTY_MARK);
  return length > mark && strcmp(text + length - mark, UNCERTAINTY_MARK) == 0;
}

/* Characters behind a number where another one has its mark. */
static size_t room_of_mark(const struct column *column, const struct kept *cell) {
  return column->marked && !cell->left && !has_mark(cell->text) ? strlen(UNCERTAINTY_MARK) : 0;
}

/* Columns that a person has room for: those of the terminal, or WIDTH. COLUMNS says otherwise. */
static size_t room_for(FILE *out) {
  const char *columns = getenv("COLUMNS");
  struct winsize size;
  const long asked = columns ? strtol(columns, NULL, 10) : 0;
  if (asked > 0)
    return (size_t)asked;
  return isatty(fileno(out)) && ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : WIDTH;
}

static size_t total_width(const struct table *table) {
  size_t total = 0;
  for (size_t c = 0; c < table->column_count; c++)
    total += table->columns[c].left_out ? 0 : table->columns[c].width + GAP;
  return total ? total - GAP : 0;
}

/* The widest path of a text, such as target.material.porosity.curve, but not beyond PATH_MOST. */
static size_t widest_path(const char *text) {
  size_t widest = 0;
  for (size_t length; *text; text += length + (text[length] == ' ')) {
    length = strcspn(text, " ");
    const bool path = memchr(text, '.', length) && length > 0 && text[length - 1] != '.';
    const size_t width = path ? text_characters(text, length) : 0;
    widest = width > widest && width <= PATH_MOST ? width : widest;
  }
  return widest;
}

/* Width of a column by its cells and its heading, and by its cells and the words of its heading. */
static void measure(struct table *table, size_t c) {
  struct column *column = &table->columns[c];
  column->width = width_of(column->head);
  column->narrow = widest_word(column->head);
  for (size_t i = c; i < table->kept_count; i += table->column_count) {
    column->marked |= !table->kept[i].left && has_mark(table->kept[i].text);
    column->text |= table->kept[i].left;
  }
  for (size_t i = c; i < table->kept_count; i += table->column_count) {
    const size_t width = width_of(table->kept[i].text) + room_of_mark(column, &table->kept[i]);
    column->width = width > column->width ? width : column->width;
    column->narrow = width > column->narrow ? width : column->narrow;
    const size_t path = column->text ? widest_path(table->kept[i].text) : 0;
    column->path = path > column->path ? path : column->path;
  }
}

/* The column that gains most by a heading of several lines; with `texts` the widest column of texts. NULL: none. */
static struct column *widest(const struct table *table, bool texts) {
  struct column *best = NULL;
  size_t most = 0;
  for (size_t c = 0; c < table->column_count; c++) {
    struct column *column = &table->columns[c];
    const size_t text = column->input ? NAME_LEAST : TEXT_LEAST;
    const size_t least = !texts ? column->narrow : column->path > text ? column->path : text;
    if (column->left_out || (texts && !column->text) || column->width <= least + most)
      continue;
    best = column;
    most = column->width - least;
  }
  return best;
}

/* Until the table fits: gives headings several lines, then makes columns of texts narrower. */
static void make_narrow(struct table *table, size_t room) {
  struct column *column;
  while (total_width(table) > room && (column = widest(table, false))) { /* no narrower than it takes: few lines */
    const size_t gain = column->width - column->narrow, over = total_width(table) - room;
    size_t need = column->narrow;
    column->width -= gain < over ? gain : over;
    for (const char *head = column->head; *head;) { /* without the room that its lines leave */
      const size_t bytes = line_of(head, column->width, false), width = text_characters(head, bytes);
      need = width > need ? width : need;
      head += bytes + (head[bytes] == ' ');
    }
    column->width = need;
  }
  while (total_width(table) > room && (column = widest(table, true)))
    column->width--;
}

/* Do the cells of a column say nothing: because all are the same, or are 0 or missing? */
static bool is_quiet(const struct table *table, size_t c) {
  const enum role role = table->columns[c].role;
  for (size_t i = c; i < table->kept_count; i += table->column_count)
    if (role == SAME ? strcmp(table->kept[i].text, table->kept[c].text) != 0
                     : strcmp(table->kept[i].text, "0") != 0 && strcmp(table->kept[i].text, "-") != 0)
      return false;
  return (role == SAME || role == ZERO) && table->rows < BATCH_ROWS && table->kept_count > 0;
}

struct told {
  uint64_t others; /* hash of a row's other inputs */
  const char *cell;
};

static int told_order(const void *a, const void *b) {
  const struct told *x = a, *y = b;
  return x->others != y->others ? (x->others < y->others ? -1 : 1) : strcmp(x->cell, y->cell);
}

/* Do the inputs that are not left out tell the same rows apart without column c? */
static bool is_told_by_others(const struct table *table, size_t c) {
  const size_t rows = table->kept_count / table->column_count;
  OWNED struct told *told = NULL;
  if (memory_array(&told, rows, sizeof *told, "a table", NULL) != STATUS_OK)
    return false;
  for (size_t r = 0; r < rows; r++) {
    const struct kept *row = &table->kept[r * table->column_count];
    told[r].cell = row[c].text;
    for (size_t k = 0; k < table->column_count; k++)
      if (k != c && table->columns[k].input && !table->columns[k].left_out)
        told[r].others = text_hash(told[r].others, row[k].text, strlen(row[k].text) + 1);
  }
  qsort(told, rows, sizeof *told, told_order);
  for (size_t r = 1; r < rows; r++)
    if (told[r].others == told[r - 1].others && strcmp(told[r].cell, told[r - 1].cell) != 0)
      return false;
  return true;
}

/* Where a table does not fit, inputs that only studies vary leave two thirds of its width to the results: the last ones
 * are left out, because the number of the point or run tells its rows apart. Others that tell no rows apart, such as
 * the values of several rocks, leave a third. */
static void leave_out_inputs(struct table *table, size_t room) {
  size_t width = 0;
  bool numbered = false;
  for (size_t c = 0; c < table->column_count; c++) {
    const struct column *column = &table->columns[c];
    width += column->input ? column->width + GAP : 0;
    numbered |= strcmp(column->name, "point_id") == 0 || strcmp(column->name, "run_id") == 0;
  }
  for (size_t c = table->column_count;
       numbered && !table->asked && c-- > 0 && width > room / 3 && total_width(table) > room;) {
    struct column *column = &table->columns[c];
    column->left_out |= column->of_studies;
    width -= column->of_studies ? column->width + GAP : 0;
  }
  for (size_t c = table->column_count;
       numbered && !table->asked && c-- > 0 && width > room - room / 3 && total_width(table) > room;) {
    struct column *column = &table->columns[c];
    if (!column->input || column->left_out || !is_told_by_others(table, c))
      continue;
    column->left_out = true;
    width -= column->width + GAP;
  }
}

static void lay_out(struct table *table) {
  const size_t room = room_for(table->out);
  table->laid_out = true;
  for (size_t c = 0; c < table->column_count; c++) {
    struct column *column = &table->columns[c];
    column->left_out = column->role == ERROR ||
                       (table->format != TABLE_ALL && (column->role == RARE || is_quiet(table, c)));
    if (c == 0 && (column->role == PLAIN || table->asked))
      column->role = KEY;
    measure(table, c);
  }
  make_narrow(table, room);
  if (table->format != TABLE_ALL)
    leave_out_inputs(table, room);
  if (table->format != TABLE_ALL)
    for (size_t c = table->column_count; c-- > 1 && total_width(table) > room;)
      table->columns[c].left_out |= table->columns[c].role != KEY && table->columns[c].role != MEAN;
}

/* Prints one line after the other of cells, whose texts go on at rest[]. row NULL: the headings. A row whose texts are
 * all in columns that are left out has no line. */
static void print_lines(struct table *table, size_t count, const size_t *list, const struct kept *row) {
  FILE *const out = table->out;
  bool more = !row;
  for (size_t i = 0; i < count; i++) {
    table->columns[list[i]].rest = row ? row[list[i]].text : table->columns[list[i]].head;
    more |= *table->columns[list[i]].rest != 0;
  }
  while (more) {
    size_t blanks = 0; /* before the next text: none at the end of a line */
    more = false;
    for (size_t i = 0; i < count; i++) {
      struct column *column = &table->columns[list[i]];
      const char *const text = column->rest;
      const size_t bytes = row && !column->text ? strlen(text) : line_of(text, column->width, row != NULL);
      const size_t mark = row && *text ? room_of_mark(column, &row[list[i]]) : 0;
      const size_t width = text_characters(text, bytes) + mark, gap = column->width > width ? column->width - width : 0;
      if (bytes)
        fprintf(out, "%*s%.*s", (int)(blanks + (column->text ? 0 : gap)), "", (int)bytes, text);
      blanks = bytes ? GAP + mark + (column->text ? gap : 0) : blanks + GAP + column->width;
      column->rest = text + bytes + (text[bytes] == ' ');
      more |= *column->rest != 0;
    }
    fputc('\n', out);
  }
}

/* The keys and the columns of a part, from *next on: as many as there is room for, at least one. */
static size_t take_part(const struct table *table, size_t *next, size_t *list) {
  const size_t from = *next, room = room_for(table->out);
  size_t used = 0, count = 0;
  for (size_t c = 0; c < table->column_count; c++)
    used += table->columns[c].role == KEY && !table->columns[c].left_out ? table->columns[c].width + GAP : 0;
  for (bool some = false; *next < table->column_count; ++*next) {
    const struct column *column = &table->columns[*next];
    if (column->left_out || column->role == KEY)
      continue;
    if (some && used + column->width > room)
      break;
    some = true;
    used += column->width + GAP;
  }
  for (size_t c = 0; c < table->column_count; c++)
    if (!table->columns[c].left_out && (table->columns[c].role == KEY || (c >= from && c < *next)))
      list[count++] = c;
  return count;
}

/* Do the kept cells fit into the columns as they were laid out for earlier rows? */
static bool fits(const struct table *table) {
  for (size_t i = 0; i < table->kept_count; i++) {
    const struct column *column = &table->columns[i % table->column_count];
    if (!column->left_out && !column->text &&
        width_of(table->kept[i].text) + room_of_mark(column, &table->kept[i]) > column->width)
      return false;
  }
  return true;
}

/* Prints the kept rows, in as many parts as it takes. */
static void print_kept(struct table *table) {
  const bool first = !table->laid_out || !fits(table);
  if (table->out == stdout)
    words_before_table();
  OWNED size_t *list = malloc((table->column_count + 1) * sizeof *list);
  if (!list) {
    fail(table);
    return;
  }
  if (first)
    lay_out(table);
  size_t next = 0;
  do {
    const size_t part = next, count = take_part(table, &next, list);
    if (part)
      fputc('\n', table->out);
    if (first || part || next < table->column_count)
      print_lines(table, count, list, NULL);
    for (size_t i = 0; i < table->kept_count; i += table->column_count)
      print_lines(table, count, list, &table->kept[i]);
  } while (next < table->column_count);
}

static void drop_kept(struct table *table) {
  for (size_t i = 0; i < table->kept_count; i++)
    free(table->kept[i].text);
  table->kept_count = 0;
}

/* Tells people on stderr what they do not see. An ending that several columns have is told once. */
static void tell_left_out(const struct table *table) {
  OWNED char *text = NULL;
  FILE *note = text_open(&text);
  const char *before = "clast: not shown (--all): ";
  bool told[RULES] = {false};
  for (size_t c = 0; note && c < table->column_count; c++) {
    const struct column *column = &table->columns[c];
    size_t rule = 0;
    while (rule < RULES && !(*rules[rule].name == '_' && ends_in(column->name, rules[rule].name)))
      rule++;
    if (!column->left_out || column->role == ERROR || (rule < RULES && told[rule]))
      continue;
    fprintf(note, "%s%s", before, rule < RULES ? rules[rule].name : column->head);
    before = ", ";
    if (rule < RULES)
      told[rule] = true;
    else if (is_quiet(table, c))
      fprintf(note, " %s", table->kept[c].text);
  }
  if (note && text_close(note, &text) && *text)
    text_wrap(text, 0, 0, WIDTH, stderr);
}

/* Would a spreadsheet run the text as a formula? It takes a number as a number. */
static bool is_formula(const char *text) {
  const char *first = text + strspn(text, " \t\n");
  char *end = NULL;
  if (!*first || !strchr(CSV_FORMULA, *first))
    return false;
  (void)strtod(first, &end);
  return end == first || *end;
}

/* The text comes from a store, perhaps a foreign one: it neither controls a terminal nor runs in a spreadsheet. */
static void print_csv_text(struct table *table, const char *text) {
  FILE *const out = table->out;
  OWNED char *plain = copy(table, text);
  if (!plain)
    return;
  text_make_plain(plain, "\t\n");
  const char *before = is_formula(plain) ? "'" : "";
  if (!strpbrk(plain, ",\"\t\n") && *plain && *plain != ' ') {
    fprintf(out, "%s%s", before, plain);
  } else {
    fprintf(out, "\"%s", before);
    for (const char *at = plain; *at; at++) {
      if (*at == '"')
        fputc('"', out);
      fputc(*at, out);
    }
    fputc('"', out);
  }
}

static void header(struct table *table) {
  if (table->format == TABLE_CSV) {
    for (size_t c = 0; c < table->column_count; c++) {
      print_csv_text(table, table->columns[c].name);
      fputs(c + 1 < table->column_count ? "," : "\n", table->out);
    }
  } else if (table->format == TABLE_JSON) {
    fputc('[', table->out);
  }
}

/* Why a write to `out` failed. errno may have changed since; a pipe whose reader has gone still reports it. */
static int failure_of(FILE *out, int code) {
  struct pollfd pipe_end = {.fd = fileno(out), .events = POLLOUT};
  if (poll(&pipe_end, 1, 0) == 1 && (pipe_end.revents & POLLERR))
    return EPIPE;
  return code ? code : EIO;
}

static void check_output(struct table *table) {
  if (ferror(table->out)) {
    table->write_error = failure_of(table->out, errno);
    table->broken = true;
  }
}

struct cell {
  enum { CELL_TEXT, CELL_NUMBER, CELL_MISSING } kind;
  const char *text;  /* for programs; digits of a number */
  const char *shown; /* for people */
  double number;
};

/* Gives a kept cell another text. */
static void replace(struct table *table, struct kept *kept, const char *text, size_t digits) {
  free(kept->text);
  kept->text = copy(table, text);
  kept->digits = digits;
  if (!kept->text)
    kept->text = strdup("");
}

/* Keeps a cell for people, with its mark. Of a half width, its value's cell becomes "value +- half width". */
static void keep(struct table *table, const struct cell *cell) {
  const struct column *column = &table->columns[table->cell];
  char text[2 * UNCERTAINTY_TEXT + 16];
  if (!table->kept)
    table->kept = calloc(table->column_count * BATCH_ROWS, sizeof *table->kept);
  if (!table->kept) {
    fail(table);
    return;
  }
  struct kept *kept = &table->kept[table->kept_count];
  const bool marked = *table->mark && cell->kind != CELL_MISSING;
  snprintf(text, sizeof text, "%.*s%s", UNCERTAINTY_TEXT, cell->shown, table->mark);
  *kept = (struct kept){copy(table, marked ? text : cell->shown), strlen(cell->shown), cell->number,
                        cell->kind == CELL_TEXT && *cell->shown};
  if (!kept->text)
    return;
  table->kept_count++;
  if (table->cell > 0 && !table->asked && ends_in(column->name, "_resolution_verdict") && isfinite(kept[-1].number)) {
    uncertainty_resolution_cell(ask_resolution_verdict(cell->text), kept[-1].number, text);
    replace(table, kept - 1, text, strlen(text)); /* ">= 0.04" */
  }
  struct kept *value = kept - table->cell + column->value;
  if (column->role != ERROR || !(cell->number > 0) || !isfinite(value->number) || !isfinite(cell->number))
    return;
  char number[UNCERTAINTY_TEXT];
  if (ends_in(column->name, "_weak")) {
    snprintf(text, sizeof text, "%.*s~%.*s", (int)value->digits, value->text, UNCERTAINTY_TEXT,
             value->text + value->digits);
    replace(table, value, text, value->digits);
    return;
  }
  uncertainty_cell(value->number, cell->number, &column->range, number);
  snprintf(text, sizeof text, "%s%.*s", number, UNCERTAINTY_TEXT, value->text + value->digits);
  replace(table, value, text, strlen(number));
}

static void print_csv(struct table *table, const struct cell *cell) {
  if (cell->kind == CELL_TEXT)
    print_csv_text(table, cell->text);
  else if (cell->kind == CELL_NUMBER)
    fputs(cell->text, table->out);
  fputs(table->cell + 1 < table->column_count ? "," : "\n", table->out);
}

static void print_json(struct table *table, const struct cell *cell) {
  const bool lines = table->format == TABLE_JSON_LINES;
  if (table->cell > 0)
    fputs(", ", table->out);
  else
    fputs(lines ? "{" : table->rows ? ",\n {" : "\n {", table->out);
  text_json_string(table->columns[table->cell].name, table->out);
  fputs(": ", table->out);
  if (cell->kind == CELL_TEXT)
    text_json_string(cell->text, table->out);
  else
    fputs(cell->kind == CELL_NUMBER ? cell->text : "null", table->out);
  if (table->cell + 1 == table->column_count)
    fputs(lines ? "}\n" : "}", table->out);
}

static void add_cell(struct table *table, struct cell cell) {
  if (table->broken || table->column_count == 0)
    return;
  if (table->cell == 0 && table->rows == 0 && !table->people)
    header(table);
  switch (table->format) {
  case TABLE_CSV: print_csv(table, &cell); break;
  case TABLE_JSON:
  case TABLE_JSON_LINES: print_json(table, &cell); break;
  case TABLE_TEXT:
  case TABLE_BARE:
  case TABLE_ALL: keep(table, &cell); break;
  }
  table->mark[0] = 0;
  if (table->broken || ++table->cell < table->column_count)
    return;
  table->cell = 0;
  table->rows++;
  if (table->people && table->rows % BATCH_ROWS == 0) {
    print_kept(table);
    drop_kept(table);
  }
  check_output(table);
}

void table_rests_on(struct table *table, const struct ask_doubts *doubts) {
  if (!table->broken)
    uncertainty_mark(doubts, table->mark);
}

void table_doubt_columns(struct table *table) {
  if (!table->people)
    table_columns(table, (const char *const[]){"doubtful", "doubts", NULL});
}

void table_doubt_cells(struct table *table, const struct ask_doubts *doubts) {
  char words[UNCERTAINTY_TEXT];
  if (table->people)
    return;
  ask_doubts_words(doubts, words, sizeof words);
  table_integer(table, doubts->doubtful);
  table_text(table, words);
}

void table_missing(struct table *table) {
  add_cell(table, (struct cell){CELL_MISSING, "", "-", NAN});
}

void table_text(struct table *table, const char *text) {
  if (!text) {
    table_missing(table);
    return;
  }
  if (!table->people || text_is_plain(text)) {
    add_cell(table, (struct cell){CELL_TEXT, text, text, NAN});
    return;
  }
  OWNED char *line = copy(table, text); /* a row stays one line, and a text from a file cannot control the terminal */
  if (!line)
    return;
  text_make_plain(line, "");
  add_cell(table, (struct cell){CELL_TEXT, line, line, NAN});
}

/* People see a varied input in the campaign's unit. */
static double factor_of(const struct table *table) {
  return table->people && !table->broken && table->column_count ? table->columns[table->cell].factor : 1;
}

void table_integer(struct table *table, int64_t number) {
  char digits[32];
  if (factor_of(table) != 1) {
    table_real(table, (double)number);
    return;
  }
  snprintf(digits, sizeof digits, "%" PRId64, number);
  add_cell(table, (struct cell){CELL_NUMBER, digits, digits, (double)number});
}

static bool is_json(const struct table *table) {
  return table->format == TABLE_JSON || table->format == TABLE_JSON_LINES;
}

void table_boolean(struct table *table, bool value) {
  if (is_json(table))
    add_cell(table, (struct cell){CELL_NUMBER, value ? "true" : "false", "", NAN});
  else
    add_cell(table, (struct cell){CELL_TEXT, value ? "true" : "false", value ? "yes" : "no", NAN});
}

void table_real(struct table *table, double number) {
  table_fixed(table, number, -1);
}

void table_reals(struct table *table, size_t count, const double *numbers) {
  for (size_t i = 0; i < count; i++)
    table_real(table, numbers[i]);
}

void table_fixed(struct table *table, double number, int decimals) {
  if (isnan(number)) {
    table_missing(table);
    return;
  }
  if (isinf(number)) { /* JSON has no infinity. The largest double would be wrong, so it is a text there */
    const char *inf = number > 0 ? "inf" : "-inf", *infinity = number > 0 ? "Infinity" : "-Infinity";
    add_cell(table,
             (struct cell){is_json(table) ? CELL_TEXT : CELL_NUMBER, is_json(table) ? infinity : inf, inf, number});
    return;
  }
  number /= factor_of(table);
  char digits[40], shown[40] = "";
  for (int precision = 15; precision <= 17; precision++) {
    snprintf(digits, sizeof digits, "%.*g", precision, number);
    if (strtod(digits, NULL) == number)
      break;
  }
  const bool error = table->people && !table->broken && table->column_count && !table->asked &&
                     ends_in(table->columns[table->cell].name, "_resolution");
  if (decimals < 0)
    text_append(shown, sizeof shown, error ? "%.2g" : "%.5g", number);
  else
    text_append_fixed(shown, sizeof shown, number, decimals);
  if (strchr(shown, 'e'))
    text_powers(shown, sizeof shown);
  add_cell(table, (struct cell){CELL_NUMBER, digits, shown, number});
}

void table_interval(struct table *table, double value, double low, double high) {
  char shown[UNCERTAINTY_TEXT];
  if (!table->people || isnan(value)) {
    table_reals(table, table->people ? 1 : 3, (const double[]){value, low, high});
    return;
  }
  uncertainty_interval(value, low, high, shown);
  add_cell(table, (struct cell){CELL_NUMBER, "", shown, value});
}

static status verdict(const FILE *out, int write_error, struct error *error) {
  if (write_error == 0 || write_error == EPIPE)
    return STATUS_OK;
  return status_fail(error, STATUS_IO, "cannot write to %s: %s", out == stdout ? "standard output" : "the file",
                     strerror(write_error));
}

status table_flush(FILE *out, struct error *error) {
  errno = 0;
  if (fflush(out) == 0 && !ferror(out))
    return STATUS_OK;
  int code = failure_of(out, errno);
  clearerr(out);
  return verdict(out, code, error);
}

status table_end(struct table *table, struct error *error) {
  if (!table->broken) {
    if (table->people && (!table->laid_out || table->kept_count))
      print_kept(table);
    else if (table->rows == 0)
      header(table);
    if (table->format == TABLE_JSON)
      fputs(table->rows ? "\n]\n" : "]\n", table->out);
    errno = 0;
    (void)fflush(table->out); /* sets the stream's error flag */
    check_output(table);
    if (table->people && !table->broken && table->format != TABLE_BARE)
      tell_left_out(table);
  }
  table->ended = true;
  clearerr(table->out); /* reported here, once */
  if (table->out_of_memory)
    return status_fail(error, STATUS_MEMORY, "out of memory while printing a table");
  return verdict(table->out, table->write_error, error);
}

bool table_hides(const struct table *table, const char *name) {
  for (size_t c = 0; c < table->column_count; c++)
    if (strcmp(table->columns[c].name, name) == 0)
      return table->columns[c].left_out;
  return true;
}

void table_drop(struct table **variable) {
  struct table *table = *variable;
  if (!table)
    return;
  if (!table->ended && table->rows > 0)
    (void)table_end(table, NULL);
  drop_kept(table);
  for (size_t c = 0; c < table->column_count; c++) {
    free(table->columns[c].name);
    free(table->columns[c].head);
    free(table->columns[c].unit);
  }
  free(table->kept);
  free(table->columns);
  free(table);
}

status table_text_only(enum table_format format, const char *what, struct error *error) {
  if (!table_for_people(format))
    return status_fail(error, STATUS_USAGE, "%s is text, not a table: leave --%s out", what,
                       format == TABLE_CSV ? "csv" : "json");
  return STATUS_OK;
}

/* ---- the rows of a question, with the units of the store's columns ---- */

/* Bytes of a blob shown in the aligned table: an identity fits, a list of masses does not. */
enum { BLOB_SHOWN = 64 };

struct rows {
  struct table *table;
  size_t *doubtful; /* of a mean: its column _doubtful, behind its column _n; 0: none */
  bool *hidden;
  size_t n; /* the column of the number of runs */
};

/* The column of the mean whose number of doubtful runs is in column `i`; 0: none. */
static size_t mean_of(const struct answer *answer, size_t i) {
  const char *name = answer_name(answer, i), *end = strstr(name, "_doubtful");
  for (size_t k = 1; end && !end[strlen("_doubtful")] && k < i; k++)
    if (strncmp(answer_name(answer, k), name, (size_t)(end - name)) == 0 &&
        strcmp(answer_name(answer, k) + (end - name), "_mean") == 0)
      return k;
  return 0;
}

/* People see marks, not the columns that they come from. */
static void find_marks(struct rows *rows, const struct answer *answer) {
  for (size_t i = 1; i < answer_count(answer); i++) {
    const size_t mean = mean_of(answer, i);
    rows->doubtful[mean] = mean ? i : 0;
    if (mean)
      rows->hidden[i] = rows->hidden[i - 1] = true;
    if (strcmp(answer_name(answer, i), "n") == 0)
      rows->n = i;
    rows->hidden[i] |= strcmp(answer_name(answer, i), "doubts") == 0;
  }
}

/* A number of seconds since 1970: people see the date. */
static bool is_date(const struct table *table, const char *name) {
  return table->people && ends_in(name, "_at");
}

static void print_date(struct table *table, double seconds) {
  char text[32] = "";
  struct tm utc;
  const time_t time = fabs(seconds) < 1e11 ? (time_t)seconds : 0; /* a hostile store has any numbers */
  if (gmtime_r(&time, &utc))
    strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  table_text(table, text);
}

/* The headings, with the units of the store's columns: people see varied inputs in the campaign's units (`written`). */
static void name_columns(struct rows *rows, const struct answer *answer, bool written) {
  OWNED struct ask_column *units = NULL;
  struct ask_column axes[LIMITS_AXES_OF_TABLE];
  size_t unit_count = 0, axis_count = 0;
  if (rows->table->people) { /* on an error headings have no units, and values stay in SI */
    (void)ask_columns_units(answer->store, &units, &unit_count, NULL);
    (void)ask_columns_axes(answer->store, written, LIMITS_AXES_OF_TABLE, axes, &axis_count, NULL);
    if (written)
      find_marks(rows, answer);
  }
  for (size_t i = 0; i < answer_count(answer); i++) {
    const char *name = answer_name(answer, i), *unit = NULL;
    size_t axis = 0;
    while (axis < axis_count && strcmp(axes[axis].name, name) != 0)
      axis++;
    const size_t stem = strlen(name) -
                        (ends_in(name, "_mean") ? strlen("_mean") : 0); /* a mean has its result's unit */
    for (size_t k = 0; k < unit_count && !unit; k++)
      if (strcmp(units[k].name, name) == 0 || (strncmp(units[k].name, name, stem) == 0 && !units[k].name[stem]))
        unit = units[k].unit;
    if (axis < axis_count)
      table_key(rows->table, &axes[axis]);
    else if (!rows->hidden[i])
      table_column(rows->table, name, is_date(rows->table, name) ? NULL : unit);
  }
}

static void print_blob(struct rows *rows, const unsigned char *bytes, size_t size) {
  const size_t room = 2 * size + sizeof "(18446744073709551615 bytes)";
  OWNED char *text = malloc(room);
  if (text && rows->table->people && size > BLOB_SHOWN)
    snprintf(text, room, "(%zu bytes)", size);
  else if (text)
    text_hex(bytes, size, text);
  table_text(rows->table, text);
}

void table_value(struct table *table, const struct query_value *value) {
  switch (value->kind) {
  case QUERY_NULL: table_missing(table); break;
  case QUERY_INTEGER: table_integer(table, value->integer); break;
  case QUERY_REAL: table_real(table, value->real); break;
  case QUERY_TEXT: table_text(table, value->text); break;
  case QUERY_BLOB: break; /* print_blob */
  }
}

void table_field(struct table *table, const struct field *row, const void *object) {
  struct field_value value;
  field_get(row, object, &value);
  switch (row->kind) {
  case FIELD_REAL: table_real(table, value.number); break;
  case FIELD_INTEGER: table_integer(table, value.integer); break;
  case FIELD_BOOLEAN: table_boolean(table, value.number != 0); break;
  case FIELD_CHOICE:
  case FIELD_TEXT: table_text(table, value.text); break;
  }
}

static void print_row(struct rows *rows, const struct answer *answer) {
  for (size_t i = 0; i < answer_count(answer); i++) {
    const struct query_value value = answer_value(answer, i);
    if (rows->hidden[i])
      continue;
    if (rows->doubtful[i]) {
      const int64_t doubtful = answer_integer(answer, rows->doubtful[i]), n = answer_integer(answer, rows->n);
      /* unsigned: a hostile store has any numbers */
      const int64_t withheld = (int64_t)((uint64_t)n - (uint64_t)answer_integer(answer, rows->doubtful[i] - 1));
      table_rests_on(rows->table, &(struct ask_doubts){.runs = n, .doubtful = doubtful, .withheld = withheld});
    }
    if (value.kind == QUERY_BLOB)
      print_blob(rows, value.blob, value.size);
    else if (value.kind == QUERY_REAL && is_date(rows->table, answer_name(answer, i)))
      print_date(rows->table, value.real);
    else
      table_value(rows->table, &value);
  }
}

status table_answer(struct answer question, bool written, enum table_format format, FILE *out) {
  ANSWER answer = question;
  TRY(answer_status(&answer)); /* the question itself failed: no table */
  const size_t count = answer_count(&answer);
  TABLE table = table_new(format, out);
  OWNED size_t *doubtful = memory_small(count, sizeof *doubtful); /* at most COLUMNS_MAXIMUM */
  OWNED bool *hidden = memory_small(count, sizeof *hidden);
  table->asked = !written;
  struct rows rows = {.table = table, .doubtful = doubtful, .hidden = hidden};
  name_columns(&rows, &answer, written);
  while (!table_broken(table) && answer_next(&answer))
    print_row(&rows, &answer);
  TRY(answer_end(&answer));
  return table_end(table, answer.error);
}
