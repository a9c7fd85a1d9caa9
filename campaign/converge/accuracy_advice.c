/* What to type where no setting of a study reaches an accuracy. `clast converge` tells what its runs take. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/accuracy_finding.h"

enum {
  MOST_SEEDS = 1000, /* a study with more is no advice */
  FIRST_SEEDS = 4    /* of `clast converge` without --seeds */
};

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

/* A finer setting of another knob of resolution, with which a level is not in doubt. */
struct remedy {
  const struct knob *knob; /* NULL: none helps */
  char setting[64];
};

/* The condition that marks the next finer level of the knob. NULL: none does. */
static const struct condition *mark_of_finer(const struct accuracy_finding *finding, const struct accuracy_part *part,
                                             struct remedy *remedy) {
  enum { HALVINGS = 10 };
  const struct campaign *campaign = finding->campaign;
  struct error ignored;
  char finer[64], own[64];
  SCENE level = scene_copy(finding->scene);
  *remedy = (struct remedy){.knob = NULL};
  snprintf(finer, sizeof finer, "%.6g", finest_of(campaign, part) * finer_by(part->knob));
  const struct condition *mark = ladder_turn(part->knob, level, finer, &ignored) == STATUS_OK
                                     ? accuracy_mark(finding->scene, level)
                                     : NULL;
  for (const struct knob *other = campaign->scene->kind->knobs; mark && other->name; other++) {
    if (other == part->knob || other->group != KNOB_RESOLUTION || !(other->step_power > 0) ||
        accuracy_is_varied(campaign, other, ""))
      continue;
    ladder_setting(other, finding->scene, own, sizeof own);
    for (int h = 1; h <= HALVINGS && !remedy->knob; h++) {
      SCENE scene = scene_copy(level);
      snprintf(remedy->setting, sizeof remedy->setting, "%.6g", ldexp(strtod(own, NULL), -h));
      if (ladder_turn(other, scene, remedy->setting, &ignored) == STATUS_OK && !accuracy_mark(finding->scene, scene))
        remedy->knob = other;
    }
  }
  return mark;
}

/* Has the store the next finer level of the knob, studied from settings with the remedy? */
static bool is_studied(const struct accuracy_finding *finding, const struct accuracy_part *part,
                       const struct remedy *remedy) {
  struct error ignored;
  int64_t point = 0;
  bool is = false;
  size_t count;
  const double finer = finer_by(part->knob), wanted = finest_of(finding->campaign, part) * finer;
  SCENE scene = scene_copy(finding->scene);
  if (ladder_turn(remedy->knob, scene, remedy->setting, &ignored) != STATUS_OK ||
      store_point_find(finding->store, scene, &point, &ignored) != STATUS_OK || !point)
    return false;
  const struct convergence_row *rows = accuracy_rows(finding, point, &count);
  for (size_t r = 0; r < count; r++)
    is |= strcmp(rows[r].knob, part->knob->name) == 0 && rows[r].n > 0 &&
          (strtod(rows[r].setting, NULL) - wanted) * (finer - 1) >= -1e-5 * wanted; /* as fine or finer */
  return is;
}

/* Appends the words of a command with --set of the remedy, in the place of one of its input. */
static void append_words(const struct accuracy_finding *finding, const struct remedy *remedy, char *text, size_t size) {
  static const char set[] = " --set ";
  const char *path = remedy->knob ? remedy->knob->inputs[0].path : "";
  const size_t length = strlen(path);
  for (const char *at = finding->accuracy->path; *at;) {
    const char *word = at + strlen(set), *next = strstr(at + 1, set);
    const bool is_set = strncmp(at, set, strlen(set)) == 0, quoted = is_set && *word == '\'';
    if (length && is_set && strncmp(word + quoted, path, length) == 0 && word[quoted + length] == '=')
      at = word + quoted + strcspn(word + quoted, quoted ? "'" : " ") + quoted;
    text_append(text, size, "%.*s", (int)(next ? next - at : (ptrdiff_t)strlen(at)), at);
    at = next ? next : "";
  }
  if (length)
    text_append(text, size, " --set %s='%s%s%s'", path, remedy->setting,
                *unit_of(finding->campaign, remedy->knob) ? " " : "", unit_of(finding->campaign, remedy->knob));
}

/* Appends a level to a list unless it is there already: a level of the study within 2 % takes its place. */
static void append_level(const struct accuracy_finding *finding, const struct knob *knob, double value, char *list,
                         size_t size) {
  char level[80], word[80];
  size_t count;
  double least = 0.02 * value;
  const struct convergence_row *rows = accuracy_rows(finding, finding->point, &count);
  snprintf(level, sizeof level, "%.4g", value);
  for (size_t r = 0; r < count; r++) {
    const double far = fabs(strtod(rows[r].setting, NULL) - value);
    if (strcmp(rows[r].knob, knob->name) != 0 || !(rows[r].n > 0 || rows[r].base) || !(far < least))
      continue;
    least = far;
    snprintf(level, sizeof level, "%.63s", rows[r].setting);
  }
  text_append(level, sizeof level, "%s", unit_of(finding->campaign, knob));
  for (const char *words = list; ladder_next_word(&words, word, sizeof word);)
    if (strcmp(word, level) == 0)
      return;
  text_append(list, size, "%s%s", *list ? "," : "", level);
}

