#!/usr/bin/env bash
# `clast materials`: the built-in materials of engine sph.
. "$(dirname "$0")/lib.bash"

expect 0 "$clast" materials --json
python -c "
import json
rows = {r['name']: r for r in json.load(open('out'))}
assert len(rows) >= 10, rows.keys()
assert rows['basalt']['density'] == 2700 and rows['basalt']['weibull_m'] == 8.5, rows['basalt']
assert rows['nylon']['weibull_k'] is None
"
for material in basalt nylon ice gabbro steel aluminium polycarbonate granite pumice rubber; do
  expect 0 "$clast" materials $material
  prints "source:"
  prints "material: $material"
done
expect 66 "$clast" materials basalr
says "did you mean 'basalt'"
expect 64 "$clast" materials basalt ice
done_after 13
