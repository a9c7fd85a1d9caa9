/* Columns to records before a chunk is summed, and records of sums back to columns after it, in one precision. LANES
 * particles at a time are transposed in a block; columns are of double, so the block is filled by AT_ONCE particles, as
 * many as a register of doubles holds. */

#define vec_part        TYPED(vec_part)
#define column_load     TYPED(column_load)
#define column_position TYPED(column_position)
#define column_store    TYPED(column_store)
#define pack_columns    TYPED(pack_columns)
#define unpack_columns  TYPED(unpack_columns)
#define pack_records    TYPED(pack_records)
#define unpack_records  TYPED(unpack_records)
#define record_kernels  TYPED(record_kernels)

typedef REAL vec_part __attribute__((vector_size(WIDTH / sizeof(double) * sizeof(REAL))));

/* A column times `scale`, for the AT_ONCE particles from `first` on or, with `which`, for those that it names. A column
 * that is NULL counts as zero. */
INLINE vec_double column_load(const double *from, double scale, size_t first, const uint32_t *which) {
  vec_double v = {0};
  if (!from)
    return v;
  if (!which) {
    memcpy(&v, from + first, sizeof v);
  } else {
#ifdef __AVX512F__
    v = (vec_double)_mm512_i32gather_pd(_mm256_loadu_si256((const void *)which), from, sizeof *from);
#else
    for (size_t lane = 0; lane < AT_ONCE; lane++)
      v[lane] = from[which[lane]];
#endif
  }
  return v * scale;
}

/* Positions as float records hold them: in units of 1/per_unit, rounded towards zero, modulo 2^32. */
INLINE vec_part column_position(vec_double x, double per_unit) {
  vec_part to = {0};
#if SINGLE
  int32_t at[AT_ONCE];
  for (size_t lane = 0; lane < AT_ONCE; lane++) {
    const double t = x[lane] * per_unit;
    const int64_t whole = t > -9e18 && t < 9e18 ? (int64_t)t : 0; /* any value does for NaN: the step fails elsewhere */
    at[lane] = (int32_t)(uint32_t)(uint64_t)whole;
  }
  memcpy(&to, at, sizeof at);
#else
  (void)x, (void)per_unit;
#endif
  return to;
}

INLINE void column_store(REAL block[PAIR_WIDE][LANES], size_t column, size_t part, vec_double v) {
  *(vec_part *)(void *)(block[column] + part) = __builtin_convertvector(v, vec_part);
}

/* Fills the rows of a block (one per column of the records) with AT_ONCE particles, from lane `part` on. */
INLINE void pack_columns(const struct sph_pair_source *source, size_t first, const uint32_t *which, size_t part,
                         REAL block[PAIR_WIDE][LANES]) {
  const bool artificial = source->column[PAIR_ARTIFICIAL] != NULL, corrected = source->correction[0] != NULL;
  vec_double its[PAIR_NARROW];
  UNROLL
  for (size_t c = 0; c < PAIR_NARROW; c++)
    its[c] = column_load(source->column[c], source->scale[c], first, which);

  const vec_double pressure = column_load(source->pressure, source->scale[PAIR_XX], first, which);
  const vec_double factor = column_load(source->stress_factor, 1, first, which);
  const vec_double square = its[PAIR_DENSITY] * its[PAIR_DENSITY];
  UNROLL
  for (size_t c = PAIR_XX; c < PAIR_ZZ; c++)
    its[c] *= factor;
  its[PAIR_ZZ] = -(its[PAIR_XX] + its[PAIR_YY]);
  its[PAIR_XX] += pressure;
  its[PAIR_YY] += pressure;
  its[PAIR_ZZ] += pressure;
  UNROLL
  for (size_t c = 0; c < 6; c++)
    if (source->volume_weights)
      its[PAIR_XX + c] *= square; /* sigma, not sigma/rho^2 */

  if (artificial) {
    UNROLL
    for (size_t c = PAIR_ARTIFICIAL; c < PAIR_ARTIFICIAL + 6; c++) {
      const vec_double r = column_load(source->column[c], source->scale[c], first, which);
      column_store(block, c, part, source->volume_weights ? r * square : r);
    }
  }
  if (corrected) {
    vec_double b[6], t[9];
    UNROLL
    for (size_t c = 0; c < 6; c++)
      b[c] = column_load(source->correction[c], 1, first, which);
    turn(its + PAIR_XX, b, t);
    UNROLL
    for (size_t c = 0; c < 6; c++)
      its[PAIR_XX + c] = t[c];
    UNROLL
    for (size_t c = 0; c < 3; c++)
      column_store(block, (artificial ? PAIR_TURNED_TOO : PAIR_TURNED) + c, part, t[6 + c]);
  }

  UNROLL
  for (size_t c = 0; c < PAIR_NARROW; c++) {
    if (SINGLE && c <= PAIR_Z)
      *(vec_part *)(void *)(block[c] + part) = column_position(its[c], source->per_unit[c]);
    else
      column_store(block, c, part, its[c]);
  }
}

