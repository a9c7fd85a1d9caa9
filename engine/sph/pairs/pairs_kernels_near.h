/* The search for neighbours (neighbours.c). Eight candidates at a time in every CPU class, always in double. */

typedef double near_vector __attribute__((vector_size(64)));

/* Bit k: a[k] < b[k]. */
#ifdef __AVX512F__
INLINE unsigned near_less(near_vector a, near_vector b) {
  return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
}
#else
INLINE unsigned near_less(near_vector a, near_vector b) {
  unsigned mask = 0;
#pragma GCC unroll 8
  for (unsigned k = 0; k < 8; k++)
    mask |= (unsigned)(a[k] < b[k]) << k;
  return mask;
}
#endif

INLINE near_vector near_load(const double *from) {
  near_vector v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

/* Writes the lanes in `mask` to the front of `to`; up to 8 places are written. */
INLINE void near_compress(double *to, unsigned mask, near_vector v) {
#ifdef __AVX512F__
  _mm512_storeu_pd(to, _mm512_maskz_compress_pd((__mmask8)mask, (__m512d)v));
#else
  for (size_t n = 0; mask; mask &= mask - 1)
    to[n++] = v[__builtin_ctz(mask)];
#endif
}
INLINE void near_compress_numbers(uint32_t *to, unsigned mask, const uint32_t *from) {
#ifdef __AVX512F__
  const __m256i its = _mm256_loadu_si256((const __m256i *)(const void *)from);
  _mm256_storeu_si256((__m256i *)(void *)to, _mm256_maskz_compress_epi32((__mmask8)mask, its));
#else
  for (size_t n = 0; mask; mask &= mask - 1)
    to[n++] = from[__builtin_ctz(mask)];
#endif
}

/* Sets `bits` in the numbers of the lanes in `mask`. */
INLINE void near_tag(uint32_t number[8], unsigned mask, uint32_t bits) {
#ifdef __AVX512F__
  const __m256i its = _mm256_loadu_si256((const __m256i *)(const void *)number);
  _mm256_storeu_si256((__m256i *)(void *)number,
                      _mm256_mask_or_epi32(its, (__mmask8)mask, its, _mm256_set1_epi32((int)bits)));
#else
  for (unsigned k = 0; k < 8; k++)
    number[k] |= (mask >> k & 1) ? bits : 0;
#endif
}

/* The nearest periodic image of a distance `d`. */
INLINE near_vector near_image(near_vector d, double period, const bool wrapped) {
  if (!wrapped || !(period > 0))
    return d;
  const near_vector turns = d * (1 / period) + 6755399441055744.0; /* 1.5 x 2^52: rounds to an integer */
  return d - (turns - 6755399441055744.0) * period;
}

/* The distance of a coordinate from an interval: 0 inside. */
INLINE near_vector near_gap(near_vector d, near_vector half) {
  typedef int64_t bits __attribute__((vector_size(64)));
  const near_vector gap = (near_vector)((bits)d & INT64_MAX) - half, zero = {0};
#ifdef __AVX512F__
  return (near_vector)_mm512_max_pd((__m512d)zero, (__m512d)gap); /* NaN stays NaN */
#else
  return (near_vector)((bits)gap & ~(bits)(gap < zero));
#endif
}

INLINE size_t near_boxes_of(const struct sph_near_boxes *boxes, const uint32_t *parent, size_t count,
                            const struct sph_near_box *own, const double period[3], uint32_t lowest, uint32_t *found,
                            const bool wrapped) {
  size_t n = 0;
  for (size_t k = 0; k < count; k++) {
    const struct sph_near_boxes *b = boxes + parent[k];
    near_vector square = {0}, reach = near_load(b->reach) + own->reach;
#pragma GCC unroll 3
    for (int d = 0; d < 3; d++) {
      const near_vector to = near_image(near_load(b->middle[d]) - own->middle[d], period[d], wrapped);
      const near_vector gap = near_gap(to, near_load(b->half[d]) + own->half[d]);
      square += gap * gap;
    }
    unsigned mask = near_less(square, reach * reach);
    const uint32_t first = 8 * parent[k];
    if (first < lowest)
      mask &= lowest - first < 8 ? ~0U << (lowest - first) : 0;
    for (; mask; mask &= mask - 1)
      found[n++] = first + (uint32_t)__builtin_ctz(mask);
  }
  return n;
}

INLINE size_t near_particles_of(const struct sph_near_particles *p, const uint32_t *leaf, size_t count,
                                const struct sph_near_box *own, const double period[3], double *at[4], uint32_t *number,
                                const bool wrapped) {
  size_t n = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t first = p->first[leaf[k]], size = p->size[leaf[k]];
    for (uint32_t part = 0; part < size; part += 8) {
      const size_t from = first + part;
      const near_vector its = near_load(p->reach + from), reach = its + own->reach, zero = {0};
      near_vector place[3], square = zero;
#pragma GCC unroll 3
      for (int d = 0; d < 3; d++) {
        place[d] = near_load(p->place[d] + from);
        const near_vector gap = near_gap(near_image(place[d] - own->middle[d], period[d], wrapped),
                                         zero + own->half[d]);
        square += gap * gap;
      }
      unsigned mask = near_less(square, reach * reach);
      if (size - part < 8)
        mask &= (1U << (size - part)) - 1;
      if (!mask)
        continue;
#pragma GCC unroll 3
      for (int d = 0; d < 3; d++)
        near_compress(at[d] + n, mask, place[d]);
      near_compress(at[3] + n, mask, its);
      uint32_t numbers[8];
      for (uint32_t lane = 0; lane < 8; lane++)
        numbers[lane] = (uint32_t)from + lane;
      near_compress_numbers(number + n, mask, numbers);
      n += (size_t)__builtin_popcount(mask);
    }
  }
  return n;
}

