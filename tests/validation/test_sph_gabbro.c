/* The gabbro cube of Benz & Asphaug 1995 [BA95] section 5.3: speed of longitudinal waves after the impact, against
 * distance.
 *
 * c_p(r) = sqrt((K + 4 mu (1-D)/3)/rho), the mean over the matter that was in a shell of 1 cm round the point of impact
 * before the impact. The experiment (Ahrens & Rubin 1993): damage falls as about r^-1.5 from the crater on. The paper:
 * m = 3 falls within the measurements; m = 6 and 9 do not for any k. Here k of m = 6 and 9 is such that about half of
 * the matter at 7.5 cm is damaged, as with m = 3 (at each number of particles: the smaller a particle, the stronger, by
 * an amount that depends on m), and the test compares the decrease of damage round that place; the points of the
 * paper's figure 6 are not printed in it.
 *
 * Far sides are damped. One run has the cube's free sides, which reflect waves: within 7 cm this must change nothing,
 * and beyond it the cube has spalls near its edges, as in the paper's figure 5. To 50 us; a wave crosses the cube in 31
 * us, and the damped box takes no more damage after 40 us.
 *
 * Quick: a coarse cube, m = 3 and 9. CLAST_FULL=1: 45 000 particles, m = 6, and the paper's 80 000 evenly spaced on a
 * lattice, with c_p halfway between floor and sound rock at 4.8 to 5.6 cm (the paper: "centered around r = 4 cm").
 * CLAST_PARTICLES=n changes the number of the graded ones, CLAST_EVEN=n that of the evenly spaced ones, CLAST_SEEDS=n
 * takes the mean of n seeds for m = 3 in the half-space. */
#include "tests/support/run_case.h"

#include "analysis/statistics/statistics.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"

enum { SHELLS = 14, FIRST = 5, LAST = 9, MOST_SEEDS = 1000 };
static const double shell = 0.01;

struct cratered {
  double damage[SHELLS], speed[SHELLS], mean; /* speed over that of sound rock */
  double exponent;                            /* of D ~ r^-exponent from 5 to 10 cm */
  double exponent_3_8;                        /* from 3 to 8 cm, where D is 1 to begin with */
  double halfway;                             /* m: where the speed lies halfway between floor and sound rock */
  size_t particles;
};

static const double sound_rock = 6503;    /* m/s */
static const double floor_speed = 0.7557; /* sqrt(K/(K + 4 mu/3)), K 71, mu 40 GPa: no shear modulus is left */

static double falls_as(const double *damage, int first, int last) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (int k = first; k <= last; k++) {
    const double u = log((k + 0.5) * shell), v = log(damage[k]);
    n++, x += u, y += v, xx += u * u, xy += u * v;
  }
  return -(n * xy - x * y) / (n * xx - x * x);
}

static double halfway(const double *speed) {
  const double half = (1 + floor_speed) / 2;
  for (int s = 1; s < SHELLS; s++)
    if (speed[s - 1] < half && speed[s] >= half)
      return shell * (s - 0.5 + (half - speed[s - 1]) / (speed[s] - speed[s - 1]));
  return NAN;
}

/* `even`: number of particles on an even lattice, as text; NULL: graded particles. */
struct rock {
  const char *m, *k, *far, *even;
};

static struct sph_inputs inputs_of(const struct rock *rock) {
  char options[6][64];
  const char *asked = getenv("CLAST_PARTICLES");
  snprintf(options[0], sizeof options[0], "target.material.weibull.m=%s", rock->m);
  snprintf(options[1], sizeof options[1], "target.material.weibull.k=%s 1/m^3", rock->k);
  snprintf(options[2], sizeof options[2], "sides.far=%s", rock->far);
  snprintf(options[3], sizeof options[3], "fidelity.particles=%s",
           rock->even        ? rock->even
           : asked           ? asked
           : run_case_full() ? "45000"
                             : "8000");
  snprintf(options[4], sizeof options[4], "fidelity.%s",
           rock->even        ? "graded=false"
           : run_case_full() ? "fine_spacing=1 mm"
                             : "fine_spacing=2 mm");
  snprintf(options[5], sizeof options[5], "target.lattice=%s", rock->even ? "hexagonal" : "irregular");
  return SPH_CASE("gabbro-crater", options[0], options[1], options[2], options[3], options[4], options[5],
                  "stop.end_time=50 us");
}

/* Adds this run's shells, over `seeds`, to `c`; returns where its own speed is halfway between floor and sound rock, m.
 */
