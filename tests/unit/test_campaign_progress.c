/* Progress into a file that is no terminal, and the bar's redraws: how often, how long, what they say. */

#include "campaign/terminal/progress.h"
#include "tests/support/check.h"

static struct progress_state of(int64_t done) {
  return (struct progress_state){.done = done,
                                 .total = 1000,
                                 .running = 2,
                                 .rate = 20,
                                 .seconds_left = 90,
                                 .quantity = "largest_fraction",
                                 .mean = {.mean = 0.3125, .half_width = 0.008}};
}

TEST(durations) {
  char text[32];
  const struct {
    double s;
    const char *text;
  } cases[] = {{0.4, "0.4 s"},          {42.4, "42 s"},       {125, "2 min 05 s"}, {12000, "3 h 20 min"},
               {100000, "27 h 46 min"}, {200000, "2 d 07 h"}, {NAN, "?"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    progress_duration(cases[i].s, text, sizeof text);
    assert_string_equal(text, cases[i].text);
  }
}

TEST(a_rule_tells_how_narrow_its_interval_is) {
  char text[1024] = "";
  FILE *out = fmemopen(text, sizeof text, "w");
  struct progress *progress = progress_create(out, PROGRESS_BAR, false, 240);
  struct progress_state now = of(10);
  now.reached = 5.84, now.asked = 5, now.unit = " %";
  progress_update(progress, &now, 0, false);
  now.reached = 2.6e5, now.asked = 2e5, now.unit = " Pa", now.point = 2;
  progress_update(progress, &now, 100, false);
  now.reached = 1e5, now.least = 50;
  progress_update(progress, &now, 200, true);
  progress_free(progress);
  fclose(out);
  assert_non_null(strstr(text, " Pa (asked 2e+05 Pa of at least 50 runs)"));
  assert_non_null(strstr(text, ", the rule's interval ± 5.8 % (asked 5 %)"));
  assert_non_null(strstr(text, ", the rule's interval at point 2 ± 2.6e+05 Pa (asked 2e+05 Pa)"));
}

TEST(a_log_gets_a_line_per_twentieth_or_minute) {
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(progress_style_of(tmpfile()), PROGRESS_PLAIN);
  struct progress *progress = progress_create(out, PROGRESS_PLAIN, false, 0);
  struct progress_state now;
  for (int i = 0; i <= 1000; i++) {
    now = of(i);
    progress_update(progress, &now, i * 0.01, false);
  }
  progress_free(progress);
  fflush(out);
  int lines = 0;
  for (char *c = text; *c; c++)
    lines += *c == '\n';
  assert_int_equal(lines, 20); /* 5 %, 10 % ... 100 % */
  assert_null(strchr(text, '\r'));
  assert_null(strchr(text, '\033'));
  assert_non_null(strstr(text, " 45%  450 of 1000 runs, 2 running, 20 runs/s, 1 min 30 s left, "
                               "largest_fraction 0.312 ± 0.008 (seeds, 95 %)\n"));
  rewind(out);
  progress = progress_create(out, PROGRESS_PLAIN, false, 0);
  now = of(3);
  for (int second = 0; second <= 200; second++) /* no run finishes: one line a minute shows that the program is alive */
    progress_update(progress, &now, second, false);
  progress_free(progress);
  fclose(out);
  lines = 0;
  for (size_t i = 0; i < size; i++)
    lines += text[i] == '\n';
  assert_int_equal(lines, 3);
}

/* A study runs one campaign after the other: each tells its progress, in lines two seconds apart. */
TEST(a_log_tells_of_each_part_of_a_study) {
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  struct progress *progress = progress_create(out, PROGRESS_PLAIN, false, 0);
  for (int part = 0; part < 3; part++)
    for (int i = 0; i <= 1000; i++) { /* 10 s each */
      struct progress_state now = of(i);
      now.part = true;
      progress_update(progress, &now, part * 10 + i * 0.01, false);
    }
  progress_free(progress);
  fclose(out);
  int lines = 0;
  for (char *c = text; *c; c++)
    lines += *c == '\n';
  assert_in_range(lines, 3 * 4, 3 * 5);
}

TEST(a_bar_is_redrawn_ten_times_a_second_and_fits) {
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  struct progress *progress = progress_create(out, PROGRESS_BAR, true, 60);
  struct progress_state now = of(0);
  for (int i = 0; i <= 1000; i++) { /* one second */
    now = of(i);
    now.failed = 3;
    progress_update(progress, &now, i * 0.001, i == 1000);
  }
  progress_note(progress, "a note");
  progress_update(progress, &now, 2, false);
  progress_free(progress);
  fclose(out);
  assert_non_null(strstr(text, "clast: a note\n"));
  int redraws = 0, widest = 0, width = 0, escape = 0;
  for (size_t i = 0; i < size; i++) {
    redraws += text[i] == '\r' && i + 4 < size && (unsigned char)text[i + 4] == 0x1B;
    if (text[i] == '\r' || text[i] == '\n')
      width = 0;
    else if (text[i] == '\033')
      escape = 1;
    else if (escape)
      escape = text[i] != 'm' && text[i] != 'K';
    else if (((unsigned char)text[i] & 0xC0) != 0x80)
      width++;
    widest = width > widest ? width : widest;
  }
  assert_true(redraws >= 10 && redraws <= 13);
  assert_true(widest < 60);
  assert_non_null(strstr(text, "a note\n"));
  assert_non_null(strstr(text, "3 failed"));
  assert_int_equal(text[size - 1], '\n');
}
