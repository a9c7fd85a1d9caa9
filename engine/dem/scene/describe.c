/* Text for `clast explain` and `clast plan`: the model of a scene with reasons, and its numbers beside others. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/dem/run/run.h"
#include "engine/dem/step/system_layout.h"
#include "schemas/memory.h"
#include "schemas/text.h"

enum { MEASURED_UP_TO = 20000 }; /* grains; larger bodies are not built for a description */
static const double SPEED = 1e7; /* grain-steps of one core in a second; bench_dem measures 0.95e7 to 1.34e7 */

/* Square lattice along its rows: beams have modulus E; a contact pressed by d has the force Y d S/L_c with S = s and
 * L_c = 2 s/sqrt(pi), the diameter of the circle of area s^2, hence the modulus Y sqrt(pi)/2. */
void dem_describe_sound_speeds(const struct dem_inputs *in, double *extension, double *compression) {
  bool contact = in->contact.law != DEM_CONTACT_OFF && in->contact.bonded;
  *extension = sqrt(in->beam.young_modulus / in->grain.density);
  *compression = sqrt((in->beam.young_modulus + (contact ? in->grain.young_modulus * 0.88622692545275801 : 0)) /
                      in->grain.density);
}

/* Two squares of side s face on, with d = 2 s/sqrt(pi). Pushed through each other they take up at most the work of the
 * law's spring over the way s. Their kinetic energy is rho s^2 v^2 / 4. Here s = 1. */
double dem_describe_passing_speed(const struct dem_inputs *in) {
  const double d = 2 / sqrt(M_PI);
  const double spring = dem_laws_spring(in->contact.law,
                                        dem_laws_coefficient(in->contact.law, 1 / d,
                                                             dem_assemble_reference_side(0, d, d)),
                                        1);
  return sqrt(2 * spring * in->grain.young_modulus / in->grain.density);
}

static void protocol(const struct dem_inputs *in, FILE *out) {
  switch ((enum dem_kind)in->kind) {
  case DEM_DISC_EXPLOSION:
    fprintf(out,
            "disc-explosion: a charge of %.4g J/m in the central grain, which it burns; its neighbours fly off\n"
            "  perpendicular to the common sides, with a speed proportional to side over mass (K99 section 3.3.1)\n",
            in->charge.energy);
    break;
  case DEM_BLOCK_IMPACT:
    fprintf(out,
            "block-impact: the middle grain of the lower side is shot into the block at %.4g m/s (K99 section 3.3.2)\n",
            in->impact.speed);
    break;
  case DEM_UNIAXIAL:
    fprintf(out,
            "uniaxial: lower and upper row move %s at strain rate %.4g /s, free to slide sideways (K99 section 3.1)\n",
            in->loading.direction == DEM_EXTENSION ? "apart" : "together", in->loading.rate);
    break;
  case DEM_COMPRESSION:
    fprintf(out, "compression: confined lower and upper row move together at strain rate %.4g /s (K99 section 3.2)\n",
            in->loading.rate);
    break;
  case DEM_DISC_COLLISION:
    fprintf(out, "disc-collision: two equal %s approach at %.4g m/s, impact parameter %.4g diameters\n",
            field_is_off(in->body.wall) ? "discs" : "rings", in->collision.speed, in->collision.impact_parameter);
    break;
  case DEM_RING_EXPLOSION:
    fprintf(out, "ring-explosion: all grains start outwards, with %.4g /s times their distance from the middle\n",
            in->expansion.rate);
    break;
  case DEM_KINDS: break;
  }
}

static void model(const struct dem_inputs *in, FILE *out) {
  fprintf(out, "  beams: yes, E %.4g Pa\n", in->beam.young_modulus);
  if (!in->threshold.breaking)
    fprintf(out, "  breaking: no (threshold.breaking is false)\n");
  else if (field_is_off(in->threshold.modulus))
    fprintf(out, "  breaking: strain %.4g, angle %.4g deg, the same for all beams\n", in->threshold.strain,
            in->threshold.angle * 57.295779513082323);
  else
    fprintf(out, "  breaking: thresholds drawn per beam, Weibull modulus %.4g about strain %.4g, angle %.4g deg\n",
            in->threshold.modulus, in->threshold.strain, in->threshold.angle * 57.295779513082323);
  if (in->contact.law == DEM_CONTACT_OFF) {
    fprintf(out, "  contact: no (contact.law is off): grains pass through each other\n");
    return;
  }
  fprintf(out, "  contact: %s law, Y %.4g Pa, bonded neighbours %s\n", dem_laws_names[in->contact.law],
          in->grain.young_modulus, in->contact.bonded ? "too" : "not");
  fprintf(out, "  limit of the model: single grains that close in faster than about %.0f m/s pass through each other\n",
          dem_describe_passing_speed(in));
  bool damped = in->contact.normal_damping > 0 || in->contact.tangential_damping > 0;
  if (damped)
    fprintf(out, "  damping: normal %.4g /s, tangential %.4g /s, friction %.4g, bonded neighbours %s\n",
            in->contact.normal_damping, in->contact.tangential_damping, in->contact.friction,
            in->contact.damping_bonded ? "too" : "not");
  else
    fprintf(out, "  damping: no\n");
}

