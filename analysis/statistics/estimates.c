/* The standard set of exponents of a run, and the table that describes a row of it. */
#include "analysis/statistics/statistics.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "schemas/memory.h"
#include "schemas/rows.h"

FIELD_WORDS(
    estimates_window_names,
    ESTIMATES_WINDOWS, [ESTIMATES_FROM_2] = "from_2", [ESTIMATES_FROM_5] = "from_5", [ESTIMATES_FROM_10] = "from_10");
static const char *const window_docs =
    "from 1.5 mean masses of an element (grain or particle). Of one run: without single elements. Of a point: by mass "
    "alone, so that single grains heavier than that are in it, 5 to 12 % of its fragments in the demo. Where "
    "all elements have one mass, the exponent by method masses is too low: by 0.02 to 0.04 for 2, by 0.08 for 2.5\n"
    "from 4.5 mean element masses\n"
    "from 9.5 mean element masses";
static const char *const method_docs =
    "unweighted least squares of log density on log bins of one decade, the largest fragment included: the method of "
    "Kun & Herrmann (1999). Of a point: off until its runs fill every bin; of one run: of the bins that are filled, "
    "biased low\n"
    "maximum likelihood on masses in a bounded window\n"
    "power law with an exponential cut-off at large masses, maximum likelihood on masses";

#define REAL(path_, unit_, member_, least_, doc_, source_)                                                             \
  REAL_OF(estimate, path_, member_, unit_, NAN, least_, HUGE_VAL, .flags = FIELD_MAY_BE_OFF, .doc = doc_,              \
          .source = source_)
static const struct field rows_of_table[] = {
    ROW_OF(estimate, window, window, FIELD_CHOICE, NULL, .choices = estimates_window_names, .choice_docs = window_docs,
           .maximum = ESTIMATES_WINDOWS - 1,
           .doc = "Window of masses of the estimate. None begins below complete_mass of the run."),
    ROW_OF(estimate, method, fit.method, FIELD_CHOICE, NULL, .choices = exponent_method_names,
           .choice_docs = method_docs, .maximum = EXPONENT_METHODS - 1, .doc = "Method of the estimate."),
    ROW_OF(estimate, headline, headline, FIELD_BOOLEAN, NULL, .maximum = 1,
           .doc = "1: the estimate that is called beta, by maximum likelihood on masses of at least 5 elements (grains "
                  "or particles), without the largest fragment."),
    REAL(lower, "kg", fit.lower, 0, "Lower end of the window used (2D: kg per metre of thickness).", NULL),
    REAL(upper, "kg", fit.upper, 0,
         "Upper end, not part of the window: the mass of the largest fragment, or a bin edge. With least_squares a "
         "decade above the lower end.",
         NULL),
    ROW_OF(estimate, n, fit.n, FIELD_INTEGER, "1", .maximum = 9007199254740992.0, .doc = "Fragments in the window."),
    REAL(beta, "1", fit.beta, -HUGE_VAL,
         "Exponent of F(m) ~ m^-beta, fragments per unit mass (differential; the cumulative slope is beta - 1). Off "
         "when there are too few fragments.",
         "Kun & Herrmann (1999) section 3.3"),
    REAL(
        standard_error, "1", fit.standard_error, 0,
        "Standard error of beta. Of one run: fragments are taken as independent, which they are not; it is no interval "
        "over seeds. Of a point: from leaving out one of its runs after another (jackknife), and as of one run where "
        "this gives no interval.",
        NULL),
    REAL(hw95, "1", half_width, 0,
         "Half width of the 95 % interval of beta over the runs (seeds) of a point: Student's t and the jackknife. Off "
         "for one run. It does not hold the error of the resolution.",
         NULL),
    REAL(cutoff_mass, "kg", fit.cutoff_mass, 0,
         "m_c of m^-beta exp(-m/m_c); method cutoff only. Off when the pure power law fits best.", NULL),
    REAL(ks_distance, "1", fit.ks_distance, 0,
         "Largest distance between the distribution functions of sample and fit; method masses only.",
         "Clauset, Shalizi & Newman (2009)"),
    REAL(log_likelihood, "1", fit.log_likelihood, -HUGE_VAL,
         "Natural logarithm of the likelihood of ln(m). Compare within one window only.", NULL),
};
const struct field_table estimates_table = FIELD_TABLE(rows_of_table, struct estimate, "estimate",
                                                       "Exponents of fragment spectra, by method and window.");

