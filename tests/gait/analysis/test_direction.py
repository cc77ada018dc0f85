"""Walks that are not forwards: named so, with lengths along and across the way."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.analysis.analyse import analyse
from plantar.gait.analysis.pages.report import summary_text

from .walks import made_walk

WAYS = {
    "forwards": (1.0, 0.0),
    "backwards": (-1.0, 0.0),
    "sideways to the left": (0.0, 1.0),
    "sideways to the right": (0.0, -1.0),
}


def placed(way, turn=0.0, speed=0.2):
    """A walk whose soles, 0.2 m apart and turned by an angle in rad, are carried along a way."""
    recording = made_walk(strides=8).recording
    c, s = np.cos(turn), np.sin(turn)
    feet = {}
    for side, foot in recording.feet.items():
        beside = 0.1 if side == "left" else -0.1
        local = speed * np.outer(recording.time, way) + [0.0, beside]
        x, y = (local @ np.array([[c, s], [-s, c]])).T
        feet[side] = replace(foot, placement=np.column_stack([x, y, np.full(len(x), turn)]))
    return replace(recording, feet=feet)


@pytest.mark.parametrize("direction", WAYS)
@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_a_walk_is_named_by_its_way(direction, turn):
    recording = placed(WAYS[direction], turn)
    walk = analyse(recording)
    gait = walk.metrics["gait"]
    assert gait["direction"] == direction
    noted = [w for w in walk.warnings if f"walking {direction}" in w]
    assert len(noted) == (direction != "forwards")
    assert (direction in summary_text(walk.metrics)) == (direction != "forwards")
    steps = {s: walk.metrics["feet"][s]["measures"]["step_length_m"]["mean"] for s in ("left", "right")}
    stride = gait["stride_length_m"]
    assert stride == pytest.approx(0.2 * gait["stride_time_s"], rel=0.02)
    if direction.startswith("sideways"):
        ahead = 1.0 if direction.endswith("left") else -1.0
        assert steps["left"] - steps["right"] == pytest.approx(0.4 * ahead, abs=0.02)
        assert gait["step_length_m"] is None
        assert gait["step_width_m"] == pytest.approx(0.0, abs=0.01)
    else:
        assert gait["step_length_m"] == pytest.approx(0.5 * stride, rel=0.03)
        assert gait["step_width_m"] == pytest.approx(0.2, abs=0.01)


def test_insoles_show_no_direction():
    assert analyse(made_walk(strides=6).recording).metrics["gait"]["direction"] is None
