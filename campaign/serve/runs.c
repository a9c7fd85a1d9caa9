/* A table of runs with two keys, and a queue. */
#include "campaign/serve/runs.h"

#include <stdlib.h>

static void free_run(struct serve_run *run) {
  for (struct serve_wish *wish = run->wishes, *next; wish; wish = next) {
    next = wish->next;
    free(wish);
  }
  scene_free(run->scene);
  free(run);
}

struct serve_run *serve_runs_find(const struct serve_runs *runs, const uint8_t identity[16]) {
  struct serve_run *run = NULL;
  HASH_FIND(hh, runs->all, identity, 16, run);
  return run;
}

struct serve_run *serve_runs_with_id(const struct serve_runs *runs, uint64_t id) {
  struct serve_run *run = NULL;
  HASH_FIND(by_id, runs->all_by_id, &id, sizeof id, run);
  return run;
}

void serve_runs_push(struct serve_runs *runs, struct serve_run *run) {
  run->next = NULL;
  if (runs->queue)
    runs->queue_end->next = run;
  else
    runs->queue = run;
  runs->queue_end = run;
}

void serve_runs_pop(struct serve_runs *runs) {
  runs->queue = runs->queue->next;
}

struct serve_run *serve_runs_add(struct serve_runs *runs, const struct record *record, const struct scene *scene) {
  struct serve_run *run = calloc(1, sizeof *run);
  if (!run)
    return NULL;
  run->scene = scene_copy(scene);
  run->id = ++runs->last_id;
  run->record = *record;
  if (!run->scene) {
    free_run(run);
    return NULL;
  }
  HASH_ADD(hh, runs->all, record.identity, 16, run);
  HASH_ADD(by_id, runs->all_by_id, id, sizeof run->id, run);
  serve_runs_push(runs, run);
  return run;
}

bool serve_runs_wish(struct serve_run *run, struct serve_job *job) {
  struct serve_wish *wish = malloc(sizeof *wish);
  if (!wish)
    return false;
  *wish = (struct serve_wish){job, run->wishes};
  run->wishes = wish;
  return true;
}

void serve_runs_remove(struct serve_runs *runs, struct serve_run *run) {
  HASH_DELETE(hh, runs->all, run);
  HASH_DELETE(by_id, runs->all_by_id, run);
  free_run(run);
}

void serve_runs_clear(struct serve_runs *runs) {
  struct serve_run *run, *next;
  HASH_ITER(hh, runs->all, run, next) {
    serve_runs_remove(runs, run);
  }
  *runs = (struct serve_runs){0};
}
