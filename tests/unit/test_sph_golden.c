/* Result bits change only on purpose: three small runs under the baseline CPU class have pinned hashes. When this fails and the
 * change was meant, raise .results_version in engine/sph/sph.c and put its number and the printed hash here; when it was not
 * meant, the change has a fault. glibc's own CPU variants are masked, so that any x86-64 machine gives the same bits. */
#include "tests/sph_run_case.h"

#include <unistd.h>

#include "engine/blake2s.h"

enum { RESULTS_VERSION = 2 };
#define GOLDEN_SPHERE "148fc873da543a94e23cadf66939278b"
#define GOLDEN_ROD "a05b12616952ccc398936f33020e2726"
#define GOLDEN_RINGS "902c29367ddad135e72f9e5f57ef71bb"

static void hash_of(const struct sph_ran *ran, char text[33]) {
  size_t size = 6 * sizeof(double) + ran->count * 12 * sizeof(double);
  double *numbers = malloc(size), *at = numbers;
  *at++ = (double)ran->outcome.steps;
  *at++ = ran->outcome.time;
  *at++ = ran->outcome.largest_fraction;
  *at++ = ran->results.mean_damage;
  *at++ = ran->results.energy.internal;
  *at++ = ran->results.energy.kinetic;
  for (size_t i = 0; i < ran->count; i++) {
    const struct fragment *f = &ran->fragments[i];
    const double values[12] = {f->mass,        f->position[0], f->position[1], f->position[2], f->velocity[0],       f->velocity[1],
                               f->velocity[2], f->spin[0],     f->spin[1],     f->spin[2],     f->moment_of_inertia, f->kinetic_energy};
    memcpy(at, values, sizeof values);
    at += 12;
  }
  uint8_t digest[16];
  blake2s(numbers, size, digest);
  for (int i = 0; i < 16; i++)
    snprintf(text + 2 * i, 3, "%02x", digest[i]);
  free(numbers);
}

static int pinned(const char *name, const struct sph_inputs *inputs, const char *golden) {
  struct sph_ran ran = sph_run_case_run(inputs, 11);
  char text[33];
  hash_of(&ran, text);
  free(ran.fragments);
  if (strcmp(text, golden) == 0)
    return 0;
  print_error("%s: the bits of results_version %d changed: %s, pinned %s\n", name, sph_engine.results_version, text, golden);
  return 1;
}

static void bits_change_only_with_the_version(void **state) {
  (void)state;
  if (sph_engine.results_version != RESULTS_VERSION)
    fail_msg("results_version is %d now: pin its hashes here", sph_engine.results_version);
  struct sph_inputs sphere = SPH_RUN_CASE("basalt-sphere", "fidelity.particles=500", "fidelity.projectile_spacing=0.7",
                                          "stop.end_time=30 us", "fracture.draw=poisson");
  struct sph_inputs rod = SPH_RUN_CASE("tensile-rod", "fidelity.particles=1200", "stop.end_time=20 us", "fidelity.flaws=compact",
                                       "target.lattice=irregular", "method.gradient_correction=true");
  struct sph_inputs rings = SPH_RUN_CASE("colliding-cylinders", "fidelity.particles=300", "stop.end_time=0.3 ms");
  int changed = pinned("sphere", &sphere, GOLDEN_SPHERE) + pinned("rod", &rod, GOLDEN_ROD) + pinned("rings", &rings, GOLDEN_RINGS);
  assert_int_equal(changed, 0);
}

int main(int count, char **arguments) {
  (void)count;
  if (!getenv("CLAST_GOLDEN")) { /* the tunables are read before main: start again with them */
    setenv("CLAST_GOLDEN", "1", 1);
    setenv("CLAST_CPU", "baseline", 1);
    setenv("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F", 1);
    execv("/proc/self/exe", arguments);
    return 71;
  }
  const struct CMUnitTest tests[] = {cmocka_unit_test(bits_change_only_with_the_version)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
