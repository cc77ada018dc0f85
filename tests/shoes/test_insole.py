"""Tests of insoles: planned to the thickness asked for, printable, and read again by `plantar analyze`."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from plantar import Percept, Reading, read_layout
from plantar.errors import FootError, InputError
from plantar.gait.analysis.analyse import analyse, with_layout
from plantar.shoes import ShoeParameters, export_shoe
from plantar.shoes.foot.foot import Foot, foot_from_dimensions
from plantar.shoes.insole import build_insole
from plantar.shoes.parameters import read_parameters

from .foot_family import prism
from .shoe_witness import Witness

PERSON = foot_from_dimensions("person", length=0.255, width=0.095, corner_radius=0.035)


@pytest.mark.parametrize("thickness", [4.0, 5.5, 8.0, 15.0])
def test_an_insole_is_as_thick_as_asked_for_and_covers_the_sole(thickness: float) -> None:
    build = build_insole(PERSON, thickness, layout_only=True)
    p, plan = build.parameters, build.shoes[0].plan
    assert p.thickness == pytest.approx(thickness)
    assert p.floor >= p.wall_min
    assert (p.material, p.retention, build.kind) == ("TPU", "none", "insole")
    assert PERSON.sole.buffer(-0.4).covers(plan.contact)
    assert sum(c.area for c in plan.cells) > 0.84 * PERSON.sole.area
    assert plan.blind_rim <= 12.0
    assert build.load_share.flat >= 0.95
    assert build.load_share.half >= 0.80
    assert build.shoes[1].layout.positions[:, 1] == pytest.approx(-build.shoes[0].layout.positions[:, 1])


def test_what_cannot_be_an_insole_is_refused() -> None:
    for thickness, change, reason in (
        (3.0, {}, "insole is 3 mm thick; allowed: 4 to 15 mm"),
        (float("nan"), {}, "insole is nan mm thick"),
        (6.0, {"material": "PLA"}, "an insole of PLA would not bend"),
        (5.0, {"pad_thickness": 3.0}, "has a floor of"),
    ):
        with pytest.raises(InputError, match=reason):
            build_insole(PERSON, thickness, parameters=ShoeParameters(**change), layout_only=True)  # type: ignore[arg-type]


@pytest.mark.parametrize(("length", "width"), [(0.24, 0.09), (0.29, 0.105)])
def test_whole_cells_that_miss_too_much_of_the_pressure_are_refused(length: float, width: float) -> None:
    foot = foot_from_dimensions("person", length=length, width=width, corner_radius=0.035)
    with pytest.raises(FootError, match=r"whole cells of 691 mm\^2 cover 7\d % of the foot's outline; .*--rim fine"):
        build_insole(foot, 6.0, rim="whole", layout_only=True)
    build = build_insole(foot, 6.0, rim="whole", cell_area=150.0, layout_only=True)
    cells = shapely.union_all(build.shoes[0].plan.cells)
    assert cells.intersection(foot.sole).area > 0.8 * foot.sole.area


def walk(weights: dict[str, np.ndarray], steps: int = 8) -> dict[str, np.ndarray]:
    """Forces (time, cells) in N of each foot of a walk of 70 kg: 0.7 s of 1.1 s on the ground, heel to toe."""
    time = np.arange(0.0, 1.1 * steps, 0.01)
    out = {"time": time}
    for side, start in (("left", 0.2), ("right", 0.75)):
        x = weights[side]
        phase = ((time - start) % 1.1) / 0.7
        on = (phase < 1.0) & (time > start)
        total = np.where(on, 687.0 * np.minimum(1.0, 6.0 * np.minimum(phase, 1.0 - phase)), 0.0)
        cop = x.min() + np.clip(phase, 0.0, 1.0) * np.ptp(x)
        share = np.exp(-(((x[None] - cop[:, None]) / 0.05) ** 2))
        out[side] = np.maximum(total, 0.0)[:, None] * share / share.sum(axis=1, keepdims=True)
    return out


def test_a_walk_on_insoles_is_read_and_measured(tmp_path: Path) -> None:
    export_shoe(build_insole(PERSON, 6.0, layout_only=True), tmp_path)
    layouts = {side: read_layout(tmp_path / f"layout_{side}.json") for side in ("left", "right")}
    made = walk({side: layout.positions[:, 0] for side, layout in layouts.items()})
    np.savez(tmp_path / "walk.npz", unit="N", **made)
    analysis = analyse(tmp_path / "walk.npz", options=with_layout(None, tmp_path / "layout_left.json"))
    for side, layout in layouts.items():
        got = analysis.recording.feet[side]
        assert len(got.layout) == len(layout)
        k = 40 if side == "left" else 95  # in the middle of a step
        percept = Percept(layout, Reading(time=0.0, force=made[side][k]))
        x = layout.positions[:, 0]
        assert percept.position_cop_in_sole is not None
        force = made[side][k]
        assert percept.position_cop_in_sole[0] == pytest.approx(float(force @ x / force.sum()), abs=2e-3)
        assert percept.vertical_force == pytest.approx(float(force.sum()), rel=0.02)
        steps = analysis.feet[side].steps
        assert len(steps) in (7, 8)


@pytest.mark.long
@pytest.mark.parametrize("thickness", [4.0, 6.0])
def test_an_insole_holds_and_a_witness_agrees(small_foot: Foot, tmp_path: Path, thickness: float) -> None:
    build = build_insole(replace(small_foot, mass=40.0), thickness, side="left", cell_area=300.0)
    report = export_shoe(build, tmp_path)
    assert report.holds, [c for c in report.checks["left"].checks if not c.holds]
    foot = prism(np.array(small_foot.sole.exterior.coords)[:-1], 0.0, 40.0)
    assert Witness(tmp_path, foot).problems() == []
    told = json.loads((tmp_path / "check.json").read_text())
    assert told["kind"] == "insole"
    assert read_parameters(tmp_path / "check.json") == build.parameters
    again = build_insole(small_foot, thickness, parameters=build.parameters, cell_area=300.0, layout_only=True)
    assert again.parameters == build.parameters
