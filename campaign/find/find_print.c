/* The answer of a search as a sentence, as rows, and as a picture. */
#include "campaign/find/find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/terminal/words.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

static const double LITTLE = 0.9; /* of a width, after twice the runs: 0.71 is usual */
static const double FASTER = 0.7; /* of the width by the root law: it does not hold yet */
static const double APART = 0.2;  /* of the bracket; less than the first values are */
enum { BINS = 10, SENTENCE = 2048 };

static const char *show_value(const struct find *find, const struct field_value *value, char text[FIND_TEXT]) {
  design_axis_show(&find->axis, value, text, FIND_TEXT);
  text_powers(text, FIND_TEXT);
  return text;
}

static const char *show(const struct find *find, double x, char text[FIND_TEXT]) {
  struct field_value value;
  find_value(find, x, &value);
  return show_value(find, &value, text);
}

/* The value at x with the digits that the interval from `low` to `high` allows. */
static struct field_value round_within(const struct find *find, double x, double low, double high) {
  struct field_value ends[2], value;
  find_value(find, fmax(low, 0), &ends[0]);
  find_value(find, fmin(high, 1), &ends[1]);
  find_value(find, fmin(fmax(x, 0), 1), &value);
  const double width = fabs(ends[1].number - ends[0].number);
  if (value.kind == FIELD_REAL && width > 0) {
    const char *unit;
    const double scale = find_unit(find, &unit);
    const double digits = find->logarithmic ? fmin(width, fabs(value.number)) : width;
    const double step = pow(10, floor(log10(digits / scale)) - 1) * scale;
    const double places = value.number / step;
    value.number = step * (x == low ? floor(places + 1e-6) : x == high ? ceil(places - 1e-6) : round(places));
  }
  return value;
}

const char *find_show_within(const struct find *find, double x, double low, double high, char text[FIND_TEXT]) {
  const struct field_value value = round_within(find, x, low, high);
  return show_value(find, &value, text);
}

/* ---- the sentence ---- */

static void show_level(const struct find *find, char level[FIND_TEXT]) {
  const struct field real = find_level_row(find);
  field_show(&real, &(struct field_value){.kind = FIELD_REAL, .number = find->level}, level, FIND_TEXT);
}

static void write_subject(const struct find *find, char *text, size_t size) {
  char level[FIND_TEXT];
  const struct field *row = find->quantity.row;
  show_level(find, level);
  if (isnan(find->share))
    snprintf(text, size, "the mean of %s\n%s", row->path, level);
  else
    snprintf(text, size, "the share of runs with %s above %s\n%g", row->path, level, find->share);
}

static void write_contradiction(const struct find *find, char text[SENTENCE]) {
  const struct crossing *found = &find->found;
  char at[FIND_TEXT];
  if (found->contradicted && found->kind == CROSSING_OPEN && found->low < 0 && found->high > 1)
    text_append(text, SENTENCE, " The runs at %s lie on the other side than most.",
                show(find, found->contradiction, at));
  else if (found->contradicted)
    text_append(text, SENTENCE, " But the runs at %s lie on the other side: there may be another crossing.",
                show(find, found->contradiction, at));
}

