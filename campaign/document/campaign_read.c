/* Reads the document of a campaign: the plain keys by their rows, the keys of several forms by hand. */
#include "campaign/document/campaign_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "db/ask/ask.h"
#include "db/store/store.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

static document_node *key_of(document_node *mapping, const char *key) {
  return mapping && document_kind(mapping) == DOCUMENT_MAPPING ? document_key(mapping, key) : NULL;
}

bool campaign_read_value(document_node *node, const struct field *row, const char *folder, struct field_value *value) {
  if (!document_value(node, row, value))
    return false;
  if (row->kind != FIELD_TEXT || !row->choices || field_is_choice(row, value->text) || document_is_put(node))
    return true;
  OWNED char *whole = file_name_in(folder, value->text);
  if (whole && strlen(whole) < FIELD_TEXT_SIZE)
    field_copy_text(value->text, whole);
  else
    document_report(node, row->path, "the name of this file is too long with its folder");
  return whole && strlen(whole) < FIELD_TEXT_SIZE;
}

/* Does the axis follow another one, or another one it? */
static bool is_linked(const struct campaign *campaign, const struct design_axis *axis) {
  for (size_t a = 0; a < campaign->axis_count; a++)
    if (campaign->axes[a].kind == DESIGN_AXIS_LINKED &&
        (&campaign->axes[a] == axis || &campaign->axes[campaign->axes[a].linked] == axis))
      return true;
  return false;
}

/* Reads one entry of `set`. Returns the input; NULL: not found, reported. *good: false after a report. */
static const struct field *read_set_value(document_node *node, const char *key, const char *path, const char *folder,
                                          const struct campaign *campaign, struct scene *scene, const char *varied,
                                          bool *good) {
  struct error error = {0};
  struct field_value value;
  const bool before = *good;
  *good = false;
  if (!key || document_kind(node) != DOCUMENT_SCALAR) {
    document_report(node, path, "expected one value; several values belong in `vary`");
    return NULL;
  }
  const struct field *row = field_find_in(scene->kind->inputs, key, scene->inputs, &error);
  const struct design_axis *axis = row ? campaign_axis(campaign, row->path) : NULL;
  if (axis)
    document_report(node, path, "%s",
                    document_is_put(node) && is_linked(campaign, axis)
                        ? "in `vary` it is linked to another input, which one value would not fit: change `vary` in "
                          "the file"
                        : varied);
  else if (!row ||
           (campaign_read_value(node, row, folder, &value) && scene_set(scene, row->path, &value, &error) != STATUS_OK))
    document_report_error(node, path, &error);
  else
    *good = before;
  return row;
}

bool campaign_read_set(document_node *set, const char *folder, const struct campaign *campaign, struct scene *scene,
                       bool stored, const char *varied) {
  const struct field_table *inputs = scene->kind->inputs;
  bool good = true;
  if (!set)
    return true;
  if (document_kind(set) != DOCUMENT_MAPPING) {
    document_report(set, "set", "expected a mapping of paths to values, e.g. contact.friction: 0.2");
    return false;
  }
  OWNED const char **names = memory_small(inputs->count, sizeof *names); /* the key that has set an input */
  for (size_t i = 0; i < document_count(set); i++) {
    const char *key = NULL;
    char path[320];
    document_node *node = document_item(set, i, &key);
    snprintf(path, sizeof path, "set.%.300s", key ? key : "");
    const struct field *row = read_set_value(node, key, path, folder, campaign, scene, varied, &good);
    if (!row)
      continue;
    const char **name = &names[row - inputs->rows];
    if (*name && document_is_put(node) && !document_is_put(document_key(set, *name))) {
      document_graft_drop(set, *name);
      i--;
    } else if (*name && !stored) {
      document_report(node, path, "the same input as set.%.200s; leave one of them out", *name);
    }
    *name = key;
  }
  return good;
}

/* Two rocks of one name in a list could not be told apart in a table. */
static bool check_rocks(document_node *vary, const struct campaign *campaign) {
  struct error error;
  for (size_t a = 0; a < campaign->axis_count; a++) {
    const struct design_axis *axis = &campaign->axes[a];
    if (axis->row->kind != FIELD_TEXT || !axis->row->choices || axis->kind != DESIGN_AXIS_LEVELS)
      continue;
    OWNED struct field_value *name = memory_small(axis->level_count, sizeof *name);
    for (size_t i = 0; i < axis->level_count; i++) {
      SCENE scene = scene_copy(campaign->scene);
      if (scene_set(scene, axis->row->path, &axis->levels[i], &error) == STATUS_OK)
        field_get(axis->row, scene->inputs, &name[i]);
      for (size_t k = 0; k < i; k++)
        if (*name[i].text && strcmp(name[i].text, name[k].text) == 0 &&
            strcmp(axis->levels[i].text, axis->levels[k].text) != 0) {
          document_report(vary, axis->row->path,
                          "%s and %s would have one name in all tables, '%s': give one of them another `material:` or "
                          "another file name",
                          axis->levels[k].text, axis->levels[i].text, name[i].text);
          return false;
        }
    }
  }
  return true;
}

