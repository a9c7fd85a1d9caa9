/* The words of warnings. */
#include "engine/warnings.h"

#include "schemas/text.h"

void warnings_words(unsigned set, char *text, size_t size) {
#define WORD(name_, word_, doc_) word_,
  static const char *const words[WARNINGS_COUNT] = {WARNINGS(WORD)};
#undef WORD
  text[0] = 0;
  for (size_t k = 0; k < WARNINGS_COUNT; k++)
    if (set >> k & 1)
      text_append(text, size, "%s%s", *text ? ", " : "", words[k]);
}
