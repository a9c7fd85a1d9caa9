/* Reads the measurements. */
#include "campaign/document/observed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign_read.h"
#include "schemas/memory.h"
#include "schemas/rows.h"

#define COUNT_ABOVE "count_above"
#define SHARE_ABOVE "share_above"

static const struct field root_rows[] = {
    ROW_OF(observed, name, name, FIELD_TEXT, NULL, .flags = FIELD_REQUIRED, .doc = "Name of the measurements."),
    ROW_OF(observed, source, source, FIELD_TEXT, NULL, .flags = FIELD_REQUIRED,
           .doc = "Who measured it, and where it is printed."),
};
static const struct field_table root_table = FIELD_TABLE(root_rows, struct observed, "measurements",
                                                         "What was measured, for clast fit.");

static const struct field shot_rows[] = {
    ROW_OF(observed_shot, name, name, FIELD_TEXT, NULL, .text = "", .doc = "Name of the shot."),
    ROW_OF(observed_shot, specimens, specimens, FIELD_INTEGER, "1", .number = 1, .minimum = 1, .maximum = 1000000,
           .doc = "How many specimens each value is the mean of."),
};
static const struct field_table shot_table = FIELD_TABLE(shot_rows, struct observed_shot, "shot",
                                                         "One experiment, or the mean of several equal ones.");

/* value, error and resolution have the quantity's unit; read_datum() fills it in. */
static const struct field datum_rows[] = {
    ROW_OF(observed_datum, quantity, quantity, FIELD_TEXT, NULL, .flags = FIELD_REQUIRED,
           .doc = "The measured result of a run."),
    REAL_OF(observed_datum, value, value, "1", 0, -HUGE_VAL, HUGE_VAL, .flags = FIELD_REQUIRED,
            .doc = "The measured value."),
    REAL_OF(observed_datum, error, error, "1", 0, 0, HUGE_VAL, .doc = "Standard deviation of the measurement."),
    REAL_OF(observed_datum, resolution, resolution, "1", NAN, 0, HUGE_VAL,
            .doc = "Standard deviation of the change by a finer resolution."),
    REAL_OF(observed_datum, share, share, "1", 0, 0, 1, .flags = FIELD_ABOVE_MINIMUM | FIELD_BELOW_MAXIMUM,
            .doc = "Share of the body that counted fragments are heavier than."),
};
enum { QUANTITY, VALUE, ERROR, RESOLUTION, SHARE, DATUM_ROWS };

struct fragments {
  double total, complete; /* kg, or kg/m: only their ratios count */
  double resolution;      /* as a share of each number that follows from the list; NaN: not given */
};

static const struct field fragments_rows[] = {
    REAL_OF(fragments, total, total, "kg", 0, 0, HUGE_VAL, .flags = FIELD_REQUIRED | FIELD_ABOVE_MINIMUM,
            .doc = "Mass of the body."),
    REAL_OF(fragments, complete, complete, "kg", 0, 0, HUGE_VAL, .flags = FIELD_REQUIRED | FIELD_ABOVE_MINIMUM,
            .doc = "The list has every fragment from this mass on."),
    REAL_OF(fragments, resolution, resolution, "1", NAN, 0, HUGE_VAL,
            .doc = "Standard deviation of the change by a finer resolution, as a share (10 %) of M_1/M and of each "
                   "number of fragments that follow from the list."),
};
static const struct field_table fragments_table = FIELD_TABLE(fragments_rows, struct fragments, "fragments",
                                                              "Masses of the fragments of a shot.");

struct reading {
  const struct campaign *campaign;
  struct observed *observed;
};

static struct observed_datum *add_datum(struct reading *r, document_node *node) {
  struct observed *m = r->observed;
  if (m->datum_count == OBSERVED_DATA) {
    document_report(node, "measured", "more than %d numbers in all: keep the most important ones", OBSERVED_DATA);
    return NULL;
  }
  struct observed_datum *datum = &m->data[m->datum_count++];
  *datum = (struct observed_datum){.resolution = NAN, .shot = m->shot_count - 1};
  return datum;
}

