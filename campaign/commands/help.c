/* `clast help [COMMAND]`: the list of commands, one command's help, and the manual page, from the command tables. */
#include <ctype.h>

#include "campaign/build_facts.h"
#include "campaign/commands/commands.h"

#define EXIT_CODE(constant, value, meaning) constant,
static const status exits[] = {STATUS_LIST(EXIT_CODE)};
enum { EXITS = sizeof exits / sizeof exits[0] };

enum { COLUMN = 30, WIDTH = 96 }; /* where the meaning of an option begins, and where it ends */

static const char purpose[] = "Runs ensembles of fragmentation simulations and keeps every result in one SQLite file.";
static const char
    first_steps[] = "clast scenes                                   # what can be broken\n"
                    "clast simulate disc-explosion --picture a.png  # one run, drawn\n"
                    "clast run campaign.yaml                        # many runs; the same command resumes";
static const char streams[] = "Data goes to stdout, remarks and errors to stderr.";

struct options {
  bool man;
};

/* Prints lines, indented by two spaces. */
static void print_lines(const char *line, int length, FILE *out) {
  for (const char *end = line + length; line < end;) {
    const char *next = memchr(line, '\n', (size_t)(end - line));
    fprintf(out, "  %.*s\n", (int)((next ? next : end) - line), line);
    line = next ? next + 1 : end;
  }
}

/* Prints paragraphs in lines of WIDTH; indented lines and empty ones stay as they are. */
static void print_paragraphs(const char *text, int length, FILE *out) {
  char paragraph[4096] = "";
  for (const char *end = text + length; text < end;) {
    const char *next = memchr(text, '\n', (size_t)(end - text));
    const int line = (int)((next ? next : end) - text);
    const bool plain = line > 0 && *text != ' ';
    if (plain)
      text_append(paragraph, sizeof paragraph, "%.*s\n", line, text);
    else
      fprintf(out, "%.*s\n", line, text);
    text += line + 1;
    if (!plain || (text < end && *text != '\n' && *text != ' '))
      continue;
    text_wrap(paragraph, 0, 0, WIDTH, out);
    *paragraph = 0;
  }
}

static void print_row(char letter, const char *name, const char *argument, const char *doc, const char *initial,
                      FILE *out) {
  const bool has_default = initial && *initial;
  char shown[160], text[OPTION_DOC + 100], start[4] = "   ";
  if (letter)
    snprintf(start, sizeof start, "-%c,", letter);
  snprintf(shown, sizeof shown, "  %s --%s%s%s", start, name, argument ? " " : "", argument ? argument : "");
  snprintf(text, sizeof text, "%s%s%s%s", doc, has_default ? " (default " : "", has_default ? initial : "",
           has_default ? ")" : "");
  size_t at = strlen(shown);
  fputs(shown, out);
  if (at + 2 > COLUMN) {
    fputc('\n', out);
    at = 0;
  }
  text_wrap(text, at, COLUMN, WIDTH, out);
}

void help_one(const struct command *command, FILE *out) {
  int length;
  const struct option_row *row;
  const char *options = option_row(command, 0) ? "[OPTIONS]" : "", *doc = option_part(command, OPTION_ABOUT, &length);
  fprintf(out, "usage: clast %s %s%s%s\n\n", command->name, options, *options && *command->arguments ? " " : "",
          command->arguments);
  print_paragraphs(doc, length, out);
  fputs("\noptions:\n", out);
  for (size_t i = 0; (row = option_row(command, i)); i++) {
    char meaning[OPTION_DOC];
    option_doc(command, row, meaning);
    print_row(row->letter, row->name, row->argument, meaning, row->initial, out);
  }
  print_row('h', "help", NULL, "Print this text.", NULL, out);
  fputs("\nexamples:\n", out);
  const char *examples = option_part(command, OPTION_EXAMPLES, &length);
  print_lines(examples, length, out);
  fputs("\nexit codes:\n", out);
  for (size_t i = 0; i < EXITS; i++)
    if (command->has_runs || (exits[i] != STATUS_FAILED_RUNS && exits[i] != STATUS_STOPPED))
      fprintf(out, "  %2d  %s\n", (int)exits[i], status_meaning(exits[i]));
}

void help_overview(FILE *out) {
  fprintf(out, "usage: clast COMMAND [OPTIONS] ...\n\n%s\n\nfirst steps:\n", purpose);
  print_lines(first_steps, (int)strlen(first_steps), out);
  const char *group = "";
  for (size_t i = 0; i < commands_count(); i++) {
    const struct command *command = commands_all()[i];
    int length;
    const char *summary = option_part(command, OPTION_SUMMARY, &length);
    if (strcmp(command->group, group) != 0)
      fprintf(out, "\n%s:\n", command->group);
    group = command->group;
    fprintf(out, "  %-12s %.*s\n", command->name, length, summary);
  }
  fprintf(out, "\n`clast COMMAND --help` tells more, with examples. %s\n", streams);
}

/* ---- the manual page clast(1) in man(7) macros, for groff and mandoc ---- */

/* manual.man, embedded by CMakeLists.txt: what is not in the tables. What is stands at the mark. */
extern const char manual_text[];
static const char manual_mark[] = "@TABLES@\n";

/* Writes text for roff. Some characters are escaped, because roff gives them a meaning, or a UTF-8 terminal shows
 * others that cannot be pasted into a shell. In prose, text in backquotes is bold, a hyphen between letters stays one,
 * and lines are joined unless indented. */
