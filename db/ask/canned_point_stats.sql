WITH first AS (
  SELECT k.largest_fraction AS k0, t.point_id, t.results_version
  FROM point_total t JOIN run k ON k.run_id = (SELECT f.run_id FROM run f WHERE f.point_id =
    t.point_id AND f.results_version = t.results_version AND f.counts = 1 ORDER BY f.replicate, f.seed LIMIT 1)
), moment AS (
  SELECT f.point_id, f.results_version, count(*) AS n,
    k0, total(r.largest_fraction - k0) AS s0, total((r.largest_fraction - k0) * (r.largest_fraction - k0)) AS q0
  FROM first f CROSS JOIN run r ON r.point_id = f.point_id AND r.results_version = f.results_version AND
    r.counts = 1
  GROUP BY f.point_id, f.results_version
), scatter AS (
  SELECT point_id, results_version, n,
    k0 + s0 / n AS m0, sqrt(max(0, (q0 - s0 * s0 / n) / (n - 1))) AS d0
  FROM moment
)
SELECT point_id, results_version, n, m0 AS mean, d0 AS sd, d0 / sqrt(n) AS se FROM scatter
