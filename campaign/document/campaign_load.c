/* The keys of a campaign, and a campaign from a document and changes of it. */

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "campaign/document/campaign_read.h"
#include "db/ask/ask.h"
#include "engine/random.h"
#include "schemas/memory.h"
#include "schemas/rows.h"

#define ROW(path_, member_, kind_, unit_, ...)                                                                         \
  { .path = path_, .kind = kind_, .unit = unit_, .offset = offsetof(struct campaign, member_), __VA_ARGS__ }
#define TEXT(path_, member_, ...) ROW(path_, member_, FIELD_TEXT, NULL, __VA_ARGS__)
#define COUNT(path_, member_, default_, low, high, ...)                                                                \
  ROW(path_, member_, FIELD_INTEGER, "1", .number = default_, .minimum = low, .maximum = high, __VA_ARGS__)

static const struct field rows[] = {
    TEXT("name", name, .flags = FIELD_REQUIRED, .doc = "Name of the campaign, as the store lists it."),
    TEXT("scene", scene_reference, .flags = FIELD_REQUIRED,
         .doc = "What is run: a built-in scene (`clast scenes`) or a file, relative to this document's folder."),
    TEXT("quantity", quantity, .text = OUTCOME_DEFAULT,
         .doc = "The main quantity: shown while running and in the table at the end, and compared by `keep: {fields: "
                "extremes}`. Any number that a run reports (`clast explain`). Unless given: that of `accuracy` or "
                "`seeds.until`, else what the scene is made for, such as the strength of a compression; where bodies "
                "break largest_fraction."),
    TEXT("store", store, .text = "",
         .doc = "The results file, relative to the current folder. Default: the name with .db after it."),
    COUNT(
        "seeds.first", first_seed, 1, 0, 0x1p62,
        .doc =
            "Seed of replicate 0; replicate r of every point has first + r, so that points share their random bodies."),
    ROW("seeds.independent", independent, FIELD_BOOLEAN, NULL, .maximum = 1,
        .doc = "Every point gets seeds of its own, derived from its inputs and the replicate. `clast find` gives them, "
               "whatever stands here, and `clast fit` unless `false` is written."),
    COUNT("seeds.per_point", per_point, 20, 1, 0x1p40, .doc = "Replicates (seeds) of every point."),
    COUNT("seeds.max", maximum, 200, 2, 0x1p40, .doc = "Most replicates of a point when `until` decides."),
    TEXT("seeds.until.quantity", until_quantity, .text = "",
         .doc = "The quantity whose mean must be known well enough. Default: the main quantity."),
    ROW("seeds.until.half_width", until_half_width, FIELD_REAL, "1", .number = 0.01, .minimum = 0, .maximum = HUGE_VAL,
        .flags = FIELD_ABOVE_MINIMUM | FIELD_ANY_UNIT,
        .doc = "A point is finished when the confidence interval of the mean is narrower than plus or minus this: a "
               "value of the quantity (17 MPa), or a share of its mean (5 %). Judged on "
               "fixed prefixes of replicate numbers, with an interval wider than Student's: values that are alike by "
               "chance do not end a point. Tables then have no wider interval of this level, but where all "
               "runs of a share are equal: there they have the bounds of what so few may have missed.",
        .source = "Chow & Robbins 1965"),
    ROW("seeds.until.level", until_level, FIELD_REAL, "1", .number = 0.95, .minimum = 0.5, .maximum = 1,
        .flags = FIELD_BELOW_MAXIMUM, .doc = "Confidence level of that interval."),
    COUNT("seeds.until.minimum", until_minimum, 30, 2, 0x1p40,
          .doc = "Replicates before the first decision: with fewer, intervals of skew or bimodal quantities are often "
                 "too narrow. At level 0.95 a point needs 41 in any case: in batches of 10 from 30 on, 50."),
    COUNT("seeds.until.batch", until_batch, 10, 1, 0x1p40, .doc = "Replicates between two decisions."),
    TEXT("accuracy.quantity", accuracy_quantity, .text = "",
         .doc = "The quantity that must be accurate. Default: the main quantity."),
    ROW("accuracy.within", accuracy_within, FIELD_REAL, "1", .number = NAN, .minimum = 0, .maximum = HUGE_VAL,
        .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM | FIELD_ANY_UNIT,
        .doc = "Choose settings and number of seeds so that the error of resolution and the 95 % interval of the mean "
               "together are at most this, at the least processor time: a value of the quantity with its "
               "unit (17 MPa), or a share of its mean (5 %), for each setting of the mean that it gives itself. The "
               "choice comes from a study in the store (`clast converge`). off: settings and seeds are as written."),
    ROW("accuracy.processor_time", accuracy_time, FIELD_REAL, "s", .number = NAN, .minimum = 0, .maximum = 1e12,
        .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM,
        .doc = "Instead of within: choose settings and number of seeds so that the same sum is least for so much "
               "processor time of all points together."),
    ROW("limits.time", time_limit, FIELD_REAL, "s", .number = NAN, .minimum = 0, .maximum = 1e9,
        .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM, .doc = "Wall time of one attempt at a run; off: none."),
    ROW("limits.memory", memory_limit, FIELD_REAL, "B", .number = NAN, .minimum = 1048576, .maximum = 0x1p60,
        .flags = FIELD_MAY_BE_OFF, .doc = "Memory of one attempt at a run; off: none."),
    COUNT("limits.attempts", attempts, 2, 1, 1000,
          .doc = "Attempts at one run, in all, before it is given up as failed."),
    COUNT("limits.failures", failures, 20, 0, 50,
          .doc = "The campaign stops when this many of its first 50 runs have failed; 0: it never stops for failures."),
};
const struct field_table
    campaign_table = FIELD_TABLE(rows, struct campaign, "campaign",
                                 "Many runs of one scene: what is varied, how often, within which limits.");