/* The number of "first 12": at least 1, up to 9 digits, no sign or blanks. 0: the text has another form. */
static int64_t first_of(const char *text) {
  char *end = NULL;
  if (strncmp(text, "first ", 6) != 0 || text[6] < '1' || text[6] > '9' || strlen(text + 6) >= 10)
    return 0;
  const int64_t count = strtoll(text + 6, &end, 10);
  return *end ? 0 : count;
}

static void read_keep(document_node *keep, struct campaign *campaign) {
  static const char *const names[] =
      {[CAMPAIGN_KEEP_NONE] = "none", [CAMPAIGN_KEEP_ALL] = "all", [CAMPAIGN_KEEP_EXTREMES] = "extremes"};
  static const char expected[] = "expected {fields: none | all | extremes | first N}";
  document_node *fields = key_of(keep, "fields");
  const char *text = fields ? document_scalar(fields) : NULL;
  if (!keep)
    return;
  if (document_kind(keep) == DOCUMENT_MAPPING)
    document_unknown_keys(keep, "keep", (const char *const[]){"fields", NULL});
  if (!text) {
    document_report(fields ? fields : keep, "keep", "%s", expected);
    return;
  }
  for (int i = 0; i < (int)(sizeof names / sizeof names[0]); i++)
    if (strcmp(text, names[i]) == 0) {
      campaign->keep = i;
      return;
    }
  campaign->keep = CAMPAIGN_KEEP_FIRST;
  campaign->keep_first = first_of(text);
  if (campaign->keep_first == 0)
    document_report(fields, "keep.fields", "%s, got '%.80s'", expected, text);
}

static void read_design(document_node *design, struct campaign *campaign) {
  field_defaults(&campaign_design_table, &campaign->design);
  if (!design)
    return;
  if (document_kind(design) == DOCUMENT_MAPPING) {
    document_read(design, &campaign_design_table, NULL, &campaign->design);
    if (document_key(design, "file")) {
      if (document_count(design) > 1)
        document_report(design, "design", "a file is the list of points: leave the other keys of design out");
      campaign->design.kind = CAMPAIGN_LIST;
      campaign->design.points = 0;
    }
    return;
  }
  struct field row = campaign_design_table.rows[0]; /* kind */
  row.path = "design";
  struct field_value value;
  if (document_value(design, &row, &value))
    campaign->design.kind = (int)value.number;
}

/* A width in per cent is a share of the mean. */
static bool is_of_value(document_node *mapping, const char *key) {
  document_node *width = key_of(mapping, key);
  const char *text = width ? document_scalar(width) : NULL;
  return text && strchr(text, '%');
}

/* Checks `seeds`: a fixed number, or a rule with a maximum. A document that a store keeps was read by the program of
 * its day: what has run with it is not refused. */
static void check_seeds(document_node *root, bool stored, struct campaign *campaign) {
  document_node *seeds = key_of(root, "seeds");
  document_node *until = key_of(seeds, "until"), *per_point = key_of(seeds, "per_point"), *max = key_of(seeds, "max");
  campaign->independent_given = key_of(seeds, "independent");
  if (until && per_point)
    document_report(per_point, "seeds.per_point",
                    "a fixed number and `until` exclude each other; leave one of them out");
  if (max && !until)
    document_report(max, "seeds.max", "only `until` has a maximum; a fixed number is per_point");
  if (!until)
    return;
  campaign->per_point = 0;
  campaign->until_of_value = is_of_value(until, "half_width");
  if (!key_of(until, "half_width"))
    document_report(until, "seeds.until", "'half_width' is missing: give the half width that ends a point");
  if (!stored && (campaign->until_minimum > campaign->maximum ||
                  !sample_could_stop((size_t)campaign->maximum, campaign->until_level))) {
    const long long most = campaign->maximum;
    long long least = campaign->until_minimum;
    while (!sample_could_stop((size_t)least, campaign->until_level))
      least++;
    document_report(
        max ? max : until, "seeds.max",
        "seeds.until ends no point before %lld runs, whatever its interval, and max is %lld: give max: %lld "
        "or more, or per_point: %lld and no until",
        least, most, least, most);
  }
}

