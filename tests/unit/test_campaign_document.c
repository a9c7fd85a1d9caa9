/* Campaign documents: the meaning of good ones and the errors of bad ones. Every error has the line, the path and the
 * remedy. */
#include <dirent.h>

#include "campaign/design/design.h"
#include "campaign/document/campaign.h"
#include "campaign/scheduler/scheduler.h"
#include "tests/support/check.h"

#define HEAD "name: t\nscene: disc-explosion\n"

static status parse(const char *text, struct campaign **campaign, struct error *e) {
  return campaign_parse("t.yaml", text, strlen(text), NULL, campaign, e);
}

static uint64_t points_of(const struct campaign *campaign) {
  struct design *design = NULL;
  if (design_create((enum design_kind)campaign->design.kind, campaign->axes, campaign->axis_count,
                    (uint64_t)campaign->design.points, (uint64_t)campaign->design.seed, &design, &error) != STATUS_OK)
    fail_msg("%s", error.message);
  const uint64_t points = design_points(design);
  design_free(design);
  return points;
}

static struct campaign *good(const char *text) {
  struct campaign *campaign = NULL;
  if (parse(text, &campaign, &error) != STATUS_OK)
    fail_msg("refused:\n%s\n%s", text, error.message);
  return campaign;
}

/* `first` opens the report; it contains the others, separated by '|', in any place. */
static void bad(const char *text, const char *expected) {
  struct campaign *campaign = NULL;
  assert_int_equal(parse(text, &campaign, &error), STATUS_CONTENT);
  assert_null(campaign);
  char *copy = strdup(expected), *rest = NULL;
  for (char *part = strtok_r(copy, "|", &rest); part; part = strtok_r(NULL, "|", &rest))
    if (!strstr(error.message, part))
      fail_msg("not said: '%s'\nin the report on\n%s\n%s", part, text, error.message);
  free(copy);
}

/* The report has one error. */
static void once(const char *text, const char *expected) {
  struct campaign *campaign = NULL;
  assert_int_equal(parse(text, &campaign, &error), STATUS_CONTENT);
  const char *first = strstr(error.message, "error: ");
  if (!first || !strstr(error.message, expected) || strstr(first + 1, "error: "))
    fail_msg("%s", error.message);
}

