/* `clast converge SCENE|CAMPAIGN`: how far results are from those of finer settings, and what that costs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/commands/converge_print.h"
#include "campaign/commands/launch.h"
#include "campaign/converge/study.h"
#include "campaign/design/design.h"
#include "campaign/driver/provenance.h"
#include "campaign/driver/run.h"
#include "campaign/terminal/scene_option.h"
#include "schemas/clock.h"

enum { MOST_SCENES = 64 };

struct options {
  struct launch_options launch;
  struct option_list knobs, set;
  const char *quantity, *store, *within, *seconds, *picture;
  int64_t first_seeds, most_seeds, first_seed;
  bool list;
};

/* What is studied, and what holds it. */
struct subject {
  struct study study;
  struct campaign *campaign;         /* NULL: a scene was named */
  struct scene *scenes[MOST_SCENES]; /* owned */
  size_t scene_count;
  char reference[2 * FIELD_TEXT_SIZE]; /* of the scene, from the current folder */
};

static void clear(struct subject *subject) {
  study_clear(&subject->study);
  for (size_t i = 0; i < subject->scene_count; i++)
    scene_free(subject->scenes[i]);
  campaign_free(subject->campaign);
}

/* ---- the subject ---- */

static status add_scene(struct subject *subject, const struct options *options, struct scene *scene,
                        struct error *error) {
  subject->scenes[subject->scene_count++] = scene;
  return scene_option_apply(scene, &options->set, error);
}

/* Every point of the campaign is a scene of its own. */
static status add_points(struct subject *subject, const struct options *options, struct error *error) {
  const struct campaign *campaign = subject->campaign;
  struct design *design = NULL;
  struct field_value *values = calloc(campaign->axis_count + 1, sizeof *values);
  if (!values)
    return status_fail(error, STATUS_MEMORY, "no memory for the points");
  status code = design_create((enum design_kind)campaign->design.kind, campaign->axes, campaign->axis_count,
                              (uint64_t)campaign->design.points, (uint64_t)campaign->design.seed, &design, error);
  while (code == STATUS_OK && design_next(design, values)) {
    struct scene *scene = campaign_point_scene(campaign, values, error);
    if (!scene)
      code = STATUS_CONTENT;
    else if (subject->scene_count < MOST_SCENES)
      code = add_scene(subject, options, scene, error);
    else {
      scene_free(scene);
      code = status_fail(error, STATUS_CONTENT,
                         "the campaign has more than %d points: study a campaign with fewer points, or one scene",
                         MOST_SCENES);
    }
  }
  design_free(design);
  free(values);
  return code;
}

static status load_campaign(struct subject *subject, const char *path, const struct options *options,
                            struct error *error) {
  status code = campaign_load(path, &subject->campaign, error);
  if (code != STATUS_OK)
    return code;
  const struct campaign *campaign = subject->campaign;
  const char *slash = strrchr(path, '/'), *scene = campaign->scene_reference;
  const bool is_file = strchr(scene, '/') || strchr(scene, '.');
  snprintf(subject->reference, sizeof subject->reference, "%.*s%s",
           slash && is_file && scene[0] != '/' ? (int)(slash + 1 - path) : 0, path, scene);
  subject->study.limits = *campaign;
  return add_points(subject, options, error);
}

static status load_scene(struct subject *subject, const char *reference, const struct options *options,
                         struct error *error) {
  struct scene *scene = NULL;
  status code = scene_load(reference, NULL, &scene, error);
  if (code != STATUS_OK)
    return code;
  struct campaign *limits = &subject->study.limits;
  field_defaults(&campaign_table, limits);
  snprintf(limits->name, sizeof limits->name, "%s", scene->name[0] ? scene->name : "scene");
  snprintf(limits->store, sizeof limits->store, "%.200s-converge.db", limits->name);
  snprintf(subject->reference, sizeof subject->reference, "%s", reference);
  return add_scene(subject, options, scene, error);
}

/* A campaign's document has the key `scene`, which a scene's has not; what is no file is a built-in scene. */
static bool is_campaign(const char *path) {
  bool found = false;
  char line[4096];
  FILE *in = scene_builtin_text(path) ? NULL : fopen(path, "r");
  while (in && !found && fgets(line, sizeof line, in))
    found = strncmp(line, "scene:", 6) == 0 || strstr(line, "\"scene\"");
  if (in)
    fclose(in);
  return found;
}

