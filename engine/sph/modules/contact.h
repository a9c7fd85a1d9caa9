/* Contact of different bodies: they press on each other, and do nothing else.
 *
 *   method.contact   overlap turns the module on
 *
 * Without it a pair of two bodies acts as a pair of one: bodies that touch are welded, and feel each other over a gap
 * of two smoothing lengths. With it the pair loop leaves these pairs out, so that gradients, corrections and stresses
 * of a body are its own. Overlap has an energy instead,
 *
 *   E = sum_i V_i K_i/2 o_i^2,   o_i = max(0, n_i - n*_i),   n_i = sum_j V_j W_ij over the particles of other bodies,
 *
 * and its gradient is the force: with the pressures p_i = K_i o_i of the contact
 *
 *   m_i dv_i/dt = -sum_j V_i V_j (p_i + p_j) grad_i W
 *
 * n*_i is what the own body leaves of its surroundings at the start, 0.9 - sum V_j W_ij over its own particles: at 0.9
 * contact begins shortly before the lattices of two surfaces would continue each other. V, h and K = rho c^2 are those
 * of the start. So E depends on positions alone and goes back into motion whole; momentum and angular momentum are
 * kept, since the force of a pair is central. The ledger has E as an account of its own.
 *
 * The viscosity of such a pair grows with the pressure of the contact, so that slow bodies lose next to nothing:
 *
 *   Pi_ij = (alpha c' mu_ij + beta mu_ij min(mu_ij, c'))/rho,   c'^2 = (p_i + p_j)/(rho_i + rho_j)
 *
 * with Monaghan's mu_ij. Its heat goes to both halves. */

MODULE(contact)
MODULE_HOOKS(contact)
MODULE_INPUTS(contact)
MODULE_RESULTS(contact)
MODULE_REPORT(contact)

COLUMN(contact_room) /* n*, 1 */

#ifdef SPH_MODULE_STRUCTS
enum sph_contact_rule { SPH_CONTACT_WELDED, SPH_CONTACT_OVERLAP, SPH_CONTACTS };
struct sph_contact_inputs {
  int rule; /* enum sph_contact_rule */
};
struct sph_contact_results {
  double energy; /* J */
};
#endif

#ifdef SPH_MODULE_LOOPS

/* Adds what the particles of a block get from other bodies to their sums. */
RANGE_HOOK void contact_add(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  const struct sph_foreign *f = sph_pairs_foreign(s->pairs);
  size_t low = 0, high = f->count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (f->row[middle].particle < b->low)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < f->count && f->row[low].particle < b->high; low++) {
    const struct sph_touch *t = &s->touch[low];
    const size_t k = f->row[low].particle - b->low;
    b->sums->ax[k] += t->acceleration[0];
    b->sums->ay[k] += t->acceleration[1];
    b->sums->az[k] += t->acceleration[2];
    b->sums->heating[k] += t->heating;
    b->sums->signal[k] = range_larger(b->sums->signal[k], t->signal);
  }
}

static const sph_hook contact_hooks[SPH_STAGES] = {[SPH_FORCES] = contact_add};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

/* How full of others the surroundings of a particle may be before they press, over what the own body leaves free. */
static const double contact_full = 0.9;
/* K of the contact over that of the matter. W spreads the contact of two planes over 2.7 spacings, which gives way more
 * than matter does; with more, the roughness of few particles shows. */
static const double contact_stiffness = 2;

/* W = 105/(32 pi R^3) (1 - r^2/R^2)^2 with R = 2h, 1/m^3, of the square of a distance; and its slope over r, 1/m^5. */
static double contact_weight(double square, double h) {
  const double reach2 = 4 * h * h, within = fmax(0, 1 - square / reach2);
  return 105 / (32 * M_PI) / (reach2 * 2 * h) * within * within;
}
static double contact_slope(double square, double h) {
  const double reach2 = 4 * h * h, within = fmax(0, 1 - square / reach2);
  return -105 / (8 * M_PI) / (reach2 * reach2 * 2 * h) * within;
}

static bool contact_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body;
  return inputs->contact.rule == SPH_CONTACT_OVERLAP && (inputs->kind == SPH_IMPACT || inputs->kind == SPH_COLLISION);
}

/* Two particles of different bodies. */
struct contact_pair {
  double d[3], square, h; /* from i to j, m; m^2; mean h of the start, m */
};

static inline bool contact_near(const struct sph_system *s, size_t i, size_t j, struct contact_pair *p) {
  const struct sph_columns *c = &s->c;
  const double *periodic = s->domain.periodic;
  p->d[0] = sph_pairs_image(c->x[j] - c->x[i], periodic[0]);
  p->d[1] = sph_pairs_image(c->y[j] - c->y[i], periodic[1]);
  p->d[2] = sph_pairs_image(c->z[j] - c->z[i], periodic[2]);
  p->square = p->d[0] * p->d[0] + p->d[1] * p->d[1] + p->d[2] * p->d[2];
  p->h = 0.5 * (c->h_initial[i] + c->h_initial[j]);
  return p->square < 4 * p->h * p->h;
}

static inline double contact_volume(const struct sph_system *s, size_t i) {
  return s->c.mass[i] / s->solid[s->body[i]].density;
}

/* n of one particle. */
static double contact_others(const struct sph_system *s, const struct sph_foreign *f, size_t row) {
  double sum = 0;
  for (size_t k = f->row[row].first; k < f->row[row + 1].first; k++) {
    const size_t j = f->row[f->other[k]].particle;
    struct contact_pair p;
    if (contact_near(s, f->row[row].particle, j, &p))
      sum += contact_volume(s, j) * contact_weight(p.square, p.h);
  }
  return sum;
}

