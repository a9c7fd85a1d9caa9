/* Completion of commands and options for zsh and fish, from the option tables. The one for bash is in option.h. */
#ifndef CLAST_CAMPAIGN_TERMINAL_SHELLS_H
#define CLAST_CAMPAIGN_TERMINAL_SHELLS_H

#include "campaign/terminal/option.h"

/* Their output must follow the list of inputs: the array `inputs` in zsh, $__clast_inputs in fish. */
void shells_zsh(size_t count, const struct command *const *commands, FILE *out);
void shells_fish(size_t count, const struct command *const *commands, FILE *out);

#endif
