/* What to type where no setting of a study reaches an accuracy. `clast converge` tells what its runs take. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/accuracy_finding.h"

enum { MOST_SEEDS = 1000, FIRST_SEEDS = 4 }; /* of an advised study; of `clast converge` without --seeds */

/* The next finer level of a knob of numbers, over a level. */
static double finer_by(const struct knob *knob) {
  return knob->step_power > 0 ? 0.5 : 2;
}

/* SI unit of a knob's levels, as the user writes it behind them. */
static const char *unit_of(const struct campaign *campaign, const struct knob *knob) {
  const char *path = knob->inputs[0].path; /* NULL: named settings of the scene */
  const struct field *row = path ? field_find(campaign->scene->kind->inputs, path, NULL) : NULL;
  return row && row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
}

/* The finest level of a knob; the scene's own setting if no level has runs. 0: it is a choice. */
static double finest_of(const struct campaign *campaign, const struct accuracy_part *part) {
  char own[64];
  if (part->finest > 0)
    return part->finest;
  ladder_setting(part->knob, campaign->scene, own, sizeof own);
  return strtod(own, NULL);
}

/* The first condition that would mark this scene's result and not that of the campaign's scene (finer grains with the
 * same time step). NULL: none. */
static const struct condition *mark_of(const struct campaign *campaign, const struct scene *scene) {
  const struct condition *list = scene->kind->conditions;
  const condition_set marks = condition_before(list, scene->inputs, NULL) &
                              ~condition_before(list, campaign->scene->inputs, NULL);
  size_t k = 0;
  while (marks && !(marks >> k & 1))
    k++;
  return marks ? &list[k] : NULL;
}

/* The condition that marks the next finer level of the knob. NULL: none does. */
static const struct condition *mark_of_finer(const struct accuracy_finding *finding, const struct accuracy_part *part) {
  struct error ignored;
  char finer[64];
  SCENE scene = scene_copy(finding->campaign->scene);
  snprintf(finer, sizeof finer, "%.6g", finest_of(finding->campaign, part) * finer_by(part->knob));
  return ladder_turn(part->knob, scene, finer, &ignored) == STATUS_OK ? mark_of(finding->campaign, scene) : NULL;
}

/* Have runs told that finer levels of the knob are in doubt, for a reason that is not known before them? */
static bool is_hopeless(const struct accuracy_finding *finding, const struct accuracy_part *part) {
  return condition_has(finding->hopeless, part->knob->name) && !mark_of_finer(finding, part);
}

/* With what the slowest law leaves beyond the levels. */
static double told_of(const struct accuracy_option *option, const struct accuracy_part *part) {
  return (part->error > 0 ? part->error : 0) + (option->open && part->beyond > 0 ? part->beyond : 0);
}

/* Appends the levels of a knob of the study, "0.02m,0.01m". finest > 0: also those that it had no time for, the finest
 * level that any study has, and one beyond it, if they are finer. */
static void append_levels(const struct accuracy_finding *finding, const struct knob *knob, double finest, char *text,
                          size_t size) {
  size_t count;
  double last = 0;
  bool late = false; /* is the last level finer than all runs? */
  const char *before = "", *unit = unit_of(finding->campaign, knob);
  const struct convergence_row *rows = accuracy_rows(finding, finding->point, &count);
  for (size_t r = 0; r < count; r++) {
    const bool ran = rows[r].n > 0, wanted = isnan(rows[r].cpu) && (isnan(rows[r].resolution) || rows[r].open);
    if (strcmp(rows[r].knob, knob->name) != 0 || !(ran || (finest > 0 && wanted)))
      continue;
    text_append(text, size, "%s%s%s", before, rows[r].setting, unit);
    before = ",";
    late = !ran && !rows[r].base;
    last = strtod(rows[r].setting, NULL);
  }
  for (int i = 0; i < 2 && finest > 0 && !late; i++, finest *= finer_by(knob)) {
    const double beyond = last > 0 ? log(finest / last) / log(finer_by(knob)) : 1;
    if (i == 1 || beyond > 0.03) /* not the same but for its digits */
      text_append(text, size, finest < 1000 ? "%s%.4g%s" : "%s%.0f%s", before, finest, unit);
    before = ",";
  }
}

