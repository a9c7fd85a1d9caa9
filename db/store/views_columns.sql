-- The rows of column_doc for the views: first axis columns, statistics and the views' own columns; the others inherit from
-- their table.
DELETE FROM column_doc WHERE table_name IN ('runs', 'points', 'spectra', 'estimates', 'resolution');
INSERT INTO column_doc (table_name, column_name, unit, meaning)
  SELECT v.column1, column_name, unit, meaning || ' (input ' || path || ')'
  FROM axis, (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v;
INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning)
  SELECT v.column1, w.column1, NULL, w.column2
  FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v,
    (VALUES ('scene', 'name of the scene the inputs started from'),
      ('study', '1: only studies and searches (clast converge, find, ...) asked for the point; 0 also in a store without other campaigns')) w;
INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning) VALUES
  ('runs', 'doubtful', '1', '1: the run breaks a condition, so that results are in doubt; clast explain WORD says what a word of warnings means'),
  ('points', 'n', '1', 'runs that count: completed, or ended at their time, not surplus, not excluded'),
  ('points', 'failed', '1', 'runs without a usable result: it is not finite or not valid, or every attempt died; of several results_version, the newest has those that died'),
  ('points', 'excluded', '1', 'runs that a person excluded (clast exclude)'),
  ('points', 'failed_attempts', '1', 'attempts that failed: limits, crashes, lost workers'),
  ('points', 'doubtful', '1', 'runs behind the means that break a condition: their values are in doubt, or have no meaning'),
  ('points', 'doubts', NULL, 'warnings of these runs, each different text once; clast explain WORD says what a word means'),
  ('spectra', 'n', '1', 'runs of the point that count'),
  ('spectra', 'count', '1', 'fragments in the bin, of all runs'),
  ('spectra', 'mass', (SELECT unit FROM column_doc WHERE table_name = 'bin' AND column_name = 'lower'), 'their mass'),
  ('spectra', 'count_mean', '1', 'fragments in the bin per run'),
  ('spectra', 'count_sd', '1', 'standard deviation of the count between runs'),
  ('spectra', 'count_hw95', '1', 'half width of the 95 % confidence interval of count_mean (Student); NULL: one run, or all are equal to 14 digits'),
  ('spectra', 'density', (SELECT CASE unit WHEN 'kg/m' THEN 'm/kg' WHEN 'kg' THEN '1/kg' ELSE '1/kg or m/kg' END
    FROM column_doc WHERE table_name = 'bin' AND column_name = 'lower'), 'fragment number density F(m): share of all fragments per unit mass; its integral over mass is 1'),
  ('estimates', 'untold', NULL, 'of a point: why tables show no beta, whose whole number is not known; NULL: they show it'),
  ('resolution', 'point_id', NULL, 'the point: the scene of a study, or one of its levels'),
  ('resolution', 'results_version', NULL, 'version of the engine''s results that was studied'),
  ('resolution', 'quantity', NULL, 'the result, as a column of the view runs; beta or beta_METHOD_WINDOW: an exponent of all runs of a point'),
  ('resolution', 'half_width', NULL, 'how far finer settings may move the result, in its unit: all knobs that were studied'),
  ('resolution', 'verdict', NULL, 'known: half_width is a bound, which can be as large as the result; no-difference: all runs of the settings are equal; at-least: no limit is known yet, so that half_width may be too small; diverges: the result does not converge');
INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning)
  SELECT 'points', d.column_name || s.column1,
    CASE s.column1 WHEN '_weak' THEN '1' WHEN '_resolution_verdict' THEN NULL ELSE d.unit END, s.column2 || d.meaning
  FROM column_doc d, (VALUES ('_mean', 'mean over runs: '), ('_sd', 'standard deviation between runs: '),
    ('_se', 'standard error of the mean: '),
    ('_hw95', 'half width of the 95 % confidence interval of the mean; NULL: one run, or all are equal to 14 digits: '),
    ('_low95', 'lower end of this interval; of a share also when all runs are equal to 14 digits: '),
    ('_high95', 'upper end of this interval; of a share also when all runs are equal to 14 digits: '),
    ('_weak', '1: too few runs of this kind for the interval of this share: '),
    ('_resolution', 'how far finer settings may move the mean (view resolution): '),
    ('_resolution_verdict', 'known, no-difference, at-least, diverges, or not-studied: ')) s
  WHERE d.table_name = 'run' AND d.column_name || s.column1 IN (SELECT name FROM pragma_table_info('points'));
-- A result that several engines have is that of an engine of this store's points: energies of `dem` are in J/m, of `sph` in J.
-- CROSS JOIN: SQLite lists the columns of a view once, not once for each row of column_doc.
INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning)
  WITH of_points AS MATERIALIZED (SELECT DISTINCT 'result_' || engine AS table_name FROM point),
  d AS MATERIALIZED (
    SELECT table_name, unit, meaning, column_name, table_name || '_' || column_name AS long_name FROM column_doc
    WHERE table_name IN ('run', 'point', 'point_total', 'point_spectrum', 'bin', 'estimate') OR table_name GLOB 'result_*')
  SELECT v.column1, c.name, d.unit, d.meaning
  FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v CROSS JOIN pragma_table_info(v.column1) c
    CROSS JOIN (SELECT column_name AS name, * FROM d UNION ALL SELECT long_name, * FROM d) d ON d.name = c.name
  ORDER BY CASE WHEN d.table_name IN ('estimate', 'point_total', 'point_spectrum', 'bin') THEN v.column1 IN ('runs')
    ELSE v.column1 NOT IN ('runs') END, d.table_name GLOB 'result_*', d.table_name NOT IN of_points, d.table_name;
