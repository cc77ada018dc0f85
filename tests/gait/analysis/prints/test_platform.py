"""Footprints on a walkway, told apart and measured where they were set."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.errors import FormatError
from plantar.formats import detect_format
from plantar.formats.recorded_layouts import grid_cells
from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.gait.analysis.exports import export_analysis
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.pages.player import player_data
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.prints.platform import separated_feet
from plantar.layouts.layout import Side
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

PITCH = 0.01
STEP, WIDTH, TOE_OUT = 0.62, 0.12, 8.0
DOUBLE, STANCE = 0.12, 0.72


def shape(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Where a foot of 0.25 m touches; u from the heel, v to the medial side, both in m."""

    def disc(at: float, side: float, a: float, b: float) -> np.ndarray:
        return ((u - at) / a) ** 2 + ((v - side) / b) ** 2 <= 1.0

    inside = disc(0.04, 0.0, 0.04, 0.03) | ((u > 0.04) & (u < 0.16) & (v > -0.035) & (v < 0.0))
    return inside | disc(0.165, 0.0, 0.04, 0.045) | disc(0.232, 0.02, 0.018, 0.014)


def walkway(steps=6, first="left", reverse=False, across=False, cut=False, heading=0.0, width=WIDTH):
    """Feet that walk over a platform of cells of 1 cm, and the truth: side and heel strike of each step."""
    rows, columns = round(STEP * steps / PITCH) + 30, 150 if heading else 50
    layout = grid_cells(np.ones((rows, columns), dtype=bool), PITCH, PITCH, side="left", name="way", threshold=1e3)
    turned = (layout.positions[:, 0] + 1j * layout.positions[:, 1]) * np.exp(-1j * np.radians(heading))
    x, y = turned.real, turned.imag
    time = np.arange(0.0, 0.5 + steps * (STANCE - DOUBLE) + 1.0, 0.01)
    force = np.zeros((len(time), len(layout)))
    truth: list[tuple[Side, float]] = []
    for k in range(steps):
        side: Side = first if k % 2 == 0 else ("right" if first == "left" else "left")
        out = 1.0 if side == "left" else -1.0
        turn = np.radians(TOE_OUT) * out
        strike = (0.5 if not cut else 0.0) + k * (STANCE - DOUBLE)
        heel = np.array([0.05 + k * STEP, out * width / 2])
        u = (x - heel[0]) * np.cos(turn) + (y - heel[1]) * np.sin(turn)
        left = -(x - heel[0]) * np.sin(turn) + (y - heel[1]) * np.cos(turn)
        cells = shape(u, left * (1.0 if side == "right" else -1.0))
        phase = (time - strike) / STANCE
        for i in np.flatnonzero((phase >= 0) & (phase <= 1)):
            near = np.exp(-0.5 * ((u[cells] - 0.25 * (0.1 + 0.8 * phase[i])) / 0.07) ** 2)
            force[i, cells] += 800.0 * np.sin(np.pi * phase[i]) ** 0.5 * near / near.sum()
        truth.append((side, strike))
    if reverse:  # the same walk, seen from the other end of the platform
        force = force.reshape(len(time), rows, columns)[:, ::-1, ::-1].reshape(len(time), -1)
    if across:
        layout = grid_cells(np.ones((columns, rows), dtype=bool), PITCH, PITCH, side="left", name="way", threshold=1e3)
        force = np.rot90(force.reshape(len(time), rows, columns), axes=(1, 2)).reshape(len(time), -1)
    feet: dict[Side, FootRecording] = {"left": FootRecording("left", np.ascontiguousarray(force), layout)}
    recording = PressureRecording(Path("way"), "synthetic", 100.0, time, feet, kind="platform")
    return recording, truth


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "options",
    [
        {"steps": 4},
        {"steps": 2, "heading": 20.0},
        pytest.param({"steps": 3, "reverse": True}, marks=pytest.mark.long),
        pytest.param({"steps": 2}, marks=pytest.mark.long),
        pytest.param({"first": "right"}, marks=pytest.mark.long),
        pytest.param({"reverse": True}, marks=pytest.mark.long),
        pytest.param({"across": True}, marks=pytest.mark.long),
    ],
)
def test_a_walkway(options):
    recording, truth = walkway(**options)
    told, prints = separated_feet(recording)
    assert [(p.side, round(float(told.time[p.begin]), 1)) for p in prints] == [(s, round(t, 1)) for s, t in truth]
    feet = analyse_feet(told, prints)
    for side, gait in feet.items():
        strikes = [t for s, t in truth if s == side]
        assert len(gait.steps) == len(strikes)
        for k, (step, strike) in enumerate(zip(gait.steps, strikes, strict=True)):
            assert step.heel_strike_s == pytest.approx(strike, abs=0.011)
            assert step["foot_length_m"] == pytest.approx(0.25, abs=2 * PITCH)
            assert step["foot_progression_deg"] == pytest.approx(TOE_OUT, abs=5.0)
            # Of the first footprint the other foot stands beside the platform: no share of it may be given.
            double = 200.0 * DOUBLE / 2.0 / (STANCE - DOUBLE)
            assert np.isnan(step["double_support_percent"]) or step["double_support_percent"] == pytest.approx(
                double, 0.03
            )
            if k:
                assert step["step_length_m"] == pytest.approx(STEP, abs=PITCH)
                assert step["step_width_m"] == pytest.approx(WIDTH, abs=2 * PITCH)
            if k + 1 < len(strikes):  # a stride begins with its step, in length, time and velocity
                assert step["stride_length_m"] == pytest.approx(2 * STEP, abs=PITCH)
                assert step["stride_velocity_m_s"] == pytest.approx(STEP / (STANCE - DOUBLE), rel=0.02)
                assert step["stride_length_m"] == pytest.approx(step["stride_velocity_m_s"] * step["stride_time_s"])
            assert step.regions["heel"]["peak_force_N"] > 100.0
            assert 0.08 < step["cop_excursion_ap_m"] < 0.2
            assert step["cop_excursion_ml_m"] < 0.04
    metrics = metrics_of(told, feet)
    assert metrics["frames"] == len(recording.time)
    assert metrics["gait"]["landings"] == len(truth)


