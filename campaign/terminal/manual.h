/* The manual page clast(1) in man(7) macros, for groff and mandoc: what `clast help --man` prints and the build keeps.
 */
#ifndef CLAST_CAMPAIGN_TERMINAL_MANUAL_H
#define CLAST_CAMPAIGN_TERMINAL_MANUAL_H

#include "campaign/terminal/option.h"

/* Texts that the page shares with the overview of `clast help`: purpose, first command lines, use of stdout and stderr.
 */
struct manual_texts {
  const char *purpose, *first_steps, *streams;
};

void manual_write(const struct manual_texts *texts, size_t count, const struct command *const *commands, FILE *out);

#endif