static void write_sentence(const struct find *find, char text[SENTENCE]) {
  const struct crossing *found = &find->found;
  char subject[FIELD_TEXT_SIZE + 3 * FIND_TEXT], low[FIND_TEXT], high[FIND_TEXT], at[FIND_TEXT], mark[UNCERTAINTY_TEXT];
  write_subject(find, subject, sizeof subject);
  char *level = strchr(subject, '\n');
  *level++ = '\0';
  subject[0] = found->kind == CROSSING_OPEN ? 't' : 'T';
  const char *input = find->input->path;
  double least, most; /* places with results */
  find_show_within(find, found->low, found->low, found->high, low);
  find_show_within(find, found->high, found->low, found->high, high);
  uncertainty_mark(&find->doubts, mark);
  text[0] = '\0';
  switch (found->kind) {
  case CROSSING_FOUND:
    text_append(text, SENTENCE, "%s %s through %s at %s = %s%s (95 %% interval %s to %s).", subject,
                found->rising ? "rises" : "falls", level, input,
                find_show_within(find, found->at, found->low, found->high, at), mark, low, high);
    write_contradiction(find, text);
    break;
  case CROSSING_ABOVE:
  case CROSSING_BELOW:
    least = 1;
    most = 0;
    for (size_t i = 0; i < find->runs; i++)
      if (isfinite(find->y[i])) {
        least = fmin(least, find->x[i]);
        most = fmax(most, find->x[i]);
      }
    text_append(text, SENTENCE,
                "%s is %s %s for %s from %s to %s%s: no crossing in the bracket (95 %%, from all %zu runs). "
                "A rise and a fall between the values that ran may be missed.",
                subject, found->kind == CROSSING_ABOVE ? "above" : "below", level, input, show(find, least, low),
                show(find, most, high), mark, found->n);
    break;
  case CROSSING_SEVERAL:
    text_append(text, SENTENCE, "%s crosses %s several times%s", subject, level, mark);
    for (size_t i = 0; i < found->parts; i++)
      text_append(text, SENTENCE, "%s between %s and %s", i ? "," : ", at ",
                  find_show_within(find, found->part[i].low, found->part[i].low, found->part[i].high, low),
                  find_show_within(find, found->part[i].high, found->part[i].low, found->part[i].high, high));
    text_append(text, SENTENCE, " of %s. Choose one with --from and --to.", input);
    break;
  case CROSSING_PLATEAU:
    text_append(text, SENTENCE, "%s has a plateau at %s, within 3 %% of its range, for %s from %s to %s%s.", subject,
                level, input, low, high, mark);
    break;
  case CROSSING_OPEN:
    text_append(text, SENTENCE, "Not decided%s: %s crosses %s ", mark, subject, level);
    text_append(text, SENTENCE,
                found->low < 0 && found->high > 1 ? "anywhere, or not in the bracket of %s."
                : found->low < 0                  ? "at %s below %s, or not in the bracket."
                                                  : "at %s above %s, or not in the bracket.",
                input, found->low < 0 ? high : low);
    write_contradiction(find, text);
    break;
  }
}

/* Is the answer that nothing crosses? */
static bool is_none(const struct find *find) {
  return find->found.kind == CROSSING_ABOVE || find->found.kind == CROSSING_BELOW;
}

/* ---- the runs along the input ---- */

struct bin {
  double low, high, x; /* places, and the mean of the runs' */
  size_t n, above;
  struct ask_doubts doubts; /* only the number of runs in doubt */
  struct sample_summary mean;
};

/* Pools the runs, in order of the input, into bins of whole places. A bin has at least 1 / `BINS` of them, but places
 * that are far apart are not pooled: a second crossing could be between them. So there are at most `BINS` + 1 bins and
 * one for each such gap. */
static status make_bins(const struct find *find, struct bin *bins, size_t *count, struct error *error) {
  OWNED double(*pairs)[3] = NULL;
  const struct sample_range range = sample_range(find->quantity.row);
  OWNED double *values = NULL;
  size_t n = 0;
  TRY(memory_array(&pairs, find->runs, sizeof *pairs, "the runs of a search", error));
  TRY(memory_array(&values, find->runs, sizeof *values, "the runs of a search", error));
  for (size_t i = 0; i < find->runs; i++)
    if (isfinite(find->y[i])) {
      pairs[n][0] = find->x[i];
      pairs[n][2] = find->doubtful[i];
      pairs[n++][1] = find->y[i];
    }
  qsort(pairs, n, sizeof *pairs, sample_ascending); /* by x */
  *count = 0;
  for (size_t i = 0, from = 0; i < n; i++) {
    values[i - from] = pairs[i][1];
    const size_t in = i + 1 - from;
    if (i + 1 < n && (pairs[i + 1][0] == pairs[i][0] || (in < n / BINS && pairs[i + 1][0] - pairs[i][0] < APART)))
      continue;
    struct bin *bin = &bins[(*count)++];
    *bin = (struct bin){.low = pairs[from][0], .high = pairs[i][0], .n = in};
    for (size_t k = from; k <= i; k++) {
      bin->x += pairs[k][0];
      bin->above += pairs[k][1] > find->level;
      bin->doubts.doubtful += pairs[k][2] > 0;
    }
    bin->x /= (double)in; /* a sum of parts of equal places at an end may lie beyond it */
    bin->mean = sample_summarise(in, values, 0.95);
    sample_in_range(&bin->mean, &range, 0.95);
    from = i + 1;
  }
  return STATUS_OK;
}

