/* Cells that several tables have; a run's results, long for people and wide for programs; spectra as rows, and their
 * distances. */
#include "campaign/print/print.h"

#include <math.h>
#include <string.h>

#include "campaign/terminal/words.h"
#include "schemas/memory.h"

void print_pool_columns(struct table *table, const struct ask_pools *pools) {
  struct ask_column axes[LIMITS_AXES_OF_TABLE];
  size_t count = 0;
  (void)ask_columns_axes(pools->store, true, LIMITS_AXES_OF_TABLE, axes, &count, NULL);
  for (size_t a = 0; a < pools->axes; a++) {
    size_t k = 0;
    while (k < count && strcmp(axes[k].name, pools->column[a]) != 0)
      k++;
    if (k < count)
      table_key(table, &axes[k]);
    else
      table_column(table, pools->column[a], NULL);
  }
  table_column(table, pools->choice.by ? "points" : "point_id", NULL);
}

void print_pool_cells(struct table *table, const struct ask_pools *pools, const struct ask_pool *pool) {
  for (size_t a = 0; a < pools->axes; a++)
    table_value(table, &pool->input[a]);
  table_integer(table, pools->choice.by ? (int64_t)pool->points : pool->data.point_id);
}

/* A withheld value is empty; people see a mark behind one that is in doubt. */
static void value_cell(struct table *table, const struct field *row, const void *object, enum condition_mark mark) {
  if (mark == CONDITION_WITHHELD) {
    table_real(table, NAN);
    return;
  }
  if (row->kind == FIELD_REAL || row->kind == FIELD_INTEGER)
    table_rests_on(table, &(struct ask_doubts){.runs = 1, .doubtful = mark == CONDITION_MARKED});
  table_field(table, row, object);
}

/* `dimensions`: of the engine; 2: masses are per metre of thickness. */
static void print_row(struct table *table, const struct field *row, const void *object, enum condition_mark mark,
                      int dimensions) {
  char meaning[FIELD_TEXT_SIZE];
  const char *unit = ask_result_unit(row, dimensions);
  text_sentence(row->doc, meaning, sizeof meaning);
  table_text(table, row->path);
  value_cell(table, row, object, mark);
  table_text(table, unit && strcmp(unit, "1") != 0 ? unit : "");
  table_text(table, meaning);
}

void print_results_row(struct table *table, const struct field *row, const void *object) {
  print_row(table, row, object, CONDITION_SOUND, 3);
}

/* Lists the values of an object; left out is what does not apply to this scene, and the message, which goes to stderr.
 */
static void list(struct table *table, const struct field_table *fields, const void *object,
                 const struct engine_kind *kind, const char *words) {
  for (size_t i = 0; i < fields->count; i++) {
    const struct field *row = &fields->rows[i];
    struct field_value value;
    field_get(row, object, &value);
    if (row->kind != FIELD_TEXT && !(row->kind == FIELD_REAL && isnan(value.number)))
      print_row(table, row, object, condition_mark(kind->conditions, words, row->path), kind->dimensions);
  }
}

static status print_wide(const struct engine_kind *kind, int64_t seed, const struct run_result *result,
                         enum table_format format, struct error *error) {
  const struct field_table *tables[] = {&outcome_table, kind->results};
  const void *objects[] = {&result->outcome, result->result};
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"engine", "seed", NULL});
  for (size_t t = 0; t < 2; t++)
    for (size_t i = 0; i < tables[t]->count; i++) { /* columns have the same names as in the store */
      char name[FIELD_TEXT_SIZE];
      field_column_name(tables[t]->rows[i].path, name, sizeof name);
      table_column(table, name, tables[t]->rows[i].unit);
    }
  for (size_t i = 0; i < result->estimate_count; i++) {
    char name[128];
    const char *method = exponent_method_names[result->estimates[i].fit.method];
    const char *window = estimates_window_names[result->estimates[i].window];
    snprintf(name, sizeof name, "beta_%s_%s", method, window);
    table_column(table, name, NULL);
  }
  table_text(table, kind->name);
  table_integer(table, seed);
  for (size_t t = 0; t < 2; t++)
    for (size_t i = 0; i < tables[t]->count; i++)
      value_cell(table, &tables[t]->rows[i], objects[t],
                 condition_mark(kind->conditions, result->outcome.warnings, tables[t]->rows[i].path));
  for (size_t i = 0; i < result->estimate_count; i++)
    table_real(table, result->estimates[i].fit.beta);
  return table_end(table, error);
}

