#!/usr/bin/env bash
# python/clast.py on a store: its tables, masses and fields are those of the program; the example runs; the package is
# described. CLAST_FULL=1 also installs it with pip, which needs setuptools.
. "$(dirname "$0")/lib.bash"
export PYTHONPATH=$source/python CLAST=$clast PYTHONDONTWRITEBYTECODE=1

expect 0 python "$source/python/example.py"
prints "strain 0.05  angle 6 deg  M_1/M"
prints "(n = 4)"
same "$(grep -c '^strain.*!$' out)" "$(number example.db 'select count(*) from points where doubtful')" "means in doubt are marked"
prints "over threshold_angle (2) x threshold_strain (2) in ['rad', '1']"
expect 0 "$clast" export example.db runs.csv --per run
expect 0 "$clast" export example.db points.jsonl --per point --jsonl
expect 0 "$clast" replay example.db 3 --fields three.h5

expect 0 python - <<'PY'
import array, csv, json, math, sqlite3, warnings
import clast

def rows(table):
    return table.to_dict("records") if hasattr(table, "to_dict") else table

with clast.open("example.db") as store:
    # tables are those of `clast export`
    runs, points = rows(store.runs()), rows(store.points())
    table = list(csv.DictReader(open("runs.csv", newline="")))
    assert len(runs) == len(table) == 16 and list(runs[0]) == list(table[0])
    assert all(float(cells["largest_fraction"]) == row["largest_fraction"] for row, cells in zip(runs, table))
    assert points == [json.loads(line) for line in open("points.jsonl")] or clast.pandas
    assert len(rows(store.runs(counted=True))) == sum(row["counts"] for row in runs)
    # masses: those of the blob, whose sum is the result's
    raw = sqlite3.connect("example.db").execute("SELECT masses FROM fragment_mass WHERE run_id = 3").fetchone()[0]
    masses = store.fragments(3)
    assert bytes(masses.tobytes()) == raw and len(masses) == runs[2]["fragment_count"]
    assert abs(masses[0] / runs[2]["total_mass"] - runs[2]["largest_fraction"]) < 1e-12
    assert len(store.lengths(3)) == 0  # dem measures none
    # spectra: all fragments of the point's runs
    for point in points:
        own = [row for row in runs if row["point_id"] == point["point_id"] and row["counts"]]
        assert sum(bin["count"] for bin in rows(store.spectra(point["point_id"]))) == sum(row["fragment_count"] for row in own)
    assert len(rows(store.spectra())) > 4 and rows(store.estimates(1))
    # fields: the same run, and the same from a file
    body = store.snapshot(3)
    assert list(body["fragments/mass"]) == list(masses)
    kept = clast._read_hdf5("three.h5")
    assert set(kept) == set(body) and all(list(map(str, kept[k])) == list(map(str, body[k])) for k in kept if k[:3] != "VTK")
    assert len(body["grains/position"]) in (len(body["grains/mass"]), 2 * len(body["grains/mass"]))
    # the cube: each place has the value of its point
    dimensions, coordinates, variables = store.cube()
    assert dimensions == ["threshold_angle", "threshold_strain"] and len(variables["n"]) == 4
    for place, value in enumerate(variables["largest_fraction_mean"]):
        angle, strain = coordinates["threshold_angle"][place // 2], coordinates["threshold_strain"][place % 2]
        assert [value] == [p["largest_fraction_mean"] for p in points if (p["threshold_angle"], p["threshold_strain"]) == (angle, strain)]
    # units, and metadata for Datasette from the same table
    assert store.unit("threshold_angle") == "rad" and store.unit("largest_fraction") == ""
    assert [store.unit(of) for of in ("total_mass", "mean_fragment_mass_mean", "lower", "density")] == ["kg/m", "kg/m", "kg/m", "m/kg"]
    try:
        store.unit("largest_fractoin")
        raise SystemExit("an unknown column has a unit")
    except KeyError:
        pass
    tables = store.datasette()["databases"]["example"]["tables"]
    assert tables["runs"]["columns"]["total_mass"].endswith("[kg]") or "[kg" in tables["runs"]["columns"]["total_mass"]
    assert set(list(points[0])) <= set(tables["points"]["columns"]), set(points[0]) - set(tables["points"]["columns"])
    try:
        store.connection.execute("DELETE FROM run")
        raise SystemExit("the store is not read-only")
    except sqlite3.OperationalError:
        pass
    for wrong, call in ((66, lambda: store.fragments(99)), (66, lambda: store.snapshot(99)), (66, lambda: clast.open("none.db")),
                        (66, lambda: clast.run("none.yaml")), (65, lambda: clast.run({"name": "x", "scene": "disc-explosion", "oops": 1})),
                        (65, lambda: clast._read_hdf5("runs.csv"))):
        try:
            call()
            raise SystemExit(f"no error {wrong}")
        except clast.Error as error:
            assert error.code == wrong and str(error), (wrong, error.code, str(error))
    # a list of points is no grid
    lone = clast.run({"name": "lone", "scene": "disc-explosion", "design": "list", "seeds": {"per_point": 2},
                      "set": {"body.diameter": "8 cm", "charge.energy": "2 kJ/m", "stop.end_time": "1 ms"},
                      "vary": {"threshold.strain": ["2 %", "5 %"], "threshold.angle": ["0.1 rad", "0.05 rad"]}}, store="lone.db", slots=2)
    assert lone.cube()[0] == ["point_id"] and lone.cube()[1]["threshold_strain"] == [0.02, 0.05]
PY
ok "tables, masses, fields, errors"
same "$(ls campaign-* 2>/dev/null | wc -l)" 0 "temporary files"

# files from someone else: each is refused, and the caller's process goes on
expect 0 python - <<'PY'
import ctypes, os, shutil, sqlite3
import clast

h5 = clast._hdf5_calls()
i64, i32, text, count = ctypes.c_int64, ctypes.c_int, ctypes.c_char_p, ctypes.c_uint64
for name, kinds in {"H5Lcreate_external": (text, text, i64, text, i64, i64), "H5Lcreate_soft": (text, i64, text, i64, i64),
                    "H5Lcreate_hard": (i64, text, i64, text, i64, i64), "H5Fclose": (i64,), "H5Dclose": (i64,), "H5Pset_external": (i64, text, i64, count),
                    "H5Pset_virtual": (i64, i64, text, text, i64), "H5Pset_chunk": (i64, i32, ctypes.POINTER(count)),
                    "H5Dcreate2": (i64, text, i64, i64, i64, i64, i64), "H5Pcreate": (i64,),
                    "H5Screate_simple": (i32, ctypes.POINTER(count), ctypes.POINTER(count))}.items():
    getattr(h5, name).argtypes = kinds
    getattr(h5, name).restype = i64
byte = i64.in_dll(h5, "H5T_NATIVE_UCHAR_g").value
creation = i64.in_dll(h5, "H5P_CLS_DATASET_CREATE_ID_g").value

def dataset(file, rows, set_storage):
    sides, layout = (count * 1)(rows), h5.H5Pcreate(creation)
    space = h5.H5Screate_simple(1, sides, None)
    set_storage(layout, space)
    return h5.H5Dclose(h5.H5Dcreate2(file, b"more", byte, space, 0, layout, 0))  # an open one keeps the file from its end

changes = {
    "is a link": lambda file: h5.H5Lcreate_external(b"three.h5", b"/", file, b"more", 0, 0),
    "is a link ": lambda file: h5.H5Lcreate_soft(b"/grains", file, b"more", 0, 0),
    "too deep": lambda file: h5.H5Lcreate_hard(file, b"/", file, b"more", 0, 0),
    "in another file": lambda file: dataset(file, 9, lambda layout, _: h5.H5Pset_external(layout, b"/etc/passwd", 0, 9)),
    "in another file ": lambda file: dataset(file, 9, lambda layout, space: h5.H5Pset_virtual(layout, space, b"three.h5", b"/x", space)),
    "more numbers": lambda file: dataset(file, 10**15, lambda layout, _: h5.H5Pset_chunk(layout, 1, (count * 1)(1000))),
}
for words, change in changes.items():
    shutil.copy("three.h5", "strange.h5")
    file = h5.H5Fopen(b"strange.h5", 1, 0)
    assert file >= 0 and change(file) >= 0, words
    h5.H5Fclose(file)
    try:
        clast._read_hdf5("strange.h5")
        raise SystemExit(f"read: {words}")
    except clast.Error as error:
        assert error.code == 65 and words.strip() in str(error), (words, error)

whole = open("three.h5", "rb").read()
for at in range(0, len(whole), len(whole) // 12):  # HDF5 may crash on some
    with open("strange.h5", "wb") as file:
        file.write(whole[:at] + bytes(255 - byte for byte in whole[at:at + 64]) + whole[at + 64:])
    try:
        clast._read_hdf5("strange.h5")
    except clast.Error as error:
        assert error.code == 65, error

os.mkfifo("pipe.db")
shutil.copy("example.db", "odd.db")
with sqlite3.connect("odd.db") as odd:
    odd.execute("UPDATE fragment_mass SET masses = x'0102' WHERE run_id = 3")
with clast.open("odd.db") as store:
    for wrong, call in ((65, lambda: store.fragments(3)), (66, lambda: clast.open("pipe.db")), (66, lambda: clast._read_hdf5("pipe.db"))):
        try:
            call()
            raise SystemExit(f"no error {wrong}")
        except clast.Error as error:
            assert error.code == wrong, error
PY
ok "files from someone else"

# the package: its version is the program's
same "$(python -c 'import clast; print(clast.__version__)')" "$("$clast" version | sed -nE '1s/^clast ([0-9.]+).*/\1/p')" "version"
same "$(python -c "
import tomllib
package = tomllib.load(open('$source/python/pyproject.toml', 'rb'))
print(package['project']['name'], package['tool']['setuptools']['py-modules'], package['project'].get('dependencies'))")" \
  "clast ['clast'] None" "package"
if [ -n "${CLAST_FULL:-}" ]; then
  cp -r "$source/python" tree
  expect 0 python -m pip install --no-index --no-build-isolation --target installed ./tree
  (cd / && PYTHONPATH=$work/installed python -c "import clast; print(clast.__file__)") | grep -qF "$work/installed" || fail "not installed"
  ok "pip installs it"
  done_after 14
else
  done_after 12
fi