static FIELD_WORDS(kinds,
                   CAMPAIGN_DESIGNS, [CAMPAIGN_GRID] = "grid", [CAMPAIGN_LIST] = "list", [CAMPAIGN_RANDOM] = "random",
                   [CAMPAIGN_LATIN_HYPERCUBE] = "latin_hypercube", [CAMPAIGN_SOBOL] = "sobol");
static const struct field design_rows[] = {
    {.path = "kind",
     .kind = FIELD_CHOICE,
     .offset = offsetof(struct campaign_design_keys, kind),
     .choices = kinds,
     .choice_docs = "every combination of the varied inputs' values\n"
                    "the i-th value of every varied input makes point i\n"
                    "independent draws\n"
                    "each input's range is cut into as many strata as there are points, one point in each\n"
                    "Sobol numbers, digitally shifted: the most even of the three samplings",
     .doc = "How points are made from the varied inputs."},
    ROW_OF(campaign_design_keys, points, points, FIELD_INTEGER, "1", .minimum = 1, .maximum = 0x1p53,
           .when = "kind=random|latin_hypercube|sobol", .doc = "How many points are sampled."),
    ROW_OF(campaign_design_keys, seed, seed, FIELD_INTEGER, "1", .number = 1, .maximum = 0x1p62,
           .when = "kind=random|latin_hypercube|sobol",
           .doc = "Seed of the draws, permutations and shifts; the runs have other seeds (`seeds`)."),
    ROW_OF(campaign_design_keys, file, file, FIELD_TEXT, NULL, .text = "",
           .doc = "CSV file of the points, relative to this document's folder: a header of input paths, a line for "
                  "each point. \"threshold.angle [deg]\" gives the unit of bare numbers. Instead of vary."),
};
const struct field_table campaign_design_table = FIELD_TABLE(design_rows, struct campaign_design_keys, "design",
                                                             "How points are made from the varied inputs.");

const struct design_axis *campaign_axis(const struct campaign *campaign, const char *path) {
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (strcmp(campaign->axes[i].row->path, path) == 0)
      return &campaign->axes[i];
  return NULL;
}

