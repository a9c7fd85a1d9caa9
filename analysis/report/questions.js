// All SQL text of the page. The page reads small SQLite files of its own (db/ask/page.h) and whole stores that a reader
// drops on it; both have these tables or views. No text of a file becomes SQL: names are quoted by name().

export const name = (text) => `"${String(text).replaceAll('"', '""')}"`;

export const tables = 'SELECT name FROM sqlite_schema';
export const columns = 'SELECT name FROM pragma_table_info(:table)';
export const facts = 'SELECT name, value FROM fact';
export const labels = 'SELECT column_name, label, unit, factor, share, least, most FROM label';
export const units = `SELECT column_name, min(unit) AS unit FROM column_doc WHERE unit <> '1'
  GROUP BY column_name HAVING count(DISTINCT unit) = 1`;
export const axes = 'SELECT column_name, path, unit, meaning FROM axis ORDER BY path';
export const fixedAxes = 'SELECT column_name, path, unit, meaning FROM fixed_axis ORDER BY path';
export const canned = 'SELECT name, doc, sql, parameters FROM question';

// Without an earlier form of a campaign: one whose points a later campaign of its name has.
export const campaigns = `SELECT campaign_id, name, document, added_at FROM campaign WHERE NOT EXISTS (SELECT 1 FROM campaign AS later
  WHERE later.name = campaign.name AND later.campaign_id > campaign.campaign_id AND NOT EXISTS (SELECT 1 FROM campaign_point AS p
    WHERE p.campaign_id = campaign.campaign_id
    AND p.point_id NOT IN (SELECT point_id FROM campaign_point AS q WHERE q.campaign_id = later.campaign_id))) ORDER BY campaign_id`;
export const sessions = `SELECT started_at, ended_at, outcome, host, json_extract(facts, '$.version') AS version,
  json_extract(facts, '$.commit') AS commit_id, json_extract(facts, '$.compiler') AS compiler
  FROM session ORDER BY session_id`;
export const failedRuns = `SELECT state AS reason, count(*) AS n, min(message) AS example FROM runs
  WHERE counts = 0 AND surplus = 0 GROUP BY state`;
export const failedAttempts = 'SELECT reason, count(*) AS n, min(message) AS example FROM attempt GROUP BY reason';

// Newer versions of results come later. A study also stores finer settings, without runs, to tell their error.
export const points = (axes, counts) => `SELECT point_id, scene, results_version, n, failed, censored, surplus, failed_attempts${counts}
  ${axes.map((axis) => `, ${name(axis)}`).join('')} FROM points WHERE n > 0 OR failed > 0 OR point_id IN (SELECT point_id FROM campaign_point)
  ORDER BY point_id, results_version`;
export const mainStatistics = (quantity) => `SELECT point_id, results_version, n, ${name(`${quantity}_mean`)} AS mean,
  ${name(`${quantity}_sd`)} AS sd FROM points ORDER BY results_version`;
export const otherStatistics = 'SELECT point_id, results_version, n, mean, sd FROM means WHERE quantity = :quantity ORDER BY results_version';
// The complete mass is there for the spectrum, also if it has one value.
export const otherQuantities = `SELECT quantity FROM means GROUP BY quantity
  HAVING quantity <> 'complete_mass' OR min(mean) < max(mean)`;
// Of a whole store, which has no table of means: two moments about the first value.
export const statisticsOfRuns = (quantity) => `SELECT point_id, results_version, count(${name(quantity)}) AS n,
  avg(${name(quantity)}) AS mean, sqrt(max(0, avg(d * d) - avg(d) * avg(d)) * count(d) / (count(d) - 1)) AS sd
  FROM (SELECT *, ${name(quantity)} - first_value(${name(quantity)}) OVER (PARTITION BY point_id, results_version) AS d
  FROM runs WHERE counts) GROUP BY point_id, results_version ORDER BY results_version`;