@pytest.mark.parametrize("first", ["left", "right"])
@pytest.mark.parametrize("reverse", [False, True])
def test_a_single_footprint_tells_its_side_by_its_shape(first, reverse):
    recording, _ = walkway(1, first, reverse)
    told, prints = separated_feet(recording)
    assert [p.side for p in prints] == [first]
    assert any(f"taken as the {first} one from the footprint's shape" in w for w in told.warnings)
    data = player_data(told, analyse_feet(told, prints))
    assert len(data["feet"][0]["cells"]) < 400  # not the whole platform


@pytest.mark.sample(1, each="width")
@pytest.mark.parametrize("first", ["left", "right"])
@pytest.mark.parametrize("options", [{}, {"reverse": True}, {"across": True}, {"heading": 20.0}])
@pytest.mark.parametrize(
    ("width", "doubted"), [(-0.1, True), (-0.14, True), (-0.06, False), (0.0, False), (WIDTH, False)]
)
def test_feet_that_cross_over_are_doubted(first, options, width, doubted):
    """By their places a left foot is a right one; arches and great toes contradict, or show it where places do not."""
    recording, truth = walkway(3, first, width=width, **options)
    told, prints = separated_feet(recording)
    assert ([p.side for p in prints] != [side for side, _ in truth]) == doubted
    assert any("lie as in the other foot: feet that cross over" in w for w in told.warnings) == doubted


@pytest.mark.parametrize("first", ["left", "right"])
@pytest.mark.parametrize("stated", ["left", "right"])
def test_a_stated_side_is_held_against_the_shape(first, stated):
    recording = replace(walkway(1, first)[0], metadata={"side": stated})
    told, (print_,) = separated_feet(recording)
    assert print_.side == stated
    assert any("or the wrong --side" in w for w in told.warnings) == (stated != first)


def test_a_platform_that_records_from_the_first_load_has_a_whole_step():
    recording, _ = walkway(1, cut=True)
    loaded = np.flatnonzero(recording.feet["left"].force.sum(axis=1) > 1.0)
    part = slice(loaded[0], loaded[-1] + 1)
    foot = FootRecording("left", recording.feet["left"].force[part], recording.feet["left"].layout)
    short = PressureRecording(Path("x"), "x", 100.0, recording.time[part], {"left": foot}, kind="platform")
    told, prints = separated_feet(short)
    (gait,) = analyse_feet(told, prints).values()
    assert len(gait.steps) == 1
    assert any("unloaded just before and after" in w for w in told.warnings)


@pytest.mark.parametrize("steps", [1, pytest.param(2, marks=pytest.mark.long)])
def test_a_platform_that_was_exported_is_a_platform_again(tmp_path, steps):
    recording, _ = walkway(steps)
    told, prints = separated_feet(recording)
    feet = analyse_feet(told, prints)
    export_analysis(Analysis(told, feet, metrics_of(told, feet)), tmp_path / "way.npz")
    again = analyse(tmp_path / "way.npz")
    assert again.recording.kind == "platform"
    for side, gait in feet.items():
        for one, other in zip(gait.steps, again.feet[side].steps, strict=True):
            assert other.measures == pytest.approx(one.measures, nan_ok=True)
    export_analysis(again, tmp_path / "way.csv")  # its row of names alone is longer than what files are told by
    assert (tmp_path / "way.csv").read_text().index("\n") > (50_000 if steps > 1 else 0)
    assert detect_format(tmp_path / "way.csv").name == "csv"


