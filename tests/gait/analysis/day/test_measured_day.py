"""A made morning whose bouts, steps and loads are chosen."""

import csv
import json
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import InputError
from plantar.cli import app
from plantar.formats.nominal_insole import moticon_insole
from plantar.gait.analysis.day.bouts import Bout
from plantar.gait.analysis.day.day_page import day_page, write_day
from plantar.gait.analysis.day.measured_day import clock_of, measure_day
from plantar.gait.analysis.masks import SEVEN_MASKS
from plantar.layouts.layout_file import layout_to_dict
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

from ..walks import two_humps

RATE = 50.0
WEIGHT = 700.0
STRIDE = 1.1
PLAN = (("sit", 120.0), ("walk", 88.0), ("stand", 200.0), ("walk", 44.0), ("gap", 60.0), ("sit", 150.0), ("walk", 22.0))


def made_morning() -> tuple[PressureRecording, list[tuple[str, float, float]]]:
    layouts = {side: moticon_insole(7, side) for side in ("left", "right")}
    along = layouts["left"].positions[:, 0] / layouts["left"].outline[:, 0].max()

    def shares(place: float) -> np.ndarray:
        near = np.exp(-(((along - place) / 0.25) ** 2)) * layouts["left"].areas
        return near / near.sum()

    n = round(STRIDE * RATE)
    share = np.arange(n) / n / 0.62
    stride = np.stack(
        [WEIGHT * f * shares(0.15 + 0.7 * min(1.0, s)) for s, f in zip(share, two_humps(share), strict=True)]
    )
    parts: dict[str, list[np.ndarray]] = {"left": [], "right": []}
    truth = []
    at = 0
    for kind, lasts in PLAN:
        frames = round(lasts * RATE)
        if kind == "walk":
            count = frames // n
            whole = np.tile(stride, (count, 1))
            half = np.zeros((n // 2, 16))
            parts["left"].append(np.concatenate([whole, half]))
            parts["right"].append(np.concatenate([half, whole]))
            frames = len(whole) + len(half)
        else:
            level = {"sit": 0.1, "stand": 0.5, "gap": np.nan}[kind] * WEIGHT
            for own in parts.values():
                own.append(np.tile(level * shares(0.45), (frames, 1)))
        truth.append((kind, at / RATE, (at + frames) / RATE))
        at += frames
    force = {side: np.concatenate(own) + 0.1 for side, own in parts.items()}  # an offset
    feet = {side: FootRecording(side, force[side], layouts[side]) for side in ("left", "right")}
    return PressureRecording(Path("morning.npz"), "made", RATE, np.arange(at) / RATE, feet), truth


@pytest.fixture(scope="module")
def morning():
    recording, truth = made_morning()
    return recording, truth, measure_day(recording, clock=datetime(2026, 3, 2, 8, 50))


def test_bouts_are_those_that_were_made(morning):
    _, truth, day = morning
    names = {"walk": "walking", "stand": "standing", "sit": "sitting", "gap": "gap"}
    assert [b.activity for b in day.bouts] == [names[kind] for kind, *_ in truth]
    for bout, (_, begin, end) in zip(day.bouts, truth, strict=True):
        assert bout.begin == pytest.approx(begin, abs=1.2)
        assert bout.end == pytest.approx(end, abs=1.2)


def test_steps_and_cadence_are_those_that_were_made(morning):
    _, truth, day = morning
    made = [2 * int((end - begin) * RATE / round(STRIDE * RATE)) for kind, begin, end in truth if kind == "walk"]
    walks = [b for b in day.bouts if b.activity == "walking"]
    assert [b.steps for b in walks] == pytest.approx(made, abs=1)
    assert all(b.cadence == pytest.approx(120.0 / STRIDE, rel=0.01) for b in walks)
    assert day.cadence_1 == pytest.approx(120.0 / STRIDE, abs=2.0)
    assert day.steps == sum(hour.steps for hour in day.hours)
    assert day.weight_N == pytest.approx(WEIGHT, rel=0.03)


def test_load_an_hour_is_the_force_over_time_without_the_offset(morning):
    recording, _, day = morning
    assert [hour.clock for hour in day.hours] == ["08:50", "09:00"]
    assert sum(hour.seconds["gap"] for hour in day.hours) == pytest.approx(60.0, abs=1.0)
    for side, foot in recording.feet.items():
        true = np.nansum(foot.vertical_force - 1.6) / RATE
        assert sum(hour.impulse_Ns[side] for hour in day.hours) == pytest.approx(true, rel=1e-3)
        pressure = np.nan_to_num(foot.force) / foot.layout.areas
        most = pressure.max(axis=1).sum() / RATE
        regions = {name: sum(h.pressure_Pas[side][name] for h in day.hours) for name, _ in SEVEN_MASKS.names}
        assert max(regions.values()) <= most <= sum(regions.values())


def test_one_foot_counts_its_steps_twice(morning):
    recording, _, day = morning
    left = PressureRecording(recording.path, "made", RATE, recording.time, {"left": recording.feet["left"]})
    alone = measure_day(left)
    assert alone.steps == pytest.approx(day.steps, abs=6)  # a step of each walk begins under load
    assert any("one foot was measured" in note for note in alone.notes)
    assert alone.hours[0].clock == "0 h"


def test_the_page_and_tables_hold_the_day(morning, tmp_path):
    _, _, day = morning
    files = [Path(f).name for f in write_day(day, SEVEN_MASKS, tmp_path, "A morning <b>")]
    assert files == ["bouts.csv", "day.html", "day.json", "day.png", "day.svg", "hours.csv"]
    page = (tmp_path / "day.html").read_text()
    assert f"{day.steps} steps" in page
    assert "A morning &lt;b&gt;" in page
    with (tmp_path / "bouts.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert [row["activity"] for row in rows] == [b.activity for b in day.bouts]
    assert rows[1]["clock"].startswith("08:52:0")
    assert day_page(day, SEVEN_MASKS, [], "x").count("<table") == 3
    assert json.loads((tmp_path / "day.json").read_text())["seconds"]["walking"] == day.seconds("walking")


def test_the_command_measures_a_file(morning, tmp_path):
    recording, _, day = morning
    file = tmp_path / "day.npz"
    held = {f"layout_{side}": json.dumps(layout_to_dict(foot.layout)) for side, foot in recording.feet.items()}
    held |= {side: foot.force.astype(np.float32) for side, foot in recording.feet.items()}
    np.savez(file, rate_hz=RATE, unit="N", **held)
    command = ["analyze", str(file), "--day", "--clock", "08:50", "--json", "-o", str(tmp_path / "out")]
    found = CliRunner().invoke(app, command)
    assert found.exit_code == 0, found.output
    assert json.loads(found.stdout)["steps"] == pytest.approx(day.steps, abs=3)
    refused = CliRunner().invoke(app, ["analyze", str(file), "--clock", "08:50"])
    assert "--day measures one recording" in str(refused.exception)


def test_what_is_no_day_is_refused(morning):
    recording, *_ = morning
    short = PressureRecording(
        recording.path,
        "made",
        RATE,
        recording.time[:1000],
        {s: FootRecording(s, f.force[:1000], f.layout) for s, f in recording.feet.items()},
    )
    with pytest.raises(InputError, match=r"10 minutes or more; the recording lasts 0\.333"):
        measure_day(short)
    with pytest.raises(InputError, match="allowed: 08:30"):
        clock_of("half past eight")
    assert Bout("walking", 1.0, 3.0).lasts == 2.0