/* n* of all particles, at the start: bodies that touch then do not press. */
static void contact_measure_room(struct sph_system *s, const struct sph_foreign *f) {
  const struct sph_pair_fields fields = sph_system_step_fields(s);
  double *room = s->c.contact_room;
  memset(room, 0, s->n * sizeof *room);
  sph_pairs_volumes(s->pairs, &fields, contact_weight, room);
  for (size_t i = 0; i < s->n; i++)
    room[i] = contact_full * fmax(0, 1 - room[i]);
  for (size_t row = 0; row < f->count; row++) {
    double *own = &room[f->row[row].particle];
    *own = fmax(*own, contact_others(s, f, row));
  }
}

/* The overlap of one particle as pressure and energy. */
static void contact_press(struct sph_system *s, const struct sph_foreign *f, size_t row) {
  const size_t i = f->row[row].particle;
  const struct sph_solid *body = &s->solid[s->body[i]];
  const double speed = sph_material_longitudinal_speed(&body->physics.material, false),
               overlap = fmax(0, contact_others(s, f, row) - s->c.contact_room[i]);
  s->touch[row] = (struct sph_touch){.pressure = contact_stiffness * body->density * speed * speed * overlap};
  s->touch[row].energy = 0.5 * s->touch[row].pressure * overlap * contact_volume(s, i);
}

/* The forces on one particle, its heating and its signal for the time step, by the pressures of all. */
static void contact_push(struct sph_system *s, const struct sph_foreign *f, size_t row) {
  const struct sph_columns *c = &s->c;
  const size_t i = f->row[row].particle;
  struct sph_touch *own = &s->touch[row];
  double force[3] = {0, 0, 0};
  for (size_t k = f->row[row].first; k < f->row[row + 1].first; k++) {
    const size_t j = f->row[f->other[k]].particle;
    const double pressures = own->pressure + s->touch[f->other[k]].pressure;
    struct contact_pair p;
    if (!(pressures > 0) || !contact_near(s, i, j, &p))
      continue;
    const double slope = contact_slope(p.square, p.h), densities = c->density[i] + c->density[j];
    const double closing = p.d[0] * (c->vx[i] - c->vx[j]) + p.d[1] * (c->vy[i] - c->vy[j]) +
                           p.d[2] * (c->vz[i] - c->vz[j]);
    const double mu = p.h * fmax(0, closing) / (p.square + 0.01 * p.h * p.h), speed = sqrt(pressures / densities);
    const double viscous = 2 * mu / densities *
                           (s->in.viscosity.alpha * speed + s->in.viscosity.beta * fmin(mu, speed));
    const double along = slope *
                         (contact_volume(s, i) * contact_volume(s, j) * pressures + c->mass[i] * c->mass[j] * viscous);
    for (int d = 0; d < 3; d++)
      force[d] += along * p.d[d];
    own->heating -= 0.5 * c->mass[j] * viscous * slope * closing;
    own->signal = fmax(own->signal, mu);
  }
  for (int d = 0; d < 3; d++)
    own->acceleration[d] = force[d] / c->mass[i];
}

/* Fills s->touch for the present positions and velocities. A particle is computed by one thread from its own row, so
 * that the bits do not depend on threads. */
static bool contact_touch(struct sph_system *s) {
  const struct sph_foreign *f = sph_pairs_foreign(s->pairs);
  if (s->now.steps == 0 && s->dt == 0)
    contact_measure_room(s, f);
  if (!grow_room(&s->touch, &s->touch_capacity, f->count, sizeof *s->touch))
    return false;
#pragma omp parallel for schedule(static) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t row = 0; row < f->count; row++)
    contact_press(s, f, row);
#pragma omp parallel for schedule(static) num_threads((int)s->in.fidelity.threads) if (s->in.fidelity.threads > 1)
  for (size_t row = 0; row < f->count; row++)
    contact_push(s, f, row);
  s->now.contact = 0;
  for (size_t row = 0; row < f->count; row++)
    s->now.contact += s->touch[row].energy;
  return true;
}

static const struct sph_column_need contact_columns[] = {{SPH_COLUMNS_OF(contact_room), 0, NULL}, {0}};

static const struct sph_module contact_module = {
    .name = "contact",
    .doc = "Different bodies press on each other where they overlap, by an energy of its own; they neither stick nor "
           "strain each other.",
    .source = "our choice",
    .when = "method.contact: overlap, in an impact or a collision",
    .on = contact_on,
    .columns = contact_columns,
    .bytes_linked = 8,
    .touch = contact_touch,
};

#endif

#ifdef SPH_MODULE_REPORT
static void contact_report(const struct sph_run *run, struct sph_results *results) {
  results->contact.energy = sph_results_finite(run->system->now.contact);
}
#endif

#ifdef SPH_MODULE_RESULT_ROWS
RESULT_REAL(energy.contact, contact.energy, "J", 0,
            .doc = "Energy of the overlap of bodies in contact at the end. Off with method.contact: welded."),
#endif

#ifdef SPH_MODULE_INPUT_ROWS
    INPUT_CHOICE(
        method.contact, contact.rule,
        FIELD_WORDS_HERE(SPH_CONTACTS, [SPH_CONTACT_WELDED] = "welded", [SPH_CONTACT_OVERLAP] = "overlap"),
        .absent = "welded", .flags = FIELD_DERIVED, .when = "kind=impact|collision",
        .choice_docs = "a pair of two bodies acts as in one body: intact bodies that touch stick together\n"
                       "bodies press on each other where they overlap, and part freely",
        .doc =
            "How different bodies act on each other. Unless given it is `overlap` where two bodies with strength meet "
            "below 0.03 of the speed of waves, else `welded`.",
        .source = "BA95 for `welded`; `overlap` is ours"),
#endif
