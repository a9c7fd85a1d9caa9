/* Signals and the restart file. */
#include "campaign/one_run/resume.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include "engine/restart.h"
#include "schemas/clock.h"

enum { EVERY_S = 300 };

static volatile sig_atomic_t stopped; /* a signal handler can use only a global variable */

static void note(int number) {
  stopped = number;
}

void resume_begin(struct resume *resume, const char *path) {
  const int wanted[] = {SIGINT, SIGTERM, SIGHUP};
  struct sigaction action = {.sa_handler = note, .sa_flags = (int)SA_RESETHAND};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++)
    sigaction(wanted[k], &action, NULL);
  *resume = (struct resume){path, clock_s()};
}

status resume_look(struct resume *resume, const struct engine_kind *kind, void *run, struct error *error) {
  if (!stopped && clock_s() - resume->saved < EVERY_S)
    return STATUS_OK;
  status code = restart_save(kind, run, resume->path, error);
  resume->saved = clock_s();
  if (code || !stopped)
    return code;
  return status_fail(error, STATUS_STOPPED,
                     "stopped at %.4g s of simulated time, saved in %s: the same command goes on from there",
                     kind->time(run), resume->path);
}

void resume_end(const char *path) {
  unlink(path);
}
