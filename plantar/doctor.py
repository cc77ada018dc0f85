"""Which optional libraries are installed, missing or broken, and the remedy."""

import platform
import sys
from collections.abc import Mapping
from ctypes.util import find_library
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from plantar.common.optional_library import LIBRARIES, optional_library
from plantar.common.version import VERSION
from plantar.errors import DependencyError

PURPOSES = {
    "": "reading, perception and analysis of recordings",
    "shoes": "plantar shoe: printable shoes",
    "sim": "plantar sim, sweep, robot, demo: walking in MuJoCo",
    "formats": "ROS bags, C3D files and images of footprints",
    "study": "mixed models and workbooks of a study",
    "warp": "skin in many worlds of MuJoCo Warp at once",
    "gym": "environments for learning, PlantarWalk-v0",
    "cluster": "plantar sweep --scheduler: workers on other machines",
}
"""What each extra is for."""


def examine(libraries: Mapping[str, Mapping[str, str]] = LIBRARIES) -> dict[str, Any]:
    """Load every library that Plantar can use.

    Returns versions, platform, whether kernels are compiled, a line of that (`kernels`), whether pictures need no
    display (`opengl`), and each library's extra, name, version and problem: None, "missing" or why it cannot be loaded.
    `holds` is False where a required one is missing, or one is broken.

    Example:
        >>> examine({"": {"no-such-library": "no_such_library"}})["libraries"][0]["problem"]
        'missing'
    """
    found: list[dict[str, str | None]] = [
        {"extra": extra, "library": name, **_state(name, module, extra or "all")}
        for extra, modules in libraries.items()
        for name, module in modules.items()
    ]
    kernels = import_module("plantar.kernels")
    wrong = [f for f in found if f["problem"] is not None and (f["problem"] != "missing" or not f["extra"])]
    return {
        "plantar": VERSION,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "compiled": kernels.compiled,
        "kernels": kernels.form_text(),
        "opengl": sys.platform != "linux" or any(find_library(name) is not None for name in ("EGL", "OSMesa")),
        "libraries": found,
        "holds": not wrong,
    }


def doctor_text(found: Mapping[str, Any]) -> str:
    """`examine`'s result for people: an extra a paragraph, and what to do.

    Example:
        >>> print(doctor_text(examine({"gym": {"no-such-library": "no_such_library"}})).splitlines()[-1].strip())
        get them: pip install 'gymnasium>=1.0'
    """
    lines = [f"plantar {found['plantar']}, Python {found['python']}, {found['platform']}", found["kernels"]]
    if not found["opengl"]:
        lines.append("pictures and videos: no EGL; on Debian or Ubuntu: sudo apt-get install libegl1")
    for extra in dict.fromkeys(f["extra"] for f in found["libraries"]):
        own = [f for f in found["libraries"] if f["extra"] == extra]
        lines.append(f"{extra or 'always needed'} ({PURPOSES.get(extra, '')})")
        lines += [f"    {f['library']} {f['version'] or ''}{_told(f['problem'])}".rstrip() for f in own]
        if any(f["problem"] == "missing" for f in own):
            lines.append(f"    get them: {DependencyError.install_command(extra)}")
    return "\n".join(lines)


def _state(name: str, module: str, extra: str) -> dict[str, str | None]:
    try:
        installed = version(name)
    except PackageNotFoundError:
        installed = None
    try:
        with optional_library(module, extra):
            import_module(module)
    except DependencyError as error:
        return {"version": installed, "problem": "missing" if installed is None else str(error)}
    return {"version": installed, "problem": None}


def _told(problem: str | None) -> str:
    if problem is None:
        return ""
    return "missing" if problem == "missing" else f": cannot be loaded: {problem}"
