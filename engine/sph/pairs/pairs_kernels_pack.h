/* Records out of columns and sums back into columns, LANES particles at a time, in one precision (pairs_kernels_sum.h,
 * which comes first, has the transposition). Columns are of double: so many particles at once as registers of those
 * hold. */

typedef REAL NAME(narrow) __attribute__((vector_size(WIDTH / sizeof(double) * sizeof(REAL))));

/* `scale` times what the column has for AT_ONCE particles, those from `first` on or those that `which` names. */
INLINE double_vector NAME(column)(const double *from, double scale, size_t first, const uint32_t *which) {
  double_vector v = {0};
  if (!from)
    return v;
  if (!which) {
    memcpy(&v, from + first, sizeof v);
  } else {
#ifdef AVX512
    v = (double_vector)_mm512_i32gather_pd(_mm256_loadu_si256((const void *)which), from, sizeof *from);
#else
    for (size_t lane = 0; lane < AT_ONCE; lane++)
      v[lane] = from[which[lane]];
#endif
  }
  return v * scale;
}

/* Positions as float records hold them: towards zero, and round the 2^32 quanta that a record can tell apart. */
INLINE NAME(narrow) NAME(quanta)(double_vector x, double per_quantum) {
  NAME(narrow) to = {0};
#if FIXED
  int32_t at[AT_ONCE];
  for (size_t lane = 0; lane < AT_ONCE; lane++) {
    const double t = x[lane] * per_quantum;
    const int64_t whole = t > -9e18 && t < 9e18 ? (int64_t)t : 0; /* NaN: anything, the step ends on it elsewhere */
    at[lane] = (int32_t)(uint32_t)(uint64_t)whole;
  }
  memcpy(&to, at, sizeof at);
#else
  (void)x, (void)per_quantum;
#endif
  return to;
}

/* Of `count` particles: those from `first` on, or those that `which` names. */
static void NAME(pack)(const struct sph_pair_source *source, size_t first, const uint32_t *which, size_t count,
                       size_t stride, REAL *in) {
  const bool artificial = source->column[PAIR_ARTIFICIAL] != NULL, corrected = source->correction[0] != NULL;
  const size_t turned = artificial ? PAIR_TURNED_TOO : PAIR_TURNED;
  REAL room[PAIR_WIDE][LANES] __attribute__((aligned(64)));
  memset(room, 0, sizeof room); /* there are more columns than are used */
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    const uint32_t *at = which ? which + k : NULL;
    uint32_t last[LANES];
    if (left < LANES) { /* the last ones, the very last again and again */
      for (size_t lane = 0; lane < LANES; lane++) {
        const size_t m = lane < left ? k + lane : count - 1;
        last[lane] = which ? which[m] : (uint32_t)(first + m);
      }
      at = last;
    }
    for (size_t part = 0; part < LANES; part += AT_ONCE) {
      const size_t from = first + k + part;
      const uint32_t *these = at ? at + part : NULL;
      double_vector its[PAIR_NARROW], more[6], t[9], b[6];
      UNROLL
      for (size_t c = 0; c < PAIR_NARROW; c++)
        its[c] = NAME(column)(source->column[c], source->scale[c], from, these);
      const double_vector pressure = NAME(column)(source->pressure, source->scale[PAIR_XX], from, these);
      const double_vector factor = NAME(column)(source->stress_factor, 1, from, these);
      UNROLL
      for (size_t c = PAIR_XX; c < PAIR_ZZ; c++)
        its[c] *= factor;
      its[PAIR_ZZ] = -(its[PAIR_XX] + its[PAIR_YY]);
      its[PAIR_XX] += pressure, its[PAIR_YY] += pressure, its[PAIR_ZZ] += pressure;
      const double_vector square = its[PAIR_DENSITY] * its[PAIR_DENSITY];
      UNROLL
      for (size_t c = 0; c < 6; c++)
        if (source->volume_weights)
          its[PAIR_XX + c] *= square; /* sigma, not sigma/rho^2 */
      if (artificial) {
        UNROLL
        for (size_t c = 0; c < 6; c++) {
          more[c] = NAME(column)(source->column[PAIR_ARTIFICIAL + c], source->scale[PAIR_ARTIFICIAL + c], from, these);
          if (source->volume_weights)
            more[c] *= square;
          *(NAME(narrow) *)(void *)(room[PAIR_ARTIFICIAL + c] + part) = __builtin_convertvector(more[c], NAME(narrow));
        }
      }
      if (corrected) {
        UNROLL
        for (size_t c = 0; c < 6; c++)
          b[c] = NAME(column)(source->correction[c], 1, from, these);
        double_turn(its + PAIR_XX, b, t);
        UNROLL
        for (size_t c = 0; c < 6; c++)
          its[PAIR_XX + c] = t[c];
        UNROLL
        for (size_t c = 0; c < 3; c++)
          *(NAME(narrow) *)(void *)(room[turned + c] + part) = __builtin_convertvector(t[6 + c], NAME(narrow));
      }
      UNROLL
      for (size_t c = 0; c < PAIR_NARROW; c++)
        *(NAME(narrow) *)(void *)(room[c] + part) = FIXED && c <= PAIR_Z
                                                        ? NAME(quanta)(its[c], source->per_quantum[c])
                                                        : __builtin_convertvector(its[c], NAME(narrow));
    }
    for (size_t c = 0; c < stride; c += LANES) {
      VECTOR r[LANES];
      UNROLL
      for (size_t m = 0; m < LANES; m++)
        r[m] = *(const VECTOR *)(const void *)room[c + m];
      NAME(transpose)(r);
      for (size_t lane = 0; lane < left; lane++)
        *(VECTOR *)(void *)(in + (k + lane) * stride + c) = r[lane];
    }
  }
}