/* Finds the quantity of a name. */
static bool find_quantity(struct reading *r, document_node *node, struct observed_datum *datum) {
  struct error error = {0};
  bool exponent = false;
  struct ask_specimens_quantity *ask = &datum->ask;
  if (strcmp(datum->quantity, COUNT_ABOVE) == 0 || strcmp(datum->quantity, SHARE_ABOVE) == 0) {
    ask->kind = datum->quantity[0] == COUNT_ABOVE[0] ? ASK_SPECIMENS_COUNT : ASK_SPECIMENS_SHARE;
    return true;
  }
  status code = estimates_named(datum->quantity, &exponent, &ask->method, &ask->window, &error);
  if (code == STATUS_OK && exponent) {
    ask->kind = ASK_SPECIMENS_EXPONENT;
    return true;
  }
  if (code == STATUS_OK)
    ask->row = campaign_quantity(r->campaign->scene->kind, datum->quantity, &ask->of_outcome, &error);
  if (ask->row)
    return true;
  document_report(node, "quantity", "%s; or beta, beta_METHOD_WINDOW, " COUNT_ABOVE ", " SHARE_ABOVE, error.message);
  return false;
}

static void read_datum(struct reading *r, document_node *node) {
  if (document_kind(node) != DOCUMENT_MAPPING) {
    document_report(node, "measured", "expected {quantity: NAME, value: NUMBER, error: NUMBER}");
    return;
  }
  if (document_key(node, "fragments")) {
    document_report(document_key(node, "fragments"), "fragments",
                    "a list of masses is a key of the shot, as `measured` is");
    return;
  }
  struct observed_datum *datum = add_datum(r, node);
  document_node *quantity = document_key(node, "quantity"), *share = document_key(node, "share");
  const char *name = quantity ? document_scalar(quantity) : NULL;
  if (!datum)
    return;
  struct field rows[DATUM_ROWS];
  memcpy(rows, datum_rows, sizeof rows);
  snprintf(datum->quantity, sizeof datum->quantity, "%.200s", name ? name : "");
  if (name && !find_quantity(r, quantity, datum))
    return;
  const bool above = datum->ask.kind == ASK_SPECIMENS_COUNT || datum->ask.kind == ASK_SPECIMENS_SHARE;
  const struct field *row = datum->ask.row;
  for (int k = VALUE; row && row->unit && k <= RESOLUTION; k++)
    rows[k].unit = ask_result_unit(row, r->campaign->scene->kind->dimensions);
  const struct field_table table = FIELD_TABLE(rows, struct observed_datum, "measured", "One number of one shot.");
  document_read(node, &table, NULL, datum);
  datum->ask.share = datum->share;
  const double low = row ? row->minimum : above ? 0 : -HUGE_VAL;
  const double high = row ? row->maximum : datum->ask.kind == ASK_SPECIMENS_SHARE ? 1 : HUGE_VAL;
  if (name && !(datum->value >= low && datum->value <= high))
    document_report(document_key(node, "value"), "value", "%s lies between %g and %g, not at %.6g", name, low, high,
                    datum->value);
  if (name && above && !share)
    document_report(node, "measured", "%s needs 'share': fragments heavier than this share of the body",
                    datum->quantity);
  if (name && !above && share)
    document_report(share, "share", "only " COUNT_ABOVE " and " SHARE_ABOVE " have a share");
}

/* ---- a list of masses ---- */

/* Takes the largest fragment, and the numbers of fragments above up to four masses. These are evenly spaced in the
 * logarithm, from the second largest fragment to the mass down to which the list is complete. A fragment of just such a
 * mass counts. Rounding must not decide that, so the masses are smaller by a billionth, which no balance resolves. */