static void answer(const char *name, double value, enum condition_mark mark, const char *says) {
  char text[64], head[96];
  const bool whole = value == floor(value) && fabs(value) < 1e9;
  snprintf(text, sizeof text,
           mark == CONDITION_WITHHELD ? "withheld"
           : isnan(value)             ? "-"
           : whole                    ? "%.0f%s"
                                      : "%.4g%s",
           value, mark == CONDITION_MARKED ? UNCERTAINTY_MARK : "");
  text_powers(text, sizeof text);
  const int cell = 10 + (int)(strlen(text) - text_characters(text, SIZE_MAX));
  const bool is_path = strchr(name, '.') != NULL; /* an engine's result */
  snprintf(head, sizeof head, is_path ? "%-20s %-*s " : "%-14s %-*s ", name, cell, text);
  words_print(stdout, head, "%s", says);
}

/* A result of the engine, with the mark of this run, and its exact value, where the engine has one. */
static void answer_result(const struct engine_kind *kind, const struct run_result *result, const struct field *row) {
  struct field_value value, exact = {.number = NAN};
  field_get(row, result->result, &value);
  char says[256], path[FIELD_TEXT_SIZE];
  const bool plain = !row->unit || strcmp(row->unit, "1") == 0;
  snprintf(says, sizeof says, "%s%s", plain ? "" : row->unit, plain ? "" : "; ");
  snprintf(path, sizeof path, "%s_exact", row->path);
  const struct field *beside = field_find(kind->results, path, NULL);
  if (beside)
    field_get(beside, result->result, &exact);
  if (isfinite(exact.number))
    text_append(says, sizeof says, "exact: %.4g; ", exact.number);
  text_powers(says, sizeof says);
  const char *of = strstr(row->doc, ": "); /* "Piston: mean pressure" */
  text_sentence(of ? of + 2 : row->doc, says + strlen(says), sizeof says - strlen(says));
  answer(row->path, value.number, condition_mark(kind->conditions, result->outcome.warnings, row->path), says);
}

/* What else such a run is made for: a crater or a shock, where there is one. Of what could be there, but is not, one
 * line: "crater.depth 0". */
static void answer_also(const struct engine_kind *kind, const struct run_result *result) {
  const struct field *none = NULL;
  for (size_t i = 0; i < kind->also_count; i++)
    for (size_t k = 0; k < kind->results->count; k++) {
      const struct field *row = &kind->results->rows[k];
      struct field_value value;
      field_get(row, result->result, &value);
      if (row->offset != kind->also[i] || !(value.number >= 0) ||
          condition_mark(kind->conditions, result->outcome.warnings, row->path) == CONDITION_WITHHELD)
        continue;
      const size_t section = strcspn(row->path, ".") + 1;
      if (value.number > 0 || !none || strncmp(none->path, row->path, section) != 0)
        answer_result(kind, result, row);
      if (!(value.number > 0))
        none = row;
    }
}

static void print_fragments(const struct scene *scene, const struct run_result *result) {
  const struct outcome *o = &result->outcome;
  const struct condition *conditions = scene->kind->conditions;
  char says[256];
  answer("M_1/M", o->largest_fraction, condition_mark(conditions, o->warnings, OUTCOME_NAME(largest_fraction)),
         "mass of the largest fragment over the total mass");
  snprintf(says, sizeof says, "%lld %s; the spectrum is complete from %.3g %s on", (long long)o->single_count,
           scene->kind->single ? scene->kind->single : "of one grain or particle", o->complete_mass,
           ask_pool_mass_unit(scene->kind->dimensions));
  text_powers(says, sizeof says);
  answer("fragments", (double)o->fragment_count, condition_mark(conditions, o->warnings, OUTCOME_NAME(fragment_count)),
         says);
  const struct estimate *fit = NULL;
  for (size_t i = 0; i < result->estimate_count; i++)
    if ((int)result->estimates[i].fit.method == ESTIMATES_HEADLINE_METHOD &&
        (int)result->estimates[i].window == ESTIMATES_HEADLINE_WINDOW)
      fit = &result->estimates[i];
  snprintf(says, sizeof says, "beta of F(m) ~ m^-beta, of %zu fragments (maximum likelihood, %s)", fit ? fit->fit.n : 0,
           estimates_window_names[ESTIMATES_HEADLINE_WINDOW]);
  /* As many digits as the number of fragments allows. */
  const double beta = fit ? fit->fit.beta : (double)NAN,
               digit = fit ? pow(10, floor(log10(fit->fit.standard_error))) : 0;
  answer("exponent", digit < 1 ? digit * round(beta / digit) : (double)NAN,
         condition_mark(conditions, o->warnings, OUTCOME_NAME(mean_fragment_mass)), says);
}

