"""Columns by a stated map, and the map that a refusal prints."""

import re

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats.column_map import column_map, mapped_columns
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import analyse

from .test_table_kinds import AHEAD, LEFT, LEFTWARD, RIGHT, TIME, check, rows


def printed(path) -> str:
    """The map that the refusal of a file prints."""
    with pytest.raises(FormatError) as refused:
        analyse(path)
    assert "\n" not in str(refused.value)
    match = re.search(r'--columns "([^"]+)"', str(refused.value))
    assert match is not None
    return match[1]


def test_a_map_names_the_columns_of_two_feet(tmp_path):
    path = tmp_path / "walk.csv"
    path.write_text("when,alpha,beta\n" + rows([TIME, LEFT, RIGHT], ","))
    check(analyse(path, columns="left=alpha, right=beta, time=when"))
    check(analyse(path, columns={"left": "alpha", "right": "3", "time [s]": 1}))


def test_the_printed_map_of_a_plate_without_names_mends_it(tmp_path):
    path = tmp_path / "plate.txt"
    moments = [0.1 * AHEAD["right"], -0.2 * AHEAD["right"], 0.01 * AHEAD["right"]]
    path.write_text(rows([TIME, AHEAD["right"], LEFTWARD["right"], RIGHT, *moments]))
    columns = printed(path)
    assert columns == "time=1, Fx=2, Fy=3, Fz=4, Mx=5, My=6, Mz=7"
    check(analyse(path, options=ReadOptions(columns=columns, side="right")), ["right"])


def test_the_printed_map_of_cells_of_an_unknown_word_mends_it(tmp_path):
    path = tmp_path / "cells.csv"
    names = ",".join(f"zone{i}" for i in range(1, 9))
    path.write_text(f"time,{names}\n" + rows([TIME, *[LEFT / 4.0] * 4, *[RIGHT / 4.0] * 4], ","))
    columns = printed(path)
    assert columns == "time=time, left=zone1..zone4, right=zone5..zone8"
    check(analyse(path, columns=columns, unit="N"))


def test_a_map_of_a_data_frame():
    frame = {"t": TIME, "Fz1": LEFT, "Fz2": RIGHT}

    class Frame:
        def __init__(self):
            self.columns = list(frame)

        def __getitem__(self, name):
            return frame[name]

    check(analyse(Frame(), columns={"time": "t", "right": "Fz2", "left": "Fz1"}, unit="N"))


def test_names_that_are_not_single_are_taken_by_their_numbers():
    names = ["t", "F", "F", "a, b"]
    assert mapped_columns(column_map("time=t, left=2, right=3"), names, 4) == {
        0: "time",
        1: "left force",
        2: "right force",
    }
    assert mapped_columns(column_map("left=2..4"), names, 4) == {1: "left 1", 2: "left 2", 3: "left 3"}
    with pytest.raises(InputError, match="2 columns are called 'F'; allowed: their numbers"):
        mapped_columns(column_map("left=F"), names, 4)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "--columns is ''"),
        ("left", "--columns is 'left'"),
        ("left=", "--columns is 'left='"),
        ("left=a, left=b", "gives a name twice"),
        ("knee angle=a", "'knee angle', which is no load"),
        ("left=c", "'c', which is no column; the table's are 'a', 'b'"),
        ("left=3", "'3', which is no column"),
        ("left=a, right=a", "takes column a twice"),
        ("left=b..a", "b comes after a; allowed: a range from left to right, a..b"),
        (f"left={'1' * 5000}", "is no column"),
        ("left=a..b..a", "'b..a', which is no column"),
        ("time=a..b", "gives 'time' 2 columns"),
    ],
)
def test_a_map_that_cannot_be_is_refused(text, words):
    with pytest.raises(InputError, match=re.escape(words)):
        mapped_columns(column_map(text), ["a", "b"], 2)


def test_a_map_is_for_tables(tmp_path):
    np.save(tmp_path / "walk.npy", np.ones((50, 4)))
    with pytest.raises(InputError, match="--columns is for tables"):
        analyse(tmp_path / "walk.npy", columns="left=1")


def test_the_printed_map_of_a_force_without_a_name_mends_it(tmp_path):
    path = tmp_path / "plate.csv"
    path.write_text(rows([TIME, RIGHT], ","))
    columns = printed(path)
    assert columns == "time=1, Fz=2"
    check(analyse(path, options=ReadOptions(columns=columns, side="right")), ["right"])
    path.write_text("".join(f"{force:.2f}\n" for force in RIGHT))
    columns = printed(path)
    assert columns == "Fz=1"
    check(analyse(path, options=ReadOptions(columns=columns, side="right", rate_hz=100.0)), ["right"])