TEST(defaults_and_units) {
  struct campaign *campaign = good(HEAD "vary: {strain: [1 %, 3 %]}\nset: {contact.friction: 0.2}\n"
                                        "limits: {time: 10 min, memory: 2 GiB}\n");
  assert_string_equal(campaign->store, "t.db");
  assert_non_null(strstr(campaign->text, "vary: {strain: [1 %, 3 %]}")); /* the store keeps it as written */
  assert_string_equal(campaign->quantity, "largest_fraction");
  assert_int_equal(campaign->per_point, 20);
  assert_int_equal(campaign->attempts, 2);
  assert_int_equal(campaign->failures, 20);
  assert_true(campaign->time_limit == 600 && campaign->memory_limit == 2147483648.0);
  assert_string_equal(campaign->axes[0].row->path, "threshold.strain");
  assert_true(campaign->axes[0].levels[0].number == 0.01 && campaign->axes[0].levels[1].number == 0.03);
  assert_int_equal(points_of(campaign), 2);
  assert_int_equal(campaign_seed(campaign, campaign->scene, 4), 5);
  campaign_free(campaign);
  static const char *const made_for[][2] = {{"compression", "strength"},        {"uniaxial", "young_modulus"},
                                            {"tensile-rod", "peak.stress"},     {"elastic-bar", "frequency"},
                                            {"porous-plate", "shock.pressure"}, {"disruption", "largest_fraction"}};
  for (size_t i = 0; i < sizeof made_for / sizeof made_for[0]; i++) {
    char text[128];
    snprintf(text, sizeof text, "name: t\nscene: %s\naccuracy: {within: 1 %%}\n", made_for[i][0]);
    campaign = good(text);
    assert_string_equal(campaign->quantity, made_for[i][1]);
    assert_string_equal(campaign->accuracy_quantity, made_for[i][1]);
    campaign_free(campaign);
  }
  static const char *const asked[][2] =
      {{"accuracy: {quantity: dust_fraction, within: 1}\n", "dust_fraction"},
       {"seeds: {until: {quantity: dust_fraction, half_width: 0.1}}\n", "dust_fraction"},
       {"quantity: fragment_count\naccuracy: {quantity: dust_fraction, within: 1}\n", "fragment_count"},
       {"accuracy: {quantity: beta, within: 1}\n", "largest_fraction"}}; /* an exponent is of a point, not of a run */
  for (size_t i = 0; i < sizeof asked / sizeof asked[0]; i++) {
    char text[128];
    snprintf(text, sizeof text, HEAD "%s", asked[i][0]);
    campaign = good(text);
    assert_string_equal(campaign->quantity, asked[i][1]);
    campaign_free(campaign);
  }
  campaign = good("name: t\nscene: compression\naccuracy: {within: 17 MPa}\n");
  assert_true(campaign->accuracy_within == 17e6 && !campaign->accuracy_of_value);
  campaign_free(campaign);
  /* A number without a unit is refused where the quantity has one. Wrong units are told once. */
  bad("name: t\nscene: compression\nseeds: {until: {half_width: 2e6}}\n", "seeds.until.half_width");
  bad("name: t\nscene: compression\naccuracy: {within: 5}\n", "accuracy.within");
  once("name: t\nscene: compression\naccuracy: {within: 5 Mpa}\n", "unknown unit 'Mpa'");
  bad("name: t\nscene: compression\nseeds: {until: {half_width: 17 m}}\n", "expected a pressure");
  /* Masses of the plane. */
  bad("name: t\nscene: disc-explosion\nseeds: {until: {quantity: mean_fragment_mass, half_width: 1 kg}}\n", "kg/m");
  campaign_free(good("name: t\nscene: disc-explosion\n"
                     "seeds: {until: {quantity: mean_fragment_mass, half_width: 1 kg/m}}\n"));
  bad(HEAD "accuracy: {within: 17 MPa}\n", "accuracy.within: expected a plain number");
  campaign = good(HEAD "seeds: 4\n");
  assert_int_equal(campaign_replicates_least(campaign), 4);
  campaign_free(campaign);
  campaign = good(HEAD "seeds: {until: {half_width: 1 %}, max: 90}\nlimits: {time: off}\nkeep: {fields: first 3}\n");
  assert_int_equal(campaign->per_point, 0);
  assert_string_equal(campaign->until_quantity, "largest_fraction");
  assert_true(campaign->until_half_width == 0.01 && campaign->until_of_value && isnan(campaign->time_limit));
  assert_int_equal(campaign->until_minimum, 30);
  assert_int_equal(campaign_replicates_least(campaign), 50); /* at 30 and 40 no values are enough to stop */
  assert_int_equal(campaign_replicates_most(campaign), 90);
  assert_int_equal(campaign->keep, CAMPAIGN_KEEP_FIRST);
  assert_int_equal(campaign->keep_first, 3);
  campaign_free(campaign);
}

TEST(every_kind_of_axis) {
  CAMPAIGN campaign = good(HEAD "design: {kind: sobol, points: 16, seed: 3}\nvary:\n"
                                "  threshold.strain: {log: [1 %, 8 %], n: 4}\n"
                                "  threshold.angle: {normal: {mean: 4 deg, sd: 1 deg}, truncated: [1 deg, 7 deg]}\n"
                                "  grain.young_modulus: {lognormal: {median: 1 GPa, sigma: 0.1}}\n"
                                "  beam.young_modulus: {linked: grain.young_modulus, factor: 0.5, offset: 1 MPa}\n"
                                "  contact.friction: {uniform: [0, 0.8]}\n"
                                "  contact.tangential_damping: {log_uniform: [1e3 1/s, 1e5 1/s]}\n"
                                "  contact.law: [conservative, printed]\n"
                                "  grain.disorder: {from: 0, to: 1, n: 5}\n"
                                "  contact.bonded: {linked: contact.law, values: [true, false]}\n");
  assert_int_equal(campaign->axis_count, 9);
  assert_int_equal(points_of(campaign), 16);
  assert_int_equal(campaign->axes[0].level_count, 4);
  assert_true(fabs(campaign->axes[0].levels[1].number / 0.02 - 1) < 1e-13);
  assert_int_equal(campaign->axes[1].kind, DESIGN_AXIS_NORMAL);
  assert_true(fabs(campaign->axes[1].lower / (M_PI / 180) - 1) < 1e-13);
  assert_true(fabs(campaign->axes[1].upper / (7 * M_PI / 180) - 1) < 1e-13);
  /* A law without ends of its own ends where the input does. */
  assert_true(campaign->axes[2].lower == campaign->axes[2].row->minimum);
  assert_true(campaign->axes[2].upper == campaign->axes[2].row->maximum && isfinite(campaign->axes[2].upper));
  assert_int_equal(campaign->axes[3].kind, DESIGN_AXIS_LINKED);
  assert_int_equal(campaign->axes[3].linked, 2);
  assert_true(campaign->axes[3].b == 1e6);
  assert_int_equal(campaign->axes[8].level_count, 2);
}

