"""Reads clast stores, and runs campaigns.

One file, standard library only. numpy, pandas and xarray are used if they are there: tables are pandas frames (else lists
of dicts), lists of numbers are numpy arrays (else array.array). Units are SI; Store.unit() tells them.

    import clast
    store = clast.run("demo.yaml")      # or clast.open("demo.db")
    store.points()                      # a row for each point: inputs, and means with their 95 % intervals
    store.fragments(17)                 # all masses of run 17, descending, kg
"""
import array
import ctypes
import ctypes.util
import json
import math
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import warnings

try:
    import numpy
except ImportError:
    numpy = None
try:
    import pandas
except ImportError:
    pandas = None

__version__ = "0.1.0"
__all__ = ["Store", "Error", "open", "run"]


class Error(RuntimeError):
    """clast refused or failed: its message, and its exit code (64 command line, 65 content, 66 missing, 74 I/O, ...)."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


def _program():
    """The program: the environment's CLAST, or `clast` on the search path."""
    path = os.environ.get("CLAST") or shutil.which("clast")
    if not path:
        raise Error("the program clast is not on the search path; set the environment variable CLAST to it", 66)
    return path


def _call(*arguments):
    done = subprocess.run([_program(), *map(str, arguments)], capture_output=True, text=True)
    if done.returncode == 1:
        warnings.warn(done.stderr.strip() or "some runs failed", stacklevel=3)
    elif done.returncode != 0:
        raise Error(done.stderr.strip(), done.returncode)
    return done


def run(campaign, store=None, slots=None):
    """Computes what is missing of a campaign, and opens its store. The campaign is a file, or a dict with the same keys.

    A dict names its store, or `store` does; its paths start from the current folder. The same call goes on after a stop.
    """
    made = None
    if isinstance(campaign, dict):
        handle, made = tempfile.mkstemp(prefix="campaign-", suffix=".yaml", dir=".")
        with os.fdopen(handle, "w") as file:
            json.dump(campaign, file, indent=1)
    try:
        options = (["--store", store] if store else []) + (["--slots", slots] if slots else [])
        _call("run", made or campaign, "--quiet", *options)
        if not store:
            store = json.loads(_call("plan", made or campaign, "--no-trial", "--json").stdout)["store"]
    finally:
        if made:
            os.remove(made)
    return Store(store)


def open(path):
    """The store at `path`, for reading. A campaign may be writing to it."""
    return Store(path)


