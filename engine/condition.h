/* A result knows when it is valid: a condition is a row beside the engine that needs it. It compares a dimensionless
 * number with a bound, before the run from the inputs, at the end from the run itself, or both. A run beyond a bound is
 * marked with the condition's word in its result `warnings`; it stays in every mean. What the program says before a
 * run, the marks beside numbers and `clast explain conditions` follow from these rows. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "engine/outcome.h"

/* Error of the energy ledger, divided by the energy put in, above which a run is marked. */
#define CONDITION_LARGEST_DRIFT 0.01

/* A run at its end, as conditions look at it; or at a snapshot. */
struct condition_run {
  const void *run, *inputs;
  const struct outcome *outcome;
  const void *results; /* of the engine */
  bool going;          /* a snapshot: the run has not ended */
};

struct condition {
  const char *word;   /* in the result `warnings`; rows of one word stand together */
  const char *number; /* what is compared with the bound: "fidelity.cfl". Or: */
  const char *fact;   /* a sentence that is true where the number is above 0: "the target has no strength" */
  double bound;       /* doubtful above it */
  bool least;         /* doubtful below it instead */
  const char *doubt;  /* what is wrong beyond the bound; begins in lower case, without a full stop */
  const char *reason; /* where the bound comes from */
  const char *remedy; /* what to do */
  const char
      *results;      /* the results that rest on it: paths, separated by spaces. NULL: all; "": none, it is only told */
  bool withheld;     /* beyond the bound these results have no meaning */
  bool lasting;      /* `after` tells at any time of a run: what it finds does not go away later */
  bool absent;       /* and nothing is wrong: the scene does not ask for them. The run does not count as one in doubt */
  const char *if_so; /* what the end may find: "the body breaks"; told before the run. NULL: the end finds the same */
  bool (*unsure)(const void *inputs); /* of .if_so: bodies that break may escape it, too. NULL: they do not */
  const char *inputs; /* of the word "effect": the inputs that then have none; paths, separated by spaces */
  /* The number; NaN where the condition does not apply. At least one of the two. A condition with both is judged at the
   * end by `after` alone. */
  double (*before)(const void *inputs);
  double (*after)(const struct condition_run *run);
  /* The two numbers whose ratio `before` is, and their unit; told beside it. NULL: none. */
  void (*both)(const void *inputs, double both[2]);
  const char *unit;
  void (*beside)(const void *inputs, FILE *out); /* prints what else is told there, ": ..." or nothing. NULL: none */
};

/* A row of an engine's list. */
#define CONDITION(word_, ...)                                                                                          \
  { .word = word_, __VA_ARGS__ }

/* The two functions of a row that is one expression: of the inputs `in`, before the run; and of `r`, with the engine's
 * `run`, its inputs `in` and its `results`. An engine's file gives them its types: BEFORE(name, expression). */
#define CONDITION_BEFORE(inputs_, name_, ...)                                                                          \
  static double name_(const void *inputs) {                                                                            \
    const inputs_ *in = inputs;                                                                                        \
    return __VA_ARGS__;                                                                                                \
  }
#define CONDITION_AFTER(inputs_, run_, results_, name_, ...)                                                           \
  static double name_(const struct condition_run *r) {                                                                 \
    const inputs_ *in = r->inputs;                                                                                     \
    const run_ *run = r->run;                                                                                          \
    const results_ *results = r->results;                                                                              \
    (void)in, (void)run, (void)results;                                                                                \
    return __VA_ARGS__;                                                                                                \
  }
/* A number where the condition applies; NaN elsewhere. */
#define CONDITION_ONLY(applies, number) ((applies) ? (number) : (double)NAN)

/* Is the value of an input not the default of its row? */
bool condition_given(const struct field_table *inputs, const char *path, double value);

/* Is a number beyond the bound, by more than rounding? Not when it is NaN. */
bool condition_broken(const struct condition *condition, double number);

/* A set of rows of a list. */
typedef unsigned __int128 condition_set;
enum { CONDITION_MOST = 128 };

/* The conditions that the inputs alone break: bit k is the k-th row of `list`, which ends with a word of NULL. Prints a
 * line for each, with number, bound and where to read more, to `out` (NULL: prints nothing). A list of NULL has no
 * rows. */
condition_set condition_before(const struct condition *list, const void *inputs, FILE *out);

/* Judges a run at its end; a run that goes on by its inputs and by conditions with .lasting. Writes the words of broken
 * conditions, separated by ", ", into `words`. */
void condition_after(const struct condition *list, const struct condition_run *run, char *words, size_t size);

/* What the words of a run say of its results `names`: paths or columns of the store, separated by spaces or commas; the
 * worst of them. A word without a row comes from another version, and marks every result. */
enum condition_mark { CONDITION_SOUND, CONDITION_MARKED, CONDITION_WITHHELD };
enum condition_mark condition_mark(const struct condition *list, const char *words, const char *names);

/* Do the words of a run put it in doubt? Not when they only say that results are absent. */
bool condition_doubted(const struct condition *list, const char *words);

/* One word of a text of words. Returns what it says of the results, as condition_mark(), and moves *words on. `word`
 * gets it; *row is the row that it comes from, NULL: none. */
enum { CONDITION_WORD = 32 };
enum condition_mark condition_next(const struct condition *list, const char **words, const char *names,
                                   char word[CONDITION_WORD], const struct condition **row);

/* Prints "word: " and condition_sentence() for each of the words that `told`, a set of condition_before(), has not. */
void condition_tell(const struct condition *list, const char *words, condition_set told, const char *before, FILE *out);

/* Is a word one of some words? */
bool condition_has(const char *words, const char *word);

/* Writes "number is above bound", or the fact. Returns `text`. */
enum { CONDITION_SAYS = 256 };
char *condition_says(const struct condition *condition, char text[CONDITION_SAYS]);

/* Prints that, "or" that of the word's other row, and " (clast explain WORD)": a run has the word alone, not which of
 * the two is broken. */
void condition_sentence(const struct condition *condition, FILE *out);

/* The first row of a word in a list; NULL when there is none. */
const struct condition *condition_find(const struct condition *list, const char *word);
