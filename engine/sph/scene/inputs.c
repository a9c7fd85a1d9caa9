/* The rows of a scene. Inputs that belong to a module have theirs in its NAME.c (modules/declarations.h). "BA95" in the
 * sources: Benz & Asphaug 1995, Simulations of brittle solids using smooth particle hydrodynamics. */
#include "engine/sph/scene/inputs.h"

#include <math.h>

#include "engine/builtin.h"
#include "engine/input_rows.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/body/flaws.h"

static FIELD_WORDS(kinds, SPH_KINDS, [SPH_IMPACT] = "impact", [SPH_STRETCH] = "stretch", [SPH_VIBRATION] = "vibration",
                   [SPH_COLLISION] = "collision", [SPH_PISTON] = "piston");
static FIELD_WORDS(shapes, SPH_SHAPES, [SPH_SHAPE_SPHERE] = "sphere", [SPH_SHAPE_CYLINDER] = "cylinder",
                   [SPH_SHAPE_BOX] = "box", [SPH_SHAPE_MESH] = "mesh");
static FIELD_WORDS(lattices, SPH_LATTICES, [SPH_LATTICE_HEXAGONAL] = "hexagonal", [SPH_LATTICE_CUBIC] = "cubic",
                   [SPH_LATTICE_IRREGULAR] = "irregular");
static FIELD_WORDS(
    fractures,
    SPH_FRACTURE_CHOICES, [SPH_FRACTURE_AUTO] = "auto", [SPH_FRACTURE_ON] = "on", [SPH_FRACTURE_OFF] = "off");
static FIELD_WORDS(far_sides, SPH_FAR_SIDES, [SPH_FAR_FREE] = "free", [SPH_FAR_DAMPED] = "damped");
static FIELD_WORDS(
    projectile_by,
    SPH_PROJECTILE_BY, [SPH_BY_SIZE] = "size", [SPH_BY_MASS] = "mass", [SPH_BY_ENERGY] = "specific-energy");
static FIELD_WORDS(link_h, SPH_LINK_LENGTHS, [SPH_LINK_H_INITIAL] = "initial", [SPH_LINK_H_CURRENT] = "current");
static FIELD_WORDS(precisions, SPH_PRECISIONS, [SPH_DOUBLE] = "double", [SPH_FLOAT] = "float");

/* ---- a body: the target or the projectile ---- */

#define INPUTS sph_body_inputs

static const struct field outline_rows[] =
    {CHOICE(shape, shapes,
            .doc = "The target's outline, its centre at the origin. An impact takes all of them, a piston a box; the "
                   "others are done to cylinders. A mesh comes from a shape file."),
     ROW(mesh.file, FIELD_TEXT, NULL, .text = "", .flags = FIELD_FILE | FIELD_DERIVED, .when = "shape=mesh",
         .doc = "Shape file, STL or OBJ: a closed surface of triangles; to be given. Its name is relative to the "
                "scene's file. The centre of mass comes to the origin, the axes are those of the file, and z is up. A "
                "resolved scene has the SHA-256 of the file instead, and a store keeps the file."),
     REAL(mesh.unit, "m", NAN, 1e-12, 1e9, .flags = FIELD_DERIVED, .when = "shape=mesh",
          .doc = "Length that 1 in the shape file stands for, such as 1 km or 1 mm: to be given, as the file does not "
                 "say it."),
     REAL(radius, "m", 0.03, 1e-9, 1e9, .when = "shape=sphere|cylinder", .doc = "Radius of the sphere or cylinder."),
     REAL(inner_radius, "m", 0, 0, 1e9, .when = "shape=cylinder",
          .doc = "Radius of a hole along the cylinder's axis, which makes a ring. 0: a full cylinder."),
     REAL(length, "m", 0.04, 1e-9, 1e9, .when = "shape=cylinder",
          .doc = "Length of the cylinder along its axis: z for a target, the direction of flight for a projectile. In "
                 "a collision, where the slab repeats along z, the least length: whole periods of the lattice are made "
                 "of it."),
     REAL(width, "m", 0.2, 1e-9, 1e9, .when = "shape=box", .doc = "Side of the box along x."),
     REAL(depth, "m", 0.2, 1e-9, 1e9, .when = "shape=box",
          .doc = "Side of the box along y. Of a plate (kind: piston), which repeats along y and z, the least one: "
                 "whole periods of the lattice are made of it."),
     REAL(height, "m", 0.2, 1e-9, 1e9, .when = "shape=box",
          .doc = "Side of the box along z. A projectile comes down on the upper side. Of a plate (kind: piston) the "
                 "least one.")};
