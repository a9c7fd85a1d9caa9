/* Call once per process, before any other function of analysis/. GSL's own error handler prints and aborts; this
 * program returns a status instead. */
#pragma once

/* Switches off the error handler of GSL. main() and the tests call it; calling it again does no harm. */
void analysis_init(void);
