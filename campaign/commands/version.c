/* `clast version`, also as `clast --version`: sources and build of this program, and the machine that it runs on. */
#include <jansson.h>

#include "campaign/build_facts.h"
#include "campaign/commands/commands.h"
#include "engine/cpu_class.h"

struct options {
  bool json;
};

static status run(const struct command_line *line, struct error *error) {
  const struct {
    const char *name, *value;
  } facts[] = {
      {"version", BUILD_VERSION},  {"commit", BUILD_DIRTY ? BUILD_COMMIT " with local changes" : BUILD_COMMIT},
      {"commit_date", BUILD_DATE}, {"compiler", BUILD_COMPILER},
      {"flags", BUILD_FLAGS},      {"MPI", BUILD_MPI},
      {"SQLite", BUILD_SQLITE},    {"HDF5", BUILD_HDF5},
      {"GSL", BUILD_GSL},          {"cairo", BUILD_CAIRO},
      {"libfyaml", BUILD_FYAML},   {"cpu_class", cpu_class_name(cpu_class_choose())},
  };
  const size_t facts_count = sizeof facts / sizeof facts[0];
  if (((const struct options *)line->options)->json) {
    json_auto_t *object = json_object();
    for (size_t i = 0; i < facts_count; i++)
      json_object_set_new(object, facts[i].name, json_string(facts[i].value));
    const bool all = json_object_size(object) == facts_count && json_dumpf(object, stdout, JSON_INDENT(1)) == 0;
    putchar('\n');
    return all ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for the facts");
  }
  printf("clast %s\n", facts[0].value);
  for (size_t i = 1; i < facts_count; i++)
    printf("  %-12s %s\n", facts[i].name, facts[i].value);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_FLAG("json", 0, struct options, json),
};

COMMAND(version, "about clast", "", COMMAND_OPTIONS(struct options, rows), .run = run);
