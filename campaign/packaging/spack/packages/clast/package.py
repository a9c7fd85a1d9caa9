"""clast for Spack: `spack repo add campaign/packaging/spack`, then in the tree `spack dev-build clast@0.1.0`.

DEBIAN says which package of the list in setup.sh each dependency stands for; a test compares the two.
"""
from pathlib import Path

from spack.package import *

DEBIAN = {
    "cmake": "cmake", "ninja-build": "ninja", "pkg-config": "pkgconfig",
    "libfyaml-dev": "libfyaml", "libopenmpi-dev": "mpi", "libsqlite3-dev": "sqlite", "libhdf5-dev": "hdf5", "libgsl-dev": "gsl",
    "librandom123-dev": "random123", "libcairo2-dev": "cairo", "zlib1g-dev": "zlib-api",
    "libcmocka-dev": "cmocka", "libqhull-dev": "qhull", "uthash-dev": "uthash", "libmicrohttpd-dev": "libmicrohttpd",
    "libjansson-dev": "jansson", "nettle-dev": "nettle", "gnuplot-nox": "gnuplot",
}


class Clast(CMakePackage):
    """Ensembles of simulations of how rocks break: many runs, one SQLite file."""

    git = f"file://{Path(__file__).resolve().parents[5]}"  # the tree that this file is in

    license("GPL-3.0-or-later")
    version("0.1.0", branch="main")

    generator("ninja")
    depends_on("c", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("libfyaml@0.7:")
    depends_on("mpi")
    depends_on("sqlite@3.38:")
    depends_on("hdf5@1.10:+hl")
    depends_on("gsl@2.7:")
    depends_on("random123", type="build")
    depends_on("cairo+png+svg+pdf")
    depends_on("zlib-api")
    depends_on("cmocka", type="build")
    depends_on("qhull", type="build")
    depends_on("uthash", type="build")
    depends_on("libmicrohttpd")
    depends_on("jansson")
    depends_on("nettle")
    depends_on("gnuplot", type="run")

    conflicts("platform=windows")
    conflicts("platform=darwin", msg="clast uses interfaces of Linux")
