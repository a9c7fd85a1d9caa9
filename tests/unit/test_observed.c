/* Documents of measurements: the meaning of good ones and the errors of bad ones. */
#define CHECK_OWN_MAIN

#include "campaign/document/observed.h"
#include "campaign/fit/fit.h"
#include "schemas/text.h"
#include "tests/support/check.h"

#define HEAD "name: t\nsource: a test\n"
#define SHOT HEAD "shots:\n  - "

static struct campaign *campaign;

static status parse(const char *text, struct observed **observed, struct error *e) {
  return observed_parse("m.yaml", text, strlen(text), campaign, observed, e);
}

static struct observed *good(const char *text) {
  struct observed *observed = NULL;
  if (parse(text, &observed, &error) != STATUS_OK)
    fail_msg("refused:\n%s\n%s", text, error.message);
  return observed;
}

/* Parts of the expected report, separated by '|'. */
static void bad(const char *text, const char *expected) {
  struct observed *observed = NULL;
  char copy[512], *rest = NULL;
  assert_int_equal(parse(text, &observed, &error), STATUS_CONTENT);
  assert_null(observed);
  snprintf(copy, sizeof copy, "%s", expected);
  for (char *part = strtok_r(copy, "|", &rest); part; part = strtok_r(NULL, "|", &rest))
    if (!strstr(error.message, part))
      fail_msg("not said: '%s'\nin the report on\n%s\n%s", part, text, error.message);
}

TEST(numbers_and_units) {
  struct observed *m = good(
      SHOT "name: first\n    specimens: 3\n    set: {energy: 3 kJ/m}\n    measured:\n"
           "      - {quantity: largest_fraction, value: 31 %, error: 1 %, resolution: 0.05}\n"
           "      - {quantity: count_above, share: 0.01, value: 12, error: 2}\n"
           "  - measured: [{quantity: beta_masses_from_2, value: 2}, {quantity: time, value: 3 ms}]\n");
  assert_int_equal(m->shot_count, 2);
  assert_int_equal(m->datum_count, 4);
  assert_int_equal(m->shots[0].specimens, 3);
  assert_int_equal(m->shots[1].specimens, 1);
  assert_string_equal(m->shots[1].name, "shot 2");
  assert_true(fabs(m->data[0].value - 0.31) < 1e-15 && m->data[0].error == 0.01 && m->data[0].resolution == 0.05);
  assert_true(m->data[1].ask.kind == ASK_SPECIMENS_COUNT && m->data[1].ask.share == 0.01);
  assert_true(isnan(m->data[1].resolution));
  assert_true(m->data[2].ask.kind == ASK_SPECIMENS_EXPONENT && m->data[2].shot == 1);
  assert_true(m->data[3].value == 0.003);
  struct field_value energy;
  const struct field *row = field_find(campaign->scene->kind->inputs, "charge.energy", &error);
  field_get(row, m->shots[0].scene->inputs, &energy);
  assert_true(energy.number == 3000);
  field_get(row, m->shots[1].scene->inputs, &energy);
  assert_true(energy.number != 3000);
  /* A count is compared as ln(1 + N). */
  assert_true(fabs(fit_transform(&m->data[1], 12) - log(13)) < 1e-15);
  assert_true(fabs(fit_back(&m->data[1], fit_transform(&m->data[1], 12)) - 12) < 1e-12);
  observed_free(m);
}

/* 60, 20, 10, 5, 2.5 and 1.25 of 100: M_1/M, and numbers above 20 to 1 in four even steps of the logarithm. */
TEST(masses_become_numbers) {
  struct observed *m = good(SHOT "fragments: {total: 100 g, complete: 1 g, masses: [5 g, 60 g, 1.25 g, 20 g, 10 g, 2.5 "
                                 "g], resolution: 10 %}\n");
  assert_int_equal(m->datum_count, 5);
  assert_true(fabs(m->data[0].value - 0.6) < 1e-12 && fabs(m->data[0].resolution - 0.06) < 1e-12);
  const double counts[4] = {3, 4, 5, 6}; /* above 9.46, 4.47, 2.11 and 1 g */
  for (size_t k = 0; k < 4; k++) {
    assert_true(fabs(m->data[k + 1].share - 0.2 * pow(0.05, (double)(k + 1) / 4)) < 1e-9);
    assert_true(m->data[k + 1].value == counts[k] && fabs(m->data[k + 1].resolution - 0.1 * counts[k]) < 1e-12);
  }
  observed_free(m);
  m = good(SHOT "fragments: {total: 10 g, complete: 1 g, masses: [8 g, 2 g]}\n");
  assert_true(isnan(m->data[0].resolution) && isnan(m->data[1].resolution));
  observed_free(m);
}

