/* The rows of the scene: unit, range, default, documentation, source of each input. "K99" is Kun, D'Addetta, Herrmann &
 * Ramm 1999, Two-dimensional dynamic simulation of fracture and fragmentation of solids. The numbers of its table 1 are
 * converted from CGS to SI; the thickness is 1 m, so energies are per metre. */
#include "engine/dem/scene/inputs.h"

#include <math.h>

#include "engine/input_rows.h"

static FIELD_WORDS(kinds, DEM_KINDS, [DEM_DISC_EXPLOSION] = "disc-explosion", [DEM_BLOCK_IMPACT] = "block-impact",
                   [DEM_UNIAXIAL] = "uniaxial", [DEM_COMPRESSION] = "compression",
                   [DEM_DISC_COLLISION] = "disc-collision", [DEM_RING_EXPLOSION] = "ring-explosion");
static FIELD_WORDS(directions, DEM_DIRECTIONS, [DEM_EXTENSION] = "extension", [DEM_SHORTENING] = "compression");
static FIELD_WORDS(integrators, DEM_INTEGRATORS, [DEM_VERLET] = "verlet", [DEM_GEAR] = "gear");

#define DEGREE (M_PI / 180)

#define INPUTS dem_inputs

#define DISCS    "kind=disc-explosion|disc-collision|ring-explosion"
#define BLOCKS   "kind=block-impact|uniaxial|compression"
#define LOADED   "kind=uniaxial|compression"
#define FREE     "kind=disc-explosion|block-impact|disc-collision|ring-explosion"
#define TOUCHING "contact.law=" DEM_LAWS(DEM_LAWS_NAME, "|")

