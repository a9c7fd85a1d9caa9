#ifndef CLAST_CAMPAIGN_TERMINAL_MANUAL_H
#define CLAST_CAMPAIGN_TERMINAL_MANUAL_H

#include <stdio.h>

/* The manual page clast(1) in man(7) macros, for groff and mandoc: what `clast help --man` prints and the build keeps.
 */
void manual_write(FILE *out);

#endif
