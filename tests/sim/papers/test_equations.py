"""What a docstring claims of an equation, some scene switches on: a few runs call it.

Marks are "T 4.21", "K 28-33", "A 5-9". Sections ("T 4.2.7") are no equations. Compiled functions do not show in a
profile: their marks count where a run has loaded them.
"""

import ast
import inspect
import re
import sys
from pathlib import Path

import pytest

import plantar
from plantar.sim.run.scene_kind import open_scene, simulation_of

ROOT = Path(plantar.__file__).parent
_NUMBER = r"(?:\d+\.)?\d+(?![.\d])"
_RANGE = rf"{_NUMBER}(?:-{_NUMBER})?"
MARK = re.compile(rf"\b([TKA]) ({_RANGE}(?:(?:, | and ){_RANGE})*)")

QUICK = ("walk.settle=0.0", "walk.start=0.8", "walk.end=0.4")
RUNS = (
    ("push-step", ("paper=K", "walk.steps=3", "push.step=1", "push.small=0", *QUICK), None, 7.0),
    ("flat", ("paper=T", "walk.steps=2", *QUICK), "h1", 9.0),
    ("flat", ("walk.steps=2", *QUICK), "hrp2kai", 9.0),
    ("leader-follower", ("paper=K", *QUICK), None, 4.0),
    ("force-tracking-1", ("paper=A",), None, 6.0),
    ("guide", ("walk.steps=2", *QUICK), None, 4.0),
    ("stove", (), None, 10.0),
    ("pressure", (), None, 4.0),
    ("intentional-contact", ("paper=T",), None, 6.0),
)
"""Scenes with settings and robot, and for how many seconds each is run at most."""

SECTIONS = {"A 3.4", "K 2.4", "K 2.5", "K 4.3", "K 6.1", "T 3.2", "T 4.1", "T 5.1"}
"""Numbers of two parts that are sections where docstrings name them."""


def equations(text):
    """Each equation that a text names: "K 28-30" is three."""
    found = set()
    for paper, numbers in MARK.findall(text):
        for part in re.split(", | and ", numbers):
            first, _, last = part.partition("-")
            chapter, _, low = first.rpartition(".")
            high = last.rpartition(".")[2] or low
            found |= {f"{paper} {chapter}{'.' if chapter else ''}{n}" for n in range(int(low), int(high) + 1)}
    return found - SECTIONS


def claims():
    """Of each docstring with marks: its file, qualified name, whether its owner is called itself, and equations."""

    def below(path, node, names):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.FunctionDef | ast.ClassDef):
                found = equations(ast.get_docstring(child) or "")
                if found:
                    yield path, ".".join([*names, child.name]), isinstance(child, ast.FunctionDef), found
                yield from below(path, child, [*names, child.name])

    for path in sorted(ROOT.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        found = equations(ast.get_docstring(tree) or "")
        if found:
            yield path, "", False, found
        yield from below(path, tree, [])


def unclaimed(called, claimed):
    """Equations that no claim has in what was called: files and qualified names."""
    files = {file for file, _ in called}
    compiled = {
        str(ROOT.parent / m.replace(".", "/")) + ".py" for m in list(sys.modules) if m.startswith("plantar.kernels")
    }
    ran = set()
    for path, name, is_function, found in claimed:
        file = str(path)
        if file in compiled or ((file, name) in called if is_function else file in files):
            ran |= found
    return set().union(*(found for *_, found in claimed)) - ran


def test_marks_are_read():
    assert equations("pushed (T 4.21, K 28-30 corrected), A 5 and 9") == {
        "T 4.21",
        "K 28",
        "K 29",
        "K 30",
        "A 5",
        "A 9",
    }
    assert equations("section T 4.2.7 and T 4.4.1.3") == set()


@pytest.mark.long
def test_every_equation_that_is_claimed_is_switched_on_by_a_scene():
    claimed = list(claims())
    assert len(unclaimed(set(), claimed)) > 100
    codes = set()
    missing = set()

    def note(frame, event, _):
        if event == "call" and frame.f_code.co_flags & inspect.CO_OPTIMIZED:  # no body of a module or class
            codes.add(frame.f_code)

    for scene, settings, robot, end in RUNS:
        before = sys.getprofile()
        sys.setprofile(note)
        try:
            simulation = simulation_of(open_scene(scene, settings, robot), 1)
            kind = type(simulation)
            ended = property(lambda s, k=kind, t=end: k.ended.fget(s) or s.world.data.time > t)
            simulation.__class__ = type(kind.__name__, (kind,), {"ended": ended})
            simulation.run()
        finally:
            sys.setprofile(before)
        missing = unclaimed({(code.co_filename, code.co_qualname) for code in codes}, claimed)
        if not missing:
            return
    assert not missing, sorted(missing)