const struct field *campaign_quantity(const struct engine_kind *kind, const char *path, bool *of_outcome,
                                      struct error *error) {
  struct error first, second;
  const struct field *row = field_find(&outcome_table, path, &first);
  *of_outcome = row != NULL;
  if (!row)
    row = field_find(kind->results, path, &second);
  if (!row && strncmp(path, "beta", 4) == 0 && (!path[4] || path[4] == '_')) {
    status_fail(error, STATUS_CONTENT,
                "'%s' is the exponent of all runs of a point together; here a number of every run is needed, such as "
                "largest_fraction. `clast estimates STORE` has beta with its interval",
                path);
    return NULL;
  }
  if (!row) {
    struct text_guess guess = text_guess(path);
    field_guess(&outcome_table, &guess);
    field_guess(kind->results, &guess);
    text_guess_offer_part(&guess, "M_1/M", OUTCOME_NAME(largest_fraction));
    text_guess_offer_part(&guess, "M_2/M", OUTCOME_NAME(second_fraction));
    const char *nearest = guess.nearest;
    status_fail(error, STATUS_CONTENT,
                "no quantity '%s'%s%s%s; a run of engine %s reports largest_fraction, fragment_count, "
                "mean_fragment_mass and more (`clast explain` lists them)",
                path, nearest ? ": did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "", kind->name);
    return NULL;
  }
  if (!field_is_number(row)) {
    status_fail(error, STATUS_CONTENT, "'%s' is no number, so it has no mean; name another quantity", path);
    return NULL;
  }
  return row;
}

const char *campaign_unit(const struct campaign *campaign, const char *quantity, char text[CAMPAIGN_UNIT]) {
  struct error ignored;
  bool of_outcome;
  const struct field *row = campaign_quantity(campaign->scene->kind, quantity, &of_outcome, &ignored);
  struct field shown = row ? *row : (struct field){0};
  shown.unit = ask_result_unit(&shown, campaign->scene->kind->dimensions);
  const char *unit = field_shown_unit(&shown);
  snprintf(text, CAMPAIGN_UNIT, "%s%s", *unit ? " " : "", unit);
  return text;
}

double campaign_value(const struct field *row, bool of_outcome, const struct outcome *outcome, const void *result) {
  if (!outcome_is_usable(outcome->state))
    return NAN;
  struct field_value value;
  field_get(row, of_outcome ? (const void *)outcome : result, &value);
  return field_number(&value);
}

/* The document for the store. The checksum identifies the file of points; another file of points is another
 * campaign. */
static char *text_for_store(const char *document, const struct campaign *campaign) {
  char *text = NULL;
  FILE *out = text_open(&text);
  fputs(document, out);
  if (campaign->points_sha256[0])
    fprintf(out, "%s# design.file: %lld points, sha256 %s\n",
            *document && document[strlen(document) - 1] != '\n' ? "\n" : "", (long long)campaign->design.points,
            campaign->points_sha256);
  return text_close(out, &text);
}

/* ---- Puts the changes into the document before it is read: they are checked like the file's own values ---- */

static const char origin[] = "command line";

status campaign_change_split(const char *text, char path[FIELD_TEXT_SIZE], const char **value, struct error *error) {
  const char *equals = strchr(text, '=');
  if (!equals || equals == text || equals - text >= FIELD_TEXT_SIZE)
    return status_fail(error, STATUS_USAGE, "--set expects PATH=VALUE (--set threshold.strain=0.03), got \"%.128s\"",
                       text);
  snprintf(path, FIELD_TEXT_SIZE, "%.*s", (int)(equals - text), text);
  *value = equals + 1;
  return STATUS_OK;
}

/* STATUS_USAGE: no PATH=VALUE. */
static status change(struct document *document, const struct campaign_changes *changes, struct error *error) {
  for (size_t i = 0; i < changes->input_count; i++) {
    char path[FIELD_TEXT_SIZE];
    const char *value = NULL;
    TRY(campaign_change_split(changes->inputs[i], path, &value, error));
    TRY(document_change_put(document, (const char *const[]){"set", path}, value, origin, error));
  }
  char number[32];
  if (changes->processor_time > 0) {
    document_node *seeds = document_key(document_root(document), "seeds");
    document_node *accuracy = document_key(document_root(document), "accuracy");
    document_drop(seeds, (const char *const[]){"per_point", "until", "max", NULL});
    document_drop(accuracy, (const char *const[]){"within", NULL});
    snprintf(number, sizeof number, "%.17g s", changes->processor_time);
    TRY(document_change_put(document, (const char *const[]){"accuracy", "processor_time"}, number, origin, error));
  }
  if (changes->seeds == 0)
    return STATUS_OK;
  document_drop(document_key(document_root(document), "seeds"), (const char *const[]){"until", "max", NULL});
  snprintf(number, sizeof number, "%" PRId64, changes->seeds);
  return document_change_put(document, (const char *const[]){"seeds", "per_point"}, number, origin, error);
}

/* ---- a campaign from a document ---- */

static status from_document(struct document *document, const struct campaign_changes *changes, const char *folder,
                            bool stored, struct campaign **out, struct error *error) {
  document_node *seeds = document_key(document_root(document), "seeds");
  const char *number = seeds ? document_scalar(seeds) : NULL;
  if (number && *number && !document_graft_word(seeds, "per_point", number)) /* `seeds: 4` */
    return status_fail(error, STATUS_MEMORY, "no memory for the campaign");
  if (changes)
    TRY(change(document, changes, error));
  CAMPAIGN campaign = memory_small(1, sizeof *campaign);
  campaign_read(document_root(document), folder, stored, campaign); /* its defaults clear the whole struct */
  OWNED char *changed = document_change_text(document);
  campaign->text = changed ? text_for_store(changed, campaign) : NULL;
  if (!campaign->text)
    return status_fail(error, STATUS_MEMORY, "no memory for the campaign");
  TRY(document_verdict(document, error));
  *out = campaign;
  campaign = NULL;
  return STATUS_OK;
}

static status from_text(const char *name, const char *text, size_t size, const char *folder, bool si,
                        struct campaign **out, struct error *error) {
  DOCUMENT document = NULL;
  *out = NULL;
  TRY(document_parse(name, text, size, &document, error));
  if (si)
    document_take_si(document);
  return from_document(document, NULL, folder, si, out, error);
}

status campaign_parse(const char *name, const char *text, size_t size, const char *folder, struct campaign **out,
                      struct error *error) {
  return from_text(name, text, size, folder, false, out, error);
}

status campaign_parse_stored(const char *name, const char *text, const char *folder, struct campaign **out,
                             struct error *error) {
  return from_text(name, text, strlen(text), folder, true, out, error);
}

status campaign_load(const char *path, struct campaign **out, struct error *error) {
  return campaign_load_changed(path, NULL, out, error);
}

status campaign_load_changed(const char *path, const struct campaign_changes *changes, struct campaign **out,
                             struct error *error) {
  DOCUMENT document = NULL;
  *out = NULL;
  const status code = document_open(path, &document, error);
  if (code == STATUS_MISSING && scene_builtin_text(path))
    return status_fail(error, STATUS_MISSING,
                       "%s is a built-in scene; a campaign is a file, which names it: `scene: %s`, and `vary:` with an "
                       "input and its values",
                       path, path);
  TRY(code);
  char word[TEXT_WORD];
  if (document_key(document_root(document), "engine") && !document_key(document_root(document), "scene"))
    return status_fail(error, STATUS_CONTENT,
                       "%s is a scene, not a campaign: a campaign is another file, with `name: NAME`, `scene: %s` and "
                       "what varies; `clast simulate %s` makes one run of the scene",
                       path, path, text_word(path, word));
  const char *slash = strrchr(path, '/');
  OWNED char *folder = slash ? memory_small_text(path) : NULL;
  if (folder)
    folder[slash - path + (slash == path)] = '\0';
  return from_document(document, changes, folder, false, out, error);
}

void campaign_free(struct campaign *campaign) {
  if (!campaign)
    return;
  design_axis_free_all(campaign->axes, campaign->axis_count);
  scene_free(campaign->scene);
  free(campaign->point_lines);
  free(campaign->text);
  free(campaign);
}

void campaign_drop(struct campaign **campaign) {
  campaign_free(*campaign);
}

int64_t campaign_replicates_of_rule(const struct campaign *campaign) {
  int64_t least = campaign->until_minimum;
  while (least < 1000 && !sample_could_stop((size_t)least, campaign->until_level)) /* 1000: enough at any level */
    least += campaign->until_batch;
  return least;
}

int64_t campaign_replicates_least(const struct campaign *campaign) {
  if (campaign->per_point)
    return campaign->per_point;
  const int64_t least = campaign_replicates_of_rule(campaign);
  return least < campaign->maximum ? least : campaign->maximum;
}

int64_t campaign_replicates_most(const struct campaign *campaign) {
  return campaign->per_point ? campaign->per_point : campaign->maximum;
}

struct scene *campaign_point_scene(const struct campaign *campaign, const struct field_value *values,
                                   struct error *error) {
  return campaign_point_scene_from(campaign->scene, campaign, values, error);
}

struct scene *campaign_point_scene_from(const struct scene *base, const struct campaign *campaign,
                                        const struct field_value *values, struct error *error) {
  struct scene *scene = scene_copy(base);
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < campaign->axis_count; i++)
    code = scene_set(scene, campaign->axes[i].row->path, &values[i], error);
  if (code == STATUS_OK)
    code = scene_check(scene, error);
  if (code == STATUS_OK)
    return scene;
  scene_free(scene);
  return NULL;
}

