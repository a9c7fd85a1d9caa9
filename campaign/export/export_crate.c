/* Writes the files of a crate and their metadata (JSON-LD).
 *
 * The graph has the crate; the program, one entity for each version that computed; an action for each session, from the
 * campaign's file to the store; and one for this export, from the store to the tables. */
#include "campaign/export/export.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "campaign/build_facts.h"
#include "db/ask/campaign.h"
#include "schemas/file.h"
#include "schemas/text.h"

#define SPECIFICATION "https://w3id.org/ro/crate/1.1"
#define PROFILE       "https://w3id.org/ro/wfrun/process/0.5"
#define STORE         "store.db"
#define METADATA      "ro-crate-metadata.json"
enum { PATH_SIZE = 4096, PROGRAMS = 64 };

struct crate {
  const struct export_crate_options *options;
  FILE *graph, *parts, *actions; /* text of the entities; of the lists hasPart and mentions */
  char *graph_text, *parts_text, *actions_text;
  size_t graph_size, parts_size, actions_size;
  char programs[PROGRAMS][96]; /* ids of programs that were written */
  size_t program_count;
};

static bool join(char path[PATH_SIZE], const char *folder, const char *name) {
  return snprintf(path, PATH_SIZE, "%s/%s", folder, name) < PATH_SIZE;
}

/* ---- JSON ---- */

/* Begins an entity of the graph; the caller adds members and closes it with "}". */
static void entity(struct crate *crate, const char *id, const char *type) {
  fputs(",\n  {\"@id\": ", crate->graph);
  text_json_string(id, crate->graph);
  fputs(", \"@type\": ", crate->graph);
  text_json_string(type, crate->graph);
}

static void member(struct crate *crate, const char *name, const char *text) {
  fprintf(crate->graph, ", \"%s\": ", name);
  text_json_string(text, crate->graph);
}

static void link_to(struct crate *crate, const char *name, const char *id) {
  fprintf(crate->graph, ", \"%s\": {\"@id\": ", name);
  text_json_string(id, crate->graph);
  fputc('}', crate->graph);
}

static void end(struct crate *crate) {
  fputc('}', crate->graph);
}

/* Adds the "@id" of an entity to a list. */
static void list(FILE *out, const char *id) {
  fputs(ftell(out) > 0 ? ", {\"@id\": " : "{\"@id\": ", out);
  text_json_string(id, out);
  fputc('}', out);
}

static void file_entity(struct crate *crate, const char *name, const char *format, const char *description) {
  char path[PATH_SIZE], size[32];
  struct stat facts;
  entity(crate, name, "File");
  member(crate, "name", name);
  member(crate, "encodingFormat", format);
  member(crate, "description", description);
  if (join(path, crate->options->folder, name) && stat(path, &facts) == 0) {
    snprintf(size, sizeof size, "%lld", (long long)facts.st_size);
    member(crate, "contentSize", size);
  }
  end(crate);
  list(crate->parts, name);
}

/* Writes the program's entity, once for each version, and returns its id. */
static const char *program(struct crate *crate, const char *version, const char *commit) {
  char id[96];
  snprintf(id, sizeof id, "#clast-%.32s-%.40s", version, commit);
  for (size_t i = 0; i < crate->program_count; i++)
    if (strcmp(crate->programs[i], id) == 0)
      return crate->programs[i];
  const size_t place = crate->program_count < PROGRAMS ? crate->program_count++ : PROGRAMS - 1;
  memcpy(crate->programs[place], id, sizeof id);
  entity(crate, id, "SoftwareApplication");
  member(crate, "name", "clast");
  member(crate, "softwareVersion", version);
  member(crate, "description", "Ensembles of simulations of brittle fragmentation");
  member(crate, "identifier", commit);
  end(crate);
  return crate->programs[place];
}

/* ---- from the store ---- */

/* campaign, name, document */
static status add_campaign(struct crate *crate, const struct answer *row, struct error *error) {
  char name[64], path[PATH_SIZE], description[512];
  snprintf(name, sizeof name, "campaign-%" PRId64 ".yaml", answer_integer(row, 0));
  if (!join(path, crate->options->folder, name))
    return status_fail(error, STATUS_USAGE, "the folder's name is too long");
  TRY(file_write(path, "campaign", answer_text(row, 2), strlen(answer_text(row, 2)), error));
  snprintf(description, sizeof description, "The campaign \"%.400s\" as it was read", answer_text(row, 1));
  file_entity(crate, name, "application/yaml", description);
  return STATUS_OK;
}

