-- Adds the attempts that are missing, the campaigns of the sessions that were copied, shape files that are missing here,
-- and units that only the other store knows.
INSERT INTO main.attempt (identity, point_id, replicate, seed, session_id, number, reason, exit_code, signal, wall_time,
    peak_memory, limited_to, message, host, rank, failed_at)
  SELECT b.identity, m.ours, b.replicate, b.seed, s.ours, b.number, b.reason, b.exit_code, b.signal, b.wall_time,
    b.peak_memory, b.limited_to, b.message, b.host, b.rank, b.failed_at
  FROM other.attempt b JOIN merge_point m ON m.theirs = b.point_id LEFT JOIN merge_session s ON s.theirs = b.session_id
  WHERE NOT EXISTS (SELECT 1 FROM main.attempt a
    WHERE (a.identity, a.number, a.failed_at) = (b.identity, b.number, b.failed_at));
UPDATE main.session SET campaign_id = of.campaign_id FROM (SELECT m.ours, a.campaign_id FROM merge_session m
    JOIN other.session b ON b.session_id = m.theirs JOIN other.campaign c USING (campaign_id)
    JOIN main.campaign a ON a.name = c.name AND a.document = c.document) AS of
  WHERE of.ours = session.session_id AND session.campaign_id IS NULL;
INSERT OR IGNORE INTO main.shape_file (hash, bytes) SELECT hash, bytes FROM other.shape_file;
UPDATE main.axis SET written_unit = b.written_unit FROM other.axis b
  WHERE b.path = axis.path AND axis.written_unit IS NULL;
