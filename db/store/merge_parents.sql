-- Adds the points, inputs, axes, campaigns and sessions that are missing. The temporary tables merge_point and
-- merge_session map the other store's ids to the ids here. Sessions are the same when the same process started them at
-- the same time.
INSERT OR IGNORE INTO main.column_doc (table_name, column_name, unit, meaning, deterministic)
  SELECT table_name, column_name, unit, meaning, deterministic FROM other.column_doc;

CREATE TEMP TABLE merge_point AS SELECT b.point_id AS theirs, a.point_id AS ours
  FROM other.point b LEFT JOIN main.point a USING (hash);
INSERT INTO main.point (hash, digest, engine, scene_name, scene) SELECT hash, digest, engine, scene_name, scene
  FROM other.point WHERE point_id IN (SELECT theirs FROM merge_point WHERE ours IS NULL);
DROP TABLE merge_point;
CREATE TEMP TABLE merge_point (theirs INTEGER PRIMARY KEY, ours INTEGER NOT NULL);
INSERT INTO merge_point SELECT b.point_id, a.point_id FROM other.point b JOIN main.point a USING (hash);
INSERT OR IGNORE INTO main.point_input (point_id, path, value) SELECT m.ours, i.path, i.value
  FROM other.point_input i JOIN merge_point m ON m.theirs = i.point_id
  WHERE m.ours NOT IN (SELECT point_id FROM main.point_input);
INSERT OR IGNORE INTO main.axis (path, column_name, unit, meaning)
  SELECT path, column_name, unit, meaning FROM other.axis;

INSERT INTO main.campaign (name, document, plan, added_at) SELECT name, document, plan, added_at FROM other.campaign b
  WHERE NOT EXISTS (SELECT 1 FROM main.campaign a WHERE a.name = b.name AND a.document = b.document);
INSERT OR IGNORE INTO main.campaign_point (campaign_id, point_id) SELECT a.campaign_id, m.ours
  FROM other.campaign_point c JOIN other.campaign b ON b.campaign_id = c.campaign_id
  JOIN main.campaign a ON a.name = b.name AND a.document = b.document JOIN merge_point m ON m.theirs = c.point_id;

INSERT INTO main.session (started_at, ended_at, outcome, host, pid, facts)
  SELECT started_at, ended_at, outcome, host, pid, facts FROM other.session b
  WHERE NOT EXISTS (SELECT 1 FROM main.session a
    WHERE (a.started_at, a.host, a.pid) = (b.started_at, b.host, b.pid));
CREATE TEMP TABLE merge_session (theirs INTEGER PRIMARY KEY, ours INTEGER NOT NULL);
INSERT OR IGNORE INTO merge_session SELECT b.session_id, a.session_id FROM other.session b
  JOIN main.session a ON (a.started_at, a.host, a.pid) = (b.started_at, b.host, b.pid);
