/* A farm played by the test: tasks are taken from a scheduler, computed by the toy engine and reported in an order that
 * the test chooses. */
#pragma once

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "campaign/scheduler/run.h"
#include "campaign/scheduler/scheduler.h"
#include "engine/random.h"
#include "tests/support/owned.h"
#include "tests/support/toy_engine.h"

static inline struct field_value play_real(double x) {
  return (struct field_value){.kind = FIELD_REAL, .number = x};
}

/* strain x angle, as in a document. */
static struct campaign *play_campaign(size_t strains, size_t angles, int64_t per_point) {
  struct error error;
  struct campaign *campaign = calloc(1, sizeof *campaign);
  field_defaults(&campaign_table, campaign);
  snprintf(campaign->name, sizeof campaign->name, "play");
  campaign->text = strdup("name: play\n");
  campaign->per_point = per_point;
  snprintf(campaign->until_quantity, sizeof campaign->until_quantity, "largest_fraction");
  campaign->scene = calloc(1, sizeof *campaign->scene);
  campaign->scene->kind = &toy_engine;
  campaign->scene->inputs = calloc(1, toy_engine.inputs->size);
  campaign->scene->given = calloc(toy_engine.inputs->count, sizeof *campaign->scene->given);
  campaign->scene->overridden = calloc(toy_engine.inputs->count, sizeof *campaign->scene->overridden);
  campaign->scene->replaced = calloc(toy_engine.inputs->count, sizeof *campaign->scene->replaced);
  field_defaults(toy_engine.inputs, campaign->scene->inputs);
  ((struct toy_inputs *)campaign->scene->inputs)->stick.trouble = true;
  campaign->axis_count = 2;
  campaign->axes = calloc(2, sizeof *campaign->axes);
  for (int a = 0; a < 2; a++) {
    size_t n = a ? angles : strains;
    campaign->axes[a] = (struct design_axis){.row = field_find(toy_engine.inputs, a ? "stick.angle" : "stick.strain",
                                                               &error),
                                             .kind = DESIGN_AXIS_LEVELS,
                                             .level_count = n,
                                             .lower = -HUGE_VAL,
                                             .upper = HUGE_VAL};
    campaign->axes[a].levels = calloc(n, sizeof *campaign->axes[a].levels);
    for (size_t i = 0; i < n; i++)
      campaign->axes[a].levels[i] = play_real(0.01 * (double)(i + 1));
  }
  return campaign;
}

enum play_fate { PLAY_RUN, PLAY_CRASH, PLAY_SLOW, PLAY_LOST, PLAY_STOP };
struct play {
  int slots;
  uint64_t order; /* seed of the order in which runs finish; 0 = the order in which they were started */
  int stop_after; /* number of reports after which all runs in progress are dropped; 0 = never */
  enum play_fate (*fate)(uint64_t seed, int attempt); /* NULL: every task is PLAY_RUN */
  int reports;
  struct progress *progress; /* NULL: none */
  char *says;                /* message of the status that ended it, malloc'd */
};

static status play_farm(struct play *play, struct scheduler *scheduler, struct error *e) {
  struct {
    struct farm_task task;
    uint8_t *bytes;
  } out[64];
  struct farm_manager manager = scheduler_manager(scheduler);
  int count = 0;
  status code = STATUS_OK;
  for (uint64_t turn = 0; code == STATUS_OK; turn++) {
    while (count < play->slots && manager.next(manager.context, &out[count].task)) {
      out[count].bytes = malloc(out[count].task.size);
      memcpy(out[count].bytes, out[count].task.bytes, out[count].task.size);
      count++;
    }
    code = manager.tick(manager.context, count, e);
    if (count == 0 || code != STATUS_OK)
      break;
    if (play->stop_after && play->reports >= play->stop_after) {
      code = STATUS_STOPPED;
      break;
    }
    int pick = play->order ? (int)(random_draw(play->order, RANDOM_RESAMPLE, turn, 0) * count) : 0;
    uint64_t seed = 0;
    /* mark, name, length of the definition, seed: see run.c */
    memcpy(&seed, out[pick].bytes + 8 + 12 + 8 + 3 + 8, sizeof seed);
    enum play_fate fate = play->fate ? play->fate(seed, 0) : PLAY_RUN;
    struct farm_report report =
        {.id = out[pick].task.id, .ending = FARM_DONE, .wall_s = 0.01, .cpu_s = 0.01, .host = "here", .message = ""};
    OWNED uint8_t *bytes = NULL;
    if (fate == PLAY_CRASH) {
      report.ending = FARM_CRASHED;
      report.signal = 11;
      report.message = "killed by signal 11";
    } else if (fate == PLAY_LOST) {
      report.ending = FARM_LOST;
      report.signal = 9;
      report.message = "killed by signal 9";
    } else if (fate == PLAY_SLOW) {
      report.ending = FARM_TIME_LIMIT;
      report.message = "ended at its time limit";
    } else {
      code = run_work(out[pick].bytes, out[pick].task.size, &bytes, &report.size, e);
      report.bytes = bytes;
    }
    free(out[pick].bytes);
    out[pick] = out[--count];
    if (code == STATUS_OK)
      code = manager.report(manager.context, &report, e);
    play->reports++;
  }
  while (count > 0)
    free(out[--count].bytes);
  return code;
}

/* One invocation of `clast run`. */
static status play_once(struct play *play, const struct campaign *campaign, const char *path,
                        struct driver_summary *summary) {
  struct error error = {0};
  struct driver *driver = driver_new(campaign);
  struct scheduler scheduler =
      {.planner = driver_planner(driver),
       .options = {.store_path = path, .facts = "{}", .progress = play->progress, .slots = play->slots}};
  status code = store_open_writer(path, &scheduler.store, NULL, 0, &error);
  if (code == STATUS_OK)
    code = scheduler.planner.begin(driver, &scheduler, &error);
  if (code == STATUS_OK) {
    code = scheduler_end(&scheduler, play_farm(play, &scheduler, &error), &error);
    *summary = driver_summarise(driver);
  }
  driver_free(driver);
  status closed = store_close(scheduler.store, code == STATUS_OK ? &error : NULL);
  code = code != STATUS_OK ? code : closed;
  if (code != STATUS_OK && code != STATUS_STOPPED && code != STATUS_FAILED_RUNS)
    fprintf(stderr, "play: %s: %s\n", status_meaning(code), error.message);
  free(play->says);
  play->says = strdup(error.message);
  return code;
}

/* The result of store_export_digests as text; malloc'd. */
static inline char *play_dump(const char *path) {
  struct error error = {0};
  struct store *store = NULL;
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (store_open_reader(path, &store, &error) != STATUS_OK || store_export_digests(store, out, &error) != STATUS_OK)
    fprintf(stderr, "dump: %s\n", error.message);
  store_close(store, NULL);
  fclose(out);
  return text;
}

static inline void play_remove(const char *path) {
  char other[512];
  unlink(path);
  for (int i = 0; i < 3; i++) {
    snprintf(other, sizeof other, "%s%s", path, i == 0 ? "-wal" : i == 1 ? "-shm" : "-journal");
    unlink(other);
  }
}