/* The command that studies the knob at its finest level, one on either side, and the scene's own, whose error is
 * wanted. */
static void append_study(const struct accuracy_finding *finding, const struct accuracy_part *part, char *next,
                         size_t size) {
  const struct knob *knob = part->knob;
  struct remedy remedy;
  const struct condition *mark = mark_of_finer(finding, part, &remedy);
  const double finer = finer_by(knob), value = finest_of(finding->campaign, part);
  char own[64], list[512] = "";
  ladder_setting(knob, finding->campaign->scene, own, sizeof own);
  if (mark && !remedy.knob) {
    text_append(next, size, ", but their runs would be in doubt (clast explain %s) and not count", mark->word);
    return;
  }
  if (mark && is_studied(finding, part, &remedy)) {
    text_append(next, size, ". The store has them from other settings on: `clast plan ");
    append_words(finding, &remedy, next, size);
    text_append(next, size, "` goes on there");
    return;
  }
  if (mark)
    text_append(next, size,
                ", with the --set of this command here and in later ones, or in `set` of the campaign: else their runs "
                "are in doubt (clast explain %s) and do not count",
                mark->word);
  const double levels[] = {value / finer, value, value * finer, strtod(own, NULL)};
  for (size_t i = 0; i < 4 && value > 0; i++)
    append_level(finding, knob, levels[i], list, sizeof list);
  text_append(next, size, ": `clast converge ");
  append_words(finding, &remedy, next, size);
  text_append(next, size, " --knob %s%s%s", knob->name, *list ? "=" : "", list);
  if (part->seeds > FIRST_SEEDS) /* not fewer than the study has */
    text_append(next, size, " --seeds %lld", (long long)part->seeds);
  text_append(next, size, "`");
}

/* Have runs told that finer levels of the knob are in doubt, for a reason that is not known before them? */
static bool is_hopeless(const struct accuracy_finding *finding, const struct accuracy_part *part) {
  struct remedy remedy;
  return condition_has(finding->hopeless, part->knob->name) && !(mark_of_finer(finding, part, &remedy) && remedy.knob);
}

/* With what the slowest law leaves beyond the levels. */
static double told_of(const struct accuracy_option *option, const struct accuracy_part *part) {
  return (part->error > 0 ? part->error : 0) + (option->open && part->beyond > 0 ? part->beyond : 0);
}

/* A level that a study of resolution had no time for. */
static bool is_late(const struct convergence_row *row) {
  return row->n == 0 && isnan(row->cpu) && (isnan(row->resolution) || row->open);
}

/* Appends the levels of a knob of the study, "0.02m,0.01m", with those that it had no time for if `late`. */
static void append_levels(const struct accuracy_finding *finding, const struct knob *knob, bool late, char *text,
                          size_t size) {
  size_t count;
  const char *before = "";
  const struct convergence_row *rows = accuracy_rows(finding, finding->point, &count);
  for (size_t r = 0; r < count; r++)
    if (strcmp(rows[r].knob, knob->name) == 0 && (rows[r].n > 0 || (late && is_late(&rows[r])))) {
      text_append(text, size, "%s%s%s", before, rows[r].setting, unit_of(finding->campaign, knob));
      before = ",";
    }
}

/* The study of the knob had no time for levels that are finer than those that ran: it can go on. */
static bool advise_late(const struct accuracy_finding *finding, const struct knob *knob, char *next, size_t size) {
  size_t count;
  char late[200] = "";
  bool ran = false, finer = false;
  const struct convergence_row *rows = accuracy_rows(finding, finding->point, &count);
  for (size_t r = 0; r < count; r++) {
    if (strcmp(rows[r].knob, knob->name) != 0)
      continue;
    ran |= rows[r].n > 0;
    finer |= ran && is_late(&rows[r]) && !rows[r].base;
    if (ran && is_late(&rows[r]))
      text_append(late, sizeof late, "%s%s", *late ? ", " : "", rows[r].setting);
  }
  if (!finer)
    return false;
  text_append(next, size, "The study had no time for %s = %s: `clast converge %s --quantity %s --knob %s=", knob->name,
              late, finding->accuracy->path, finding->campaign->accuracy_quantity, knob->name);
  append_levels(finding, knob, true, next, size);
  text_append(next, size, "` goes on with it and takes its time");
  return true;
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
    append_levels(finding, best->part[k].knob, false, levels, sizeof levels);
    if (best->part[k].knob->group == KNOB_RESOLUTION && *levels && best->part[k].error > 0)
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
  if (seeds == 0 && widest && advise_late(finding, widest->knob, next, size))
    return;
  if (seeds > 0) {
    advise_seeds(finding, best, middle, seeds, next, size);
    return;
  }
  if (!open && best->error > 0)
    text_append(next, size, "More seeds leave about %.2g%s of it. ", fmin(middle, accuracy_resolution(best)), unit);
  if (!widest) {
    text_append(next, size, "No setting that was studied is enough");
    return;
  }
  text_append(next, size, "Finer levels of %s, which leaves most of it (%.2g%s), may narrow it", widest->knob->name,
              told_of(best, widest), unit);
  append_study(finding, widest, next, size);
}
