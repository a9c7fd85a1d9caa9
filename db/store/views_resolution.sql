WITH level AS (SELECT * FROM convergence WHERE resolution IS NOT NULL OR open),
of_knob AS (SELECT base_point_id, results_version, quantity, knob,
    max(iif(base, resolution, NULL)) AS at_base, max(open) AS open, max(verdict IN ('no-limit', 'no-order')) AS diverges,
    max(iif(base, distance, NULL)) AS base_distance, max(iif(base, distance_half_width, NULL)) AS base_width
  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)
  GROUP BY base_point_id, results_version, quantity, knob),
studied AS (SELECT DISTINCT base_point_id, results_version, quantity, point_id FROM level),
of_study AS (SELECT s.point_id, s.results_version, s.quantity,
    sum(coalesce(l.resolution, k.at_base)) AS half_width, max(k.diverges) AS diverges,
    max(k.open OR coalesce(l.resolution, k.at_base) IS NULL) AS open,
    iif(count(*) = count(coalesce(l.distance, k.base_distance)), sum(coalesce(l.distance, k.base_distance)), NULL)
      AS distance, sum(coalesce(l.distance_half_width, k.base_width)) AS distance_half_width
  FROM studied s JOIN of_knob k USING (base_point_id, results_version, quantity)
    LEFT JOIN level l ON l.base_point_id = s.base_point_id AND l.results_version = s.results_version
    AND l.quantity = s.quantity AND l.knob = k.knob AND l.point_id = s.point_id
  GROUP BY s.base_point_id, s.point_id, s.results_version, s.quantity
  UNION ALL SELECT s.point_id, s.results_version, s.quantity, s.error, (SELECT max(k.diverges) FROM of_knob k
    WHERE k.base_point_id = s.base_point_id AND k.results_version = s.results_version AND
    k.quantity = s.quantity), s.open, NULL, NULL
  FROM convergence s WHERE s.knob = 'settings' AND NOT s.base AND s.error IS NOT NULL)
SELECT point_id, results_version, quantity, max(half_width) AS half_width,
  CASE WHEN max(diverges) THEN 'diverges' WHEN max(open) THEN 'at-least' ELSE 'known' END AS verdict,
  iif(count(*) = 1, max(distance), NULL) AS distance, iif(count(*) = 1, max(distance_half_width), NULL)
    AS distance_half_width
FROM of_study WHERE half_width IS NOT NULL GROUP BY point_id, results_version, quantity;
