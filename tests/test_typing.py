"""A user's typed script, checked by mypy against the two ways to install Plantar."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

# One line a package; the comment says what mypy has to find where there is one.
SCRIPT = """
from dataclasses import replace

import numpy as np

from plantar.common.settings.schema import Settings, choice, number
from plantar.mechanics.lip import pendulum_frequency
from plantar.geometry import polygon
from plantar import Percept, Reading, SoleLayout, hex_layout
from plantar.geometry.inscribed import inscribed_circle
from plantar.shoes.units import to_m
from plantar.sim.run.scene import Scene, load_scene

layout: SoleLayout = hex_layout([[0.0, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.1]])
percept = Percept(layout, Reading(time=0.0, force=np.zeros(len(layout))))
area: float = percept.contact_area
hull = polygon.convex_hull(percept.support_polygon_in_sole)
circle = inscribed_circle(hull)
radius: float = 0.0 if circle is None else circle.radius
omega: float = pendulum_frequency(0.8)
scene: Scene = load_scene("flat")
length: float = to_m(250.0)


class Spring(Settings):
    stiffness: float = number(100.0, "N/m", 1.0)
    metal: str = choice("steel", "brass")


spring: Spring = replace(Spring(20.0, metal="brass"), stiffness=3.0)
stiff: float = spring.stiffness
"""
WRONG = """
import plantar.nothing  # import-not-found
import numpy as np

from plantar.common.settings.schema import Settings, number
from plantar.mechanics.lip import pendulum_frequency
from plantar import Percept, Reading, hex_layout, no_such_name  # attr-defined
from plantar.shoes.units import to_m
from plantar.sim.run.scene import load_scene

layout = hex_layout([[0.0, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.1]])
percept = Percept(layout, Reading(time=0.0, force="none"))  # arg-type
area: str = percept.contact_area  # assignment
radius = percept.inscribed_circle_in_sole.radius  # union-attr
omega = pendulum_frequency("0.8")  # arg-type
scene: int = load_scene("flat")  # assignment
length = to_m("250")  # type-var


class Spring(Settings):
    stiffness: float = number(100.0, "N/m", 1.0)


Spring().stiffness = 3.0  # misc
Spring(stifness=3.0)  # call-arg
Spring("stiff")  # arg-type
"""


@pytest.fixture(scope="module")
def editable(tmp_path_factory):
    """The interpreter of an environment with an editable install, as `tools/make-venv` makes one, of a copy of the
    checkout; without Cython, so that nothing is compiled. The libraries come from this environment by a path file."""
    folder = tmp_path_factory.mktemp("editable")
    source = folder / "source"
    left_out = shutil.ignore_patterns("__pycache__", "*.so", "*.pyd", "*.egg-info")
    shutil.copytree(ROOT / "plantar", source / "plantar", ignore=left_out)
    for name in ("setup.py", "pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    (folder / "blocked").mkdir()
    (folder / "blocked" / "Cython.py").write_text("raise ImportError")
    venv.create(folder / "venv", with_pip=False, symlinks=os.name != "nt")
    python = folder / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
    here = sysconfig.get_paths(vars={"base": str(folder / "venv"), "platbase": str(folder / "venv")})["purelib"]
    (Path(here) / "libraries.pth").write_text(sysconfig.get_paths()["purelib"] + "\n")
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV", "PLANTAR"))}
    pip = f"-m pip --python {python} --disable-pip-version-check install --quiet --no-deps --no-index"
    flags = "--no-build-isolation --ignore-installed --editable"
    done = subprocess.run(
        [sys.executable, *pip.split(), *flags.split(), str(source)],
        env=environment | {"PYTHONPATH": str(folder / "blocked")},
        cwd=folder,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return python


def checked(python: Path, folder: Path, **scripts: str) -> dict[str, dict[int, str]]:
    """What mypy finds in a user's scripts, strictly: of each the code of the error on each line. No cache is
    kept and no configuration read."""
    for name, script in scripts.items():
        (folder / f"{name}.py").write_text(script)
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "MYPY"))}
    flags = "--strict --config-file= --cache-dir=/dev/null --no-color-output --python-executable"
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *flags.split(), str(python), *(f"{name}.py" for name in scripts)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode in (0, 1), done.stderr
    found: dict[str, dict[int, str]] = {name: {} for name in scripts}
    for name, line, code in re.findall(r"^(\w+)\.py:(\d+): error: .*\[([a-z-]+)\]$", done.stdout, re.M):
        found[name][int(line)] = code
    return found


def expected(script: str) -> dict[int, str]:
    return {i: m[1] for i, line in enumerate(script.splitlines(), 1) if (m := re.search(r"  # ([a-z-]+)$", line))}


@pytest.mark.long  # 13 s of the processor; `make lint` checks the package itself, as strictly
def test_a_right_script_passes_and_every_wrong_line_is_found(editable, tmp_path):
    found = checked(editable, tmp_path, right=SCRIPT, wrong=WRONG)
    assert found == {"right": {}, "wrong": expected(WRONG)}
