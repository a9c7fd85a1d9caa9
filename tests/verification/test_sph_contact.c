/* One material runs into another: plane nylon on plane basalt at 3.2 km/s, without strength, against the exact answer.
 * Between the two shocks there is one pressure and one velocity, where both materials' Hugoniots meet (impedance
 * matching); so much momentum goes over per area and time. Densities stand 1 : 2.3: the case for `volume_weights`. */
#include "tests/support/sph_solid.h"

static struct sph_material nylon(void) { /* engine/sph/material/builtin/nylon.yaml */
  return (struct sph_material){.density = 1185,
                               .tillotson = {1.01e10, 3.38e10, 0.6, 2, 10, 5, 7e6, 2e6, 2.4e6},
                               .tension_limit.pressure = NAN,
                               .melt_energy = NAN,
                               .weibull = {NAN, NAN}};
}

TEST(nylon_on_basalt) {
  const double speed = 3200, spacing = 1e-4, length = 90 * spacing, thickness = 60 * spacing;
  const struct sph_material target = solid_basalt(), projectile = nylon();
  double low = 0, high = speed;
  for (int it = 0; it < 100; it++) {
    const double v = (low + high) / 2;
    if (solid_hugoniot(&target, v).pressure < solid_hugoniot(&projectile, speed - v).pressure)
      low = v;
    else
      high = v;
  }
  const double velocity = low, pressure = solid_hugoniot(&target, low).pressure;
  print_message("exact: the contact moves at %.1f m/s under %.3f GPa\n", velocity, pressure / 1e9);
  for (int form = 0; form < (SOLID_SLOW ? 1 : 6); form++) {
    const bool cubic = form < 4;
    struct solid_case c = solid_make(2);
    c.physics[0].material = target, c.physics[1].material = projectile;
    c.parameters.in.gradient_correction.on = form & 1, c.parameters.in.method.volume_weights = form & 2;
    solid_bar(&c, cubic ? SPH_LATTICE_CUBIC : SPH_LATTICE_HEXAGONAL, 0, length, spacing, false);
    c.body[1].shape = c.body[0].shape, c.body[1].lattice = c.body[0].lattice;
    c.body[1].shape.side[0] = thickness, c.body[1].shape.centre[0] = length + thickness / 2;
    solid_build(&c, 0);
    struct sph_particles *p = c.particles;
    for (size_t i = 0; i < p->n; i++)
      p->vx[i] = p->body[i] ? -speed : 0;
    solid_start(&c);
    const struct sph_ledger start = sph_system_ledger(c.system);
    const double area = c.body[0].shape.side[1] * c.body[0].shape.side[2];
    const double end = 0.8 * fmin(length / solid_hugoniot(&target, velocity).shock,
                                  thickness / solid_hugoniot(&projectile, speed - velocity).shock);
    enum { SAMPLES = 20 };
    double st = 0, sy = 0, stt = 0, sty = 0, mean[2][3] = {{0}};
    for (int sample = 0; sample < SAMPLES; sample++) {
      const double t = end * (0.5 + 0.5 * sample / (SAMPLES - 1));
      double momentum = 0;
      solid_until(&c, t);
      solid_read(&c);
      for (size_t i = 0; i < p->n; i++)
        if (!p->body[i])
          momentum -= p->mass[i] * p->vx[i];
      st += t, sy += momentum, stt += t * t, sty += t * momentum;
    }
    const double force = (SAMPLES * sty - st * sy) / (SAMPLES * stt - st * st);
    const double contact = length - velocity * end; /* position of the contact now */
    for (size_t i = 0; i < p->n; i++) {
      const double beyond = fabs(p->x[i] - contact);
      if (beyond < 6 * spacing || beyond > 14 * spacing)
        continue;
      mean[p->body[i]][0]++, mean[p->body[i]][1] -= p->vx[i], mean[p->body[i]][2] += p->pressure[i];
    }
    const double pushed = force / area / pressure - 1;
    double off[2][2]; /* by body: velocity, pressure */
    for (int k = 0; k < 2; k++)
      off[k][0] = mean[k][1] / mean[k][0] / velocity - 1, off[k][1] = mean[k][2] / mean[k][0] / pressure - 1;
    const double deviation = solid_energy_error(&c, start) / start.kinetic;
    print_message("%-9s, correction %-3s, volume weights %-3s, n %zu: force %+.2f %%; velocity %+.2f, %+.2f %%; "
                  "pressure %+.2f, %+.2f %%; energy "
                  "error %.1e\n",
                  cubic ? "cubic" : "hexagonal", form & 1 ? "on" : "off", form & 2 ? "on" : "off", p->n, 100 * pushed,
                  100 * off[0][0], 100 * off[1][0], 100 * off[0][1], 100 * off[1][1], deviation);
    assert_true(fabs(deviation) < 0.005); /* the bound for impacts; the others are that for shocks, and half of it */
    assert_true(fabs(pushed) < 0.01);
    for (int k = 0; k < 2; k++)
      assert_true(fabs(off[k][0]) < 0.005 && fabs(off[k][1]) < 0.01);
    solid_end(&c);
  }
}
