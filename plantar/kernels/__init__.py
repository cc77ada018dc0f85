"""Hot functions, one plain-Python source each, compiled ahead of time where a compiler is found.

`geometry/convex.py` is plain Python; `convex.pxd` next to it has the C types with which Cython compiles that very file.
Without a compiler the sources run, slower, equal to the last bit. PLANTAR_KERNELS=python always runs the sources. Where
one extension is missing or older than its source, all sources run: see `build_stamp`.
"""

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.machinery import FileFinder, ModuleSpec, SourceFileLoader
from pathlib import Path
from types import ModuleType

from plantar.errors import KernelError
from plantar.kernels.build_stamp import lack

__all__ = ["KERNELS", "compiled", "form_text", "need_compiled", "problem", "python_form"]

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


_PYTHON = os.environ.get("PLANTAR_KERNELS", "") == "python"
_CHECKOUT = (_FOLDER.parents[1] / "setup.py").is_file()

problem: str = "" if _PYTHON else lack(_FOLDER, sources_too=_CHECKOUT)
"""Why kernels run as plain Python though PLANTAR_KERNELS does not ask for that; empty if they are compiled."""

compiled: bool = not _PYTHON and not problem
"""Whether the kernels run compiled: all of them do, or none."""

if not compiled:
    sys.meta_path.insert(0, _SourceFinder(__name__))


def form_text() -> str:
    """A line for people: in which form the kernels run, and where that is not as asked for, why and what to do."""
    if compiled:
        return "kernels: compiled"
    if not problem:
        return "kernels: plain Python, as PLANTAR_KERNELS asks for"
    remedy = "run `make setup`" if _CHECKOUT else "install a C compiler, then Plantar again"
    return f"kernels: plain Python, slower ({problem}); {remedy}"


def need_compiled(work: str) -> None:
    """Refuse work that is too slow by interpreted kernels; PLANTAR_KERNELS=python allows it.

    Args:
        work: Such as "walking".

    Raises:
        KernelError: If they are not compiled.
    """
    if problem:
        raise KernelError(
            f"{work} needs compiled kernels, a control tick of 5 ms takes about 19 ms without; {form_text()}"
        )