uint64_t campaign_seed(const struct campaign *campaign, const struct scene *point, int64_t replicate) {
  if (!campaign->independent)
    return (uint64_t)campaign->first_seed + (uint64_t)replicate;
  /* The seed follows from the point's inputs, not from its place in the design: a design that grows keeps its seeds. 63
   * bits, because integers of SQL have a sign. */
  uint8_t identity[16];
  uint64_t item = 0, bits[4];
  scene_identity(point, 0, identity);
  for (int i = 0; i < 8; i++)
    item = item << 8 | identity[i];
  random_bits((uint64_t)campaign->first_seed, RANDOM_SEED, item, (uint64_t)replicate, bits);
  return bits[0] >> 1;
}

/* ---- Raises the limits for runs that reached them ---- */

/* A limit given on the command line, or twice the campaign's. */
static status raise_limit(const char *path, const char *text, double *limit, struct error *error) {
  if (!text) {
    *limit *= 2;
    return STATUS_OK;
  }
  const struct field *row = field_find(&campaign_table, path, error);
  struct field_value value;
  if (!row)
    return STATUS_INTERNAL;
  status code = field_parse(row, text, &value, error);
  if (code)
    return STATUS_USAGE;
  *limit = value.number;
  return STATUS_OK;
}

status campaign_raise(struct campaign *campaign, const char *time, const char *memory, int64_t attempts,
                      struct error *error) {
  TRY(raise_limit("limits.time", time, &campaign->time_limit, error));
  TRY(raise_limit("limits.memory", memory, &campaign->memory_limit, error));
  campaign->attempts += attempts;
  campaign->failures = 0; /* the user was told of these failures before */
  return STATUS_OK;
}

