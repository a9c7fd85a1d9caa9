/* Connected components and their mass, centre, velocity and spin. */
#include "engine/fragments.h"

#include <math.h>
#include <stdlib.h>

#include "schemas/memory.h"

/* Path halving. The root is the lowest index of its set, so labels do not depend on the order of the links. */
uint32_t fragments_root(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

bool fragments_join(uint32_t *parent, uint32_t a, uint32_t b) {
  a = fragments_root(parent, a);
  b = fragments_root(parent, b);
  if (a < b)
    parent[b] = a;
  else
    parent[a] = b;
  return a != b;
}

struct component {
  double mass;
  uint32_t root;
};

static int by_descending_mass(const void *a, const void *b) {
  const struct component *p = a, *q = b;
  if (p->mass != q->mass)
    return p->mass < q->mass ? 1 : -1;
  return p->root < q->root ? -1 : p->root > q->root;
}

size_t fragments_label(size_t n, const double *mass, size_t link_count, const uint32_t (*links)[2], uint32_t *label) {
  for (size_t i = 0; i < n; i++)
    label[i] = (uint32_t)i;
  for (size_t k = 0; k < link_count; k++)
    fragments_join(label, links[k][0], links[k][1]);
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    count += label[i] == i;
  /* number[root]: the number of its fragment. Without memory the labels stay roots and the count is 0. */
  OWNED struct component *components = malloc((count ? count : 1) * sizeof *components);
  OWNED uint32_t *number = malloc((n ? n : 1) * sizeof *number);
  if (!components || !number)
    return 0;
  size_t next = 0;
  for (size_t i = 0; i < n; i++) {
    uint32_t root = fragments_root(label, (uint32_t)i);
    if (root == i) {
      number[i] = (uint32_t)next;
      components[next++] = (struct component){.mass = 0, .root = root};
    }
    components[number[root]].mass += mass[i];
  }
  qsort(components, count, sizeof *components, by_descending_mass);
  for (size_t k = 0; k < count; k++)
    number[components[k].root] = (uint32_t)k;
  /* label[root] must be read as a root until all members of its set have their number. A root is the lowest index of
   * its set, so the loop goes downwards. */
  for (size_t i = n; i-- > 0;)
    label[i] = number[fragments_root(label, (uint32_t)i)];
  return count;
}

static status no_memory(size_t n, struct error *error) {
  return status_fail(error, STATUS_MEMORY, "no memory to find the fragments of %zu grains or particles", n);
}

/* Quantities common to 2D and 3D: labels, masses, centres of mass, velocities, kinetic energies, counts. */
static status gather(size_t n, const struct fragment_member *members, size_t link_count, const uint32_t (*links)[2],
                     uint32_t *label, struct fragment **out, size_t *count, struct error *error) {
  OWNED double *mass = malloc(n * sizeof *mass);
  if (!mass)
    return no_memory(n, error);
  for (size_t i = 0; i < n; i++)
    mass[i] = members[i].mass;
  size_t found = fragments_label(n, mass, link_count, links, label);
  struct fragment *fragments = found ? calloc(found, sizeof *fragments) : NULL;
  if (!fragments)
    return no_memory(n, error);

  for (size_t i = 0; i < n; i++) {
    struct fragment *f = &fragments[label[i]];
    const struct fragment_member *m = &members[i];
    if (f->count++ == 0)
      f->first = (uint32_t)i;
    f->mass += m->mass;
    for (int d = 0; d < 3; d++) {
      f->position[d] += m->mass * m->position[d];
      f->velocity[d] += m->mass * m->velocity[d];
      f->kinetic_energy += 0.5 * m->mass * m->velocity[d] * m->velocity[d];
    }
    f->kinetic_energy += 0.5 * m->moment_of_inertia * m->spin * m->spin;
  }
  for (size_t k = 0; k < found; k++)
    for (int d = 0; d < 3; d++) {
      fragments[k].position[d] /= fragments[k].mass;
      fragments[k].velocity[d] /= fragments[k].mass;
    }
  *out = fragments;
  *count = found;
  return STATUS_OK;
}

/* Spin and moment of inertia about z. */
static void turn_in_plane(size_t n, const struct fragment_member *members, const uint32_t *label, size_t count,
                          struct fragment *fragments) {
  for (size_t i = 0; i < n; i++) { /* parallel axes theorem: about the fragment's centre of mass */
    struct fragment *f = &fragments[label[i]];
    const struct fragment_member *m = &members[i];
    double x = m->position[0] - f->position[0], y = m->position[1] - f->position[1];
    double vx = m->velocity[0] - f->velocity[0], vy = m->velocity[1] - f->velocity[1];
    f->moment_of_inertia += m->moment_of_inertia + m->mass * (x * x + y * y);
    f->spin[2] += m->moment_of_inertia * m->spin + m->mass * (x * vy - y * vx);
  }
  for (size_t k = 0; k < count; k++)
    fragments[k].spin[2] /= fragments[k].moment_of_inertia;
}

/* One rotation that makes a[p][q] zero; axes are the rows of `axis` (Golub & Van Loan, section 8.5). */
static void rotate(double a[3][3], double axis[3][3], int p, int q) {
  if (a[p][q] == 0)
    return;
  double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + hypot(theta, 1)), c = 1 / hypot(t, 1), s = t * c;
  for (int k = 0; k < 3; k++) {
    double left = a[k][p], right = a[k][q];
    a[k][p] = c * left - s * right;
    a[k][q] = s * left + c * right;
  }
  for (int k = 0; k < 3; k++) {
    double left = a[p][k], right = a[q][k];
    a[p][k] = c * left - s * right;
    a[q][k] = s * left + c * right;
    left = axis[p][k];
    right = axis[q][k];
    axis[p][k] = c * left - s * right;
    axis[q][k] = s * left + c * right;
  }
  a[p][q] = a[q][p] = 0;
}

