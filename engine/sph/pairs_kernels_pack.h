/* Records out of columns and sums back into columns, LANES particles at a time, in one precision (pairs_kernels_sum.h, which comes first, has the
 * transposition). */

INLINE void NAME(column)(const double *from, double scale, size_t first, const uint32_t *which, double to[LANES]) {
  if (!from) {
    for (size_t lane = 0; lane < LANES; lane++)
      to[lane] = 0;
  } else if (which) {
    for (size_t lane = 0; lane < LANES; lane++)
      to[lane] = from[which[lane]] * scale;
  } else {
    for (size_t lane = 0; lane < LANES; lane++)
      to[lane] = from[first + lane] * scale;
  }
}

/* T = sigma B / rho^2, which is not symmetric. */
INLINE void NAME(turn)(double t[PAIR_WIDE][LANES], double b[6][LANES]) {
  static const int row[3][3] = {{PAIR_XX, PAIR_XY, PAIR_XZ}, {PAIR_YX, PAIR_YY, PAIR_YZ}, {PAIR_ZX, PAIR_ZY, PAIR_ZZ}};
  static const int of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (size_t lane = 0; lane < LANES; lane++) {
    double s[6];
    for (int k = 0; k < 6; k++)
      s[k] = t[PAIR_XX + k][lane];
    for (int a = 0; a < 3; a++)
      for (int c = 0; c < 3; c++)
        t[row[a][c]][lane] = b[of[c][0]][lane] * s[of[a][0]] + b[of[c][1]][lane] * s[of[a][1]] + b[of[c][2]][lane] * s[of[a][2]];
  }
}

/* Positions as float records hold them: towards zero, and round the 2^32 quanta that a record can tell apart. */
INLINE void NAME(quanta)(const double x[LANES], double per_quantum, REAL to[LANES]) {
  int32_t at[LANES];
  for (size_t lane = 0; lane < LANES; lane++) {
    const double t = x[lane] * per_quantum;
    const int64_t whole = t > -9e18 && t < 9e18 ? (int64_t)t : 0; /* NaN: anything, the step ends on it elsewhere */
    at[lane] = (int32_t)(uint32_t)(uint64_t)whole;
  }
  memcpy(to, at, sizeof at);
}

/* Of `count` particles: those from `first` on, or those that `which` names. */
static void NAME(pack)(const struct sph_pair_source *source, size_t first, const uint32_t *which, size_t count, size_t stride, REAL *in) {
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
    double room[PAIR_WIDE][LANES], pressure[LANES], correction[6][LANES];
    for (size_t c = 0; c < stride; c++)
      NAME(column)(source->column[c], source->scale[c], first + k, at, room[c]);
    NAME(column)(source->pressure, source->scale[PAIR_XX], first + k, at, pressure);
    for (size_t lane = 0; lane < LANES; lane++)
      room[PAIR_XX][lane] += pressure[lane], room[PAIR_YY][lane] += pressure[lane], room[PAIR_ZZ][lane] += pressure[lane];
    if (source->volume_weights) /* sigma, not sigma/rho^2 */
      for (int c = 0; c < 6; c++)
        for (size_t lane = 0; lane < LANES; lane++) {
          const double square = room[PAIR_DENSITY][lane] * room[PAIR_DENSITY][lane];
          room[PAIR_XX + c][lane] *= square;
          if (stride > PAIR_NARROW) room[PAIR_ARTIFICIAL + c][lane] *= square;
        }
    if (source->correction[0]) {
      for (int c = 0; c < 6; c++)
        NAME(column)(source->correction[c], 1, first + k, at, correction[c]);
      NAME(turn)(room, correction);
    }
    REAL narrow[PAIR_WIDE][LANES] __attribute__((aligned(64)));
    for (size_t c = 0; c < stride; c++)
      for (size_t lane = 0; lane < LANES; lane++)
        narrow[c][lane] = (REAL)room[c][lane];
    for (size_t c = PAIR_X; FIXED && c <= PAIR_Z; c++)
      NAME(quanta)(room[c], source->per_quantum[c], narrow[c]);
    for (size_t c = 0; c < stride; c += LANES) {
      VECTOR r[LANES];
      UNROLL for (size_t m = 0; m < LANES; m++)
        r[m] = *(const VECTOR *)(const void *)narrow[c + m];
      NAME(transpose)(r);
      for (size_t lane = 0; lane < left; lane++)
        *(VECTOR *)(void *)(in + (k + lane) * stride + c) = r[lane];
    }
  }
}

/* What LANES particles got, from room[column][lane]; `lanes` of them count. Lines are written whole, so that few stores wait for
 * memory. Returns how many neighbours they have. */
INLINE double NAME(deliver)(const struct sph_pair_sink *sink, size_t first, size_t lanes, REAL room[PAIR_NARROW][LANES]) {
  double weight[LANES], within = 0;
  for (size_t lane = 0; lane < lanes; lane++)
    weight[lane] = sink->density ? sink->unit / sink->density[first + lane] : 1;
  for (int c = SUM_ACCELERATION; c < SUM_GRADIENT; c++)
    for (size_t lane = 0; lane < lanes; lane++)
      sink->column[c][first + lane] = (double)room[c][lane] * sink->scale[c];
  for (int c = SUM_GRADIENT; c < SUM_HEATING; c++)
    for (size_t lane = 0; lane < lanes; lane++)
      sink->column[c][first + lane] = (double)room[c][lane] * weight[lane] * sink->scale[c];
  for (size_t lane = 0; lane < lanes; lane++) {
    const double count = (double)room[SUM_COUNT][lane];
    sink->column[SUM_HEATING][first + lane] = (double)room[SUM_HEATING][lane] * sink->scale[SUM_HEATING];
    sink->column[SUM_SIGNAL][first + lane] = count > 0 ? (double)room[SUM_SIGNAL][lane] * sink->scale[SUM_SIGNAL] : -1;
    within += count;
  }
  return within;
}

/* The sums of `count` particles from `first` on, whose records begin at `records`. Returns how many neighbours they have. */
static double NAME(unpack)(const struct sph_pair_sink *sink, size_t first, size_t count, size_t stride, const REAL *records) {
  double within = 0;
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    REAL room[PAIR_NARROW][LANES] __attribute__((aligned(64)));
    for (size_t c = 0; c < PAIR_NARROW; c += LANES) {
      VECTOR r[LANES];
      UNROLL for (size_t lane = 0; lane < LANES; lane++)
        r[lane] = *(const VECTOR *)(const void *)(records + (k + (lane < left ? lane : 0)) * stride + c);
      NAME(transpose)(r);
      UNROLL for (size_t m = 0; m < LANES; m++)
        *(VECTOR *)(void *)room[c + m] = r[m];
    }
    within += left == LANES ? NAME(deliver)(sink, first + k, LANES, room) : NAME(deliver)(sink, first + k, left, room);
  }
  return within;
}
