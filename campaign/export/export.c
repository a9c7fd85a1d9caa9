/* What `clast export` writes: views and bits of a store as text, and a crate for an archive. */
#include "campaign/export/export.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "campaign/build_facts.h"
#include "schemas/file.h"
#include "schemas/memory.h"

/* ---- views and bits as text ---- */

/* The views of a folder, and what a crate says of their tables. */
static const char *const exported[][2] = {
    {"runs", "A row for each run: inputs, every result, state, times. SI units; column_doc.csv tells them"},
    {"points", "A row for each point: inputs, and means over its runs with 95 % intervals"},
    {"spectra", "A row for each point and bin of fragment mass"},
    {"estimates", "A row for each exponent of the fragment mass distribution"},
    {"resolution", "A row for each result of a point that clast converge studied: its error by finer settings"},
    {"column_doc", "Meaning and unit of every column of the store and of these tables"},
};
enum { TABLES = sizeof exported / sizeof exported[0] };

static status write_rows(struct store *store, const char *view, enum table_format format, FILE *out,
                         struct error *error) {
  return view ? table_answer(ask_columns_view(store, view, error), false, format, out)
              : store_export_digests(store, out, error);
}

status export_files_write(struct store *store, const char *path, const char *view, enum table_format format,
                          struct error *error) {
  struct file_output file;
  if (!path)
    return write_rows(store, view, format, stdout, error);
  TRY(file_begin(&file, path, "rows", error));
  return file_end(&file, write_rows(store, view, format, file.out, error), error);
}

static status join(char path[LIMITS_PATH], const char *folder, const char *name, struct error *error) {
  return snprintf(path, LIMITS_PATH, "%s/%s", folder, name) < LIMITS_PATH
             ? STATUS_OK
             : status_fail(error, STATUS_USAGE, "the folder's name is too long");
}

status export_files_folder(struct store *store, const char *folder, struct error *error) {
  char path[TABLES][LIMITS_PATH], name[64];
  TRY(file_folder(folder, error));
  for (size_t i = 0; i < TABLES; i++) { /* all before the first is written */
    snprintf(name, sizeof name, "%s.csv", exported[i][0]);
    TRY(join(path[i], folder, name, error));
    TRY(file_may_replace(path[i], "table", error));
  }
  for (size_t i = 0; i < TABLES; i++)
    TRY(export_files_write(store, path[i], exported[i][0], TABLE_CSV, error));
  return STATUS_OK;
}

/* ---- a crate: files and their metadata (JSON-LD) ----
 *
 * The graph has the crate; the program, one entity for each version that computed; an action for each session, from the
 * campaign's file to the store; and one for this export, from the store to the tables. */

#define SPECIFICATION "https://w3id.org/ro/crate/1.1"
#define PROFILE       "https://w3id.org/ro/wfrun/process/0.5"
#define STORE_COPY    "store.db"
#define METADATA      "ro-crate-metadata.json"

struct crate {
  const struct export_crate_options *options;
  json_t *graph, *parts, *actions; /* the entities; the lists hasPart and mentions */
  bool failed;                     /* there was no memory for an entity */
};

/* A text from a user: bytes that are not UTF-8 become U+FFFD. */
static json_t *text_of(const char *text) {
  json_t *made = json_string(text);
  OWNED char *quoted = NULL;
  FILE *out = made ? NULL : text_open(&quoted);
  if (!out)
    return made;
  text_json_string(text, out);
  return text_close(out, &quoted) ? json_loads(quoted, JSON_DECODE_ANY, NULL) : NULL;
}

static json_t *id_of(const char *id) {
  return json_pack("{s:o}", "@id", text_of(id));
}

/* Appends a value that was made; NULL: there was no memory for it. */
static void append(struct crate *crate, json_t *list, json_t *made) {
  if (json_array_append_new(list, made))
    crate->failed = true;
}

