#!/usr/bin/env bash
# Series of snapshots of both engines as ParaView sees them: times, points, arrays. Where there is no pvpython (Debian: apt install
# python3-paraview; 5.11 is meant) nothing is checked, and it says so.
. "$(dirname "$0")/lib.bash"
command -v pvpython >/dev/null || { echo "skipped: no pvpython on this machine"; exit 77; }

expect 0 "$clast" simulate basalt-sphere --quiet --set fidelity.particles=500 --set 'stop.end_time=10 us' --snapshots 3
expect 0 "$clast" simulate disc-explosion --quiet --set 'body.diameter=8 cm' --set 'stop.end_time=0.2 ms' --snapshots 3
cat >look.py <<'PY'
import json
from paraview.simple import OpenDataFile
for name, points, arrays in (("basalt-sphere", True, "damage density fragment pressure velocity"), ("disc-explosion", False, "fragment mass velocity")):
    series = name + ".hdf.series"
    reader = OpenDataFile(series)
    reader.UpdatePipelineInformation()
    times = [f["time"] for f in json.load(open(series))["files"]]
    assert len(times) >= 2 and times[0] == 0 and list(reader.TimestepValues) == times, (list(reader.TimestepValues), times)
    sizes = set()
    bounds = []
    for t in times:
        reader.UpdatePipeline(t)
        info = reader.GetDataInformation()
        sizes.add(info.GetNumberOfCells())
        bounds.append(tuple(info.GetBounds()))
        if points:
            assert info.GetNumberOfPoints() == info.GetNumberOfCells()
    assert len(sizes) == 1 and min(sizes) > 20, sizes
    assert len(set(bounds)) == len(times), bounds # every time is another state
    data = reader.PointData if points else reader.CellData
    have = {data.GetArray(k).GetName(): data.GetArray(k).GetNumberOfComponents() for k in range(data.GetNumberOfArrays())}
    assert all(a in have for a in arrays.split()) and have["velocity"] == 3, have
    print(name, sorted(sizes), times)
PY
expect 0 pvpython look.py
prints disc-explosion
done_after 3
