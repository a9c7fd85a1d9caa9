#!/usr/bin/python3
"""Momentum enhancement of impacts along z, from fields files of any version, for cost_per_answer.md.

usage: cost_per_answer.py FIELDS.hdf ...

1 plus the momentum along z of the target's matter faster than crater.ejection_speed, and of the projectile's matter
that moves outwards, over the projectile's. That is ejecta.momentum_enhancement since results_version 9; older versions
left out the projectile's matter, or had no such result."""
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../python"))
import clast  # noqa: E402


def enhancement(fields):
    column = {name: fields["VTKHDF/PointData/" + name] for name in ("velocity", "mass", "body")}
    velocity = column["velocity"].ravel() if hasattr(column["velocity"], "ravel") else column["velocity"]
    inputs = ("crater.ejection_speed", "impact.speed", "impact.angle")
    least, impact, angle = (fields["inputs/" + name][0] for name in inputs)
    ejecta = back = projectile = 0
    for i, (mass, body) in enumerate(zip(column["mass"], column["body"])):
        speed = velocity[3 * i + 2]
        if body:
            projectile += mass
            back += mass * max(speed, 0)
        elif speed > least:
            ejecta += mass * speed
    return ejecta, 1 + (ejecta + back) / (projectile * impact * math.cos(angle))


if len(sys.argv) < 2:
    sys.exit(__doc__)
for path in sys.argv[1:]:
    ejecta, enhanced = enhancement(clast._read_hdf5(path))
    print(f"{path}: ejecta momentum {ejecta:.6g} kg m/s, momentum enhancement {enhanced:.6g}")