static double energy_put_in(const struct dem_inputs *in) {
  double area = in->grain.spacing * in->grain.spacing;
  switch ((enum dem_kind)in->kind) {
  case DEM_DISC_EXPLOSION: return in->charge.energy;
  case DEM_BLOCK_IMPACT: return 0.5 * in->grain.density * area * in->impact.speed * in->impact.speed;
  case DEM_DISC_COLLISION:
    return 0.125 * in->grain.density * dem_inputs_grains(in) * area * in->collision.speed * in->collision.speed;
  case DEM_RING_EXPLOSION: /* mass and mean square of the distance of a ring */
    return 0.25 * in->grain.density * dem_inputs_grains(in) * area * in->expansion.rate * in->expansion.rate *
           (in->body.diameter * in->body.diameter / 4 + dem_inputs_hole(in) * dem_inputs_hole(in));
  case DEM_UNIAXIAL:
  case DEM_COMPRESSION:
  case DEM_KINDS: break;
  }
  return NAN;
}

/* Builds the body of seed 1 and describes it: counts, the energy of its beams, the stability limit. Returns its number
 * of grains; 0: it cannot be built. */
static size_t body(const struct dem_inputs *in, FILE *out) {
  struct dem_inputs probe = *in;
  probe.fidelity.time_step = 1e-15; /* any step is good enough to build the body */
  probe.stop.end_time = 1e-12;
  probe.impact.speed = 1;
  if (dem_inputs_loaded(&probe))
    probe.kind = DEM_BLOCK_IMPACT; /* the same body without a stress-strain record */
  struct dem_run *run = NULL;
  struct error error = {0};
  if (dem_run_create(&probe, 1, &run, &error)) {
    fprintf(out, "  cannot be run: %s\n", error.message);
    return 0;
  }
  const size_t grains = run->tessellation->cell_count;
  const double energy = energy_put_in(in), needed = run->threshold_energy;
  const double step = in->fidelity.time_step, limit = run->stable_time_step;
  fprintf(out, "  grains: %zu, beams: %zu (seed 1)\n", grains, run->tessellation->pair_count);
  if (isnan(energy) && !isnan(needed))
    fprintf(out, "  every beam at its strain threshold would hold %.4g J/m\n", needed);
  else if (!isnan(energy) && isnan(needed))
    fprintf(out, "  energy put in: %.4g J/m\n", energy);
  else if (!isnan(energy))
    fprintf(out, "  energy put in: %.4g J/m; every beam at its strain threshold would hold %.4g J/m (ratio %.3g)\n",
            energy, needed, energy / needed);
  fprintf(out, "  time step: %.4g s, stability limit %.4g s (ratio %.2g)%s\n", step, limit, step / limit,
          step > limit ? ": UNSTABLE, will be refused" : "");
  dem_run_free(run);
  return grains;
}

char *dem_describe_scene(const void *inputs, bool all) {
  (void)all;
  const struct dem_inputs *in = inputs;
  char *text = NULL, *rest = NULL;
  FILE *out = text_open(&rest);
  model(in, out);
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  fprintf(out, "  sound speed (estimate along a square lattice): %.0f m/s in extension, %.0f m/s in compression\n",
          extension, compression);

  double grains = dem_inputs_grains(in);
  size_t built = 0;
  if (grains > MEASURED_UP_TO)
    fprintf(out, "  grains: about %.0f; too many to measure stability and energies for a description\n", grains);
  else
    built = body(in, out);
  if (built)
    grains = (double)built;
  OWNED char *details = text_close(out, &rest);

  const double steps = dem_inputs_end_time(in) / in->fidelity.time_step;
  out = text_open(&text);
  protocol(in, out);
  fprintf(out, "  at most %.3g steps of %.3g grains, ", steps, grains);
  text_duration(steps * grains / SPEED, out);
  fprintf(out, " of a core that does %.2g grain-steps a second\n\n%s", SPEED, details ? details : "");
  OWNED char *plain = text_close(out, &text);
  return plain && details ? text_people(plain) : NULL;
}

double dem_describe_stable_step(const struct dem_inputs *in) {
  double extension, compression;
  dem_describe_sound_speeds(in, &extension, &compression);
  /* The shortest in 40 discs of 8 cm and 40 of 20 cm, for each of five values of disorder: within 5 %. */
  const double verlet = 0.95 * (1 - 0.5 * in->grain.disorder * in->grain.disorder) * in->grain.spacing / compression;
  return in->fidelity.integrator == DEM_GEAR ? 0.27 * verlet : verlet;
}

double dem_describe_damping(const struct dem_inputs *in) {
  if (in->contact.law == DEM_CONTACT_OFF)
    return 0;
  const double sliding = in->contact.friction > 0 ? in->contact.tangential_damping : 0; /* Coulomb bounds it */
  return fmax(in->contact.normal_damping, sliding);
}
