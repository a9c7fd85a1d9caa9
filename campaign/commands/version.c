/* `clast version`, also as `clast --version`: sources and build of this program, and the machine that it runs on. */
#include "campaign/build_facts.h"
#include "campaign/commands/commands.h"
#include "campaign/terminal/table.h"
#include "schemas/text.h"

struct options {
  bool json;
};

struct fact {
  const char *name, *value;
};

static void print_json(size_t count, const struct fact *facts) {
  fputc('{', stdout);
  for (size_t i = 0; i < count; i++) {
    fputs(i ? ",\n " : "\n ", stdout);
    text_json_string(facts[i].name, stdout);
    fputs(": ", stdout);
    text_json_string(facts[i].value, stdout);
  }
  fputs("\n}\n", stdout);
}

static status run(const struct command_line *line, struct error *error) {
  (void)error;
  const struct fact facts[] = {
      {"version", BUILD_VERSION},  {"commit", BUILD_DIRTY ? BUILD_COMMIT " with local changes" : BUILD_COMMIT},
      {"commit_date", BUILD_DATE}, {"compiler", BUILD_COMPILER},
      {"flags", BUILD_FLAGS},      {"MPI", BUILD_MPI},
      {"SQLite", BUILD_SQLITE},    {"HDF5", BUILD_HDF5},
      {"GSL", BUILD_GSL},          {"cairo", BUILD_CAIRO},
      {"libfyaml", BUILD_FYAML},
  };
  size_t facts_count = sizeof facts / sizeof facts[0];
  if (((const struct options *)line->options)->json) {
    print_json(facts_count, facts);
    return STATUS_OK;
  }
  printf("clast %s\n", facts[0].value);
  for (size_t i = 1; i < facts_count; i++)
    printf("  %-12s %s\n", facts[i].name, facts[i].value);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_FLAG("json", 0, struct options, json),
};

const struct command version_command = {
    .name = "version",
    .group = "about clast",
    .arguments = "",
    .text = version_text,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