static void add_file(struct crate *crate, const char *name, const char *format, const char *description) {
  char path[LIMITS_PATH], size[32];
  struct stat facts;
  const bool known = join(path, crate->options->folder, name, NULL) == STATUS_OK && stat(path, &facts) == 0;
  if (known)
    snprintf(size, sizeof size, "%lld", (long long)facts.st_size);
  append(crate, crate->graph,
         json_pack("{s:s, s:s, s:s, s:s, s:o, s:s*}", "@id", name, "@type", "File", "name", name, "encodingFormat",
                   format, "description", text_of(description), "contentSize", known ? size : NULL));
  append(crate, crate->parts, id_of(name));
}

enum { ID = 96 };
/* Adds the program, once for each version; its id. */
static void add_program(struct crate *crate, const char *version, const char *commit, char id[ID]) {
  size_t i;
  json_t *entity;
  snprintf(id, ID, "#clast-%.32s-%.40s", version, commit);
  text_make_plain(id, "");
  json_array_foreach(crate->graph, i, entity) {
    if (strcmp(json_string_value(json_object_get(entity, "@id")), id) == 0)
      return;
  }
  append(crate, crate->graph,
         json_pack("{s:s, s:s, s:s, s:o, s:s, s:o}", "@id", id, "@type", "SoftwareApplication", "name", "clast",
                   "softwareVersion", text_of(version), "description",
                   "Ensembles of simulations of brittle fragmentation", "identifier", text_of(commit)));
}

/* campaign, name, document */
static status add_campaign(struct crate *crate, const struct answer *row, struct error *error) {
  char name[64], path[LIMITS_PATH], description[512];
  snprintf(name, sizeof name, "campaign-%" PRId64 ".yaml", answer_integer(row, 0));
  TRY(join(path, crate->options->folder, name, error));
  TRY(file_write(path, "campaign", answer_text(row, 2), strlen(answer_text(row, 2)), error));
  snprintf(description, sizeof description, "The campaign \"%.400s\" as it was read", answer_text(row, 1));
  add_file(crate, name, "application/yaml", description);
  return STATUS_OK;
}

/* session, campaign, started, ended, outcome, version, commit, command */
static void add_session(struct crate *crate, const struct answer *row) {
  char id[64], campaign[64], name[96], program[ID];
  snprintf(id, sizeof id, "#session-%" PRId64, answer_integer(row, 0));
  snprintf(name, sizeof name, "Session %" PRId64 " of the store", answer_integer(row, 0));
  snprintf(campaign, sizeof campaign, "campaign-%" PRId64 ".yaml", answer_integer(row, 1));
  add_program(crate, answer_text(row, 5), answer_text(row, 6), program);
  const bool failed = strcmp(answer_text(row, 4), "failed") == 0;
  append(crate, crate->graph,
         json_pack("{s:s, s:s, s:s, s:o, s:o, s:o*, s:o, s:o*, s:o, s:o*, s:o}", "@id", id, "@type", "CreateAction",
                   "name", name, "description", text_of(answer_text(row, 7)), "startTime", text_of(answer_text(row, 2)),
                   "endTime", *answer_text(row, 3) ? text_of(answer_text(row, 3)) : NULL, "instrument", id_of(program),
                   "object", answer_value(row, 1).kind == QUERY_INTEGER ? id_of(campaign) : NULL, "result",
                   id_of(STORE_COPY), "agent", crate->options->author ? id_of("#author") : NULL, "actionStatus",
                   id_of(failed ? "http://schema.org/FailedActionStatus" : "http://schema.org/CompletedActionStatus")));
  append(crate, crate->actions, id_of(id));
}