static status load(struct subject *subject, const char *path, const struct options *options, struct error *error) {
  status code = is_campaign(path) ? load_campaign(subject, path, options, error)
                                  : load_scene(subject, path, options, error);
  if (code != STATUS_OK)
    return code;
  struct campaign *limits = &subject->study.limits;
  /* What the study borrows from a campaign is not owned twice. */
  limits->axes = NULL;
  limits->axis_count = 0;
  limits->scene = NULL;
  limits->text = NULL;
  limits->independent = false;
  limits->keep = CAMPAIGN_KEEP_NONE;
  if (options->first_seed > 0)
    limits->first_seed = options->first_seed;
  if (options->store)
    snprintf(limits->store, sizeof limits->store, "%s", options->store);
  subject->study.scene_reference = subject->reference;
  return STATUS_OK;
}

/* ---- what is asked ---- */

static status read_quantities(struct study *study, const char *names, const struct engine_kind *kind,
                              struct error *error) {
  for (const char *from = names; *from;) {
    char name[FIELD_TEXT_SIZE];
    const size_t length = strcspn(from, ",");
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), from);
    if (study->quantity_count == STUDY_QUANTITIES)
      return status_fail(error, STATUS_USAGE, "at most %d quantities in one study", STUDY_QUANTITIES);
    struct study_quantity *quantity = &study->quantity[study->quantity_count++];
    quantity->row = campaign_quantity(kind, name, &quantity->of_outcome, error);
    if (!quantity->row)
      return STATUS_USAGE;
    from += length + (from[length] == ',');
  }
  return study->quantity_count ? STATUS_OK : status_fail(error, STATUS_USAGE, "--quantity names none");
}

static status read_rule(struct study *study, const struct options *options, struct error *error) {
  struct study_rule *rule = &study->rule;
  char *end = NULL;
  *rule = (struct study_rule){.within = NAN,
                              .seconds = HUGE_VAL,
                              .first_seeds = options->first_seeds,
                              .most_seeds = options->most_seeds};
  if (rule->most_seeds < rule->first_seeds)
    rule->most_seeds = rule->first_seeds;
  if (options->seconds) {
    rule->seconds = strtod(options->seconds, &end);
    if (*end || !(rule->seconds > 0))
      return status_fail(error, STATUS_USAGE, "--seconds %s: expected a number of seconds above 0", options->seconds);
  }
  if (!options->within || strcmp(options->within, "off") == 0)
    return STATUS_OK;
  rule->within = strtod(options->within, &end);
  rule->relative = strcmp(end + strspn(end, " "), "%") == 0;
  if ((*end && !rule->relative) || !(rule->within > 0))
    return status_fail(error, STATUS_USAGE,
                       "--within %s: expected a width above 0 in the quantity's SI unit, a share of its value such as "
                       "\"5 %%\", or off",
                       options->within);
  if (!rule->relative && study->quantity_count > 1)
    return status_fail(error, STATUS_USAGE, "--within %s: several quantities need a share of their values (\"5 %%\")",
                       options->within);
  if (rule->relative)
    rule->within /= 100;
  return STATUS_OK;
}

static void note_lines(const struct options *options, const char *text) {
  for (const char *line = text; line && *line && !options->launch.quiet; line += strcspn(line, "\n") + 1)
    fprintf(stderr, "clast: %.*s\n", (int)strcspn(line, "\n"), line);
}

/* A knob that does not apply is said and left out when a group was asked for, and refused when it was named. */
static status add_knob(struct subject *subject, const struct options *options, const struct scene *scene,
                       const struct knob *knob, const char *settings, bool named, struct error *error) {
  struct ladder levels;
  char *notes = NULL;
  status code = ladder_make(knob, scene, settings, &levels, &notes, error);
  if (code == STATUS_OK)
    note_lines(options, notes);
  free(notes);
  if (code == STATUS_CONTENT && !named) {
    *error = (struct error){0};
    return STATUS_OK;
  }
  return code == STATUS_OK ? study_add(&subject->study, scene, &levels, error) : code;
}

