"""Treadmills of a few strides, by the steady backward motion of the centre of pressure."""

import re

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import analyse

from .test_table_kinds import AHEAD, GONE_LEFT, GONE_RIGHT, LEFT, RIGHT, TIME, rows

PREFIXES = [("", "l_"), ("R_", "L_"), ("r_", ""), ("1_", "2_"), ("", "1_")]


def walk(path, prefixes, speed, strides=2, pushes=True, order=(0, 1)):
    """OpenSim's table of a right and a left belt (z to the right) with a few strides at a speed in m/s."""
    part = (TIME > 1.1) & (1.1 * strides + 0.9 > TIME - 1.1)
    names, columns = ["time"], [TIME[part]]
    feet = [(RIGHT, GONE_RIGHT, AHEAD["right"], 0.1), (LEFT, GONE_LEFT, AHEAD["left"], -0.1)]
    for prefix, k in zip(prefixes, order, strict=True):
        force, gone, ahead, z = feet[k]
        place = np.where(force > 0.0, 0.4 + (0.22 - speed * 0.682) * gone, 0.0)
        names += [f"{prefix}ground_force_{c}" for c in ("vx", "vy", "vz", "px", "py", "pz")]
        none = np.zeros_like(TIME)
        three = [ahead if pushes else none, force, none, place, none, np.where(force > 0.0, z, 0.0)]
        columns += [c[part] for c in three]
    head = f"walk.mot\nversion=1\nnRows={part.sum()}\nnColumns={len(columns)}\ninDegrees=yes\nendheader\n"
    path.write_text(head + "\t".join(names) + "\n" + rows(columns))
    begins = {}
    for side, force in (("left", LEFT), ("right", RIGHT)):
        on = np.diff((force[part] > 0.0).astype(int))
        begins[side] = TIME[part][np.flatnonzero(on == 1)]
    return begins


@pytest.mark.sample(10)
@pytest.mark.parametrize("prefixes", PREFIXES)
@pytest.mark.parametrize(("speed", "pushes"), [(0.5, True), (1.2, True), (1.2, False), (1.8, False)])
@pytest.mark.parametrize("strides", [1, 3])
def test_belts_of_a_few_strides(tmp_path, prefixes, speed, pushes, strides):
    path = tmp_path / "walk.mot"
    begins = walk(path, prefixes, speed, strides, pushes)
    found = analyse(path)
    for side in ("left", "right"):
        strikes = [s.heel_strike_s for s in found.feet[side].steps]
        assert len(strikes) >= strides
        for strike in strikes:
            assert np.abs(begins[side] - strike).min() < 0.02
    (told,) = [w for w in found.warnings if "these are belts" in w]
    stated = re.search(r"run at about ([\d.]+) m/s", told)
    assert stated is not None
    assert float(stated[1]) == pytest.approx(speed, abs=0.05)


def test_names_win_over_places(tmp_path):
    path = tmp_path / "walk.mot"
    walk(path, ("l_", "r_"), 1.2)
    left = analyse(path).feet["left"].steps[0].heel_strike_s
    walk(path, ("r_", "l_"), 1.2)
    assert left == analyse(path).feet["right"].steps[0].heel_strike_s


def test_stated_plates_win_over_names(tmp_path):
    path = tmp_path / "walk.mot"
    walk(path, ("r_", "l_"), 1.2)
    named = analyse(path).feet["right"].steps[0].heel_strike_s
    stated = analyse(path, options=ReadOptions(plates=("left", "right")))
    assert stated.feet["left"].steps[0].heel_strike_s == named


@pytest.mark.parametrize("speed", [0.6, 1.2])
def test_one_belt_alone_is_of_one_foot(tmp_path, speed):
    path = tmp_path / "walk.mot"
    begins = walk(path, ("r_",), speed, strides=3, order=(0,))
    found = analyse(path, options=ReadOptions(side="right"))
    assert any("these are belts" in w for w in found.warnings)
    strikes = [s.heel_strike_s for s in found.feet["right"].steps]
    assert len(strikes) == 3
    assert all(np.abs(begins["right"] - strike).min() < 0.02 for strike in strikes)


def test_plates_in_a_walkway_are_no_belts(tmp_path):
    """A foot that is set down rolls forwards."""
    path = tmp_path / "walk.mot"
    walk(path, ("1_", "2_"), 0.0)
    assert not any("belts" in w for w in analyse(path).warnings)


@pytest.mark.parametrize(("contact", "flight"), [(0.24, 0.12), (0.28, 0.08), (0.30, 0.03)])
@pytest.mark.parametrize("drift", [0.0, 80.0])
def test_a_run_of_both_feet_on_one_belt_is_refused(tmp_path, contact, flight, drift):
    path = tmp_path / "run.csv"
    time = np.arange(0.0, 12.0, 0.002)
    gone = np.mod(time, contact + flight) / contact
    force = np.where(gone < 1.0, 1700.0 * np.sin(np.pi * np.minimum(gone, 1.0)), 0.0) + drift * time / time[-1]
    path.write_text("time [s]\tFz [N]\n" + rows([time, force]))
    with pytest.raises(FormatError, match=r"the flight of a run and no foot's swing.*allowed: a plate for each foot"):
        analyse(path)


def test_contacts_nearer_than_a_swing_are_doubted(tmp_path):
    path = tmp_path / "run.csv"
    time = np.arange(0.0, 12.0, 0.002)
    for flight, told in ((0.2, 1), (0.5, 0)):
        force = 1700.0 * np.clip(np.sin(np.pi * np.mod(time, 0.2 + flight) / 0.2), 0.0, None)
        force[np.mod(time, 0.2 + flight) > 0.2] = 0.0
        path.write_text("time [s]\tFz [N]\n" + rows([time, force]))
        assert sum("where both feet run on it" in w for w in analyse(path).warnings) == told
