/* Speed of the discrete elements on one core, in double: `name value unit` per line.
 *
 * First: discs of K99's grains that vibrate after the charge (the same energy per mass), unbroken, with contact on all
 * pairs, averaged over 2 ms. Then a whole explosion. The frozen plain C version of the model (reference_dem.c)
 * alternates with the first disc and starts from its state; the ratios refer to this version. An argument selects one
 * part: 1100, 10000 or explosion. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/dem/step/system_layout.h"
#include "tests/bench/dem_disc.h"
#include "tests/bench/reference_dem.h"

static _Noreturn void fail(const char *what, const struct error *error) {
  fprintf(stderr, "bench_dem: %s %s\n", what, error ? error->message : "");
  exit(70);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Runs the reference for a few steps from the state of `system`. Returns the seconds; the energies must agree. */
static double reference_steps(struct reference_dem *reference, struct dem_system *system, int steps) {
  reference_dem_state(reference, system);
  const struct dem_ledger l = dem_system_ledger(system);
  const double ours = l.kinetic + l.beam + l.contact, theirs = reference_dem_energy(reference);
  if (fabs(ours / theirs - 1.0) > 1e-6)
    fail("the reference does not compute the same energy", NULL);
  const double start = now();
  for (int k = 0; k < steps; k++)
    reference_dem_step(reference);
  return now() - start;
}

/* Returns the reference's speed when `with_reference`, else `reference_speed`. */
static double ringing(const char *name, double scale, bool with_reference, double reference_speed) {
  struct dem_tessellation *t = NULL;
  struct dem_system *system = NULL;
  struct error error = {0};
  const struct dem_inputs in = dem_disc_inputs();
  if (!dem_disc_tessellation(0.2 * scale, 0.01069, 1, &t, &error) ||
      dem_system_create(t, &in, 0, &system, &error) != STATUS_OK)
    fail("set-up:", &error);
  dem_disc_charge(system, t, in.grain.density, 5e4 * scale * scale);
  struct reference_dem *reference = with_reference ? reference_dem_create(t, &in) : NULL;
  const int steps = 2000, every = 100, reference_every = 10;
  double spent = 0.0, share = 0.0, reference_spent = 0.0;
  int samples = 0;
  struct dem_ledger l = dem_system_ledger(system);
  const double before = l.kinetic + l.beam + l.contact;
  for (int k = 0; k < steps; k += every, ++samples) {
    const double start = now();
    for (int i = 0; i < every; i++)
      if (!dem_system_step(system))
        fail("a position is no longer finite", NULL);
    spent += now() - start;
    share += dem_system_overlap_share(system);
    if (reference)
      reference_spent += reference_steps(reference, system, reference_every);
  }
  l = dem_system_ledger(system);
  const double cells = (double)t->cell_count, speed = cells * steps / spent;
  if (reference) {
    reference_speed = cells * samples * reference_every / reference_spent;
    printf("dem_reference_grain_steps_per_s %.4g grain-steps/s\n", reference_speed);
    reference_dem_free(reference);
  }
  printf("dem_grain_steps_per_s_%s %.4g grain-steps/s\n", name, speed);
  if (reference_speed > 0.0)
    printf("dem_ratio_to_reference_%s %.3g 1\n", name, speed / reference_speed);
  printf("dem_overlap_share_%s %.3f 1\n", name, share / samples);
  printf("dem_energy_error_%s %.2e 1\n", name, (l.kinetic + l.beam + l.contact) / before - 1.0);
  printf("dem_list_rebuilds_%s %.0f 1\n", name, (double)system->now.rebuilds);
  printf("dem_bytes_per_grain_%s %.0f B\n", name, (double)dem_system_arrays_bytes(system) / cells);
  dem_system_free(system);
  dem_tessellation_free(t);
  return reference_speed;
}

static void explosion(double reference_speed) {
  struct dem_tessellation *t = NULL;
  struct dem_system *system = NULL;
  struct error error = {0};
  struct dem_inputs in = dem_disc_inputs();
  in.threshold.breaking = true;
  if (!dem_disc_tessellation(0.2, 0.01069, 1, &t, &error) || dem_system_create(t, &in, 0, &system, &error) != STATUS_OK)
    fail("set-up:", &error);
  dem_disc_charge(system, t, in.grain.density, 5e4);
  const double start = now();
  while (dem_system_now(system)->time < 20e-3 &&
         dem_system_now(system)->time - dem_system_now(system)->last_break < 0.3e-3)
    if (!dem_system_step(system))
      fail("a position is no longer finite", NULL);
  const double speed = (double)t->cell_count * (double)dem_system_now(system)->steps / (now() - start);
  const struct dem_break *log;
  printf("dem_grain_steps_per_s_explosion %.4g grain-steps/s\n", speed);
  if (reference_speed > 0.0)
    printf("dem_ratio_to_reference_explosion %.3g 1\n", speed / reference_speed);
  printf("dem_steps_explosion %.0f 1\n", (double)dem_system_now(system)->steps);
  printf("dem_broken_share_explosion %.3f 1\n", (double)dem_system_breaks(system, &log) / (double)t->pair_count);
  printf("dem_list_rebuilds_explosion %.0f 1\n", (double)system->now.rebuilds);
  dem_system_free(system);
  dem_tessellation_free(t);
}

int main(int argc, char **argv) {
  const char *only = argc > 1 ? argv[1] : "";
  double reference = 0.0;
  if (!*only || !strcmp(only, "1100"))
    reference = ringing("1100", 1.0, true, 0.0);
  if (!*only || !strcmp(only, "10000"))
    ringing("10000", 3.015, false, reference);
  if (!*only || !strcmp(only, "explosion"))
    explosion(reference);
  return 0;
}