def test_a_table_is_told_by_a_row_of_names_that_is_longer_than_what_files_are_told_by(tmp_path):
    names = ["time (s)", *(f"left {i} (N)" for i in range(5000))]
    (tmp_path / "way.csv").write_text("\n".join([",".join(names), *3 * [",".join(["1"] * len(names))]]) + "\n")
    assert (tmp_path / "way.csv").read_text().index("\n") > 50_000
    assert detect_format(tmp_path / "way.csv").name == "csv"


def test_an_empty_platform_and_a_sole():
    recording, _ = walkway(1)
    empty = FootRecording("left", 0 * recording.feet["left"].force, recording.feet["left"].layout)
    nobody = PressureRecording(Path("x"), "x", 100.0, recording.time, {"left": empty}, kind="platform")
    told, prints = separated_feet(nobody)
    assert prints == ()
    assert analyse_feet(told, prints)["left"].steps == ()
    sole = PressureRecording(Path("x"), "x", 100.0, recording.time, {"left": empty})
    assert separated_feet(sole) == (sole, ())


def trimmed(recording, begin, end):
    """The part of a walkway between two distances in m."""
    foot = recording.feet["left"]
    along = foot.layout.positions[:, 0]
    keep = (along > along.min() + begin) & (along < along.min() + end)
    layout = grid_cells(np.ones((keep.sum() // 50, 50), dtype=bool), PITCH, PITCH, side="left", name="x", threshold=1e3)
    return replace(recording, feet={"left": FootRecording("left", foot.force[:, keep].copy(), layout)})


@pytest.mark.sample(1)
@pytest.mark.parametrize(("begin", "end", "steps"), [(0.12, 9.0, 3), (0.0, 0.05 + 3 * STEP + 0.16, 3)])
def test_a_footprint_cut_off_by_the_edge_gives_no_length(begin, end, steps):
    told, prints = separated_feet(trimmed(walkway(4)[0], begin, end))
    assert [p.cut for p in prints].count(True) == 1
    assert any("the platform's edge cuts off the" in w for w in told.warnings)
    feet = analyse_feet(told, prints)
    found = [step for gait in feet.values() for step in gait.steps]
    assert len(found) == steps
    for key, right in (("step_length_m", STEP), ("stride_length_m", 2 * STEP), ("foot_length_m", 0.25)):
        known = [step[key] for step in found if np.isfinite(step[key])]
        assert known == pytest.approx([right] * len(known), abs=PITCH)
        assert known


def test_a_single_footprint_at_the_edge_is_doubted():
    told, prints = separated_feet(trimmed(walkway(1)[0], 0.12, 9.0))
    assert not prints[0].cut
    assert any("its edge may cut them off" in w for w in told.warnings)


def passes(*shifts):
    """Passes of three steps over one walkway, one after the other, each moved by cells forward and to the side."""
    recording, _ = walkway(3)
    foot, n = recording.feet["left"], len(recording.time)
    force = foot.force.reshape(n, -1, 50)
    moved = [np.roll(force, (-ahead, side), axis=(1, 2)).reshape(n, -1) for ahead, side in shifts]
    feet: dict[Side, FootRecording] = {"left": FootRecording("left", np.concatenate(moved), foot.layout)}
    return replace(recording, feet=feet, time=0.01 * np.arange(n * len(shifts)))


def test_passes_over_the_same_cells_are_walks_of_their_own():
    told, prints = separated_feet(passes((0, 0), (20, 6), (40, 12), (30, 10)))
    feet = analyse_feet(told, prints)
    assert {side: len(gait.steps) for side, gait in feet.items()} == {"left": 8, "right": 4}
    for step in (step for gait in feet.values() for step in gait.steps):
        assert step["foot_length_m"] == pytest.approx(0.25, abs=PITCH)
        for key, right in (("step_length_m", STEP), ("stride_time_s", 2 * (STANCE - DOUBLE))):
            assert np.isnan(step[key]) or step[key] == pytest.approx(right, abs=PITCH)


@pytest.mark.parametrize(("apart", "text"), [((20, 0), "a footprint of 0.39 m"), ((0, 24), "three footprints at once")])
def test_two_people_at_once_are_no_one(apart, text):
    one, two = passes((0, 0), (0, 0)), passes(apart, apart)
    force = one.feet["left"].force.copy()
    half = len(force) // 2
    force[half:] += two.feet["left"].force[half:]
    both = replace(one, feet={"left": replace(one.feet["left"], force=force)})
    told, prints = separated_feet(both)
    assert len(prints) == 3
    assert any(text in w and "The pass over the platform at 3.8 s is left out" in w for w in told.warnings)
    late = replace(both, feet={"left": replace(one.feet["left"], force=force[half:])}, time=both.time[half:])
    with pytest.raises(FormatError, match="one person, whose footprints lie apart"):
        separated_feet(late)
