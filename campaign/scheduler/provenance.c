/* Writes the facts as a JSON object. */
#include "campaign/scheduler/run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>

#include "campaign/build_facts.h"
#include "engine/cpu_class.h"

static void cpu_model(char *model, size_t size) {
  char line[512];
  snprintf(model, size, "unknown");
  FILE *file = fopen("/proc/cpuinfo", "r");
  while (file && fgets(line, sizeof line, file)) {
    char *colon = strchr(line, ':');
    if (strncmp(line, "model name", 10) != 0 || !colon)
      continue;
    line[strcspn(line, "\n")] = '\0';
    snprintf(model, size, "%s", colon + 1 + strspn(colon + 1, " \t"));
    break;
  }
  if (file)
    fclose(file);
}

static void member(FILE *out, const char *name, const char *value) {
  fprintf(out, ", \"%s\": ", name);
  text_json_string(value, out);
}

char *provenance_json(int ranks, int slots, int argc, char *const *argv) {
  char *text = NULL, model[256];
  struct utsname host;
  FILE *out = text_open(&text);
  cpu_model(model, sizeof model);
  fputs("{\"version\": ", out);
  text_json_string(BUILD_VERSION, out);
  member(out, "commit", BUILD_COMMIT);
  fprintf(out, ", \"dirty\": %s", BUILD_DIRTY ? "true" : "false");
  member(out, "commit_date", BUILD_DATE);
  member(out, "compiler", BUILD_COMPILER);
  member(out, "build_type", BUILD_TYPE);
  member(out, "flags", BUILD_FLAGS);
  fputs(", \"libraries\": {\"fyaml\": ", out);
  text_json_string(BUILD_FYAML, out);
  member(out, "hdf5", BUILD_HDF5);
  member(out, "sqlite", BUILD_SQLITE);
  member(out, "gsl", BUILD_GSL);
  member(out, "cairo", BUILD_CAIRO);
  member(out, "mpi", BUILD_MPI);
  fputs("}, \"results_versions\": {", out);
  for (size_t i = 0; i < engine_count(); i++)
    fprintf(out, "%s\"%s\": %d", i ? ", " : "", engine_at(i)->name, engine_at(i)->results_version);
  fputc('}', out);
  member(out, "cpu_model", model);
  member(out, "cpu_class", cpu_class_name(cpu_class_choose()));
  if (uname(&host) == 0) {
    member(out, "host", host.nodename);
    member(out, "system", host.release);
  }
  const char *threads = getenv("OMP_NUM_THREADS");
  member(out, "omp_num_threads", threads ? threads : "");
  fprintf(out, ", \"ranks\": %d, \"slots\": %d, \"command\": [", ranks, slots);
  for (int i = 0; argv && i < argc; i++) {
    fputs(i ? ", " : "", out);
    text_json_string(argv[i], out);
  }
  fputs("]}", out);
  return text_close(out, &text);
}

void provenance_other_build(const char *version, const char *commit, const char *compiler,
                            char text[PROVENANCE_BUILD_SIZE]) {
  const char *here = BUILD_DIRTY ? BUILD_COMMIT " with local changes" : BUILD_COMMIT;
  const bool same = strcmp(version, BUILD_VERSION) == 0 && strcmp(commit, here) == 0 &&
                    strcmp(compiler, BUILD_COMPILER) == 0;
  text[0] = '\0';
  if (!same && *version)
    snprintf(text, PROVENANCE_BUILD_SIZE, "clast %s, commit %s, %s", version, *commit ? commit : "unknown",
             *compiler ? compiler : "unknown compiler");
  text_make_plain(text, ""); /* a store from an untrusted source has any text here */
}
