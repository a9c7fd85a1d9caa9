/* Neighbour lists: skins, the cell grid, near pairs, repacked bond blocks. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/step/system_layout.h"
#include "engine/grow.h"

static const double horizon_steps = 150.0; /* a skin lasts about this many steps at the grain's present speed */
static const double smallest_skin = 0.25;  /* in mean diameters */
static const double neighbour_share = 0.5; /* of a neighbour's speed counts as the grain's own */
static const double largest_skin = 3.0;
static const uint32_t none = UINT32_MAX;

void dem_neighbours_cache_side(struct dem_system *s, uint32_t near, const struct dem_overlap *overlap) {
  const struct dem_near_pair *pair = &s->near_pair[near];
  struct dem_near_block *block = &s->near[near / DEM_BLOCK];
  const size_t lane = near % DEM_BLOCK;
  const uint32_t grains[2] = {pair->first, pair->second};
  const uint32_t owner = grains[overlap->owner], other = grains[1 - overlap->owner];
  block->owner[lane] = owner;
  block->other[lane] = other;
  const uint32_t first = s->first_vertex[owner], sides = s->first_vertex[owner + 1] - first;
  const size_t from = first + overlap->side, to = first + (overlap->side + 1) % sides;
  block->side_x[lane] = s->outline_x[to] - s->outline_x[from];
  block->side_y[lane] = s->outline_y[to] - s->outline_y[from];
  block->offset[lane] = s->outline_x[from] * block->side_y[lane] - s->outline_y[from] * block->side_x[lane];
  const uint32_t first_other = s->first_vertex[other], count = s->first_vertex[other + 1] - first_other;
  for (size_t v = 0; v < 3; v++) { /* the vertex before the nearest one, the nearest, the one after */
    const size_t vertex = first_other + (overlap->vertex + count - 1 + v) % count;
    block->vertex_x[v][lane] = s->outline_x[vertex];
    block->vertex_y[v][lane] = s->outline_y[vertex];
  }
}

/* Is the contact of a broken pair still side on side, so that its window is exact? Only the positions decide:
 * it does not matter when the beam broke. */
static bool still_side_on_side(const struct dem_system *s, const struct dem_bond_block *block, size_t lane,
                               int32_t pair) {
  if (!s->windowed[pair])
    return false;
  double x[2], y[2];
  for (int k = 0; k < 2; k++) {
    const uint32_t grain = s->pair[pair][k];
    const double c = s->c.cosine[grain], sn = s->c.sine[grain];
    x[k] = s->c.x[grain] + c * block->middle_x[k][lane] - sn * block->middle_y[k][lane];
    y[k] = s->c.y[grain] + sn * block->middle_x[k][lane] + c * block->middle_y[k][lane];
  }
  const double dx = x[1] - x[0], dy = y[1] - y[0];
  const double half = block->half_x[0][lane] * block->half_x[0][lane] + block->half_y[0][lane] * block->half_y[0][lane];
  return dx * dx + dy * dy < half && fabs(s->c.angle[s->pair[pair][0]] - s->c.angle[s->pair[pair][1]]) < 0.3;
}

/* Removes broken pairs that came apart from the bond blocks. The other lanes keep their order. */
static void repack_bonds(struct dem_system *s) {
  const size_t lanes = s->now.bond_blocks * DEM_BLOCK;
  size_t kept = 0;
  for (size_t lane = 0; lane < lanes; lane++) {
    const int32_t pair = s->lane_pair[lane];
    if (pair == DEM_NO_PAIR)
      continue;
    const bool gone = !s->present[s->pair[pair][0]] || !s->present[s->pair[pair][1]];
    if (gone || (!s->alive[pair] && !still_side_on_side(s, &s->bond[lane / DEM_BLOCK], lane % DEM_BLOCK, pair))) {
      s->pair_lane[pair] = DEM_NO_PAIR;
      continue;
    }
    if (kept != lane) {
      struct dem_bond_block *to = &s->bond[kept / DEM_BLOCK];
      const struct dem_bond_block *from = &s->bond[lane / DEM_BLOCK];
      const size_t a = kept % DEM_BLOCK, b = lane % DEM_BLOCK;
      to->first[a] = from->first[b];
      to->second[a] = from->second[b];
      const size_t start = offsetof(struct dem_bond_block, reference_x);
      double *write = (double *)((char *)to + start);
      const double *read = (const double *)((const char *)from + start);
      for (size_t f = 0; f < (sizeof *to - start) / sizeof(dem_lane); f++)
        write[f * DEM_BLOCK + a] = read[f * DEM_BLOCK + b];
      s->lane_pair[kept] = pair;
      s->pair_lane[pair] = (int32_t)kept;
    }
    kept++;
  }
  const size_t blocks = (kept + DEM_BLOCK - 1) / DEM_BLOCK;
  for (size_t lane = kept; lane < lanes; lane++) {
    s->lane_pair[lane] = DEM_NO_PAIR;
    dem_breaking_clear(s, &s->bond[lane / DEM_BLOCK], (int)(lane % DEM_BLOCK));
  }
  s->now.bond_blocks = blocks;
}