/* The command that studies finer levels, too. */
static void append_study(const struct accuracy_finding *finding, const struct accuracy_part *part, char *next,
                         size_t size) {
  const struct condition *mark = mark_of_finer(finding, part);
  if (mark)
    text_append(next, size,
                ", but their runs would be in doubt (%s) and not count: %s, with --set here and in later commands",
                mark->word, mark->remedy ? mark->remedy : mark->doubt);
  text_append(next, size, ": `clast converge %s --knob %s=", finding->accuracy->path, part->knob->name);
  append_levels(finding, part->knob, finest_of(finding->campaign, part), next, size);
  if (part->seeds > FIRST_SEEDS) /* not fewer than the study has */
    text_append(next, size, " --seeds %lld", (long long)part->seeds);
  text_append(next, size, "`");
}

/* More seeds at the levels of the study: they narrow the interval of each knob's distance to the limit, and leave its
 * middle. 0: they do not reach the accuracy. */
static double seeds_for(const struct accuracy_option *best, double middle) {
  const double room = best->within - middle;
  double seeds = 0;
  for (size_t k = 0; k < best->part_count; k++)
    seeds = fmax(seeds, (double)best->part[k].seeds);
  const double factor = best->error > 0 ? fmax((accuracy_resolution(best) - middle) / room, M_SQRT2) : 2;
  seeds = ceil(seeds * factor * factor);
  return room > 0 && seeds <= MOST_SEEDS ? seeds : 0;
}

static void advise_seeds(const struct accuracy_finding *finding, const struct accuracy_option *best, double middle,
                         double seeds, char *next, size_t size) {
  if (best->error > 0)
    text_append(next, size,
                "More seeds narrow the interval of this error. If they leave %.2g of it, about %.0f at the levels of "
                "this study are needed",
                middle, seeds);
  else
    text_append(next, size, "More seeds may show a difference");
  text_append(next, size, ": `clast converge %s", finding->accuracy->path);
  for (size_t k = 0; k < best->part_count; k++) {
    char levels[512] = "";
    append_levels(finding, best->part[k].knob, 0, levels, sizeof levels);
    if (best->part[k].knob->group == KNOB_RESOLUTION && *levels)
      text_append(next, size, " --knob %s=%s", best->part[k].knob->name, levels);
  }
  text_append(next, size, " --max-seeds %.0f --within off --seeds %.0f`", seeds, seeds);
}

void accuracy_advise(const struct accuracy_finding *finding) {
  struct accuracy *accuracy = finding->accuracy;
  const struct accuracy_option *best = &accuracy->options[accuracy->reference];
  const struct accuracy_part *widest = NULL;
  char *next = accuracy->advice, text[CAMPAIGN_UNIT];
  const size_t size = sizeof accuracy->advice;
  const char *unit = campaign_unit(finding->campaign, finding->campaign->accuracy_quantity, text);
  bool open = false;
  double middle = 0; /* what more seeds leave */
  for (size_t k = 0; k < best->part_count; k++) {
    const struct accuracy_part *part = &best->part[k];
    middle += part->left_by_seeds > 0 ? part->left_by_seeds : 0;
    open |= part->open;
    if (told_of(best, part) > 0 && part->knob->group == KNOB_RESOLUTION && !part->knob->choices[0] &&
        !is_hopeless(finding, part) && (!widest || told_of(best, part) > told_of(best, widest)))
      widest = part;
  }
  const double seeds = open ? 0 : seeds_for(best, middle);
  if (seeds == 0 && !open && best->error > 0)
    text_append(next, size, "More seeds leave about %.2g%s of it. ", fmin(middle, accuracy_resolution(best)), unit);
  if (seeds > 0)
    advise_seeds(finding, best, middle, seeds, next, size);
  else if (!widest)
    text_append(next, size, "No setting that was studied is enough");
  else {
    text_append(next, size, "Finer levels of %s, which leaves most of it (%.2g%s), may narrow it", widest->knob->name,
                fmin(told_of(best, widest), accuracy_resolution(best)), unit);
    append_study(finding, widest, next, size);
  }
}