/* Fragments of just a mass from which numbers count are in them, whatever the rounding of that mass: eight of the
 * complete mass below second fragments of many masses, and a list in which every mass is such a mass. */
TEST(ties_count) {
  for (int second = 150; second < 400; second++) {
    char text[512];
    snprintf(text, sizeof text,
             SHOT
             "fragments: {total: 200 g, complete: 0.7 g, masses: [94 g, %.1f g, 12 g, 5 g, 2 g, 1 g, 0.7 g, 0.7 g, "
             "0.7 g, 0.7 g, 0.7 g, 0.7 g, 0.7 g, 0.7 g]}\n",
             second / 10.0);
    struct observed *m = good(text);
    assert_true(m->datum_count == 5 && m->data[4].value == 14);
    observed_free(m);
  }
  for (int scale = 1; scale < 100; scale++) {
    char text[512];
    snprintf(text, sizeof text, SHOT "fragments: {total: %d g, complete: %d g, masses: [", 150 * scale, 3 * scale);
    for (int k = 5; k >= 0; k--)
      snprintf(text + strlen(text), sizeof text - strlen(text), "%d g%s", 3 * (k < 5 ? 1 << k : 16) * scale,
               k ? ", " : "]}\n");
    struct observed *m = good(text);
    assert_int_equal(m->datum_count, 5);
    for (int k = 1; k < 5; k++) /* above 24, 12, 6 and 3 times the scale */
      assert_true(m->data[k].value == k + 2);
    observed_free(m);
  }
}

TEST(errors_have_a_place) {
  bad("name: t\nshots: []\n", "source|m.yaml:2|expected a list of shots");
  bad(HEAD, "expected a list of shots");
  bad(SHOT "name: s\n", "m.yaml:4|no measurement");
  bad(SHOT "measured: [{quantity: largest_fractoin, value: 1}]\n", "m.yaml:4|largest_fraction");
  bad(SHOT "measured: [{quantity: beta_best, value: 2}]\n", "beta");
  bad(SHOT "measured: [{quantity: largest_fraction}]\n", "value: is missing");
  bad(SHOT "measured: [{value: 2}]\n", "quantity: is missing");
  bad(SHOT "measured: [{quantity: time, value: 3 kg}]\n", "m.yaml:4|kg");
  bad(SHOT "measured: [{quantity: largest_fraction, value: 0.3, error: -1}]\n", "error|at least 0");
  bad(SHOT "measured: [{quantity: largest_fraction, value: 0.3, sigma: 1}]\n", "sigma");
  bad(SHOT "measured: [{quantity: largest_fraction, value: 0.3, share: 0.1}]\n",
      "only count_above and share_above have a share");
  bad(SHOT "measured: [{quantity: count_above, value: 3}]\n", "count_above needs 'share'");
  bad(SHOT "measured: [{quantity: share_above, value: 3}]\n", "share_above needs 'share'");
  bad(SHOT "measured: [{quantity: count_above, value: 3, share: 2}]\n", "share|below 1");
  bad(SHOT "measured: {quantity: time}\n", "expected a list");
  /* 31 was meant as 31 % */
  bad(SHOT "measured: [{quantity: largest_fraction, value: 31}]\n",
      "m.yaml:4|largest_fraction lies between 0 and 1, not at 31");
  bad(SHOT "measured: [{quantity: time, value: -1 ms}]\n", "time lies between 0 and inf, not at -0.001");
  bad(SHOT "measured: [{quantity: count_above, share: 0.1, value: -1}]\n", "count_above lies between 0 and");
  bad(SHOT "measured: [{quantity: share_above, share: 0.1, value: 1.1}]\n", "share_above lies between 0 and 1");
  bad(SHOT "set: {body.diameter: 8 cm, diameter: 9 cm}\n    measured: [{quantity: time, value: 1}]\n",
      "the same input");
  bad(SHOT "set: {strain: 3 %}\n    measured: [{quantity: time, value: 1}]\n", "unknown in the campaign");
  bad(SHOT "set: {strian: 3 %}\n    measured: [{quantity: time, value: 1}]\n", "threshold.strain");
  bad(SHOT "specimens: 0\n    measured: [{quantity: time, value: 1}]\n", "specimens|at least 1");
  bad(SHOT "fragments: {total: 10 g, complete: 1 g, masses: [9 g, 1.21 g]}\n",
      "weigh 102.1 % of the total"); /* 2 % are of the balance */
  observed_free(good(SHOT "fragments: {total: 10 g, complete: 1 g, masses: [9 g, 1.19 g]}\n"));
  bad(SHOT "fragments: {total: 10 g, masses: [9 g]}\n", "complete");
  bad(SHOT "measured: [{fragments: {total: 10 g, complete: 1 g, masses: [9 g]}}]\n", "a key of the shot");
  observed_free(good(SHOT "fragments: {total: 10 kg/m, complete: 1 kg/m, masses: [9 kg/m]}\n")); /* discs are flat */
  bad(SHOT "fragments: {total: 10 kg/m, complete: 1 kg, masses: [9 kg/m]}\n", "complete");
  char many[4000] = SHOT "measured:\n", shots[4000] = HEAD "shots:\n"; /* one more than there is room for */
  for (size_t k = 0; k <= OBSERVED_DATA; k++)
    text_append(many, sizeof many, "    - {quantity: time, value: %zu ms}\n", k + 1);
  bad(many, "m.yaml:37|more than 32 numbers in all");
  for (size_t k = 0; k <= OBSERVED_SHOTS; k++)
    text_append(shots, sizeof shots, "  - {name: s%zu, measured: [{quantity: time, value: 1 ms}]}\n", k);
  bad(shots, "more than 32 shots");
}

