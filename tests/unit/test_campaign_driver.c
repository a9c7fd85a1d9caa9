/* The driver against a real store, with a farm played by the test: same bits for any slots, order and interruptions;
 * resume, growth, attempts, the failure limit, surplus, fields. */
#define CHECK_OWN_MAIN
#include <signal.h>
#include <sys/wait.h>

#include "campaign/terminal/progress.h"
#include "tests/support/campaign_play.h"
#include "tests/support/check.h"

static char folder[64];
static const char *in(const char *name) {
  static char paths[4][128];
  static int turn;
  turn = (turn + 1) % 4;
  snprintf(paths[turn], sizeof paths[turn], "%s/%s", folder, name);
  play_remove(paths[turn]);
  return paths[turn];
}

static char *complete(const struct campaign *campaign, const char *path, int slots, uint64_t order) {
  struct driver_summary summary;
  struct play play = {.slots = slots, .order = order};
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  free(play.says);
  return play_dump(path);
}

TEST(same_bits_whatever_the_slots) {
  CAMPAIGN campaign = play_campaign(3, 2, 5);
  char *one = complete(campaign, in("one.db"), 1, 0), *three = complete(campaign, in("three.db"), 3, 1);
  char *many = complete(campaign, in("many.db"), 20, 2);
  assert_true(strlen(one) > 1000);
  assert_string_equal(one, three);
  assert_string_equal(one, many);
  /* Interrupted again and again. */
  const char *path = in("stopped.db");
  struct driver_summary summary;
  int invocations = 0;
  int64_t done = 0;
  for (status code = STATUS_STOPPED; code == STATUS_STOPPED; invocations++) {
    struct play play = {.slots = 4, .order = 9 + (uint64_t)invocations, .stop_after = 1 + invocations % 5};
    code = play_once(&play, campaign, path, &summary);
    assert_true(code == STATUS_STOPPED || code == STATUS_OK);
    assert_int_equal(summary.runs_reused, done); /* no reported run is lost or computed twice */
    done += summary.runs_done;
    free(play.says);
  }
  assert_true(invocations > 6);
  assert_int_equal(done, 30);
  char *pieces = play_dump(path);
  assert_string_equal(one, pieces);
  struct play again = {.slots = 3};
  assert_int_equal(play_once(&again, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 0);
  assert_int_equal(summary.runs_reused, 30);
  assert_int_equal(summary.points_done, 6);
  free(again.says), free(pieces), free(one), free(three), free(many);
}

TEST(killed_at_random_instants) {
  CAMPAIGN campaign = play_campaign(2, 2, 40);
  OWNED char *whole = complete(campaign, in("whole.db"), 2, 0);
  const char *path = in("killed.db");
  for (uint64_t k = 0; k < 6; k++) {
    pid_t child = fork();
    if (child == 0) {
      struct driver_summary summary;
      struct play play = {.slots = 4, .order = k + 1};
      play_once(&play, campaign, path, &summary);
      _exit(0);
    }
    usleep((useconds_t)(1000 + 12000 * random_draw(77, RANDOM_RESAMPLE, k, 0)));
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, NULL, 0), child);
  }
  OWNED char *mended = complete(campaign, path, 3, 5);
  assert_string_equal(whole, mended);
}

