"""plfit, fits of power laws (Clauset, Shalizi & Newman), which Spack has not."""
from spack.package import *


class Plfit(CMakePackage):
    """Fits power-law distributions to data."""

    homepage = "https://github.com/ntamas/plfit"
    git = "https://github.com/ntamas/plfit.git"

    license("GPL-2.0-or-later")
    version("0.9.4", tag="0.9.4")

    depends_on("c", type="build")
    depends_on("cxx", type="build")

    def cmake_args(self):
        return [self.define("BUILD_SHARED_LIBS", True), self.define("PLFIT_USE_OPENMP", False)]
