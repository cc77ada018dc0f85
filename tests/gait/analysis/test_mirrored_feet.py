"""Feet whose load lies as in the other foot."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.common.sides import SIDES, other_side
from plantar.gait.analysis.health import inward_of_toes, mirrored_doubts
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.parameters import analyse_feet
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

from .vendor_texts import matrix_insoles
from .walks import made_walk

LAYOUTS = matrix_insoles(31, 11, 8.6e-3)


def arched(mirrored: tuple[str, ...] = ()) -> PressureRecording:
    """A walk whose midfoot is loaded outside and whose toes are loaded inside; the other way round in some feet."""
    recording = made_walk(layouts=LAYOUTS).recording
    feet = {}
    for side, foot in recording.feet.items():
        layout = foot.layout
        inward = layout.positions[:, 1] * (1.0 if side == "right" else -1.0) / 0.05
        along = layout.positions[:, 0] / float(layout.outline[:, 0].max())
        turn = -1.0 if side in mirrored else 1.0
        share = 1.0 + turn * inward * np.where(along > 0.78, 0.9, np.where((along > 0.3) & (along < 0.55), -0.9, 0.0))
        feet[side] = replace(foot, force=foot.force * np.maximum(share, 0.0))
    return replace(recording, feet=feet)


def test_feet_as_they_are_and_mirrored():
    for mirrored, doubted in (((), 0), (("left",), 0), (SIDES, 1)):
        recording = arched(mirrored)
        feet = analyse_feet(recording)
        assert [inward_of_toes(feet[side]) < 0.0 for side in SIDES] == [side in mirrored for side in SIDES]
        assert len(mirrored_doubts(recording, feet)) == doubted
    assert any("as mirrored feet do" in warning for warning in metrics_of(recording, feet)["warnings"])


def test_swapped_matrices_are_mirrored_feet():
    recording = arched()
    feet = {
        side: FootRecording(side, recording.feet[other_side(side)].force, layout) for side, layout in LAYOUTS.items()
    }
    swapped = replace(recording, feet=feet)
    assert len(mirrored_doubts(swapped, analyse_feet(swapped))) == 1


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("mirrored", [(), SIDES])
def test_one_foot_of_the_other_side_is_doubted(side, mirrored):
    recording = arched(mirrored)
    one = replace(recording, feet={side: recording.feet[side]})
    doubts = mirrored_doubts(one, analyse_feet(one))
    assert [line.split(" carries")[0] for line in doubts] == [f"the {side} foot"] * bool(mirrored)


def test_robots_are_not_doubted():
    robot = replace(arched(SIDES), kind="robot")
    assert mirrored_doubts(robot, analyse_feet(robot)) == []


def test_a_real_foot_of_the_other_side_is_doubted(real_data):
    from plantar.formats import ReadOptions
    from plantar.gait.analysis.analyse import analyse

    found = analyse(real_data / "recordings" / "fscan_walk_left.asf", options=ReadOptions(side="right"))
    assert any("the right foot carries" in w and "as mirrored feet do" in w for w in found.metrics["warnings"])


def test_real_feet_are_not_doubted(real_data):
    from plantar.gait.analysis.analyse import analyse

    for name in ("pedar_walk.asc", "moticon_walk_a.txt", "xsensor_walk.csv", "fscan_walk_left.asf"):
        found = analyse(real_data / "recordings" / name)
        assert not any("mirrored" in warning for warning in found.metrics["warnings"])
        assert all(inward_of_toes(gait) > 0.05 for gait in found.feet.values())


@pytest.mark.parametrize("layout", [None, LAYOUTS["left"]])
def test_a_foot_without_geometry_or_load_has_no_inward(layout):
    recording = arched()
    foot = FootRecording("left", np.zeros_like(recording.feet["left"].force), layout)
    empty = replace(recording, feet={"left": foot})
    assert np.isnan(inward_of_toes(analyse_feet(empty)["left"]))
