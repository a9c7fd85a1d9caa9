/* The loop of a run, the look at its energy, and its end. */
#include "engine/frame.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

void frame_end(struct frame_state *state, int stop, int outcome_state, const char *format, ...) {
  const bool fault = outcome_state > OUTCOME_END_TIME, was_fault = state->outcome_state > OUTCOME_END_TIME;
  if (state->finished && (!fault || was_fault))
    return;
  state->finished = 1;
  state->stop = stop;
  state->outcome_state = outcome_state;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(state->message, sizeof state->message, format, arguments);
  va_end(arguments);
}

void frame_end_not_finite(struct frame *f, const char *quantity) {
  double speed;
  const size_t member = f->kind->fastest(f, &speed);
  frame_end(f->state, f->kind->fault, OUTCOME_NOT_FINITE,
            "%s is no longer finite at %.6g s; %s %zu is the fastest, at %.3g m/s: %s", quantity, *f->time,
            f->kind->member, member, speed, f->kind->remedy(f, NAN));
}

static void look_at_energy(struct frame *f) {
  const struct frame_energy now = f->kind->energy(f);
  const double drift = fabs(now.closed - f->state->closed_start);
  if (!isfinite(now.closed)) {
    frame_end_not_finite(f, "the energy");
    return;
  }
  if (field_is_off(now.bound) || !(now.input > 0) || drift <= now.bound * now.input)
    return;
  double speed;
  const size_t member = f->kind->fastest(f, &speed);
  frame_end(
      f->state, f->kind->fault, OUTCOME_ENERGY,
      "at %.6g s the sum of all energies has drifted by %.3g of the energy put in, above fidelity.energy_bound %.3g; "
      "%s %zu is the fastest, at %.3g m/s: %s",
      *f->time, drift / now.input, now.bound, f->kind->member, member, speed, f->kind->remedy(f, drift));
}

void frame_look(struct frame *f) {
  look_at_energy(f);
  if (f->kind->look)
    f->kind->look(f);
}

status frame_advance(struct frame *f, uint64_t max_steps) {
  for (uint64_t k = 0; k < max_steps && !f->state->finished; k++) {
    if (!f->kind->step(f))
      return f->state->finished ? STATUS_OK : STATUS_MEMORY;
    f->kind->stop(f);
    if (*f->steps % f->kind->looks == 0 || f->state->finished)
      frame_look(f);
  }
  return STATUS_OK;
}

status frame_step(void *run, uint64_t max_steps, bool *finished, struct error *error) {
  struct frame *f = run;
  const status code = frame_advance(f, max_steps);
  *finished = f->state->finished;
  return code ? status_fail(error, code, "%s", f->failure) : STATUS_OK;
}

double frame_time(const void *run) {
  return *((const struct frame *)run)->time;
}

double frame_progress(const void *run) {
  const struct frame *f = run;
  return f->state->finished ? 1 : fmin(frame_time(run) / f->end_time, 1);
}

struct outcome frame_outcome(const struct frame *f, double time_step) {
  const struct frame_state *state = f->state;
  struct outcome outcome = {.state = state->finished ? state->outcome_state : OUTCOME_END_TIME,
                            .steps = (int64_t)*f->steps,
                            .time = *f->time,
                            .time_step = time_step};
  snprintf(outcome.message, sizeof outcome.message, "%s",
           state->finished ? state->message : "not finished: results of a snapshot");
  return outcome;
}
