/* Collects the engine's warnings about the first points of a campaign. */
#include "campaign/document/campaign_warn.h"

#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign_walk.h"
#include "engine/outcome.h"
#include "schemas/text.h"

enum { LOOKED_AT = 1000, LINE = 400 };

struct doubts {
  size_t points, count[WARNINGS_COUNT];
  char first[WARNINGS_COUNT][LINE]; /* the engine's text for the first point with this warning */
};

/* The engine writes its lines in the order of the bits. */
static void add(struct doubts *doubts, const struct scene *scene) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = scene->kind->warn ? text_open(&text, &size) : NULL;
  doubts->points++;
  if (!out)
    return;
  const unsigned set = scene->kind->warn(scene->inputs, out);
  const char *line = text_close(out, &text) ? text : "";
  for (size_t k = 0; k < WARNINGS_COUNT; k++) {
    if (!(set >> k & 1))
      continue;
    const size_t length = strcspn(line, "\n");
    if (doubts->count[k]++ == 0)
      snprintf(doubts->first[k], sizeof doubts->first[k], "%.*s", (int)length, line);
    line += length + (line[length] != 0);
  }
  free(text);
}

static void print(const struct doubts *doubts, const char *before, bool counted, FILE *out) {
  for (size_t k = 0; k < WARNINGS_COUNT; k++) {
    if (doubts->count[k] == 0)
      continue;
    fputs(before, out);
    if (counted)
      fprintf(out, "%zu of %zu points: ", doubts->count[k], doubts->points);
    fprintf(out, "%s\n", doubts->first[k]);
  }
}

void campaign_warn_scene(const struct scene *scene, const char *before, FILE *out) {
  struct doubts doubts = {0};
  add(&doubts, scene);
  print(&doubts, before, false, out);
}

void campaign_warn(const struct campaign *campaign, const char *before, FILE *out) {
  struct doubts doubts = {0};
  struct campaign_walk walk;
  struct error error;
  if (campaign_walk_begin(&walk, campaign, &error) == STATUS_OK)
    for (size_t i = 0; i < LOOKED_AT && campaign_walk_next(&walk); i++) {
      struct scene *scene = campaign_walk_scene(&walk, &error);
      if (scene)
        add(&doubts, scene);
      scene_free(scene);
    }
  campaign_walk_end(&walk);
  print(&doubts, before, doubts.points > 1, out);
}
