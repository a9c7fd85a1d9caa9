/* The glossary of the terminal, and the columns of the store. */
#include "campaign/terminal/explain_words.h"

#include <stdio.h>
#include <string.h>

#include "analysis/statistics/estimates.h"
#include "db/store/schema.h"
#include "schemas/text.h"

static const struct {
  const char *name, *also; /* other words for it, with blanks between */
  const char *meaning;
} glossary[] = {
    {"scene", "scenes",
     "One set-up: a document, or a built-in one; all its inputs have values. `clast scenes` lists the "
     "built-in ones, `clast explain SCENE` tells what one models and costs."},
    {"axis", "axes", "An input that a campaign varies, and its values: clast explain vary"},
    {"point", "points",
     "One set of input values of a campaign. Its runs differ by their seeds. The view `points` of a "
     "store has the statistics."},
    {"run", "runs",
     "One point with one seed. It is stored once and gives the same bits wherever it is computed. The view "
     "`runs` of a store has the inputs that vary and all results."},
    {"replicate", "replicates", "The r-th seed of a point, from 0."},
    {"seed", "",
     "The number that decides what is random in a run: the specimen. The same seed gives the same bits. How many "
     "a campaign takes: clast explain seeds"},
    {"identity", "", "The 128-bit hash of a run's inputs, seed and results_version. Runs are found again by it."},
    {"results_version", "", "A number of each engine that rises when result bits change. Statistics never mix two."},
    {"attempt", "attempts failed_attempts",
     "One try to compute a run. It can crash or meet a limit without a result; limits.attempts says "
     "how often a run is tried."},
    {"counted", "counts n",
     "A run counts in statistics when it completed, or ended at its end time, and is not surplus."},
    {"censored", "",
     "A run that met its hard end time (stop.end_time) while fragments may still have been breaking. It "
     "counts; raise the end time when there are many."},
    {"failed", "",
     "A run that ended without a usable result: not-finite, time-step, energy, invalid. Its row tells why."},
    {"surplus", "",
     "A run beyond those that a stopping rule decided on: stored, left out of statistics, as a sample that "
     "ends when it looks good is biased."},
    {"slot", "slots", "A place where one run at a time is computed: --slots, -j."},
    {"store", "", "The SQLite file that a campaign writes. Any SQLite tool reads it; db/README.md explains it."},
    {"interval", "hw95 half_width",
     "Half width of the 95 % confidence interval over seeds: if the campaign were repeated "
     "with other seeds, 95 of 100 intervals would hold the value of endless seeds. It "
     "leaves out the error of the resolution."},
    {"resolution", "convergence",
     "What finer settings (particles or grains, time step, precision) would change in a result. "
     "More seeds do not cure it. `clast converge` measures it."},
    {"beta", "exponent",
     "The exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative number has "
     "slope beta - 1). By two methods, LSQ and ML, in three windows: clast estimates --help"},
    {"LSQ", "least_squares",
     "Exponent by least squares through logarithmic mass bins of one decade, as in Kun et al. 1999. "
     "It needs a fragment in every bin."},
    {"ML", "masses", "Exponent by maximum likelihood on fragment masses, without the largest fragment of each run."},
    {"window", "from_2 from_5 from_10",
     "The masses that an exponent is fitted to. from_5: fragments heavier than 4.5 mean "
     "grains or particles; from_2: than 1.5; from_10: than 9.5."},
    {"count", "count_mean count_sd count_hw95",
     "Fragments in a mass bin of a spectrum: of all runs of a point, and their mean, scatter and interval per run."},
    {"dust", "", "Fragments lighter than a mass of the scene (`fragments.dust_mass`); in dem, single grains."},
    {"core", "", "The largest fragment without its damaged layer: clast explain largest.bare_fraction"},
    {"damage", "D", "0 to 1: the share of its tension and shear that a particle has lost to cracks."},
    {"distention", "", "alpha: density of the solid over that of the porous body. 1: no pores."},
    {"flaw", "flaws", "A point of a body where a crack starts at a given strain (Weibull): clast explain weibull"},
};

static bool explain_column(const char *word) {
  size_t found = 0;
  for (size_t t = 0; t < schema_tables_count; t++)
    for (size_t i = 0; i < schema_tables[t].count; i++) {
      const struct schema_column *column = &schema_tables[t].columns[i];
      if (strcmp(column->name, word) != 0)
        continue;
      if (found++ == 0)
        printf("%s: a column of a store\n", word);
      printf("  in %s: %s%s%s\n", schema_tables[t].name, column->meaning, column->unit ? ", " : "",
             column->unit ? column->unit : "");
    }
  return found > 0;
}

static bool explain_exponent(const char *word) {
  enum exponent_method method;
  enum estimates_window window;
  struct error missed;
  bool is = false;
  if (estimates_named(word, &is, &method, &window, &missed) != STATUS_OK || !is)
    return false;
  printf("%s\n    Exponent of F(m) ~ m^-beta by %s in the window %s (clast explain beta, ML, window).\n", word,
         exponent_method_names[method], estimates_window_names[window]);
  return true;
}

bool explain_words(const char *word) {
  for (size_t i = 0; i < sizeof glossary / sizeof glossary[0]; i++) {
    if (strcmp(glossary[i].name, word) != 0 && !text_has_word(glossary[i].also, word))
      continue;
    printf("%s\n", word);
    text_wrap(glossary[i].meaning, 0, 4, 96, stdout);
    return true;
  }
  return explain_exponent(word) || explain_column(word);
}

void explain_words_guess(struct text_guess *guess) {
  for (size_t i = 0; i < sizeof glossary / sizeof glossary[0]; i++)
    text_guess_offer(guess, glossary[i].name);
}

const char *explain_words_result(const char *name, char plain[256], const char **said) {
  static const char *const ends[][2] = {{"_mean", "mean over the runs of a point"},
                                        {"_sd", "standard deviation between the runs of a point"},
                                        {"_se", "standard error of the mean over the runs of a point"},
                                        {"_resolution_verdict", "what is known of the error of the resolution"},
                                        {"_resolution", "how far finer settings may move the result"},
                                        {"_hw95", "half width of the 95 % interval of the mean over seeds"}};
  *said = NULL;
  for (size_t i = 0; i < engine_count(); i++) {
    char prefix[64];
    snprintf(prefix, sizeof prefix, "result_%s_", engine_at(i)->name);
    if (strncmp(name, prefix, strlen(prefix)) == 0) {
      name += strlen(prefix);
      break;
    }
  }
  const size_t length = strlen(name);
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    const size_t tail = strlen(ends[i][0]);
    if (length <= tail || length - tail >= 256 || strcmp(name + length - tail, ends[i][0]) != 0)
      continue;
    snprintf(plain, 256, "%.*s", (int)(length - tail), name);
    *said = ends[i][1];
    return plain;
  }
  return name;
}