static bool grow_cells(struct dem_system *s) {
  const size_t capacity = s->cell_capacity * 2;
  if (!grow_block(&s->cell_grain, capacity * sizeof *s->cell_grain) ||
      !grow_block(&s->cell_next, capacity * sizeof *s->cell_next) ||
      !grow_block(&s->cell_key, capacity * sizeof *s->cell_key))
    return false;
  s->cell_capacity = capacity;
  return true;
}

static int32_t cell_of(double position, double per_size) {
  const double cell = floor(position * per_size);
  if (cell > 1e9)
    return 1000000000;
  return cell > -1e9 ? (int32_t)cell : -1000000000; /* also for a position that is NaN */
}

static size_t bucket_of(const struct dem_system *s, int32_t x, int32_t y) {
  const uint64_t mixed = ((uint64_t)(uint32_t)x << 32 | (uint32_t)y) * 0x9E3779B97F4A7C15u;
  return (size_t)((mixed ^ mixed >> 29) * 0xBF58476D1CE4E5B9u >> 32) & (s->cell_buckets - 1);
}

static int32_t pair_of(const struct dem_system *s, uint32_t i, uint32_t j) {
  for (uint32_t k = s->first_partner[i]; k < s->first_partner[i + 1]; k++)
    if (s->partner[k] == j)
      return (int32_t)s->partner_pair[k];
  return DEM_NO_PAIR;
}

/* Lists the pair j < i if its gap is within the two skins. False: no memory. */
static bool consider(struct dem_system *s, uint32_t i, uint32_t j, const struct dem_ring *mine) {
  const struct dem_columns *c = &s->c;
  const double dx = c->x[j] - c->x[i], dy = c->y[j] - c->y[i];
  const double skins = c->skin[i] + c->skin[j], reach = s->c.radius[i] + s->c.radius[j] + skins;
  if (dx * dx + dy * dy > reach * reach)
    return true;
  const int32_t pair = pair_of(s, i, j);
  if (pair != DEM_NO_PAIR && s->windowed[pair] && s->pair_lane[pair] != DEM_NO_PAIR)
    return true;
  struct dem_ring ring[2]; /* first is the lower index, as in near_pair */
  struct dem_overlap overlap;
  dem_system_arrays_ring(s, j, dx, dy, &ring[0]);
  ring[1].count = mine->count;
  const size_t used = (dem_overlap_last(mine) + 1) * sizeof(double);
  memcpy(ring[1].x, mine->x, used);
  memcpy(ring[1].y, mine->y, used);
  s->kernels->best_side(ring, &overlap);
  if (overlap.gap > skins)
    return true;
  if (s->now.near_count == s->near_capacity && !dem_system_arrays_grow_near(s, 2 * s->near_capacity))
    return false;
  struct dem_near_pair *near = &s->near_pair[s->now.near_count];
  *near = (struct dem_near_pair){.first = j, .second = i, .pair = pair};
  if (pair == DEM_NO_PAIR)
    near->contact = dem_assemble_contact(s, i, j, 0.0);
  dem_neighbours_cache_side(s, (uint32_t)s->now.near_count, &overlap);
  s->now.near_count++;
  return true;
}

/* A grain's skin also allows for the speed of its neighbours, which a wave or an impact will pass on to it. */
static void set_skins(struct dem_system *s) {
  struct dem_columns *c = &s->c;
  double *const speed = c->list_x; /* scratch memory until the positions are stored there */
  const double reach = horizon_steps * s->in->fidelity.time_step;
  for (size_t i = 0; i < s->count; i++)
    speed[i] = sqrt(c->vx[i] * c->vx[i] + c->vy[i] * c->vy[i]) + s->c.radius[i] * fabs(c->spin[i]);
  for (size_t i = 0; i < s->count; i++) {
    double fastest = speed[i];
    for (uint32_t k = s->first_partner[i]; k < s->first_partner[i + 1]; k++)
      fastest = fmax(fastest, neighbour_share * speed[s->partner[k]]);
    c->skin[i] = fmin(largest_skin * s->mean_diameter, fmax(smallest_skin * s->mean_diameter, fastest * reach));
  }
  for (size_t i = 0; i < s->count; i++) {
    c->list_x[i] = c->x[i];
    c->list_y[i] = c->y[i];
    c->list_angle[i] = c->angle[i];
  }
  /* The check of the skins runs over whole vectors. Padding lanes must not look as if they had moved, or the list would
   * be made at every step of a body whose number of grains is no multiple of the vector's width. */
  for (size_t i = s->count; i < s->padded; i++) {
    c->list_x[i] = c->x[i];
    c->list_y[i] = c->y[i];
    c->list_angle[i] = c->angle[i];
    c->skin[i] = largest_skin * s->mean_diameter;
  }
}

