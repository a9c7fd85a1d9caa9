// What the page computes itself. Means and intervals of whole points come from clast; these are for points together,
// and for whole stores, which hold only the main results ready.

// Two-sided 95 % quantile of Student's t: the table up to 10 degrees of freedom, then the series in 1/degrees by which
// the store's views do the same (db/store/views.c).
const T95 = [12.706204736174, 4.302652729749, 3.182446305284, 2.776445105198, 2.570581835636, 2.446911851145,
  2.364624251592, 2.306004135204, 2.262157162798, 2.228138851986];
export function student(degrees) {
  if (!(degrees >= 1)) return NaN;
  if (degrees <= 10) return T95[degrees - 1];
  const x = 1 / degrees;
  return 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 + 1.589534053394 * x) * x) * x) * x;
}

// The 95 % interval of a mean, as clast makes it; the numbers and their reasons are in analysis/statistics/statistics.h.
// range: the label of a result, with its least and largest value.
export function interval(mean, sd, n, {share = 0, least = null, most = null} = {}) {
  const none = {hw95: null, low95: null, high95: null, weak: null};
  if (!(n > 1) || sd === null) return none;
  if (!(sd > 1e-14 * Math.abs(mean))) {
    const seen = 0.05 ** (1 / n);
    return share ? {...none, low95: mean * seen, high95: 1 - (1 - mean) * seen} : none;
  }
  const student95 = (student(n - 1) * sd) / Math.sqrt(n);
  if (!share)
    return {hw95: student95, low95: Math.max(mean - student95, least ?? -Infinity), high95: Math.min(mean + student95, most ?? Infinity), weak: null};
  const near = Math.min(mean, 1 - mean), far = Math.max(mean, 1 - mean);
  const skew = Math.min(Math.sqrt(n), sd / Math.max(near, 1e-300)) * Math.min(1, Math.sqrt(25 / n));
  const hw95 = student95 * (1 + 0.375 * skew);
  const weak = (n < 40 && sd < 0.045 * far) || (n < 20 && sd < 0.14 * far && sd > 0.4 * near);
  return {hw95, low95: Math.max(mean - hw95, 0), high95: Math.min(mean + hw95, 1), weak: Number(weak)};
}

// values in ascending order; linear between neighbours.
export function quantile(sorted, p) {
  const place = p * (sorted.length - 1), below = Math.floor(place);
  return below + 1 < sorted.length ? sorted[below] + (place - below) * (sorted[below + 1] - sorted[below]) : sorted[below];
}

// Its 95 % interval between order statistics, as of `clast scatter` (analysis/statistics/scatter.c): at most low - 1 of n
// values are below the quantile with a probability of at most 0.025, and likewise above.
export function quantileInterval(sorted, p) {
  const n = sorted.length;
  let low = null, high = null, term = n * Math.log1p(-p), below = 0;
  for (let k = 0; k < n && high === null; k++) {
    below += Math.exp(term); // P(X <= k) of the binomial law
    if (low === null && below > 0.025) low = k;
    if (1 - below <= 0.025) high = k;
    term += Math.log(((n - k) / (k + 1)) * (p / (1 - p)));
  }
  return {low: low > 0 ? sorted[low - 1] : null, high: high === null ? null : sorted[high]};
}

export function summary(values, range = {}) {
  const n = values.length;
  const largest = values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  const ordinary = largest === 0 || (largest > 1e-60 && largest < 1e60);
  const scale = ordinary ? 1 : 2 ** Math.min(1000, -Math.floor(Math.log2(largest)) - 1); // so that sums and squares fit
  const mean = values.reduce((sum, value) => sum + value * scale, 0) / n / scale;
  const sd = n > 1 ? Math.sqrt(values.reduce((sum, value) => sum + ((value - mean) * scale) ** 2, 0) / (n - 1)) / scale : null;
  const sorted = Float64Array.from(values).sort();
  return {n, mean, sd, ...interval(mean, sd, n, range), least: sorted[0], quarter: quantile(sorted, 0.25), median: quantile(sorted, 0.5),
    threeQuarters: quantile(sorted, 0.75), largest: sorted[n - 1]};
}

// Spectra of several points as one: the mean over points, as of `clast spectrum --by ""`. Its interval takes the runs: what
// a seed changes at all points alike is in it.
export function pool(spectra) {
  const points = spectra.length, places = new Map();
  for (const bins of spectra)
    for (const bin of bins) {
      const place = places.get(bin.lower) ?? {lower: bin.lower, upper: bin.upper, count: 0, means: []};
      place.count += bin.count;
      place.means.push(bin.count_mean);
      places.set(bin.lower, place);
    }
  return [...places.values()].sort((a, b) => a.lower - b.lower).map(({means, ...bin}) =>
    ({...bin, count_mean: means.reduce((sum, mean) => sum + mean, 0) / points, count_hw95: null}));
}