/* The documents of the pages fit_*.md. */
TEST(documents_of_the_pages_are_good) {
  static const char *const pairs[][2] = {{"sphere-measured", "sphere-k"},
                                         {"sphere-measured", "sphere-k-measured-m"},
                                         {"sphere-measured", "sphere-m-k"},
                                         {"exponent-measured", "exponent"},
                                         {"quartzite-measured", "quartzite"}};
  for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
    CAMPAIGN own = NULL;
    struct observed *observed = NULL;
    struct fit *fit = NULL;
    char path[2][512];
    for (int k = 0; k < 2; k++)
      snprintf(path[k], sizeof path[k], CLAST_SOURCE_DIR "/tests/validation/fit/%s.yaml", pairs[i][k]);
    status code = campaign_load(path[1], &own, &error);
    if (code == STATUS_OK)
      code = observed_load(path[0], own, &observed, &error);
    if (code == STATUS_OK)
      code = fit_create(own, observed, &(struct fit_rule){.rounds = 4}, "", &fit, &error);
    if (code != STATUS_OK)
      fail_msg("%s", error.message);
    fit_free(fit);
    observed_free(observed);
  }
}

/* Which campaigns a fit accepts. */
static status create(const char *text, struct error *e) {
  CAMPAIGN other = NULL;
  struct observed *m = good(SHOT "measured: [{quantity: time, value: 1 ms}]\n");
  struct fit *fit = NULL;
  const struct fit_rule rule = {.rounds = 4};
  if (campaign_parse("c.yaml", text, strlen(text), NULL, &other, e) != STATUS_OK)
    fail_msg("refused: %s", e->message);
  const status code = fit_create(other, m, &rule, "disc-explosion", &fit, e);
  fit_free(fit);
  observed_free(m);
  return code;
}

TEST(campaigns_need_priors_and_seeds) {
  assert_int_equal(create("name: t\nscene: disc-explosion\nvary: {strain: [1 %, 2 %]}\n", &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "latin_hypercube"));
  const char sampled[] = "name: t\nscene: disc-explosion\ndesign: {kind: sobol, points: 20}\n";
  char text[512];
  snprintf(text, sizeof text, "%svary: {strain: [1 %%, 2 %%]}\n", sampled);
  assert_int_equal(create(text, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "prior law"));
  snprintf(text, sizeof text, "%svary: {strain: {uniform: [1 %%, 2 %%]}}\nseeds: {per_point: 1}\n", sampled);
  assert_int_equal(create(text, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "at least 2"));
  snprintf(text, sizeof text, "%svary: {strain: {uniform: [1 %%, 2 %%]}}\n", sampled);
  OK(create(text, &error));
}

static int start(void **state) {
  (void)state;
  static const char text[] = "name: t\nscene: disc-explosion\nvary: {strain: {uniform: [1 %, 8 %]}}\n"
                             "design: {kind: random, points: 20}\n";
  return campaign_parse("c.yaml", text, strlen(text), NULL, &campaign, &error);
}

static int end(void **state) {
  (void)state;
  campaign_free(campaign);
  return 0;
}

int main(void) {
  return check_run(start, end);
}
