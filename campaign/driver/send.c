/* Chooses the next run of the campaign and makes the farm's task from it. */
#include <stdlib.h>
#include <string.h>

#include "campaign/driver/private.h"
#include "campaign/driver/run.h"
#include "schemas/clock.h"

/* The most expensive point that has a run to send out. The run is in the point's prefix, or with `ahead` may be beyond
 * it. */
static struct point *choose(struct driver *driver, bool ahead, int64_t *replicate) {
  struct point *best = NULL;
  double highest = -1;
  for (size_t i = 0; i < driver->point_count; i++) {
    struct point *point = driver->points[i];
    double cost = cost_predict(&driver->cost, &point->cost);
    if (cost <= highest)
      continue;
    int64_t r = point_next(point, ahead);
    if (r < 0)
      continue;
    best = point;
    highest = cost;
    *replicate = r;
  }
  return best;
}

/* A stored run whose fields are still to be written. */
static struct point *choose_replay(struct driver *driver, int64_t *replicate) {
  for (size_t i = 0; i < driver->point_count; i++) {
    struct point *point = driver->points[i];
    for (int64_t r = 0; point->replays > 0 && r < point->capacity; r++)
      if (point->replicates[r].replay) {
        *replicate = r;
        return point;
      }
  }
  return NULL;
}

static status fill_window(struct driver *driver, double deadline) {
  status code = STATUS_OK;
  while (driver->point_count < DRIVER_WINDOW && clock_s() < deadline) {
    if (!driver_window_expand(driver, &code, &driver->error))
      break;
  }
  return code;
}

/* The next run or replay, regardless of earlier failures: first runs of the prefixes, then runs beyond them, so that no
 * slot idles, then replays. Runs beyond a prefix start only when no further point can enter the window. NULL: nothing
 * to do. */
static struct point *choose_any(struct driver *driver, double deadline, struct flight *flight, status *code) {
  do {
    *code = fill_window(driver, deadline);
    if (*code != STATUS_OK)
      return NULL;
    struct point *point = choose(driver, false, &flight->replicate);
    if (point)
      return point;
  } while (driver->point_count < DRIVER_WINDOW && driver_window_expand(driver, code, &driver->error));
  if (*code != STATUS_OK)
    return NULL;

  struct point *point = choose(driver, true, &flight->replicate);
  if (point)
    return point;
  point = choose_replay(driver, &flight->replicate);
  flight->replay = point != NULL;
  return point;
}

/* The next run whose attempts are not used up. Runs that used up their attempts, now or in an earlier invocation, count
 * as failed. */
static struct point *next_run(struct driver *driver, struct flight *flight, status *code) {
  const double deadline = clock_s() + DRIVER_FILL_S;
  for (;;) {
    struct point *point = choose_any(driver, deadline, flight, code);
    if (!point)
      return NULL;
    flight->seed = campaign_seed(driver->campaign, point->scene, flight->replicate);
    scene_identity(point->scene, flight->seed, flight->identity);
    flight->attempt = 1;
    if (flight->replay)
      return point;

    int failed = store_attempts(driver->store, flight->identity, driver->time_limit, driver->memory_limit);
    flight->attempt = failed + 1;
    if (failed < driver->campaign->attempts)
      return point;

    driver_give_up(driver, point, flight->replicate);
    *code = driver_window_judge(driver, point, &driver->error);
    if (*code != STATUS_OK)
      return NULL;
    if (point_over(point))
      driver_window_drop(driver, point);
  }
}

static struct flight *free_flight(struct driver *driver) {
  for (size_t i = 0; i < driver->flight_count; i++)
    if (!driver->flights[i].point)
      return &driver->flights[i];

  size_t count = driver->flight_count ? 2 * driver->flight_count : 16;
  struct flight *flights = realloc(driver->flights, count * sizeof *flights);
  if (!flights)
    return NULL;
  struct flight *fresh = &flights[driver->flight_count];
  memset(fresh, 0, (count - driver->flight_count) * sizeof *flights);
  driver->flights = flights;
  driver->flight_count = count;
  return fresh;
}

static status encode(struct driver *driver, const struct flight *flight, const struct scene *scene, size_t *size) {
  char path[4096] = "";
  if (driver_writes_fields(driver, flight))
    driver_fields_path(driver, flight->identity, true, path, sizeof path);
  const struct run_request request = {.kind = scene->kind,
                                      .inputs = scene->inputs,
                                      .seed = flight->seed,
                                      .fields_path = path[0] ? path : NULL};
  free(driver->task);
  driver->task = run_encode_task(&request, size);
  if (!driver->task)
    return status_fail(&driver->error, STATUS_MEMORY, "no memory for a task");
  return STATUS_OK;
}

static void mark_sent(struct point *point, const struct flight *flight) {
  struct point_replicate *replicate = &point->replicates[flight->replicate];
  point->out++;
  if (!flight->replay) {
    replicate->state = POINT_OUT;
    return;
  }
  replicate->replay = false;
  replicate->replaying = true;
  point->replays--;
}

bool driver_send(void *context, struct farm_task *task) {
  struct driver *driver = context;
  if (driver->error.status != STATUS_OK)
    return false; /* tick() passes the error to the farm */
  if (driver->stop.status != STATUS_OK)
    return false;

  struct flight flight = {0};
  status code = STATUS_OK;
  flight.point = next_run(driver, &flight, &code);
  if (code != STATUS_OK)
    driver->error.status = code;
  if (!flight.point)
    return false;

  struct flight *place = free_flight(driver);
  if (!place) {
    status_fail(&driver->error, STATUS_MEMORY, "no memory for a task");
    return false;
  }
  if (encode(driver, &flight, flight.point->scene, &task->size) != STATUS_OK)
    return false;
  flight.started = clock_s();
  *place = flight;
  mark_sent(flight.point, &flight);
  task->id = (uint64_t)(place - driver->flights);
  task->bytes = driver->task;
  return true;
}
