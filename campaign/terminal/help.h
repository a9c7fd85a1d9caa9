#ifndef CLAST_CAMPAIGN_TERMINAL_HELP_H
#define CLAST_CAMPAIGN_TERMINAL_HELP_H

#include <stdio.h>

/* Words of the overview that the manual page has, too: one sentence, command lines, what goes where. */
extern const char help_purpose[], help_first_steps[], help_streams[];

void help_overview(FILE *out); /* what `clast help` prints */

#endif