/* Considers grain i with all grains of one cell. `mine` is the outline of i, whose lowest cell is (x0, y0). */
static bool search_cell(struct dem_system *s, uint32_t i, const struct dem_ring *mine, size_t bucket, int32_t x,
                        int32_t y) {
  const int32_t x0 = s->cell_low[i][0], y0 = s->cell_low[i][1];
  for (uint32_t e = s->cell_head[bucket]; e != none; e = s->cell_next[e]) {
    if (s->cell_key[e][0] != x || s->cell_key[e][1] != y)
      continue;
    const uint32_t j = s->cell_grain[e];
    const int32_t home_x = s->cell_low[j][0], home_y = s->cell_low[j][1];
    if (x != (home_x > x0 ? home_x : x0) || y != (home_y > y0 ? home_y : y0))
      continue; /* a pair is considered once, in the lowest cell that both share */
    if (!consider(s, i, j, mine))
      return false;
  }
  return true;
}

/* Considers grain i with all grains before it, and enters it into its cells. */
static bool search_grain(struct dem_system *s, uint32_t i, double per_size, size_t *entries) {
  const double reach = s->c.radius[i] + s->c.skin[i];
  const int32_t x0 = cell_of(s->c.x[i] - reach, per_size), x1 = cell_of(s->c.x[i] + reach, per_size);
  const int32_t y0 = cell_of(s->c.y[i] - reach, per_size), y1 = cell_of(s->c.y[i] + reach, per_size);
  s->cell_low[i][0] = x0;
  s->cell_low[i][1] = y0;
  struct dem_ring mine;
  dem_system_arrays_ring(s, i, 0.0, 0.0, &mine);
  for (int32_t y = y0; y <= y1; y++)
    for (int32_t x = x0; x <= x1; x++) {
      const size_t bucket = bucket_of(s, x, y);
      if (!search_cell(s, i, &mine, bucket, x, y))
        return false;
      const size_t e = *entries;
      if (e == s->cell_capacity && !grow_cells(s))
        return false;
      s->cell_key[e][0] = x;
      s->cell_key[e][1] = y;
      s->cell_grain[e] = i;
      s->cell_next[e] = s->cell_head[bucket];
      s->cell_head[bucket] = (uint32_t)e;
      *entries = e + 1;
    }
  return true;
}

/* Points the unused lanes of the last near block at the ghosts, and clears them, so that equal states have equal bytes.
 */
static void pad_near(struct dem_system *s) {
  for (size_t lane = s->now.near_count; lane % DEM_BLOCK; lane++) {
    struct dem_near_block *block = &s->near[lane / DEM_BLOCK];
    const size_t start = offsetof(struct dem_near_block, side_x);
    double *const fields = (double *)((char *)block + start);
    for (size_t f = 0; f < (sizeof *block - start) / sizeof(dem_lane); f++)
      fields[f * DEM_BLOCK + lane % DEM_BLOCK] = 0.0;
    block->owner[lane % DEM_BLOCK] = s->ghost;
    block->other[lane % DEM_BLOCK] = s->ghost + 1;
  }
}

/* Searches the new list. A grain makes a new list before it leaves its skin, so it has no contact with a grain that is
 * not in a list with it. */
static void see_approaches(struct dem_system *s) {
  for (size_t k = 0; k < s->now.near_count; k++) {
    const struct dem_near_pair *near = &s->near_pair[k];
    if (near->pair != DEM_NO_PAIR && s->alive[near->pair])
      continue;
    const uint32_t i = near->first, j = near->second;
    const double dx = s->c.x[j] - s->c.x[i], dy = s->c.y[j] - s->c.y[i];
    const double vx = s->c.vx[j] - s->c.vx[i], vy = s->c.vy[j] - s->c.vy[i];
    const double speed = sqrt(vx * vx + vy * vy), reach = 0.5 * (s->diameter[i] + s->diameter[j]);
    const bool meet = dx * vx + dy * vy < 0.0 && fabs(dx * vy - dy * vx) < reach * speed;
    if (meet && speed > s->now.fastest_approach)
      s->now.fastest_approach = speed;
  }
}

bool dem_neighbours_make(struct dem_system *s) {
  s->now.rebuilds++;
  set_skins(s);
  repack_bonds(s);
  s->now.near_count = 0;
  if (s->in->contact.law == DEM_CONTACT_OFF)
    return true;

  const double per_size = 1.0 / (1.5 * s->mean_diameter);
  size_t entries = 0;
  for (size_t b = 0; b < s->cell_buckets; b++)
    s->cell_head[b] = none;
  for (uint32_t i = 0; i < s->count; i++)
    if (s->present[i] && !search_grain(s, i, per_size, &entries)) {
      s->no_memory = true;
      return false;
    }
  pad_near(s);
  if (s->now.steps > 0) /* at the start a shot grain still has its beams */
    see_approaches(s);
  return true;
}
