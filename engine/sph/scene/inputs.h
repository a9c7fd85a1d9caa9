/* The typed scene of engine `sph`: every input of every protocol, one row each in inputs.c or, where it belongs to a
 * module, in the module's NAME.c. SI throughout. */
#pragma once

#include "engine/sph/material/material.h"
#include "schemas/field.h"

enum sph_kind {
  SPH_IMPACT,    /* a projectile into a target */
  SPH_STRETCH,   /* a cylinder pulled by its ends at a constant rate */
  SPH_VIBRATION, /* a free cylinder that vibrates along its axis in its first mode */
  SPH_COLLISION, /* two equal cylinders or rings, thin slabs that repeat along their axes */
  SPH_PISTON,    /* a plate, a bar along x that repeats sideways, with a piston running into its end */
  SPH_KINDS
};
enum sph_fracture_choice { SPH_FRACTURE_AUTO, SPH_FRACTURE_ON, SPH_FRACTURE_OFF, SPH_FRACTURE_CHOICES };
enum sph_projectile_by { SPH_BY_SIZE, SPH_BY_MASS, SPH_BY_ENERGY, SPH_PROJECTILE_BY };
enum sph_far_side { SPH_FAR_FREE, SPH_FAR_DAMPED, SPH_FAR_SIDES };
enum sph_link_h { SPH_LINK_H_INITIAL, SPH_LINK_H_CURRENT, SPH_LINK_LENGTHS };

/* In float precision the pair loop reads and sums floats; all else stays double. Positions are read as integers in
 * units of h/2^20, so that a scene of kilometres is as accurate as a small one. */
enum sph_precision { SPH_DOUBLE, SPH_FLOAT, SPH_PRECISIONS };

struct sph_mesh_inputs {
  char file[FIELD_TEXT_SIZE]; /* SHA-256 of the shape file (engine/mesh/mesh.h) */
  double unit;                /* m */
};

struct sph_body_inputs {
  int shape; /* enum sph_shape_kind */
  struct sph_mesh_inputs mesh;
  double radius, inner_radius, length; /* m */
  double width, depth, height;         /* m: box along x, y, z */
  double spin;                         /* rad/s about z */
  int lattice;                         /* enum sph_lattice_kind */
  bool turned;
  bool strength;
  int fracture;                        /* enum sph_fracture_choice */
  char material_name[FIELD_TEXT_SIZE]; /* built-in, the name of a file, or custom */
  struct sph_material material;
};

struct sph_sides {
  int far;      /* 0 free, 1 damped */
  double depth; /* m */
};
struct sph_impact {
  int projectile;           /* enum sph_projectile_by */
  double mass;              /* kg */
  double specific_energy;   /* J/kg */
  double speed, angle, gap; /* m/s, rad, m */
};
struct sph_stretch {
  double rate, grip, flaw_free; /* 1/s, m, m */
};
struct sph_collision {
  double speed, gap; /* m/s, m */
};
struct sph_method {
  bool volume_weights, negative_energy;
};
struct sph_fragment_rules {
  double static_strength, damage, link_length; /* Pa, 1, 1 */
  double layer_width;                          /* m; 0: link_length h */
  double dust_mass;                            /* kg */
  int link_h;                                  /* 0 initial, 1 current */
  bool veneer;
};
struct sph_stop_rules {
  double end_time, quiet_time, quiet_growth; /* s, s, 1 */
};
#define SPH_INPUTS_CFL       0.3 /* the default Courant number where viscosity is strong */
#define SPH_INPUTS_LEAST_CFL 1e-3
struct sph_fidelity {
  int64_t particles, points;
  double projectile_spacing; /* 1, over the target's */
  bool graded;
  double spacings_per_radius;       /* 1, of the projectile where it hits; NaN: fine_spacing decides */
  double coarsest;                  /* 1, largest spacing over the uniform one */
  double fine_spacing, fine_radius; /* m */
  double smoothing, cfl;            /* 1 */
  double skin;                      /* 1, over h */
  int precision;                    /* enum sph_precision */
  int64_t threads;
  double energy_bound; /* 1; NaN = off */
};

/* Bodies and physics read these sections themselves: only the rows have their names, defaults and ranges. */
struct sph_inputs {
  int kind; /* enum sph_kind: the protocol */
  struct sph_body_inputs target, projectile;
  struct sph_sides sides;
  struct sph_impact impact;
  struct sph_stretch stretch;
  struct {
    double speed; /* m/s */
  } vibration;
  struct sph_collision collision;
  struct {
    double speed; /* m/s */
  } piston;
  struct sph_method method;
  struct sph_fragment_rules fragments;
  struct {
    double ejection_speed, escape_speed; /* m/s */
  } crater;
  struct sph_stop_rules stop;
  struct sph_fidelity fidelity;
#define MODULE_INPUTS(name) struct sph_##name##_inputs name;
#include "engine/sph/modules/declarations.h"
};

extern struct field_table sph_inputs; /* constant once main() begins */

/* Calls of struct engine_kind have its types: inputs are a struct sph_inputs.
 * inputs_complete.c: sets inputs that were not given and follow from others. */
void sph_inputs_complete(void *inputs, const bool *given);
/* inputs_check.c: values that a custom material must give. STATUS_CONTENT. */
status sph_inputs_check_given(const void *inputs, const bool *given, struct error *error);
void sph_inputs_remark(const void *inputs, const bool *given, char *text, size_t size);
/* inputs_check.c: conditions across fields. STATUS_CONTENT with a remedy. */
status sph_inputs_check(const void *inputs, struct error *error);
/* How to have fewer particles: "lower fidelity.particles". */
const char *sph_inputs_check_fewer(const struct sph_inputs *inputs);
