/* The typed scene of engine `dem`: every input of every protocol, with one row each in inputs.c. SI units throughout.
 *
 * The physics reads these sections by const pointer. Only the rows have ranges and defaults. */
#pragma once

#include "engine/dem/contacts/laws.h"
#include "schemas/field.h"

enum dem_kind {
  DEM_DISC_EXPLOSION,
  DEM_BLOCK_IMPACT,
  DEM_UNIAXIAL,
  DEM_COMPRESSION,
  DEM_DISC_COLLISION,
  DEM_RING_EXPLOSION,
  DEM_KINDS
};
enum dem_direction { DEM_EXTENSION, DEM_SHORTENING, DEM_DIRECTIONS };
enum dem_integrator { DEM_VERLET, DEM_GEAR, DEM_INTEGRATORS };

struct dem_inputs {
  int kind; /* enum dem_kind: the protocol */
  struct {
    double diameter;       /* m */
    double wall;           /* thickness of a ring's wall, m; NaN = off: no hole */
    int64_t columns, rows; /* grains */
  } body;
  struct {
    double density;           /* kg/m^3; the thickness is 1 m, so masses are in kg per metre */
    double young_modulus;     /* Y, Pa */
    double spacing, disorder; /* m; 1 */
  } grain;
  struct {
    double young_modulus; /* E, Pa */
  } beam;
  struct {
    bool breaking;
    double strain, angle; /* t_epsilon; t_Theta, rad */
    double modulus;       /* Weibull modulus of thresholds drawn for each beam; NaN = off */
  } threshold;
  struct dem_contact_inputs {
    int law;                                   /* enum dem_contact_law */
    bool bonded;                               /* contact acts between grains that a beam joins, too */
    double normal_damping, tangential_damping; /* gamma_N, gamma_T, 1/s */
    double friction;                           /* mu */
    bool damping_bonded;                       /* damping and friction act between grains that a beam joins, too */
  } contact;
  struct {
    double energy; /* J/m */
  } charge;
  struct {
    double speed, angle; /* m/s; rad */
  } impact;
  struct {
    int direction;                           /* enum dem_direction */
    double rate, ramp, strain_end, residual; /* 1/s; s; 1; 1, NaN = off */
  } loading;
  struct {
    double speed, impact_parameter; /* m/s; diameters */
  } collision;
  struct {
    double rate; /* 1/s */
  } expansion;
  struct {
    double quiet_time, least_time, end_time; /* s */
  } stop;
  struct {
    double time_step;    /* s */
    int integrator;      /* enum dem_integrator */
    double energy_bound; /* share of the energy put in; NaN = off */
  } fidelity;
};

extern const struct field_table dem_inputs;

/* The time step, which follows from the contact law unless it is given. */
void dem_inputs_complete(void *inputs, const bool *given);
/* Checks conditions across fields: sizes that cannot be run, times that contradict each other. STATUS_CONTENT with a
 * remedy. */
status dem_inputs_check(const void *inputs, struct error *error); /* struct dem_inputs */

/* Whether the body is round, or is two round bodies. */
bool dem_inputs_round(const struct dem_inputs *inputs);
/* Radius of the hole in a round body, m; 0: none. */
double dem_inputs_hole(const struct dem_inputs *inputs);
/* Distance along the approach of the centres of two discs that are `apart`, m. */
double dem_inputs_approach(const struct dem_inputs *inputs, double apart);
/* Whether moving sides load the body (uniaxial, compression). */
bool dem_inputs_loaded(const struct dem_inputs *inputs);
/* Estimated number of grains of the body (or of both bodies), to plan memory and time. */
double dem_inputs_grains(const struct dem_inputs *inputs);
/* Simulated time at which the run ends at the latest, s. */
double dem_inputs_end_time(const struct dem_inputs *inputs);