/* May the row's mean lie at the level? Of a share no row has an interval, and a weak one tells nothing. */
static bool may_cross(const struct find *find, const struct bin *bin) {
  return !isnan(find->share) || bin->mean.weak || (bin->mean.low <= find->level && find->level <= bin->mean.high);
}

/* An interval that the bracket cuts: the input may go farther, and the crossing be there. Not where the rows of the
 * table lie on one side of the level at this end, beyond their errors. */
static void write_end(const struct find *find, const struct bin *bins, size_t count, char text[SENTENCE]) {
  const bool one = find->found.kind == CROSSING_FOUND && !find->found.contradicted;
  const bool low = one && find->found.low <= 0 && find->from > find->input->minimum && may_cross(find, &bins[0]);
  const bool high = one && find->found.high >= 1 && find->to < find->input->maximum &&
                    may_cross(find, &bins[count - 1]);
  if (low || high)
    text_append(text, SENTENCE, " The interval ends where the bracket does, and the crossing may be beyond it: %s.",
                !high  ? "a lower --from tells"
                : !low ? "a higher --to tells"
                       : "a lower --from and a higher --to tell");
}

static status print_bins(const struct find *find, const struct bin *bins, size_t count, bool quiet,
                         struct error *error) {
  bool any_weak = false, all_one = false, holds = false;
  const struct sample_range range = sample_range(find->quantity.row);
  char text[FIND_TEXT], mean[2 * UNCERTAINTY_TEXT], from[FIELD_TEXT_SIZE + 8], of[FIELD_TEXT_SIZE + 40], above[128];
  show_level(find, text);
  snprintf(from, sizeof from, "%s from", find->input->path);
  const struct field real = find_level_row(find);
  const char *unit = field_shown_unit(&real);
  snprintf(of, sizeof of, *unit ? "mean %s [%s]" : "mean %s", find->quantity.row->path, unit);
  snprintf(above, sizeof above, "share above %s", text);
  TABLE table = table_new(TABLE_TEXT, stdout);
  table_columns(table, (const char *const[]){from, "to", "runs", of, above, NULL});
  for (size_t i = 0; i < count; i++) {
    table_text(table, find_show_within(find, bins[i].low, 0, 0.1, text));
    table_text(table, find_show_within(find, bins[i].high, 0, 0.1, text));
    table_integer(table, (int64_t)bins[i].n);
    if (uncertainty_all_one(bins[i].mean.mean, bins[i].mean.half_width, bins[i].mean.low, &range, mean))
      all_one = true;
    else
      uncertainty_cell(bins[i].mean.mean, bins[i].mean.half_width, &range, mean);
    any_weak |= bins[i].mean.weak;
    holds |= isnan(find->share) && bins[i].mean.low < find->level && find->level < bins[i].mean.high;
    if (bins[i].mean.weak)
      text_append(mean, sizeof mean, "~");
    uncertainty_mark(&bins[i].doubts, mean + strlen(mean));
    table_text(table, mean);
    table_fixed(table, (double)bins[i].above / (double)bins[i].n, 2);
  }
  TRY(table_end(table, error));
  fflush(stdout);
  if (quiet)
    return STATUS_OK;
  words_print(stderr, "",
              "clast: runs of neighbouring values are one row, from its least to its largest value, with the mean over "
              "them and its 95 %% interval%s%s",
              any_weak ? "; ~: weak, too few runs" : "", all_one ? "; " UNCERTAINTY_ALL_ONE : "");
  if (holds && is_none(find))
    words_print(stderr, "",
                "clast: the interval of one row holds the level; it comes from the runs of that row alone. The answer "
                "comes from all runs. It assumes that the mean only rises or only falls");
  return STATUS_OK;
}