static const struct field rows[] = {
    CHOICE(kind, kinds,
           .choice_docs = "a charge in the centre of a disc\n"
                          "one grain of a block's lower side is shot into it\n"
                          "a block pulled or pressed between two opposite sides, free to slide sideways: K and nu\n"
                          "a block pressed between confined ends until it fails\n"
                          "two equal discs run into each other\n"
                          "all grains of a ring start outwards, so that it widens everywhere at one strain rate",
           .doc = "Protocol: load or impact on the body.", .source = "K99 section 3"),

    REAL(body.diameter, "m", 0.4, 1e-6, 1e6, .when = DISCS, .label = "diameter of the body",
         .doc = "Diameter of the disc, or outer diameter of the ring.", .source = "K99 table 1"),
    REAL(body.wall, "m", NAN, 0, 5e5, .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM, .absent = "off",
         .when = "kind=disc-collision|ring-explosion", .label = "thickness of the ring's wall",
         .doc = "Thickness of the wall of a ring, at least two spacings: grains whose centroid lies between the two "
                "circles belong to it. off: a disc without a hole.",
         .source = "Szuszik & Kun (2025), abstract: ring thickness decides between segments and planar fragments"),
    COUNT(body.columns, 40, 1, 10000, .when = BLOCKS, .doc = "Grains along the block's width (x)."),
    COUNT(body.rows, 20, 2, 10000, .when = BLOCKS,
          .doc = "Grains along the block's height (y): the direction of the load or of the shot."),

    REAL(grain.density, "kg/m^3", 5000, 1e-3, 1e6, .label = "density of the grains",
         .doc = "Mass density of the grains.", .source = "K99 table 1"),
    REAL(grain.young_modulus, "Pa", 1e9, 1, 1e15, .label = "Young's modulus of the grains Y",
         .doc = "Y: modulus of the repulsion of overlapping grains.", .source = "K99 eq. 2 and table 1"),
    REAL(grain.spacing, "m", 0.01069, 1e-9, 1e5, .label = "spacing of the grains",
         .doc =
             "Grid constant of the random lattice: the mean size of a grain. The default gives about 1100 grains in a "
             "disc of 0.4 m. A block has body.columns times body.rows of them, so that it shrinks with the spacing; "
             "the knob `grains` of `clast converge` keeps its sides.",
         .source = "K99 table 1 (number of polygons)"),
    REAL(grain.disorder, "1", 1, 0, 1,
         .doc = "a over spacing: each grid square has one random point, uniform in the concentric square of side a. 0 "
                "is a square lattice, 1 uses the whole grid square.",
         .source = "K99 section 2.1; the paper gives no value for its runs"),

    REAL(beam.young_modulus, "Pa", 5e8, 1, 1e15, .label = "Young's modulus of the beams E",
         .doc = "E: modulus of the beams that join neighbouring grains; the shear modulus is E/2.",
         .source = "K99 eqs. 7-9 and table 1"),

    SWITCH(threshold.breaking, 1, .doc = "Beams may break. Off: a purely elastic body."),
    REAL(threshold.strain, "1", 0.03, 1e-9, 1e3, .flags = FIELD_PERCENT, .when = "threshold.breaking=true",
         .label = "threshold of beams in strain t_ε", .doc = "t_epsilon: strain at which an unbent beam breaks.",
         .source = "K99 eq. 13"),
    REAL(threshold.angle, "rad", 4 * DEGREE, 1e-9, 1e3, .when = "threshold.breaking=true",
         .label = "threshold of beams in angle t_Θ",
         .doc = "t_Theta: end rotation at which a beam with almost no stretch breaks.", .source = "K99 eq. 13"),
    REAL(threshold.modulus, "1", NAN, 0.1, 1e6, .flags = FIELD_MAY_BE_OFF, .when = "threshold.breaking=true",
         .label = "Weibull modulus of the thresholds",
         .doc = "Weibull modulus: each beam has random thresholds; the two thresholds above are the scales of the law. "
                "off: all beams have the same thresholds.",
         .source = "off is K99 section 2.3; the law is an option beyond the paper"),

    CHOICE(contact.law, dem_laws_names,
           .choice_docs = DEM_LAWS(DEM_LAWS_DOC, "\n") "\n"
                                                       "grains pass through each other: the pure beam lattice",
           .doc = "Repulsion of overlapping grains.", .source = "K99 eq. 2 for `printed`"),
    SWITCH(contact.bonded, 1, .when = TOUCHING,
           .doc = "Repulsion acts between grains that a beam joins, too: the paper's stiffer compression needs it.",
           .source = "K99 section 3.1"),
    REAL(contact.normal_damping, "1/s", 0, 0, 1e12, .when = TOUCHING,
         .doc = "gamma_N: damping of the approach of overlapping grains.",
         .source = "K99 eq. 3; the paper gives no value"),
    REAL(contact.tangential_damping, "1/s", 0, 0, 1e12, .when = TOUCHING,
         .doc = "gamma_T: damping of the sliding of overlapping grains, limited by Coulomb's law.",
         .source = "K99 eq. 4; the paper gives no value"),
    REAL(contact.friction, "1", 0, 0, 100, .when = TOUCHING,
         .doc = "mu: limit of the tangential over the normal force.", .source = "K99 eq. 4; the paper gives no value"),
    SWITCH(contact.damping_bonded, 0, .when = TOUCHING,
           .doc =
               "Damping and friction act between grains that a beam joins, too. They decide the outcome more than any "
               "threshold does."),

    REAL(charge.energy, "J/m", 5e4, 1e-12, 1e18, .when = "kind=disc-explosion", .label = "energy of the charge",
         .doc =
             "E_o: kinetic energy given to the neighbours of the central grain, per metre of thickness. Each starts "
             "perpendicular to the common side with a speed proportional to side over mass; the central grain is the "
             "explosive and is gone.",
         .source = "K99 section 3.3.1 and table 1 (5e9 erg per cm)"),

    REAL(impact.speed, "m/s", 400, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=block-impact",
         .label = "impact speed", .doc = "Speed of the grain in the middle of the lower side, directed into the block.",
         .source = "K99 figure II"),
    REAL(impact.angle, "rad", 0, -1.5707963267948966, 1.5707963267948966, .when = "kind=block-impact",
         .label = "impact angle", .doc = "Angle between that velocity and the inward normal, positive towards +x."),

    CHOICE(loading.direction, directions, .when = "kind=uniaxial",
           .choice_docs = "the sides move apart\nthe sides move towards each other", .doc = "Sense of the load."),
    REAL(loading.rate, "1/s", 0.5, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = LOADED, .label = "strain rate",
         .doc = "Strain rate once the sides move at constant speed (each side moves at half of rate times height).",
         .source = "K99 section 3.1; the paper gives no value"),
    REAL(loading.ramp, "s", 5e-3, 0, 1e3, .when = LOADED,
         .doc = "Time of constant acceleration from rest to that speed: it keeps elastic waves small.",
         .source = "K99 section 3.1; the paper gives no value"),
    REAL(loading.strain_end, "1", 0.01, 0, 0.9, .flags = FIELD_ABOVE_MINIMUM | FIELD_PERCENT, .when = LOADED,
         .doc = "Strain between the held layers at which the run ends."),
    REAL(loading.residual, "1", 0.3, 0, 1, .flags = FIELD_MAY_BE_OFF | FIELD_BELOW_MAXIMUM, .when = "kind=compression",
         .doc = "The run ends when the stress falls below this share of its maximum: the body has then failed. off: "
                "load up to strain_end."),

    REAL(collision.speed, "m/s", 200, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=disc-collision",
         .label = "collision speed",
         .doc = "Speed of approach of the two discs; each has half of it in their common frame."),
    REAL(collision.impact_parameter, "1", 0, 0, 1, .flags = FIELD_BELOW_MAXIMUM, .when = "kind=disc-collision",
         .doc = "Distance of the centres across the approach, over the diameter: 0 is head-on."),

    REAL(expansion.rate, "1/s", 100, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=ring-explosion",
         .label = "strain rate of the expansion",
         .doc = "Strain rate at the start, along and across the wall: each grain starts away from the centre of mass "
                "with this rate times its distance, without spin.",
         .source = "Szuszik & Kun (2025), abstract, for the strain rate; the field of speeds is our choice"),

    REAL(stop.quiet_time, "s", 3e-4, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = FREE,
         .doc =
             "The run is complete when no beam has broken for this long, counted from the first break. A time, not a "
             "number of steps: else the time step would change the physics.",
         .source = "K99 section 3.3.1 (300 steps of 1 us)"),
    REAL(stop.least_time, "s", 1e-2, 0, 1e6, .when = FREE,
         .doc = "The run is not complete before this time, or before stop.end_time if that is earlier. Without damping "
                "fragments go on vibrating, and beams go on breaking, about as many in each doubling of the time; a "
                "short quiet time says little. The result largest_loss tells how final a run is. 0 is K99's rule.",
         .source = "measured: engine/dem/README.md, how final a run is"),
    REAL(stop.end_time, "s", 2e-2, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = FREE,
         .doc = "End time of the run, also if fracture continues."),

    REAL(fidelity.time_step, "s", 1e-6, 1e-15, 1e3, .flags = FIELD_DERIVED,
         .doc =
             "Time step, at most the body's longest stable step: 2/omega_max for `verlet`, 0.54/omega_max for `gear`. "
             "Unless given: 1 us, or 0.5 us with contact.law: printed, whose jumps of the force let the energy drift.",
         .source = "K99 table 1"),
    CHOICE(fidelity.integrator, integrators,
           .choice_docs = "velocity Verlet: the everyday choice\nfifth-order Gear predictor-corrector: the paper's",
           .doc = "Integrator of the equations of motion.", .source = "K99 section 2.3 for `gear`"),
    REAL(fidelity.energy_bound, "1", 0.01, 0, 1e3, .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM | FIELD_PERCENT,
         .doc = "The run ends with state `energy` when the sum of all energies drifts by more than this share of the "
                "energy put "
                "in. off: it only reports the drift."),
};