static const struct field_table outline = FIELD_TABLE(outline_rows, struct sph_body_inputs, "outline", NULL);

#define MATERIAL_DOC(default_)                                                                                         \
  "Material whose values become the defaults of this body's; `clast materials` lists them, and " default_              \
  " is taken unless one is named. A file of your own ends in .yaml, such as ./my-rock.yaml. "                          \
  "custom: the scene gives all values."

static const struct field matter_rows[] = {
    CHOICE(lattice, lattices,
           .choice_docs =
               "hexagonal close packing\nsimple cubic\nrandom points pushed apart until the density is uniform",
           .doc = "How particles stand at the start."),
    SWITCH(turned, 0, .flags = FIELD_DERIVED,
           .doc = "Orientation and offset of the lattice are drawn from the seed, so that each seed is a specimen of "
                  "its own; on in impacts and stretched rods unless given. false: along the axes, the same for all "
                  "seeds, which makes scatter 2 to 100 times too small."),
    SWITCH(strength, 1,
           .doc = "The body resists shear (Hooke, von Mises). false: a fluid; stress and strength are not stored."),
    CHOICE(fracture, fractures, .when = "strength=true",
           .choice_docs = "if the material has Weibull's m and k\nyes; m and k are needed\nno: only tension_limit and "
                          "yield limit stress",
           .doc = "The body has explicit flaws, from which cracks grow.", .source = "BA95 section 3"),
    ROW_OF(INPUTS, material.name, material_name, FIELD_TEXT, NULL, .text = "custom", .choices = builtin_material_names,
           .flags = FIELD_DERIVED, .doc = MATERIAL_DOC("basalt")),
    {.path = "material",
     .offset = offsetof(struct sph_body_inputs, material),
     .nest = &sph_materials_nested,
     .flags = FIELD_DERIVED,
     .doc = "The named material's value unless given.",
     .choice_docs = "The named material's unless given."},
};
static const struct field_table matter = FIELD_TABLE(matter_rows, struct sph_body_inputs, "matter", NULL);

#undef INPUTS
#define INPUTS sph_inputs

static const struct field projectile_outline[] = {
    {.path = "shape", .when = "impact.projectile=size", .doc = "The projectile's outline."},
    {.path = "radius", .number = 0.0035},
    {0},
};
static const struct field projectile_matter[] = {{.path = "material.name", .doc = MATERIAL_DOC("nylon")}, {0}};

/* ---- inputs of modules, in the order of modules/declarations.h ---- */

static const struct field module_rows[] = {
#define SPH_MODULE_INPUT_ROWS
#include "engine/sph/modules/declarations.h"
};
static const struct field_table modules = FIELD_TABLE(module_rows, struct sph_inputs, "modules", NULL);

/* ---- the scene ---- */

