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
# Neither -ffast-math nor contraction to fused multiply-adds: error-free sums and NaN must mean what the source says.
FLAGS = [] if os.name == "nt" else ["-O3", "-g0", "-ffp-contract=off"]
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
    found: list[Extension] = cythonize(
        modules, build_dir="build/cython", language_level=3, quiet=True, compiler_directives=DIRECTIVES
    )
    return found


class BuildWherePossible(build_ext):
    """Compiles each extension, or says that it could not: a missing compiler raises what `optional` does not catch."""

    def build_extension(self, ext: Extension) -> None:
        """Compile one extension; a failure is no error."""
        try:
            super().build_extension(ext)
        except Exception as problem:
            print(f"plantar: {ext.name} is not compiled and stays plain Python, which is slower: {problem}")


setup(ext_modules=extensions(), cmdclass={"build_ext": BuildWherePossible})