static void now_text(char text[32]) {
  const time_t now = time(NULL);
  struct tm utc;
  strftime(text, 32, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
}

static status add_tables(struct crate *crate, struct store *store, struct error *error) {
  char date[32], program[ID], name[64];
  TRY(export_files_folder(store, crate->options->folder, error));
  json_t *tables = json_array();
  for (size_t i = 0; i < TABLES; i++) {
    snprintf(name, sizeof name, "%s.csv", exported[i][0]);
    add_file(crate, name, "text/csv", exported[i][1]);
    append(crate, tables, id_of(name));
  }
  add_program(crate, BUILD_VERSION, BUILD_COMMIT, program);
  now_text(date);
  append(crate, crate->graph,
         json_pack("{s:s, s:s, s:s, s:s, s:s, s:o, s:o, s:o}", "@id", "#export", "@type", "CreateAction", "name",
                   "Export of the tables", "description", "clast export --crate", "endTime", date, "instrument",
                   id_of(program), "object", id_of(STORE_COPY), "result", tables));
  append(crate, crate->actions, id_of("#export"));
  return STATUS_OK;
}

/* Adds author and licence. */
static void add_people(struct crate *crate) {
  const char *author = crate->options->author, *license = crate->options->license;
  if (author)
    append(crate, crate->graph,
           json_pack("{s:s, s:s, s:o}", "@id", "#author", "@type", "Person", "name", text_of(author)));
  if (license && strstr(license, "://"))
    append(crate, crate->graph,
           json_pack("{s:o, s:s, s:o, s:s}", "@id", text_of(license), "@type", "CreativeWork", "name", text_of(license),
                     "description", "The licence of this data set"));
}

/* Writes the metadata, after all other files: what describes the crate, then the entities. */
static status finish(struct crate *crate, const char *title, struct error *error) {
  const char *license = crate->options->license;
  char path[LIMITS_PATH], date[32];
  now_text(date);
  TRY(join(path, crate->options->folder, METADATA, error));
  json_auto_t *root = json_pack(
      "{s:[s, s], s:[{s:s, s:s, s:o, s:o}, {s:s, s:s, s:o, s:o, s:s, s:s, s:o, s:o*, s:O, s:O}, {s:s, s:s, s:s, s:s}]}",
      "@context", SPECIFICATION "/context", "https://w3id.org/ro/terms/workflow-run/context", "@graph",   /* */
      "@id", METADATA, "@type", "CreativeWork", "conformsTo", id_of(SPECIFICATION), "about", id_of("./"), /* */
      "@id", "./", "@type", "Dataset", "conformsTo", id_of(PROFILE), "name", text_of(title), "description",
      "An ensemble of simulations of brittle fragmentation: every run with its inputs, results and fragment masses",
      "datePublished", date, "license",
      !license                 ? json_string("No licence was chosen: ask the authors before you use it.")
      : strstr(license, "://") ? id_of(license)
                               : text_of(license),
      "author", crate->options->author ? id_of("#author") : NULL, "hasPart", crate->parts, "mentions", crate->actions,
      "@id", PROFILE, "@type", "CreativeWork", "name", "Process Run Crate", "version", "0.5");
  struct file_output file;
  if (!root || crate->failed || json_array_extend(json_object_get(root, "@graph"), crate->graph))
    return status_fail(error, STATUS_MEMORY, "no memory for the metadata");
  TRY(file_begin(&file, path, "metadata", error));
  const bool written = json_dumpf(root, file.out, JSON_INDENT(1)) == 0 && fputc('\n', file.out) != EOF;
  return file_end(&file, written ? STATUS_OK : status_fail(error, STATUS_IO, "cannot write %s", path), error);
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
  char path[LIMITS_PATH];
  TRY(join(path, crate->options->folder, STORE_COPY, error));
  TRY(store_export(store, path, error));
  add_file(crate, STORE_COPY, "application/vnd.sqlite3",
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
  TRY(add_tables(crate, store, error));
  add_people(crate);
  return finish(crate, title, error);
}

status export_crate(struct store *store, const char *store_path, const struct export_crate_options *options,
                    struct error *error) {
  json_auto_t *graph = json_array(), *parts = json_array(), *actions = json_array();
  struct crate crate = {.options = options, .graph = graph, .parts = parts, .actions = actions};
  const char *slash = strrchr(store_path, '/');
  TRY(take_folder(options->folder, error));
  return fill(&crate, store, slash ? slash + 1 : store_path, error);
}
