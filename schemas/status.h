/* Statuses and errors of every call that can fail.
 *
 * The values are the process exit codes (BSD sysexits), so main() returns a status unchanged. Nothing below main()
 * prints or exits; it returns a status and says in `struct error` what happened, where, and what to do. */
#pragma once

#include "schemas/limits.h"

/* X(constant, pinned value, meaning) */
#define STATUS_LIST(X)                                                                                                 \
  X(STATUS_OK, 0, "done")                                                                                              \
  X(STATUS_FAILED_RUNS, 1, "the campaign finished, but some runs failed")                                              \
  X(STATUS_USAGE, 64, "the command line is wrong")                                                                     \
  X(STATUS_CONTENT, 65, "a file's content is wrong")                                                                   \
  X(STATUS_MISSING, 66, "an input file is missing")                                                                    \
  X(STATUS_INTERNAL, 70, "a bug in clast")                                                                             \
  X(STATUS_MEMORY, 71, "the system refused memory, a process or another resource")                                     \
  X(STATUS_IO, 74, "reading or writing failed (read-only, disk full, locked)")                                         \
  X(STATUS_STOPPED, 75, "stopped early; the same command resumes")

typedef enum status {
#define STATUS_ENUM(constant, value, meaning) constant = value,
  STATUS_LIST(STATUS_ENUM)
#undef STATUS_ENUM
} status;

/* Why a run gave no result, where the attempt at it must tell (campaign/farm). */
enum error_cause { ERROR_PLAIN, ERROR_TIME_LIMIT, ERROR_CRASH };

/* Owned by the caller. `message` holds whole sentences for a person: what happened, where, what to do. It may span
 * lines: a report of a document with a few dozen errors fits (schemas/document.h). */
struct error {
  status status;
  enum error_cause cause; /* status_fail() makes it plain */
  char message[LIMITS_MESSAGE];
};

/* Fills *error (may be NULL) and returns `code`, so that a function can end with `return status_fail(error, STATUS_IO,
 * "...", ...)`. */
status status_fail(struct error *error, status code, const char *format, ...) __attribute__((format(printf, 3, 4)));

const char *status_meaning(status code);

/* Returns from the calling function with the status of `call` unless it is STATUS_OK. Only where that function owns
 * nothing, or what it owns releases itself (OWNED in schemas/memory.h). */
#define TRY(call)                                                                                                      \
  do {                                                                                                                 \
    const status try_status = (call);                                                                                  \
    if (try_status)                                                                                                    \
      return try_status;                                                                                               \
  } while (0)