/* Columns of the first `lanes` of the AT_ONCE particles that stand at `part` of room[column]. Lines are written whole,
 * so that few stores wait for memory. */
INLINE void NAME(deliver)(const struct sph_pair_sink *sink, size_t first, const size_t lanes,
                          REAL room[PAIR_WIDE][LANES], size_t part) {
  const double_vector zero = {0}, one = zero + 1;
  double_vector weight = one, per_mass = one;
  if (FIXED || !sink->volume_weights) {
    double_vector density = one;
    memcpy(&density, sink->density + first, lanes * sizeof(double));
    weight = sink->volume_weights ? density / sink->density_unit : sink->density_unit / density;
  }
  if (FIXED) {
    memcpy(&per_mass, sink->mass + first, lanes * sizeof(double));
    per_mass = sink->mass_unit / per_mass;
    weight *= per_mass;
  }
  UNROLL
  for (size_t c = 0; c < SUM_COLUMNS; c++) {
    if (c >= SUM_MOMENT && !sink->column[c])
      break;
    double_vector v = __builtin_convertvector(*(const NAME(narrow) *)(const void *)(room[c] + part), double_vector);
    const double_vector own = v;
    if ((c >= SUM_GRADIENT && c < SUM_HEATING) || c >= SUM_MOMENT)
      v *= weight;
    else if (FIXED && c != SUM_SIGNAL)
      v *= per_mass;
    v *= sink->scale[c];
    if (c == SUM_SIGNAL)
      v = double_select(double_less(zero, own), double_keep(double_less(zero + (double)LEAST_SIGNAL, own), v), -one);
    memcpy(sink->column[c] + first, &v, lanes * sizeof(double));
  }
}

/* The sums of `count` particles from `first` on, whose records begin at `records`. */
static void NAME(unpack)(const struct sph_pair_sink *sink, size_t first, size_t count, size_t stride,
                         const REAL *records) {
  const size_t columns = sink->column[SUM_MOMENT] ? SUM_COLUMNS : PAIR_NARROW;
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    REAL room[PAIR_WIDE][LANES] __attribute__((aligned(64)));
    for (size_t c = 0; c < columns; c += LANES) {
      VECTOR r[LANES];
      UNROLL
      for (size_t lane = 0; lane < LANES; lane++)
        r[lane] = *(const VECTOR *)(const void *)(records + (k + (lane < left ? lane : 0)) * stride + c);
      NAME(transpose)(r);
      UNROLL
      for (size_t m = 0; m < LANES; m++)
        *(VECTOR *)(void *)room[c + m] = r[m];
    }
    for (size_t part = 0; part < left; part += AT_ONCE) {
      if (left - part >= AT_ONCE)
        NAME(deliver)(sink, first + k + part, AT_ONCE, room, part);
      else
        NAME(deliver)(sink, first + k + part, left - part, room, part);
    }
  }
}