/* ---- rows for programs ---- */

static double value_at(const struct find *find, double x) {
  struct field_value value;
  if (!(x >= 0 && x <= 1))
    return NAN;
  find_value(find, x, &value);
  return field_number(&value);
}

static status print_rows(const struct find *find, enum table_format format, struct error *error) {
  const struct crossing *found = &find->found;
  const bool has = !is_none(find);
  const size_t parts = found->kind == CROSSING_SEVERAL ? found->parts : 1;
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"kind", "quantity", "level", "share", "input", "unit", "at", "low95",
                                             "high95", "rising", "narrow", "from", "to", "runs", "runs_without", NULL});
  table_doubt_columns(table);
  for (size_t i = 0; i < parts; i++) {
    const bool one = found->kind == CROSSING_FOUND;
    const double low = found->parts > 1 ? found->part[i].low : found->low;
    const double high = found->parts > 1 ? found->part[i].high : found->high;
    table_text(table, crossing_kind_names[found->kind]);
    table_text(table, find->quantity.row->path);
    table_reals(table, 2, (const double[]){find->level, find->share});
    table_text(table, find->input->path);
    table_text(table, find->input->unit);
    table_reals(table, 3,
                (const double[]){value_at(find, one ? found->at : (double)NAN), value_at(find, has ? low : (double)NAN),
                                 value_at(find, has ? high : (double)NAN)});
    if (one)
      table_boolean(table, found->rising);
    else
      table_missing(table);
    table_boolean(table, find->narrow);
    table_reals(table, 2, (const double[]){find->from, find->to});
    table_integer(table, (int64_t)find->runs);
    table_integer(table, (int64_t)find->failed);
    table_doubt_cells(table, &find->doubts);
  }
  return table_end(table, error);
}

/* The study of the point with this value of the input, and the command that makes it. */
static status read_resolution(const struct find *find, struct store *store, const struct field_value *place,
                              const char *column, struct ask_resolution *resolution, struct error *error) {
  int64_t point = 0;
  char value[FIELD_TEXT_SIZE], set[2 * FIELD_TEXT_SIZE];
  SCENE scene = campaign_point_scene_from(find->base, &find->limits, place, error);
  if (!scene)
    return STATUS_CONTENT;
  TRY(store_point_find(store, scene, &point, error));
  TRY(ask_resolution(point ? store : NULL, point, column, resolution, error));
  snprintf(set, sizeof set, "%s=%s", find->input->path, design_axis_print(&find->axis, place, value, sizeof value));
  const size_t size = sizeof resolution->command;
  resolution->command[0] = '\0';
  if (!text_append(resolution->command, size, "%s --set", find->words) ||
      !text_append_word(resolution->command, size, set) || !text_append(resolution->command, size, " -Q %s", column))
    resolution->command[0] = '\0';
  return STATUS_OK;
}

/* The error of the resolution at the crossing, as the sentence has it. If no study was made there, that at the point of
 * the search that is nearest to it counts. Without a crossing this point is the end where the level is nearest. */
static status tell_resolution(const struct find *find, struct error *error) {
  const struct crossing *found = &find->found;
  const bool one = found->kind == CROSSING_FOUND;
  double x = HUGE_VAL;
  struct ask_resolution resolution, nearest;
  struct field_value place;
  char column[FIELD_TEXT_SIZE], at[FIND_TEXT] = "", text[UNCERTAINTY_TEXT];
  STORE store = NULL;
  for (size_t i = 0; i < find->runs; i++)
    if (isfinite(find->y[i]) && fabs(find->x[i] - found->at) < fabs(x - found->at))
      x = find->x[i];
  if (!isfinite(x))
    return STATUS_OK;
  field_column_name(find->quantity.row->path, column, sizeof column);
  TRY(store_open_reader(find->limits.store, &store, error));
  find_value(find, x, &place);
  show(find, x, at);
  TRY(read_resolution(find, store, &place, column, &nearest, error));
  if (one && nearest.verdict == ASK_RESOLUTION_NOT_STUDIED) {
    const struct field_value shown = round_within(find, found->at, found->low, found->high);
    TRY(field_parse(find->input, design_axis_show(&find->axis, &shown, at, sizeof at), &place, error));
    show_value(find, &shown, at);
    TRY(read_resolution(find, store, &place, column, &resolution, error));
  } else {
    resolution = nearest;
  }
  uncertainty_resolution(&resolution, text);
  fprintf(stderr, "clast: %s at %s = %s: %s\n", column, find->input->path, at, text);
  return STATUS_OK;
}

