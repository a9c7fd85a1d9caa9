/* The typed scene of engine `sph`: every input of every protocol, one row each in inputs.c. SI throughout. */
#ifndef CLAST_ENGINE_SPH_SCENE_INPUTS_H
#define CLAST_ENGINE_SPH_SCENE_INPUTS_H

#include "engine/sph/material/material.h"
#include "schemas/field.h"

enum sph_kind {
  SPH_IMPACT,    /* a projectile into a target */
  SPH_STRETCH,   /* a cylinder pulled by its ends at a constant rate */
  SPH_VIBRATION, /* a free cylinder ringing along its axis in its first mode */
  SPH_COLLISION, /* two equal cylinders or rings, thin slabs that repeat along their axes */
  SPH_PISTON,    /* a plate, a bar along x that repeats sideways, with a piston running into its end */
};
enum sph_fracture_choice { SPH_FRACTURE_AUTO, SPH_FRACTURE_ON, SPH_FRACTURE_OFF };
enum sph_projectile_by { SPH_BY_SIZE, SPH_BY_MASS, SPH_BY_ENERGY };

struct sph_body_inputs {
  int shape;                           /* enum sph_shape_kind */
  double radius, inner_radius, length; /* m */
  double width, depth, height;         /* m: box along x, y, z */
  double spin;                         /* rad/s about z */
  int lattice;                         /* enum sph_lattice_kind */
  bool turned;
  bool strength;
  int fracture;      /* enum sph_fracture_choice */
  int material_name; /* index of builtin_material_names */
  struct sph_material material;
};

struct sph_inputs {
  int kind; /* enum sph_kind: the protocol */
  struct sph_body_inputs target, projectile;
  struct {
    int far;      /* 0 free, 1 damped */
    double depth; /* m */
  } sides;
  struct {
    int projectile; /* enum sph_projectile_by */
    double mass, specific_energy;
    double speed, angle, gap;
  } impact;
  struct {
    double rate, grip, flaw_free;
  } stretch;
  struct {
    double speed;
  } vibration;
  struct {
    double speed, gap;
  } collision;
  struct {
    double speed;
  } piston;
  struct {
    int draw, growth, cap, crack_radius;
  } fracture;
  struct {
    double alpha, beta;
  } viscosity;
  struct {
    double artificial_stress;
    bool gradient_correction, volume_weights;
  } method;
  struct {
    double static_strength, damage, link_length;
    int link_h; /* 0 initial, 1 current */
    bool veneer;
  } fragments;
  struct {
    double ejection_speed;
  } crater;
  struct {
    double end_time, quiet_time, quiet_growth;
  } stop;
  struct {
    int64_t particles, points;
    double projectile_spacing;
    bool graded;
    double fine_spacing, fine_radius;
    double smoothing, cfl, damage_step, distention_step, skin;
    int precision, flaws;
    int64_t threads;
    double energy_bound; /* NaN = off */
  } fidelity;
};

extern const struct field_table sph_inputs;

/* inputs_complete.c: what was not given and follows from what was (engine_kind.complete). */
void sph_inputs_complete(struct sph_inputs *inputs, const bool *given);
/* inputs_check.c: conditions across fields. STATUS_CONTENT with a remedy. */
status sph_inputs_check(const struct sph_inputs *inputs, struct error *error);
/* What makes fewer particles of these inputs: "lower fidelity.particles". */
const char *sph_inputs_check_fewer(const struct sph_inputs *inputs);

#endif
