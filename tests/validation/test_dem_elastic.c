/* Elastic moduli of the grain and beam solid (K99 section 3.1, figures 5 and 6): K linear in E under extension, stiffer
 * under compression by a step that no longer grows at large E; nu larger under compression, above 1 at small cohesion,
 * both tending to the pure beam lattice's. Prints the table; dem_elastic.md quotes it.
 *
 * Quick: one body of 16 x 24 grains. CLAST_FULL=1: three bodies of 25 x 40. */
#include "tests/support/run_case.h"

enum { MODULI = 6 };

struct moduli {
  double k, nu;
};

static struct moduli measure(double beam_modulus, bool extension, bool contact, double disorder, uint64_t seed) {
  struct dem_inputs in = DEM_CASE("uniaxial", NULL);
  if (!run_case_full()) {
    in.body.columns = 16;
    in.body.rows = 24;
  }
  in.beam.young_modulus = beam_modulus;
  in.grain.disorder = disorder;
  in.loading.direction = extension ? DEM_EXTENSION : DEM_SHORTENING;
  if (!contact)
    in.contact.law = DEM_CONTACT_OFF;
  /* Slow compared with sound: the load takes 10 times as long as a wave along the body, after a rise of 5 such times.
   */
  double wave = (double)in.body.rows * in.grain.spacing / sqrt(beam_modulus / in.grain.density);
  in.loading.strain_end = 2e-3;
  in.loading.rate = in.loading.strain_end / (10 * wave);
  in.loading.ramp = 5 * wave;
  /* a fifth of the square lattice's limit 2/omega_max = spacing sqrt(rho/modulus) (beams and contacts) or less */
  in.fidelity.time_step = 0.2 * in.grain.spacing *
                          sqrt(in.grain.density / (beam_modulus + 0.9 * in.grain.young_modulus));
  struct ran ran = run_case_run(&dem_engine, &in, seed);
  assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
  assert_int_equal(ran.results.dem.stop_reason, 3); /* strain */
  free(ran.fragments);
  return (struct moduli){ran.results.dem.young_modulus, ran.results.dem.poisson_ratio};
}

TEST(square_lattice_is_exact) {
  /* Rows of aligned beams of modulus E, nothing across: K = E, nu = 0. What remains are vibrations of the start: 0.2 %.
   */
  struct moduli m = measure(5e8, true, true, 0, 1);
  print_message("square lattice pulled: K/E %.6f, nu %.2e\n", m.k / 5e8, m.nu);
  assert_true(fabs(m.k / 5e8 - 1) < 2e-3);
  assert_true(fabs(m.nu) < 1e-6);
  /* Pressed: contacts of the conservative law have the modulus of the printed one, Y sqrt(pi)/2, in series with none.
   */
  m = measure(5e8, false, true, 0, 1);
  double expected = 5e8 + 1e9 * 0.88622692545275801;
  print_message("square lattice pressed: K/(E + Y sqrt(pi)/2) %.6f\n", m.k / expected);
  assert_true(fabs(m.k / expected - 1) < 1e-2); /* contacts stiffen with overlap: strain 2e-3, and vibrations */
}

TEST(trends) {
  const double e[MODULI] = {1e8, 2e8, 5e8, 1e9, 2e9, 4e9}; /* figures 5 and 6: 1e9 to 4e10 dyn/cm^2 at Y = 1e10 */
  struct moduli pulled[MODULI] = {0}, pressed[MODULI] = {0}, beams[MODULI] = {0};
  int bodies = (int)run_case_seeds(1, 3);
  print_message("%10s %12s %12s %12s %8s %8s %8s\n", "E, Pa", "K_ext, Pa", "K_comp, Pa", "K_beams, Pa", "nu_ext",
                "nu_comp", "nu_beams");
  for (int k = 0; k < MODULI; k++) {
    for (int seed = 1; seed <= bodies; seed++) {
      struct moduli m[3] = {measure(e[k], true, true, 1, (uint64_t)seed), measure(e[k], false, true, 1, (uint64_t)seed),
                            measure(e[k], true, false, 1, (uint64_t)seed)};
      struct moduli *sums[3] = {&pulled[k], &pressed[k], &beams[k]};
      for (int i = 0; i < 3; i++) {
        sums[i]->k += m[i].k / bodies;
        sums[i]->nu += m[i].nu / bodies;
      }
    }
    print_message("%10.3g %12.5g %12.5g %12.5g %8.4f %8.4f %8.4f\n", e[k], pulled[k].k, pressed[k].k, beams[k].k,
                  pulled[k].nu, pressed[k].nu, beams[k].nu);
  }
  for (int k = 0; k < MODULI; k++) {
    assert_true(pressed[k].k > pulled[k].k);   /* "the solid is more stiff under compression" */
    assert_true(pressed[k].nu > pulled[k].nu); /* figure 6 */
    /* the beam lattice alone has no scale except E: the only differences are vibrations of the start */
    assert_true(fabs(beams[k].k / e[k] / (beams[0].k / e[0]) - 1) < 0.01);
    assert_true(k == 0 || pulled[k].k > pulled[k - 1].k);
  }
  /* "K is a linear function of E": the slope at large E against the mean slope above 5e8. Overlaps across the load, in
   * a pulled body that contracts, bend it at small E. */
  double slope_high = (pulled[5].k - pulled[4].k) / (e[5] - e[4]),
         slope_low = (pulled[4].k - pulled[2].k) / (e[4] - e[2]);
  print_message("slope of K_ext(E): %.4f up to 2e9 Pa, %.4f beyond\n", slope_low, slope_high);
  assert_true(fabs(slope_high / slope_low - 1) < 0.1);
  /* "For large E the elongation and compression curves are parallel" */
  double parallel = (pressed[5].k - pressed[4].k) / (pulled[5].k - pulled[4].k);
  print_message("slope of K_comp over slope of K_ext beyond 2e9 Pa: %.4f\n", parallel);
  assert_true(fabs(parallel - 1) < 0.15);
  /* small cohesion: nu above 1, K below Y; large E: towards the beams */
  print_message("smallest E: nu_comp %.3f, K_comp/Y %.3f\n", pressed[0].nu, pressed[0].k / 1e9);
  assert_true(pressed[0].k < 1e9);
  assert_true(fabs(pressed[5].nu - beams[5].nu) < fabs(pressed[0].nu - beams[0].nu));
  assert_true(fabs(pulled[5].nu - beams[5].nu) < fabs(pulled[0].nu - beams[0].nu));
}
