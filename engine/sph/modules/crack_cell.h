/* Cells of a fixed width that crack as one.
 *
 *   fracture.cell   width of the cells
 *
 * Without this module every particle must fail by a flaw of its own. The threshold of the weakest of them grows as
 * (k V_p)^(-1/m), so strength grows with the number of particles without end. With it, fracture treats the particles of
 * a cell as one particle: they share the flaws in the cell, R_s of the cell's volume, the mean stress and so the
 * damage. Motion is as finely resolved as before. Strength depends on the width of the cells, which is a length of the
 * rock, not of the method (tests/validation/crack_cell.md).
 *
 * Where another module damages the body, too, the bound that pressure sets to D depends on all damage of a particle, so
 * that D by flaws may differ a little within a cell.
 */

MODULE(crack_cell)
MODULE_INPUTS(crack_cell)

#ifdef SPH_MODULE_STRUCTS
struct sph_crack_cell_inputs {
  double width; /* m; 0: off */
};
#endif

COLUMN(crack_stress[5]) /* Pa, what opens the flaws: means over the cell of the particle */
COLUMN(crack_pressure)  /* Pa, likewise */

#ifdef SPH_MODULE_DESCRIPTORS

/* Particles are named by their number within their body, which sorting does not change. */
struct crack_cells {
  size_t count, particles;
  size_t *first;    /* cell k has the particles member[first[k]] ... member[first[k + 1] - 1] */
  uint32_t *member; /* by ascending number */
  uint32_t *index;  /* by number: where the particle stands now */
};

static bool crack_cell_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  return body->flaws != NULL && inputs->crack_cell.width > 0;
}

static void crack_cell_free_prepared(void *prepared) {
  struct crack_cells *c = prepared;
  if (!c)
    return;
  free(c->first);
  free(c->member);
  free(c->index);
  free(c);
}

/* Counting sort by cell. */
static void crack_cell_sort_members(struct crack_cells *c, const uint32_t *cell_of) {
  size_t *next = c->first + 1;
  for (size_t i = 0; i < c->particles; i++)
    next[cell_of[i] + 1]++;
  for (size_t k = 1; k <= c->count; k++)
    next[k] += next[k - 1];
  for (size_t i = 0; i < c->particles; i++)
    c->member[next[cell_of[i]]++] = (uint32_t)i;
}

static status crack_cell_prepare(const struct sph_inputs *inputs, const struct sph_particles *p, struct sph_solid *body,
                                 struct error *error) {
  (void)p;
  const struct sph_cells *given = body->physics.flaws->cells;
  if (!given)
    return status_fail(error, STATUS_CONTENT, "fracture.cell is %g m, but the flaws are those of particles",
                       inputs->crack_cell.width);
  struct crack_cells *c = memory_small(1, sizeof *c);
  c->count = given->count;
  c->particles = given->particles;
  c->first = calloc(c->count + 2, sizeof *c->first);
  c->member = malloc(c->particles * sizeof *c->member);
  c->index = malloc(c->particles * sizeof *c->index);
  if (!c->first || !c->member || !c->index) {
    crack_cell_free_prepared(c);
    return status_fail(error, STATUS_MEMORY, "no memory for the crack cells of %zu particles", given->particles);
  }
  crack_cell_sort_members(c, given->of);
  body->prepared[SPH_MODULE_crack_cell] = c;
  return STATUS_OK;
}

/* Gives the particles of cell k their mean stress, by volume. */
static void crack_cell_average(struct sph_system *s, const struct crack_cells *c, size_t k) {
  double sum[6] = {0}, volume = 0;
  for (size_t m = c->first[k]; m < c->first[k + 1]; m++) {
    const size_t i = c->index[c->member[m]];
    const double own = s->c.mass[i] / s->c.density[i];
    volume += own;
    for (int d = 0; d < 5; d++)
      sum[d] += own * s->c.stress[d][i];
    sum[5] += own * s->c.pressure[i];
  }
  for (size_t m = c->first[k]; m < c->first[k + 1]; m++) {
    const size_t i = c->index[c->member[m]];
    for (int d = 0; d < 5; d++)
      s->c.crack_stress[d][i] = sum[d] / volume;
    s->c.crack_pressure[i] = sum[5] / volume;
  }
}

static void crack_cell_average_stress(struct sph_system *s, const struct sph_solid *body) {
  struct crack_cells *c = body->prepared[SPH_MODULE_crack_cell];
  for (size_t i = body->first; i < body->last; i++)
    c->index[s->id[i] - body->first] = (uint32_t)i;
#pragma omp parallel for schedule(static) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t k = 0; k < c->count; k++)
    crack_cell_average(s, c, k);
}

static void crack_cell_fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
  const struct crack_cells *c = body->prepared[SPH_MODULE_crack_cell];
  const double crack_speed = sph_material_crack_speed(&body->physics.material);
  for (size_t k = 0; k < c->count; k++) {
    double volume = 0;
    for (size_t m = c->first[k]; m < c->first[k + 1]; m++)
      volume += p->mass[body->first + c->member[m]] / p->density[body->first + c->member[m]];
    for (size_t m = c->first[k]; m < c->first[k + 1]; m++)
      s->c.crack_rate[body->first + c->member[m]] = crack_speed / cbrt(3 * volume / (4 * M_PI));
  }
}

static const struct sph_column_need crack_cell_columns[] = {{SPH_COLUMNS_OF(crack_stress), 0, NULL},
                                                            {SPH_COLUMNS_OF(crack_pressure), 0, NULL},
                                                            {0}};

static const struct sph_module crack_cell_module = {
    .name = "crack_cell",
    .doc = "Cells of a fixed width crack as one: their particles share flaws, R_s, mean stress and damage. Strength "
           "depends on the width of the cells, not on the number of particles.",
    .source = "our choice; within a cell the law of Benz & Asphaug 1995. Damage over a fixed length: Pijaudier-Cabot & "
              "Bazant 1987, J. Eng. Mech. 113, 1512",
    .when = "a body whose material has Weibull parameters, with fracture.cell above 0",
    .on = crack_cell_on,
    .columns = crack_cell_columns,
    .bytes_linked = 12,
    .cost = 15, /* basalt sphere of 30 000 particles to 15 us: 6 % of a step */
    .prepare = crack_cell_prepare,
    .free_prepared = crack_cell_free_prepared,
    .meet = crack_cell_average_stress,
    .fill = crack_cell_fill,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_REAL(fracture.cell, crack_cell.width, "m", 0, 0, 1e9, .absent = "0", .when = "target.fracture=auto|on",
           .doc = "Width of the cells that crack as one: their particles share flaws, mean stress and damage. Strength "
                  "then depends on this width and not on the number of particles, where a cell holds several "
                  "particles. 0: each particle cracks by itself, as printed.",
           .source = "our choice; BA95 for 0"),
#endif
