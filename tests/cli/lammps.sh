#!/usr/bin/env bash
# LAMMPS under the driver (campaign/examples/lammps). Skipped where the program lmp is missing: Debian has it as lammps.
command -v lmp >/dev/null || { echo "skipped: there is no lmp"; exit 77; }
. "$(dirname "$0")/lib.bash"

cp "$source"/campaign/examples/lammps/* .
expect 0 "$clast" run rates.yaml --allow-commands --seeds 2
python - <<'PY'
import sqlite3
rows = sqlite3.connect('rates.db').execute('select rate, largest_fraction, total_mass, broken, fragment_count from runs order by rate').fetchall()
assert len(rows) == 6 and {row[2] for row in rows} == {1159.0}, rows # no atom is lost
largest, broken = [row[1] for row in rows], [row[3] for row in rows]
assert min(largest[:2]) > max(largest[4:]) and max(broken[:2]) < min(broken[4:]), rows # faster: smaller pieces
assert len({row[3:] for row in rows}) == 6, rows # seeds and rates differ
PY
ok "faster discs break into smaller pieces"
expect 0 "$clast" spectrum rates.db
expect 0 "$clast" replay rates.db 1 --allow-commands
says "agree to the last bit"
done_after 4