static void take_masses(struct reading *r, document_node *node, size_t count, double *masses,
                        const struct fragments *of) {
  enum { STEPS = 4 };
  const double total = of->total;
  qsort(masses, count, sizeof *masses, sample_descending);
  struct observed_datum *largest = add_datum(r, node);
  if (!largest)
    return;
  snprintf(largest->quantity, sizeof largest->quantity, "%s", OUTCOME_NAME(largest_fraction));
  find_quantity(r, node, largest);
  largest->value = masses[0] / total;
  largest->resolution = of->resolution * largest->value;
  const double from = count > 1 ? masses[1] / total : 0, to = of->complete / total;
  for (int step = 1; step <= STEPS && from > to * 1.2; step++) {
    struct observed_datum *datum = add_datum(r, node);
    if (!datum)
      return;
    snprintf(datum->quantity, sizeof datum->quantity, COUNT_ABOVE);
    datum->ask.kind = ASK_SPECIMENS_COUNT;
    datum->share = datum->ask.share = (1 - 1e-9) * from * pow(to / from, (double)step / STEPS);
    for (size_t i = 0; i < count; i++)
      datum->value += masses[i] > datum->share * total;
    datum->resolution = of->resolution * datum->value;
  }
}

static void read_fragments(struct reading *r, document_node *node) {
  static const char *const also[] = {"masses", NULL};
  struct field row = {.path = "masses",
                      .kind = FIELD_REAL,
                      .unit = "kg",
                      .maximum = HUGE_VAL,
                      .flags = FIELD_ABOVE_MINIMUM};
  struct field rows[] = {fragments_rows[0], fragments_rows[1], fragments_rows[2]};
  struct field_table table = fragments_table;
  struct fragments from = {.resolution = NAN};
  document_node *list = document_kind(node) == DOCUMENT_MAPPING ? document_key(node, "masses") : NULL;
  if (!list || document_kind(list) != DOCUMENT_SEQUENCE || document_count(list) == 0) {
    document_report(
        node, "fragments",
        "expected {total: mass of the body, complete: the list has every fragment from this mass on, masses: [...]}");
    return;
  }
  const size_t count = document_count(list);
  OWNED double *masses = calloc(count, sizeof *masses);
  double sum = 0;
  const char *total = document_key(node, "total") ? document_scalar(document_key(node, "total")) : NULL;
  if (r->campaign->scene->kind->dimensions == 2 && total && strchr(total, '/'))
    row.unit = rows[0].unit = rows[1].unit = "kg/m";
  table.rows = rows;
  bool good = document_read(node, &table, also, &from);
  if (!masses)
    document_report_memory(node, "fragments");
  for (size_t i = 0; masses && i < count; i++) {
    struct field_value mass = {0};
    good &= document_value(document_item(list, i, NULL), &row, &mass);
    sum += masses[i] = mass.number;
  }
  if (masses && good && sum > 1.02 * from.total)
    document_report(list, "masses", "the fragments together weigh %.15g %% of the total; expected at most 102 %%",
                    100 * sum / from.total);
  else if (masses && good)
    take_masses(r, list, count, masses, &from);
}

/* ---- shots ---- */

/* The inputs of a shot as words of a command. */
static void note_set(document_node *set, struct observed_shot *shot) {
  for (size_t i = 0; set && document_kind(set) == DOCUMENT_MAPPING && i < document_count(set); i++) {
    const char *key = NULL, *value = document_scalar(document_item(set, i, &key));
    char item[3 * FIELD_TEXT_SIZE];
    snprintf(item, sizeof item, "%s=%s", key, value ? value : "");
    text_append(shot->set, sizeof shot->set, " --set");
    text_append_word(shot->set, sizeof shot->set, item);
  }
}

