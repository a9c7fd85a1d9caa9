#!/usr/bin/python3
"""Measures fields files of the basalt sphere for crack_cell.md.

usage: crack_cell.py parts FIELDS.hdf ...
       crack_cell.py pulse SNAPSHOT.hdf ...

parts: the heaviest bodies of sound matter (cores, without their damaged layers): share of the target's mass, distance
       from the target's centre, and the gap between the two heaviest. Then the share of sound matter in layers of
       1 mm below the surface that faces away from the impact, within 30 degrees of the axis.
pulse: the wave of an impact along z, from the snapshots of one run. In four balls on the axis: the largest mean
       compression, its rise time, the width at half of it, and the largest tension. Run with target.fracture=off, as
       broken matter carries no tension."""
import bisect
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../python"))
import clast  # noqa: E402

CORE = 0  # VTKHDF/PointData/part
BALL = 2.5e-3  # m, radius of a ball: a few particles of the coarsest run
RADIUS = 30e-3  # m, of the basalt sphere
PLACES = (10e-3, 0.0, -10e-3, -20e-3)  # m along z; the impact comes from +z


def column(fields, name):
    return fields["VTKHDF/PointData/" + name]


def points(fields):
    flat = fields["VTKHDF/Points"]
    if hasattr(flat, "ravel"):
        flat = flat.ravel()
    return [tuple(flat[3 * i:3 * i + 3]) for i in range(len(flat) // 3)]


def gap(one, other):
    """Smallest distance between two sets of points."""
    other = sorted(other, key=lambda point: point[2])
    heights = [point[2] for point in other]
    best = min(math.dist(one[0], point) for point in other)
    for point in one:
        low, high = bisect.bisect_left(heights, point[2] - best), bisect.bisect_right(heights, point[2] + best)
        best = min([best] + [math.dist(point, near) for near in other[low:high]])
    return best


def sound_by_depth(place, mass, damage, target):
    all_, sound = [0.0] * 16, [0.0] * 16
    for i in target:
        distance = math.hypot(*place[i])
        depth = max(0, int(1e3 * (RADIUS - distance)))
        if depth < len(all_) and -place[i][2] > math.cos(math.radians(30)) * distance:
            all_[depth] += mass[i]
            sound[depth] += mass[i] * (damage[i] < 1)
    return [part / whole if whole else math.nan for part, whole in zip(sound, all_)]


def show_parts(path):
    fields = clast._read_hdf5(path)
    place, mass, part = points(fields), column(fields, "mass"), column(fields, "part")
    label, damage, body = column(fields, "fragment"), column(fields, "damage"), column(fields, "body")
    target = [i for i in range(len(mass)) if body[i] == 0]
    total = sum(mass[i] for i in target)
    sound = sum(mass[i] for i in target if damage[i] < 1) / total
    bodies = {}
    for i in target:
        if part[i] == CORE:
            bodies.setdefault(label[i], []).append(i)
    heaviest = sorted(bodies.values(), key=lambda members: -sum(mass[i] for i in members))
    print(f"{path}: {len(target)} particles, sound {sound:.4f}")
    for members in heaviest[:3]:
        own = sum(mass[i] for i in members)
        distance = sum(mass[i] * math.hypot(*place[i]) for i in members) / own
        print(f"  {own / total:.4f} of the mass in {len(members)} particles, {1e3 * distance:.1f} mm from the centre")
    if len(heaviest) > 1:
        between = gap([place[i] for i in heaviest[1]], [place[i] for i in heaviest[0]])
        print(f"  gap between the two heaviest: {1e3 * between:.2f} mm")
    print("  sound by depth:", " ".join(f"{share:.2f}" for share in sound_by_depth(place, mass, damage, target)))


def compressions(fields):
    """Mean of the compression along z in each ball, Pa."""
    place, pressure, body = points(fields), column(fields, "pressure"), column(fields, "body")
    deviator = column(fields, "deviator")
    if hasattr(deviator, "ravel"):
        deviator = deviator.ravel()
    sums = [[0.0, 0] for _ in PLACES]
    for i, (x, y, z) in enumerate(place):
        if body[i] != 0 or x * x + y * y > BALL**2:
            continue
        for entry, height in zip(sums, PLACES):
            if x * x + y * y + (z - height)**2 < BALL**2:
                entry[0] += pressure[i] - deviator[9 * i + 8]
                entry[1] += 1
    return [value / max(count, 1) for value, count in sums]


def crossing(times, values, level, first, last):
    """When `values`, between two rows, first passes `level`; nan: it does not."""
    for k in range(first, last):
        a, b = values[k], values[k + 1]
        if (a - level) * (b - level) <= 0 and a != b:
            return times[k] + (level - a) / (b - a) * (times[k + 1] - times[k])
    return math.nan


def show_pulse(paths):
    files = [clast._read_hdf5(path) for path in sorted(paths)]
    times = [1e6 * float(fields["outcome/time"][0] if hasattr(fields["outcome/time"], "__len__") else fields["outcome/time"])
             for fields in files]
    rows = [compressions(fields) for fields in files]
    for k, height in enumerate(PLACES):
        values = [row[k] for row in rows]
        top = max(range(len(values)), key=lambda i: values[i])
        peak = values[top]
        rise = crossing(times, values, 0.9 * peak, 0, top) - crossing(times, values, 0.1 * peak, 0, top)
        width = crossing(times, values, 0.5 * peak, top, len(values) - 1) - crossing(times, values, 0.5 * peak, 0, top)
        print(f"z {1e3 * height:4.0f} mm: largest compression {1e-6 * peak:.0f} MPa at {times[top]:.2f} us, rise {rise:.2f} us, "
              f"width {width:.2f} us, largest tension {-1e-6 * min(values):.0f} MPa")


def main():
    if len(sys.argv) < 3 or sys.argv[1] not in ("parts", "pulse"):
        print(__doc__, file=sys.stderr)
        return 64
    if sys.argv[1] == "pulse":
        show_pulse(sys.argv[2:])
        return 0
    for path in sys.argv[2:]:
        show_parts(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