def test_nameless_columns_that_may_be_anything_are_not_filled_in(tmp_path):
    path = tmp_path / "table.csv"
    turns = np.sin(TIME[:, None] + np.arange(8.0))
    serial = np.full(len(TIME), 40213.0)
    curves = [LEFT + 0.01 * i for i in range(320)]
    for columns in (turns.T, [serial, LEFT, RIGHT], curves):
        path.write_text(rows(list(columns), ","))
        assert printed(path) == "left=FIRST..LAST, right=FIRST..LAST"


def test_whole_numbers_between_commas_may_be_one_column(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("".join(f"{round(force)},{i % 10}\n" for i, force in enumerate(RIGHT)))
    with pytest.raises(FormatError, match="one with a decimal comma; allowed"):
        analyse(path)


def test_a_named_load_beside_one_foots_name_is_asked_for(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("time,force,corrected,right\n" + rows([TIME, RIGHT, 0.0 * RIGHT, 0.5 * RIGHT], ","))
    columns = printed(path)
    assert columns == "right=force"
    check(analyse(path, columns="time=time, right=force"), ["right"])


@pytest.mark.parametrize(
    ("names", "columns", "wanted"),
    [
        ("time[secs],force[N],pressure[kPa],area[cm2],force[N],pressure[kPa],area[cm2]", "LpaRpa", "left=2, right=5"),
        ("Time [s],Z Left,Z Right", "LR", "left=Z Left, right=Z Right"),
        ("Time [s],links innen (N),rechts innen (N)", "LR", "left=links innen (N), right=rechts innen (N)"),
    ],
)
def test_the_printed_map_of_two_forces_mends_it(tmp_path, names, columns, wanted):
    """A novel .fgt, whose names begin again; a jump plate's vertical axes; an unknown word with a unit of force."""
    held = {"L": LEFT, "R": RIGHT, "p": 0.2 * LEFT, "a": 0.01 * LEFT}
    path = tmp_path / "walk.csv"
    path.write_text(names + "\n" + rows([TIME, *(held[c] for c in columns)], ","))
    assert printed(path).endswith(wanted)
    walk = analyse(path, columns=printed(path))
    check(walk)
    assert not any("times state no unit" in w for w in walk.recording.warnings)  # the map keeps the clock's unit


def test_mean_pressures_and_areas_beside_a_foots_force_are_no_cells(tmp_path):
    path = tmp_path / "walk.csv"
    names = [f"{side} {what}" for side in ("left", "right") for what in ("force[N]", "pressure[kPa]", "area[cm2]")]
    columns = [TIME, LEFT, 0.2 * LEFT, 0.01 * LEFT, RIGHT, 0.2 * RIGHT, 0.01 * RIGHT]
    path.write_text(",".join(["time[secs]", *names]) + "\n" + rows(columns, ","))
    check(analyse(path))


def test_measures_of_steps_are_refused_as_such(tmp_path):
    path = tmp_path / "steps.csv"
    steps = np.arange(12.0)
    path.write_text("Record #,Foot,Step Length,Stride Length,Step Time\n")
    path.write_text(
        path.read_text() + rows([steps + 1, steps % 2, 60 + 0 * steps, 120 + 0 * steps, 0.5 + 0 * steps], ",")
    )
    with pytest.raises(FormatError, match="each row is a step, as 'Step Length' and 'Stride Length' show"):
        analyse(path)


def test_places_of_a_plate_are_its_center_of_pressure_where_in_metres(tmp_path):
    """BioWare's Ax and Ay; of an inertial sensor they are accelerations."""
    path = tmp_path / "plate.txt"
    place = [0.3 + 0.2 * np.clip(TIME % 1.0, 0.0, 1.0), 0.1 + 0.0 * TIME]
    path.write_text("Time [s]\tFx [N]\tFy [N]\tFz [N]\tAx [m]\tAy [m]\n" + rows([TIME, *[0 * TIME] * 2, RIGHT, *place]))
    walk = analyse(path, options=ReadOptions(side="right"))
    assert np.nanmax(walk.feet["right"].cop[:, 0]) == pytest.approx(0.5, abs=0.02)


def test_the_printed_map_of_names_that_begin_again_for_each_plate_mends_it(tmp_path):
    """BioWare's text of two plates: each has the same names."""
    path = tmp_path / "plates.txt"
    names = ["abs time (s)", *2 * ["Fx", "Fy", "Fz", "|Ft|", "Ax", "Ay"]]
    units = ["s", *2 * ["N", "N", "N", "N", "m", "m"]]
    of_feet = {"left": LEFT, "right": RIGHT}
    columns = [c for s, f in of_feet.items() for c in (0 * f, AHEAD[s], f, f, 0.1 + 0 * f, 0.2 + 0.1 * (TIME % 1.0))]
    path.write_text("BioWare\n" + "\n".join(map("\t".join, (names, units))) + "\n" + rows([TIME, *columns]))
    walk = analyse(path, options=ReadOptions(columns=printed(path), plates=("left", "right")))
    check(walk)
    assert np.nanmax(walk.feet["left"].cop[:, 0]) == pytest.approx(0.1, abs=0.02)