INLINE size_t near_pairs_of(size_t count, double *const at[4], const uint32_t *number, const double (*own)[4],
                            const size_t owns, const double period[3], uint32_t tag, uint32_t *found, size_t *pairs,
                            const bool wrapped) {
  size_t n = 0, total = 0;
  for (size_t k = 0; k < count; k += 8) {
    const unsigned all = count - k < 8 ? (1U << (count - k)) - 1 : ~0U;
    uint32_t its[8];
    unsigned mask = 0;
    memcpy(its, number + k, sizeof its);
    for (size_t m = 0; m < owns; m++) {
      const near_vector reach = near_load(at[3] + k) + own[m][3];
      near_vector square = {0};
#pragma GCC unroll 3
      for (int d = 0; d < 3; d++) {
        const near_vector to = near_image(near_load(at[d] + k) - own[m][d], period[d], wrapped);
        square += to * to;
      }
      const unsigned near = near_less(square, reach * reach) & all;
      mask |= near;
      if (tag)
        near_tag(its, near, tag << m);
      if (owns > 1)
        total += (size_t)__builtin_popcount(near);
    }
    near_compress_numbers(found + n, mask, its);
    n += (size_t)__builtin_popcount(mask);
  }
  *pairs += owns > 1 ? total : n;
  return n;
}

static bool near_wraps(const double period[3]) {
  return period[0] > 0 || period[1] > 0 || period[2] > 0;
}

static size_t near_boxes(const struct sph_near_boxes *boxes, const uint32_t *parent, size_t count,
                         const struct sph_near_box *own, const double period[3], uint32_t lowest, uint32_t *found) {
  return near_wraps(period) ? near_boxes_of(boxes, parent, count, own, period, lowest, found, true)
                            : near_boxes_of(boxes, parent, count, own, period, lowest, found, false);
}

static size_t near_particles(const struct sph_near_particles *particles, const uint32_t *leaf, size_t count,
                             const struct sph_near_box *own, const double period[3], double *at[4], uint32_t *number) {
  return near_wraps(period) ? near_particles_of(particles, leaf, count, own, period, at, number, true)
                            : near_particles_of(particles, leaf, count, own, period, at, number, false);
}

static size_t near_pairs(size_t count, double *const at[4], const uint32_t *number, const double (*own)[4], size_t owns,
                         const double period[3], uint32_t tag, uint32_t *found, size_t *pairs) {
  if (near_wraps(period))
    return near_pairs_of(count, at, number, own, owns, period, tag, found, pairs, true);
  if (owns == 1)
    return near_pairs_of(count, at, number, own, 1, period, tag, found, pairs, false);
  if (owns == 2)
    return near_pairs_of(count, at, number, own, 2, period, tag, found, pairs, false);
  return near_pairs_of(count, at, number, own, owns, period, tag, found, pairs, false);
}
