"""Who may import whom: the layers and rooms of docs/architecture.md, and one place for each heavy library."""

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
    "robots": {"robots", "gait", "plantar"},
    "wholebody": {"wholebody", "plantar"},
    "shoes": {"shoes", "plantar"},
    "sim": {"sim", "robots", "gait", "wholebody", "plantar"},
    "testing": {"testing", "sim", "robots", "gait", "wholebody", "plantar"},
    "commands": {"commands", "sim", "robots", "gait", "wholebody", "shoes", "plantar"},
    "cli": {"cli", "commands", "sim", "robots", "gait", "wholebody", "shoes", "plantar"},
}
"""What each part of the distribution may import of the distribution: `plantar` is what lies in no other part."""


def part_of(module: str) -> str | None:
    """The part of the distribution that a module belongs to; None for other libraries."""
    top, _, rest = module.partition(".")
    inside = rest.partition(".")[0]
    if top != "plantar":
        return None
    return "cli" if inside == "__main__" else inside if inside in ALLOWED else "plantar"


ROOMS: dict[str, tuple[str, ...]] = {
    "plantar": (
        *("errors", "kernels", "common", "parts", "doctor", "mechanics", "layouts", "plotting", "geometry"),
        *("sensing", "percepts", "batch", "mujoco", "recordings", "formats", "live"),
        *("calibration", "viewer", "bench"),
    ),
    "plantar.common": (
        *(
            "version",
            "sides",
            "gravity",
            "arguments",
            "arrays",
            "plane_points",
            "lazy",
            "record",
            "atomic",
            "table_writer",
            "row_table",
        ),
        *("optional_library", "console", "extensions", "files", "settings", "pages", "workers"),
    ),
    "plantar.gait": (
        *("analysis", "plan", "estimate", "contact", "balance", "feet", "propose", "command", "safety"),
        *("controller_settings", "tick", "controller", "controller_tables"),
    ),
    "plantar.gait.analysis": (
        *("earlier_output", "masks", "measures", "options", "subject", "prints", "steps", "summary", "direction"),
        *("health", "activity"),
        *(
            "parameters",
            "measure_errors",
            "pages",
            "metrics",
            "results",
            "analyse_one",
            "compare",
            "day",
            "walkway",
            "study",
        ),
        *("custom", "c3d_export", "exports", "analyse"),
    ),
    "plantar.wholebody": ("dynamics", "tasks", "fusion", "stack", "behaviours", "torque_resolver", "held_gains"),
    "plantar.robots": (
        *("robot_tables", "biped", "robot", "robot_file", "leg_shapes", "model_file", "kinematics", "walk"),
        *("motors", "sole_readings", "controller_settings", "start", "bring_up", "controller", "survey"),
    ),
    "plantar.kernels": (
        *("build_stamp", "base", "geometry", "mechanics", "skin", "gait", "joints", "contacts", "sensors", "judging"),
        *("formats", "safety"),
    ),
    "plantar.sim": (
        *("libraries", "papers", "terrain", "plant", "model", "judging", "sensing", "body_skin"),
        *("figures", "loop", "companion", "arms", "partner", "run", "environments"),
        *("bench", "survey", "sweep"),
    ),
    "plantar.shoes": (
        *("units", "order", "processes", "materials", "dimensions", "parameters", "cells", "cad_kernel"),
        *("geometry", "foot", "fit", "plan", "solid", "build", "insole", "checks", "wiring", "papers"),
        *("coupon", "cell_choice", "ordered", "found_foot"),
    ),
}
"""The rooms of a package (folders, and files beside them) in their order: a room imports only those before it."""

ALONE = {"plantar.gait.analysis"}
"""Rooms that import no other room of their package, and that none imports."""

