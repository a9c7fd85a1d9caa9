"""Reads clast stores, and runs campaigns.

One file, standard library only. numpy, pandas and xarray are used if they are there: tables are pandas frames (else lists
of dicts), lists of numbers are numpy arrays (else array.array). Units are SI; Store.unit() tells them.

    import clast
    store = clast.run("demo.yaml")      # or clast.open("demo.db")
    store.points()                      # a row for each point: inputs, and means with their 95 % intervals
    store.fragments(17)                 # all masses of run 17, descending, kg
    store.lengths(17)                   # three lengths of each of its larger fragments, m (sph)
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
        if not os.path.isfile(self.path):  # SQLite would wait for a pipe
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

    def _without(self, studies):
        """SQL that is true of rows of a view, without those that only studies and searches (`clast converge`, `find`) have."""
        has = any(row[1] == "study" for row in self.connection.execute("PRAGMA table_info(points)"))
        return "TRUE" if studies or not has else "NOT study"

    def runs(self, counted=False, studies=False):
        """A row for each run: varied inputs, every result, state, times. counted: only those that enter statistics.
        studies: also those that only studies and searches (`clast converge`, `find`) asked for."""
        return self.query(f"SELECT * FROM runs WHERE {self._without(studies)}" + (" AND counts = 1" if counted else ""))

    def excluded(self):
        """The runs that a person left out of all statistics (`clast exclude`), with the date and the reason."""
        if "excluded" not in {row[1] for row in self.connection.execute("PRAGMA table_info(run)")}:
            return self.query("SELECT run_id, point_id, seed FROM run WHERE 0")
        return self.query("SELECT run_id, point_id, seed, excluded_at AS date, excluded AS reason FROM run WHERE "
                          "surplus > 1 ORDER BY run_id")

    def points(self, studies=False):
        """A row for each point: varied inputs; n, excluded; _mean, _sd, _se, _hw95, _low95 and
        _high95 (95 % interval; _hw95 is None when all runs are equal to 14 digits) of the main results.
        runs() has all results; `clast stats STORE -Q NAME --csv` the means of any of them."""
        return self.query(f"SELECT * FROM points WHERE {self._without(studies)}")

    def spectra(self, point=None, studies=False):
        """A row for each point and mass bin: lower and upper edge (kg), fragments, mass, density F(m)."""
        if point is None:
            return self.query(f"SELECT * FROM spectra WHERE {self._without(studies)}")
        return self.query("SELECT * FROM spectra WHERE point_id = ?", (int(point),))

    def estimates(self, point=None, studies=False):
        """A row for each exponent of a point, over all of its runs; untold: why tables show no beta."""
        where = "SELECT * FROM estimates WHERE run_id IS NULL"
        if point is None:
            return self.query(f"{where} AND {self._without(studies)}")
        return self.query(where + " AND point_id = ?", (int(point),))

    def unit(self, column):
        """The SI unit of a column of the views; "" for a pure number or a text. KeyError: there is no such column."""
        units = [unit for (unit,) in self.connection.execute(
            "SELECT unit FROM column_doc WHERE column_name = ? ORDER BY table_name LIKE 'result%'", (column,))]
        if not units:
            raise KeyError(f"the store has no column {column!r}")
        return next((unit for unit in units if unit not in (None, "", "1", "-")), "")

    def axes(self):
        """The varied inputs, as columns of the views."""
        return [name for (name,) in self.connection.execute("SELECT column_name FROM axis ORDER BY path")]

    # ---- one run

    def fragments(self, run):
        """Masses of all fragments of a run, descending, kg (kg/m in the plane)."""
        return self._numbers(run, "masses")

    def lengths(self, run):
        """Three lengths of each fragment, m, longest first, one fragment after another: in the order of `fragments`, up to
        the last that was measured, 0 for others. Empty: the run measured none."""
        return self._numbers(run, "lengths")

    def _numbers(self, run, column):
        row = self.connection.execute(f"SELECT {column} FROM fragment_mass WHERE run_id = ?", (int(run),)).fetchone()
        if not row:
            raise Error(f"{self.path}: there is no run {run} with fragments", 66)
        held = b"" if row[0] is None and column == "lengths" else row[0]
        if not isinstance(held, bytes) or len(held) % (24 if column == "lengths" else 8):
            raise Error(f"{self.path}: the {column} of run {run} are damaged", 65)
        if numpy:
            return numpy.frombuffer(held, dtype="<f8")
        numbers = array.array("d")
        numbers.frombytes(held)
        if sys.byteorder == "big":
            numbers.byteswap()
        return numbers

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
        if kept and os.path.isfile(kept) and not path:
            return _read_hdf5(kept)
        with tempfile.TemporaryDirectory() as folder:
            target = os.fspath(path) if path else os.path.join(folder, "run.h5")
            _call("replay", self.path, run, "--fields", target)
            return _read_hdf5(target)

    # ---- the points as arrays over the varied inputs

    def cube(self):
        """(dimensions, coordinates, variables): what to_xarray() makes a Dataset from. Where the points are a full grid,
        the inputs that differ are the dimensions; else there is one dimension, point_id. Of several results versions the
        newest is taken. Points that only studies and searches have are left out."""
        cursor = self.connection.execute(f"SELECT * FROM points WHERE {self._without(False)} ORDER BY point_id, "
                                         "results_version")
        names = [column[0] for column in cursor.description]
        rows = list({row[names.index("point_id")]: row for row in cursor}.values())
        axes = [name for name in self.axes() if name in names and len({row[names.index(name)] for row in rows}) > 1]
        at = {name: names.index(name) for name in names}
        levels = {axis: sorted({row[at[axis]] for row in rows}, key=lambda value: (str(type(value)), value)) for axis in axes}
        places = {tuple(levels[axis].index(row[at[axis]]) for axis in axes): row for row in rows}
        size = math.prod(len(values) for values in levels.values())
        grid = bool(axes) and len(places) == len(rows) == size
        dimensions = axes if grid else ["point_id"]
        coordinates = levels if grid else {name: [row[at[name]] for row in rows] for name in ["point_id", *axes]}
        ordered = [places[place] for place in sorted(places)] if grid else rows
        fixed = {"engine", "scene", "study", *coordinates}
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


# ---- fields files, with the C library of HDF5, which clast itself needs

_MOST_OBJECTS, _MOST_DEEP, _MOST_COMPRESSED = 10000, 8, 1100  # in a file, in each other, and deflate's limit


def _read_hdf5(path):
    """Every dataset of numbers, as doubles. The file may come from an untrusted source, and HDF5 can crash on a damaged
    one: another process reads it. It refuses links and storage that lead to other files, and loads no plug-in filters.
    """
    if not os.path.isfile(path):
        raise Error(f"{path}: there is no such file", 66)
    done = subprocess.run([sys.executable, os.path.abspath(__file__), path], capture_output=True,
                          env={**os.environ, "HDF5_PLUGIN_PRELOAD": "::"})  # "::" forbids plug-ins
    if done.returncode in (65, 66, 74):
        raise Error(done.stderr.decode(errors="replace").strip(), done.returncode)
    if done.returncode:
        raise Error(f"{path}: HDF5 fails on it; the file is damaged", 65)
    head, _, body = done.stdout.partition(b"\n")
    found, at = {}, 0
    for name, shape, count in json.loads(head):
        values = array.array("d", body[at:at + 8 * count])
        found[name] = numpy.array(values).reshape(shape) if numpy else values
        at += 8 * count
    return found


def _send_hdf5(path):
    """The other process: a line that lists the datasets, then their numbers."""
    found = []  # name, shape, numbers
    try:
        _walk(path, found)
    except Error as error:
        sys.stderr.write(str(error))
        return error.code
    out = sys.stdout.buffer
    out.write(json.dumps([(name, shape, len(values)) for name, shape, values in found]).encode() + b"\n")
    for _, _, values in found:
        out.write(values)
    return 0


def _hdf5_library():
    for name in ("hdf5_serial", "hdf5"):
        found = ctypes.util.find_library(name)
        if found:
            return ctypes.CDLL(found)
    raise Error("to read fields, install the HDF5 library", 66)


def _hdf5_calls():
    """The library with the types of the calls below."""
    h5 = _hdf5_library()
    identifier, count, text = ctypes.c_int64, ctypes.c_uint64, ctypes.c_char_p  # hid_t since HDF5 1.10; hsize_t
    if not hasattr(h5, "H5Lget_info"):
        h5.H5Lget_info = h5.H5Lget_info1  # since HDF5 1.12
    for name, result, kinds in (
            ("H5Fopen", identifier, (text, ctypes.c_uint, identifier)), ("H5Oopen", identifier, (identifier, text, identifier)),
            ("H5Dget_space", identifier, (identifier,)), ("H5Dget_type", identifier, (identifier,)),
            ("H5Dget_create_plist", identifier, (identifier,)), ("H5Dread", ctypes.c_int, (identifier,) * 5 + (ctypes.c_void_p,)),
            ("H5Pget_external_count", ctypes.c_int, (identifier,)), ("H5Pget_layout", ctypes.c_int, (identifier,)),
            ("H5Tget_class", ctypes.c_int, (identifier,)), ("H5Tget_size", ctypes.c_size_t, (identifier,)),
            ("H5Iget_type", ctypes.c_int, (identifier,)), ("H5Sget_simple_extent_ndims", ctypes.c_int, (identifier,)),
            ("H5Sget_simple_extent_dims", ctypes.c_int, (identifier, ctypes.POINTER(count), ctypes.POINTER(count))),
            ("H5Lget_info", ctypes.c_int, (identifier, text, ctypes.c_void_p, identifier)),
            ("H5Lget_name_by_idx", ctypes.c_ssize_t, (identifier, text, ctypes.c_int, ctypes.c_int, count, text, ctypes.c_size_t,
                                                      identifier)),
            ("H5Eset_auto2", ctypes.c_int, (identifier, ctypes.c_void_p, ctypes.c_void_p))):
        getattr(h5, name).restype, getattr(h5, name).argtypes = result, kinds
    h5.H5open()
    h5.H5Eset_auto2(0, None, None)  # the end of a group is found by asking for one link too many
    return h5


def _walk(path, found):
    """Reads the data sets. The process ends afterwards, so nothing is closed."""
    h5, most, objects = _hdf5_calls(), os.path.getsize(path) * _MOST_COMPRESSED, 0
    double = ctypes.c_int64.in_dll(h5, "H5T_NATIVE_DOUBLE_g").value
    group, dataset, numbers, virtual = 2, 5, (0, 1), 3  # H5I_GROUP, H5I_DATASET; H5T_INTEGER, H5T_FLOAT; H5D_VIRTUAL

    def refuse_if(truth, name, what):
        if truth:
            raise Error(f"{path}: {name} {what}; clast writes no such files", 65)

    def read(place, name):
        kind, layout = h5.H5Dget_type(place), h5.H5Dget_create_plist(place)
        if h5.H5Tget_class(kind) not in numbers:
            return
        refuse_if(h5.H5Tget_size(kind) > 8, name, "has numbers of more than 8 bytes")
        # before the shape, which can lie in other files, too
        outside = h5.H5Pget_external_count(layout) != 0 or h5.H5Pget_layout(layout) == virtual
        refuse_if(outside, name, "keeps its numbers in another file")
        space = h5.H5Dget_space(place)
        rank = max(h5.H5Sget_simple_extent_ndims(space), 0)
        sides = (ctypes.c_uint64 * (rank + 1))(*[1] * (rank + 1))
        h5.H5Sget_simple_extent_dims(space, sides, None)
        count = math.prod(sides)
        refuse_if(count > most, name, "claims more numbers than the file can hold")
        values = array.array("d", bytes(8 * count))
        refuse_if(count and h5.H5Dread(place, double, 0, 0, 0, values.buffer_info()[0]) < 0, name, "cannot be read")
        found.append((name, sides[:rank], values))

    def look(place, prefix):
        nonlocal objects
        text, info = ctypes.create_string_buffer(1024), (ctypes.c_int * 64)()  # H5L_info_t begins with the link's type
        index = 0
        while h5.H5Lget_name_by_idx(place, b".", 0, 0, index, text, len(text), 0) >= 0:
            name = prefix + text.value.decode(errors="replace")
            index, objects = index + 1, objects + 1
            refuse_if(objects > _MOST_OBJECTS or name.count("/") > _MOST_DEEP, name, "is too much or too deep")
            refuse_if(h5.H5Lget_info(place, text.value, info, 0) < 0 or info[0] != 0, name, "is a link to elsewhere")
            inner = h5.H5Oopen(place, text.value, 0)
            if inner >= 0 and h5.H5Iget_type(inner) == group:
                look(inner, name + "/")
            elif inner >= 0 and h5.H5Iget_type(inner) == dataset:
                read(inner, name)

    file = h5.H5Fopen(os.fsencode(path), 0, 0)
    if file < 0:
        raise Error(f"{path}: no HDF5 file, or it is damaged", 65)
    look(file, "")


if __name__ == "__main__":
    result = _send_hdf5(sys.argv[1])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(result)  # HDF5's own exit can crash on a strange file
