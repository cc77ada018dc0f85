"""Who may import whom: the layers of docs/architecture.md, and one place for each heavy library."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

ALLOWED = {
    "plantar": {"plantar"},
    "gait": {"gait", "plantar"},
    "wholebody": {"wholebody", "plantar"},
    "shoes": {"shoes", "plantar"},
    "sim": {"sim", "gait", "wholebody", "plantar"},
    "cli": {"cli", "sim", "gait", "wholebody", "shoes", "plantar"},
}
"""What each part of the distribution may import of the distribution."""

PLACE_OF_LIBRARY = {
    "cadquery": "shoes",
    "OCP": "shoes",
    "trimesh": "shoes",
    "mujoco": "sim",
    "matplotlib": "plantar.plotting",
    "mpl_toolkits": "plantar.plotting",
    "mink": None,  # a reference in tests and benchmarks only
    "pink": None,
    "pytest": None,
    "hypothesis": None,
}
"""The module or package, with what is inside it, that alone may import a heavy library."""


def imported_modules(source: str, module: str, is_package: bool) -> Iterator[tuple[int, str]]:
    """Line and absolute name of every module that some source imports, at its top or anywhere inside."""
    package = module if is_package else module.rpartition(".")[0]
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package.split(".")
                base = ".".join([*parents[: len(parents) - node.level + 1], *([base] if base else [])])
            yield node.lineno, base
            for alias in node.names:
                yield node.lineno, f"{base}.{alias.name}"
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name in ("import_module", "__import__", "importorskip") and isinstance(node.args[0].value, str):
                yield node.lineno, node.args[0].value


def violations(root: Path) -> list[str]:
    """Every import below a folder that the layers forbid, as file, line and reason."""
    found = []
    modules = [p for p in root.glob("*.py") if p.name != "setup.py"]  # which builds the distribution, no part of it
    for path in sorted([*modules, *(p for part in ALLOWED for p in (root / part).rglob("*.py"))]):
        relative = path.relative_to(root)
        part = relative.parts[0].removesuffix(".py")
        module = ".".join(relative.with_suffix("").parts).removesuffix(".__init__")
        if part not in ALLOWED:
            found.append(f"{relative}: module '{part}' has no layer; give it one in {Path(__file__).name}")
            continue
        names = imported_modules(path.read_text(encoding="utf-8"), module, path.name == "__init__.py")
        for line, name in names:
            top = name.partition(".")[0]
            if top in ALLOWED and top not in ALLOWED[part]:
                found.append(f"{relative}:{line}: {part} imports {name}; allowed: {', '.join(sorted(ALLOWED[part]))}")
            if top in PLACE_OF_LIBRARY:
                place = PLACE_OF_LIBRARY[top]
                if place is None or not (module == place or module.startswith(f"{place}.")):
                    found.append(f"{relative}:{line}: {top} is imported outside {place or 'tests and benchmarks'}")
    return sorted(set(found))


def test_every_import_keeps_the_layers():
    assert violations(ROOT) == []


def test_every_part_is_looked_at():
    parts = {p.parent.name for p in ROOT.glob("*/__init__.py")} - {"tests"}
    assert parts <= set(ALLOWED)
    assert {"plantar", "gait", "shoes", "sim"} <= parts


def test_benchmarks_and_examples_do_not_import_the_command_line():
    for path in [*(ROOT / "benchmarks").rglob("*.py"), *(ROOT / "examples").rglob("*.py")]:
        names = [name for _, name in imported_modules(path.read_text(encoding="utf-8"), path.stem, False)]
        assert "cli" not in names, path


@pytest.mark.parametrize(
    ("file", "source", "reason"),
    [
        ("plantar/force.py", "import gait", "plantar imports gait"),
        ("plantar/force.py", "from sim.skin import Skin", "plantar imports sim.skin"),
        ("plantar/formats/pedar.py", "def read():\n    import shoes.export", "plantar imports shoes.export"),
        ("gait/lip.py", "if True:\n    from sim import world", "gait imports sim"),
        ("gait/lip.py", "import shoes", "gait imports shoes"),
        ("shoes/tray.py", "from gait import lip", "shoes imports gait"),
        ("shoes/tray.py", "import sim.robots.robot as r", "shoes imports sim.robots.robot"),
        ("sim/runner.py", "from importlib import import_module\nimport_module('shoes.tray')", "sim imports shoes.tray"),
        ("sim/runner.py", "import cli", "sim imports cli"),
        ("wholebody/tasks.py", "from gait import lip", "wholebody imports gait"),
        ("sim/runner.py", "import trimesh", "trimesh is imported outside shoes"),
        ("cli.py", "def shoe():\n    import cadquery as cq", "cadquery is imported outside shoes"),
        ("gait/lip.py", "from mujoco import MjModel", "mujoco is imported outside sim"),
        ("gait/plot.py", "from matplotlib.figure import Figure", "matplotlib is imported outside plantar.plotting"),
        ("sim/inverse_kinematics.py", "import mink", "mink is imported outside tests"),
        ("stray.py", "", "no layer"),
    ],
)
def test_a_planted_violation_is_found(tmp_path, file, source, reason):
    path = tmp_path / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)
    found = violations(tmp_path)
    assert any(reason in line for line in found), found


@pytest.mark.parametrize(
    ("file", "source"),
    [
        ("sim/runner.py", "import mujoco\nfrom gait import lip\nfrom plantar.layout import SoleLayout"),
        ("sim/robots/robot.py", "from ..world import World\nfrom . import biped"),
        ("shoes/tray.py", "def build():\n    import cadquery\n    import trimesh"),
        ("plantar/plotting.py", "def f():\n    from matplotlib.figure import Figure"),
        ("plantar/__init__.py", "from .force import wrench_at"),
        ("cli.py", "import shoes, sim, gait.analysis"),
    ],
)
def test_what_is_allowed_passes(tmp_path, file, source):
    path = tmp_path / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)
    assert violations(tmp_path) == []
