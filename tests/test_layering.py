"""Who may import whom: the layers and rooms of docs/architecture.md, and one place for each heavy library."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
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

ROOMS: dict[str, tuple[str, ...]] = {
    "plantar": (
        *(
            "errors",
            "sides",
            "gravity",
            "kernels",
            "arguments",
            "arrays",
            "plane_points",
            "lazy",
            "record",
            "kernel_class",
        ),
        "atomic",
        *("console", "optional_library", "doctor", "files", "settings", "mechanics", "layouts", "plotting", "pages"),
        *("geometry", "sensing", "percepts", "recordings", "formats", "viewer", "bench"),
    ),
    "gait": (
        *("analysis", "plan", "estimate", "contact", "balance", "feet", "propose", "command"),
        *("controller_settings", "controller", "controller_tables"),
    ),
    "gait.analysis": (
        *("measures", "options", "subject", "spread", "prints", "steps", "body_weight", "activity"),
        *("mirrored_feet", "parameters", "pages", "analyse", "compare", "custom", "exports", "study"),
    ),
    "wholebody": ("dynamics", "tasks", "fusion", "stack", "behaviours", "torque_resolver"),
    "plantar.kernels": (
        *("base", "geometry", "mechanics", "skin", "gait", "joints", "contacts", "sensors", "judging", "formats"),
    ),
    "sim": (
        *(
            "libraries",
            "terrain",
            "robots",
            "plant",
            "model",
            "judging",
            "sensing",
            "body_skin",
            "contact_models",
            "figures",
        ),
        *("companion", "arms", "partner", "run", "bench", "survey", "sweep"),
    ),
    "shoes": (
        *(
            "units",
            "order",
            "materials",
            "dimensions",
            "parameters",
            "cells",
            "cad_kernel",
            "geometry",
            "foot",
            "fit",
            "plan",
            "solid",
            "build",
        ),
        *("insole", "checks", "papers", "coupon", "ordered", "found_foot"),
    ),
}
"""The rooms of a package (folders, and files beside them) in their order: a room imports only those before it."""

ALONE = {"gait.analysis"}
"""Rooms that import no other room of their package, and that none imports."""

PLACE_OF_LIBRARY = {
    "cadquery": "shoes",
    "OCP": "shoes",
    "trimesh": "shoes",
    "mujoco": ("sim", "shoes.foot.model_source"),
    "matplotlib": "plantar.plotting",
    "mpl_toolkits": "plantar.plotting",
    "mink": None,  # a reference in tests and benchmarks only
    "pink": None,
    "pytest": None,
    "hypothesis": None,
}
"""The module or package (or several), with what is inside it, that alone may import a heavy library."""


@cache
def imported_modules(source: str, module: str, is_package: bool) -> tuple[tuple[int, str], ...]:
    """Line and absolute name of every module that some source imports, at its top or anywhere inside."""
    return tuple(_imported(source, module, is_package))


def _imported(source: str, module: str, is_package: bool) -> Iterator[tuple[int, str]]:
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
                places = place if isinstance(place, tuple) else () if place is None else (place,)
                if not any(module == p or module.startswith(f"{p}.") for p in places):
                    allowed = ", ".join(places) or "tests and benchmarks"
                    found.append(f"{relative}:{line}: {top} is imported outside {allowed}")
    return sorted(set(found))


def test_every_import_keeps_the_layers():
    assert violations(ROOT) == []


def sources(root: Path) -> Iterator[tuple[str, Path]]:
    """Name and file of every module of the packages below a folder."""
    for path in sorted(p for part in ALLOWED for p in (root / part).rglob("*.py")):
        yield ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"), path


def imports_of(module: str, path: Path) -> tuple[tuple[int, str], ...]:
    """Line and name of every module that a file imports."""
    return imported_modules(path.read_text(encoding="utf-8"), module, path.name == "__init__.py")


def room_of(name: str, house: str) -> str | None:
    """The room of a module in a package; None for the package itself and for what is outside."""
    inside = name.removeprefix(f"{house}.")
    return inside.partition(".")[0] if inside != name else None


def arrows_up(root: Path) -> list[str]:
    """Every import from one room of a package into a later one, as file, line and reason."""
    found = []
    for module, path in sources(root):
        for house, rooms in ROOMS.items():
            own = room_of(module, house)
            if own is None:
                continue
            where = path.relative_to(root)
            if own not in rooms:
                found.append(f"{where}: '{own}' of {house} has no place in ROOMS of {Path(__file__).name}")
                continue
            for line, name in imports_of(module, path):
                other = room_of(name, house)
                if other in (None, own):
                    continue
                if other not in rooms[: rooms.index(own)] or ALONE & {f"{house}.{own}", f"{house}.{other}"}:
                    found.append(f"{where}:{line}: {own} imports {name}, which is no earlier room of {house}")
    return found


def circle(root: Path) -> list[str]:
    """Modules that import each other in a circle; empty where there is none."""
    modules = dict(sources(root))
    needs: dict[str, set[str]] = {}
    for module, path in modules.items():
        names = {name for _, name in imports_of(module, path)}
        # `from a import b` names both a and a.b; where the latter is a module, the former is no more than its place.
        places = {name.rpartition(".")[0] for name in names if name in modules}
        needs[module] = {name for name in names - places if name in modules}
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_no_room_imports_a_later_one():
    assert arrows_up(ROOT) == []


def test_no_modules_import_each_other_in_a_circle():
    assert circle(ROOT) == []


def plant(root, file, source):
    """Put a source file into a tree that a check is tried on."""
    path = root / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(source)


@pytest.mark.parametrize(
    ("file", "source", "reason"),
    [
        ("gait/plan/phases.py", "from gait.feet import swing", "plan imports gait.feet"),
        ("gait/analysis/compare.py", "import gait.plan.phases", "analysis imports gait.plan.phases"),
        ("gait/controller.py", "from gait.analysis.events import Contact", "controller imports gait.analysis"),
        ("gait/analysis/steps/events.py", "from gait.analysis.pages import page", "steps imports gait.analysis.pages"),
        ("sim/sensing/sensors.py", "def f():\n    from sim.run.scene import Scene", "sensing imports sim.run.scene"),
        ("shoes/build.py", "from shoes.checks import check", "build imports shoes.checks"),
        ("plantar/layouts/layout.py", "from ..percepts import feet", "layouts imports plantar.percepts"),
        ("plantar/helpers.py", "", "'helpers' of plantar has no place"),
    ],
)
def test_a_planted_arrow_up_is_found(tmp_path, file, source, reason):
    plant(tmp_path, file, source)
    assert any(reason in line for line in arrows_up(tmp_path)), arrows_up(tmp_path)


def test_a_planted_circle_is_found(tmp_path):
    (tmp_path / "sim").mkdir()
    (tmp_path / "sim" / "a.py").write_text("from sim import b")
    (tmp_path / "sim" / "b.py").write_text("def f():\n    import sim.c")
    (tmp_path / "sim" / "c.py").write_text("from sim.a import x")
    assert set(circle(tmp_path)) == {"sim.a", "sim.b", "sim.c"}


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
        ("plantar/sensing/force.py", "import gait", "plantar imports gait"),
        ("plantar/sensing/force.py", "from sim.sensing.skin import Skin", "plantar imports sim.sensing.skin"),
        (
            "plantar/formats/pedar.py",
            "def read():\n    import shoes.papers.export",
            "plantar imports shoes.papers.export",
        ),
        ("gait/plan/phases.py", "if True:\n    from sim import world", "gait imports sim"),
        ("gait/plan/phases.py", "import shoes", "gait imports shoes"),
        ("shoes/solid/tray.py", "from gait.plan import phases", "shoes imports gait"),
        ("shoes/solid/tray.py", "import sim.robots.robot as r", "shoes imports sim.robots.robot"),
        (
            "sim/run/runner.py",
            "from importlib import import_module\nimport_module('shoes.solid.tray')",
            "sim imports shoes.solid.tray",
        ),
        ("sim/run/runner.py", "import cli", "sim imports cli"),
        ("wholebody/tasks.py", "from gait.plan import phases", "wholebody imports gait"),
        ("sim/run/runner.py", "import trimesh", "trimesh is imported outside shoes"),
        ("cli.py", "def shoe():\n    import cadquery as cq", "cadquery is imported outside shoes"),
        ("gait/plan/phases.py", "from mujoco import MjModel", "mujoco is imported outside sim"),
        ("gait/plot.py", "from matplotlib.figure import Figure", "matplotlib is imported outside plantar.plotting"),
        ("sim/model/inverse_kinematics.py", "import mink", "mink is imported outside tests"),
        ("stray.py", "", "no layer"),
    ],
)
def test_a_planted_violation_is_found(tmp_path, file, source, reason):
    plant(tmp_path, file, source)
    found = violations(tmp_path)
    assert any(reason in line for line in found), found


@pytest.mark.parametrize(
    ("file", "source"),
    [
        (
            "sim/run/runner.py",
            "import mujoco\nfrom gait.plan import phases\nfrom plantar.layouts.layout import SoleLayout",
        ),
        ("sim/robots/robot.py", "from ..world import World\nfrom . import biped"),
        ("shoes/solid/tray.py", "def build():\n    import cadquery\n    import trimesh"),
        ("plantar/plotting.py", "def f():\n    from matplotlib.figure import Figure"),
        ("plantar/__init__.py", "from .force import wrench_at"),
        ("cli.py", "import shoes, sim, gait.analysis"),
    ],
)
def test_what_is_allowed_passes(tmp_path, file, source):
    plant(tmp_path, file, source)
    assert violations(tmp_path) == []
