#ifndef CLAST_CAMPAIGN_COMMANDS_HELP_H
#define CLAST_CAMPAIGN_COMMANDS_HELP_H

#include <stdio.h>

void help_overview(FILE *out); /* what `clast help` prints */

#endif
