"""Compile the kernels ahead of time where Cython and a C compiler are there; the rest is in pyproject.toml.

Each kernel is plain Python that runs as it is. Without Cython, or where the compiler fails for one of them, the package
is built without the extensions and works the same, slower. A whole build is stamped (plantar/kernels/build_stamp.py).

The environment variable PLANTAR_HOME, the address of the repository, makes README's links absolute and gives the
package its addresses; a build without it keeps them as they are.
"""

import os
import re
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

KERNEL_FOLDER = Path("plantar/kernels")
KERNELS = sorted(p for p in KERNEL_FOLDER.glob("*/*.pxd") if p.with_suffix(".py").exists())
# Cython's own code for views of arrays, compiled once: 17,000 lines that each extension held.
SHARED = KERNEL_FOLDER / "base" / "memoryviews"
BUILD = "build/cython"
HOME = os.environ.get("PLANTAR_HOME", "").rstrip("/")
# Shapes, text and small vectors gain nothing by -O3, which takes a third longer to compile; ticks take 8 % less.
LEVEL = dict.fromkeys(("base", "geometry", "formats"), "-O2")
# Neither -ffast-math nor contraction to fused multiply-adds: error-free sums and NaN must mean what the source says.
# What a builder asks for in CFLAGS comes last and counts.
FLAGS = [] if os.name == "nt" else ["-g0", "-ffp-contract=off", *os.environ.get("CFLAGS", "").split()]
# Kernels keep their indices in range, never count from the end, and guard each division themselves.
DIRECTIVES = {"boundscheck": False, "wraparound": False, "cdivision": True, "initializedcheck": False}
DIRECTIVES["infer_types"] = True  # locals have the types of what they are assigned
DIRECTIVES["binding"] = False  # a kernel's function is called in two thirds of the time of one with attributes
DIRECTIVES["auto_pickle"] = False  # no kernel is pickled, and the code for that is a sixth of what is compiled


def extensions() -> list[Extension]:
    """The extension modules, none without Cython."""
    try:
        import numpy
        from Cython.Build import cythonize
    except ImportError as problem:
        print(f"plantar: {problem}; the kernels are installed as plain Python, which is slower")
        return []
    modules = [
        Extension(
            ".".join(p.with_suffix("").parts),
            [str(p.with_suffix(".py"))],
            include_dirs=[numpy.get_include()],  # an array's memory, `base/pointers.pxd`
            define_macros=[("NPY_NO_DEPRECATED_API", "NPY_1_7_API_VERSION")],
            extra_compile_args=FLAGS and [LEVEL.get(p.parent.name, "-O3"), *FLAGS],
            optional=True,
        )
        for p in KERNELS
    ]
    modules.append(Extension(".".join(SHARED.parts), [f"{SHARED}.c"], extra_compile_args=FLAGS and ["-O2", *FLAGS]))
    for kernel in KERNELS:
        made = Path(BUILD, kernel.with_suffix(".c"))
        if made.exists() and made.stat().st_mtime < max(p.stat().st_mtime for p in types_of(kernel)):
            made.unlink()
    found: list[Extension] = cythonize(
        modules,
        build_dir=BUILD,
        language_level=3,
        quiet=True,
        compiler_directives=DIRECTIVES,
        shared_utility_qualified_name=".".join(SHARED.parts),
    )
    return found


def types_of(kernel: Path) -> set[Path]:
    """The files with the types that a kernel is compiled with: its own, and those of kernels that these use in turn.

    Kernels use each other's types by relative cimports, which Cython does not follow when it looks for changes.
    """
    found: set[Path] = set()
    left = {kernel}
    while left:
        pxd = left.pop()
        found.add(pxd)
        text = pxd.read_text(encoding="utf-8")
        for dots, module, names in re.findall(r"^from (\.+)([\w.]*) cimport (.+)$", text, re.MULTILINE):
            room = pxd.parents[len(dots) - 1].joinpath(*module.split("."))  # a room, or one of its files
            named = [name.split()[0] for name in names.split(",")]
            used = [room / f"{name}.pxd" for name in named] if room.is_dir() else [room.with_suffix(".pxd")]
            left |= set(used) - found
    return found