/* Values of axes are checked where a point is made: the point's scene is freed then (the leak check sees it). */
TEST(values_that_do_not_fit_make_no_point) {
  static const struct {
    const char *vary;
    struct field_value values[2];
    const char *expected;
  } cases[] = {
      {"vary: {strain: [1 %]}\n", {{.kind = FIELD_REAL, .number = -1}}, "threshold.strain"},
      {"vary: {contact.bonded: [true], strain: [1 %]}\n",
       {{.kind = FIELD_BOOLEAN, .number = 1}, {.kind = FIELD_REAL, .number = 1e9}},
       "threshold.strain"},
      {"vary: {body.diameter: [1 m], grain.spacing: [1 cm]}\n", /* each is in its range */
       {{.kind = FIELD_REAL, .number = 1e3}, {.kind = FIELD_REAL, .number = 1e-3}},
       "too large"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[200];
    snprintf(text, sizeof text, HEAD "%s", cases[i].vary);
    CAMPAIGN campaign = good(text);
    assert_null(campaign_point_scene(campaign, cases[i].values, &error));
    assert_int_equal(error.status, STATUS_CONTENT);
    if (!strstr(error.message, cases[i].expected))
      fail_msg("%s", error.message);
  }
}

TEST(independent_seeds_follow_the_point) {
  CAMPAIGN campaign = good(HEAD "seeds: {first: 10, independent: true}\nvary: {strain: [1 %, 3 %]}\n");
  SCENE a = campaign_point_scene(campaign, &campaign->axes[0].levels[0], &error);
  SCENE b = campaign_point_scene(campaign, &campaign->axes[0].levels[1], &error);
  assert_true(campaign_seed(campaign, a, 0) != campaign_seed(campaign, b, 0));
  assert_true(campaign_seed(campaign, a, 0) != campaign_seed(campaign, a, 1));
  assert_true(campaign_seed(campaign, a, 3) == campaign_seed(campaign, a, 3));
  assert_true(campaign_seed(campaign, a, 0) >> 63 == 0);
  assert_true(campaign->independent_given);
}

TEST(equal_values_are_one_point) {
  static const struct {
    const char *text;
    uint64_t points;
  } cases[] = {
      {"vary: {strain: [7 %, 7.0 %, 0.07 m/m]}\n", 1},
      {"vary: {strain: [7 %, 1 %, 7.0 %, 3 %, 1 %]}\n", 3},
      {"vary: {strain: [1 %, 1 %], contact.law: [printed, conservative, printed], contact.bonded: [true, true]}\n", 2},
      {"vary: {strain: [1 %, 1 %], threshold.angle: {linked: strain, values: [2 deg, 3 deg]}}\n", 2},
      {"design: list\nvary: {strain: [1 %, 1 %], threshold.angle: [2 deg, 3 deg]}\n", 2},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[300];
    snprintf(text, sizeof text, HEAD "%s", cases[i].text);
    CAMPAIGN campaign = good(text);
    assert_int_equal(points_of(campaign), cases[i].points);
  }
  CAMPAIGN campaign = good(HEAD "vary: {strain: [7 %, 1 %, 7.0 %, 3 %]}\n");
  assert_true(campaign->axes[0].levels[0].number == 0.07 && campaign->axes[0].levels[2].number == 0.03);
}

/* Two names of one input are a slip; documents of stores may have them, the last one counts. */
TEST(one_input_is_set_once) {
  static const char twice[] = HEAD "set: {body.diameter: 8 cm, diameter: 9 cm}\n";
  bad(twice, "t.yaml:3:|set.diameter: the same input as set.body.diameter");
  struct campaign *campaign = NULL;
  OK(campaign_parse_stored("t", twice, NULL, &campaign, &error));
  campaign_free(campaign);

  /* The command line replaces the value of the document, under any name. */
  FILE *file = fopen("t-set.yaml", "w");
  assert_non_null(file);
  fputs(HEAD "set: {body.diameter: 8 cm}\n", file);
  fclose(file);
  const struct campaign_changes once = {1, (const char *const[]){"diameter=9 cm"}, 0, 0};
  OK(campaign_load_changed("t-set.yaml", &once, &campaign, &error));
  assert_null(strstr(campaign->text, "8 cm"));
  struct field_value value;
  field_get(field_find(campaign->scene->kind->inputs, "body.diameter", &error), campaign->scene->inputs, &value);
  assert_true(value.number == 0.09);
  campaign_free(campaign);
  const struct campaign_changes both = {2, (const char *const[]){"diameter=9 cm", "body.diameter=7 cm"}, 0, 0};
  campaign = NULL;
  const status code = campaign_load_changed("t-set.yaml", &both, &campaign, &error);
  remove("t-set.yaml");
  assert_int_equal(code, STATUS_USAGE);
}

/* The command line is the last layer: an input that it sets does not vary, and the store's document says so. */
TEST(a_set_input_does_not_vary) {
  static const struct {
    const char *change, *kept;
    double points; /* 0: refused */
  } cases[] = {{"strain=9 %", "8 deg", 2},
               {"threshold.strain=9 %", "8 deg", 2},
               {"angle=3 deg", "2 %", 3},
               {"charge.energy=3 kJ/m", "", 0}}; /* the strain follows it */
  FILE *file = fopen("t-layer.yaml", "w");
  assert_non_null(file);
  fputs(HEAD "vary: {strain: [2 %, 5 %, 7 %], threshold.angle: [4 deg, 8 deg]}\n", file);
  fclose(file);
  FILE *linked = fopen("t-linked.yaml", "w");
  assert_non_null(linked);
  fputs(HEAD "vary: {charge.energy: [1 kJ/m, 2 kJ/m], strain: {linked: energy, values: [1 %, 2 %]}}\n", linked);
  fclose(linked);
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    struct campaign *campaign = NULL;
    const struct campaign_changes changes = {1, &cases[i].change, 0, 0};
    if (cases[i].points == 0) {
      assert_int_equal(campaign_load_changed("t-linked.yaml", &changes, &campaign, &error), STATUS_USAGE);
      assert_non_null(strstr(error.message, "it is linked to another input"));
      continue;
    }
    OK(campaign_load_changed("t-layer.yaml", &changes, &campaign, &error));
    assert_int_equal(points_of(campaign), cases[i].points);
    assert_non_null(strstr(campaign->text, cases[i].kept));
    struct campaign *stored = NULL;
    OK(campaign_parse_stored("t", campaign->text, NULL, &stored, &error));
    assert_int_equal(points_of(stored), cases[i].points);
    campaign_free(stored);
    campaign_free(campaign);
  }
  remove("t-layer.yaml");
  remove("t-linked.yaml");
}

