"""The stamp of a whole build: a hash of the kernels' sources, and the extensions that were made of them.

`setup.py` writes it when every extension was built, and leaves none otherwise: kernels run all compiled or all
interpreted, since compiled ones take no objects of interpreted ones.
"""

import hashlib
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

__all__ = ["STAMP", "lack", "write"]

STAMP = "compiled.stamp"
"""Name of its file, in the kernels' folder."""

_SHARED = "base.memoryviews"  # Cython's own code for views of arrays, which has no source here


def _names(folder: Path) -> list[str]:
    """Names of all extensions, such as "geometry.convex": kernels with types."""
    kernels = [p for p in folder.glob("*/*.pxd") if p.with_suffix(".py").is_file()]
    return sorted([*(f"{p.parent.name}.{p.stem}" for p in kernels), _SHARED])


def _sources(folder: Path) -> str:
    """Hash of all sources and types."""
    found = hashlib.sha256()
    for path in sorted(p for suffix in ("py", "pxd") for p in folder.glob(f"*/*.{suffix}")):
        found.update(path.relative_to(folder).as_posix().encode())
        found.update(path.read_bytes())
    return found.hexdigest()


def _missing(folder: Path, names: list[str]) -> list[str]:
    """Those whose extension is not in the folder."""
    return [n for n in names if not any((folder / f"{n.replace('.', '/')}{s}").is_file() for s in EXTENSION_SUFFIXES)]


def write(folder: Path, sources: Path) -> list[str]:
    """Stamp a folder of rooms built from `sources` if it holds every extension; take an older stamp away.

    Returns:
        Names of extensions that it lacks.
    """
    names = _names(sources)
    missing = _missing(folder, names)
    if missing:
        (folder / STAMP).unlink(missing_ok=True)
    else:
        (folder / STAMP).write_text("\n".join([_sources(sources), *names]) + "\n", encoding="ascii")
    return missing


def lack(folder: Path, *, sources_too: bool) -> str:
    """Why the kernels in a folder cannot run compiled, in a few words; empty if they can.

    Args:
        folder: Of the rooms.
        sources_too: Whether to compare the sources with those that were compiled, as a checkout needs.
    """
    try:
        made, *names = (folder / STAMP).read_text(encoding="ascii").split()
    except (OSError, ValueError):
        names = _names(folder)
        missing = _missing(folder, names)
        if len(missing) == len(names):
            return "none of them is compiled"
        return f"{len(missing)} of {len(names)} were not compiled" if missing else "the build was not finished"
    missing = _missing(folder, names)
    if missing:
        return f"{len(missing)} of {len(names)} compiled ones are missing: {', '.join(missing[:3])}"
    if sources_too and made != _sources(folder):
        return "they were compiled from other sources"
    return ""