static int group_of(const char *name) {
  for (int group = 0; group < KNOB_GROUPS; group++)
    if (strcmp(name, knob_group_names[group]) == 0)
      return group;
  return -1;
}

static status add_named(struct subject *subject, const struct options *options, const struct scene *scene,
                        const char *name, const char *settings, struct error *error) {
  const int group = group_of(name);
  if (group < 0) {
    const struct knob *knob = knob_find(scene->kind->name, name, error);
    return knob ? add_knob(subject, options, scene, knob, settings, true, error) : STATUS_USAGE;
  }
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < knob_count(); i++)
    if ((int)knob_at(i)->group == group && strcmp(knob_at(i)->engine, scene->kind->name) == 0)
      code = add_knob(subject, options, scene, knob_at(i), NULL, false, error);
  return code;
}

/* "particles,time_step" or "particles=1000,3000". */
static status add_item(struct subject *subject, const struct options *options, const struct scene *scene,
                       const char *item, struct error *error) {
  const char *equals = strchr(item, '=');
  status code = STATUS_OK;
  for (const char *from = item; code == STATUS_OK && *from;) {
    char name[64];
    const size_t length = equals ? (size_t)(equals - item) : strcspn(from, ",");
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), from);
    code = add_named(subject, options, scene, name, equals ? equals + 1 : NULL, error);
    if (equals)
      break;
    from += length + (from[length] == ',');
  }
  return code;
}

static status add_knobs(struct subject *subject, const struct options *options, struct error *error) {
  status code = STATUS_OK;
  for (size_t s = 0; code == STATUS_OK && s < subject->scene_count; s++) {
    const struct scene *scene = subject->scenes[s];
    if (options->knobs.count == 0)
      code = add_item(subject, options, scene, "resolution,settings", error);
    for (size_t i = 0; code == STATUS_OK && i < options->knobs.count; i++)
      code = add_item(subject, options, scene, options->knobs.items[i], error);
  }
  if (code == STATUS_OK && subject->study.ladder_count == 0)
    code = status_fail(error, STATUS_CONTENT, "no knob applies to this scene (`clast converge --list`)");
  return code;
}

static void note(void *context, const char *text) {
  const struct options *options = context;
  if (!options->launch.quiet || strncmp(text, "warning", 7) == 0)
    fprintf(stderr, "clast: %s\n", text);
}

static void print_summary(const struct study *study, double wall_s) {
  char wall[64], cpu[64];
  progress_duration(wall_s, wall, sizeof wall);
  progress_duration(study->cpu_s, cpu, sizeof cpu);
  fprintf(stderr, "%s: %lld runs computed in %s (%s of processor time)%s\n", study->limits.store,
          (long long)study->runs_done, wall, cpu, study->runs_failed ? "; some runs failed" : "");
}