def remove_extensions(folder: Path, kept: set[Path]) -> None:
    """Remove extension modules from a folder of rooms, except those of kernels that are kept.

    Python would load what former kernels left, and a wheel hold it.
    """
    for path in [p for suffix in EXTENSION_SUFFIXES for p in folder.rglob(f"*{suffix}")]:
        if path.relative_to(folder).with_name(path.name.split(".")[0]) not in kept:
            path.unlink(missing_ok=True)


def stamp(folder: Path) -> None:
    """Stamp a folder that holds every extension; of one that does not, remove those that it holds."""
    spec = spec_from_file_location("build_stamp", KERNEL_FOLDER / "build_stamp.py")
    assert spec is not None
    assert spec.loader is not None
    build_stamp = module_from_spec(spec)
    spec.loader.exec_module(build_stamp)
    missing = build_stamp.write(folder, KERNEL_FOLDER)
    if missing:
        print(f"plantar: {len(missing)} kernels are not compiled ({', '.join(missing[:3])}); all stay plain Python")
        remove_extensions(folder, set())


class BuildWherePossible(build_ext):
    """Compiles the extensions in parallel and prints which could not be: `optional` misses a missing compiler."""

    def finalize_options(self) -> None:
        """As many at once as there are cores, where no number was asked for."""
        super().finalize_options()
        if self.parallel is None:
            self.parallel = os.cpu_count() or 1

    def run(self) -> None:
        """Compile them, clear away what former kernels left, and stamp, in the checkout and where wheels are made."""
        folders = (KERNEL_FOLDER, Path(self.build_lib, KERNEL_FOLDER))
        sources = {p.relative_to(KERNEL_FOLDER).with_suffix("") for p in [*KERNELS, SHARED]}
        for folder in folders:
            remove_extensions(folder, sources if self.extensions else set())
        super().run()
        for folder in folders if self.inplace else folders[1:]:
            if folder.is_dir():
                stamp(folder)

    def build_extensions(self) -> None:
        """Compile them, and go on with those that could be: an editable install copies each from where it was built."""
        super().build_extensions()
        self.extensions = [e for e in self.extensions if os.path.exists(self.get_ext_fullpath(e.name))]

    def build_extension(self, ext: Extension) -> None:
        """Compile one extension; a failure is no error."""
        try:
            super().build_extension(ext)
        except Exception as problem:
            print(f"plantar: {ext.name} cannot be compiled: {problem}")
            Path(self.get_ext_fullpath(ext.name)).unlink(missing_ok=True)  # what was made of an older source


def described(text: str, home: str, version: str) -> str:
    """README whose links lead to a version's files under a home, pictures to what is shown; as it is without a home."""

    def absolute(link: re.Match[str]) -> str:
        before, path, after = link.groups()
        shown = before.startswith(("src", "!"))
        return f"{before}{home}/{'raw' if shown else 'blob'}/v{version}/{path}{after}"

    link = r'((?:src|srcset)="|!?\[(?:[^\[\]]|\[[^\]]*\])*\]\()(?!#|\w+:)([^)"\s]+)([)"])'
    return re.sub(link, absolute, text) if home else text


def addresses(home: str, version: str) -> dict[str, str]:
    """What an index links to; nothing without a home."""
    pages = {
        "Source": "",
        "Documentation": "/tree/v{}/docs",
        "Changelog": "/blob/v{}/CHANGELOG.md",
        "Issues": "/issues",
    }
    return {name: home + path.format(version) for name, path in pages.items()} if home else {}


VERSION = re.findall(r'^VERSION = "(.+)"', Path("plantar/common/version.py").read_text(encoding="utf-8"), re.MULTILINE)[
    0
]

setup(
    ext_modules=extensions(),
    cmdclass={"build_ext": BuildWherePossible},
    long_description=described(Path("README.md").read_text(encoding="utf-8"), HOME, VERSION),
    long_description_content_type="text/markdown",
    project_urls=addresses(HOME, VERSION),
)