/* Is there a value, right or wrong? */
static bool is_given(document_node *mapping, const char *key) {
  document_node *value = key_of(mapping, key);
  const char *text = value ? document_scalar(value) : NULL;
  return value && !(text && strcmp(text, "off") == 0);
}

/* `accuracy` decides the seeds itself. */
static void check_accuracy(document_node *root, struct campaign *campaign) {
  document_node *accuracy = document_key(root, "accuracy"), *seeds = key_of(document_key(root, "seeds"), "per_point");
  if (!accuracy)
    return;
  if (is_given(accuracy, "within") == is_given(accuracy, "processor_time"))
    document_report(accuracy, "accuracy",
                    "give one of 'within', the largest error of the result, and 'processor_time', which the campaign "
                    "may cost");
  campaign->accuracy_of_value = is_of_value(accuracy, "within");
  if (seeds || key_of(document_key(root, "seeds"), "until"))
    document_report(accuracy, "accuracy",
                    "accuracy finds the number of seeds; leave seeds.per_point (also as --seeds) and seeds.until out");
}

static bool is_share_of(const struct campaign *campaign, const char *name) {
  struct error error;
  bool of_outcome;
  const struct field *row = campaign_quantity(campaign->scene->kind, name, &of_outcome, &error);
  return row && field_is_share(row);
}

static void check_quantity(document_node *node, const char *path, const char *name, const struct campaign *campaign) {
  struct error error;
  bool of_outcome;
  if (!campaign_quantity(campaign->scene->kind, name, &of_outcome, &error))
    document_report_error(node, path, &error);
}

/* The quantity that decides about settings or seeds, if a run has it; else what the scene is made for. */
static const char *main_quantity(const struct campaign *campaign) {
  const char *const asked[] = {campaign->accuracy_quantity, campaign->until_quantity};
  struct error error;
  bool of_outcome;
  for (size_t i = 0; i < sizeof asked / sizeof asked[0]; i++)
    if (asked[i][0] && campaign_quantity(campaign->scene->kind, asked[i], &of_outcome, &error))
      return asked[i];
  return scene_headline(campaign->scene);
}

/* For people, widths of the rule are in the unit that the user wrote. */
static void note_unit(document_node *width, struct campaign *campaign) {
  const char *text = width ? document_scalar(width) : NULL;
  char *unit = NULL;
  const double written = text ? strtod(text, &unit) : 0;
  campaign->until_scale = written > 0 && campaign->until_half_width > 0 ? written / campaign->until_half_width : 1;
  unit += unit ? strspn(unit, " ") : 0;
  snprintf(campaign->until_unit, sizeof campaign->until_unit, unit && *unit ? " %s" : "", unit);
}

/* A width that is not per cent has the unit of the quantity. A text without a number or a unit is told already. */
static void check_width(document_node *width, const char *path, const char *quantity, const struct campaign *campaign) {
  struct error error;
  struct field_value ignored;
  bool of_outcome;
  const char *text = width ? document_scalar(width) : NULL;
  const struct field *row = campaign_quantity(campaign->scene->kind, quantity, &of_outcome, &error);
  const struct field any_unit = {.path = path,
                                 .unit = "1",
                                 .minimum = 0,
                                 .maximum = HUGE_VAL,
                                 .flags = FIELD_ANY_UNIT | FIELD_ABOVE_MINIMUM};
  if (!text || !row || strchr(text, '%') || strcmp(text, "off") == 0 ||
      field_parse(&any_unit, text, &ignored, &error) != STATUS_OK)
    return;
  const struct field in_unit = {.path = path,
                                .unit = row->unit ? ask_result_unit(row, campaign->scene->kind->dimensions) : "1",
                                .minimum = -HUGE_VAL,
                                .maximum = HUGE_VAL};
  document_value(width, &in_unit, &ignored);
}