/* What most people want of a run, in six lines, and what else the scene is made for. */
static void print_answers(const struct scene *scene, int64_t seed, const struct run_result *result) {
  const struct outcome *o = &result->outcome;
  const struct condition *conditions = scene->kind->conditions;
  struct field_value state;
  field_get(field_find(&outcome_table, OUTCOME_NAME(state), NULL), o, &state);
  char time[64];
  snprintf(time, sizeof time, "%.4g", o->time);
  text_powers(time, sizeof time);
  printf("%s, seed %lld: %s after %s s in %lld steps\n", scene->name, (long long)seed, state.text, time,
         (long long)o->steps);
  if (o->state == OUTCOME_INVALID)
    return;
  const char *headline = scene_headline(scene);
  const struct field *row = field_find(scene->kind->results, headline, NULL);
  if (row)
    answer_result(scene->kind, result, row);
  if (!scene->kind->definition || o->fragment_count > 0)
    print_fragments(scene, result);
  answer("energy error", o->energy_error, CONDITION_SOUND, "of the energy put in, by numerical errors");
  printf("in doubt (!)   %s\n", condition_doubted(conditions, o->warnings) ? o->warnings : "nothing");
  answer_also(scene->kind, result);
}

static status print_long(const struct engine_kind *kind, const struct run_result *result, enum table_format format,
                         struct error *error) {
  const enum condition_mark masses = condition_mark(kind->conditions, result->outcome.warnings,
                                                    OUTCOME_NAME(mean_fragment_mass));
  TABLE results = table_new(format, stdout);
  table_columns(results, (const char *const[]){"result", "value", "unit", "meaning", NULL});
  list(results, &outcome_table, &result->outcome, kind, result->outcome.warnings);
  list(results, kind->results, result->result, kind, result->outcome.warnings);
  TRY(table_end(results, error));
  fputs("\nexponent beta of F(m) ~ m^-beta, of this run alone:\n", stdout);
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"method", "window", "fragments", "beta", NULL});
  for (size_t i = 0; i < result->estimate_count; i++) {
    table_text(table, exponent_method_names[result->estimates[i].fit.method]);
    table_text(table, estimates_window_names[result->estimates[i].window]);
    table_integer(table, result->estimates[i].fit.n);
    table_rests_on(table, &(struct ask_doubts){.runs = 1, .doubtful = masses != CONDITION_SOUND});
    table_real(table, result->estimates[i].fit.beta);
  }
  return table_end(table, error);
}

static status print_for_people(const struct scene *scene, const char *reference, int64_t seed,
                               const struct run_result *result, enum table_format format, struct error *error) {
  struct ask_resolution resolution;
  char text[UNCERTAINTY_TEXT];
  print_answers(scene, seed, result);
  if (result->outcome.state == OUTCOME_INVALID && format != TABLE_ALL) {
    puts("no results: these inputs cannot be run together, and the message says why");
    return table_flush(stdout, error);
  }
  TRY(ask_resolution(NULL, 0, OUTCOME_DEFAULT, &resolution, error));
  if (strlen(reference) < sizeof resolution.command) /* a part of it would be another scene */
    snprintf(resolution.command, sizeof resolution.command, "%s", reference);
  uncertainty_resolution(&resolution, text);
  puts("errors: one run alone has no interval; `clast run` with several seeds gives one");
  words_print(stdout, "", "%s", text);
  if (format == TABLE_ALL) {
    putchar('\n');
    TRY(print_long(scene->kind, result, format, error));
  } else {
    puts("all results: --all");
  }
  return table_flush(stdout, error);
}

status print_results(const struct scene *scene, const char *reference, int64_t seed, const struct run_result *result,
                     enum table_format format, struct error *error) {
  return table_for_people(format) ? print_for_people(scene, reference, seed, result, format, error)
                                  : print_wide(scene->kind, seed, result, format, error);
}

/* ---- spectra ---- */

