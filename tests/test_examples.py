"""Every example runs, says what it is about in its first line, and finds what it claims."""

import ast
import re
import runpy
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from plantar.robots.controller import load_controller
from tests.unitree_stub import StubRobot, stub_modules, typed

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
PICTURES = ("gallery", "walk_picture", "beam_picture")
"""Scripts that draw the documents' pictures; they are longer."""


class Example(NamedTuple):
    """What an example is run with, what it has to print, and what else must hold of the numbers in that."""

    pattern: str
    arguments: tuple[str, ...] = ()
    holds: Callable[..., bool] = lambda *_: True


QUICK = {
    "sole_hexagons": Example(r"left: (\d+) taxels.*right: (\d+) taxels", holds=lambda left, right: left == right > 50),
    "sole_squares": Example(
        r"squares: 44 .* on (\d+) %.*whole squares: .* on (\d+) %.*oblong cells: .* on (\d+) %",
        holds=lambda cut, whole, oblong: whole < cut < oblong < 100,
    ),
    "sole_insole": Example(r"7 sensors carry (\d+) N", holds=lambda load: load == 650),
    "sole_other_cells": Example(
        r"fsr_402_short: (\d+) .* carry (\S+) N.*velostat: (\d+) .* carry (\S+) N.*fx29_100: (\d+) .* carry (\S+) N",
        holds=lambda films, a, many, b, few, c: few == 4 < films < many and min(a, b, c) > 245.0,
    ),
    "sole_curved": Example(
        r"flat: .* force \+(\S+) N forward.*rocker: heel and toe (\d+) mm up, force \+(\S+) N",
        holds=lambda flat, lift, rocker: flat == 0 and lift > 15 and rocker > 30,
    ),
    "skin_any_model": Example(
        r"taxels \[\s*\S+\s+\S+\s+(\S+)\s*\] N, contacts \[\s*\S+\s+\S+\s+(\S+)\s*\] N.*taxels: True",
        holds=lambda taxels, contacts: taxels == contacts > 90,
    ),
    "percept_one_foot": Example(r"that is (\d+) % of the sole", holds=lambda share: 20 < share < 30),
    "percept_two_feet": Example(r"margin of the ZMP: (\d+) mm", holds=lambda margin: margin > 50),
    "percept_before_contact": Example(
        r"10 mm: (\d+) taxels.*50 mm: (\d+) taxels.* (\S+) degrees forward",
        holds=lambda few, many, slope: few < many and abs(slope + 8.0) < 0.1,
    ),
    "percept_rectangles": Example(
        r"cells (\S+) cm.*inside, along the sole: (\S+) cm.*inside, at any angle: (\S+) cm.*, along the sole: (\S+)",
        holds=lambda cells, along, any_angle, outlined: outlined <= min(along, cells) and along < any_angle,
    ),
    "sole_at_an_instant": Example(
        r"left: .*convex polygon (\S+) cm2, concave polygon (\S+) cm2.*wrote sole_left.png",
        holds=lambda convex, concave: float(convex) >= float(concave) > 50,
    ),
    "percept_faults": Example(
        r"1 dead, 0 saturated, 1 stuck.*true load (\d+) N: (\d+) N .*, (\d+) N",
        holds=lambda true, left_out, filled: left_out < 0.98 * true and abs(filled - true) < 0.005 * true,
    ),
    "percept_stream": Example(
        r"stuck: \[5\].*polygon of (\d+) cm.*contact: (\d+) by a threshold, (\d+) with hysteresis",
        holds=lambda area, bare, kept: 100 < area < 240 and kept < bare / 5,
    ),
    "calibrate_a_sole": Example(
        r"gains within (\S+) %.*worst gain (\S+) % off", holds=lambda sure, worst: worst < 2 * sure
    ),
    "live_page": Example(
        r"open http://127.0.0.1:\d+/ .*3.0 s recorded, (\d+) readings.*Cadence: (\d+) steps/min",
        holds=lambda readings, cadence: readings == 300 and abs(cadence - 109) < 2,
    ),
    "percept_temperature": Example(r"push with (\d+) N", holds=lambda force: force == 14 * 13),
    "percept_a_million": Example(r"as a percept says it: True", ("20000",)),
    "record_larger_than_memory": Example(
        r"([\d.]+) MB on disk, ([\d.]+) MB at a time", ("50000",), lambda disk, held: held < 0.1 * disk
    ),
    "record_any_size": Example(
        r"40 steps of 2 people.*ST presses ([\d.]+) kPa, BF ([\d.]+)", holds=lambda shoe, bare: shoe < 0.8 * bare
    ),
    "record_own_sensor": Example(
        r"mcap: 1000 frames at 100 Hz.*right: at most (\d+) N", holds=lambda load: load == 700
    ),
    "record_formats": Example(r"pedar.*2 feet, 50 Hz, peak (\d+) N.*table.*peak (\d+) N", holds=lambda a, b: a == b),
    "record_makers": Example(
        r"emed: .* peak (\d+) N.*tekscan: 736 .* peak (\d+) N.*footscan: .* peak (\d+) N.*xsensor: 736 .* peak (\d+) N"
        r".*moticon: 16 ",
        holds=lambda emed, *spacing: emed == 693 and spacing == (715, 739, 715),  # 616 cells of 45 kPa, by their areas
    ),
    "record_own_metric": Example(r"left: (\d+) steps, forefoot loaded (\S+) ", holds=lambda n, t: n == 13 and t > 0.2),
    "shoe_from_any_foot": Example(
        r"a box: .* (\d+) whole.*an ellipse: .* (\d+) whole.*h1: .* (\d+) whole", holds=lambda *n: min(n) > 20
    ),
    "shoe_wired": Example(
        r"floating: .* reads (\S+) %.*solved: .* reads (\S+) %.*taxel (\d+) rose by (\d+) counts, the next by (\d+)",
        holds=lambda ghost, left, taxel, most, next_: ghost > 5 > left and taxel == 20 and most > 100 * next_,
    ),
    "shoe_in_cadquery": Example(
        r"(\S+) cm\^3, valid: True, the hole takes (\d+) mm", holds=lambda volume, taken: volume > 50 and taken > 10
    ),
    "shoe_from_files": Example(
        r"svg: .* (\d+) cm.*dxf: .* (\d+) cm.*geojson: .* (\d+) cm.*robot.xml: .* (\d+) cm",
        holds=lambda *area: area == (176, 176, 176, 176),
    ),
    "own_policy": Example(r"FootholdResult\(completed=False, steps=0, planned=8"),
    "walk_own_computer": Example(r"walked (\S+) m and stands", holds=lambda way: 0.4 < way < 0.65),
    "walk_by_keyboard": Example(
        r"at (\S+) (\S+) m, (\S+) m high; walks", holds=lambda x, y, height: 0.0 < x < 0.6 and height > 0.7
    ),
    "walk_own_loop": Example(
        r"walked (\S+) m; the controller thinks (\S+) m",
        holds=lambda true, found: true > 0.55 and abs(true - found) < 0.03,
    ),
}

