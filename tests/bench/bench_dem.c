/* Speed of the discrete elements on one core, in double: `name value unit` per line. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "engine/dem/system_layout.h"
#include "tests/bench/dem_disc.h"

static _Noreturn void fail(const char *what, const struct error *error) {
  fprintf(stderr, "bench_dem: %s %s\n", what, error ? error->message : "");
  exit(70);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A disc ringing after the charge, unbroken, contact on all pairs, over `duration`. */
static void ringing(const char *name, double scale, double duration) {
  struct dem_tessellation *t = NULL;
  struct dem_system *system = NULL;
  struct error error = {0};
  const struct dem_parameters p = dem_disc_parameters();
  if (!dem_disc_tessellation(0.2 * scale, 0.01069, 1, &t, &error) || dem_system_create(t, &p, &system, &error) != STATUS_OK)
    fail("set-up:", &error);
  dem_disc_charge(system, t, p.density, 5e4 * scale * scale);
  const int steps = (int)(duration / p.time_step);
  double spent = 0.0, share = 0.0;
  int samples = 0;
  struct dem_ledger l = dem_system_ledger(system);
  const double before = l.kinetic + l.beam + l.contact;
  for (int k = 0; k < steps; k += 100, ++samples) {
    const double start = now();
    for (int i = 0; i < 100; ++i)
      if (!dem_system_step(system)) fail("a position is no longer finite", NULL);
    spent += now() - start;
    share += dem_system_overlap_share(system);
  }
  l = dem_system_ledger(system);
  printf("dem_grain_steps_per_s_%s %.4g grain-steps/s\n", name, (double)t->cell_count * steps / spent);
  printf("dem_overlap_share_%s %.3f 1\n", name, share / samples);
  printf("dem_energy_error_%s %.3g 1\n", name, (l.kinetic + l.beam + l.contact) / before - 1.0);
  printf("dem_rebuilds_%s %.0f 1\n", name, (double)system->now.rebuilds);
  printf("dem_bytes_per_grain_%s %.0f B\n", name, (double)dem_system_bytes(system) / (double)t->cell_count);
  dem_system_free(system);
  dem_tessellation_free(t);
}

static void explosion(void) {
  struct dem_tessellation *t = NULL;
  struct dem_system *system = NULL;
  struct error error = {0};
  struct dem_parameters p = dem_disc_parameters();
  p.breaking = true;
  if (!dem_disc_tessellation(0.2, 0.01069, 1, &t, &error) || dem_system_create(t, &p, &system, &error) != STATUS_OK)
    fail("set-up:", &error);
  dem_disc_charge(system, t, p.density, 5e4);
  const double start = now();
  while (dem_system_time(system) < 20e-3 && dem_system_time(system) - dem_system_last_break(system) < 0.3e-3)
    if (!dem_system_step(system)) fail("a position is no longer finite", NULL);
  const double spent = now() - start;
  const struct dem_break *log;
  printf("dem_grain_steps_per_s_explosion %.4g grain-steps/s\n",
         (double)t->cell_count * (double)dem_system_steps(system) / spent);
  printf("dem_explosion_steps %.0f 1\n", (double)dem_system_steps(system));
  printf("dem_rebuilds_explosion %.0f 1\n", (double)system->now.rebuilds);
  printf("dem_explosion_broken %.3f 1\n", (double)dem_system_breaks(system, &log) / (double)t->pair_count);
  dem_system_free(system);
  dem_tessellation_free(t);
}

int main(int argc, char **argv) {
  const char *only = argc > 1 ? argv[1] : "";
  if (!*only || !strcmp(only, "1100"))
    ringing("1100", 1.0, 2e-3);
  if (!*only || !strcmp(only, "10000"))
    ringing("10000", 3.015, 2e-3);
  if (!*only || !strcmp(only, "explosion"))
    explosion();
  return 0;
}