/* session, campaign, started, ended, outcome, version, commit, command */
static void add_session(struct crate *crate, const struct answer *row) {
  char id[64], campaign[64], name[96];
  snprintf(id, sizeof id, "#session-%" PRId64, answer_integer(row, 0));
  snprintf(name, sizeof name, "Session %" PRId64 " of the store", answer_integer(row, 0));
  snprintf(campaign, sizeof campaign, "campaign-%" PRId64 ".yaml", answer_integer(row, 1));
  const char *tool = program(crate, answer_text(row, 5), answer_text(row, 6));
  entity(crate, id, "CreateAction");
  member(crate, "name", name);
  member(crate, "description", answer_text(row, 7));
  member(crate, "startTime", answer_text(row, 2));
  if (*answer_text(row, 3))
    member(crate, "endTime", answer_text(row, 3));
  link_to(crate, "instrument", tool);
  if (answer_value(row, 1).kind == QUERY_INTEGER)
    link_to(crate, "object", campaign);
  link_to(crate, "result", STORE);
  if (crate->options->author)
    link_to(crate, "agent", "#author");
  const bool failed = strcmp(answer_text(row, 4), "failed") == 0;
  link_to(crate, "actionStatus",
          failed ? "http://schema.org/FailedActionStatus" : "http://schema.org/CompletedActionStatus");
  end(crate);
  list(crate->actions, id);
}

/* ---- the crate ---- */

