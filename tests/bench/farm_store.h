/* Synthetic tasks whose reports go into a store as runs of one point: the work of a campaign's manager, without
 * physics. */
#pragma once

#include "db/store/store.h"
#include "tests/support/farm_tasks.h"
#include "tests/support/store_fixture.h"

struct storing {
  struct task_list *list; /* first: set by farm_over */
  struct store *store;
  struct scene scene;
  struct fixture_run *run;
};

static inline bool store_next(void *context, struct farm_task *task) {
  return task_list_next(((struct storing *)context)->list, task);
}

static inline status store_report(void *context, const struct farm_report *report, struct error *error) {
  struct storing *s = context;
  s->run->run.replicate = (int64_t)report->id;
  s->run->run.seed = report->id;
  s->run->run.wall_s = report->wall_s;
  scene_identity(&s->scene, report->id, s->run->run.identity);
  return store_add_run(s->store, &s->run->run, error);
}

static inline status store_ticking(void *context, int running, struct error *error) {
  (void)running;
  return store_tick(((struct storing *)context)->store, error);
}

/* A store with a campaign of one point, for runs of `fragments` fragments. The caller frees s->run and s->store. */
static inline status storing_begin(struct storing *s, size_t fragments, struct error *error) {
  struct fixture_inputs inputs;
  char path[64];
  int64_t campaign = 0, session = 0, point = 0;
  s->run = malloc(sizeof *s->run);
  s->scene = fixture_scene(&inputs, 6, 1e30);
  status code = s->run ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a run");
  if (!code)
    code = store_open_writer(fixture_path(path, "bench-farm"), &s->store, NULL, 0, error);
  if (!code)
    code = store_add_campaign(s->store, "bench", "", "{}", &campaign, error);
  if (!code)
    code = store_begin_session(s->store, "{}", &session, error);
  if (!code)
    code = store_add_point(s->store, campaign, &s->scene, 2, fixture_axes, &point, error);
  if (code)
    return code;
  fixture_fill(s->run, &s->scene, point, session, 0, fragments);
  s->run->run.estimate_count = 0;
  return STATUS_OK;
}

static inline void storing_end(struct storing *s) {
  char path[64];
  store_close(s->store, NULL);
  fixture_path(path, "bench-farm"); /* removes it */
  free(s->run);
}
