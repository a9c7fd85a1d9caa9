#include "engine/fragments.h"

#include <math.h>
#include <stdlib.h>

/* Root of i with path halving; roots are the lowest index of their set, so labels do not depend on the links' order. */
static uint32_t find(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
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
  for (size_t k = 0; k < link_count; k++) {
    uint32_t a = find(label, links[k][0]), b = find(label, links[k][1]);
    if (a < b)
      label[b] = a;
    else
      label[a] = b;
  }
  size_t count = 0;
  for (size_t i = 0; i < n; i++)
    count += label[i] == i;
  /* number[root] = fragment number; on exhausted memory the labels stay roots and the count is 0. */
  struct component *components = malloc((count ? count : 1) * sizeof *components);
  uint32_t *number = malloc((n ? n : 1) * sizeof *number);
  if (!components || !number) {
    free(components);
    free(number);
    return 0;
  }
  size_t next = 0;
  for (size_t i = 0; i < n; i++) {
    uint32_t root = find(label, (uint32_t)i);
    if (root == i) {
      number[i] = (uint32_t)next;
      components[next++] = (struct component){.mass = 0, .root = root};
    }
    components[number[root]].mass += mass[i];
  }
  qsort(components, count, sizeof *components, by_descending_mass);
  for (size_t k = 0; k < count; k++)
    number[components[k].root] = (uint32_t)k;
  /* A root is the lowest index of its set, so label[root] is read as a root before it is overwritten only if members
   * come after it: go downwards. */
  for (size_t i = n; i-- > 0;)
    label[i] = number[find(label, (uint32_t)i)];
  free(components);
  free(number);
  return count;
}

status fragments_find_plane(size_t n, const struct fragment_member *members, size_t link_count,
                            const uint32_t (*links)[2], uint32_t *label, struct fragment **out, size_t *count,
                            struct error *error) {
  *out = NULL;
  *count = 0;
  if (n == 0)
    return STATUS_OK;
  status code = STATUS_OK;
  uint32_t *own = label ? NULL : malloc(n * sizeof *own);
  double *mass = malloc(n * sizeof *mass);
  struct fragment *fragments = NULL;
  uint32_t *labels = label ? label : own;
  if (!labels || !mass) {
    code = status_fail(error, STATUS_MEMORY, "no memory to find the fragments of %zu grains", n);
    goto cleanup;
  }
  for (size_t i = 0; i < n; i++)
    mass[i] = members[i].mass;
  size_t found = fragments_label(n, mass, link_count, links, labels);
  fragments = found ? calloc(found, sizeof *fragments) : NULL;
  if (!fragments) {
    code = status_fail(error, STATUS_MEMORY, "no memory for the fragments of %zu grains", n);
    goto cleanup;
  }
  for (size_t i = 0; i < n; i++) {
    struct fragment *f = &fragments[labels[i]];
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
  for (size_t i = 0; i < n; i++) { /* parallel axes: about the fragment's centre of mass */
    struct fragment *f = &fragments[labels[i]];
    const struct fragment_member *m = &members[i];
    double x = m->position[0] - f->position[0], y = m->position[1] - f->position[1];
    double vx = m->velocity[0] - f->velocity[0], vy = m->velocity[1] - f->velocity[1];
    f->moment_of_inertia += m->moment_of_inertia + m->mass * (x * x + y * y);
    f->spin[2] += m->moment_of_inertia * m->spin + m->mass * (x * vy - y * vx);
  }
  for (size_t k = 0; k < found; k++)
    fragments[k].spin[2] /= fragments[k].moment_of_inertia;
  *out = fragments;
  *count = found;
  fragments = NULL;
cleanup:
  free(own);
  free(mass);
  free(fragments);
  return code;
}