static void check_quantities(document_node *root, bool stored, struct campaign *campaign) {
  char *const follow[] = {campaign->until_quantity, campaign->accuracy_quantity};
  if (!document_key(root, "quantity"))
    snprintf(campaign->quantity, sizeof campaign->quantity, "%s", main_quantity(campaign));
  for (size_t i = 0; i < sizeof follow / sizeof follow[0]; i++)
    if (!follow[i][0])
      memcpy(follow[i], campaign->quantity, sizeof campaign->quantity);
  struct error error;
  bool exponent;
  enum exponent_method method;
  enum estimates_window window;
  document_node *quantity = document_key(root, "quantity");
  document_node *until = key_of(key_of(key_of(root, "seeds"), "until"), "quantity");
  document_node *accuracy = key_of(document_key(root, "accuracy"), "quantity");
  /* Exponents are refused, although a study of convergence has them: an exponent belongs to a point and has no mean
   * over runs. */
  if (accuracy && estimates_named(campaign->accuracy_quantity, &exponent, &method, &window, &error) != STATUS_OK)
    document_report_error(accuracy, "accuracy.quantity", &error);
  else if (accuracy && !exponent)
    check_quantity(accuracy, "accuracy.quantity", campaign->accuracy_quantity, campaign);
  check_quantity(quantity ? quantity : document_key(root, "scene"), "quantity", campaign->quantity, campaign);
  if (until)
    check_quantity(until, "seeds.until.quantity", campaign->until_quantity, campaign);
  document_node *half_width = key_of(key_of(key_of(root, "seeds"), "until"), "half_width");
  note_unit(half_width, campaign);
  if (!stored) { /* older programs took a width without a unit */
    check_width(half_width, "seeds.until.half_width", campaign->until_quantity, campaign);
    check_width(key_of(document_key(root, "accuracy"), "within"), "accuracy.within", campaign->accuracy_quantity,
                campaign);
  }
  if (half_width && !campaign->until_of_value && campaign->until_half_width >= 1 &&
      is_share_of(campaign, campaign->until_quantity))
    document_report(
        half_width, "seeds.until.half_width",
        "%s is a share between 0 and 1, so no interval is as wide as %g; %g per cent of the mean is written "
        "'%g %%'",
        campaign->until_quantity, campaign->until_half_width, campaign->until_half_width, campaign->until_half_width);
}

/* Reports what a scene refuses at the entry of `set` or `vary` that its message names. False: there is none. */
static bool report_entry(document_node *root, const char *section, const struct campaign *campaign,
                         const struct error *error) {
  document_node *entries = document_key(root, section);
  for (size_t i = 0; entries && i < document_count(entries); i++) {
    const char *key = NULL;
    char path[320];
    document_node *node = document_item(entries, i, &key);
    const struct field *row = key ? field_find_in(campaign->scene->kind->inputs, key, campaign->scene->inputs, NULL)
                                  : NULL;
    const size_t length = row ? strlen(row->path) : 0;
    if (!row || strncmp(error->message, row->path, length) != 0 || strncmp(error->message + length, ": ", 2) != 0)
      continue;
    snprintf(path, sizeof path, "%s.%.300s", section, key);
    document_report(node, path, "%s", error->message + length + 2);
    return true;
  }
  return false;
}

/* Does the message name an input that `vary` gives, if perhaps misspelt? With an error in `vary`, its values are not
 * known. */
static bool names_varied(document_node *vary, const char *message) {
  char words[sizeof((struct error *)0)->message], *rest = words;
  snprintf(words, sizeof words, "%s", message + strcspn(message, ":")); /* behind the input of `set` itself */
  for (char *word; (word = strsep(&rest, " ,:;'()"));)
    for (size_t i = 0; *word && vary && i < document_count(vary); i++) {
      const char *key = NULL;
      (void)document_item(vary, i, &key);
      struct text_guess guess = text_guess(key ? key : "");
      text_guess_offer(&guess, word);
      if (key && (guess.nearest || strcmp(word, key) == 0 || text_ends_in_words(word, key, ".")))
        return true;
    }
  return false;
}

/* Tries every point of a small design, or the first ones of a large one. The driver writes notes about the others. A
 * point that cannot be run is reported with its line in the file, or at the key that made it. */
static void check_points(document_node *root, struct campaign *campaign) {
  enum { TRIED = 1000 };
  struct error error = {0};
  CAMPAIGN_WALK walk = {0};
  document_node *design = document_key(root, "design"), *vary = document_key(root, "vary");
  bool good = campaign_walk_begin(&walk, campaign, &error) == STATUS_OK;
  if (!good)
    document_report_error(design ? design : vary ? vary : root, "design", &error);
  for (int64_t i = 0; good && i < TRIED && campaign_walk_next(&walk); i++) {
    struct scene *scene = campaign_walk_scene(&walk, &error);
    good = scene != NULL;
    scene_free(scene);
    if (good)
      continue;
    if (error.status == STATUS_MEMORY)
      document_report_error(root, NULL, &error);
    else if (campaign->point_lines)
      document_report(design, "design.file", "%s:%lld: %s", campaign->design.file, (long long)campaign->point_lines[i],
                      error.message);
    else if (!report_entry(root, "set", campaign, &error) && !report_entry(root, "vary", campaign, &error))
      document_report_error(vary ? vary : root, vary ? "vary" : "scene", &error);
  }
}

