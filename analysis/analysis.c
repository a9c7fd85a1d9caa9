/* Switches off the error handler of GSL. */
#include "analysis/analysis.h"

#include <gsl/gsl_errno.h>

void analysis_init(void) {
  gsl_set_error_handler_off();
}
