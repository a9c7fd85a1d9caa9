/* Warnings about a run that did not fail: one word each, in the result column `warnings`. Some follow from the inputs
 * before the run, others only from the run itself. */
#ifndef CLAST_ENGINE_WARNINGS_H
#define CLAST_ENGINE_WARNINGS_H

#include <stddef.h>

/* Name, word, meaning. The limits are below or in the engines. */
#define WARNINGS(X)                                                                                                    \
  X(DRIFT, "drift", "the energy ledger drifted by more than 1 %, which the scene's fidelity.energy_bound allows")      \
  X(PASSING, "passing",                                                                                                \
    "grains that no beam joins closed in faster than the speed at which they pass through each other (dem)")           \
  X(STEP, "step",                                                                                                      \
    "the time step is above 0.25 of the longest stable one (dem), or fidelity.cfl above 0.5, or "                      \
    "above 0.2 with viscosity.alpha below 0.5 (sph)")                                                                  \
  X(DAMPING, "damping", "damping over a time step is above 0.05: the integrator does not resolve it (dem)")            \
  X(CLAMPED, "clamped", "cold matter held at u = 0 was given more than 1 % of the energy put in (sph)")                \
  X(HELD, "held", "the density was held at its lower limit in more than 1 % of all particle steps (sph)")              \
  X(CONTRAST, "contrast",                                                                                              \
    "the densities of target and projectile differ by more than a factor of 3 without method.volume_weights (sph)")    \
  X(PISTON, "piston", "matter of the plate went through the piston (sph)")                                             \
  X(GAIN, "gain",                                                                                                      \
    "contacts gave the grains more than 1 % of the energy put in, as contact.law printed and contact.bonded false "    \
    "can; the energy ledger books this as work (dem)")                                                                 \
  X(KERNEL, "kernel",                                                                                                  \
    "fidelity.smoothing is below 0.9 without method.gradient_correction: stresses and wave speeds are too small, up "  \
    "to 39 % (sph)")                                                                                                   \
  X(ARRIVAL, "arrival",                                                                                                \
    "a wave reaches the far side of the plate before the end, so that speeds and plateaus of its fronts are wrong "    \
    "(sph)")                                                                                                           \
  X(LINKS, "links",                                                                                                    \
    "particles at the start stand farther apart than fragments.link_length times h, so that a whole body "             \
    "counts as many fragments (sph)")

#define WARNINGS_BIT(name_, word_, doc_) WARNINGS_PLACE_##name_,
enum warnings_place { WARNINGS(WARNINGS_BIT) WARNINGS_COUNT };
#undef WARNINGS_BIT

/* One bit each, to be joined with |. */
#define WARNINGS_MASK(name_, word_, doc_) WARNINGS_##name_ = 1 << WARNINGS_PLACE_##name_,
enum warnings_bits { WARNINGS(WARNINGS_MASK) };
#undef WARNINGS_MASK

/* Drift of the energy ledger, divided by the energy put in, above which a run gets a warning. */
#define WARNINGS_LARGEST_DRIFT 0.01

/* The words of a set, "passing, step"; empty for none. */
void warnings_words(unsigned set, char *text, size_t size);

#endif