class Store:
    def __init__(self, path):
        self.path = os.fspath(path)
        if not os.path.exists(self.path):
            raise Error(f"{self.path}: there is no such store", 66)
        quoted = self.path.replace("%", "%25").replace("?", "%3f").replace("#", "%23")
        self.connection = sqlite3.connect(f"file:{quoted}?mode=ro", uri=True)
        self.connection.execute("PRAGMA trusted_schema = OFF")  # a store is data, never code

    def close(self):
        self.connection.close()

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.close()

    # ---- tables

    def query(self, sql, parameters=()):
        """The rows of one SQL statement: a pandas frame, or a list of dicts."""
        cursor = self.connection.execute(sql, parameters)
        names = [column[0] for column in cursor.description]
        if pandas:
            return pandas.DataFrame.from_records(cursor.fetchall(), columns=names)
        return [dict(zip(names, row)) for row in cursor]

    def runs(self, counted=False):
        """A row for each run: varied inputs, every result, state, times. counted: only those that enter statistics."""
        return self.query("SELECT * FROM runs" + (" WHERE counts = 1" if counted else ""))

    def points(self):
        """A row for each point: varied inputs; n; _mean, _sd, _se and _hw95 (95 % interval) of the main results."""
        return self.query("SELECT * FROM points")

    def spectra(self, point=None):
        """A row for each point and mass bin: lower and upper edge (kg), fragments, mass, density F(m)."""
        if point is None:
            return self.query("SELECT * FROM spectra")
        return self.query("SELECT * FROM spectra WHERE point_id = ?", (int(point),))

    def estimates(self, point=None):
        """A row for each exponent of a point, over all of its runs."""
        where = "SELECT * FROM estimates WHERE run_id IS NULL"
        return self.query(where) if point is None else self.query(where + " AND point_id = ?", (int(point),))

    def unit(self, column):
        """The SI unit of a column of the views; "" for a pure number or a text."""
        row = self.connection.execute(
            "SELECT unit FROM column_doc WHERE column_name = ? AND unit <> '1' LIMIT 1", (column,)).fetchone()
        return row[0] if row else ""

    def axes(self):
        """The varied inputs, as columns of the views."""
        return [name for (name,) in self.connection.execute("SELECT column_name FROM axis ORDER BY path")]

    # ---- one run

    def fragments(self, run):
        """Masses of all fragments of a run, descending, kg (kg/m in the plane)."""
        row = self.connection.execute("SELECT masses FROM fragment_mass WHERE run_id = ?", (int(run),)).fetchone()
        if not row:
            raise Error(f"{self.path}: there is no run {run} with fragments", 66)
        if numpy:
            return numpy.frombuffer(row[0], dtype="<f8")
        masses = array.array("d")
        masses.frombytes(row[0])
        if sys.byteorder == "big":
            masses.byteswap()
        return masses

    def snapshot(self, run, path=None):
        """The body at the end of a run: a dict of arrays, such as ["grains/position"]. Rows of tables come one after
        another; numpy arrays have their shape.

        Takes the file that the campaign kept; else computes the run again (to the same bits) into `path`, or into a
        temporary file.
        """
        row = self.connection.execute("SELECT fields_path FROM runs WHERE run_id = ?", (int(run),)).fetchone()
        if not row:
            raise Error(f"{self.path}: there is no run {run}", 66)
        kept = os.path.join(os.path.dirname(self.path), row[0]) if row[0] else None
        if kept and os.path.exists(kept) and not path:
            return _read_hdf5(kept)
        with tempfile.TemporaryDirectory() as folder:
            target = os.fspath(path) if path else os.path.join(folder, "run.h5")
            _call("replay", self.path, run, "--fields", target)
            return _read_hdf5(target)

    # ---- the points as arrays over the varied inputs

    def cube(self):
        """(dimensions, coordinates, variables): what to_xarray() makes a Dataset from. Where the points are a full grid,
        the varied inputs are the dimensions; else there is one dimension, point_id. Of several results versions the
        newest is taken."""
        cursor = self.connection.execute("SELECT * FROM points ORDER BY point_id, results_version")
        names = [column[0] for column in cursor.description]
        rows = list({row[names.index("point_id")]: row for row in cursor}.values())
        axes = [name for name in self.axes() if name in names]
        at = {name: names.index(name) for name in names}
        levels = {axis: sorted({row[at[axis]] for row in rows}, key=lambda value: (str(type(value)), value)) for axis in axes}
        places = {tuple(levels[axis].index(row[at[axis]]) for axis in axes): row for row in rows}
        size = math.prod(len(values) for values in levels.values())
        grid = bool(axes) and len(places) == len(rows) == size
        dimensions = axes if grid else ["point_id"]
        coordinates = levels if grid else {name: [row[at[name]] for row in rows] for name in ["point_id", *axes]}
        ordered = [places[place] for place in sorted(places)] if grid else rows
        fixed = {"engine", "scene", *coordinates}
        variables = {name: [row[at[name]] for row in ordered] for name in names if name not in fixed}
        return dimensions, coordinates, variables

    def to_xarray(self):
        """The view points as an xarray Dataset, with units. Needs xarray."""
        import xarray
        dimensions, coordinates, variables = self.cube()
        shape = [len(coordinates[name]) for name in dimensions]

        def named(name, values, form):
            numbers = [math.nan if value is None else value for value in values]
            return (dimensions, numpy.array(numbers).reshape(form), {"units": self.unit(name)})

        data = {name: named(name, values, shape) for name, values in variables.items()}
        if dimensions == ["point_id"]:
            places = {name: named(name, values, shape) for name, values in coordinates.items()}
        else:
            places = {name: ([name], values, {"units": self.unit(name)}) for name, values in coordinates.items()}
        return xarray.Dataset(data, places)

    # ---- other programs

    def datasette(self):
        """Metadata for Datasette, from the table column_doc: what each column means, in which unit.

            json.dump(store.datasette(), open("metadata.json", "w"))
            datasette demo.db --metadata metadata.json
        """
        tables = {}
        for table, column, unit, meaning in self.connection.execute(
                "SELECT table_name, column_name, unit, meaning FROM column_doc ORDER BY table_name, column_name"):
            entry = tables.setdefault(table, {"columns": {}})
            entry["columns"][column] = (meaning or "") + (f" [{unit}]" if unit and unit != "1" else "")
        name = os.path.splitext(os.path.basename(self.path))[0]
        return {"databases": {name: {"description": "A store of clast. Units are SI.", "tables": tables}}}