double estimates_window_elements(enum estimates_window window) {
  switch (window) {
  case ESTIMATES_FROM_2: return 1.5;
  case ESTIMATES_FROM_5: return 4.5;
  case ESTIMATES_FROM_10: return 9.5;
  case ESTIMATES_WINDOWS: break;
  }
  return NAN;
}

double estimates_window_lower(enum estimates_window window, double element_mass, double complete_mass) {
  return fmax(estimates_window_elements(window) * element_mass, complete_mass); /* fmax ignores a NaN */
}

status estimates_make(size_t n, const struct fragment *fragments, double complete_mass,
                      struct estimate rows[ESTIMATES_COUNT], struct error *error) {
  double total = 0, elements = 0, largest = 0;
  OWNED double *masses = NULL;
  TRY(memory_array(&masses, n, sizeof *masses, "the estimates", error));
  size_t resolved = 0;
  for (size_t i = 0; i < n; i++) {
    total += fragments[i].mass;
    elements += fragments[i].count;
    if (fragments[i].count > 1)
      masses[resolved++] = fragments[i].mass;
    largest = fmax(largest, fragments[i].mass);
  }
  double element = total / elements;
  for (int i = 0; i < ESTIMATES_COUNT; i++) {
    struct estimate *row = &rows[i];
    const enum exponent_method method = (enum exponent_method)(i / ESTIMATES_WINDOWS); /* with a cut-off: one window */
    const int number = method == EXPONENT_UPPER_CUTOFF ? ESTIMATES_FROM_5 : i % ESTIMATES_WINDOWS;
    const double lower = estimates_window_lower((enum estimates_window)number, element, complete_mass);
    const struct exponent_window window = exponent_window_from(method, lower, largest);
    *row = (struct estimate){.window = number,
                             .half_width = NAN,
                             .headline = method == (int)ESTIMATES_HEADLINE_METHOD &&
                                         number == (int)ESTIMATES_HEADLINE_WINDOW,
                             .fit = exponent_unknown(method, window)};
    if (!(largest > lower))
      continue; /* no fragment in the window */
    TRY(exponent_fit(method, resolved, masses, window, &row->fit, error));
    if (isinf(row->fit.cutoff_mass))
      row->fit.cutoff_mass = NAN;
  }
  return STATUS_OK;
}

status estimates_named(const char *name, bool *is, enum exponent_method *method, enum estimates_window *window,
                       struct error *error) {
  *is = strncmp(name, "beta", strlen("beta")) == 0;
  *method = (enum exponent_method)ESTIMATES_HEADLINE_METHOD;
  *window = (enum estimates_window)ESTIMATES_HEADLINE_WINDOW;
  if (!*is || strcmp(name, "beta") == 0)
    return STATUS_OK;
  char all[512] = "";
  for (int m = EXPONENT_LEAST_SQUARES; m <= EXPONENT_MASSES; m++)
    for (int w = 0; w < ESTIMATES_WINDOWS; w++) {
      char known[64];
      snprintf(known, sizeof known, "beta_%s_%s", exponent_method_names[m], estimates_window_names[w]);
      *method = (enum exponent_method)m;
      *window = (enum estimates_window)w;
      if (strcmp(name, known) == 0)
        return STATUS_OK;
      text_append(all, sizeof all, ", %s", known);
    }
  return status_fail(error, STATUS_USAGE, "'%s' is no exponent of a point: give beta, or beta_METHOD_WINDOW, one of%s",
                     name, all + 1);
}

const char *estimates_short_name(const char *name) {
  char headline[64];
  snprintf(headline, sizeof headline, "beta_%s_%s", exponent_method_names[ESTIMATES_HEADLINE_METHOD],
           estimates_window_names[ESTIMATES_HEADLINE_WINDOW]);
  return strcmp(name, headline) == 0 ? "beta" : name;
}