LONG = {
    "walk_by_torque": Example(r"servo: took 4 of 4 steps.*torque: took 4 of 4 steps"),
    "walk_push": Example(r"feedback=true: took 4 of 4.*feedback=false: fell"),
    "walk_guided": Example(
        r"yields gave way by (\d+) mm under at most (\d+) N, and the feet followed by (\d+) mm in 8 steps"
        r".*stiff arm gave way by (\d+) mm under at most (\d+) N",
        holds=lambda soft, least, way, stiff, most: stiff < 20 < soft and least < most and 100 < way < 220,
    ),
    "walk_own_proposer": Example(
        r"without it: steps at 0.20, 0.40, 0.60.*completed: True.*with it: steps at 0.20, 0.40, 0.64.*completed: True"
    ),
    "walk_own_terrain": Example(r"pfc=true: completed, 6 steps.*pfc=false: .*fall"),
    "walk_own_gains": Example(
        r"dcm_gain 0: .*dcm_gain 3: completed 3 of 3.*dcm_gain 8: .*gains differ by \S+ degrees, seeds by \S+: \w+"
    ),
    "walk_sweep": Example(r"'false'}: (\d) of 2 completed.*'true'}: 2 of 2.*finds 4 of its 4", holds=lambda n: n == 0),
}

ELSEWHERE = {
    "insole_walk",  # test_readme.py
    "live_stream",  # below, in a process of its own
    "introduce_robot",  # sim/survey/test_introduce.py
    "other_plant",  # test_plant_example.py
    "record_to_tables",  # below, on the recording of another one
    "skin_any_arm",  # test_skin_examples.py
    "skin_arm",
    "skin_new_task",
    "walk_unitree",  # below, against a stub of its SDK
    "gallery",  # test_gallery.py
    "walk_picture",  # draws a run of a minute
}


