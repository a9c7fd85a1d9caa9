/* Pairs of particles of different bodies, where the pair loop leaves them out (pairs.h, struct sph_foreign). */
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "engine/sph/pairs/lists.h"
#include "engine/sph/pairs/pairs.h"

/* Is the k-th particle of a list a neighbour of this entry? */
static bool is_of(uint32_t entry, size_t k, size_t per_list) {
  return per_list == 1 || (entry >> (SPH_TAGS + k) & 1);
}

bool sph_foreign_part(struct sph_chunk *c, size_t per_list, const uint8_t *body, struct sph_neighbour_lists *lists) {
  c->foreign_count = 0;
  for (size_t list = 0; list * per_list < c->own; list++) {
    uint32_t *entry = lists->j + lists->start[list];
    uint32_t kept = 0;
    for (uint32_t e = 0; e < lists->count[list]; e++) {
      const size_t its = c->first + (per_list == 1 ? entry[e] : entry[e] & SPH_NUMBER);
      bool stays = false;
      for (size_t k = 0; k < per_list; k++) {
        const size_t mine = c->first + list * per_list + k;
        if (!is_of(entry[e], k, per_list))
          continue;
        if (body[mine] == body[its]) {
          stays = true;
          continue;
        }
        entry[e] &= per_list == 1 ? ~0U : ~(1U << (SPH_TAGS + k));
        if (!grow_room(&c->foreign, &c->foreign_capacity, c->foreign_count + 1, sizeof *c->foreign))
          return false;
        c->foreign[c->foreign_count][0] = (uint32_t)mine;
        c->foreign[c->foreign_count++][1] = (uint32_t)its;
        lists->pairs--;
      }
      entry[kept] = entry[e];
      kept += stays;
    }
    lists->count[list] = kept;
  }
  return true;
}

/* Numbers the rows: `row` becomes the row of each particle that has one. */
static size_t number_rows(const struct sph_chunks *s, size_t n, uint32_t *row) {
  size_t count = 0;
  memset(row, 0, n * sizeof *row);
  for (size_t k = 0; k < s->count; k++)
    for (size_t m = 0; m < s->chunk[k].foreign_count; m++)
      row[s->chunk[k].foreign[m][0]] = row[s->chunk[k].foreign[m][1]] = 1;
  for (size_t i = 0; i < n; i++)
    if (row[i])
      row[i] = (uint32_t)count++;
  return count;
}

bool sph_foreign_collect(const struct sph_chunks *s, size_t n, struct sph_foreign *f) {
  size_t pairs = 0;
  for (size_t k = 0; k < s->count; k++)
    pairs += s->chunk[k].foreign_count;
  f->count = 0;
  if (!pairs)
    return true;
  uint32_t *row = malloc(n * sizeof *row);
  if (!row)
    return false;
  const size_t count = number_rows(s, n, row);
  const bool enough = grow_room(&f->row, &f->row_capacity, count + 1, sizeof *f->row) &&
                      grow_room(&f->other, &f->other_capacity, 2 * pairs, sizeof *f->other);
  if (!enough)
    goto cleanup;
  memset(f->row, 0, (count + 1) * sizeof *f->row);
  for (size_t k = 0; k < s->count; k++) /* lengths, then ends, then beginnings of the rows */
    for (size_t m = 0; m < s->chunk[k].foreign_count; m++)
      for (int side = 0; side < 2; side++) {
        const uint32_t i = s->chunk[k].foreign[m][side];
        f->row[row[i]].first++;
        f->row[row[i]].particle = i;
      }
  for (size_t r = 1; r <= count; r++)
    f->row[r].first += f->row[r - 1].first;
  for (size_t k = s->count; k-- > 0;)
    for (size_t m = s->chunk[k].foreign_count; m-- > 0;)
      for (int side = 2; side-- > 0;) {
        const uint32_t *pair = s->chunk[k].foreign[m];
        f->other[--f->row[row[pair[side]]].first] = row[pair[1 - side]];
      }
  f->count = count;
cleanup:
  free(row);
  return enough;
}

void sph_foreign_clear(struct sph_foreign *f) {
  free(f->row);
  free(f->other);
}
