/* Call once per process, before any other function of analysis/. The libraries' own error handlers print and abort;
 * this program returns a status instead. */
#ifndef CLAST_ANALYSIS_ANALYSIS_H
#define CLAST_ANALYSIS_ANALYSIS_H

/* Switches off the error handlers of GSL and plfit. main() and the tests call it; calling it again does no harm. */
void analysis_init(void);

#endif
