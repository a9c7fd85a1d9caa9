/* Call once per process, before anything else of analysis/: the libraries' own error handlers print and abort, where
 * this program returns a status. */
#ifndef CLAST_ANALYSIS_ANALYSIS_H
#define CLAST_ANALYSIS_ANALYSIS_H

/* Switches off the error handlers of GSL and plfit. main() and the tests call it; calling it again does no harm. */
void analysis_init(void);

#endif
