/* Writes the snapshot that is due, and the list of all snapshots. */
#include "campaign/one_run/snapshots.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/snapshot_read.h"
#include "schemas/field.h"
#include "schemas/file.h"
#include "schemas/text.h"

struct snapshots {
  char name[FIELD_TEXT_SIZE];
  int64_t count, next; /* next: number of the next snapshot */
  bool resumed;        /* the run was restored, and snapshots_look() was not called yet */
  double *time;        /* s, by number; NaN: there is no such file */
};

enum { PATH = FIELD_TEXT_SIZE + 64 };

static void path_of(const struct snapshots *s, int64_t number, char path[PATH]) {
  snprintf(path, PATH, "%s_%06lld.hdf", s->name, (long long)number);
}

static void path_of_list(const struct snapshots *s, char path[PATH]) {
  snprintf(path, PATH, "%s.hdf.series", s->name);
}

status snapshots_open(const char *name, int64_t count, bool resumed, struct snapshots **out, struct error *error) {
  struct snapshots *s = calloc(1, sizeof *s);
  *out = NULL;
  if (s && !(s->time = malloc(((size_t)count + 1) * sizeof *s->time))) {
    free(s);
    s = NULL;
  }
  if (!s)
    return status_fail(error, STATUS_MEMORY, "no memory for %lld snapshots", (long long)count);
  snprintf(s->name, sizeof s->name, "%s", name);
  s->count = count;
  s->resumed = resumed;
  char path[PATH];
  path_of_list(s, path);
  status code = file_claim(path, "list of snapshots", error);
  for (int64_t k = 0; k < count; k++) {
    s->time[k] = NAN;
    path_of(s, k, path);
    if (code == STATUS_OK)
      code = file_may_replace(path, "snapshot", error);
  }
  if (code == STATUS_OK)
    *out = s;
  else
    snapshots_close(s);
  return code;
}

void snapshots_close(struct snapshots *s) {
  if (s)
    free(s->time);
  free(s);
}

/* Reads the times of the earlier snapshots of a restored run, which are on the disk. */
static void find_earlier(struct snapshots *s, double progress) {
  s->resumed = false;
  s->next = (int64_t)ceil(progress * (double)s->count);
  for (int64_t k = 0; k < s->next && k < s->count; k++) {
    char path[PATH];
    struct snapshot_read *file;
    path_of(s, k, path);
    if (snapshot_read_open(path, &file, NULL))
      continue;
    if (!snapshot_read_real(file, "run", "time", &s->time[k]))
      s->time[k] = NAN;
    snapshot_read_close(file);
  }
}

/* ParaView's list of files with their times (style: JSON, version 1.0). Names are relative to it. */
static status write_series(const struct snapshots *s, struct error *error) {
  char *text = NULL, path[PATH];
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    return status_fail(error, STATUS_MEMORY, "no memory for the list of snapshots");
  const char *base = strrchr(s->name, '/');
  fputs("{\n  \"file-series-version\": \"1.0\",\n  \"files\": [", out);
  const char *between = "\n";
  for (int64_t k = 0; k < s->count; k++) {
    if (isnan(s->time[k]))
      continue;
    char number[32];
    snprintf(path, sizeof path, "%s_%06lld.hdf", base ? base + 1 : s->name, (long long)k);
    field_print_number(s->time[k], number);
    fprintf(out, "%s    {\"name\": ", between);
    text_json_string(path, out);
    fprintf(out, ", \"time\": %s}", number);
    between = ",\n";
  }
  fputs("\n  ]\n}\n", out);
  if (!text_close(out, &text))
    return status_fail(error, STATUS_MEMORY, "no memory for the list of snapshots");
  path_of_list(s, path);
  status code = file_write(path, "list of snapshots", text, size, error);
  free(text);
  return code;
}

status snapshots_look(struct snapshots *s, const struct engine_kind *kind, void *run, struct error *error) {
  double progress = kind->progress(run);
  if (s->resumed)
    find_earlier(s, progress);
  if (s->next >= s->count || progress * (double)s->count < (double)s->next)
    return STATUS_OK;
  char path[PATH];
  int64_t number = s->next;
  path_of(s, number, path);
  TRY(kind->write_snapshot(run, path, error));
  s->time[number] = kind->time(run);
  s->next = number + 1;
  while (s->next < s->count && progress < 1 && progress * (double)s->count >= (double)s->next)
    s->next++; /* a step longer than the interval: the missed snapshots are left out */
  if (progress >= 1)
    s->next = s->count; /* the run has ended, perhaps before its longest time: this was the last snapshot */
  return write_series(s, error);
}
