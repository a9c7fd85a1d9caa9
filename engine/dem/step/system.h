/* The moving grains: beams, contacts, integration, breaking. K99 section 2 with the corrections in
 * engine/dem/README.md.
 *
 * All arrays are allocated at set-up; nothing is allocated in the step loop. */
#pragma once

#include <stdbool.h>

#include "engine/dem/lattice/tessellation.h"
#include "engine/dem/scene/inputs.h"
#include "engine/dem/step/progress.h"

/* Energy per term, J/m. closed = kinetic + beam + contact + broken_beam + damping + friction - external_work; for a law
 * that stores energy `contact` is that energy, for another the work done on contacts. */
struct dem_ledger {
  double kinetic, beam, contact, damping, friction, broken_beam, external_work;
  double begun; /* given by contacts that began with a break; broken_beam is less by this */
};

struct dem_system; /* opaque; layout in system_layout.h, for this folder only */

/* Builds the grains at rest. The system keeps `inputs`: they must outlive it. `seed` draws the thresholds of beams.
 * STATUS_CONTENT: a grain or pair that cannot be used. STATUS_MEMORY. */
status dem_system_create(const struct dem_tessellation *tessellation, const struct dem_inputs *inputs, uint64_t seed,
                         struct dem_system **out, struct error *error);
void dem_system_free(struct dem_system *system); /* NULL is fine */

/* Boundary conditions and loads, per grain. */
void dem_system_set_velocity(struct dem_system *system, uint32_t grain, double vx, double vy, double spin);
void dem_system_remove(struct dem_system *system, uint32_t grain); /* the explosive: its beams and contacts vanish */
/* Degrees of freedom held at a prescribed velocity (bit 1: x, 2: y, 4: rotation). The work they do is booked. */
void dem_system_hold(struct dem_system *system, uint32_t grain, unsigned freedoms);
void dem_system_drive(struct dem_system *system, uint32_t grain, double vx, double vy, double spin);

/* One time step. False when a position or velocity is no longer finite, or memory ran out. */
bool dem_system_step(struct dem_system *system);
bool dem_system_lacks_memory(const struct dem_system *system); /* why a step failed */

/* How far it has come. */
const struct dem_progress *dem_system_now(const struct dem_system *system);
struct dem_ledger dem_system_ledger(struct dem_system *system);
/* State of one grain: position of the centre of mass, rotation angle, velocities. */
struct dem_grain {
  double x, y, angle, vx, vy, spin, mass, moment_of_inertia;
  bool present;
};
struct dem_grain dem_system_grain(const struct dem_system *system, uint32_t grain);
/* Force on a grain at the last evaluation (without the reaction of its holds). */
void dem_system_force(const struct dem_system *system, uint32_t grain, double *fx, double *fy, double *torque);
/* Beams: do they hold, and their present strain. */
bool dem_system_beam_alive(const struct dem_system *system, size_t beam);
double dem_system_beam_strain(const struct dem_system *system, size_t beam);
/* Energy that would bring each present beam, unbent, to its own threshold, J/m. NaN without breaking. */
double dem_system_threshold_energy(const struct dem_system *system);
size_t dem_system_breaks(const struct dem_system *system, const struct dem_break **log);
/* Longest stable time step, s: 2 / omega_max for Verlet, 0.54 / omega_max for Gear (why: system.c), by power
 * iteration on the beams and contacts at rest. NaN: no memory. */
double dem_system_stable_time_step(const struct dem_system *system);
/* Number of pairs that overlap now, divided by the number of the tessellation's neighbour pairs. */
double dem_system_overlap_share(struct dem_system *system);
/* Current outline of a grain, counter-clockwise; returns the number of vertices (up to capacity are written). */
size_t dem_system_outline(const struct dem_system *system, uint32_t grain, size_t capacity, struct dem_point *vertices);

/* Everything that the next step depends on: a restored run continues with the same bits. copy: malloc'd, NULL without
 * memory. load: false when the bytes do not fit this system, or without memory. */
void *dem_system_state_copy(const struct dem_system *system, size_t *size);
bool dem_system_state_load(struct dem_system *system, const void *bytes, size_t size);