/* The store is named after the campaign when the document does not name it. */
static void check_store(document_node *root, struct campaign *campaign) {
  document_node *name = document_key(root, "name"), *store = document_key(root, "store");
  if (!campaign->store[0] &&
      snprintf(campaign->store, sizeof campaign->store, "%s.db", campaign->name) >= (int)sizeof campaign->store)
    document_report(name, "name", "too long to name the store after it; give `store`");
  if (!store && strchr(campaign->name, '/')) /* a name must not lead to another folder */
    document_report(name, "name",
                    "\"%s\" has a slash, and the store would be in another folder; take it out, or give `store`",
                    campaign->name);
  if (campaign->store[0] && store_name_refused(campaign->store))
    document_report(store, "store", "%s", store_name_refused(campaign->store));
}

/* Is the axis of this key an own one: linked to no other, and no other to it? */
static bool stands_alone(document_node *vary, const char *key) {
  for (size_t i = 0; i < document_count(vary); i++) {
    const char *name = NULL;
    document_node *linked = key_of(document_item(vary, i, &name), "linked");
    if (linked && (strcmp(name, key) == 0 || document_kind(linked) != DOCUMENT_SCALAR ||
                   text_ends_in_words(key, document_scalar(linked), ".") ||
                   text_ends_in_words(document_scalar(linked), key, ".")))
      return false;
  }
  return true;
}

/* An input that the command line sets does not vary: the later layer wins whole. */
static void drop_set_axes(document_node *set, document_node *vary, const struct scene *scene) {
  struct error error;
  for (size_t i = 0; set && vary && i < document_count(set); i++) {
    const char *path = NULL, *key = NULL;
    if (!document_is_put(document_item(set, i, &path)))
      continue;
    const struct field *row = field_find_in(scene->kind->inputs, path, scene->inputs, &error);
    for (size_t a = document_count(vary); row && a-- > 0;) {
      (void)document_item(vary, a, &key);
      if (key && field_find_in(scene->kind->inputs, key, scene->inputs, &error) == row && stands_alone(vary, key))
        document_graft_drop(vary, key);
    }
  }
}

void campaign_read(document_node *root, const char *folder, bool stored, struct campaign *campaign) {
  static const char *const also[] = {"vary", "set", "design", "keep", NULL};
  field_defaults(&campaign_table, campaign);
  const bool plain = document_read(root, &campaign_table, also, campaign);
  document_node *set = document_key(root, "set");
  read_keep(document_key(root, "keep"), campaign);
  read_design(document_key(root, "design"), campaign);
  check_seeds(root, stored, campaign);
  check_accuracy(root, campaign);
  check_store(root, campaign);

  struct error error = {0};
  document_node *scene = document_key(root, "scene"), *vary = document_key(root, "vary");
  document_node *file = key_of(document_key(root, "design"), "file");
  if (!scene || !campaign->scene_reference[0])
    return; /* document_read has reported it; the other keys cannot be read without a scene */
  if (scene_load(campaign->scene_reference, folder, &campaign->scene, &error) != STATUS_OK) {
    document_report_error(scene, "scene", &error);
    return;
  }
  if (campaign->keep != CAMPAIGN_KEEP_NONE && engine_has_fields(campaign->scene->kind, "fields files", &error))
    document_report_error(document_key(root, "keep"), "keep", &error);
  bool varied = true;
  if (set && vary && document_kind(set) == DOCUMENT_MAPPING && document_kind(vary) == DOCUMENT_MAPPING)
    drop_set_axes(set, vary, campaign->scene);
  if (file && vary)
    document_report(vary, "vary", "the columns of design.file are the varied inputs; leave vary out");
  if (file)
    varied = campaign_points_read(file, folder, campaign) && !vary;
  else
    varied = campaign_vary_read(vary, folder, campaign);
  const bool good = campaign_read_set(set, folder, campaign, campaign->scene, stored,
                                      "set here and varied in `vary`; leave one of them out");
  check_quantities(root, stored, campaign);
  if (plain && varied && good && (stored || check_rocks(file ? file : vary, campaign)))
    check_points(root, campaign);
  else if (good && set && scene_check(campaign->scene, &error) != STATUS_OK && /* not only the errors of `vary` */
           (varied || !names_varied(vary, error.message)))
    (void)report_entry(root, "set", campaign, &error);
}