PLACE_OF_LIBRARY = {
    "cadquery": "plantar.shoes",
    "OCP": "plantar.shoes",
    "trimesh": ("plantar.shoes", "plantar.common.files.mesh_library"),
    "mujoco": (
        *("plantar.testing.terrain", "plantar.sim", "plantar.robots", "plantar.mujoco"),
        *("plantar.shoes.foot.model_bodies", "plantar.common.files.model_limits"),
    ),
    "matplotlib": "plantar.plotting",
    "mpl_toolkits": "plantar.plotting",
    "gymnasium": "plantar.sim.environments",
    "warp": ("plantar.mujoco.warp_kernels", "plantar.mujoco.warp_skin", "plantar.mujoco.mjlab_sensor"),
    "mjlab": "plantar.mujoco.mjlab_sensor",
    "torch": "plantar.mujoco.mjlab_sensor",
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
    scripts = {"setup.py", "cli.py"}  # one builds the distribution, the other starts its command line from a checkout
    for path in sorted(p for p in root.glob("*.py") if p.name not in scripts):
        found.append(f"{path.name}: module '{path.stem}' has no layer; allowed: modules of plantar/")
    for module, path in sources(root):
        part = part_of(module)
        where = path.relative_to(root)
        for line, name in imports_of(module, path):
            top = name.partition(".")[0]
            other = part_of(name)
            if top in ALLOWED and top != "plantar":
                found.append(f"{where}:{line}: imports {name}, a folder of the checkout; allowed: plantar.{name}")
            if other is not None and other not in ALLOWED[part] and module != "plantar":  # the doors of the root
                found.append(f"{where}:{line}: {part} imports {name}; allowed: {', '.join(sorted(ALLOWED[part]))}")
            if top in PLACE_OF_LIBRARY:
                place = PLACE_OF_LIBRARY[top]
                places = place if isinstance(place, tuple) else () if place is None else (place,)
                if not any(module == p or module.startswith(f"{p}.") for p in places):
                    allowed = ", ".join(places) or "tests and benchmarks"
                    found.append(f"{where}:{line}: {top} is imported outside {allowed}")
    return sorted(set(found))


def test_every_import_keeps_the_layers():
    assert violations(ROOT) == []


def sources(root: Path) -> Iterator[tuple[str, Path]]:
    """Name and file of every module of the distribution below a folder."""
    for path in sorted((root / "plantar").rglob("*.py")):
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
            if own is None or part_of(module) != part_of(house):
                continue
            where = path.relative_to(root)
            if own not in rooms:
                found.append(f"{where}: '{own}' of {house} has no place in ROOMS of {Path(__file__).name}")
                continue
            for line, name in imports_of(module, path):
                other = room_of(name, house)
                if other in (None, own) or part_of(name) != part_of(house):
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
        ("plantar/gait/plan/phases.py", "from plantar.gait.feet import swing", "plan imports plantar.gait.feet"),
        ("plantar/gait/controller.py", "from plantar.gait.analysis.events import Contact", "controller imports"),
        ("plantar/gait/analysis/steps/events.py", "from plantar.gait.analysis.pages import page", "steps imports"),
        ("plantar/shoes/build.py", "from plantar.shoes.checks import check", "build imports plantar.shoes.checks"),
        ("plantar/layouts/layout.py", "from ..percepts import feet", "layouts imports plantar.percepts"),
        ("plantar/helpers.py", "", "'helpers' of plantar has no place"),
    ],
)
def test_a_planted_arrow_up_is_found(tmp_path, file, source, reason):
    plant(tmp_path, file, source)
    assert any(reason in line for line in arrows_up(tmp_path)), arrows_up(tmp_path)


def test_a_planted_circle_is_found(tmp_path):
    folder = tmp_path / "plantar" / "sim"
    folder.mkdir(parents=True)
    (folder / "a.py").write_text("from plantar.sim import b")
    (folder / "b.py").write_text("def f():\n    import plantar.sim.c")
    (folder / "c.py").write_text("from plantar.sim.a import x")
    assert set(circle(tmp_path)) == {"plantar.sim.a", "plantar.sim.b", "plantar.sim.c"}


def test_every_part_is_looked_at():
    parts = {part_of(module) for module, _ in sources(ROOT)}
    assert parts == set(ALLOWED)


def test_benchmarks_and_examples_do_not_import_the_command_line():
    for path in [*(ROOT / "benchmarks").rglob("*.py"), *(ROOT / "examples").rglob("*.py")]:
        names = [name for _, name in imported_modules(path.read_text(encoding="utf-8"), path.stem, False)]
        assert "plantar.cli" not in names, path


@pytest.mark.parametrize(
    ("file", "source", "reason"),
    [
        ("plantar/sensing/force.py", "import plantar.gait", "plantar imports plantar.gait"),
        ("plantar/gait/plan/phases.py", "if True:\n    from plantar.sim import world", "gait imports plantar.sim"),
        ("plantar/shoes/solid/tray.py", "import plantar.robots.robot as r", "shoes imports plantar.robots"),
        (
            "plantar/sim/run/runner.py",
            "from importlib import import_module\nimport_module('plantar.shoes.solid.tray')",
            "sim imports plantar.shoes.solid.tray",
        ),
        ("plantar/sim/run/runner.py", "from plantar import cli", "sim imports plantar.cli"),
        ("plantar/sim/run/runner.py", "import gait.command", "a folder of the checkout"),
        (
            "plantar/sim/run/runner.py",
            "import trimesh",
            "trimesh is imported outside plantar.shoes, plantar.common.files.mesh_library",
        ),
        ("plantar/cli.py", "def shoe():\n    import cadquery as cq", "cadquery is imported outside plantar.shoes"),
        ("plantar/gait/plot.py", "from matplotlib.figure import Figure", "matplotlib is imported outside"),
        ("plantar/robots/kinematics/inverse_kinematics.py", "import mink", "mink is imported outside tests"),
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
            "plantar/sim/run/runner.py",
            "import mujoco\nfrom plantar.gait.plan import phases\nfrom plantar.layouts.layout import SoleLayout",
        ),
        ("plantar/robots/robot.py", "from ..world import World\nfrom . import biped"),
        ("plantar/shoes/solid/tray.py", "def build():\n    import cadquery\n    import trimesh"),
        ("plantar/plotting.py", "def f():\n    from matplotlib.figure import Figure"),
        ("plantar/__init__.py", "from .force import wrench_at\nfrom plantar.sim.run.scene_kind import run"),
        ("plantar/cli.py", "import plantar.shoes, plantar.sim, plantar.gait.analysis"),
    ],
)
def test_what_is_allowed_passes(tmp_path, file, source):
    plant(tmp_path, file, source)
    assert violations(tmp_path) == []
