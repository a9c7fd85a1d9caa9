/* Texts about the program as a whole: the overview of `clast help`, and the manual page. */
#ifndef CLAST_CAMPAIGN_COMMANDS_HELP_H
#define CLAST_CAMPAIGN_COMMANDS_HELP_H

#include <stdio.h>

/* Texts that the overview and the manual page share: purpose, first command lines, use of stdout and stderr. */
extern const char help_purpose[], help_first_steps[], help_streams[];

void help_overview(FILE *out); /* what `clast help` prints */

/* The manual page clast(1) in man(7) macros, for groff and mandoc: what `clast help --man` prints and the build keeps.
 */
void manual_write(FILE *out);

#endif
