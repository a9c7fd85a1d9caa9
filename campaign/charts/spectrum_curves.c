/* Makes the curves of spectra with their fits, and draws them. */
#include "campaign/charts/charts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "schemas/memory.h"

status spectrum_curves_measured(struct store *store, const char *path, struct spectrum_choice *choice,
                                struct measured *measured, struct error *error) {
  struct spectrum_size size = {.density = choice->density};
  const status code = ask_pool_dimensions(store, &choice->pool, &size.dimensions, error);
  choice->measured = measured;
  return code ? code : measured_read(path, &size, measured, error);
}

/* A pool's spectrum with its headline fit, which only a pool of one point has. */
struct curve {
  char label[ASK_POOL_LABEL + 64], fit_label[160];
  struct pooled_form form;
  struct pooled_bin *bins; /* owned */
  size_t count;
  double complete_mass; /* kg; NaN: not known */
  double mass;          /* kg, all fragments of all runs */
  size_t runs;
  struct picture_fit fit;    /* owns its runs */
  const char *untold;        /* why there is no fit; NULL: there is one */
  struct picture_thin *thin; /* one for each run; owned with their bins */
  size_t thin_count;
};

/* "beta = 2.03 +- 0.05 (seeds, 95 %)" with the name of the exponent in this form. */
static void label_fit(struct curve *curve, double beta, double half_width) {
  static const char *const names[2][2] = {{"\xce\xb2", "\xce\xb2 \xe2\x88\x92 1"}, {"D + 1", "D"}};
  const char *name = names[curve->form.size.density > 0][curve->form.cumulative];
  const double value = pooled_spectrum_exponent(&curve->form, beta);
  const double width = pooled_spectrum_half_width(&curve->form, half_width);
  char number[UNCERTAINTY_TEXT];
  uncertainty_number(value, width, number);
  snprintf(curve->fit_label, sizeof curve->fit_label,
           isfinite(width) ? "%s = %s (seeds, 95 %%)" : "%s = %s (no interval)", name, number);
}

/* The parts of N(>m): the window of each run, and the fragments that the fit leaves out. */
static status make_runs(const struct pooled_runs *runs, struct picture_fit *fit, struct error *error) {
  struct picture_run *run;
  TRY(memory_array(&run, runs->count, sizeof *run, "the fit of a spectrum", error));
  fit->run = run;
  fit->runs = runs->count;
  for (size_t r = 0; r < runs->count; r++) {
    size_t begin, end;
    const double largest = pooled_window(runs, r, fit->lower, &begin, &end);
    run[r] = (struct picture_run){largest, begin - runs->first[r], end - begin};
  }
  return STATUS_OK;
}