# ---- HDF5 without h5py: the C library, which clast itself needs

def _read_hdf5(path):
    try:
        import h5py
    except ImportError:
        return _read_hdf5_by_c(path)
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if hasattr(item, "dtype") else None)
    return found


def _hdf5_library():
    for name in ("hdf5_serial", "hdf5"):
        found = ctypes.util.find_library(name)
        if found:
            return ctypes.CDLL(found)
    raise Error("to read fields, install h5py, or the HDF5 library", 66)


def _read_hdf5_by_c(path):
    """Every dataset of numbers, as doubles."""
    h5 = _hdf5_library()
    identifier, count = ctypes.c_int64, ctypes.c_uint64  # hid_t since HDF5 1.10; hsize_t
    for name in ("H5Fopen", "H5Oopen", "H5Dget_space", "H5Dget_type"):
        getattr(h5, name).restype = identifier
    for name, kinds in {"H5Fopen": (ctypes.c_char_p, ctypes.c_uint, identifier), "H5Dread": (identifier,) * 5 + (ctypes.c_void_p,),
                        "H5Oopen": (identifier, ctypes.c_char_p, identifier), "H5Dget_space": (identifier,),
                        "H5Dget_type": (identifier,), "H5Tget_class": (identifier,), "H5Iget_type": (identifier,),
                        "H5Oclose": (identifier,), "H5Sclose": (identifier,), "H5Tclose": (identifier,), "H5Fclose": (identifier,),
                        "H5Sget_simple_extent_ndims": (identifier,),
                        "H5Sget_simple_extent_dims": (identifier, ctypes.POINTER(count), ctypes.POINTER(count)),
                        "H5Lget_name_by_idx": (identifier, ctypes.c_char_p, ctypes.c_int, ctypes.c_int, count,
                                               ctypes.c_char_p, ctypes.c_size_t, identifier)}.items():
        getattr(h5, name).argtypes = kinds
    h5.H5Lget_name_by_idx.restype = ctypes.c_ssize_t
    h5.H5open()
    h5.H5Eset_auto2.argtypes = (identifier, ctypes.c_void_p, ctypes.c_void_p)
    h5.H5Eset_auto2(0, None, None)  # the end of a group is found by asking for one link too many
    double = identifier.in_dll(h5, "H5T_NATIVE_DOUBLE_g").value
    group, dataset, integers, reals = 2, 5, 0, 1  # H5I_GROUP, H5I_DATASET, H5T_INTEGER, H5T_FLOAT
    found = {}

    def read(place, name):
        space, kind = h5.H5Dget_space(place), h5.H5Dget_type(place)
        rank = h5.H5Sget_simple_extent_ndims(space)
        sides = (count * max(rank, 1))(*[1] * max(rank, 1))
        h5.H5Sget_simple_extent_dims(space, sides, None)
        numbers = array.array("d", bytes(8 * math.prod(sides)))
        if h5.H5Tget_class(kind) in (integers, reals):
            if len(numbers) and h5.H5Dread(place, double, 0, 0, 0, numbers.buffer_info()[0]) < 0:
                raise Error(f"{path}: {name} cannot be read", 74)
            found[name] = numpy.array(numbers).reshape(sides[:rank]) if numpy else numbers
        h5.H5Tclose(kind)
        h5.H5Sclose(space)

    def walk(place, prefix):
        text = ctypes.create_string_buffer(1024)
        index = 0
        while h5.H5Lget_name_by_idx(place, b".", 0, 0, index, text, len(text), 0) >= 0:
            inner = h5.H5Oopen(place, text.value, 0)
            name = prefix + text.value.decode()
            if inner >= 0 and h5.H5Iget_type(inner) == group:
                walk(inner, name + "/")
            elif inner >= 0 and h5.H5Iget_type(inner) == dataset:
                read(inner, name)
            if inner >= 0:
                h5.H5Oclose(inner)
            index += 1

    file = h5.H5Fopen(os.fsencode(path), 0, 0)
    if file < 0:
        raise Error(f"{path}: no HDF5 file", 65)
    walk(file, "")
    h5.H5Fclose(file)
    return found