static void pack_records(const struct sph_pair_source *source, size_t first, const uint32_t *which, size_t count,
                         size_t stride, void *records) {
  REAL block[PAIR_WIDE][LANES] __attribute__((aligned(64)));
  memset(block, 0, sizeof block); /* not all columns are used */
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    const uint32_t *at = which ? which + k : NULL;
    uint32_t last[LANES];
    if (left < LANES) { /* fill up with the last particle */
      for (size_t lane = 0; lane < LANES; lane++) {
        const size_t m = lane < left ? k + lane : count - 1;
        last[lane] = which ? which[m] : (uint32_t)(first + m);
      }
      at = last;
    }
    for (size_t part = 0; part < LANES; part += AT_ONCE)
      pack_columns(source, first + k + part, at ? at + part : NULL, part, block);

    REAL *to = (REAL *)records + k * stride;
    for (size_t c = 0; c < stride; c += LANES) {
      vec r[LANES];
      UNROLL
      for (size_t m = 0; m < LANES; m++)
        r[m] = vec_load(block[c + m]);
      vec_transpose(r);
      for (size_t lane = 0; lane < left; lane++)
        vec_store(to + lane * stride + c, r[lane]);
    }
  }
}

/* The sums of AT_ONCE particles, of which the first `lanes` exist, out of the block's lanes from `part` on. A column is
 * written in whole cache lines, so that few stores wait for memory. */
INLINE void unpack_columns(const struct sph_pair_sink *sink, size_t first, const size_t lanes,
                           REAL block[PAIR_WIDE][LANES], size_t part) {
  const vec_double zero = {0}, one = zero + 1;
  vec_double weight = one, per_mass = one;
  if (SINGLE || !sink->volume_weights) {
    vec_double density = one;
    memcpy(&density, sink->density + first, lanes * sizeof(double));
    weight = sink->volume_weights ? density / sink->density_unit : sink->density_unit / density;
  }
  if (SINGLE) {
    memcpy(&per_mass, sink->mass + first, lanes * sizeof(double));
    per_mass = sink->mass_unit / per_mass;
    weight *= per_mass;
  }
  UNROLL
  for (size_t c = 0; c < SUM_COLUMNS; c++) {
    if (c >= SUM_MOMENT && !sink->column[c])
      break;
    vec_double v = __builtin_convertvector(*(const vec_part *)(const void *)(block[c] + part), vec_double);
    const vec_double own = v;
    if ((c >= SUM_GRADIENT && c < SUM_HEATING) || c >= SUM_MOMENT)
      v *= weight;
    else if (SINGLE && c != SUM_SIGNAL)
      v *= per_mass;
    v *= sink->scale[c];
    if (c == SUM_SIGNAL)
      v = vec_select_double(vec_less_double(zero, own),
                            vec_keep_double(vec_less_double(zero + (double)LEAST_SIGNAL, own), v), -one);
    memcpy(sink->column[c] + first, &v, lanes * sizeof(double));
  }
}

static void unpack_records(const struct sph_pair_sink *sink, size_t first, size_t count, size_t stride,
                           const void *in) {
  const REAL *records = in;
  const size_t columns = sink->column[SUM_MOMENT] ? SUM_COLUMNS : PAIR_NARROW;
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    REAL block[PAIR_WIDE][LANES] __attribute__((aligned(64)));
    for (size_t c = 0; c < columns; c += LANES) {
      vec r[LANES];
      UNROLL
      for (size_t lane = 0; lane < LANES; lane++)
        r[lane] = vec_load(records + (k + (lane < left ? lane : 0)) * stride + c);
      vec_transpose(r);
      UNROLL
      for (size_t m = 0; m < LANES; m++)
        vec_store(block[c + m], r[m]);
    }
    for (size_t part = 0; part < left; part += AT_ONCE) {
      if (left - part >= AT_ONCE)
        unpack_columns(sink, first + k + part, AT_ONCE, block, part);
      else
        unpack_columns(sink, first + k + part, left - part, block, part);
    }
  }
}

static const struct sph_record_kernels record_kernels = {
    .bytes = sizeof(REAL),
    .sum = {{sum_pairs_plain, sum_pairs_artificial}, {sum_pairs_corrected, sum_pairs_both}},
    .pack = pack_records,
    .unpack = unpack_records,
};