const struct field_table dem_inputs = FIELD_TABLE(
    rows, struct dem_inputs, "dem scene",
    "Discrete elements in the plane: Voronoi grains joined by breakable beams (Kun, D'Addetta, Herrmann & Ramm 1999).",
    .lacking = "material",
    .instead =
        "grains of dem are of no rock; their values are grain.*, beam.*, threshold.* and contact.*, which 'clast "
        "explain SCENE' lists. Rocks are for scenes of engine sph");

bool dem_inputs_round(const struct dem_inputs *in) {
  return in->kind == DEM_DISC_EXPLOSION || in->kind == DEM_DISC_COLLISION || in->kind == DEM_RING_EXPLOSION;
}

double dem_inputs_hole(const struct dem_inputs *in) {
  return field_is_off(in->body.wall) ? 0 : in->body.diameter / 2 - in->body.wall;
}

double dem_inputs_approach(const struct dem_inputs *in, double apart) {
  const double across = in->collision.impact_parameter * in->body.diameter;
  return sqrt(apart * apart - across * across);
}

bool dem_inputs_loaded(const struct dem_inputs *in) {
  return in->kind == DEM_UNIAXIAL || in->kind == DEM_COMPRESSION;
}

double dem_inputs_grains(const struct dem_inputs *in) {
  if (!dem_inputs_round(in))
    return (double)in->body.columns * (double)in->body.rows;
  double disc = 0.25 * M_PI * pow(in->body.diameter / in->grain.spacing, 2) -
                M_PI * pow(dem_inputs_hole(in) / in->grain.spacing, 2);
  return in->kind == DEM_DISC_COLLISION ? 2 * disc : disc;
}

