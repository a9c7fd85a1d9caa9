# %% [markdown]
# # A campaign from Python
# Cells begin with `# %%`: Jupyter (with jupytext), VS Code and Spyder open this file as a notebook. As a script:
# `python3 example.py`. It needs the program `clast` on the search path, and no package.

# %%
import math

import clast

# %% [markdown]
# A campaign is a dict with the keys of a campaign file. `run` computes what the store lacks: a second call is quick.

# %%
store = clast.run({
    "name": "example",
    "scene": "disc-explosion",
    "set": {"body.diameter": "8 cm", "charge.energy": "2 kJ/m"},
    "vary": {"threshold.strain": ["2 %", "5 %"], "threshold.angle": ["2 deg", "6 deg"]},
    "seeds": {"per_point": 4},
    "store": "example.db",
})

# %% [markdown]
# One row for each point. With pandas `points` is a frame; here the rows are made to dicts, so that both work. A `!` marks a
# mean of runs of which some are in doubt, as in the tables of clast (`clast explain conditions`).

# %%
points = store.points()
if hasattr(points, "to_dict"):
    points = points.to_dict("records")
for point in points:
    print(f"strain {point['threshold_strain']:.2f}  angle {math.degrees(point['threshold_angle']):.0f} deg  "
          f"M_1/M {point['largest_fraction_mean']:.3f} ({point['largest_fraction_low95']:.3f} to "
          f"{point['largest_fraction_high95']:.3f})  (n = {point['n']})"
          + ("  !" if point["doubtful"] else ""))

# %% [markdown]
# All fragment masses of one run, and the body at its end.

# %%
masses = store.fragments(1)
print(f"run 1: {len(masses)} fragments, the largest has {masses[0]:.3g} kg/m of {sum(masses):.3g} kg/m")
body = store.snapshot(1)
print(f"       {int(sum(body['grains/present']))} grains, {int(sum(body['beams/alive']))} of {len(body['beams/alive'])} beams hold")

# %% [markdown]
# The points as arrays over the varied inputs. With xarray: `store.to_xarray().largest_fraction_mean.plot()`.

# %%
dimensions, coordinates, variables = store.cube()
print("over", " x ".join(f"{name} ({len(coordinates[name])})" for name in dimensions), "in", [store.unit(name) or "1" for name in dimensions])
print("M_1/M:", [round(value, 3) for value in variables["largest_fraction_mean"]])