static void swap(double *a, double *b) {
  double v = *a;
  *a = *b;
  *b = v;
}

void fragments_principal(const double tensor[6], double value[3], double axis[3][3]) {
  double a[3][3] = {{tensor[0], tensor[1], tensor[2]},
                    {tensor[1], tensor[3], tensor[4]},
                    {tensor[2], tensor[4], tensor[5]}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      axis[i][j] = i == j;
  for (int sweep = 0; sweep < 12; sweep++) { /* convergence is quadratic: five sweeps are enough in double precision */
    rotate(a, axis, 0, 1);
    rotate(a, axis, 0, 2);
    rotate(a, axis, 1, 2);
  }
  for (int i = 0; i < 3; i++)
    value[i] = a[i][i];
  for (int pass = 0; pass < 2; pass++) /* ascending */
    for (int i = 0; i < 2 - pass; i++)
      if (value[i] > value[i + 1]) {
        swap(&value[i], &value[i + 1]);
        for (int k = 0; k < 3; k++)
          swap(&axis[i][k], &axis[i + 1][k]);
      }
}

/* Spin from angular momentum L and inertia tensor, along each principal axis that has inertia. */
static void solve_spin(const double tensor[6], const double momentum[3], double spin[3]) {
  double value[3], axis[3][3];
  fragments_principal(tensor, value, axis);
  spin[0] = spin[1] = spin[2] = 0;
  for (int k = 0; k < 3; k++)
    if (value[k] > 1e-12 * value[2]) { /* smaller values are rounding errors of particles in a line */
      double along = (axis[k][0] * momentum[0] + axis[k][1] * momentum[1] + axis[k][2] * momentum[2]) / value[k];
      for (int d = 0; d < 3; d++)
        spin[d] += along * axis[k][d];
    }
}

/* Inertia tensor (xx xy xz yy yz zz) and angular momentum about a fragment's centre of mass. */
struct turning {
  double inertia[6], momentum[3];
};

static void add_turning(struct turning *t, const struct fragment *f, const struct fragment_member *m) {
  double r[3], v[3], own = m->moment_of_inertia;
  for (int d = 0; d < 3; d++) {
    r[d] = m->position[d] - f->position[d];
    v[d] = m->velocity[d] - f->velocity[d];
  }
  double xx = m->mass * r[0] * r[0], yy = m->mass * r[1] * r[1], zz = m->mass * r[2] * r[2];
  const double tensor[6] = {yy + zz + own, -m->mass * r[0] * r[1], -m->mass * r[0] * r[2],
                            zz + xx + own, -m->mass * r[1] * r[2], xx + yy + own};
  for (int k = 0; k < 6; k++)
    t->inertia[k] += tensor[k];
  t->momentum[0] += m->mass * (r[1] * v[2] - r[2] * v[1]);
  t->momentum[1] += m->mass * (r[2] * v[0] - r[0] * v[2]);
  t->momentum[2] += m->mass * (r[0] * v[1] - r[1] * v[0]) + own * m->spin;
}

static status turn_in_space(size_t n, const struct fragment_member *members, const uint32_t *label, size_t count,
                            struct fragment *fragments, struct error *error) {
  OWNED struct turning *turning = calloc(count, sizeof *turning);
  if (!turning)
    return no_memory(n, error);
  for (size_t i = 0; i < n; i++) {
    const struct fragment *f = &fragments[label[i]];
    if (f->count == 1 && members[i].moment_of_inertia == 0)
      continue; /* a single particle lies at the centre of its fragment */
    add_turning(&turning[label[i]], f, &members[i]);
  }
  for (size_t k = 0; k < count; k++) {
    const double *tensor = turning[k].inertia;
    fragments[k].moment_of_inertia = (tensor[0] + tensor[3] + tensor[5]) / 3;
    if (fragments[k].moment_of_inertia > 0)
      solve_spin(tensor, turning[k].momentum, fragments[k].spin);
  }
  return STATUS_OK;
}

status fragments_find(bool in_space, size_t n, const struct fragment_member *members, size_t link_count,
                      const uint32_t (*links)[2], uint32_t *label, struct fragment **out, size_t *count,
                      struct error *error) {
  *out = NULL;
  *count = 0;
  if (n == 0)
    return STATUS_OK;
  uint32_t *labels = label ? label : malloc(n * sizeof *labels);
  if (!labels)
    return no_memory(n, error);
  status code = gather(n, members, link_count, links, labels, out, count, error);
  if (!code && in_space)
    code = turn_in_space(n, members, labels, *count, *out, error);
  else if (!code)
    turn_in_plane(n, members, labels, *count, *out);
  if (!label)
    free(labels);
  if (!code)
    return STATUS_OK;
  free(*out);
  *out = NULL;
  *count = 0;
  return code;
}
