/* The typed scene of engine `dem`: every input of every protocol, one row each in inputs.c. SI throughout. */
#ifndef CLAST_ENGINE_DEM_SCENE_INPUTS_H
#define CLAST_ENGINE_DEM_SCENE_INPUTS_H

#include "schemas/field.h"

enum dem_kind {
  DEM_DISC_EXPLOSION,
  DEM_BLOCK_IMPACT,
  DEM_UNIAXIAL,
  DEM_COMPRESSION,
  DEM_DISC_COLLISION,
};
enum dem_direction { DEM_EXTENSION, DEM_SHORTENING };

struct dem_inputs {
  int kind; /* enum dem_kind: the protocol */
  struct {
    double diameter;       /* m */
    int64_t columns, rows; /* grains */
  } body;
  struct {
    double density, young_modulus, spacing, disorder;
  } grain;
  struct {
    double young_modulus;
  } beam;
  struct {
    bool breaking;
    double strain, angle, modulus; /* modulus: NaN = off */
  } threshold;
  struct {
    int law; /* enum dem_contact_law */
    bool bonded;
    double normal_damping, tangential_damping, friction;
    bool damping_bonded;
  } contact;
  struct {
    double energy; /* J/m */
  } charge;
  struct {
    double speed, angle;
  } impact;
  struct {
    int direction; /* enum dem_direction */
    double rate, ramp, strain_end, residual;
  } loading;
  struct {
    double speed, impact_parameter;
  } collision;
  struct {
    double quiet_time, end_time;
  } stop;
  struct {
    double time_step;
    int integrator;      /* enum dem_integrator */
    double energy_bound; /* NaN = off */
  } fidelity;
};

extern const struct field_table dem_inputs;

/* Conditions across fields: sizes that cannot be run, times that contradict. STATUS_CONTENT with a remedy. */
status dem_inputs_check(const struct dem_inputs *inputs, struct error *error);

/* Grains the body (or both bodies) will have, near enough to plan memory and time. */
double dem_inputs_grains(const struct dem_inputs *inputs);
/* Simulated time at which the run ends at the latest, s. */
double dem_inputs_end_time(const struct dem_inputs *inputs);

#endif
