/* `clast report STORE...`: a page for a browser, in one file. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "campaign/commands/commands.h"
#include "campaign/report/report_make.h"
#include "schemas/file.h"
#include "schemas/limits.h"

enum { EVERY_MOST = 86400 };

struct options {
  const char *output;
  bool watch;
  int64_t every;
};

/* demo.html in the current folder for the store folder/demo.db. */
static void name_page(const char *store, char *name, size_t size) {
  const char *slash = strrchr(store, '/'), *base = slash ? slash + 1 : store;
  const char *dot = strrchr(base, '.');
  snprintf(name, size, "%.*s.html", (int)(dot && dot > base ? (size_t)(dot - base) : strlen(base)), base);
}

/* Makes the page again and again while a campaign writes one of the stores, and once more at its end. */
static status watch(struct report_choice *choice, int64_t every, size_t *size, struct error *error) {
  bool running;
  do {
    running = report_make_running(choice);
    choice->refresh = running ? every : 0;
    TRY(report_make(choice, size, error));
    if (running) {
      fprintf(stderr, "%s written; again in %lld s, while the campaign runs\n", choice->output, (long long)every);
      sleep((unsigned)every);
    }
  } while (running);
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char name[LIMITS_PATH];
  size_t size = 0;
  if (line->count > REPORT_STORES)
    return status_fail(error, STATUS_USAGE, "a page shows at most %d stores", REPORT_STORES);
  name_page(line->arguments[0], name, sizeof name);
  struct report_choice choice = {.count = line->count,
                                 .stores = line->arguments,
                                 .output = options->output ? options->output : name};
  if (!options->output)
    TRY(file_claim(name, "page", error));
  const status code = options->watch ? watch(&choice, options->every, &size, error)
                                     : report_make(&choice, &size, error);
  if (code == STATUS_OK)
    fprintf(stderr, "%s written (%.2f MB); open it in a browser\n", choice.output, 1e-6 * (double)size);
  return code;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_OUTPUT(OPTION_OUTPUT, "output", 'o', "PAGE.html", struct options, output),
    OPTION_ROW_FLAG("watch", 0, struct options, watch),
    OPTION_ROW_INTEGER("every", 0, "S", struct options, every, 1, EVERY_MOST, "10"),
};

COMMAND(report, "results", "STORE...", COMMAND_OPTIONS(struct options, option_rows), .run = run);