TEST(bad_documents_are_told_what_to_do) {
  bad("name: t\nscene: disc-collision\nset: {impact.speed: 100 m/s}\nvary: {impact.parameter: [0, 0.5]}\n",
      "t.yaml:3:21: error: set.impact.speed: has no effect|t.yaml:4:26: error: vary.impact.parameter: the dem scene");
  bad(HEAD "seeds: [4]\n", "t.yaml:3:8: error: seeds: expected keys and values below it|per_point");
  bad(HEAD "set: {body.diameter: 2e9 cm}\n", "and at most|cm, got 2e9 cm");
  bad(HEAD "set: {threshold.strain: 5 %%}\n", "two percent signs");
  bad(HEAD "set: {threshold.strain: 0.07}\n", "write '0.07 %' or '7 %'");
  bad("scene: disc-explosion\n", "name");
  bad("name: t\n", "scene");
  bad("name: t\nscene: disc-explosoin\n", "t.yaml:2:8: error: scene|disc-explosion");
  bad(HEAD "nmae: x\n", "t.yaml:3:1: error:|nmae|name");
  bad(HEAD "vary: {threshold.strian: [1, 2]}\n", "t.yaml:3:|vary.threshold.strian|threshold.strain");
  bad(HEAD "vary: {threshold.strain: 3 %}\n", "t.yaml:3:|a single value belongs in `set`");
  bad(HEAD "vary: {threshold.strain: []}\n", "expected one value at least");
  bad(HEAD "vary: {threshold.strain: [1 m]}\n", "t.yaml:3:|vary.threshold.strain|m");
  bad(HEAD "vary: {threshold.strain: [-1 %]}\n", "t.yaml:3:|vary.threshold.strain");
  bad(HEAD "vary: {threshold.strain: [.nan, 1 %]}\n", "t.yaml:3:|vary.threshold.strain");
  bad(HEAD "vary: {threshold.strain: {log: [1 %, 6 %]}}\n", "'n', the number of values, is missing");
  bad(HEAD "vary: {threshold.strain: {log: [6 %, 1 %], n: 3}}\n", "the smaller value first");
  bad(HEAD "vary: {contact.friction: {log: [0, 1], n: 3}}\n", "both ends above zero");
  bad(HEAD "vary: {threshold.strain: {from: 1 %, n: 3}}\n", "'to' is missing");
  bad(HEAD "vary: {threshold.strain: {from: 1 %, to: 2 %, n: 1}}\n", "t.yaml:3:|vary.threshold.strain");
  bad(HEAD "vary: {threshold.strain: {from: 1 %, to: 2 %, n: 3, step: 4}}\n", "step");
  bad(HEAD "vary: {threshold.strain: {evenly: [1, 2]}}\n", "expected one of {from, to, n}");
  bad(HEAD "vary: {threshold.strain: {uniform: [1 %, 2 %]}}\n", "a distribution has no grid");
  bad(HEAD "design: {kind: sobol, points: 8}\nvary: {threshold.strain: {normal: {mean: 3 %, sd: 1 %}}}\n",
      "cannot take|truncated: [a, b]");
  bad(HEAD "design: {kind: sobol, points: 8}\nvary: {threshold.strain: {normal: {mean: 3 %}}}\n", "'sd' is missing");
  bad(HEAD "design: {kind: sobol, points: 8}\nvary: {threshold.strain: {lognormal: {median: 3 %, sigma: 0}}}\n",
      "sigma|0");
  bad(HEAD "design: {kind: sobol, points: 8}\nvary: {contact.law: {uniform: [1, 2]}}\n", "this input is no number");
  bad(HEAD "design: sobol\nvary: {threshold.strain: {uniform: [1 %, 2 %]}}\n", "say how many points");
  bad(HEAD "design: {kind: grid, points: 5}\nvary: {threshold.strain: [1 %]}\n", "t.yaml:3:|points");
  bad(HEAD "design: hexagonal\n", "t.yaml:3:9: error:|hexagonal|latin_hypercube");
  bad(HEAD "design: list\nvary: {threshold.strain: [1 %, 2 %], threshold.angle: [1 deg]}\n", "equally long");
  bad(HEAD "vary: {threshold.strain: [1 %], strain: [2 %]}\n", "the same input as vary.threshold.strain");
  bad(HEAD "vary: {threshold.strain: [1 %]}\nset: {strain: 2 %}\n", "t.yaml:4:|varied in `vary`");
  bad(HEAD "vary: {beam.young_modulus: {linked: grain.young_modulus}}\n", "is not varied");
  bad(HEAD "vary: {beam.young_modulus: {linked: beam.young_modulus}}\n", "is not varied");
  bad(HEAD
      "vary: {beam.young_modulus: {linked: grain.young_modulus}, grain.young_modulus: {linked: beam.young_modulus}}\n",
      "linked itself");
  bad(HEAD "vary: {beam.young_modulus: {linked: strain, values: [1 GPa]}, strain: [1 %, 2 %]}\n", "as many as");
  bad(HEAD "set: {contact.friction: [1, 2]}\n", "several values belong in `vary`");
  bad(HEAD "set: {contact.friction: 5 m}\n", "t.yaml:3:|set.contact.friction");
  bad(HEAD "set: {impact.speed: 5 m/s}\n", "impact.speed"); /* has no effect in an explosion */
  bad(HEAD "vary:\n  threshold.strain: [1 %, 2 %]\n  impact.speed: [5 m/s, 6 m/s]\n",
      "t.yaml:5:17: error: vary.impact.speed: has no effect");
  bad(HEAD "seeds: {per_point: 0}\n", "t.yaml:3:|seeds.per_point");
  bad(HEAD "seeds: {per_point: 3.5}\n", "t.yaml:3:|seeds.per_point");
  bad(HEAD "seeds: {per_point: 3, until: {half_width: 0.1}}\n", "exclude each other");
  bad(HEAD "seeds: {max: 100}\n", "only `until` has a maximum");
  bad(HEAD "seeds: {until: {quantity: largest_fraction}}\n", "'half_width' is missing");
  bad(HEAD "seeds: {until: {half_width: 0.1}, max: 20}\n",
      "seeds.until ends no point before 41 runs, whatever its interval, and max is 20: give max: 41 or more, or "
      "per_point: 20 and no until");
  bad(HEAD "seeds: {until: {half_width: 0.1, minimum: 10}, max: 40}\n", "no point before 41 runs");
  campaign_free(good(HEAD "seeds: {until: {half_width: 0.1, minimum: 2, batch: 3}, max: 41}\n")); /* 20 t(40) = 40.4 */
  bad(HEAD "seeds: {until: {half_width: 8, quantity: largest_fraction}}\n", "8 per cent of the mean is written '8 %'");
  campaign_free(good(HEAD "seeds: {until: {half_width: 8, quantity: fragment_count}}\n"));
  bad(HEAD "seeds: {until: {half_width: 0.1, quantity: largest_fractoin}}\n", "did you mean 'largest_fraction'?");
  bad(HEAD "quantity: message\n", "no number");
  bad(HEAD "keep: {fields: last 3}\n", "expected {fields: none | all | extremes | first N}, got 'last 3'");
  bad(HEAD "keep: {fields: first 0}\n", "expected {fields:");
  bad(HEAD "keep: all\n", "expected {fields:");
  bad(HEAD "limits: {time: 10 m}\n", "t.yaml:3:|limits.time");
  bad(HEAD "limits: {memory: 2 kg}\n", "limits.memory");
  bad(HEAD "limits: {attempts: 0}\n", "limits.attempts");
  bad(HEAD "limits: {failures: 51}\n", "limits.failures");
  bad(HEAD "store: {a: b}\n", "store");
}