static double add_run(const struct sph_inputs *inputs, uint64_t seed, size_t seeds, struct cratered *c) {
  struct sph_run *run;
  OK(sph_run_create(inputs, seed, &run, &error));
  while (!run->state.frame.finished)
    frame_advance(&run->frame, 1000);
  assert_int_equal(run->state.frame.outcome_state, OUTCOME_END_TIME); /* damage grew within the last two crossings */

  const struct sph_particles *now = sph_run_read(run), *start = run->start;
  const double K = sph_material_bulk_modulus(&inputs->target.material),
               mu = inputs->target.material.elastic.shear_modulus;
  double mass[SHELLS] = {0}, damage[SHELLS] = {0}, speed[SHELLS] = {0};
  for (size_t i = 0; i < run->targets; i++) {
    const double up = inputs->target.height / 2 - start->z[i];
    const double r = sqrt(start->x[i] * start->x[i] + start->y[i] * start->y[i] + up * up),
                 d = pow(now->damage_cbrt[i], 3);
    if (r >= SHELLS * shell)
      continue;
    const int s = (int)(r / shell);
    mass[s] += now->mass[i];
    damage[s] += now->mass[i] * d;
    speed[s] += now->mass[i] * sqrt((K + 4 * mu * (1 - d) / 3) / (K + 4 * mu / 3));
  }
  for (int s = 0; s < SHELLS; s++) {
    speed[s] /= mass[s];
    c->damage[s] += damage[s] / mass[s] / (double)seeds;
    c->speed[s] += speed[s] / (double)seeds;
  }
  c->mean += sph_system_damage(run->system, 0, run->system->body_count) / (double)seeds;
  c->particles = run->targets;
  sph_run_free(run);
  return halfway(speed);
}

/* The mean of `seeds` runs. */
static struct cratered crater(struct rock rock, size_t seeds) {
  const struct sph_inputs inputs = inputs_of(&rock);
  struct cratered c = {0};
  double half[MOST_SEEDS];
  for (size_t seed = 1; seed <= seeds; seed++)
    half[seed - 1] = add_run(&inputs, seed, seeds, &c);
  print_message("m %s, k %s /m^3, sides %s, %zu particles, %s, seeds 1 to %zu: mean damage %.3f\n  r, cm   ", rock.m,
                rock.k, rock.far, c.particles, rock.even ? "even" : "graded", seeds, c.mean);
  for (int s = 0; s < SHELLS; s++)
    print_message(" %5.1f", 100 * (s + 0.5) * shell);
  print_message("\n  damage  ");
  for (int s = 0; s < SHELLS; s++)
    print_message(" %5.3f", c.damage[s]);
  print_message("\n  c_p, m/s");
  for (int s = 0; s < SHELLS; s++)
    print_message(" %5.0f", sound_rock * c.speed[s]);
  c.exponent = falls_as(c.damage, FIRST, LAST);
  c.exponent_3_8 = falls_as(c.damage, 3, 7);
  const struct sample_summary place = sample_summarise(seeds, half, 0.95);
  c.halfway = place.mean;
  print_message("\n  damage falls as r^-%.2f from 5 to 10 cm, r^-%.2f from 3 to 8 cm; c_p is halfway at %.2f cm",
                c.exponent, c.exponent_3_8, 100 * c.halfway);
  if (seeds > 1)
    print_message(" +- %.2f (95 %%)", 100 * place.half_width);
  print_message("\n");
  return c;
}

TEST(speed_of_waves) {
  const size_t seeds = run_case_seeds(1, 1);
  const struct cratered three = crater((struct rock){"3", "1.39e18", "damped", NULL}, seeds);
  const struct cratered nine = crater((struct rock){"9", run_case_full() ? "7e40" : "2e41", "damped", NULL}, 1);
  for (int s = 0; s < 3; s++)
    assert_true(fabs(three.speed[s] / floor_speed - 1) < 0.01); /* "severely damaged" */
  for (int s = FIRST; s < LAST; s++)
    assert_true(three.speed[s] < three.speed[s + 1]);
  assert_true(three.speed[12] > 0.93);
  /* The experiment's 1.5; steeper by up to 1 as D of this model begins at 1 there. It is 1.4 to 2.3 at 6000 to 45 000
   * particles, and 4 and more for m = 9: flaws of more similar strength give a sharper edge of the broken zone. */
  assert_true(three.exponent > 1 && three.exponent < 2.5);
  assert_true(nine.exponent > three.exponent + 1);
  if (run_case_full())
    assert_true(crater((struct rock){"6", "3e29", "damped", NULL}, 1).exponent > three.exponent + 0.5);
  const struct cratered cube = crater((struct rock){"3", "1.39e18", "free", NULL}, 1);
  /* a wave to the nearest side and back to this place travels 23 cm; its tension is weak by then */
  for (int s = 0; s < 7; s++)
    assert_true(fabs(three.damage[s] - cube.damage[s]) < 0.05);
  assert_true(cube.mean >
              three.mean + 0.08); /* spalls near the edges: 0.16 of the cube at either number of particles */

  if (!run_case_full())
    return; /* with fewer particles the projectile would have none: here it is one particle */
  const char *asked = getenv("CLAST_EVEN"), *number = asked ? asked : "80000";
  const struct cratered even = crater((struct rock){"3", "1.39e18", "damped", number}, seeds);
  assert_true(asked || (even.halfway > 0.048 && even.halfway < 0.056)); /* of 80 000: 5.2 cm; seeds within 0.1 */
  assert_true(even.damage[2] > 0.98 && even.speed[9] > 0.97);
}