static status fit_curve(const struct ask_pool *pool, struct curve *curve, struct error *error) {
  const double lower = point_window(&pool->data, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
  struct pooled_exponent headline;
  curve->untold = pool->points > 1 ? "each of its points has a law of its own" : "no estimates are stored";
  if (pool->points != 1 || !(lower > 0))
    return STATUS_OK;
  TRY(pooled_exponent(&pool->data.runs, (enum exponent_method)ESTIMATES_HEADLINE_METHOD, lower, 0.95, &headline,
                      error));
  curve->untold = pooled_exponent_untold(&headline);
  if (curve->untold)
    return STATUS_OK;
  const double runs = (double)pool->data.runs.count;
  label_fit(curve, headline.fit.beta, headline.interval.half_width);
  const bool sizes = curve->form.size.density > 0;
  /* Windows that begin at the same mass differ in the last bits: they do not round to different sides of a half. */
  const double from = headline.fit.lower * (1 + 1e-9);
  text_append(curve->fit_label, sizeof curve->fit_label,
              "; %zu fragments from %.3g %s on, the largest of each run left out", headline.fit.n,
              sizes ? spectrum_size_of(&curve->form.size, from) : from,
              sizes ? "m" : ask_pool_mass_unit(pool->data.dimensions));
  curve->fit = (struct picture_fit){.beta = headline.fit.beta,
                                    .lower = headline.fit.lower,
                                    .upper = headline.fit.upper,
                                    .fragments_per_run = (double)headline.fit.n / runs};
  return curve->form.cumulative ? make_runs(&pool->data.runs, &curve->fit, error) : STATUS_OK;
}

static status make_thin(const struct ask_pool *pool, struct curve *curve, struct error *error) {
  const struct pooled_runs *runs = &pool->data.runs;
  struct pooled_form form = curve->form;
  form.first_run = NULL;
  form.seed = NULL;
  TRY(memory_array(&curve->thin, runs->count, sizeof *curve->thin, "the spectra of the runs", error));
  for (size_t r = 0; r < runs->count; r++) {
    struct pooled_bin *bins;
    TRY(pooled_spectrum(&(struct pooled_runs){1, runs->first + r, runs->masses}, &form, &bins, &curve->thin[r].count,
                        error));
    curve->thin[curve->thin_count++].bins = bins;
  }
  return STATUS_OK;
}

static status make_curve(const struct spectrum_choice *choice, const struct ask_pool *pool, struct curve *curve,
                         struct error *error) {
  const size_t runs = pool->data.runs.count;
  const char *mark = pool->doubts.doubtful ? " !" : "";
  *curve = (struct curve){.form = ask_pool_form(pool, choice->cumulative, choice->density),
                          .complete_mass = pool->data.complete_mass,
                          .fit = {.beta = NAN}};
  if (pool->points == 1)
    snprintf(curve->label, sizeof curve->label, "%s, %zu run%s%s", pool->label, runs, runs == 1 ? "" : "s", mark);
  else
    snprintf(curve->label, sizeof curve->label, "%s, %zu points, %zu runs%s", pool->label, pool->points, runs, mark);
  curve->runs = runs;
  for (size_t i = 0; i < pool->data.runs.first[runs]; i++)
    curve->mass += pool->data.runs.masses[i];
  TRY(pooled_spectrum(&pool->data.runs, &curve->form, &curve->bins, &curve->count, error));
  TRY(fit_curve(pool, curve, error));
  if (choice->runs)
    TRY(make_thin(pool, curve, error));
  curve->form.first_run = NULL; /* both belong to the pool, which is released */
  curve->form.seed = NULL;
  return STATUS_OK;
}

/* Borrows the curve. */
static struct picture_series series_of(const struct curve *curve) {
  return (struct picture_series){.label = curve->label,
                                 .count = curve->count,
                                 .bins = curve->bins,
                                 .fits = isfinite(curve->fit.beta) ? 1u : 0u,
                                 .fit = &curve->fit,
                                 .complete_mass = curve->complete_mass,
                                 .thin_count = curve->thin_count,
                                 .thin = curve->thin};
}

struct curves {
  const struct spectrum_choice *choice;
  size_t count, most;
  bool more; /* there are more pools than are drawn */
  int64_t point;
  struct ask_doubts doubts;
  struct curve curve[PICTURE_SERIES];
};

static void release(struct curves **curves) {
  for (size_t i = 0; i < (*curves)->count; i++) {
    struct curve *curve = &(*curves)->curve[i];
    for (size_t r = 0; r < curve->thin_count; r++)
      free((void *)curve->thin[r].bins);
    free(curve->thin);
    free((void *)curve->fit.run);
    free(curve->bins);
  }
  free(*curves);
}

enum { CAPTION = 1600 };

/* The meaning of axes and intervals, and the error of the resolution. */
static status write_caption(struct store *store, const struct curves *curves, char caption[CAPTION],
                            struct error *error) {
  static const char *const laws[2][2] = {{"F(m) ~ m^-\xce\xb2, N(>m) ~ m^-(\xce\xb2 \xe2\x88\x92 1)",
                                          "N(>m) ~ m^-(\xce\xb2 \xe2\x88\x92 1)"},
                                         {"F(L) ~ L^-(D + 1), N(>L) ~ L^-D", "N(>L) ~ L^-D"}};
  const struct spectrum_choice *choice = curves->choice;
  struct ask_resolution resolution;
  struct ask_group_pooled pooled;
  char text[UNCERTAINTY_TEXT] = "resolution: not known", intervals[600], untold[CAPTION / 2] = "";
  bool lines = false;
  for (size_t i = 0; i < curves->count; i++) {
    const struct curve *curve = &curves->curve[i];
    lines |= !curve->untold;
    if (!curve->untold)
      continue;
    text_append(untold, sizeof untold, "%s %s", *untold ? ";" : ". No line:", curve->label);
    if (i + 1 == curves->count || curve->untold != curve[1].untold) /* one reason after all that have it */
      text_append(untold, sizeof untold, " (%s%s)", curve->form.units > 1 ? "" : "\xce\xb2 not known: ", curve->untold);
  }
  TRY(ask_group_pooled(store, choice->pool.by, &pooled, error));
  charts_intervals(&pooled, intervals, sizeof intervals);
  *caption = '\0';
  if (lines) {
    if (ask_resolution(store, curves->point, "beta", &resolution, NULL) == STATUS_OK)
      uncertainty_resolution(&resolution, text);
    snprintf(caption, CAPTION, "%s; of \xce\xb2, %s. ", laws[choice->density > 0][choice->cumulative], text);
  }
  text_append(caption, CAPTION, "%s: %s. Grey: fragments are missing (too few particles or grains)",
              choice->cumulative ? "Bands" : "Error bars", intervals);
  if (choice->runs)
    text_append(caption, CAPTION, ". Thin lines: single runs");
  if (lines)
    text_append(caption, CAPTION,
                choice->cumulative ? ". Lines: the law below the largest fragment of each run, and this fragment itself"
                                   : ". Lines leave out the largest fragment of each run, marks have it");
  text_append(caption, CAPTION, "%s", untold);
  charts_doubts(store, &curves->doubts, caption, CAPTION);
  return STATUS_OK;
}

/* Bins and words of the measured spectrum. label: room for `size` bytes. A table of shares alone needs a mass to tell
 * numbers: that of the drawn runs, which every scene gives. */
static status measured_series(const struct curves *curves, const struct pooled_form *form, char *label, size_t size,
                              struct pooled_bin **bins, struct picture_series *series, struct error *error) {
  const struct measured *measured = curves->choice->measured;
  double mass = 0, runs = 0;
  for (size_t i = 0; i < curves->count; i++) {
    mass += curves->curve[i].mass;
    runs += (double)curves->curve[i].runs;
  }
  *series = (struct picture_series){.label = label, .measured = true, .complete_mass = measured->complete};
  snprintf(label, size, "measured%s%s", *measured->source ? ": " : "", measured->source);
  if (measured->shares)
    text_append(label, size, " (sieves: number of a class from its share of a body of %.3g %s, the mean mass of a run)",
                mass / runs, ask_pool_mass_unit(form->size.dimensions));
  else if (measured->weighed)
    text_append(label, size, " (sieves: number of a class from its mass)");
  else if (measured->single && !form->cumulative)
    text_append(label, size, " (a mark stands for its bin and the empty ones below)");
  TRY(measured_bins(measured, form, mass / runs, bins, &series->count, error));
  series->bins = *bins;
  return STATUS_OK;
}

static status draw_picture(struct store *store, const struct curves *curves, const struct picture_page *page,
                           struct error *error) {
  static const char *const names[2][2] = {{"F(m), fragments per run and %s", "N(>m), fragments per run"},
                                          {"F(L), fragments per run and m", "N(>L), fragments per run"}};
  const struct spectrum_choice *choice = curves->choice;
  const struct measured *measured = choice->measured;
  int dimensions;
  TRY(ask_pool_dimensions(store, &choice->pool, &dimensions, error));
  const bool sizes = choice->density > 0;
  struct picture_series series[PICTURE_SERIES];
  OWNED struct pooled_bin *bins = NULL;
  size_t count = 0;
  char caption[CAPTION], label[400], title[300], scenes[200];
  const struct pooled_form form = {.cumulative = choice->cumulative, .size = {choice->density, dimensions}};
  for (; count < curves->count; count++)
    series[count] = series_of(&curves->curve[count]);
  if (measured && measured->n)
    TRY(measured_series(curves, &form, label, sizeof label, &bins, &series[count++], error));
  TRY(write_caption(store, curves, caption, error));
  if (measured && measured->n && !measured->single && !form.cumulative && measured->above[measured->n - 1] > 0)
    text_append(caption, CAPTION, ". Measured: the class from %.3g %s on has no upper end and is drawn only in N(>%c)",
                spectrum_size_of(&form.size, measured->mass[measured->n - 1]),
                sizes ? "m" : ask_pool_mass_unit(form.size.dimensions), sizes ? 'L' : 'm');
  TRY(ask_points_scenes(store, scenes, sizeof scenes, error));
  snprintf(title, sizeof title, "Fragment %s of %s, pooled over runs", sizes ? "sizes" : "masses", scenes);
  char x[64], y[64];
  const char *kg = ask_pool_mass_unit(form.size.dimensions);
  snprintf(x, sizeof x, sizes ? "fragment size L (m)" : "fragment mass m (%s)", kg);
  snprintf(y, sizeof y, names[sizes][choice->cumulative], kg);
  const struct picture_words words = {title, caption, x, y};
  return picture_spectrum(page, &words, &form, count, series, error);
}

static status take_curves(struct store *store, struct curves *curves, struct error *error) {
  ASK_POOLS pools = ask_pools(store, &curves->choice->pool, NULL, error);
  for (const struct ask_pool *pool; !curves->more && (pool = ask_pools_next(&pools));) {
    curves->more = curves->count == curves->most; /* enough */
    if (curves->more)
      break;
    curves->point = curves->count == 0 ? pool->data.point_id : 0;
    struct curve *curve = &curves->curve[curves->count++];
    TRY(make_curve(curves->choice, pool, curve, error));
    curve->fit.label = curve->fit_label;
    ask_doubts_add(&curves->doubts, &pool->doubts);
    curves->doubts.withheld = 0; /* fragments are drawn all the same */
  }
  TRY(ask_pools_end(&pools));
  if (curves->count > 0)
    return STATUS_OK;
  return status_fail(error, STATUS_USAGE, "no finished run to draw");
}

status spectrum_curves_draw(struct store *store, const struct spectrum_choice *choice, const struct picture_page *page,
                            struct error *error) {
  __attribute__((cleanup(release))) struct curves *curves = memory_small(1, sizeof *curves);
  curves->choice = choice;
  curves->most = choice->measured ? PICTURE_SERIES - 1 : PICTURE_SERIES;
  TRY(take_curves(store, curves, error));
  TRY(draw_picture(store, curves, page, error));
  if (curves->more)
    fprintf(stderr, "clast: only the first %zu spectra are drawn; --point, --where and --by choose others\n",
            curves->count);
  return STATUS_OK;
}
