-- A newer SQLite takes no more than a thousand uses of such tables in a question, with those inside of them: what needs
-- the keys alone takes `studied`.
studied AS (SELECT * FROM convergence WHERE (resolution IS NOT NULL OR open) AND knob <> 'settings'),
row AS MATERIALIZED (SELECT *, coalesce(step, 1.0 / setting) AS size, -- numbers without a step: finer is larger
    abs(coalesce(distance, bias)) / resolution AS middle -- of its interval: what more seeds leave, as a share
  FROM studied),
finest AS MATERIALIZED (SELECT * FROM row WHERE reference AND n > 0),
-- What a law of order 0.5 leaves beyond the finest level, by the changes from coarser ones.
past AS MATERIALIZED (SELECT base_point_id, results_version, quantity, knob, count(*) AS coarser,
    max((abs(r.bias) + r.bias_half_width) / (sqrt(r.size / f.size) - 1)) AS beyond
  FROM row r JOIN finest f USING (base_point_id, results_version, quantity, knob)
  WHERE r.n > 0 AND r.size > f.size GROUP BY base_point_id, results_version, quantity, knob),
level AS MATERIALIZED (SELECT r.*, f.setting AS finest_setting, ifnull(p.coarser, 0) AS coarser,
    iif(NOT r.open, 0, iif(r.n > 0 OR r.size < f.size, p.beyond, NULL)) AS beyond,
    r.resolution * coalesce(min(r.middle, 1), iif(r.open, 1, min(f.middle, 1)), 1) AS left_by_seeds
  FROM row r LEFT JOIN finest f USING (base_point_id, results_version, quantity, knob)
    LEFT JOIN past p USING (base_point_id, results_version, quantity, knob)),
of_knob AS MATERIALIZED (SELECT base_point_id, results_version, quantity, knob, max(resolution) AS largest,
    max(verdict IN ('no-limit', 'no-order')) AS diverges, max(n) AS seeds, max(finest_setting) AS finest_setting,
    max(coarser) AS coarser, coalesce(min(iif(n > 0, size, NULL)), 9e999) AS finest,
    sign(total(size) * total(setting) - count(*) * total(size * setting)) AS up -- 1: larger settings are finer
  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)
  GROUP BY base_point_id, results_version, quantity, knob),
-- main: the input that is the setting; the others of the knob follow it.
knob_path AS MATERIALIZED (SELECT l.base_point_id, l.knob, i.path,
    min(abs(i.value - l.setting) <= 1e-5 * abs(i.value)) AS main
  FROM studied l JOIN point_input i ON i.point_id = l.point_id
    LEFT JOIN point_input b ON b.point_id = l.base_point_id AND b.path = i.path WHERE i.value IS NOT b.value
  GROUP BY l.base_point_id, l.knob, i.path),
-- A point belongs to a study if it differs from the scene studied in settings of knobs only, and if it is the one with
-- which the study compares its named settings.
scene AS MATERIALIZED (SELECT point_id, group_concat(path || quote(value)) AS inputs
  FROM (SELECT point_id, path, value FROM point_input
    WHERE point_id IN (SELECT point_id FROM studied UNION SELECT base_point_id FROM studied)
      AND path NOT IN (SELECT path FROM knob_path) ORDER BY point_id, path)
  GROUP BY point_id),
kin AS (SELECT p.point_id, s.base_point_id
  FROM (SELECT DISTINCT base_point_id FROM studied) s JOIN scene b ON b.point_id = s.base_point_id
    JOIN scene p USING (inputs)
  UNION SELECT point_id, base_point_id FROM convergence WHERE knob = 'settings' AND reference),
-- Of several studies of a knob the one with the finest level tells its errors, of those the one with most seeds.
placed AS (SELECT *, rank() OVER (PARTITION BY point_id, results_version, quantity, knob ORDER BY finest, seeds DESC)
    AS place
  FROM kin JOIN of_knob USING (base_point_id)),
-- The inputs of a knob at a point, and the one that is its setting.
at AS MATERIALIZED (SELECT base_point_id, knob, point_id, max(iif(main, value, NULL)) AS place,
    group_concat(quote(value)) AS inputs
  FROM (SELECT q.*, k.point_id, n.value FROM kin k JOIN knob_path q USING (base_point_id)
      LEFT JOIN point_input n ON n.point_id = k.point_id AND n.path = q.path ORDER BY k.point_id, q.path)
  GROUP BY base_point_id, knob, point_id),
