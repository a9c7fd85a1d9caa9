/* Everything that the next step depends on. Lists are not saved: they are made again from the positions of the last
 * listing, and the pair loop sums in their order. */
#include <stdio.h>
#include <string.h>

#include "engine/sph/step/system_layout.h"

struct section {
  void *data;
  size_t bytes;
};

enum { SECTIONS = SPH_COLUMNS + 10 };

static size_t sections(struct sph_system *s, struct section out[SECTIONS]) {
  double *column[SPH_COLUMNS];
  size_t count = 0;
  const size_t columns = sph_system_columns_list(s, column);
  out[count++] = (struct section){&s->n, sizeof s->n};
  out[count++] = (struct section){&s->now, sizeof s->now};
  for (size_t k = 0; k < columns; k++)
    out[count++] = (struct section){column[k], s->n * sizeof(double)};
  for (int k = 0; k < 5; k++)
    out[count++] = (struct section){sph_pairs_listed(s->pairs)[k], s->n * sizeof(double)};
  out[count++] = (struct section){s->id, s->n * sizeof *s->id};
  if (s->held)
    out[count++] = (struct section){s->held, s->n};
  return count;
}

size_t sph_system_state_size(const struct sph_system *system) {
  struct sph_system view = *system; /* sections() wants pointers it may write through; this one only counts */
  struct section list[SECTIONS];
  size_t total = 0;
  for (size_t k = 0, count = sections(&view, list); k < count; k++)
    total += list[k].bytes;
  return total;
}

void sph_system_state_save(const struct sph_system *system, void *bytes) {
  struct sph_system view = *system;
  struct section list[SECTIONS];
  unsigned char *to = bytes;
  for (size_t k = 0, count = sections(&view, list); k < count; k++) {
    memcpy(to, list[k].data, list[k].bytes);
    to += list[k].bytes;
  }
}

bool sph_system_state_load(struct sph_system *s, const void *bytes, size_t size) {
  struct section list[SECTIONS];
  const unsigned char *from = bytes;
  size_t n;
  if (size != sph_system_state_size(s))
    return false;
  memcpy(&n, from, sizeof n);
  if (n != s->n)
    return false;
  for (size_t k = 0, count = sections(s, list); k < count; k++) {
    memcpy(list[k].data, from, list[k].bytes);
    from += list[k].bytes;
  }
  for (size_t i = 0; i < n; i++)
    if (s->id[i] >= n) {
      s->fault = SPH_FAULT_NOT_FINITE;
      snprintf(s->failure, sizeof s->failure, "the state read back is no state of this system");
      return false;
    }
  s->fault = SPH_FAULT_NONE;
  s->failure[0] = '\0';
  return sph_system_list_again(s);
}
