/* Conditions under which results are valid. */
#include "engine/condition.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Length of the next word of a list, which commas and spaces part; 0: there is none. *at moves to its begin. */
static size_t next_word(const char **at) {
  *at += strspn(*at, ", ");
  return strcspn(*at, ", ");
}

/* Is a name one of a list? A path and its column in the store are the same name, also behind "result_ENGINE_". */
static bool is_in(const char *list, const char *name, size_t length) {
  for (size_t n; (n = next_word(&list)) > 0; list += n) {
    size_t same = 0;
    const bool behind = n < length && strncmp(name, "result_", strlen("result_")) == 0;
    const char *tail = behind ? name + length - n : name;
    while (same < n && (tail[same] == list[same] || (tail[same] == '_' && list[same] == '.')))
      same++;
    if (same == n && (behind ? tail[-1] == '_' : n == length))
      return true;
  }
  return false;
}

bool condition_has(const char *words, const char *word) {
  return is_in(words, word, strlen(word));
}

/* Columns of a run that tell how it was computed: they are right whatever the conditions say. */
static const char
    facts[] = "wall_time cpu_time peak_memory steps time time_step total_mass target_mass projectile_mass particles "
              "energy_input limited.courant limited.force limited.energy limited.density "
              "limited.distention limited.damage "
              "energy_error momentum_error angular_momentum_error";

/* Is one of the names one of the results? NULL: all but the facts. */
static bool rests_on(const char *names, const char *results) {
  for (size_t n; (n = next_word(&names)) > 0; names += n)
    if (results ? is_in(results, names, n) : !is_in(facts, names, n))
      return true;
  return false;
}

bool condition_given(const struct field_table *inputs, const char *path, double value) {
  const double usual = field_find(inputs, path, NULL)->number;
  return value < usual || value > usual;
}

bool condition_broken(const struct condition *c, double number) {
  const double rounding = 1e-12; /* dust of just two particles is 1.999999999999999 of them */
  return c->least ? number < c->bound * (1 - rounding) : number > c->bound * (1 + rounding);
}

condition_set condition_before(const struct condition *list, const void *inputs, FILE *out) {
  condition_set set = 0;
  for (size_t k = 0; list && list[k].word; k++) {
    const struct condition *c = &list[k];
    const double number = c->before ? c->before(inputs) : (double)NAN;
    if (!condition_broken(c, number))
      continue;
    set |= (condition_set)1 << k;
    if (!out)
      continue;
    fprintf(out, "%s: %s", c->word, c->fact ? c->fact : c->number);
    if (!c->fact) {
      char text[32]; /* with the digits that tell it from the bound */
      for (int digits = 3; digits < 18; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) != c->bound)
          break;
      }
      fprintf(out, " is %s, %s %g", text, c->least ? "below" : "above", c->bound);
    }
    if (c->both) {
      double both[2];
      c->both(inputs, both);
      fprintf(out, ": %.3g and %.3g %s", both[0], both[1], c->unit);
    }
    if (c->beside)
      c->beside(inputs, out);
    fprintf(out, "%s%s (clast explain %s)\n", c->if_so ? "; this counts if " : "", c->if_so ? c->if_so : "", c->word);
  }
  return set;
}

/* Of a run that goes on, numbers such as that of `cut` are not known yet. */
static double number_of(const struct condition *c, const struct condition_run *run) {
  if (c->after && (!run->going || c->lasting))
    return c->after(run);
  return c->before ? c->before(run->inputs) : (double)NAN;
}

void condition_after(const struct condition *list, const struct condition_run *run, char *words, size_t size) {
  const char *last = "";
  words[0] = 0;
  for (const struct condition *c = list; c && c->word; c++) {
    if (!condition_broken(c, number_of(c, run)) || (c->results && !*c->results) || strcmp(last, c->word) == 0)
      continue;
    text_append(words, size, "%s%s", *words ? ", " : "", c->word);
    last = c->word;
  }
}

const struct condition *condition_find(const struct condition *list, const char *word) {
  for (const struct condition *c = list; c && c->word; c++)
    if (strcmp(c->word, word) == 0)
      return c;
  return NULL;
}

enum condition_mark condition_next(const struct condition *list, const char **words, const char *names,
                                   char word[CONDITION_WORD], const struct condition **row) {
  enum condition_mark mark = CONDITION_SOUND;
  const size_t length = next_word(words);
  snprintf(word, CONDITION_WORD, "%.*s", (int)length, *words);
  *words += length;
  *row = NULL;
  if (!condition_find(list, word))
    return rests_on(names, NULL) ? CONDITION_MARKED : CONDITION_SOUND;
  for (const struct condition *c = list; c->word; c++) {
    const enum condition_mark here = c->withheld ? CONDITION_WITHHELD : CONDITION_MARKED;
    if (strcmp(c->word, word) != 0 || !rests_on(names, c->results) || here <= mark)
      continue;
    mark = here;
    *row = c;
  }
  return mark;
}

bool condition_doubted(const struct condition *list, const char *words) {
  char word[CONDITION_WORD];
  for (size_t length; (length = next_word(&words)) > 0; words += length) {
    snprintf(word, sizeof word, "%.*s", (int)length, words);
    const struct condition *row = condition_find(list, word);
    if (!row || !row->absent)
      return true;
  }
  return false;
}

enum condition_mark condition_mark(const struct condition *list, const char *words, const char *names) {
  enum condition_mark worst = CONDITION_SOUND;
  const struct condition *row;
  char word[CONDITION_WORD];
  while (next_word(&words) > 0) {
    const enum condition_mark mark = condition_next(list, &words, names, word, &row);
    worst = mark > worst ? mark : worst;
  }
  return worst;
}

char *condition_says(const struct condition *c, char text[CONDITION_SAYS]) {
  if (c->fact)
    snprintf(text, CONDITION_SAYS, "%s", c->fact);
  else
    snprintf(text, CONDITION_SAYS, "%s is %s %g", c->number, c->least ? "below" : "above", c->bound);
  return text;
}

void condition_sentence(const struct condition *c, FILE *out) {
  char says[CONDITION_SAYS];
  size_t rows = 1;
  while (c[rows].word && strcmp(c[rows].word, c->word) == 0)
    rows++;
  if (rows > 2)
    fprintf(out, "one of %zu reasons", rows);
  else
    fputs(condition_says(c, says), out);
  if (rows == 2)
    fprintf(out, ", or %s", condition_says(&c[1], says));
  fprintf(out, " (clast explain %s)\n", c->word);
}

void condition_tell(const struct condition *list, const char *words, condition_set told, const char *before,
                    FILE *out) {
  bool said[CONDITION_MOST] = {false};
  for (size_t k = 0; list && list[k].word; k++)
    said[k] = told >> k & 1;
  for (size_t k = 0; list && list[k].word; k++) {
    const struct condition *c = &list[k];
    bool known = false;
    for (size_t j = 0; list[j].word; j++)
      known = known || (said[j] && strcmp(list[j].word, c->word) == 0);
    if (known || c->absent || !condition_has(words, c->word))
      continue;
    fprintf(out, "%s%s: ", before, c->word);
    condition_sentence(c, out);
    said[k] = true;
  }
}