def numbers_in(pattern: str, text: str) -> list[float]:
    """The numbers that a pattern finds in a text."""
    found = re.search(pattern, text, re.DOTALL)
    assert found, text
    return [float(number.rstrip(".,")) for number in found.groups()]


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", QUICK)
def test_an_example_finds_what_it_says(name, monkeypatch, capsys):
    example = QUICK[name]
    monkeypatch.setattr(sys, "argv", [f"{name}.py", *example.arguments])
    runpy.run_path(str(ROOT / "examples" / f"{name}.py"), run_name="__main__")
    assert example.holds(*numbers_in(example.pattern, capsys.readouterr().out))


@pytest.mark.long
@pytest.mark.parametrize("name", LONG)
def test_a_simulated_example_finds_what_it_says(name):
    command = [sys.executable, "-W", "error", f"examples/{name}.py", *LONG[name].arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert LONG[name].holds(*numbers_in(LONG[name].pattern, done.stdout))


def test_a_stream_with_rubbish_goes_on():
    command = [sys.executable, "-W", "error", "examples/live_stream.py"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert re.search(r"left \d\.\d\d s: \d+ N, CoP .*\{'garbled': \d+", done.stdout, re.DOTALL), done.stdout


def test_a_recording_becomes_tables(tmp_path, monkeypatch, capsys):
    for name, arguments in (
        ("record_own_sensor", (tmp_path / "run.mcap",)),
        ("record_to_tables", (tmp_path / "run.mcap", tmp_path / "out")),
    ):
        monkeypatch.setattr(sys, "argv", [f"{name}.py", *map(str, arguments)])
        runpy.run_path(str(ROOT / "examples" / f"{name}.py"), run_name="__main__")
    assert "/skin/left: 1000 rows of force (42)" in capsys.readouterr().out
    assert {"run.npz", "motors.csv"} <= {p.name for p in (tmp_path / "out").iterdir()}


@pytest.mark.long
def test_a_bridge_walks_by_the_messages_of_the_sdk(monkeypatch):
    robot = StubRobot(until=16.0)
    stance = load_controller("h1", commanded=True)
    robot.stand(stance.base_position, stance.stance.angles)
    for name, module in stub_modules(robot).items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.setattr(sys, "argv", ["walk_unitree.py", "h1", "eth0"])
    monkeypatch.setattr(sys, "stdin", typed(robot, {10.0: "0.2 0 0", 13.0: ""}))
    bridge = runpy.run_path(str(ROOT / "examples" / "walk_unitree.py"), run_name="__main__")
    assert robot.ended
    assert bridge["walker"].state is None, bridge["walker"].findings
    assert min(robot.heights) > 0.9 * robot.heights[0]
    assert robot.data.qpos[0] > 0.2


def test_every_example_is_run_by_a_test():
    assert {e.stem for e in EXAMPLES} == {*QUICK, *LONG, *ELSEWHERE}


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda e: e.stem)
def test_an_example_is_one_idea_in_60_lines_and_says_how_it_is_run(example):
    source = example.read_text(encoding="utf-8")
    told = ast.get_docstring(ast.parse(source))
    assert told is not None
    assert f"python examples/{example.name}" in told
    assert len(source.splitlines()) <= (300 if example.stem in PICTURES else 60)


def test_the_page_of_examples_names_each():
    page = (ROOT / "examples" / "README.md").read_text(encoding="utf-8")
    assert set(re.findall(r"\((\w+)\.py\)", page)) == {e.stem for e in EXAMPLES}


def test_the_page_that_compares_counts_them():
    page = (ROOT / "docs" / "compare.md").read_text(encoding="utf-8")
    assert f" {len(EXAMPLES)}, one idea each, and four notebooks" in page


def test_the_made_walk_of_the_readme_needs_no_folder(tmp_path):
    command = [sys.executable, str(ROOT / "examples" / "insole_walk.py"), "out/insole.asc"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=600)
    assert (tmp_path / "out" / "insole.asc").stat().st_size > 0


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ["insole_walk", "introduce_robot", "record_to_tables", "gallery"])
def test_an_example_without_the_file_that_it_needs_says_what_to_give(name, tmp_path):
    command = [sys.executable, str(ROOT / "examples" / f"{name}.py")]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode != 0
    assert done.stderr.count("\n") == 1, done.stderr
    assert "give " in done.stderr or "usage" in done.stderr.lower()
