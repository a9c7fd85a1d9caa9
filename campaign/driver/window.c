/* The window of points being computed: points enter it with their stored runs in the order of the design, and leave it
 * when they are finished. */
#include "campaign/driver/private.h"
#include "campaign/driver/record.h"

#include <stdlib.h>
#include <string.h>

#define HASH_NONFATAL_OOM         1
#define uthash_nonfatal_oom(seen) free(seen)
#include <uthash.h>

struct driver_seen {
  int64_t id;
  UT_hash_handle hh;
};

/* True when the id is new. When memory is out a duplicate point is checked twice, which does no harm. */
static bool remember(struct driver *driver, int64_t id) {
  struct driver_seen *seen = NULL;
  HASH_FIND(hh, driver->seen, &id, sizeof id, seen);
  if (seen)
    return false;
  seen = calloc(1, sizeof *seen);
  if (!seen)
    return true;
  seen->id = id;
  HASH_ADD(hh, driver->seen, id, sizeof seen->id, seen);
  return true;
}

void driver_window_forget(struct driver *driver) {
  struct driver_seen *seen, *next;
  HASH_ITER(hh, driver->seen, seen, next) {
    HASH_DEL(driver->seen, seen);
    free(seen);
  }
}

struct resuming {
  struct driver *driver;
  struct point *point;
  bool out_of_memory;
};

/* Writes a note about the first missing fields file. */
static void note_missing(struct driver *driver, const struct store_point_run *run) {
  char text[4400];
  snprintf(text, sizeof text,
           "fields file %.4000s of the store is missing, perhaps others too (`clast check` lists them): those that "
           "the campaign keeps are computed again",
           run->fields_path);
  driver_note(driver, text);
}

static void count_stored(struct driver *driver, const struct store_point_run *run, bool usable) {
  driver->summary.runs_reused++;
  driver->summary.runs_surplus += run->surplus;
  driver->summary.runs_failed += !usable;
  driver->summary.runs_censored += run->state == OUTCOME_END_TIME;
}

/* Takes over a stored run. */
static void take_stored(void *context, const struct store_point_run *run) {
  struct resuming *resuming = context;
  struct point *point = resuming->point;
  struct driver *driver = resuming->driver;
  const int64_t r = record_replicate(driver->campaign, point->scene, run);
  if (r < 0 || r >= campaign_replicates_most(driver->campaign))
    return;
  if (!point_reserve(point, r)) {
    resuming->out_of_memory = true;
    return;
  }
  const bool usable = outcome_is_usable(run->state), kept = run->fields_path && !run->fields_missing;
  const double value = usable ? run->value : DRIVER_NOTHING;
  point_finish_replicate(point, r, POINT_DONE, value);
  point->replicates[r].surplus = run->surplus;
  point->replicates[r].fields = kept || run->state == OUTCOME_INVALID;
  if (driver->campaign->keep != CAMPAIGN_KEEP_NONE && run->fields_missing && driver->fields_missing++ == 0)
    note_missing(driver, run);
  cost_learn(&driver->cost, &point->cost, run->wall_s);
  count_stored(driver, run, usable);
  sample_add(&driver->moments, value);
}

/* Called after the prefix has grown: surplus runs inside it count from now on. A run that counts is never excluded
 * again, so that a point shared with another campaign keeps that campaign's decision. */
static status admit(struct driver *driver, struct point *point, struct error *error) {
  bool any = false;
  int64_t prefix = point->prefix;
  for (int64_t r = 0; r < point->capacity; r++) {
    struct point_replicate *replicate = &point->replicates[r];
    if (replicate->state != POINT_DONE)
      continue;
    if (r < point->prefix && replicate->surplus) {
      any = true;
      replicate->surplus = false;
      driver->summary.runs_surplus--;
    } else if (r >= prefix && !replicate->surplus) {
      prefix = r + 1;
    }
  }
  return any ? store_set_prefix(driver->store, point->id, prefix, error) : STATUS_OK;
}

status driver_window_judge(struct driver *driver, struct point *point, struct error *error) {
  int64_t before = point->prefix;
  if (!point_judge(point))
    return STATUS_OK;
  driver->wanted += point->prefix - before;
  if (point->decided) {
    driver->summary.points_done++;
    driver->summary.points_interval_met += point->verdict == DESIGN_INTERVAL_MET;
    driver->summary.points_cap_reached += point->verdict == DESIGN_CAP_REACHED;
    point_want_fields(point, driver->campaign);
  }
  return admit(driver, point, error);
}

/* Counts a point with an invalid combination of values, and writes a note for the first few. */
static void skip_invalid(struct driver *driver, const struct error *why) {
  if (++driver->summary.points_invalid > 5)
    return;
  char text[sizeof why->message + 80];
  snprintf(text, sizeof text, "point %llu of the design cannot be run: %s", (unsigned long long)driver->expanded,
           why->message);
  driver_note(driver, text);
}

/* Takes the point's stored runs, then judges its prefixes. */
static status resume(struct driver *driver, struct point *point, struct error *error) {
  struct resuming resuming = {driver, point, false};
  status code = store_point_runs(driver->store, point->id, point->scene->kind, driver->row, driver->row_of_outcome,
                                 take_stored, &resuming, error);
  if (code != STATUS_OK)
    return code;
  if (resuming.out_of_memory)
    return status_fail(error, STATUS_MEMORY, "no memory for a point's runs");
  code = driver_window_judge(driver, point, error);
  if (code != STATUS_OK)
    return code;
  return admit(driver, point, error); /* a fixed number of replicates may cover runs that an older rule left out */
}

bool driver_window_expand(struct driver *driver, status *code, struct error *error) {
  if (driver->point_count == DRIVER_WINDOW || !campaign_walk_next(&driver->walk))
    return false;
  driver->expanded++;
  struct error why = {0};
  struct scene *scene = campaign_point_scene(driver->campaign, driver->walk.values, &why);
  if (!scene && why.status == STATUS_MEMORY) {
    *code = status_fail(error, STATUS_MEMORY, "%s", why.message);
    return false;
  }
  if (!scene) {
    skip_invalid(driver, &why);
    return true;
  }

  int64_t id = 0;
  *code = store_add_point(driver->store, driver->summary.campaign_id, scene, driver->campaign->axis_count,
                          driver->paths, &id, error);
  if (*code != STATUS_OK || !remember(driver, id)) {
    scene_free(scene);
    return *code == STATUS_OK;
  }
  struct point *point = point_create(driver->campaign, scene);
  if (!point) {
    *code = status_fail(error, STATUS_MEMORY, "no memory for a point");
    return false;
  }

  point->id = id;
  driver->summary.points++;
  driver->wanted += point->prefix;
  *code = resume(driver, point, error);
  if (*code != STATUS_OK || point_over(point)) {
    point_free(point);
    return *code == STATUS_OK;
  }
  driver->points[driver->point_count++] = point;
  return true;
}

void driver_window_drop(struct driver *driver, struct point *point) {
  for (size_t i = 0; i < driver->point_count; i++)
    if (driver->points[i] == point) {
      /* Keeps the order: points of equal cost start in the order of the design. */
      memmove(&driver->points[i], &driver->points[i + 1], (driver->point_count - i - 1) * sizeof *driver->points);
      driver->point_count--;
      break;
    }
  point_free(point);
}
