/* Meanings of statuses; functions that fill errors. */
#include "schemas/status.h"

#include <stdarg.h>
#include <stdio.h>

status status_fail(struct error *error, status code, const char *format, ...) {
  if (error) {
    error->status = code;
    error->cause = ERROR_PLAIN;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
  }
  return code;
}

const char *status_meaning(status code) {
  switch (code) {
#define STATUS_MEANING(constant, value, meaning)                                                                       \
  case constant: return meaning;
    STATUS_LIST(STATUS_MEANING)
#undef STATUS_MEANING
  }
  return "unknown status";
}