static status study_with_farm(struct subject *subject, const struct options *options, const struct command_line *line,
                              enum table_format format, struct error *error) {
  struct study *study = &subject->study;
  struct farm_options farm_options = {.slots = (int)options->launch.slots,
                                      .in_process = options->launch.in_process,
                                      .use_mpi = farm_under_mpi()};
  struct farm *farm = NULL;
  driver_farm_options(&study->limits, &farm_options);
  status code = farm_start(&farm_options, run_work, &farm, error);
  if (code)
    return code;
  const bool manager = farm_rank(farm) == 0;
  char *facts = provenance_json(farm_ranks(farm), farm_slots_total(farm), line->argc, line->argv);
  const struct driver_options driver = {.store_path = study->limits.store,
                                        .facts = facts,
                                        .note = note,
                                        .note_context = (void *)options};
  const double begin = clock_s();
  code = facts ? study_rounds_run(study, farm, &driver, error) : status_fail(error, STATUS_MEMORY, "out of memory");
  free(facts);
  if (manager && !options->launch.quiet && (code == STATUS_OK || code == STATUS_STOPPED))
    print_summary(study, clock_s() - begin);
  if (manager && code == STATUS_OK)
    code = converge_print_study(study, format, options->launch.quiet, error);
  if (manager && code == STATUS_OK && options->picture)
    code = converge_print_picture(study, options->picture, error);
  status stopped = farm_stop(farm, code ? NULL : error);
  return code ? code : stopped;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->launch.table, &format, error);
  if (code)
    return code;
  if (options->list)
    return converge_print_knobs(format, error);
  if (line->count == 0)
    return status_fail(error, STATUS_USAGE, "name a scene or a campaign, or give --list");
  struct subject *subject = calloc(1, sizeof *subject);
  if (!subject)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  struct study *study = &subject->study;
  code = load(subject, line->arguments[0], options, error);
  if (!code)
    code = read_quantities(study, options->quantity ? options->quantity : study->limits.quantity,
                           subject->scenes[0]->kind, error);
  if (!code)
    code = read_rule(study, options, error);
  if (!code)
    code = add_knobs(subject, options, error);
  if (!code)
    code = study_with_farm(subject, options, line, format, error);
  clear(subject);
  free(subject);
  return launch_quiet_ranks(code, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_LIST("knob", 'k', "NAMES", struct options, knobs,
                    "What is made coarser and finer: names or groups, comma-separated, or NAME=LEVEL,LEVEL... with "
                    "levels of your own. May be given several times. Default: the groups resolution and settings."),
    OPTION_ROW_TEXT("quantity", 'q', "NAMES", struct options, quantity, NULL,
                    "Results to study, comma-separated. Default: the campaign's main quantity, or " OUTCOME_DEFAULT
                    "."),
    SCENE_OPTION_SET(struct options, set),
    OPTION_ROW_TEXT("within", 0, "WIDTH", struct options, within, "5 %",
                    "Add seeds until the half width of every bias is below this: a number in the quantity's SI unit, a "
                    "share of its value at the finest level (\"5 %\"), or off: one round only."),
    OPTION_ROW_TEXT("seconds", 0, "S", struct options, seconds, NULL,
                    "Stop adding runs after this wall time. Levels whose first runs would not fit are left out."),
    OPTION_ROW_INTEGER("seeds", 0, "N", struct options, first_seeds, 2, 1000000, "4", "Seeds of the first round."),
    OPTION_ROW_INTEGER("max-seeds", 0, "N", struct options, most_seeds, 2, 1000000, "32",
                       "Most seeds of a level. Each round doubles them."),
    OPTION_ROW_INTEGER("first-seed", 0, "N", struct options, first_seed, 0, INT64_MAX, "0",
                       "The first seed. 0: the campaign's, or 1."),
    OPTION_ROW_TEXT("store", 0, "FILE", struct options, store, NULL,
                    "Store of the runs. Default: the campaign's, or SCENE-converge.db."),
    OPTION_ROW_TEXT("picture", 0, "FILE", struct options, picture, NULL,
                    "Draw the first quantity over the cost of a run, a curve per knob (.png or .svg)."),
    OPTION_ROW_FLAG("list", 0, struct options, list, "Print all knobs and stop."),
    LAUNCH_OPTIONS(struct options, launch),
    TABLE_OPTIONS(struct options, launch.table),
};

const struct command converge_command = {
    .name = "converge",
    .group = "running",
    .arguments = "[SCENE|CAMPAIGN.yaml]",
    .summary = "how far results are from those of finer settings, and at what cost",
    .doc =
        "Runs a scene, or every point of a campaign, with coarser and finer settings (knobs: particles, time step,\n"
        "precision, ...) and the same seeds. For every level it prints the bias against the finest one with its 95 %\n"
        "interval, the scatter between seeds, the processor time, and the correlation with the next finer level. It\n"
        "measures the order of convergence and extrapolates, or says that differences do not shrink. Seeds are added\n"
        "until every bias is known (--within) or the time is spent. The runs and the findings stay in the store; the\n"
        "same command goes on after a stop.",
    .examples = "clast converge disc-explosion --set body.diameter='8 cm' --knob grains,time_step --seconds 20\n"
                "clast converge basalt-sphere --set particles=3000 --knob particles=1000,3000,9000 --seconds 60",
    .minimum_arguments = 0,
    .maximum_arguments = 1,
    .has_runs = true,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
