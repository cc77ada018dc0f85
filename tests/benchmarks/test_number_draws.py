"""Tuned numbers that are multiplied in a module as it is imported, and what their factors show."""

import ast
import os
import subprocess
import sys

import numpy as np
from number_draws import ROBOTS, SCENES, effects, factors, in_process, scale, tuned
from resumable import FOLDER
from walk_numbers import WalkNumber

from plantar.gait.propose.step_timing import LONGEST_DOUBLE

SOURCE = """
_LONE = 4
_PAIR = (0.1, 3)
_RATIO = 1 / 50

class Rules:
    reach: float = share(0.9, "leg", 0, 1)
    readings: int = whole(5, "readings")

def passed(x):
    return 0.3 * x > 3
"""


def number(line: int, kind: str, value: str = "") -> WalkNumber:
    return WalkNumber("made.py", line, kind, "made", value, "", "chosen", "")


def test_numbers_are_multiplied_where_they_stand():
    tree = ast.parse(SOURCE)
    kinds = [(2, "name"), (3, "name"), (4, "name"), (7, "setting"), (8, "setting")]
    every = [*(number(*each) for each in kinds), number(11, "literal", "0.3"), number(11, "literal", "3")]
    assert scale(tree, SOURCE, [(n, 1.2) for n in every]) == len(every)
    held: dict = {"share": lambda *a: a[0], "whole": lambda *a: a[0]}
    exec(compile(ast.fix_missing_locations(tree), "made", "exec"), held)
    assert held["_LONE"] == 5
    assert np.allclose(held["_PAIR"], (0.12, 4))
    assert np.isclose(held["_RATIO"], 1.2 / 50)
    assert held["Rules"].reach == 1.0  # the end of its range
    assert held["Rules"].readings == 6
    assert not held["passed"](11.0)  # 0.36 of it are below 4
    assert held["passed"](12.0)


def test_every_tuned_number_is_found_in_its_file():
    by_file: dict[str, list[tuple[WalkNumber, float]]] = {}
    for n in tuned().values():
        by_file.setdefault(n.path, []).append((n, 1.1))
    for path, numbers in by_file.items():
        source = (FOLDER.parent / path).read_text()
        assert scale(ast.parse(source), source, numbers) == len(numbers), path


def test_a_moved_number_is_what_a_walk_reads():
    name = next(n for n in tuned() if "LONGEST_DOUBLE" in n)
    code = f"""import sys
from number_draws import Finder
sys.meta_path.insert(0, Finder({{{name!r}: 1.2}}))
from plantar.gait.propose import late_foot
print(late_foot.LONGEST_DOUBLE)"""
    path = os.pathsep.join(map(str, (FOLDER, FOLDER.parent)))
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, capture_output=True)
    assert np.isclose(float(done.stdout), 1.2 * LONGEST_DOUBLE), done.stderr.decode()


def test_a_walk_that_raises_is_a_row():
    out = in_process({}, "flat", "no such robot", 0)
    assert not out["completed"]
    assert "no such robot" in out["failed"]


def test_the_number_that_does_something_is_the_surest():
    """Of made walks whose impact follows one number's factor, beside scatter of the same size."""
    names = list(tuned())
    chance = np.random.default_rng(7)
    known = chance.choice(len(names))
    rows = []
    for draw in range(1, 201):
        factor = factors(draw, names)[names[known]]
        for robot in ROBOTS:
            impact = 0.2 + 0.1 * (factor - 1.0) / 0.2 + chance.normal(0.0, 0.06)
            row = {"draw": str(draw), "scene": SCENES[draw % len(SCENES)], "robot": robot, "completed": "True"}
            rows.append({**row, "fell": "False", "impact": str(impact), "margin": "3.0"})
    first, second = effects(rows)[:2]
    assert first[0] == names[known]
    assert first[2] == "impact"
    assert abs(first[3] - 0.1) < 0.02
    assert abs(first[4]) > 2.0 * abs(second[4])
