/* Effect of pores on craters. Jutzi & Benz, section 3: porous ice against the same ice without pores at 10 km/s (far
 * less is thrown out; alpha is 1 near the crater only and rises to alpha_0), and a polymer bullet into very porous
 * matter (the crater is made by compaction).
 *
 * Quick: 2 seeds. CLAST_FULL=1: 10 seeds. Each seed is shown, and the ratio with its
 * interval. The criterion applies to the mean, not to every seed (a seed with the opposite result is a finding). */

#include "engine/fragments.h"
#include "engine/outcome.h"
#include "engine/scene.h"
#include "engine/sph/observe/results.h"
#include "engine/sph/run/run.h"
#include "tests/support/check.h"

static bool full(void) {
  const char *text = getenv("CLAST_FULL");
  return text && !strcmp(text, "1");
}

struct result {
  struct outcome outcome;
  struct sph_results sph;
  struct sph_crater_layer axis[200];
  size_t layers;
};

/* Even spacing, a projectile of 1 g and 200 us: those of the page's figures; half the spacing in the projectile. */
static struct result run(const char *name, uint64_t seed, const char *particles, bool even) {
  struct result r = {0};
  struct scene *scene;
  void *made = NULL;
  OWNED struct fragment *fragments = NULL;
  size_t count;
  bool finished = false;
  if (scene_load(name, NULL, &scene, &error) || scene_set_text(scene, "fidelity.particles", particles, &error) ||
      (even && (scene_set_text(scene, "fidelity.graded", "false", &error) ||
                scene_set_text(scene, "fidelity.projectile_spacing", "0.5", &error) ||
                scene_set_text(scene, "impact.mass", "1 g", &error) ||
                scene_set_text(scene, "stop.end_time", "200 us", &error))) ||
      scene_check(scene, &error) || scene->kind->prepare(scene->inputs, seed, &made, &error))
    fail_msg("%s: %s", name, error.message);
  while (!finished)
    OK(scene->kind->step(made, 1000, &finished, &error));
  OK(scene->kind->finish(made, &r.outcome, &r.sph, &fragments, &count, &error));
  struct sph_run *inside = made;
  struct sph_crater_options options = sph_report_crater_options(inside);
  r.layers = sph_crater_profile(inside->start, inside->now, &options, r.axis, sizeof r.axis / sizeof r.axis[0]);
  scene->kind->free(made);
  scene_free(scene);
  if (!(r.outcome.energy_error < 0.005))
    fail_msg("%s: energy is off by %g", name, r.outcome.energy_error);
  return r;
}

TEST(ice) {
  const int seeds = full() ? 10 : 2;
  double sum = 0, squares = 0;
  for (int seed = 1; seed <= seeds; seed++) {
    struct result porous = run("porous-ice", (uint64_t)seed, "8000", true);
    struct result solid = run("solid-ice", (uint64_t)seed, "8000", true);
    double thrown = porous.sph.ejecta.mass_fraction * porous.sph.target_mass;
    double of_solid = solid.sph.ejecta.mass_fraction * solid.sph.target_mass, ratio = log(thrown / of_solid);
    sum += ratio;
    squares += ratio * ratio;
    print_message(
        "seed %2d: ejected %.4f kg of porous ice, %.4f kg of solid ice (%.2f), momentum %.1f and %.1f kg m/s; damage "
        "%.2f and %.2f; porous: %.3f kg compacted, crater %.3g m^3, share of compaction %.2f\n",
        seed, thrown, of_solid, thrown / of_solid, porous.sph.ejecta.momentum, solid.sph.ejecta.momentum,
        porous.sph.mean_damage, solid.sph.mean_damage,
        porous.sph.palpha.compaction.mass_fraction * porous.sph.target_mass, porous.sph.crater.volume,
        porous.sph.crater.compaction_share);
    assert_true(isnan(solid.sph.palpha.compaction.mass_fraction)); /* no pores that could be compacted */
    for (size_t k = 0; seed == 1 && k < porous.layers; k++)
      print_message("  depth %.3f m: alpha %.4f, D %.2f\n", porous.axis[k].depth, porous.axis[k].distention,
                    porous.axis[k].damage);
    /* alpha = 1 near the crater only: not deeper than its bottom, while pores were lost far beyond. Layers refer to the
     * depth at the start. Matter above was pushed aside, so alpha need not rise from layer to layer. */
    assert_true(porous.sph.palpha.compaction.mass_fraction > 0);
    assert_true(porous.sph.palpha.compaction.depth < porous.sph.crater.depth);
    assert_true(porous.sph.palpha.compaction.reach > 3 * porous.sph.palpha.compaction.depth);
    assert_true(porous.layers > 5);
    double lowest = 1.5, last = porous.axis[porous.layers - 1].distention; /* rising to alpha_0 = 1.5 */
    for (size_t k = 0; k < porous.layers; k++)
      lowest = fmin(lowest, porous.axis[k].distention);
    assert_true(last > 1.45 && last > lowest);
    assert_true(porous.sph.palpha.compaction.mass_fraction < 0.05); /* alpha = 1 near the crater only */
  }
  double mean = sum / seeds,
         standard_error = seeds > 1 ? sqrt(fmax(0, squares / seeds - mean * mean) / (seeds - 1)) : 0;
  print_message("ejected mass, porous over solid: %.3f (%.3f to %.3f, two standard errors, %d seeds)\n", exp(mean),
                exp(mean - 2 * standard_error), exp(mean + 2 * standard_error), seeds);
  assert_true(exp(mean) < 0.67); /* less than its lower density alone (1/1.5) would give */
}

TEST(target) {
  struct result r = run("porous-target", 1, full() ? "20000" : "8000", false);
  print_message("porous target: crater %.4f m deep, radius %.4f m, %.3g m^3; share of compaction %.3f; ejected %.4f "
                "kg, %.3f kg m/s; "
                "compacted %.4f kg\n",
                r.sph.crater.depth, r.sph.crater.radius, r.sph.crater.volume, r.sph.crater.compaction_share,
                r.sph.ejecta.mass_fraction * r.sph.target_mass, r.sph.ejecta.momentum,
                r.sph.palpha.compaction.mass_fraction * r.sph.target_mass);
  assert_true(r.sph.crater.compaction_share > 0.5); /* mostly compaction */
  assert_true(r.sph.crater.volume > 0 && r.sph.crater.depth > 0.01);
}

/* A deviator that crushing matter holds while strain takes from it gives back more than it took: 2e-4 of the energy
 * here, 2e-3 with the gradient correction. */
TEST(crushing_makes_no_energy) {
  struct result r = run("pumice-sphere", 1, "1000", false);
  assert_true(r.sph.clamped_share == 0);
  assert_true(fabs(r.outcome.energy_error) < 1e-3);
}