static void print_roff(const char *text, int length, bool prose, FILE *out) {
  static const char *const escapes[128] = {['\\'] = "\\(rs", ['-'] = "\\-",   ['\''] = "\\(aq", ['"'] = "\\(dq",
                                           ['`'] = "\\(ga",  ['^'] = "\\(ha", ['~'] = "\\(ti"};
  bool code = false, indented = false, begins = true;
  for (const char *c = text; c < text + length; c++) {
    if (begins && *c == '.')
      fputs("\\&", out); /* roff reads a line that begins with a full stop as a command */
    begins = *c == '\n';
    if (prose && *c == '\n') {
      indented = c[1] == ' ';
      fputc(indented ? '\n' : ' ', out);
    } else if (prose && *c == '`') {
      code = !code;
      fputs(code ? "\\fB" : "\\fR", out);
    } else if (prose && *c == '-' && !code && !indented && c > text && isalpha((unsigned char)c[-1]) &&
               isalpha((unsigned char)c[1])) {
      fputc('-', out);
    } else if ((unsigned char)*c < 128 && escapes[(unsigned char)*c]) {
      fputs(escapes[(unsigned char)*c], out);
    } else {
      fputc(*c, out);
    }
  }
}

static void print_word(const char *before, const char *word, FILE *out) {
  fputs(before, out);
  print_roff(word, (int)strlen(word), false, out);
}

static void print_prose(const char *text, FILE *out) {
  print_roff(text, (int)strlen(text), true, out);
}

static void print_examples(const char *lines, int length, FILE *out) {
  fputs(".RS 4\n.EX\n", out);
  print_roff(lines, length, false, out);
  fputs("\n.EE\n.RE\n", out);
}

static void print_option(const struct command *command, const struct option_row *row, FILE *out) {
  char doc[OPTION_DOC];
  option_doc(command, row, doc);
  fputs(".TP 15\n", out);
  if (row->letter)
    fprintf(out, "\\fB\\-%c\\fR, ", row->letter);
  print_word("\\fB\\-\\-", row->name, out);
  print_word(row->argument ? "\\fR \\fI" : "", row->argument ? row->argument : "", out);
  fputs("\\fR\n", out);
  print_prose(doc, out);
  if (row->initial && *row->initial) {
    print_word(" (default ", row->initial, out);
    fputc(')', out);
  }
  fputc('\n', out);
}

static void print_command(const struct command *command, FILE *out) {
  const struct option_row *row;
  int length;
  fprintf(out, ".SS clast %s%s%s", command->name, option_row(command, 0) ? " [OPTIONS]" : "",
          *command->arguments ? " " : "");
  print_word("", command->arguments, out);
  fputc('\n', out);
  const char *doc = option_part(command, OPTION_ABOUT, &length);
  print_roff(doc, length, true, out);
  fputc('\n', out);
  for (size_t k = 0; (row = option_row(command, k)); k++)
    print_option(command, row, out);
  fputs(".PP\nExamples:\n", out);
  const char *examples = option_part(command, OPTION_EXAMPLES, &length);
  print_examples(examples, length, out);
}

static void print_tables(FILE *out) {
  print_prose(purpose, out);
  fputs("\n.PP\nFirst steps:\n", out);
  print_examples(first_steps, (int)strlen(first_steps), out);
  fputs(".PP\n", out);
  print_prose(streams, out);
  fputs("\n.SH COMMANDS\n.PD 0\n", out);
  for (size_t i = 0; i < commands_count(); i++) {
    int length;
    const char *summary = option_part(commands_all()[i], OPTION_SUMMARY, &length);
    fprintf(out, ".TP 15\n\\fB%s\\fR\n", commands_all()[i]->name);
    print_roff(summary, length, true, out);
    fputc('\n', out);
  }
  fputs(".PD\n", out);
  const char *group = "";
  for (size_t i = 0; i < commands_count(); i++) {
    const struct command *command = commands_all()[i];
    if (strcmp(command->group, group) != 0) {
      fputs(".SH ", out);
      for (const char *c = command->group; *c; c++)
        fputc(toupper((unsigned char)*c), out);
      fputc('\n', out);
    }
    group = command->group;
    print_command(command, out);
  }
  fputs(".SH EXIT STATUS\n", out);
  for (size_t i = 0; i < EXITS; i++) {
    fprintf(out, ".TP 15\n\\fB%d\\fR\n", (int)exits[i]);
    print_prose(status_meaning(exits[i]), out);
    fputc('\n', out);
  }
}

static void print_manual(FILE *out) {
  const char *mark = strstr(manual_text, manual_mark);
  fputs(".\\\" Made by `clast help --man` from the tables of the commands: change those.\n"
        ".TH CLAST 1 " BUILD_DATE " \"clast " BUILD_VERSION "\" \"User Commands\"\n",
        out);
  fwrite(manual_text, 1, (size_t)(mark - manual_text), out);
  print_tables(out);
  fputs(mark + strlen(manual_mark), out);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (options->man && line->count > 0)
    return status_fail(error, STATUS_USAGE, "--man prints the manual page of all commands; leave out \"%.64s\"",
                       line->arguments[0]);
  const struct command *command = line->count ? commands_find(line->arguments[0], error) : NULL;
  if (line->count && !command)
    return STATUS_USAGE;
  if (options->man)
    print_manual(stdout);
  else if (command)
    help_one(command, stdout);
  else
    help_overview(stdout);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_FLAG("man", 0, struct options, man),
};

COMMAND(help, "about clast", "[COMMAND]", COMMAND_OPTIONS(struct options, rows), .run = run);