static void now_text(char text[32]) {
  const time_t now = time(NULL);
  struct tm utc;
  strftime(text, 32, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
}

static status tables(struct crate *crate, struct store *store, struct error *error) {
  static const char *const described[][2] = {
      {"runs.csv", "A row for each run: inputs, every result, state, times. SI units; column_doc.csv tells them"},
      {"points.csv", "A row for each point: inputs, and means over its runs with 95 % intervals"},
      {"spectra.csv", "A row for each point and bin of fragment mass"},
      {"estimates.csv", "A row for each exponent of the fragment mass distribution"},
      {"column_doc.csv", "Meaning and unit of every column of the store and of these tables"},
  };
  const size_t count = sizeof described / sizeof described[0];
  char date[32];
  const status code = export_files_folder(store, crate->options->folder, error);
  if (code)
    return code;
  for (size_t i = 0; i < count; i++)
    file_entity(crate, described[i][0], "text/csv", described[i][1]);
  const char *tool = program(crate, BUILD_VERSION, BUILD_COMMIT);
  now_text(date);
  entity(crate, "#export", "CreateAction");
  member(crate, "name", "Export of the tables");
  member(crate, "description", "clast export --crate");
  member(crate, "endTime", date);
  link_to(crate, "instrument", tool);
  link_to(crate, "object", STORE);
  fputs(", \"result\": [", crate->graph);
  for (size_t i = 0; i < count; i++) {
    fputs(i ? ", {\"@id\": " : "{\"@id\": ", crate->graph);
    text_json_string(described[i][0], crate->graph);
    fputc('}', crate->graph);
  }
  fputc(']', crate->graph);
  end(crate);
  list(crate->actions, "#export");
  return STATUS_OK;
}

/* Writes author and licence. */
static void people(struct crate *crate) {
  const char *author = crate->options->author, *license = crate->options->license;
  if (author) {
    entity(crate, "#author", "Person");
    member(crate, "name", author);
    end(crate);
  }
  if (license && strstr(license, "://")) {
    entity(crate, license, "CreativeWork");
    member(crate, "name", license);
    member(crate, "description", "The licence of this data set");
    end(crate);
  }
}

/* Writes the metadata, after all other files. */
static status finish(struct crate *crate, const char *title, struct error *error) {
  const char *license = crate->options->license;
  char path[PATH_SIZE], date[32];
  now_text(date);
  if (!join(path, crate->options->folder, METADATA))
    return status_fail(error, STATUS_USAGE, "the folder's name is too long");
  struct file_output file;
  TRY(file_begin(&file, path, "metadata", error));
  FILE *const out = file.out;
  fputs("{\"@context\": [\"" SPECIFICATION "/context\", \"https://w3id.org/ro/terms/workflow-run/context\"],\n"
        " \"@graph\": [\n  {\"@id\": \"" METADATA "\", \"@type\": \"CreativeWork\", \"conformsTo\": {\"@id\": "
        "\"" SPECIFICATION "\"}, \"about\": {\"@id\": \"./\"}},\n  {\"@id\": \"./\", \"@type\": \"Dataset\", "
        "\"conformsTo\": {\"@id\": \"" PROFILE "\"}, \"name\": ",
        out);
  text_json_string(title, out);
  fprintf(out,
          ", \"description\": \"An ensemble of simulations of brittle fragmentation: every run with its inputs, "
          "results and fragment masses\", \"datePublished\": \"%s\", \"license\": ",
          date);
  if (license && strstr(license, "://"))
    fputs("{\"@id\": ", out);
  text_json_string(license ? license : "No licence was chosen: ask the authors before you use it.", out);
  if (license && strstr(license, "://"))
    fputc('}', out);
  if (crate->options->author)
    fputs(", \"author\": {\"@id\": \"#author\"}", out);
  fprintf(out, ", \"hasPart\": [%s], \"mentions\": [%s]},\n", crate->parts_text, crate->actions_text);
  fputs("  {\"@id\": \"" PROFILE
        "\", \"@type\": \"CreativeWork\", \"name\": \"Process Run Crate\", \"version\": \"0.5\"}",
        out);
  fputs(crate->graph_text, out);
  fputs("\n ]\n}\n", out);
  return file_end(&file, STATUS_OK, error);
}

/* Makes the folder, or checks that it is empty. */
static status take_folder(const char *folder, struct error *error) {
  TRY(file_folder(folder, error));
  DIR *there = opendir(folder);
  if (!there)
    return status_fail(error, STATUS_IO, "cannot read the folder %s: %s", folder, strerror(errno));
  bool empty = true;
  for (const struct dirent *entry; (entry = readdir(there));)
    empty &= strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0;
  closedir(there);
  return empty ? STATUS_OK : status_fail(error, STATUS_IO, "the folder %s is not empty; name a new one", folder);
}

static status fill(struct crate *crate, struct store *store, const char *title, struct error *error) {
  char path[PATH_SIZE];
  if (!join(path, crate->options->folder, STORE))
    return status_fail(error, STATUS_USAGE, "the folder's name is too long");
  TRY(store_export(store, path, error));
  file_entity(crate, STORE, "application/vnd.sqlite3",
              "Every run with its inputs, results and fragment masses; any SQLite tool reads it, and its table "
              "column_doc explains it");
  ANSWER campaigns = ask_campaign_documents(store, error);
  while (answer_next(&campaigns))
    TRY(add_campaign(crate, &campaigns, error));
  TRY(answer_end(&campaigns));
  ANSWER sessions = ask_campaign_sessions(store, error);
  while (answer_next(&sessions))
    add_session(crate, &sessions);
  TRY(answer_end(&sessions));
  TRY(tables(crate, store, error));
  people(crate);
  if (fflush(crate->graph) | fflush(crate->parts) | fflush(crate->actions))
    return status_fail(error, STATUS_MEMORY, "no memory for the metadata");
  return finish(crate, title, error);
}

status export_crate(struct store *store, const char *store_path, const struct export_crate_options *options,
                    struct error *error) {
  struct crate crate = {.options = options};
  const char *slash = strrchr(store_path, '/');
  status code = take_folder(options->folder, error);
  if (code)
    return code;
  crate.graph = text_open(&crate.graph_text, &crate.graph_size);
  crate.parts = text_open(&crate.parts_text, &crate.parts_size);
  crate.actions = text_open(&crate.actions_text, &crate.actions_size);
  code = crate.graph && crate.parts && crate.actions ? fill(&crate, store, slash ? slash + 1 : store_path, error)
                                                     : status_fail(error, STATUS_MEMORY, "no memory for the metadata");
  FILE *const streams[] = {crate.graph, crate.parts, crate.actions};
  for (size_t i = 0; i < 3; i++)
    if (streams[i])
      fclose(streams[i]);
  free(crate.graph_text);
  free(crate.parts_text);
  free(crate.actions_text);
  return code;
}