-- The level that tells the error of a point: the one with its setting, else the next coarser one, whose error is no
-- smaller. Coarser than all levels, or a choice that is none of them: the largest error counts, which is no bound.
chosen AS (SELECT p.*, min(l.size), l.resolution, l.left_by_seeds, l.open, l.beyond
  FROM placed p LEFT JOIN at a USING (base_point_id, knob, point_id)
    LEFT JOIN (SELECT l.*, t.inputs FROM level l LEFT JOIN at t USING (base_point_id, knob, point_id)
      WHERE resolution IS NOT NULL) l
    ON (l.base_point_id, l.results_version, l.quantity, l.knob) = (p.base_point_id, p.results_version, p.quantity, p.knob)
      AND (l.inputs IS a.inputs OR p.up * (a.place - l.setting) > 0)
  WHERE p.place = 1
  GROUP BY p.point_id, p.base_point_id, p.results_version, p.quantity, p.knob),
left_by AS MATERIALIZED (SELECT point_id, results_version, quantity, knob,
    max(coalesce(resolution, largest)) AS error, max(diverges) AS diverges,
    max(iif(largest IS NULL, 2, coalesce(open, 1))) AS open,
    iif(count(beyond) = count(*), max(beyond), NULL) AS beyond,
    max(coalesce(left_by_seeds, largest)) AS left_by_seeds, min(coarser) AS coarser,
    max(finest_setting) AS finest, max(seeds) AS seeds
  FROM chosen GROUP BY point_id, results_version, quantity, knob),
-- Other named settings, unless they are a level of a knob: the parts of their reference, and how far they are from it.
named AS MATERIALIZED (SELECT s.point_id, s.results_version, s.quantity, r.point_id AS reference,
    max(abs(s.bias) + s.bias_half_width) AS error, max(abs(s.bias)) AS left_by_seeds, max(s.n) AS seeds
  FROM convergence s JOIN convergence r USING (base_point_id, results_version, quantity, knob)
  WHERE s.knob = 'settings' AND r.reference AND NOT s.base AND NOT s.reference AND s.bias_half_width IS NOT NULL
    AND (r.base_point_id, r.results_version, r.quantity) IN (SELECT base_point_id, results_version, quantity
      FROM studied WHERE resolution IS NOT NULL)
    AND (s.point_id, s.results_version, s.quantity) NOT IN (SELECT point_id, results_version, quantity FROM studied)
  GROUP BY s.point_id, s.results_version, s.quantity),
part AS (SELECT * FROM left_by
    WHERE (point_id, results_version, quantity) NOT IN (SELECT point_id, results_version, quantity FROM named)
  UNION ALL SELECT n.point_id, n.results_version, n.quantity, l.knob, l.error, l.diverges, l.open, l.beyond,
    l.left_by_seeds, l.coarser, l.finest, l.seeds
  FROM named n JOIN left_by l ON l.point_id = n.reference AND l.results_version = n.results_version
    AND l.quantity = n.quantity
  UNION ALL SELECT point_id, results_version, quantity, 'settings', error, 0, 0, 0, left_by_seeds, 0, NULL, seeds
    FROM named),
whole AS (SELECT point_id, results_version, quantity, sum(error) AS error, max(diverges) AS diverges,
    max(open) AS open, iif(quantity IN (SELECT quantity FROM share), coalesce((SELECT max(r.mean, 1 - r.mean)
      FROM of_runs r WHERE (r.point_id, r.results_version, r.quantity) = (p.point_id, p.results_version, p.quantity)),
    (SELECT max(r.mean, 1 - r.mean)
      FROM convergence c JOIN convergence r USING (base_point_id, results_version, quantity, knob)
      WHERE c.point_id = p.point_id AND c.results_version = p.results_version AND c.quantity = p.quantity
      AND r.mean IS NOT NULL AND iif(c.mean IS NULL, r.reference, r.point_id = c.point_id) -- finer than any run: as the finest
      ORDER BY c.mean IS NULL, r.n DESC LIMIT 1), 1), 9e999) AS most
  FROM part p GROUP BY point_id, results_version, quantity HAVING sum(error) IS NOT NULL),
-- The error of a setting, on every screen. No error of a share is larger than `most`, its distance from the farther end
-- of 0 to 1. A knob that never ran tells nothing.
told AS (SELECT point_id, results_version, quantity, min(error, most) AS half_width,
    CASE WHEN error > most THEN 'known' WHEN diverges THEN 'diverges' WHEN NOT open THEN 'known'
      WHEN error = 0 THEN 'no-difference' ELSE 'at-least' END AS verdict
  FROM whole WHERE error > 0 OR open < 2)
