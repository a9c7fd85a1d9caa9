/* Call once per process, before any other function of analysis/. GSL's own error handler prints and aborts; this
 * program returns a status instead. */
#ifndef CLAST_ANALYSIS_ANALYSIS_H
#define CLAST_ANALYSIS_ANALYSIS_H

/* Switches off the error handler of GSL. main() and the tests call it; calling it again does no harm. */
void analysis_init(void);

#endif
