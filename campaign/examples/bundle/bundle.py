"""A bundle of parallel fibres that share a load (Daniels 1945), and the pieces into which it falls.

One fibre after the other breaks, the weakest first. The load on the bundle is largest just before it fails; neighbours
that break in the same avalanche leave as one piece."""
import argparse
import json
import random

options = argparse.ArgumentParser()
options.add_argument("--fibres", type=int)
options.add_argument("--modulus", type=float)
options.add_argument("--seed", type=int)
given = options.parse_args()

draw = random.Random(given.seed)
strengths = sorted(draw.weibullvariate(1.0, given.modulus) for _ in range(given.fibres))
load = [strength * (given.fibres - broken) / given.fibres for broken, strength in enumerate(strengths)]

avalanches, begin, highest = [], 0, 0.0
for broken, force in enumerate(load):
    if force > highest:
        if broken > begin:
            avalanches.append(broken - begin)
        begin, highest = broken, force
avalanches.append(given.fibres - begin)

print(json.dumps({"strength": highest, "broken_before": begin / given.fibres,
                  "masses": [size / given.fibres for size in avalanches]}))
