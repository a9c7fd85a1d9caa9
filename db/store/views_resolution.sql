level AS (SELECT * FROM convergence WHERE (resolution IS NOT NULL OR open) AND knob <> 'settings'),
of_knob AS (SELECT base_point_id, results_version, quantity, knob, max(iif(base, resolution, NULL)) AS at_base,
    max(iif(base, open, NULL)) AS base_open, max(resolution) AS largest,
    max(verdict IN ('no-limit', 'no-order')) AS diverges
  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)
  GROUP BY base_point_id, results_version, quantity, knob),
asked AS (SELECT DISTINCT base_point_id, results_version, quantity, point_id, false AS named FROM level
  UNION ALL SELECT base_point_id, results_version, quantity, point_id, true FROM convergence
    WHERE knob = 'settings' AND reference),
of_study AS (SELECT a.*, sum(coalesce(l.resolution, k.at_base, k.largest)) AS error, max(k.diverges) AS diverges,
    max(iif(k.largest IS NULL, 2, coalesce(l.open, k.base_open, 1) OR coalesce(l.resolution, k.at_base) IS NULL))
      AS open
  FROM asked a JOIN of_knob k USING (base_point_id, results_version, quantity)
    LEFT JOIN level l ON l.base_point_id = a.base_point_id AND l.results_version = a.results_version
    AND l.quantity = a.quantity AND l.knob = k.knob AND (l.point_id = a.point_id OR a.named AND NOT l.base AND NOT EXISTS
      (SELECT 1 FROM point_input i JOIN point_input b ON b.point_id = a.base_point_id AND b.path = i.path
        JOIN point_input n ON n.point_id = a.point_id AND n.path = i.path
        WHERE i.point_id = l.point_id AND i.value <> b.value AND i.value <> n.value))
  GROUP BY a.base_point_id, a.point_id, a.results_version, a.quantity, a.named),
of_point AS (SELECT point_id, results_version, quantity, error, diverges, open FROM of_study WHERE NOT named
  UNION ALL SELECT s.point_id, s.results_version, s.quantity, abs(s.bias) + s.bias_half_width + r.error, r.diverges,
    r.open FROM convergence s JOIN of_study r USING (base_point_id, results_version, quantity)
  WHERE r.named AND s.knob = 'settings' AND NOT s.base),
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