/* The runs that an interval of the width asked for needs. They are told from two widths, of the runs and of half of
 * them or fewer, that fall as the root of the number of runs. The first rounds halve gaps between places, and widths
 * fall faster. 0: not told. */
static size_t runs_needed(const struct find *find, const struct find_width *before) {
  const double width = find->found.high - find->found.low;
  if (find->found.kind != CROSSING_FOUND || !before || width <= find_widest(find))
    return 0;
  const double by_root = before->width * sqrt((double)before->runs / (double)find->runs);
  return width < FASTER * by_root ? 0 : crossing_runs_for(find->runs, width, find_widest(find));
}

/* The runs do not suffice: how many more are needed, and whether the last ones helped. */
static void write_more(const struct find *find) {
  const double width = find->found.high - find->found.low;
  const struct find_width *before = NULL;
  char text[SENTENCE] = "";
  for (size_t i = 0; i < find->widths; i++)
    if (2 * find->width[i].runs <= find->runs)
      before = &find->width[i];
  const size_t needed = runs_needed(find, before);
  const bool beyond = needed > FIND_MOST_RUNS || find->most >= FIND_MOST_RUNS;
  char why[200] = "One crossing is not sure";
  if (width > find_widest(find) && find->relative)
    snprintf(why, sizeof why, "The interval is %.3g %% of the %sbracket, wider than the %.3g %% asked", 100 * width,
             find->logarithmic ? "logarithm of the " : "", 100 * find->within);
  else if (width > find_widest(find))
    snprintf(why, sizeof why, "The interval is wider than asked");
  if (find->runs < find->most)
    text_append(text, SENTENCE, "%s, and no round fits into the rest of the %zu runs", why, find->most);
  else
    text_append(text, SENTENCE, "%s, and the runs are used up", why);
  text_append(text, SENTENCE, beyond ? ". A search may have at most %d runs" : ": a larger --max-runs goes on.",
              FIND_MOST_RUNS);
  if (needed > FIND_MOST_RUNS)
    text_append(text, SENTENCE, "; the width asked for needs more, if it falls as the root of their number");
  else if (needed > 0 && !beyond)
    text_append(text, SENTENCE, " The width asked for needs about %zu runs, if it falls as the root of their number.",
                needed);
  if (beyond)
    text_append(text, SENTENCE, ": give a larger --within.");
  if (find->found.kind == CROSSING_FOUND && before && width > LITTLE * before->width)
    text_append(text, SENTENCE, " From %zu to %zu runs it became only %.0f %% narrower, so it may take many more.",
                before->runs, find->runs, fmax(100 * (1 - width / before->width), 0));
  words_print(stdout, "", "%s", text);
}

/* Runs at the places of searches along the input that this one does not take: of a search for another level, share or
 * bracket, or of a campaign. */
static status tell_others(const struct find *find, struct error *error) {
  char name[2 * FIELD_TEXT_SIZE];
  int64_t runs = 0;
  STORE store = NULL;
  TRY(store_open_reader(find->limits.store, &store, error));
  find_name(find, name, sizeof name);
  TRY(ask_campaign_runs(store, name, &runs, error));
  const int64_t others = runs - (int64_t)find->runs; /* failed runs count as ours */
  if (others > 0)
    words_print(stderr, "",
                "clast: %lld other runs at places of searches along %s are left out: a search uses the runs at its own "
                "places and seeds alone, so that it answers the same whatever the store has",
                (long long)others, find->input->path);
  return STATUS_OK;
}

