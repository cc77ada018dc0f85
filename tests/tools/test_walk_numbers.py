"""The numbers of a walk: all are listed, and one without a reason is noticed."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

import walk_numbers

SOURCE = '''"""A part.

Nature: 9.81 is the acceleration of free fall.
"""
import math
from enum import IntEnum
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from plantar.common.settings.schema import fixed, number, share

if TYPE_CHECKING:
    LIMIT = 7.0

_NAMED = 3.5  # derived: half of seven
_BELOW = 4.5
"""How far it goes. Measured: 20 % less falls."""
# Chosen: between two that
# are worse.
_ABOVE = (5.5, 6.5)
_PLANTED = 1.7  # how far it goes
_START = 0.0
_TEXT = "7.5"


class Kind(IntEnum):
    WALKS = 3


class Rules:
    """Rules.

    Attributes:
        gain: How much, in 1/s. Nature: T Table 2.
        speed: How fast, beside `gain`.
    """

    gain: float = number(1.5, "1/s", 0, 50)
    speed: float = share(0.3, "leg/beat", 0.001, 10)
    reach: float = fixed(1 / 3, "leg")  # derived: a step
    count: ClassVar[int] = 8


def fall(x: float, after: float = 0.25) -> float:
    """Free fall.

    Measured: 0.125 of x is lost.
    """
    if x > 0.6:
        raise ValueError(f"{x + 3.0} is above 0.6")
    rows = np.zeros((3, 4))[3:, 2 * 3]
    y = 0.5 * 9.81 * x**3 + 0.125 * x + round(x, 4) + 2.0 * len(rows)
    # derived: a quarter turn
    z = 1.57 * y
    return z + 1.58
'''


def kinds(source: str, reason: str) -> set[tuple[str, str]]:
    """Name and value of the numbers of a module that have a reason."""
    found = walk_numbers.numbers_in(source, "plantar/gait/made.py")
    return {(n.name if n.kind != "literal" else "", n.value) for n in found if n.reason == reason}


@pytest.fixture(scope="module")
def walk() -> list[walk_numbers.WalkNumber]:
    return walk_numbers.numbers_on()


def test_each_number_on_the_control_path_has_a_reason(walk):
    without = [n for n in walk if not n.reason]
    assert not without, f"numbers without a reason (see tools/walk_numbers.py):\n{walk_numbers.listed(without)}"


def test_a_planted_number_without_a_reason_is_found():
    assert kinds(SOURCE, "") == {
        ("_PLANTED", "1.7"),
        ("speed", "0.3"),
        ("count", "8"),
        ("", "0.25"),
        ("", "0.6"),
        ("", "1.58"),
    }


def test_reasons_stand_beside_a_number_or_in_a_docstring_that_names_it():
    assert kinds(SOURCE, "derived") == {("_NAMED", "3.5"), ("reach", "1 / 3"), ("", "1.57")}
    assert kinds(SOURCE, "nature") == {("gain", "1.5"), ("", "9.81")}
    assert kinds(SOURCE, "measured") == {("_BELOW", "4.5"), ("", "0.125")}
    assert kinds(SOURCE, "chosen") == {("_ABOVE", "(5.5, 6.5)")}


def test_a_number_keeps_its_place_unit_and_reason():
    found = {n.name: n for n in walk_numbers.numbers_in(SOURCE, "plantar/gait/made.py")}
    speed = found["reach"]
    assert (SOURCE.splitlines()[speed.line - 1].split(":")[0].strip(), speed.kind, speed.unit) == (
        "reach",
        "fixed",
        "leg",
    )
    assert speed.words == "derived: a step"


def test_whole_literals_of_kernels_are_sizes_and_named_ones_are_not():
    source = "_MOST = 12\n\n\ndef grown(n):\n    return 3 * n + 4 + 0.3\n"
    found = walk_numbers.numbers_in(source, "plantar/kernels/made.py")
    assert [(n.kind, n.value) for n in found] == [("name", "12"), ("literal", "0.3")]


def test_the_path_follows_imports_but_those_for_types(tmp_path):
    room = tmp_path / "plantar" / "gait"
    room.mkdir(parents=True)
    (room / "__init__.py").write_text("")
    (room.parent / "errors.py").write_text("CODE = 2\n")
    (room / "tick.py").write_text(
        "from typing import TYPE_CHECKING\n\nfrom plantar.gait import law\nfrom .deep import far\n"
        "from plantar import errors\n\nif TYPE_CHECKING:\n    from plantar.gait import typed\n"
    )
    for name in ("law", "deep", "typed", "other"):
        (room / f"{name}.py").write_text("far = 0.7\n")
    found = walk_numbers.control_path(tmp_path, ["plantar.gait.tick"])
    assert set(found) == {"plantar.gait", "plantar.gait.tick", "plantar.gait.law", "plantar.gait.deep"}
    assert len(walk_numbers.numbers_on(tmp_path, ["plantar.gait.tick"])) == 2


def test_the_list_holds_settings_fixed_ones_names_literals_and_kernels(walk):
    assert {n.kind for n in walk} == {"setting", "fixed", "name", "literal"}
    paths = {n.path for n in walk}
    assert {"plantar/gait/propose/step_adjustment.py", "plantar/kernels/gait/swing_path.py"} <= paths
    assert not any(path.startswith("plantar/recordings") for path in paths)


def test_the_command_prints_the_list_and_its_counts(walk, monkeypatch, capsys):
    monkeypatch.setattr(walk_numbers, "numbers_on", lambda: walk)
    assert walk_numbers.main(["--under", "plantar/gait/propose/step_in_reach.py"]) == 0
    printed = capsys.readouterr().out
    assert "plantar/gait/propose/step_in_reach.py" in printed
    assert f"{len(walk)} numbers: " in printed
    monkeypatch.setattr(walk_numbers, "numbers_on", lambda: walk_numbers.numbers_in(SOURCE, "plantar/made.py"))
    assert walk_numbers.main(["--reason", "none", "--json"]) == 1
    assert '"name": "_PLANTED"' in capsys.readouterr().out
