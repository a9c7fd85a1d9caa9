/* From the final state to the outcome, the results and the fragments. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/dem/run/run.h"
#include "schemas/memory.h"

/* Data of the search for fragments. */
struct search {
  struct fragment_member *member;
  uint32_t *number;        /* by grain: its number among the present ones, or UINT32_MAX */
  uint32_t *grain, *found; /* by number: the grain; its fragment */
  uint32_t (*link)[2];
  size_t present, links;
};

static void add_grains(const struct dem_run *run, struct search *w) {
  for (uint32_t i = 0; i < run->tessellation->cell_count; i++) {
    const struct dem_grain g = dem_system_grain(run->system, i);
    w->number[i] = UINT32_MAX;
    if (!g.present)
      continue;
    w->number[i] = (uint32_t)w->present;
    w->grain[w->present] = i;
    w->member[w->present++] = (struct fragment_member){.mass = g.mass,
                                                       .position = {g.x, g.y, 0},
                                                       .velocity = {g.vx, g.vy, 0},
                                                       .spin = g.spin,
                                                       .moment_of_inertia = g.moment_of_inertia};
  }
}

/* Adds the link of a pair whose grains are both present. */
static void add_link(const struct dem_run *run, size_t pair, struct search *w) {
  const uint32_t a = w->number[run->tessellation->pair[pair][0]], b = w->number[run->tessellation->pair[pair][1]];
  if (a == UINT32_MAX || b == UINT32_MAX)
    return;
  w->link[w->links][0] = a;
  w->link[w->links++][1] = b;
}

/* The beams that held at the time `when`: the present ones, and those that broke since. */
static void add_links(const struct dem_run *run, double when, struct search *w) {
  const struct dem_break *log;
  for (size_t p = 0; p < run->tessellation->pair_count; p++)
    if (dem_system_beam_alive(run->system, p))
      add_link(run, p, w);
  for (size_t k = dem_system_breaks(run->system, &log); k > 0 && log[k - 1].time > when; k--)
    add_link(run, log[k - 1].beam, w);
}

/* Finds the fragments at the time `when`: the present grains, joined by the beams that held then. Their motion is the
 * present one. label[grain] (may be NULL) becomes the fragment's number, UINT32_MAX for the explosive. */
static status fragments_of(const struct dem_run *run, double when, uint32_t *label, struct fragment **fragments,
                           size_t *count, struct error *error) {
  const size_t n = run->tessellation->cell_count;
  struct search w = {0};
  OWNED struct fragment_member *member = w.member = malloc(n * sizeof *member);
  OWNED uint32_t *number = w.number = malloc(n * sizeof *number);
  OWNED uint32_t *grain = w.grain = malloc(n * sizeof *grain);
  OWNED uint32_t *found = w.found = malloc(n * sizeof *found);
  OWNED uint32_t(*link)[2] = w.link = malloc((run->tessellation->pair_count + 1) * sizeof *link);
  *fragments = NULL;
  *count = 0;
  if (!member || !number || !grain || !found || !link)
    return status_fail(error, STATUS_MEMORY, "no memory to find the fragments of %zu grains", n);
  add_grains(run, &w);
  add_links(run, when, &w);
  TRY(fragments_find(false, w.present, member, w.links, (const uint32_t(*)[2])link, found, fragments, count, error));
  for (size_t k = 0; k < *count; k++)
    (*fragments)[k].first = grain[(*fragments)[k].first];
  for (size_t i = 0; label && i < n; i++)
    label[i] = number[i] == UINT32_MAX ? UINT32_MAX : found[number[i]];
  return STATUS_OK;
}

status dem_report_fragments(const struct dem_run *run, uint32_t *label, struct fragment **fragments, size_t *count,
                            struct error *error) {
  return fragments_of(run, HUGE_VAL, label, fragments, count, error);
}

/* Measures whether fracture had ended: breaks and loss of mass in the second half of the simulated time. */
static status fill_finality(const struct dem_run *run, const struct outcome *outcome, struct dem_results *results,
                            struct error *error) {
  const double half = 0.5 * dem_system_now(run->system)->time;
  const struct dem_break *log;
  size_t breaks = dem_system_breaks(run->system, &log), count;
  for (size_t k = breaks; k > 0 && log[k - 1].time > half; k--)
    results->late_breaks++;
  OWNED struct fragment *then = NULL;
  TRY(fragments_of(run, half, NULL, &then, &count, error));
  if (count > 0)
    results->largest_loss = fmax(0, then[0].mass / outcome->total_mass - outcome->largest_fraction);
  return STATUS_OK;
}

/* Sums over fragments. */
struct fragment_sums {
  double mass, grains; /* kg/m */
  double translation;  /* J/m */
  double vibration;    /* J/m: their kinetic energy less that of translation and rotation */
};

static struct fragment_sums sum_fragments(size_t count, const struct fragment *fragments) {
  struct fragment_sums sums = {0};
  for (size_t k = 0; k < count; k++) {
    const struct fragment *f = &fragments[k];
    const double *v = f->velocity;
    sums.mass += f->mass;
    sums.grains += f->count;
    sums.translation += 0.5 * f->mass * (v[0] * v[0] + v[1] * v[1]);
    sums.vibration += f->kinetic_energy - 0.5 * f->mass * (v[0] * v[0] + v[1] * v[1]) -
                      0.5 * f->moment_of_inertia * f->spin[2] * f->spin[2];
  }
  sums.vibration = fmax(0, sums.vibration); /* single grains alone give rounding errors only */
  return sums;
}

