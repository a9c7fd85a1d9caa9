level AS (SELECT * FROM convergence WHERE (resolution IS NOT NULL OR open) AND knob <> 'settings'),
of_knob AS (SELECT base_point_id, results_version, quantity, knob, max(iif(base, resolution, NULL)) AS at_base,
    max(iif(base, open, NULL)) AS base_open, max(resolution) AS largest,
    max(verdict IN ('no-limit', 'no-order')) AS diverges, max(n) AS seeds,
    coalesce(min(iif(n > 0, coalesce(step, -setting), NULL)), 9e999) AS finest -- numbers without a step: finer is larger
  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)
  GROUP BY base_point_id, results_version, quantity, knob),
asked AS (SELECT DISTINCT base_point_id, results_version, quantity, point_id, false AS named FROM level
  UNION ALL SELECT base_point_id, results_version, quantity, point_id, true FROM convergence
    WHERE knob = 'settings' AND reference),
knob_path AS MATERIALIZED (SELECT DISTINCT l.base_point_id, l.knob, i.path
  FROM level l JOIN point_input i ON i.point_id = l.point_id
    LEFT JOIN point_input b ON b.point_id = l.base_point_id AND b.path = i.path WHERE i.value IS NOT b.value),
-- A point belongs to a study, too, if it differs from the scene studied in settings of knobs only.
scene AS MATERIALIZED (SELECT point_id, group_concat(path || quote(value)) AS inputs
  FROM (SELECT point_id, path, value FROM point_input
    WHERE point_id IN (SELECT point_id FROM level UNION SELECT base_point_id FROM level)
      AND path NOT IN (SELECT path FROM knob_path) ORDER BY point_id, path)
  GROUP BY point_id),
kin AS MATERIALIZED (SELECT p.point_id, s.base_point_id
  FROM (SELECT DISTINCT base_point_id FROM level) s JOIN scene b ON b.point_id = s.base_point_id
    JOIN scene p USING (inputs)),
-- There, it has the error of a knob whose setting it has.
of_kin AS (SELECT k.point_id, l.results_version, l.quantity, l.knob, l.resolution AS error, o.diverges,
    coalesce(l.open, 1) AS open, true AS has, o.finest, o.seeds
  FROM kin k JOIN level l USING (base_point_id) JOIN of_knob o USING (base_point_id, results_version, quantity, knob)
  WHERE l.resolution IS NOT NULL AND NOT EXISTS (SELECT 1 FROM knob_path q
    LEFT JOIN point_input i ON i.point_id = l.point_id AND i.path = q.path
    LEFT JOIN point_input n ON n.point_id = k.point_id AND n.path = q.path
    WHERE q.base_point_id = l.base_point_id AND q.knob = l.knob AND i.value IS NOT n.value)),
of_study AS (SELECT a.*, k.knob, coalesce(l.resolution, k.at_base, k.largest) AS error, k.diverges,
    iif(k.largest IS NULL, 2, coalesce(l.open, k.base_open, 1) OR coalesce(l.resolution, k.at_base) IS NULL) AS open,
    coalesce(l.resolution, k.at_base) IS NOT NULL AS has, k.finest, k.seeds
  FROM asked a JOIN of_knob k USING (base_point_id, results_version, quantity)
    LEFT JOIN level l ON l.base_point_id = a.base_point_id AND l.results_version = a.results_version
    AND l.quantity = a.quantity AND l.knob = k.knob AND (l.point_id = a.point_id OR a.named AND NOT l.base AND NOT EXISTS
      (SELECT 1 FROM point_input i JOIN point_input b ON b.point_id = a.base_point_id AND b.path = i.path
        JOIN point_input n ON n.point_id = a.point_id AND n.path = i.path
        WHERE i.point_id = l.point_id AND i.value <> b.value AND i.value <> n.value))),
of_named AS (SELECT base_point_id, point_id, results_version, quantity, sum(error) AS error, max(diverges) AS diverges,
    max(open) AS open FROM of_study WHERE named GROUP BY base_point_id, point_id, results_version, quantity),
-- Of several studies of a knob, one that has the setting replaces those whose finest level is coarser, or as fine with
-- fewer seeds. Of the others the largest error counts.
placed AS (SELECT *, rank() OVER (PARTITION BY point_id, results_version, quantity, knob
    ORDER BY finest, seeds DESC) AS place
  FROM (SELECT point_id, results_version, quantity, knob, error, diverges, open, has, finest, seeds FROM of_study
      WHERE NOT named
    UNION ALL SELECT point_id, results_version, quantity, knob, error, diverges, open, has, finest, seeds FROM of_kin)),
of_point AS (SELECT point_id, results_version, quantity, sum(error) AS error, max(diverges) AS diverges,
    max(open) AS open
  FROM (SELECT point_id, results_version, quantity, knob, max(error) AS error, max(diverges) AS diverges,
      max(open) AS open
    FROM (SELECT *, min(iif(has, place, NULL)) OVER (PARTITION BY point_id, results_version, quantity, knob) AS best
      FROM placed)
    WHERE place <= coalesce(best, place) GROUP BY point_id, results_version, quantity, knob)
  GROUP BY point_id, results_version, quantity
  UNION ALL SELECT s.point_id, s.results_version, s.quantity, abs(s.bias) + s.bias_half_width + r.error, r.diverges,
    r.open FROM convergence s JOIN of_named r USING (base_point_id, results_version, quantity)
  WHERE s.knob = 'settings' AND NOT s.base),
largest AS (SELECT point_id, results_version, quantity, max(error) AS error, max(diverges) AS diverges,
    max(open) AS open, iif(quantity IN (SELECT quantity FROM share), coalesce((SELECT max(r.mean, 1 - r.mean)
      FROM convergence c JOIN convergence r USING (base_point_id, results_version, quantity, knob)
      WHERE c.point_id = p.point_id AND c.results_version = p.results_version AND c.quantity = p.quantity
      AND r.mean IS NOT NULL AND iif(c.mean IS NULL, r.reference, r.point_id = c.point_id) -- finer than any run: as the finest
      ORDER BY c.mean IS NULL, r.n DESC LIMIT 1), 1), 9e999) AS most
  FROM of_point p WHERE error IS NOT NULL GROUP BY point_id, results_version, quantity)
SELECT point_id, results_version, quantity, min(error, most) AS half_width,
  CASE WHEN error > most THEN 'known' WHEN diverges THEN 'diverges' WHEN NOT open THEN 'known'
    WHEN error = 0 THEN 'no-difference' ELSE 'at-least' END AS verdict
FROM largest WHERE error > 0 OR open < 2; -- with a knob that never ran, at least 0 tells nothing
