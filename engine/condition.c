/* Conditions under which results are valid. */
#include "engine/condition.h"

#include <math.h>
#include <string.h>

#include "schemas/text.h"

/* Is `word` one of the words of a text, which commas and spaces part? */
static bool has_word(const char *text, const char *word) {
  const size_t length = strlen(word);
  for (const char *at = text; *at; at += strcspn(at, ", ")) {
    at += strspn(at, ", ");
    if (strcspn(at, ", ") == length && strncmp(at, word, length) == 0)
      return true;
  }
  return false;
}

bool condition_broken(const struct condition *c, double number) {
  return c->least ? number < c->bound : number > c->bound;
}

uint64_t condition_before(const struct condition *list, const void *inputs, FILE *out) {
  uint64_t set = 0;
  for (size_t k = 0; list && list[k].word; k++) {
    const struct condition *c = &list[k];
    const double number = c->before ? c->before(inputs) : (double)NAN;
    if (!condition_broken(c, number))
      continue;
    set |= UINT64_C(1) << k;
    if (out)
      fprintf(out, "%s: %s is %.3g, %s %g: %s; %s\n", c->word, c->number, number, c->least ? "below" : "above",
              c->bound, c->doubt, c->remedy);
  }
  return set;
}

void condition_after(const struct condition *list, const struct condition_run *run, char *words, size_t size) {
  const char *last = "";
  words[0] = 0;
  for (const struct condition *c = list; c && c->word; c++) {
    const double number = c->after ? c->after(run) : c->before(run->inputs);
    if (!condition_broken(c, number) || (c->results && !*c->results) || strcmp(last, c->word) == 0)
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

enum condition_mark condition_mark(const struct condition *list, const char *words, const char *path) {
  enum condition_mark mark = CONDITION_SOUND;
  for (const struct condition *c = list; c && c->word; c++) {
    if (!has_word(words, c->word) || (c->results && !has_word(c->results, path)))
      continue;
    mark = CONDITION_MARKED;
    if (c->withheld)
      return CONDITION_WITHHELD;
  }
  return mark;
}

void condition_tell(const struct condition *list, const char *words, uint64_t told, const char *before, FILE *out) {
  bool said[64] = {false};
  for (size_t k = 0; list && list[k].word; k++)
    said[k] = told >> k & 1;
  for (size_t k = 0; list && list[k].word; k++) {
    const struct condition *c = &list[k];
    bool known = false;
    for (size_t j = 0; list[j].word; j++)
      known = known || (said[j] && strcmp(list[j].word, c->word) == 0);
    if (known || !has_word(words, c->word))
      continue;
    fprintf(out, "%s%s: %s is %s %g: %s; %s\n", before, c->word, c->number, c->least ? "below" : "above", c->bound,
            c->doubt, c->remedy);
    said[k] = true;
  }
}