/* Prints the bins of a pool, or with run_id those of one of its runs. */
static status print_bins(struct table *table, const struct spectrum_choice *choice, const struct ask_pools *pools,
                         const struct ask_pool *pool, const struct pooled_runs *runs, const int64_t *run_id,
                         const struct ask_doubts *doubts, bool people, bool *any_incomplete, struct error *error) {
  struct pooled_form form = ask_pool_form(pool, choice->cumulative, choice->density);
  OWNED struct pooled_bin *bins = NULL;
  size_t count;
  double mass = 0;
  if (run_id)
    form = (struct pooled_form){.cumulative = form.cumulative, .size = form.size};
  TRY(pooled_spectrum(runs, &form, &bins, &count, error));
  for (size_t b = 0; b < count; b++)
    mass = form.cumulative ? fmax(mass, bins[b].mass) : mass + bins[b].mass;
  for (size_t b = 0; b < count && !table_broken(table); b++) {
    const bool incomplete = bins[b].lower < spectrum_size_of(&form.size, pool->data.complete_mass);
    *any_incomplete |= incomplete;
    print_pool_cells(table, pools, pool);
    if (run_id)
      table_integer(table, *run_id);
    if (people)
      table_text(table, incomplete ? "no" : "yes");
    table_real(table, bins[b].lower);
    if (!form.cumulative)
      table_real(table, bins[b].upper);
    table_integer(table, (int64_t)runs->count);
    table_integer(table, bins[b].count);
    table_rests_on(table, doubts);
    table_reals(table, 3, (const double[]){bins[b].value, bins[b].half_width, bins[b].mass / mass});
    table_doubt_cells(table, doubts);
  }
  return STATUS_OK;
}

status print_spectrum(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                      struct error *error) {
  const bool sizes = choice->density > 0, people = table_for_people(format);
  char kg[64]; /* none with runs of the plane and of space */
  TRY(ask_columns_unit(store, OUTCOME_NAME(mean_fragment_mass), kg, sizeof kg, error));
  const char *unit = sizes ? "m" : kg, *per_kg = !*kg ? NULL : ask_pool_per_mass_unit(strcmp(kg, "kg/m") == 0 ? 2 : 3);
  const char *per_unit = choice->cumulative ? NULL : sizes ? "1/m" : per_kg;
  struct ask_pool_choice pool_choice = choice->pool;
  pool_choice.inputs = people;
  ASK_POOLS pools = ask_pools(store, &pool_choice, NULL, error);
  TRY(pools.code);
  TABLE table = table_new(format, stdout);
  print_pool_columns(table, &pools);
  if (choice->runs)
    table_column(table, "run_id", NULL);
  if (people)
    table_column(table, "complete", NULL);
  table_column(table, "lower", unit);
  if (!choice->cumulative)
    table_column(table, "upper", unit);
  table_columns(table, (const char *const[]){"runs", "fragments", NULL});
  table_column(table, choice->cumulative ? "number" : "number_density", per_unit);
  table_column(table, choice->cumulative ? "number_hw95" : "number_density_hw95", per_unit);
  table_range(table, (struct sample_range){.least = 0, .most = HUGE_VAL});
  table_column(table, "mass_share", NULL);
  table_doubt_columns(table);
  struct ask_doubts sum = {0};
  bool incomplete = false;
  for (const struct ask_pool *pool; !table_broken(table) && (pool = ask_pools_next(&pools));) {
    const struct pooled_runs *runs = &pool->data.runs;
    ask_doubts_add(&sum, &pool->doubts);
    if (!choice->runs)
      TRY(print_bins(table, choice, &pools, pool, runs, NULL, &pool->doubts, people, &incomplete, error));
    for (size_t r = 0; choice->runs && r < runs->count && !table_broken(table); r++) {
      struct ask_doubts doubts = {0};
      TRY(ask_doubts(store, &(struct ask_doubts_choice){.run = pool->data.run_id[r]}, OUTCOME_NAME(mean_fragment_mass),
                     &doubts, error));
      TRY(print_bins(table, choice, &pools, pool, &(struct pooled_runs){1, runs->first + r, runs->masses},
                     &pool->data.run_id[r], &doubts, people, &incomplete, error));
    }
  }
  TRY(ask_pools_end(&pools));
  TRY(table_end(table, error));
  if (people && incomplete)
    words_print(stderr, "", "clast: complete no: lighter fragments than the mass from which the spectrum is complete");
  if (people)
    uncertainty_doubts(&sum, stderr);
  return STATUS_OK;
}

static const double FAR = 0.05; /* the measured spectrum differs from a pool when fewer runs are as far */

static const char *most_needed(const struct measured_match *match) {
  return match->needed < MATCH_MOST ? "" : " or more";
}

/* The answer in words: of one pool with its share of runs, of more with their numbers. few: of the rows with
 * a distance and no share, that of the fewest runs; needed 0: none. */
