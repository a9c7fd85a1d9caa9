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

/* ---- the manual page clast(1): the help within man(7) macros, for groff and mandoc ---- */

/* manual.man, embedded by CMakeLists.txt: what is not in the help. What is stands at the mark. */
extern const char manual_text[];
static const char manual_mark[] = "@HELP@\n";

/* Text as it stands. roff gives some characters a meaning, or a UTF-8 terminal shows others that cannot be pasted into
 * a shell: they are escaped. */
static void print_text(const char *text, FILE *out) {
  static const char *const escapes[128] = {['\\'] = "\\(rs", ['-'] = "\\-",   ['\''] = "\\(aq", ['"'] = "\\(dq",
                                           ['`'] = "\\(ga",  ['^'] = "\\(ha", ['~'] = "\\(ti"};
  fputs(".EX\n", out);
  for (const char *c = text; *c; c++) {
    const char plain[] = {*c, '\0'}, *escape = (unsigned char)*c < 128 ? escapes[(unsigned char)*c] : NULL;
    const bool begins = c == text || c[-1] == '\n';
    fputs(begins && *c == '.' ? "\\&" : "", out); /* roff reads a line that begins with a full stop as a command */
    fputs(escape ? escape : plain, out);
  }
  fputs(".EE\n", out);
}

/* The list of commands and the help of each. */
static void print_manual(FILE *out) {
  const char *mark = strstr(manual_text, manual_mark);
  fputs(".\\\" Made by `clast help --man` from the texts of the commands: change those.\n"
        ".TH CLAST 1 " BUILD_DATE " \"clast " BUILD_VERSION "\" \"User Commands\"\n",
        out);
  fwrite(manual_text, 1, (size_t)(mark - manual_text), out);
  for (size_t i = 0; i <= commands_count(); i++) {
    const struct command *command = i ? commands_all()[i - 1] : NULL;
    OWNED char *text = NULL;
    FILE *help = text_open(&text);
    if (command) {
      help_one(command, help);
      fprintf(out, ".SS clast %s\n", command->name);
    } else {
      help_overview(help);
    }
    print_text(text_close_small(help, &text), out);
  }
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