TEST(all_errors_come_at_once) {
  bad("name: t\nscene: disc-explosion\nvary:\n  threshold.strain: [1 kg]\nset:\n  contact.friction: many\n"
      "seeds: {per_point: none}\nlimits: {time: -1 s}\nkepe: {fields: all}\n",
      "t.yaml:4:|t.yaml:6:|t.yaml:7:|t.yaml:8:|t.yaml:9:");
}

TEST(odd_bytes_are_refused) {
  struct campaign *campaign;
  const struct {
    const char *text;
    size_t size;
  } odd[] = {{"", 0},
             {"\0\0\0", 3},
             {"name: \xff\xfe", 9},
             {"[1, 2]", 6},
             {"just text", 9},
             {"name: t\n---\nname: u\n", 20},
             {"{", 1},
             {"name: 't", 8},
             {"\x7f"
              "ELF\x02\x01\x01\0\0\0\0",
              11}};
  for (size_t i = 0; i < sizeof odd / sizeof odd[0]; i++) {
    assert_int_equal(campaign_parse("odd", odd[i].text, odd[i].size, NULL, &campaign, &error), STATUS_CONTENT);
    assert_true(strlen(error.message) > 10);
  }
  assert_int_equal(campaign_load("no/such/campaign.yaml", &campaign, &error), STATUS_MISSING);
  assert_int_equal(campaign_load(".", &campaign, &error), STATUS_IO);
}

