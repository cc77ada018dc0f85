"""Hot functions, one plain-Python source each, compiled ahead of time where a compiler is found.

`geometry/convex.py` is plain Python; `convex.pxd` next to it has the C types with which Cython compiles that very file.
Without a compiler the source runs, slower, equal to the last bit. PLANTAR_KERNELS=python always runs the sources.
"""

import os
import sys
import warnings
from collections.abc import Sequence
from importlib import import_module
from importlib.machinery import EXTENSION_SUFFIXES, FileFinder, ModuleSpec, SourceFileLoader
from pathlib import Path
from types import ModuleType

__all__ = ["KERNELS", "compiled", "is_compiled", "outdated", "python_form"]

_FOLDER = Path(__file__).resolve().parent

_ROOM = {p.stem: p.parent.name for p in sorted(_FOLDER.glob("*/*.py")) if p.stem != "__init__"}

KERNELS: tuple[str, ...] = tuple(f"{room}.{name}" for name, room in _ROOM.items())
"""Names of the kernel modules, each after its room's: `geometry.convex`."""


class _SourceFinder:
    """Finds the kernels' sources, never their extensions."""

    def __init__(self, package: str) -> None:
        self.prefix = f"{package}."

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if not name.startswith(self.prefix) or not path:
            return None
        return FileFinder(path[0], (SourceFileLoader, [".py"])).find_spec(name)


def python_form(name: str) -> ModuleType:
    """Interpreted form of a kernel, to compare both.

    Returns module, loaded from its source under another name, with its imports interpreted too.
    """
    package = f"{__name__}_in_python"
    if package not in sys.modules:
        parent = ModuleType(package)
        sys.modules[package] = parent
        parent.__path__ = [str(_FOLDER)]
        sys.meta_path.insert(0, _SourceFinder(package))
    return import_module(f"{package}.{_full(name)}")


def _full(name: str) -> str:
    return name if "." in name else f"{_ROOM[name]}.{name}"


def is_compiled(name: str) -> bool:
    """Whether a kernel runs compiled. Returns False without extension, or with PLANTAR_KERNELS=python."""
    room, kernel = _full(name).split(".")
    return not _PYTHON and any((_FOLDER / room / f"{kernel}{suffix}").is_file() for suffix in EXTENSION_SUFFIXES)


def outdated(folder: Path) -> list[str]:
    """Kernels in a folder of rooms whose source changed after they were compiled.

    Returns their names, such as "geometry.convex".

    Example:
        >>> outdated(Path("no such folder"))
        []
    """
    found = []
    for room in sorted(p for p in folder.glob("*") if p.is_dir()):
        changed = {entry.name: entry.stat().st_mtime for entry in os.scandir(room)}
        for kernel in sorted(name[:-3] for name in changed if name.endswith(".py")):
            made = [changed[kernel + suffix] for suffix in EXTENSION_SUFFIXES if kernel + suffix in changed]
            if made and max(changed[f"{kernel}.py"], changed.get(f"{kernel}.pxd", 0.0)) > max(made):
                found.append(f"{room.name}.{kernel}")
    return found


_PYTHON = os.environ.get("PLANTAR_KERNELS", "") == "python"
if _PYTHON:
    sys.meta_path.insert(0, _SourceFinder(__name__))
elif (_FOLDER.parents[1] / "setup.py").is_file() and (_outdated := outdated(_FOLDER)):  # a checkout, not an install
    warnings.warn(f"kernels compiled from older sources ({', '.join(_outdated[:3])}): run `make setup`", stacklevel=2)

compiled: bool = all(is_compiled(name) for name in KERNELS)
"""Whether every kernel runs compiled."""
