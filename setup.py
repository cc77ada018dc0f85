"""Compile the kernels ahead of time where Cython and a C compiler are there; what else there is to say of the
distribution stands in pyproject.toml.

Each kernel is plain Python that runs as it is. Without Cython, or where the compiler fails, the package is built
without the extensions and works the same, slower.
"""

import os
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

KERNELS = sorted(p for p in Path("plantar/kernels").glob("*.pxd") if p.stem != "__init__")
BUILD = "build/cython"
# Neither -ffast-math nor contraction to fused multiply-adds: error-free sums and NaN must mean what the source says.
# What a builder asks for in CFLAGS comes last and counts.
FLAGS = [] if os.name == "nt" else ["-O3", "-g0", "-ffp-contract=off", *os.environ.get("CFLAGS", "").split()]
# Kernels keep their indices in range, never count from the end, and guard each division themselves.
DIRECTIVES = {"boundscheck": False, "wraparound": False, "cdivision": True, "initializedcheck": False}


def extensions() -> list[Extension]:
    """The extension modules, none without Cython."""
    try:
        from Cython.Build import cythonize
    except ImportError:
        print("plantar: Cython is not there; the kernels are installed as plain Python, which is slower")
        return []
    modules = [
        Extension(f"plantar.kernels.{p.stem}", [str(p.with_suffix(".py"))], extra_compile_args=FLAGS, optional=True)
        for p in KERNELS
    ]
    # Kernels that use each other's types do so by relative cimports, which Cython does not follow when it looks for
    # what has changed.
    types = max(p.stat().st_mtime for p in KERNELS)
    stale = any(c.stat().st_mtime < types for c in Path(BUILD, "plantar/kernels").glob("*.c"))
    found: list[Extension] = cythonize(
        modules, build_dir=BUILD, language_level=3, quiet=True, compiler_directives=DIRECTIVES, force=stale
    )
    return found


class BuildWherePossible(build_ext):
    """Compiles each extension, or says that it could not: a missing compiler raises what `optional` does not catch.

    One on each core, since they know nothing of each other.
    """

    def finalize_options(self) -> None:
        """As many at once as there are cores, where no number was asked for."""
        super().finalize_options()
        if self.parallel is None:
            self.parallel = os.cpu_count() or 1

    def build_extension(self, ext: Extension) -> None:
        """Compile one extension; a failure is no error."""
        try:
            super().build_extension(ext)
        except Exception as problem:
            print(f"plantar: {ext.name} is not compiled and stays plain Python, which is slower: {problem}")


setup(ext_modules=extensions(), cmdclass={"build_ext": BuildWherePossible})