static void fill_breaks(const struct dem_run *run, struct dem_results *results) {
  const struct dem_break *log;
  const size_t breaks = dem_system_breaks(run->system, &log);
  results->broken = (int64_t)breaks;
  for (size_t k = 0; k < breaks; k++)
    results->broken_bend += log[k].bending;
  results->broken_stretch = results->broken - results->broken_bend;
  if (results->beams > 0)
    results->broken_share = (double)results->broken / (double)results->beams;
  if (breaks > 0) {
    results->first_break = log[0].time;
    results->last_break = log[breaks - 1].time;
  }
}

static void fill_results(struct dem_run *run, const struct dem_ledger *ledger, double energy_input,
                         struct dem_results *results) {
  const struct dem_tessellation *t = run->tessellation;
  field_defaults(&dem_results, results); /* every quantity is off or zero */
  results->stop_reason = run->state.frame.stop;
  results->energy_input = energy_input;
  results->stable_time_step = run->stable_time_step;
  results->overlap_share = dem_system_overlap_share(run->system);
  if (run->passing_speed > 0)
    results->passing_share = dem_system_now(run->system)->fastest_approach / run->passing_speed;
  results->largest_loss = 0;
  results->energy.kinetic = ledger->kinetic;
  results->energy.beam = ledger->beam;
  results->energy.contact = ledger->contact;
  results->energy.damping = ledger->damping;
  results->energy.friction = ledger->friction;
  results->energy.broken_beam = ledger->broken_beam;
  results->energy.external_work = ledger->external_work;
  dem_describe_sound_speeds(&run->inputs, &results->sound_speed_extension, &results->sound_speed_compression);
  results->threshold_energy = run->threshold_energy;
  results->grains = (int64_t)t->cell_count - (run->charge != UINT32_MAX);
  for (size_t p = 0; p < t->pair_count; p++)
    results->beams += t->pair[p][0] != run->charge && t->pair[p][1] != run->charge;
  fill_breaks(run, results);
  if (dem_inputs_loaded(&run->inputs))
    dem_loading_results(run, results);
}

/* The words of broken conditions. When grains met too fast, a message says so, unless a fault has its own message. */
static void judge(const struct dem_run *run, const struct dem_results *results, struct outcome *outcome) {
  const double fastest = dem_system_now(run->system)->fastest_approach;
  const struct condition_run end = {run, &run->inputs, outcome, results, !run->state.frame.finished};
  condition_after(dem_conditions, &end, outcome->warnings, sizeof outcome->warnings);
  if (run->passing_speed > 0 && fastest > run->passing_speed && outcome_is_usable(outcome->state))
    snprintf(outcome->message, sizeof outcome->message,
             "grains closed in at %.4g m/s: above %.4g m/s they pass through each other, and the model has no answer",
             fastest, run->passing_speed);
}

static double not_infinite(double value) {
  return isfinite(value) ? value : (double)NAN;
}

/* Errors of energy and momentum, and the share of the energy that is translation; NaN where nothing was put in. */
static void fill_balance(const struct dem_run *run, const struct dem_ledger *ledger, double input, double translation,
                         struct outcome *outcome, struct dem_results *results) {
  const struct dem_state *s = &run->state;
  double momentum[2], magnitude;
  dem_run_momentum(run, momentum, &magnitude);
  /* forces inside the body cancel: the impulse on held grains is the momentum that the free ones lose */
  const double px = momentum[0] - s->momentum_start[0] + s->impulse[0];
  const double py = momentum[1] - s->momentum_start[1] + s->impulse[1];
  outcome->energy_error = outcome->kinetic_energy_share = outcome->momentum_error = NAN;
  if (input > 0) {
    outcome->energy_error = not_infinite(fabs(dem_run_closed(ledger) - s->frame.closed_start) / input);
    outcome->kinetic_energy_share = not_infinite(translation / input);
  }
  if (!dem_inputs_loaded(&run->inputs) && magnitude > 0) {
    const struct dem_inputs *in = &run->inputs;
    const double longest = fmax(in->body.diameter,
                                in->grain.spacing * fmax((double)in->body.columns, (double)in->body.rows));
    results->angular_momentum_error = not_infinite(fabs(dem_run_angular_momentum(run) - run->angular_start) /
                                                   fmax(fabs(run->angular_start), magnitude * longest / 2));
  }
  if (magnitude > 0)
    outcome->momentum_error = not_infinite(hypot(px, py) / magnitude);
}

status dem_report_finish(void *of, struct outcome *outcome, void *report, struct fragment **fragments, size_t *count,
                         struct error *error) {
  struct dem_run *run = of;
  struct dem_results *results = report;
  TRY(dem_report_fragments(run, NULL, fragments, count, error));
  const struct dem_ledger ledger = dem_system_ledger(run->system);
  const double input = run->state.frame.energy_input + fabs(ledger.external_work);
  fill_results(run, &ledger, input, results);

  *outcome = frame_outcome(&run->frame, run->inputs.fidelity.time_step);
  const struct fragment_sums sums = sum_fragments(*count, *fragments);
  /* Single grains are dust; the spectrum is complete from two grains on. */
  const struct outcome_small small = {.dust = NAN, .complete = sums.grains > 0 ? 1.5 * sums.mass / sums.grains : 0};
  outcome_fragments(outcome, *count, *fragments, &small);
  results->energy.vibration = sums.vibration;
  const status code = fill_finality(run, outcome, results, error);
  if (code) {
    free(*fragments);
    *fragments = NULL;
    *count = 0;
    return code;
  }
  fill_balance(run, &ledger, input, sums.translation, outcome, results);
  judge(run, results, outcome);
  return STATUS_OK;
}
