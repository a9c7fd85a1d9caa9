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
of_knob AS (SELECT base_point_id, results_version, quantity, knob, max(iif(base, resolution, NULL)) AS at_base,
    max(iif(base, open, NULL)) AS base_open, max(iif(base, beyond, NULL)) AS base_beyond,
    max(iif(base, left_by_seeds, NULL)) AS base_left, max(resolution) AS largest,
    max(verdict IN ('no-limit', 'no-order')) AS diverges, max(n) AS seeds,
    max(finest_setting) AS finest_setting, max(coarser) AS coarser,
    coalesce(min(iif(n > 0, size, NULL)), 9e999) AS finest
  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)
  GROUP BY base_point_id, results_version, quantity, knob),
asked AS (SELECT DISTINCT base_point_id, results_version, quantity, point_id, false AS named FROM studied
  UNION ALL SELECT base_point_id, results_version, quantity, point_id, true FROM convergence
    WHERE knob = 'settings' AND reference),
knob_path AS MATERIALIZED (SELECT DISTINCT l.base_point_id, l.knob, i.path
  FROM studied l JOIN point_input i ON i.point_id = l.point_id
    LEFT JOIN point_input b ON b.point_id = l.base_point_id AND b.path = i.path WHERE i.value IS NOT b.value),
-- A point belongs to a study, too, if it differs from the scene studied in settings of knobs only.
scene AS MATERIALIZED (SELECT point_id, group_concat(path || quote(value)) AS inputs
  FROM (SELECT point_id, path, value FROM point_input
    WHERE point_id IN (SELECT point_id FROM studied UNION SELECT base_point_id FROM studied)
      AND path NOT IN (SELECT path FROM knob_path) ORDER BY point_id, path)
  GROUP BY point_id),
kin AS MATERIALIZED (SELECT p.point_id, s.base_point_id
  FROM (SELECT DISTINCT base_point_id FROM studied) s JOIN scene b ON b.point_id = s.base_point_id
    JOIN scene p USING (inputs)),
-- There, it has the error of a knob whose setting it has.
of_kin AS (SELECT k.point_id, l.results_version, l.quantity, l.knob, l.resolution AS error, o.diverges,
    coalesce(l.open, 1) AS open, true AS has, o.finest, o.seeds, l.beyond, l.left_by_seeds, o.finest_setting, o.coarser
  FROM kin k JOIN level l USING (base_point_id) JOIN of_knob o USING (base_point_id, results_version, quantity, knob)
  WHERE l.resolution IS NOT NULL AND NOT EXISTS (SELECT 1 FROM knob_path q
    LEFT JOIN point_input i ON i.point_id = l.point_id AND i.path = q.path
    LEFT JOIN point_input n ON n.point_id = k.point_id AND n.path = q.path
    WHERE q.base_point_id = l.base_point_id AND q.knob = l.knob AND i.value IS NOT n.value)),
of_study AS (SELECT a.*, k.knob, coalesce(l.resolution, k.at_base, k.largest) AS error, k.diverges,
    iif(k.largest IS NULL, 2, coalesce(l.open, k.base_open, 1) OR coalesce(l.resolution, k.at_base) IS NULL) AS open,
    coalesce(l.resolution, k.at_base) IS NOT NULL AS has, k.finest, k.seeds,
    iif(l.resolution IS NULL, iif(k.at_base IS NULL, NULL, k.base_beyond), l.beyond) AS beyond,
    coalesce(iif(l.resolution IS NULL, k.base_left, l.left_by_seeds), k.largest) AS left_by_seeds, k.finest_setting,
    k.coarser
  FROM asked a JOIN of_knob k USING (base_point_id, results_version, quantity)
    LEFT JOIN level l ON l.base_point_id = a.base_point_id AND l.results_version = a.results_version
    AND l.quantity = a.quantity AND l.knob = k.knob AND (l.point_id = a.point_id OR a.named AND NOT l.base AND NOT EXISTS
      (SELECT 1 FROM point_input i JOIN point_input b ON b.point_id = a.base_point_id AND b.path = i.path
        JOIN point_input n ON n.point_id = a.point_id AND n.path = i.path
        WHERE i.point_id = l.point_id AND i.value <> b.value AND i.value <> n.value))),
-- Of several studies of a knob, one that has the setting replaces those whose finest level is coarser, or as fine with
-- fewer seeds. Of the others the largest error counts.
placed AS (SELECT *, rank() OVER (PARTITION BY point_id, results_version, quantity, knob
    ORDER BY finest, seeds DESC) AS place
  FROM (SELECT point_id, results_version, quantity, knob, error, diverges, open, has, finest, seeds, beyond,
      left_by_seeds, finest_setting, coarser FROM of_study
    UNION ALL SELECT point_id, results_version, quantity, knob, error, diverges, open, has, finest, seeds, beyond,
      left_by_seeds, finest_setting, coarser FROM of_kin)),
left_by AS MATERIALIZED (SELECT point_id, results_version, quantity, knob, max(error) AS error,
    max(diverges) AS diverges, max(open) AS open, iif(count(beyond) = count(*), max(beyond), NULL) AS beyond,
    max(left_by_seeds) AS left_by_seeds, min(coarser) AS coarser, max(iif(place = 1, finest_setting, NULL)) AS finest,
    max(iif(place = 1, seeds, NULL)) AS seeds
  FROM (SELECT *, min(iif(has, place, NULL)) OVER (PARTITION BY point_id, results_version, quantity, knob) AS best
    FROM placed)
  WHERE place <= coalesce(best, place) GROUP BY point_id, results_version, quantity, knob),
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
  FROM part p GROUP BY point_id, results_version, quantity HAVING sum(error) IS NOT NULL)