#define BODY(body, ...)                                                                                                \
  { .path = #body, .offset = offsetof(struct sph_inputs, body), __VA_ARGS__ }

static const struct field rows[] = {
    CHOICE(kind, kinds,
           .choice_docs = "a projectile flies into a target\n"
                          "a cylinder is pulled apart by its ends at a constant rate\n"
                          "a free cylinder rings along its axis in its first mode\n"
                          "two equal cylinders or rings collide, as slabs that repeat along their axes\n"
                          "a piston runs into a plate without strength, a bar that repeats sideways; its shock is "
                          "compared with the exact one",
           .doc = "Protocol: load or impact on the body."),

    BODY(target, .nest = &outline),
    REAL(target.spin, "rad/s", 0, -1e9, 1e9, .when = "kind=impact",
         .doc =
             "The target turns about z before it is hit. Any value but 0 also keeps rotations at sharp edges free of "
             "strain (method.gradient_correction); without spin the bits of earlier versions stay."),
    CHOICE(sides.far, far_sides, .when = "target.shape=box",
           .choice_docs = "free surfaces: waves return\na layer inside all sides but the upper one damps motion: it "
                          "stands for a half-space",
           .doc = "The sides of a box, except the side of the impact."),
    REAL(sides.depth, "m", NAN, 1e-9, 1e9, .flags = FIELD_DERIVED, .when = "sides.far=damped",
         .doc = "Thickness of the damping layer; a tenth of the shortest side unless given. A wave that goes through "
                "it and back keeps about 3 %."),
    BODY(target, .nest = &matter),

    CHOICE(impact.projectile, projectile_by, .when = "kind=impact",
           .choice_docs =
               "projectile.radius and the like\na sphere of impact.mass\na sphere with impact.specific_energy",
           .doc = "Input that decides the projectile's size."),
    REAL(impact.mass, "kg", 2e-4, 1e-30, 1e30, .when = "impact.projectile=mass", .label = "mass of the projectile",
         .doc = "Mass of the projectile."),
    REAL(impact.specific_energy, "J/kg", 1000, 1e-12, 1e12, .when = "impact.projectile=specific-energy",
         .label = "specific impact energy Q",
         .doc = "Q: kinetic energy of the projectile over the target's mass; its mass follows from that and from the "
                "speed."),
    REAL(impact.speed, "m/s", 3200, 0, 1e6, .when = "kind=impact", .label = "impact speed",
         .doc = "Speed of the projectile; the target is at rest.", .source = "BA95 section 5.2"),
    REAL(
        impact.angle, "rad", 0, 0, 1.5707963267948966, .flags = FIELD_BELOW_MAXIMUM, .when = "kind=impact",
        .label = "impact angle",
        .doc =
            "Angle between the flight and the inward normal where the projectile hits (the target's upper side, z). It "
            "flies down and to the side of +x.",
        .source = "BA95 section 5.2"),
    REAL(impact.gap, "m", NAN, 0, 1e9, .flags = FIELD_DERIVED, .when = "kind=impact",
         .doc = "Distance of the projectile's surface from the target's at the start, along the normal; one particle "
                "spacing of the target there unless given."),

    BODY(projectile, .nest = &outline, .own = projectile_outline),
    BODY(projectile, .nest = &matter, .own = projectile_matter, .when = "kind=impact"),

    REAL(stretch.rate, "1/s", 60, 0, 1e9, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=stretch",
         .doc = "Strain rate: the rod starts in uniform stretching, and its grips keep their speeds.",
         .source = "BA95 section 5.1"),
    REAL(stretch.grip, "m", NAN, 0, 1e9, .flags = FIELD_DERIVED | FIELD_ABOVE_MINIMUM, .when = "kind=stretch",
         .doc = "Length of each end that is held and pulled; a twentieth of the rod unless given, three spacings at "
                "least."),
    REAL(stretch.flaw_free, "m", NAN, 0, 1e9, .flags = FIELD_DERIVED, .when = "kind=stretch",
         .doc = "Length of each end, grip included, that has no flaws; a tenth of the rod unless given, one support "
                "beyond the grip at least."),
    REAL(vibration.speed, "m/s", 1, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=vibration",
         .doc = "Speed of the ends at the start."),
    REAL(collision.speed, "m/s", 50, 0, 1e6, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=collision",
         .label = "collision speed", .doc = "Speed of approach; each body has half of it.",
         .source = "Gray, Monaghan & Swift 2001"),
    REAL(collision.gap, "m", NAN, 0, 1e9, .flags = FIELD_DERIVED, .when = "kind=collision",
         .doc = "Distance of the surfaces at the start; two particle spacings unless given."),
    REAL(piston.speed, "m/s", 458, 0, 1e5, .flags = FIELD_ABOVE_MINIMUM, .when = "kind=piston", .label = "piston speed",
         .doc = "Speed of the piston into the plate, along x: four layers of the same matter that keep their velocity.",
         .source = "Jutzi, Benz & Michel 2008 for 458 m/s"),

    {.nest = &modules, .only = "!fidelity"},
    SWITCH(
        method.volume_weights, 0,
        .doc =
            "m_j/rho_j instead of m_j/rho_i in the velocity gradient, for bodies of very different density that touch.",
        .source = "BA95 eq. 18 for off"),
    SWITCH(method.negative_energy, 0, .flags = FIELD_DERIVED, .absent = "false",
           .doc =
               "Keep an internal energy below 0, which errors of a time step make in cold matter; the pressure takes "
               "it as 0. Without it the energy is set to 0, and energy.clamped counts what that adds. Unless given "
               "it is on where no body cracks, yields or has pores: elastic bodies come back to 0 in each cycle.",
           .source = "our choice"),

    REAL(fragments.static_strength, "Pa", NAN, 0, 1e15, .flags = FIELD_DERIVED | FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM,
         .doc = "At the end, damaged particles under more tension than this count as broken: their cracks would still "
                "open. Sound particles stay whole, and so does a target that cannot crack. Unless given: Young's "
                "modulus times the mean strength of the weakest flaw of the whole target. off: no such pass.",
         .source = "BA95 section 4.4; that the particle is damaged is our condition"),
    REAL(fragments.damage, "1", 1, 0, 1, .flags = FIELD_ABOVE_MINIMUM,
         .doc = "Particles with this damage or more do not join fragments.",
         .source = "BA95 section 4.4 (fully damaged)"),
    REAL(fragments.link_length, "1", 1.2, 0.1, 4,
         .doc = "Undamaged particles nearer than this many smoothing lengths belong together. 1 is as printed, but "
                "nearest neighbours of the default lattice stand 0.99 h apart and a strain of 1 % would part them; "
                "from 1.1 to 1.3 h is the same: all nearest neighbours and none farther.",
         .source = "BA95 section 4.4 (1 h)"),
    CHOICE(fragments.link_h, link_h,
           .choice_docs = "of the body at rest\nas it is at the end, where debris has expanded",
           .doc = "The smoothing length that fragments.link_length multiplies."),
    SWITCH(fragments.veneer, 1,
           .doc = "The damaged matter next to a fragment belongs to it. Results tell the largest fragment with and "
                  "without it.",
           .source = "BA95 section 4.4"),
    REAL(fragments.layer_width, "m", 0, 0, 1e9, .absent = "0", .flags = FIELD_DERIVED,
         .doc = "Depth of the damaged layer of a fragment (fragments.veneer). With 0 it is fragments.link_length "
                "smoothing lengths, and gets thinner with more particles. Unless given it is fracture.cell.",
         .source = "our choice; BA95 section 4.4 for 0"),
    REAL(fragments.dust_mass, "kg", NAN, 0, 1e60, .flags = FIELD_DERIVED,
         .doc = "Lighter fragments are dust, for any mass of the particles; a thousandth of the target's mass unless "
                "given. Below complete_mass (10 particles) dust is not resolved: with that default take 10000 "
                "particles or more.",
         .source = "our choice"),

    REAL(crater.ejection_speed, "m/s", 10, 0, 1e6, .when = "kind=impact",
         .doc =
             "At the end, matter that moves out of the target (along the outward normal at the point of impact) faster "
             "than this counts as ejecta, all else as retained: there is no gravity that could separate them. 0: "
             "whatever moves outwards.",
         .source = "Jutzi & Benz, section 3.2, for 0"),
    REAL(crater.escape_speed, "m/s", 0, 0, 1e6, .absent = "0", .when = "kind=impact",
         .doc = "Escape speed of the target. At the end, matter that is slower, in any direction and relative to the "
                "target before the impact, falls back: it counts neither in ejecta.mass_fraction nor in "
                "ejecta.momentum nor in ejecta.momentum_enhancement. 0: a laboratory, where all that moves outwards "
                "leaves. Ejecta must be faster than crater.ejection_speed, too; the crater does not depend on the "
                "escape speed."),
    REAL(stop.end_time, "s", NAN, 0, 1e9, .flags = FIELD_DERIVED | FIELD_ABOVE_MINIMUM,
         .doc = "End time of the run, also if fracture continues; unless given, five times the default of "
                "stop.quiet_time, plus the time until the bodies touch (one spacing later with method.contact: "
                "overlap). Of a plate: when its first front, by the jump conditions, has gone 0.94 of its width."),
    REAL(stop.quiet_time, "s", NAN, 0, 1e9, .flags = FIELD_DERIVED | FIELD_ABOVE_MINIMUM,
         .when = "target.fracture=auto|on",
         .doc =
             "Fracture has ceased, and the run is complete, when the mean damage of all bodies together, and of each "
             "body, has grown by less than stop.quiet_growth for this long, counted from the first damage. Unless "
             "given, the time in which a longitudinal wave crosses the target twice. Of a target that is hit and "
             "bends slowly (length L over thickness h above 4.1), half of the period of a free bar's first mode, which "
             "is "
             "about 0.97 L^2/(h c)."),
    REAL(stop.quiet_growth, "1", 1e-3, 0, 1, .flags = FIELD_ABOVE_MINIMUM, .when = "target.fracture=auto|on",
         .doc = "Fracture counts as over when the mean damage grows by less than this during stop.quiet_time."),

    COUNT(fidelity.particles, 10000, 1, 2e9, .when = "kind=impact|stretch|vibration|collision",
          .label = "number of particles",
          .doc =
              "Number of particles of the target, or of each body of a collision; the lattice may change it a little."),
    COUNT(fidelity.points, 400, 1, 1e6, .when = "kind=piston",
          .doc = "Width of the plate over the particle spacing. The lattice decides the thickness sideways."),
    REAL(fidelity.projectile_spacing, "1", 0.5, 1e-3, 1e3, .when = "kind=impact",
         .doc = "Particle spacing of the projectile over the target's where it hits."),
    SWITCH(fidelity.graded, 0, .when = "kind=impact", .doc = "Particles are finer near the point of impact."),
    REAL(fidelity.spacings_per_radius, "1", NAN, 1e-3, 1e3, .absent = "off", .flags = FIELD_MAY_BE_OFF,
         .when = "fidelity.graded=true",
         .doc = "Particle spacings in the projectile's radius (of a sphere of its volume), near the point of impact. "
                "Decides fidelity.fine_spacing; off: that input decides itself."),
    REAL(fidelity.coarsest, "1", NAN, 1.1, 10, .absent = "off", .flags = FIELD_MAY_BE_OFF,
         .when = "fidelity.graded=true",
         .doc = "Largest particle spacing over the uniform one of as many particles. With fewer particles than "
                "fidelity.spacings_per_radius needs, the zone of the impact gets coarser; off: the far side does, and "
                "too few particles are refused."),
    REAL(fidelity.fine_spacing, "m", NAN, 1e-12, 1e9, .flags = FIELD_DERIVED, .when = "fidelity.graded=true",
         .doc = "Particle spacing near the point of impact. Unless given: by fidelity.spacings_per_radius, or half of "
                "the uniform one."),
    REAL(fidelity.fine_radius, "m", NAN, 0, 1e9, .flags = FIELD_DERIVED, .when = "fidelity.graded=true",
         .doc = "Distance from the point of impact up to which fine_spacing holds; four fine spacings unless given."),
    REAL(fidelity.smoothing, "1", SPH_BODIES_H, 0.7, 3,
         .doc = "Smoothing length h over the particle spacing (V/n)^(1/3). The default has 56 neighbours within 2h on "
                "lattices, and a kernel sum within 1 % of what it stands for; others err by some per cent at any "
                "resolution. Below 0.9 method.gradient_correction is necessary: else stresses and wave speeds are 5 to "
                "39 % too small."),
    REAL(fidelity.cfl, "1", SPH_INPUTS_CFL, SPH_INPUTS_LEAST_CFL, 1, .flags = FIELD_DERIVED,
         .doc = "Courant number: the time step over h/(c + viscous term). Unless given: 0.3, or less where little "
                "viscosity lets waves as short as the spacing grow."),
    REAL(fidelity.skin, "1", 0.05, 0, 1,
         .doc = "Least slack of the neighbour lists over h (fast particles have more): longer lists last for more "
                "steps. It changes the order of sums, not the physics."),
    CHOICE(fidelity.precision, precisions,
           .choice_docs = "double throughout\nstored relative positions and pair sums are float",
           .doc = "Arithmetic of the pair loop."),
    COUNT(fidelity.threads, 1, 1, 1024,
          .doc = "Threads of one run, for a large run on a machine without other work. The bits do not depend on it."),
    REAL(fidelity.energy_bound, "1", 0.01, 0, 1e3, .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM | FIELD_PERCENT,
         .doc = "The run ends with state `energy` when the sum of all energies drifts by more than this share of the "
                "energy put in. "
                "off: it only reports the drift."),
    {.nest = &modules, .only = "fidelity"},
};

static const struct field_table nested = FIELD_TABLE(
    rows, struct sph_inputs, "sph scene",
    "Solids that crack: smoothed particle hydrodynamics with explicit Weibull flaws (Benz & Asphaug 1994, 1995).");
struct field_table sph_inputs;
FIELD_TABLE_AT_START(sph_inputs, nested)