TEST(examples_are_ready_to_run) {
  DIR *folder = opendir(CLAST_SOURCE_DIR "/campaign/examples");
  int seen = 0;
  assert_non_null(folder);
  for (struct dirent *entry; (entry = readdir(folder));) {
    if (!strstr(entry->d_name, ".yaml"))
      continue;
    char path[1024];
    struct campaign *campaign = NULL;
    struct plan plan;
    snprintf(path, sizeof path, CLAST_SOURCE_DIR "/campaign/examples/%s", entry->d_name);
    OK(campaign_load(path, &campaign, &error));
    struct plan_options options = {.no_trial = true, .slots = 2, .store_path = "no-such-store.db"};
    if (plan_make(campaign, &options, &plan, &error) != STATUS_OK)
      fail_msg("%s: %s", path, error.message);
    assert_int_equal(plan.points, points_of(campaign));
    assert_true(plan.points >= 3 && plan.runs_least >= 12 && plan.memory_most > 1e5 && !plan.store_exists);
    assert_int_equal(plan.runs_there, 0);
    assert_true(isnan(plan.run_s_mean));
    OWNED char *json = plan_print_json(campaign, &plan, 2);
    assert_non_null(strstr(json, "\"run_s_mean\": null"));
    plan_clear(&plan);
    campaign_free(campaign);
    seen++;
  }
  closedir(folder);
  assert_int_equal(seen, 13);
}