double dem_inputs_end_time(const struct dem_inputs *in) {
  if (!dem_inputs_loaded(in))
    return in->stop.end_time;
  double strain = in->loading.strain_end, rate = in->loading.rate, ramp = in->loading.ramp;
  return strain >= rate * ramp / 2 ? strain / rate + ramp / 2 : sqrt(2 * ramp * strain / rate);
}

void dem_inputs_complete(void *inputs, const bool *given) {
  struct dem_inputs *in = inputs;
  if (!given[field_find(&dem_inputs, "fidelity.time_step", NULL) - dem_inputs.rows])
    in->fidelity.time_step = in->contact.law == DEM_CONTACT_PRINTED ? 0.5e-6 : 1e-6;
}

status dem_inputs_check(const void *inputs, struct error *error) {
  const struct dem_inputs *in = inputs;
  double grains = dem_inputs_grains(in);
  bool disc = dem_inputs_round(in);
  if (disc && !(in->body.diameter >= 4 * in->grain.spacing))
    return status_fail(error, STATUS_CONTENT,
                       "body.diameter is %.4g m, grain.spacing %.4g m: a disc needs a diameter of at least 4 spacings",
                       in->body.diameter, in->grain.spacing);
  if (in->body.wall < 2 * in->grain.spacing)
    return status_fail(
        error, STATUS_CONTENT,
        "body.wall is %.4g m, grain.spacing %.4g m: a wall needs at least 2 spacings to be whole; give a "
        "thicker wall or a smaller grain.spacing",
        in->body.wall, in->grain.spacing);
  if (in->body.wall > in->body.diameter / 2)
    return status_fail(error, STATUS_CONTENT,
                       "body.wall is %.4g m, more than half of body.diameter (%.4g m): give a thinner wall, or off for "
                       "a disc without a hole",
                       in->body.wall, in->body.diameter);
  if (!(grains <= 1e7))
    return status_fail(error, STATUS_CONTENT, "a body of %.3g grains is too large (at most 1e7): %s", grains,
                       disc ? "raise grain.spacing or lower body.diameter" : "lower body.columns or body.rows");
  double steps = dem_inputs_end_time(in) / in->fidelity.time_step;
  if (!(steps <= 1e12))
    return status_fail(error, STATUS_CONTENT,
                       "the run could take %.3g time steps (at most 1e12): raise fidelity.time_step or end it earlier",
                       steps);
  if (!(steps >= 1))
    return status_fail(error, STATUS_CONTENT,
                       "the run ends before its first time step of %.4g s: lower fidelity.time_step",
                       in->fidelity.time_step);
  if (!dem_inputs_loaded(in))
    return STATUS_OK;
  if (in->body.rows < 4 || in->body.columns < 4)
    return status_fail(error, STATUS_CONTENT,
                       "a loaded block needs at least 4 columns and 4 rows: two rows are held, strains are measured "
                       "between the others");
  if (in->loading.strain_end < 0.5 * in->loading.rate * in->loading.ramp)
    return status_fail(error, STATUS_CONTENT,
                       "loading.strain_end %.4g is reached while the sides still accelerate (strain %.4g at the end of "
                       "loading.ramp): shorten the ramp or lower loading.rate",
                       in->loading.strain_end, 0.5 * in->loading.rate * in->loading.ramp);
  return STATUS_OK;
}