TEST(growing_campaigns_repeat_nothing) {
  const char *path = in("grown.db");
  struct driver_summary summary;
  struct play play = {.slots = 3};
  struct campaign *small = play_campaign(2, 2, 4), *deeper = play_campaign(2, 2, 7), *wider = play_campaign(3, 2, 7);
  assert_int_equal(play_once(&play, small, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 16);
  assert_int_equal(play_once(&play, deeper, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 12);
  assert_int_equal(play_once(&play, wider, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 14);
  assert_int_equal(summary.runs_reused, 28);
  wider->first_seed = 4; /* seeds 4..10; 4..7 exist already, as other replicates */
  assert_int_equal(play_once(&play, wider, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_reused, 6 * 4);
  assert_int_equal(summary.runs_done, 6 * 3);
  wider->first_seed = 1;
  wider->independent = true;
  assert_int_equal(play_once(&play, wider, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 42);
  assert_int_equal(play_once(&play, wider, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 0);
  free(play.says);
  campaign_free(small), campaign_free(deeper), campaign_free(wider);
}

TEST(a_rule_gives_the_same_prefix_whatever_the_slots) {
  CAMPAIGN campaign = play_campaign(2, 1, 0);
  campaign->until_half_width = 0.003;
  campaign->maximum = 120;
  const char *one = in("until-one.db"), *many = in("until-many.db");
  struct driver_summary few = {0}, lots = {0}, again = {0};
  struct play serial = {.slots = 1}, wide = {.slots = 40, .order = 3};
  assert_int_equal(play_once(&serial, campaign, one, &few), STATUS_OK);
  assert_int_equal(play_once(&wide, campaign, many, &lots), STATUS_OK);
  assert_int_equal(few.runs_surplus, 0);
  assert_true(lots.runs_surplus > 0);
  assert_int_equal(few.points_interval_met + few.points_cap_reached, 2);
  char *a = play_dump(one), *b = play_dump(many);
  assert_string_equal(a, b); /* surplus left out */
  assert_int_equal(play_once(&wide, campaign, many, &again), STATUS_OK);
  assert_int_equal(again.runs_done, 0);
  free(a), free(b);
  /* A campaign with a fixed number of runs includes runs that were computed ahead. */
  campaign->per_point = 120;
  char *c = complete(campaign, many, 5, 4), *d = complete(campaign, one, 1, 0);
  assert_string_equal(c, d);
  free(c), free(d), free(serial.says), free(wide.says);
}

static enum play_fate crash_three(uint64_t seed, int attempt) {
  (void)attempt;
  return seed == 3 ? PLAY_CRASH : PLAY_RUN;
}
static enum play_fate slow_four(uint64_t seed, int attempt) {
  (void)attempt;
  return seed == 4 ? PLAY_SLOW : PLAY_RUN;
}
static enum play_fate crash_all(uint64_t seed, int attempt) {
  (void)seed, (void)attempt;
  return PLAY_CRASH;
}

TEST(attempts_are_kept_and_repeated_up_to_the_limit) {
  const char *path = in("attempts.db");
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(2, 1, 6);
  struct play crashing = {.slots = 2, .fate = crash_three}, good = {.slots = 2};
  assert_int_equal(play_once(&crashing, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.attempts_failed, 4); /* two points, two attempts */
  assert_int_equal(summary.runs_failed, 2);
  assert_int_equal(summary.runs_done, 10);
  assert_int_equal(summary.points_done, 2);
  assert_int_equal(play_once(&good, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 0); /* given up */
  assert_int_equal(summary.runs_failed, 2);
  campaign->attempts = 3;
  assert_int_equal(play_once(&good, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 2);
  assert_int_equal(summary.runs_failed, 0);

  const char *slow = in("slow.db");
  struct play slowly = {.slots = 2, .fate = slow_four};
  campaign->attempts = 1;
  campaign->time_limit = 10;
  assert_int_equal(play_once(&slowly, campaign, slow, &summary), STATUS_OK);
  assert_int_equal(summary.runs_failed, 2);
  assert_int_equal(play_once(&good, campaign, slow, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 0);
  campaign->time_limit = 20; /* a higher limit allows a new attempt */
  assert_int_equal(play_once(&good, campaign, slow, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 2);
  free(crashing.says), free(good.says), free(slowly.says);
}

static enum play_fate lose_three(uint64_t seed, int attempt) {
  (void)attempt;
  return seed == 3 ? PLAY_LOST : PLAY_RUN;
}

/* Runs that the machine ended are skipped, whatever their number, and computed when the machine allows it. */
TEST(lost_runs_are_never_given_up) {
  const char *path = in("lost.db");
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(2, 1, 6);
  struct play losing = {.slots = 2, .fate = lose_three}, good = {.slots = 2};
  for (int i = 0; i < 3; i++) {
    assert_int_equal(play_once(&losing, campaign, path, &summary), STATUS_OK);
    assert_int_equal(summary.attempts_failed, 4); /* two points, two attempts */
    assert_int_equal(summary.runs_failed, 0);
    assert_int_equal(summary.runs_left, 2);
    assert_int_equal(summary.runs_done, i == 0 ? 10 : 0);
    assert_int_equal(summary.points_done, 0);
  }
  assert_int_equal(play_once(&good, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 2);
  assert_int_equal(summary.runs_left, 0);
  assert_int_equal(summary.points_done, 2);
  char *whole = complete(campaign, in("unlost.db"), 2, 0), *mended = play_dump(path);
  assert_string_equal(whole, mended);
  free(whole), free(mended), free(losing.says), free(good.says);
}

TEST(stops_when_too_many_of_the_first_fail) {
  const char *path = in("failing.db");
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(3, 3, 10);
  struct play crashing = {.slots = 2, .fate = crash_all};
  assert_int_equal(play_once(&crashing, campaign, path, &summary), STATUS_FAILED_RUNS);
  assert_int_equal(summary.runs_failed, 20);
  assert_non_null(strstr(crashing.says, "20 of the first 20 runs failed"));
  campaign->failures = 0;
  assert_int_equal(play_once(&crashing, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_failed, 90);
  free(crashing.says);
}

TEST(failed_states_are_results) {
  const char *path = in("states.db");
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(1, 1, 60); /* seeds 1..60: 49 not finite, 13 invalid, 9 19 29 39 59 at end time */
  struct play play = {.slots = 2};
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 60);
  assert_int_equal(summary.runs_failed, 2);
  assert_int_equal(summary.runs_censored, 5);
  assert_int_equal(summary.attempts_failed, 0);
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 0);
  assert_int_equal(summary.runs_failed, 2);
  free(play.says);
}

static int files_in(const char *path) {
  char command[256];
  int count = 0;
  snprintf(command, sizeof command, "ls %s 2>/dev/null | wc -l", path);
  FILE *pipe = popen(command, "r");
  assert_int_equal(fscanf(pipe, "%d", &count), 1);
  pclose(pipe);
  return count;
}

static void print_line(void *context, const char *text) {
  (void)context;
  fprintf(stderr, "%s\n", text);
}

TEST(fields_are_kept_as_asked) {
  const char *path = in("fields.db");
  char kept[128];
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(2, 1, 8);
  struct play play = {.slots = 3, .order = 4};
  snprintf(kept, sizeof kept, "%s/fields-fields", folder);
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(files_in(kept), 0);
  campaign->keep = CAMPAIGN_KEEP_EXTREMES; /* requested later: replayed */
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_done, 0);
  assert_int_equal(summary.fields_written, 4);
  assert_int_equal(files_in(kept), 4);
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.fields_written, 0);
  campaign->keep = CAMPAIGN_KEEP_ALL;
  campaign->per_point = 9;
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(files_in(kept), 18);
  struct store *store = NULL;
  OK(store_open_reader(path, &store, &error));
  if (store_check(store, print_line, NULL, &error) !=
      STATUS_OK) /* every file it names is there, and the sums are right */
    fail_msg("%s", error.message);
  store_close(store, NULL);
  free(play.says);
}

static int fields_left; /* so many fields files can be written */
static status write_few_fields(void *run, const char *path, struct error *e) {
  return fields_left-- > 0 ? toy_write_fields(run, path, e)
                           : status_fail(e, STATUS_IO, "cannot write the fields file '%s': no space", path);
}

/* A full disk: the campaign stops and says so, what ran is stored without fields, and the next invocation makes all. */
TEST(fields_that_cannot_be_written_stop_the_campaign) {
  char path[128], kept[200];
  snprintf(path, sizeof path, "%s", in("full.db"));
  snprintf(kept, sizeof kept, "%s/full-fields", folder);
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(2, 1, 8);
  struct play play = {.slots = 3};
  toy_engine.write_snapshot = write_few_fields;
  campaign->keep = CAMPAIGN_KEEP_ALL;
  fields_left = 4;
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_IO);
  assert_non_null(strstr(play.says, "no space"));
  assert_non_null(strstr(play.says, "The results are stored, these fields are not"));
  assert_int_equal(summary.fields_written, 4);
  assert_true(summary.runs_done >= 5 && summary.runs_done <= 7); /* those on the three slots end */
  const int64_t done = summary.runs_done;
  assert_int_equal(files_in(kept), 4);
  fields_left = 100;
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.runs_reused, done);
  assert_int_equal(summary.runs_done, 16 - done);
  assert_int_equal(summary.fields_written, 12);
  assert_int_equal(files_in(kept), 16);
  toy_engine.write_snapshot = toy_write_fields;
  free(play.says);
}

/* The last line of progress: every run that the rule wanted is done. */
TEST(the_total_of_a_rule_is_met) {
  char *text = NULL;
  size_t size = 0;
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(3, 1, 0);
  campaign->until_half_width = 0.003;
  campaign->maximum = 120;
  for (int wide = 0; wide < 2; wide++) {
    FILE *out = open_memstream(&text, &size);
    struct play play = {.slots = wide ? 40 : 1, .order = 3};
    play.progress = progress_create(out, PROGRESS_PLAIN, false, 0);
    assert_int_equal(play_once(&play, campaign, in("total.db"), &summary), STATUS_OK);
    progress_free(play.progress);
    fclose(out);
    char expected[64];
    const long long counting = summary.runs_done - summary.runs_surplus;
    snprintf(expected, sizeof expected, "100%%  %lld of %lld runs", counting, counting);
    if (!strstr(text, expected))
      fail_msg("no '%s' in:\n%s", expected, text);
    free(text);
    free(play.says);
  }
}

/* Every line of progress tells all runs, also those of points that nobody has met yet. */
TEST(the_total_counts_points_not_met) {
  char *text = NULL, *rest = NULL;
  size_t size = 0;
  int lines = 0;
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(30, 1, 4);
  FILE *out = open_memstream(&text, &size);
  struct play play = {.slots = 2, .order = 3, .progress = progress_create(out, PROGRESS_PLAIN, false, 0)};
  assert_int_equal(play_once(&play, campaign, in("unmet.db"), &summary), STATUS_OK);
  progress_free(play.progress);
  fclose(out);
  for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest), lines++)
    if (!strstr(line, " of 120 runs"))
      fail_msg("not of 120 runs: %s", line);
  assert_int_equal(lines, 21); /* one for each 5 %, and the last one */
  free(text);
  free(play.says);
}

TEST(equal_points_are_computed_once) {
  const char *path = in("equal.db");
  struct driver_summary summary;
  CAMPAIGN campaign = play_campaign(3, 2, 2);
  struct play play = {.slots = 3};
  campaign->design = (struct campaign_design_keys){.kind = CAMPAIGN_RANDOM, .points = 200, .seed = 5};
  assert_int_equal(play_once(&play, campaign, path, &summary), STATUS_OK);
  assert_int_equal(summary.points, 6);
  assert_int_equal(summary.runs_done, 12);
  free(play.says);
}

TEST(broken_answers_are_refused) {
  CAMPAIGN campaign = play_campaign(1, 1, 1);
  struct run_request request = {&toy_engine, campaign->scene->inputs, 5, NULL, NULL};
  struct run_result result;
  size_t task_size, size;
  OWNED uint8_t *task = run_encode_task(&request, &task_size), *bytes = NULL;
  OK(run_work(task, task_size, &bytes, &size, &error));
  OK(run_decode_result(&toy_engine, bytes, size, &result, &error));
  assert_int_equal(result.fragment_count, 25);
  assert_int_equal(result.estimate_count, ESTIMATES_COUNT);
  run_result_clear(&result);
  for (size_t cut = 0; cut < size; cut += cut < 200 ? 1 : 97) {
    OWNED uint8_t *part = malloc(cut + 1); /* an exact copy, so that a sanitizer detects any read beyond it */
    memcpy(part, bytes, cut);
    part = realloc(part, cut ? cut : 1);
    assert_int_equal(run_decode_result(&toy_engine, part, cut, &result, &error), STATUS_INTERNAL);
  }
  for (size_t cut = 0; cut < task_size; cut++) {
    uint8_t *answer = NULL;
    size_t answer_size;
    OWNED uint8_t *part = malloc(cut ? cut : 1);
    memcpy(part, task, cut);
    assert_int_equal(run_work(part, cut, &answer, &answer_size, &error), STATUS_INTERNAL);
  }
}

int main(void) {
  snprintf(folder, sizeof folder, "driver-test-XXXXXX");
  if (!mkdtemp(folder))
    return 1;
  int failed = check_run(NULL, NULL);
  char command[128];
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return system(command) == 0 ? failed : 1;
}