status find_print(const struct find *find, enum table_format format, bool quiet, struct error *error) {
  char text[SENTENCE];
  struct bin bins[2 * BINS + 2];
  size_t count;
  if (!table_for_people(format))
    return print_rows(find, format, error);
  TRY(make_bins(find, bins, &count, error));
  write_sentence(find, text);
  write_end(find, bins, count, text);
  words_print(stdout, "", "%s", text);
  if (!find->narrow)
    write_more(find);
  TRY(print_bins(find, bins, count, quiet, error));
  fflush(stdout);
  uncertainty_doubts(&find->doubts, stderr);
  if (quiet)
    return STATUS_OK;
  if (find->failed)
    fprintf(stderr, "clast: %zu of %zu runs have no such result and are left out\n", find->failed, find->runs);
  TRY(tell_others(find, error));
  return tell_resolution(find, error);
}

/* ---- the picture ---- */

status find_print_picture(const struct find *find, const char *path, const struct chart_options *chart,
                          struct error *error) {
  struct bin bins[2 * BINS + 2];
  struct picture_mean means[2 * BINS + 2], level[2], interval[2];
  size_t count;
  char x[CHARTS_LABEL], y[CHARTS_LABEL], column[FIELD_TEXT_SIZE], title[SENTENCE], caption[CHARTS_LABEL] = "";
  const struct crossing *found = &find->found;
  const bool is_share = !isnan(find->share);
  const double at = is_share ? find->share : find->level;
  double least = at, most = at;
  const char *unit;
  const double one_of_unit = find_unit(find, &unit);
  STORE store = NULL;
  TRY(store_open_reader(find->limits.store, &store, error));
  TRY(make_bins(find, bins, &count, error));
  for (size_t i = 0; i < count; i++) {
    const double share = (double)bins[i].above / (double)bins[i].n;
    const struct sample_summary *mean = &bins[i].mean;
    means[i] = (struct picture_mean){value_at(find, bins[i].x) / one_of_unit,
                                     is_share ? share : mean->mean,
                                     is_share ? (double)NAN : mean->low,
                                     is_share ? (double)NAN : mean->high,
                                     NAN,
                                     bins[i].doubts.doubtful > 0};
    least = fmin(least, means[i].y);
    most = fmax(most, means[i].y);
  }
  const double low = value_at(find, fmax(found->low, 0)) / one_of_unit,
               high = value_at(find, fmin(found->high, 1)) / one_of_unit;
  for (int i = 0; i < 2; i++) {
    level[i] = (struct picture_mean){(i ? find->to : find->from) / one_of_unit, at, at, at, NAN, false};
    interval[i] = (struct picture_mean){i ? high : low, at, least, most, NAN, false};
  }
  const struct picture_mean crossing = {value_at(find, found->at) / one_of_unit, at, NAN, NAN, NAN, false};
  const struct picture_curve curves[] = {
      {.label = is_share ? "share of runs above" : "mean of neighbouring runs, 95 % interval",
       .count = count,
       .mean = means},
      {.label = "level", .count = 2, .mean = level, .band = true},
      {.label = "band: 95 % interval of the crossing", .count = 2, .mean = interval, .band = true},
      {.label = "crossing", .count = 1, .mean = &crossing, .scattered = true},
  };
  const bool one = found->kind == CROSSING_FOUND || found->kind == CROSSING_PLATEAU;
  field_column_name(find->input->path, column, sizeof column);
  charts_label(column, x);
  if (*unit)
    text_append(x, sizeof x, " (%s)", unit);
  field_column_name(find->quantity.row->path, column, sizeof column);
  TRY(charts_axis(store, column, y, error));
  if (is_share)
    snprintf(y, sizeof y, "share of runs above the level");
  write_sentence(find, title);
  charts_doubts(NULL, &find->doubts, caption, sizeof caption);
  const struct picture_page page = charts_page(path, chart);
  const struct picture_words words = {title, caption, x, y};
  return picture_curves(&page, &words, found->kind == CROSSING_FOUND ? 4 : one ? 3 : 2, curves, error);
}
