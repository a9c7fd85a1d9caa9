/* The manual page, made from the command tables: every command, option, example and exit code as in --help. Only NAME,
 * ENVIRONMENT and FILES have texts of their own. */
#include "campaign/terminal/manual.h"

#include <ctype.h>
#include <string.h>

#include "campaign/build_facts.h"

struct entry {
  const char *name, *meaning;
};

static const struct entry environment[] = {
    {"CLAST_CPU", "baseline, v3 (AVX2, FMA) or v4 (AVX-512): class of CPU to compute for. Results have the same bits "
                  "within a class.\nDefault: the best class that the machine has, which is also used instead of a "
                  "class that it does not have."},
    {"NO_COLOR", "If it is set and not empty, nothing is coloured."},
    {"TERM", "If it is unset or dumb, nothing is coloured, and progress is plain lines instead of a bar."},
};

static const struct entry files[] = {
    {"CAMPAIGN.yaml",
     "A campaign: what varies, how many seeds, which store. `clast schema campaign` prints its JSON Schema."},
    {"SCENE.yaml",
     "A scene: one simulation, for every command that takes a SCENE. `clast scenes NAME` prints one to start from."},
    {"STORE.db", "The store: every result in one SQLite 3 file, made by `clast run`. While it is written, "
                 "`STORE.db-wal` and\n`STORE.db-shm` belong to it."},
    {"STORE-fields/", "HDF5 files with the fields of the runs that the campaign keeps."},
};

/* Escapes, because roff gives these characters a meaning, or a UTF-8 terminal shows others that cannot be pasted into a
 * shell. */
static void print_escaped(char c, FILE *out) {
  static const char *const escapes[128] = {['\\'] = "\\(rs", ['-'] = "\\-",   ['\''] = "\\(aq", ['"'] = "\\(dq",
                                           ['`'] = "\\(ga",  ['^'] = "\\(ha", ['~'] = "\\(ti"};
  const char *escape = (unsigned char)c < 128 ? escapes[(unsigned char)c] : NULL;
  if (escape)
    fputs(escape, out);
  else
    fputc(c, out);
}

/* roff reads a line that begins with a full stop as a command. */
static void begin_line(const char *text, FILE *out) {
  if (*text == '.')
    fputs("\\&", out);
}

/* Prints text unchanged, line by line. */
static void print_literal(const char *text, FILE *out) {
  begin_line(text, out);
  for (const char *c = text; *c; c++) {
    print_escaped(*c, out);
    if (*c == '\n')
      begin_line(c + 1, out);
  }
}

static bool is_within_word(const char *text, const char *c) {
  return c > text && isalpha((unsigned char)c[-1]) && isalpha((unsigned char)c[1]);
}

/* Text in backquotes is bold, a hyphen between letters stays one, and lines are joined unless indented. */
static void print_prose(const char *text, FILE *out) {
  bool code = false, indented = false;
  begin_line(text, out);
  for (const char *c = text; *c; c++) {
    if (*c == '\n') {
      indented = c[1] == ' ';
      fputc(indented ? '\n' : ' ', out);
      begin_line(c + 1, out);
    } else if (*c == '`') {
      code = !code;
      fputs(code ? "\\fB" : "\\fR", out);
    } else if (*c == '-' && !code && !indented && is_within_word(text, c)) {
      fputc('-', out);
    } else {
      print_escaped(*c, out);
    }
  }
}

static void print_entry(const char *name, const char *meaning, FILE *out) {
  fputs(".TP 15\n\\fB", out);
  print_literal(name, out);
  fputs("\\fR\n", out);
  print_prose(meaning, out);
  fputc('\n', out);
}

static void print_entries(const char *section, size_t count, const struct entry *entries, FILE *out) {
  fprintf(out, ".SH %s\n", section);
  for (size_t i = 0; i < count; i++)
    print_entry(entries[i].name, entries[i].meaning, out);
}

static void print_examples(const char *lines, FILE *out) {
  fputs(".RS 4\n.EX\n", out);
  print_literal(lines, out);
  fputs("\n.EE\n.RE\n", out);
}

static void print_option(const struct option_row *row, FILE *out) {
  fputs(".TP 15\n", out);
  if (row->letter)
    fprintf(out, "\\fB\\-%c\\fR, ", row->letter);
  fputs("\\fB\\-\\-", out);
  print_literal(row->name, out);
  fputs(row->argument ? "\\fR \\fI" : "", out);
  print_literal(row->argument ? row->argument : "", out);
  fputs("\\fR\n", out);
  print_prose(row->doc, out);
  if (row->initial && *row->initial) {
    fputs(" (default ", out);
    print_literal(row->initial, out);
    fputc(')', out);
  }
  fputc('\n', out);
}

static void print_command(const struct command *command, FILE *out) {
  fprintf(out, ".SS clast %s%s%s", command->name, command->option_count ? " [OPTIONS]" : "",
          *command->arguments ? " " : "");
  print_literal(command->arguments, out);
  fputc('\n', out);
  print_prose(command->doc, out);
  fputc('\n', out);
  for (size_t i = 0; i < command->option_count; i++)
    print_option(&command->options[i], out);
  fputs(".PP\nExamples:\n", out);
  print_examples(command->examples, out);
}

void manual_write(const struct manual_texts *texts, size_t count, const struct command *const *commands, FILE *out) {
  fputs(".\\\" Made by `clast help --man` from the tables of the commands: change those.\n"
        ".TH CLAST 1 " BUILD_DATE " \"clast " BUILD_VERSION "\" \"User Commands\"\n"
        ".nr HY 0\n.ad l\n" /* names are not hyphenated, so that they can be searched for */
        ".SH NAME\nclast \\- ensembles of brittle-fragmentation simulations\n"
        ".SH SYNOPSIS\n\\fBclast\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR] ...\n"
        ".br\n\\fBclast\\fR \\fICOMMAND\\fR \\fB\\-\\-help\\fR\n.br\n\\fBclast \\-\\-version\\fR\n"
        ".SH DESCRIPTION\n",
        out);
  print_prose(texts->purpose, out);
  fputs("\n.PP\nFirst steps:\n", out);
  print_examples(texts->first_steps, out);
  fputs(".PP\n", out);
  print_prose(texts->streams, out);
  fputs("\n.SH COMMANDS\n.PD 0\n", out);
  for (size_t i = 0; i < count; i++)
    print_entry(commands[i]->name, commands[i]->summary, out);
  fputs(".PD\n", out);
  const char *group = "";
  for (size_t i = 0; i < count; i++) {
    const struct command *command = commands[i];
    if (strcmp(command->group, group) != 0) {
      fputs(".SH ", out);
      for (const char *c = command->group; *c; c++)
        fputc(toupper((unsigned char)*c), out);
      fputc('\n', out);
    }
    group = command->group;
    print_command(command, out);
  }
#define EXIT_ENTRY(constant, value, meaning) {#value, meaning},
  static const struct entry exits[] = {STATUS_LIST(EXIT_ENTRY)};
  print_entries("EXIT STATUS", sizeof exits / sizeof exits[0], exits, out);
  print_entries("ENVIRONMENT", sizeof environment / sizeof environment[0], environment, out);
  print_entries("FILES", sizeof files / sizeof files[0], files, out);
  fputs(".SH SEE ALSO\n\\fBsqlite3\\fR(1), \\fBmpirun\\fR(1)\n", out);
}
