/* Result bits change only on purpose: a few small runs of each engine under the baseline CPU class have pinned hashes.
 * If such a test fails and the change was intended, raise the engine's .results_version and put its number and the
 * printed hashes into the test. Otherwise the change has a fault. The CPU variants of glibc are masked, so that every
 * x86-64 machine gives the same bits. */
#pragma once

#include <unistd.h>

#include "engine/blake2s.h"
#include "tests/support/run_case.h"

/* Call this first in main. glibc reads its tunables before main, so the program restarts itself with them. False if
 * that failed. */
static bool golden_start(char **arguments) {
  if (getenv("CLAST_GOLDEN"))
    return true;
  setenv("CLAST_GOLDEN", "1", 1);
  setenv("CLAST_CPU", "baseline", 1);
  setenv("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F", 1);
  execv("/proc/self/exe", arguments);
  return false;
}

UNUSED static void golden_version(const struct engine_kind *kind, int pinned) {
  if (kind->results_version != pinned)
    fail_msg("results_version of %s is %d now: pin its hashes here", kind->name, kind->results_version);
}

/* Returns 1 and prints a line if the hash of a run is not the pinned one, else 0. `own`: the engine's own numbers that
 * are part of the hash. Frees the fragments. */
UNUSED static int golden_changed(const struct engine_kind *kind, const char *name, struct ran ran, const double *own,
                                 size_t count, const char *pinned) {
  const size_t size = (3 + count + ran.count * 12) * sizeof(double);
  double *numbers = malloc(size), *at = numbers;
  assert_non_null(numbers);
  *at++ = (double)ran.outcome.steps;
  *at++ = ran.outcome.time;
  *at++ = ran.outcome.largest_fraction;
  memcpy(at, own, count * sizeof *own);
  at += count;
  for (size_t i = 0; i < ran.count; i++, at += 12) {
    const struct fragment *f = &ran.fragments[i];
    const double values[12] = {f->mass,        f->position[0], f->position[1],       f->position[2],
                               f->velocity[0], f->velocity[1], f->velocity[2],       f->spin[0],
                               f->spin[1],     f->spin[2],     f->moment_of_inertia, f->kinetic_energy};
    memcpy(at, values, sizeof values);
  }
  uint8_t digest[16];
  char text[33];
  blake2s(numbers, size, digest);
  for (int i = 0; i < 16; i++)
    snprintf(text + 2 * i, 3, "%02x", digest[i]);
  free(numbers);
  free(ran.fragments);
  if (strcmp(text, pinned) == 0)
    return 0;
  print_error("%s: the bits of results_version %d changed: %s, pinned %s\n", name, kind->results_version, text, pinned);
  return 1;
}
