"""docs/architecture.md speaks of what is there: its files, the names on a force's way, and every room."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
TEXT = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
PARTS = ("plantar", "gait", "sim", "shoes", "wholebody", "tests", "docs", "benchmarks", "tools", "cli.py")


def spoken_of(text: str) -> set[str]:
    """Paths of the repository that a text names between backticks."""
    names = re.findall(r"`([A-Za-z_][\w./-]*)`", text)
    return {name for name in names if name.split("/")[0] in PARTS and ("/" in name or name.endswith(".py"))}


def missing(text: str, root: Path = ROOT) -> list[str]:
    """Those of them that are not there."""
    return sorted(name for name in spoken_of(text) if not any((root / f"{name}{end}").exists() for end in ("", ".py")))


def way(text: str) -> list[str]:
    """Entries of the indented drawing, each a module and a name in it: `gait/command.Sensors`."""
    return re.findall(r"^ {4,}((?:\w+/)+\w+\.\w+)\s", text, re.MULTILINE)


def defined(path: Path) -> set[str]:
    """Public names of a module's own."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    return {node.name for node in body if isinstance(node, ast.FunctionDef | ast.ClassDef)}


def lost(text: str, root: Path = ROOT) -> list[str]:
    """Entries of the drawing that are not there."""
    found = []
    for entry in way(text):
        module, _, name = entry.rpartition(".")
        path = root / f"{module}.py"
        if not path.exists() or name not in defined(path):
            found.append(entry)
    return found


def rooms_of(package: str) -> set[str]:
    """Folders and files of a package, without what Python needs."""
    inside = (ROOT / package).iterdir()
    return {p.name.removesuffix(".py") for p in inside if p.suffix in ("", ".py") and not p.name.startswith("_")}


def test_every_file_that_it_names_is_there():
    assert len(spoken_of(TEXT)) > 10
    assert missing(TEXT) == []


def test_every_stop_on_the_three_ways_is_there():
    assert len(way(TEXT)) > 36
    assert lost(TEXT) == []
    assert way(TEXT)[0].startswith("sim/run/")
    assert any(stop.startswith("plantar/robots/kinematics/inverse_kinematics") for stop in way(TEXT))
    assert way(TEXT)[-1].startswith("shoes/checks")


@pytest.mark.parametrize("package", ["gait", "wholebody", "sim", "shoes"])
def test_every_room_is_told_with_its_question(package):
    table = re.search(rf"^\| room of `{package}` \|.*\n\|---\|---\|\n((?:\|.*\n)+)", TEXT, re.MULTILINE)
    told = set(re.findall(r"`(\w+)`", table[1]))
    left_out = {"robots", "scenes", "py"} if package == "sim" else set()
    assert rooms_of(package) - told - left_out - {"py.typed"} == set()


def test_what_is_planted_is_found(tmp_path):
    (tmp_path / "gait").mkdir()
    (tmp_path / "gait" / "walk.py").write_text("class Walk: ...\n")
    text = "`gait/walk.py` `gait/run.py` `gait/walk` `a/b`\n\n    gait/walk.Walk  x\n"
    text += "      gait/walk.Run  y\n    gait/no.Walk -> z\n"
    assert missing(text, tmp_path) == ["gait/run.py"]
    assert lost(text, tmp_path) == ["gait/walk.Run", "gait/no.Walk"]