static void tell_shape(size_t pools, size_t agree, size_t differ, const struct measured_match *match, bool nothing,
                       const size_t judged[2], const struct measured_match *few) {
  char joined[120] = "of the runs are as far from the other runs as the measured spectrum is";
  if (match->together > 1)
    snprintf(joined, sizeof joined, "of draws of %zu runs (one has too few fragments) are as far from the other runs",
             match->together);
  if (agree + differ == 0 && nothing)
    puts("no verdict on the shape: no distance can be told, see below");
  else if (agree + differ == 0)
    words_print(stdout, "",
                judged[0] == judged[1]
                    ? "no verdict on the shape: it needs %zu%s runs of two fragments or more from the lightest "
                      "mass on, and has %zu"
                    : "no verdict on the shape: it needs %zu%s runs of two fragments or more from the lightest "
                      "mass on; the rows have %zu to %zu",
                match->needed, most_needed(match), judged[0], judged[1]);
  else if (pools > 1) {
    char rest[160] = "";
    if (pools > agree + differ)
      text_append(rest, sizeof rest, ", no verdict on %zu", pools - agree - differ);
    if (few->needed)
      text_append(rest, sizeof rest,
                  ", of which one has %zu of the %zu%s runs of two fragments or more that are needed", few->judged,
                  few->needed, most_needed(few));
    if (nothing)
      text_append(rest, sizeof rest, "; where there is no distance, see below");
    words_print(stdout, "", "agrees in shape with %zu of %zu rows (runs as far %.2g or more), differs from %zu%s",
                agree, pools, FAR, differ, rest);
  } else
    words_print(stdout, "", "%s in shape, whatever the number of fragments: %s %s (differs: below %.2g %%)",
                agree ? "agrees" : "differs", text_percent(match->share, (char[TEXT_PERCENT]){0}), joined, 100 * FAR);
  putchar('\n');
}

static const double SAME_MASS = 1.5; /* bodies whose masses differ by a smaller factor can be compared */

