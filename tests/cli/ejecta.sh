#!/usr/bin/env bash
# Ejecta of impacts over their speed: clast spectrum --ejecta, the table of the store, replay, and the escape speed.
. "$(dirname "$0")/lib.bash"

cat >shots.yaml <<'YAML'
name: shots
scene: basalt-sphere
set: {fidelity.particles: 500, stop.end_time: 60 us}
vary: {impact.speed: [2 km/s, 4 km/s]}
seeds: {per_point: 2}
YAML
expect 0 "$clast" run shots.yaml -j 2 --quiet
expect 0 "$clast" check shots.db
# A result by the name that it has in a scene: its error is that of the column.
expect 0 "$clast" stats shots.db -Q ejecta.mass_fraction
says "clast: ejecta_mass_fraction: intervals are over"
expect 0 "$clast" plot shots.db shots.png -Q ejecta.mass_fraction --keep-script
grep -q "^y_label.*share of the target.*mass" shots.gp || fail "a share of what: $(grep ^y_label shots.gp)"
expect 0 "$clast" spectrum shots.db --ejecta
prints "momentum [kg m/s]"; says "intervals over runs"; says "coarse"
# All of the table is what the results say; the table of the command has the means of a point.
expect 0 "$clast" spectrum shots.db --ejecta --json
cat >sums.py <<'PY'
import json, sqlite3
rows = json.load(open('out'))
d = sqlite3.connect('shots.db')
near = lambda a, b: abs(a - b) <= 1e-12 * abs(b)
for run, mass, momentum in d.execute('select run_id, ejecta_mass_fraction * target_mass, ejecta_momentum from result_sph'):
    table = d.execute('select sum(mass), sum(momentum) from ejecta where run_id = ?', (run,)).fetchone()
    assert mass > 0 and near(table[0], mass) and near(table[1], momentum), (run, mass, table)
for point, mass, momentum, runs in d.execute('select point_id, avg(ejecta_mass_fraction * target_mass), avg(ejecta_momentum), '
                                             'count(*) from result_sph join run using (run_id) group by point_id'):
    mine = [r for r in rows if r['point_id'] == point]
    assert near(mine[0]['mass'], mass) and near(mine[0]['momentum'], momentum) and mine[0]['runs'] == runs == 2, mine[0]
    for a, b in zip(mine, mine[1:]):
        assert a['speed'] < b['speed'] and a['mass'] >= b['mass'] > 0 and a['doubtful'] == 2, (a, b)
PY
python sums.py || fail "the table is not what the results say"
ok "sums of the table"
expect 0 "$clast" spectrum shots.db --ejecta --by impact.speed --csv
[ "$(grep -c . out)" -gt 5 ] || fail "no pooled rows"
expect 0 "$clast" spectrum shots.db --ejecta --picture ejecta.svg --by '' # its points share seeds, which the interval has
grep -q "without what a seed changes" ejecta.svg && fail "the interval lacks seeds that it has"
says "over points and seeds"; ! grep -q "points share seeds" err || fail "the interval lacks seeds that it has"
expect 0 "$clast" spectrum shots.db --ejecta --picture ejecta.svg --by '' --where 'replicate = 0' # one seed of a point tells nothing
grep -q "speed v (m/s)" ejecta.svg || fail "no axis of speeds"
grep -q "without what a seed changes" ejecta.svg || fail "no word of shared seeds in the caption"
says "points share seeds: "
expect 64 "$clast" spectrum shots.db --ejecta --cumulative
says "are for fragments"
expect 0 "$clast" replay shots.db 1
says "agree to the last bit"
# With an escape speed above all speeds nothing leaves.
expect 0 "$clast" simulate basalt-sphere --quiet --set fidelity.particles=500 --set 'stop.end_time=60 us' \
  --set 'crater.escape_speed=100 km/s' --json
python -c "import json; r = json.load(open('out')); r = r[0] if isinstance(r, list) else r; assert r['ejecta_mass_fraction'] == 0 == r['ejecta_momentum'] and r['ejecta_momentum_enhancement'] == 1, r" ||
  fail "ejecta with an escape speed"
tiny grains
expect 0 "$clast" run grains.yaml -j 2 --quiet
expect 64 "$clast" spectrum grains.db --ejecta
says "no impact"
# A store of version 4 has no such table.
python -c "
import sqlite3
d = sqlite3.connect('shots.db')
d.execute('drop table ejecta')
d.execute('pragma user_version = 4')
d.commit()"
expect 64 "$clast" spectrum shots.db --ejecta
says "an older clast computed them"
