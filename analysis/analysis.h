/* Once per process, before any other call of analysis/: the libraries' error handlers print and abort; ours are
 * statuses. */
#ifndef CLAST_ANALYSIS_ANALYSIS_H
#define CLAST_ANALYSIS_ANALYSIS_H

/* gsl_set_error_handler_off and plfit's alike. main() and the tests call it; calling it again does no harm. */
void analysis_init(void);

#endif