/* Rules that are younger than a store do not refuse what has run: `clast retry` reads its document. */
TEST(stored_rules_of_seeds_are_read) {
  static const char text[] = "name: x\nscene: disc-explosion\nquantity: energy_input\n"
                             "seeds: {until: {half_width: 5, minimum: 10}, max: 20}\n";
  CAMPAIGN campaign = NULL;
  assert_int_equal(campaign_parse("t.yaml", text, strlen(text), NULL, &campaign, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "ends no point before 41 runs"));
  assert_non_null(strstr(error.message, "half_width"));
  OK(campaign_parse_stored("t.yaml", text, NULL, &campaign, &error));
  assert_true(campaign->maximum == 20 && campaign->until_half_width == 5);
}

/* Documents and scenes of stores from before units were required. */
TEST(stored_numbers_are_si) {
  static const char text[] = "name: x\nscene: disc-explosion\nset: {threshold.angle: 0.1}\n"
                             "vary: {threshold.strain: [0.02, 3 %]}\nlimits: {time: 60}\n";
  CAMPAIGN campaign = NULL;
  assert_int_equal(campaign_parse("t.yaml", text, strlen(text), NULL, &campaign, &error), STATUS_CONTENT);
  for (size_t i = 0; i < 3; i++)
    assert_non_null(
        strstr(error.message, (const char *[]){"'0.1 deg' or '0.1 rad'", "'0.02 %' or '2 %'", "'60 s'"}[i]));
  OK(campaign_parse_stored("t.yaml", text, NULL, &campaign, &error));
  assert_true(campaign->axes[0].levels[0].number == 0.02 && campaign->time_limit == 60);

  OWNED char *json = scene_json(campaign->scene); /* SI numbers without unit, as in every store */
  SCENE again = NULL;
  assert_non_null(json);
  assert_int_equal(scene_parse("t", json, &again, &error), STATUS_CONTENT);
  OK(scene_parse_json("t", json, &again, &error));
  uint8_t first[16], second[16];
  scene_identity(campaign->scene, 1, first);
  scene_identity(again, 1, second);
  assert_memory_equal(first, second, sizeof first);
}

static void axis_text(const char *vary, const char *expected) {
  char text[400], *words = NULL;
  size_t size = 0;
  CAMPAIGN campaign = NULL;
  snprintf(text, sizeof text, "name: x\nscene: disc-explosion\nvary: {%s}\ndesign: {kind: random, points: 4}\n", vary);
  OK(campaign_parse("t.yaml", text, strlen(text), NULL, &campaign, &error));
  FILE *out = open_memstream(&words, &size);
  design_axis_describe(campaign->axes, campaign->axis_count - 1, out);
  fclose(out);
  assert_string_equal(words, expected);
  free(words);
}

TEST(axes_are_shown_with_units) {
  axis_text("threshold.strain: [1 %, 0.1 %]", "1 %, 0.1 %");
  axis_text("threshold.angle: [4 deg]", "4 deg");
  axis_text("beam.young_modulus: {uniform: [1 GPa, 2 GPa]}", "uniform from 1 GPa to 2 GPa");
  axis_text("charge.energy: {log_uniform: [1 kJ/m, 1 MJ/m]}", "uniform in the logarithm from 1 kJ/m to 1000 kJ/m");
  axis_text("threshold.strain: {normal: {mean: 3 %, sd: 1 %}, truncated: [1 %, 5 %]}",
            "normal, mean 3 %, standard deviation 1 %, not below 1 %, not above 5 %");
  axis_text("grain.density: {lognormal: {median: 5 g/cm^3, sigma: 0.1}}",
            "lognormal, median 5 g/cm^3, sigma of the natural logarithm 0.1");
  axis_text("grain.young_modulus: [1 GPa, 2 GPa], beam.young_modulus: {linked: grain.young_modulus, factor: 0.5}",
            "follows grain.young_modulus: 0.5 times it");
  axis_text("threshold.strain: {from: 1 %, to: 20 %, n: 20}",
            "1 %, 2 %, 3 %, 4 %, 5 %, 6 %, 7 %, 8 %, 9 %, 10 %, 11 % ... 20 %: 20 values");
}