static void read_shot(struct reading *r, document_node *node) {
  static const char *const also[] = {"set", "measured", "fragments", NULL};
  struct observed *m = r->observed;
  if (m->shot_count == OBSERVED_SHOTS) {
    document_report(node, "shots", "more than %d shots", OBSERVED_SHOTS);
    return;
  }
  struct observed_shot *shot = &m->shots[m->shot_count++];
  field_defaults(&shot_table, shot);
  shot->scene = scene_copy(r->campaign->scene);
  if (document_kind(node) != DOCUMENT_MAPPING) {
    document_report(node, "shots", "expected a mapping with `measured` or `fragments`, and the inputs of this shot");
    return;
  }
  document_read(node, &shot_table, also, shot);
  if (!shot->name[0])
    snprintf(shot->name, sizeof shot->name, "shot %zu", m->shot_count);
  document_node *data = document_key(node, "measured"), *fragments = document_key(node, "fragments");
  campaign_read_set(document_key(node, "set"), NULL, r->campaign, shot->scene, false,
                    "known here and unknown in the campaign (`vary`); leave one of them out");
  note_set(document_key(node, "set"), shot);
  if (data && (document_kind(data) != DOCUMENT_SEQUENCE || document_count(data) == 0))
    document_report(data, "measured", "expected a list of {quantity: NAME, value: NUMBER, error: NUMBER}");
  else
    for (size_t i = 0; data && i < document_count(data); i++)
      read_datum(r, document_item(data, i, NULL));
  if (fragments)
    read_fragments(r, fragments);
  if (!data && !fragments)
    document_report(node, "shots", "no measurement: give `measured` or `fragments`");
}

static void read_all(struct reading *r, document_node *root) {
  static const char *const also[] = {"shots", NULL};
  field_defaults(&root_table, r->observed);
  document_read(root, &root_table, also, r->observed);
  document_node *shots = document_key(root, "shots");
  if (!shots || document_kind(shots) != DOCUMENT_SEQUENCE || document_count(shots) == 0) {
    document_report(shots ? shots : root, "shots", "expected a list of shots, each with its measurements");
    return;
  }
  for (size_t i = 0; i < document_count(shots); i++)
    read_shot(r, document_item(shots, i, NULL));
}

static status from_document(struct document *document, const struct campaign *campaign, struct observed **out,
                            struct error *error) {
  struct reading r = {.campaign = campaign, .observed = memory_small(1, sizeof *r.observed)};
  read_all(&r, document_root(document));
  const status code = document_verdict(document, error);
  if (code)
    observed_free(r.observed);
  else
    *out = r.observed;
  return code;
}

status observed_parse(const char *name, const char *text, size_t size, const struct campaign *campaign,
                      struct observed **out, struct error *error) {
  DOCUMENT document = NULL;
  *out = NULL;
  TRY(document_parse(name, text, size, &document, error));
  return from_document(document, campaign, out, error);
}

status observed_load(const char *path, const struct campaign *campaign, struct observed **out, struct error *error) {
  DOCUMENT document = NULL;
  *out = NULL;
  TRY(document_open(path, &document, error));
  return from_document(document, campaign, out, error);
}

void observed_free(struct observed *observed) {
  for (size_t i = 0; observed && i < observed->shot_count; i++)
    scene_free(observed->shots[i].scene);
  free(observed);
}

void observed_label(const struct observed *observed, size_t datum, char *label, size_t size) {
  const struct observed_datum *d = &observed->data[datum];
  const char *shot = observed->shot_count > 1 ? observed->shots[d->shot].name : "";
  if (d->ask.kind == ASK_SPECIMENS_COUNT)
    snprintf(label, size, "%s%sfragments above %.3g M", shot, shot[0] ? ": " : "", d->share);
  else if (d->ask.kind == ASK_SPECIMENS_SHARE)
    snprintf(label, size, "%s%smass share above %.3g M", shot, shot[0] ? ": " : "", d->share);
  else
    snprintf(label, size, "%s%s%s", shot, shot[0] ? ": " : "", d->ask.row ? d->ask.row->path : d->quantity);
}