status print_spectrum_match(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                            struct error *error) {
  const struct measured *measured = choice->measured;
  double complete = measured->complete;                    /* kg; likelihoods are compared above one mass */
  double heaviest = 0, body[2] = {HUGE_VAL, 0}, given = 0; /* kg; lightest and heaviest body of a row */
  size_t judged[2] = {SIZE_MAX, 0};                        /* runs with a shape: fewest and most */
  int dimensions;
  TRY(ask_pool_dimensions(store, &choice->pool, &dimensions, error));
  const char *kg = ask_pool_mass_unit(dimensions);
  ASK_POOLS before = ask_pools(store, &choice->pool, NULL, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&before));)
    complete = fmax(complete, pool->data.complete_mass); /* fmax ignores a NaN */
  TRY(ask_pools_end(&before));
  struct ask_pool_choice pool_choice = choice->pool;
  pool_choice.inputs = table_for_people(format);
  ASK_POOLS pools = ask_pools(store, &pool_choice, NULL, error);
  TRY(pools.code);
  TABLE table = table_new(format, stdout);
  print_pool_columns(table, &pools);
  table_column(table, "from", kg);
  table_columns(table, (const char *const[]){"measured", "runs", "fragments_mean", "fragments_hw95", NULL});
  table_range(table, (struct sample_range){.least = 0, .most = HUGE_VAL});
  table_columns(table, (const char *const[]){"distance", "runs_as_far", "log_likelihood", NULL});
  table_doubt_columns(table);
  struct ask_doubts sum = {0};
  size_t count = 0, agree = 0, differ = 0;
  struct measured_match last = {.share = NAN, .needed = MATCH_RUNS, .together = 1}, few = {0};
  bool nothing = false;                           /* a spectrum has no fragment above the mass where all are complete */
  bool empty = false, lone = false, told = false; /* which one; and a row has a distance */
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));) {
    const struct pooled_form form = ask_pool_form(pool, true, 0);
    struct measured_match match;
    double fragments = NAN, half_width = NAN;
    TRY(measured_compare(choice->measured, &pool->data.runs, complete, &match, error));
    if (!isnan(match.simulated)) /* the measured spectrum has fragments from there on */
      TRY(pooled_number(&pool->data.runs, &form, match.from, &fragments, &half_width, error));
    nothing |= !isfinite(match.distance);
    empty |= match.simulated == 0; /* NaN: the measured spectrum has none */
    lone |= !isfinite(match.distance) && !(match.simulated == 0);
    told |= isfinite(match.distance);
    if (isfinite(match.distance) && isnan(match.share) && (!few.needed || match.judged < few.judged))
      few = match;
    match.needed = match.needed > last.needed ? match.needed : last.needed;
    last = match;
    count++;
    agree += match.share >= FAR;
    differ += match.share < FAR;
    const struct pooled_runs *runs = &pool->data.runs;
    double mass = 0;
    for (size_t i = 0; i < runs->first[runs->count]; i++) {
      heaviest = fmax(heaviest, runs->masses[i]);
      mass += runs->masses[i] / (double)runs->count;
    }
    body[0] = fmin(body[0], mass);
    body[1] = fmax(body[1], mass);
    judged[0] = match.judged < judged[0] ? match.judged : judged[0];
    judged[1] = match.judged > judged[1] ? match.judged : judged[1];
    print_pool_cells(table, &pools, pool);
    table_reals(table, 2, (const double[]){match.from, match.fragments});
    table_integer(table, (int64_t)pool->data.runs.count);
    table_rests_on(table, &pool->doubts);
    table_reals(table, 2, (const double[]){fragments, half_width});
    table_rests_on(table, &pool->doubts);
    table_real(table, match.distance);
    table_rests_on(table, &pool->doubts);
    table_real(table, match.share);
    table_rests_on(table, &pool->doubts);
    table_real(table, match.log_likelihood);
    table_doubt_cells(table, &pool->doubts);
    ask_doubts_add(&sum, &pool->doubts);
  }
  TRY(ask_pools_end(&pools));
  if (table_for_people(format))
    tell_shape(count, agree, differ, &last, nothing, judged, &few);
  TRY(table_end(table, error));
  if (table_for_people(format)) {
    uncertainty_doubts(&sum, stderr);
    fprintf(
        stderr,
        "clast: the measured and all simulated spectra are complete from %.3g %s on; lightest mass: %s. distance: "
        "Kolmogorov's, of %s. runs as far: share of the runs that are as far from the "
        "others as "
        "the measured one, or of draws of several runs of few fragments (below 0.05 speaks against "
        "the point; -: too few runs of two fragments). One measured fragment or class has no shape, and no distance\n",
        complete, kg, measured->single ? "this mass" : "the first measured class there",
        measured->weighed ? "the shares of mass" : "the shapes");
    if (nothing)
      fprintf(stderr,
              "clast: no distance%s: from the lightest mass on there is %s%s%s%s. The heaviest "
              "measured %s %.3g %s, the heaviest simulated fragment has %.3g %s\n",
              told ? " in some rows" : "", empty ? "no simulated fragment" : "", empty && lone ? ", or " : "",
              lone ? "at most one measured " : "",
              !lone              ? ""
              : measured->single ? "fragment"
                                 : "class",
              measured->single ? "fragment has" : "class begins at", measured->n ? measured->mass[measured->n - 1] : 0,
              measured->bodies ? "kg" : kg, heaviest, kg);
    if (measured->weighed && !measured->shares)
      given = measured->above[0];
    /* Light fragments were not collected: how much they weigh is not known. */
    const bool partial = measured->complete > 0 || (measured->weighed && measured->mass[0] > 0);
    for (size_t i = 0; !measured->weighed && i < measured->n; i++) {
      const double beyond = i + 1 < measured->n ? measured->above[i + 1] : 0;
      given += measured->mass[i] * (measured->single ? 1 : measured->above[i] - beyond); /* at least, with thresholds */
    }
    if (measured->bodies)
      fputs(
          "clast: this scene is two-dimensional: its masses are per metre of thickness, the measured ones in kg count "
          "as of 1 m. Divide them by the thickness of the specimen, and name the column mass (kg/m), "
          "with `complete from` in kg/m, too\n",
          stderr);
    else if (given > SAME_MASS * body[0] || (given > 0 && body[1] > SAME_MASS * given && !partial)) {
      char other[48] = "";
      if (body[1] > 1.001 * body[0])
        snprintf(other, sizeof other, " to %.3g", body[1]);
      fprintf(stderr,
              "clast: the measured fragments have %.3g %s or more together, a run has %.3g%s %s. Masses are compared "
              "as they are: give the body of the scene the size of the specimen\n",
              given, kg, body[0], other, kg);
    } else if (nothing)
      fputs("clast: more particles or grains lower the mass from which a spectrum is complete\n", stderr);
  }
  return STATUS_OK;
}
