"""Which optional libraries are installed, missing or broken, and the remedy."""

import platform
import re
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
    "parquet": "plantar analyze --parquet: steps of a study as Parquet",
    "warp": "skin in many worlds of MuJoCo Warp at once",
    "gym": 'environments for learning: gymnasium.make("plantar.sim.environments:PlantarWalk-v0")',
    "cluster": "plantar sweep --scheduler: workers on other machines",
}
"""What each extra is for."""


def examine(libraries: Mapping[str, Mapping[str, str]] = LIBRARIES) -> dict[str, Any]:
    """Load every library that Plantar can use.

    Returns versions, platform, whether kernels are compiled, a line of that (`kernels`), whether pictures need no
    display (`opengl`), and each library's extra, name, version, problem (None, "missing", why it cannot be loaded, or
    the version that is needed) and remedy, a command or None. `holds` is False where a required one is missing, or one
    is broken.

    Example:
        >>> examine({"": {"no-such-library": "no_such_library"}})["libraries"][0]["problem"]
        'missing'
    """
    found: list[dict[str, str | None]] = [
        {"extra": extra, "library": name, **_state(name, module, extra)}
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
        >>> text = doctor_text(examine({"gym": {"no-such-library": "no_such_library"}}))
        >>> text.endswith("pip install 'gymnasium>=1.0'")
        True
    """
    lines = [f"plantar {found['plantar']}, Python {found['python']}, {found['platform']}", found["kernels"]]
    if not found["opengl"]:
        lines.append("pictures and videos: no EGL; on Debian or Ubuntu: sudo apt-get install libegl1")
    for extra in dict.fromkeys(f["extra"] for f in found["libraries"]):
        own = [f for f in found["libraries"] if f["extra"] == extra]
        lines.append(f"{extra or 'always needed'} ({PURPOSES.get(extra, '')})")
        for f in own:
            lines.append(f"    {f['library']} {f['version'] or ''}{_told(f['problem'])}".rstrip())
            if f["remedy"] is not None:
                lines.append(f"        repair it: {f['remedy']}")
        if any(f["problem"] == "missing" for f in own):
            lines.append(f"    get them: {DependencyError.install_command(extra)}")
    return "\n".join(lines)


_SYSTEM = {"libGL.so": "libgl1", "libX11.so": "libx11-6", "libEGL.so": "libegl1", "libgomp.so": "libgomp1"}
"""Libraries of the system that wheels need, and the packages of Debian and Ubuntu that bring them."""


def _state(name: str, module: str, extra: str) -> dict[str, str | None]:
    try:
        installed = version(name)
    except PackageNotFoundError:
        installed = None
    try:
        with optional_library(module, extra):
            import_module(module)
    except DependencyError as error:
        if installed is None:
            return {"version": None, "problem": "missing", "remedy": None}
        reason = error.reason or "its files are not there"
        return {"version": installed, "problem": f"cannot be loaded ({reason})", "remedy": _remedy(name, extra, reason)}
    needed = next((r for r in DependencyError.requirements(extra) if re.split("[^\\w.-]", r)[0] == name), name)
    if installed is not None and _numbers(installed) < _numbers(needed.partition(">=")[2]):
        return {
            "version": installed,
            "problem": f"too old, {needed} is needed",
            "remedy": DependencyError.install_command(extra),
        }
    return {"version": installed, "problem": None, "remedy": None}


def _remedy(name: str, extra: str, reason: str) -> str:
    """What repairs a library that is installed, and cannot be loaded."""
    package = next((package for library, package in _SYSTEM.items() if library in reason), None)
    if package is not None:
        return f"sudo apt-get install {package} (on Debian or Ubuntu)"
    lacking = re.search(r"No module named '([\w.]+)", reason)
    known = {module: library for found in LIBRARIES.values() for library, module in found.items()}
    program = re.split(" ['\"]", DependencyError.install_command(extra))[0]
    return f"{program} --force-reinstall {name if lacking is None else known.get(lacking[1], name)}"


def _numbers(text: str) -> tuple[int, ...]:
    """The numbers that a version begins with: (3, 10) of "3.10" and "3.10rc1"."""
    return tuple(int(part) for part in re.match(r"[\d.]*", text)[0].split(".") if part)  # type: ignore[index]


def _told(problem: str | None) -> str:
    if problem is None:
        return ""
    return "missing" if problem == "missing" else f": {problem}"