export const ranges = (names) => `SELECT ${names.map((n, i) => `min(${name(n)}) AS l${i}, max(${name(n)}) AS h${i}`).join(', ')} FROM runs WHERE counts`;
// With the reason why tables and pictures leave an exponent out (pooled_exponent_untold() in C). A page has it, and so has
// the view of a store; in an older one the fragments of a single run tell the standard error, those of several do not.
const untoldOfOlder = `CASE WHEN n < 5 THEN 'fewer than 5 fragments' WHEN beta IS NULL THEN 'fewer than 5 different masses'
  WHEN hw95 >= 2 THEN 'an interval of ± 2 or wider' WHEN hw95 IS NULL AND coalesce((SELECT max(r.standard_error) FROM estimates r
    WHERE r.point_id = e.point_id AND r.results_version = e.results_version AND r.run_id IS NOT NULL AND r.counts AND r.headline
    HAVING count(*) = 1), 1) >= 1 THEN 'no interval' END`;
export const exponents = (viewed) => `SELECT point_id, results_version, n, beta AS mean, hw95, lower, upper,
  (${viewed ? 'untold' : untoldOfOlder}) AS untold FROM estimates e WHERE run_id IS NULL AND headline ORDER BY results_version`;
export const resolution = `SELECT point_id, half_width, verdict FROM resolution
  WHERE quantity = :quantity ORDER BY results_version`;

// Runs in doubt of each point, and the words that mark the quantity. A whole store has only the words, and each of them
// marks every result here: the conditions are in clast.
export const doubts = `SELECT point_id, sum(runs) AS doubtful, sum(runs * withheld) AS withheld, group_concat(DISTINCT marks) AS words
  FROM doubt JOIN doubt_mark USING (engine, words) WHERE quantity = :quantity GROUP BY point_id`;
export const doubtsOfRuns = (doubtful) => `SELECT point_id, count(*) AS doubtful, 0 AS withheld, group_concat(DISTINCT warnings) AS words
  FROM runs WHERE counts AND ${doubtful} GROUP BY point_id`;
// Of the results that rest on it, or of all of them; those that withhold a value come last.
export const sentences = `SELECT word, sentence, ' ' || replace(results, '.', '_') || ' ' AS results, withheld FROM doubt_word
  JOIN (SELECT DISTINCT engine FROM doubt) USING (engine) ORDER BY withheld, sentence DESC`;
export const marks = 'SELECT engine, words FROM doubt_mark WHERE quantity = :quantity';

export const modes = `SELECT point_id, lower_mode, upper_mode, upper_share, upper_low, upper_high FROM modes
  WHERE quantity = :quantity`;
export const quantiles = 'SELECT share, value, low, high FROM quantile WHERE quantity = :quantity AND point_id = :point';

export const spectrum = `SELECT results_version, n, lower, upper, count, count_mean, count_sd, count_hw95 FROM spectra
  WHERE point_id = :point ORDER BY results_version, lower`;
export const widestSpectrum = 'SELECT point_id FROM spectra GROUP BY point_id ORDER BY count(*) DESC, point_id LIMIT 1';
export const completeMass = `SELECT mean FROM means WHERE quantity = 'complete_mass' AND point_id = :point ORDER BY results_version DESC LIMIT 1`;
export const completeMassOfRuns = 'SELECT avg(complete_mass) AS mean FROM runs WHERE counts AND point_id = :point';

export const values = (quantity) => `SELECT results_version, ${name(quantity)} AS value FROM runs
  WHERE counts AND point_id = :point AND ${name(quantity)} IS NOT NULL ORDER BY results_version, replicate`;
export const runs = (columns, doubtful) => `SELECT run_id, point_id, replicate, CAST(seed AS TEXT) AS seed, state, counts, surplus, engine, warnings, ${doubtful} AS doubtful
  ${columns.map((column) => `, ${name(column)}`).join('')} FROM runs WHERE point_id = :point ORDER BY replicate, seed`;
export const run = 'SELECT * FROM runs WHERE run_id = :run';
export const pictures = 'SELECT run_id, quantile, png FROM picture WHERE point_id = :point ORDER BY quantile NULLS LAST, run_id';
export const pictureOfRun = 'SELECT run_id, quantile, png FROM picture WHERE run_id = :run';
export const differences = 'SELECT first_point, point_id, pairs, difference, hw95 FROM difference WHERE quantity = :quantity';
export const pairs = 'SELECT DISTINCT first_point, point_id FROM difference';
export const keptRuns = 'SELECT count(*) AS n FROM runs';

// For readers: what the box for SQL begins with, and the first run of a point.
export const start = 'SELECT * FROM points';
export const firstRun = (point) => `(SELECT min(run_id) FROM runs WHERE point_id = ${Number(point)})`;