/* ---- What the keys of a campaign with several forms mean. campaign_read.c and campaign_vary.c read them ---- */

const struct campaign_key campaign_keys[] = {
    {.name = "vary",
     .words = "from to n log uniform log_uniform normal mean sd truncated lognormal median sigma linked factor offset "
              "values",
     .doc = "Inputs of the scene that vary: the path of each, or a unique ending of it, and its values.",
     .forms = "    [1 %, 3 %, 6 %]                                    these values\n"
              "    {from: 1 %, to: 6 %, n: 6}                         even steps, both ends included\n"
              "    {log: [1 %, 6 %], n: 6}                            even steps of the logarithm\n"
              "    {uniform: [1 %, 6 %]}                              a law: uniform between two values\n"
              "    {log_uniform: [1 %, 6 %]}                          uniform in the logarithm\n"
              "    {normal: {mean: 4 deg, sd: 1 deg}}                 may be cut: truncated: [1 deg, 7 deg]\n"
              "    {lognormal: {median: 1 GPa, sigma: 0.05}}          sigma of the logarithm; truncated, too\n"
              "    {linked: threshold.strain, factor: 2}               factor (default 1) times another input,\n"
              "                                                       plus offset (SI, default 0)\n"
              "    {linked: threshold.strain, values: [2 deg, 6 deg]} i-th value with the i-th one of that input\n"
              "    Laws need a sampling design: clast explain design\n"},
    {.name = "set",
     .words = "",
     .doc = "Inputs of the scene with another value for the whole campaign.",
     .forms = "    {contact.friction: 0.2, body.diameter: 8 cm}       path of each, or a unique ending of it\n"},
    {.name = "design",
     .words = "grid list random latin_hypercube sobol kind points seed file",
     .doc = "How points are made from the varied inputs. Default: grid.",
     .forms = "    grid, or list                                      of values that are given\n"
              "    {kind: sobol, points: 64, seed: 1}                 of laws; or kind random, latin_hypercube\n"
              "    {file: points.csv}                                 from another program: a header of paths, a\n"
              "                                                       line for each point. A column\n"
              "                                                       \"threshold.angle [deg]\" is in degrees\n",
     .table = &campaign_design_table},
    {.name = "keep",
     .words = "fields none all extremes first",
     .doc = "Runs that keep their fields as HDF5 files. Default: none.",
     .forms = "    {fields: none}, {fields: all}\n"
              "    {fields: first 3}                                  the first replicates of each point\n"
              "    {fields: extremes}                                 of each point the runs with the least and the\n"
              "                                                       greatest main quantity (key quantity)\n"},
};
const size_t campaign_keys_count = sizeof campaign_keys / sizeof campaign_keys[0];

const struct campaign_key *campaign_keys_find(const char *path) {
  const size_t head = strcspn(path, ".");
  for (size_t i = 0; i < campaign_keys_count; i++) {
    const struct campaign_key *key = &campaign_keys[i];
    const bool named = strlen(key->name) == head && strncmp(key->name, path, head) == 0;
    if (named && (path[head] == '\0' || text_has_word(key->words, path + head + 1)))
      return key;
    if (!named && text_has_word(key->words, path))
      return key;
  }
  return NULL;
}
