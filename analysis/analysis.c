/* Switches off the error handlers of GSL and plfit. */
#include "analysis/analysis.h"

#include <gsl/gsl_errno.h>
#include <plfit.h>
#include <plfit_error.h>

void analysis_init(void) {
  gsl_set_error_handler_off();
  plfit_set_error_handler(plfit_error_handler_ignore);
}
