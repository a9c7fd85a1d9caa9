/* The program: finds the command, parses its options and runs it. Errors are printed, and the program exits, only here.
 * Nothing here starts a thread, MPI or HDF5: `clast run` forks its slots before any of them. */
#include <fcntl.h>
#include <signal.h>
#include <stdalign.h>
#include <unistd.h>

#include "analysis/analysis.h"
#include "campaign/commands/commands.h"
#include "campaign/farm/farm.h"
#include "campaign/terminal/words.h"
#include "engine/cpu_class.h"

static bool colour(void) {
  const char *no_colour = getenv("NO_COLOR"), *terminal = getenv("TERM");
  return !(no_colour && *no_colour) && terminal && strcmp(terminal, "dumb") != 0 && isatty(STDERR_FILENO);
}

/* Prints an error. A report on a document has its own "file:line:col: error:" lines and is printed as it is. */
static void print_error(struct error *error) {
  text_make_plain(error->message, "\n\t"); /* it may quote a file from an untrusted source */
  size_t line = strcspn(error->message, "\n");
  const char *located = strstr(error->message, ": error: ");
  bool report = located && (size_t)(located - error->message) < line;
  if (!report)
    fprintf(stderr, "clast: %serror:%s ", colour() ? "\033[1;31m" : "", colour() ? "\033[0m" : "");
  fprintf(stderr, "%s%s", error->message,
          *error->message && error->message[strlen(error->message) - 1] == '\n' ? "" : "\n");
}

static bool is_option(const char *word, const char *name, const char *letter) {
  return strcmp(word, name) == 0 || strcmp(word, letter) == 0;
}

/* argv[0] is the command's name, which follows the program's name. */
static status run_named(int argc, char **argv, struct error *error) {
  alignas(max_align_t) static char options[OPTION_STRUCT_MAXIMUM];
  const struct command *command = commands_find(argv[0], error);
  if (!command)
    return STATUS_USAGE;
  struct command_line line = {.argc = argc + 1, .argv = argv - 1};
  TRY(option_parse(command, argc, argv, options, &line, error));
  if (line.help) {
    help_one(command, stdout);
    return STATUS_OK;
  }
  const char *class = getenv("CLAST_CPU");
  if (class && *class && !cpu_class_known(class))
    return status_fail(error, STATUS_USAGE, "CLAST_CPU=%.64s is in the environment: expected baseline, v3 or v4",
                       class);
  TRY(option_claim_outputs(command, options, error));
  return commands_run(command, &line, error);
}

static status run_command_line(int argc, char **argv, struct error *error) {
  static char version[] = "version";
  if (argc < 2) {
    help_overview(stderr);
    return status_fail(error, STATUS_USAGE, "which command? The list is above");
  }
  if (is_option(argv[1], "--help", "-h")) {
    help_overview(stdout);
    return STATUS_OK;
  }
  if (is_option(argv[1], "--version", "-V"))
    argv[1] = version;
  if (argv[1][0] == '-')
    return status_fail(error, STATUS_USAGE, "expected a command before the option %.64s; `clast help` lists them",
                       argv[1]);
  return run_named(argc - 1, argv + 1, error);
}

/* Opens /dev/null for standard files that are closed. Otherwise the first file opened, the store, would get the number
 * of a standard file, and messages would be printed into it. Standard output is then open for reading only: a command
 * that prints its answer there fails. */
static void keep_standard_files(void) {
  for (int file = STDIN_FILENO; file <= STDERR_FILENO; file++)
    if (fcntl(file, F_GETFD) < 0)
      (void)open("/dev/null", file == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

int main(int argc, char **argv) {
  keep_standard_files();
  words_wrap_stderr(farm_under_mpi());
  signal(SIGPIPE, SIG_IGN); /* a closed pipe (`| head`) must not end the program in the middle of a commit */
  signal(SIGXFSZ, SIG_IGN); /* a file at its limit (`ulimit -f`) then gives a write error, like a full disk */
  analysis_init();
  struct error error = {.status = STATUS_OK};
  status code = run_command_line(argc, argv, &error);
  struct error output = {.status = STATUS_OK};
  status written = table_flush(stdout, &output);
  if (code != STATUS_OK && error.message[0])
    print_error(&error);
  if (written && (code == STATUS_OK || code == STATUS_FAILED_RUNS)) {
    print_error(&output);
    code = written;
  }
  return (int)code;
}
