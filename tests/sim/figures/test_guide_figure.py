"""The figure of a robot that is led by its arm, from a recording whose numbers are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from plantar.recordings.recording import Recording, Table
from plantar.sides import SIDES
from plantar.sim.figures.guide_figure import draw_guide


def test_it_shows_where_hand_and_feet_went_and_names_the_joints_that_turned() -> None:
    time = np.arange(0.0, 8.0, 0.02)
    ramp = 0.05 * time[:, None]
    zeros = np.zeros((len(time), 3))
    place = np.hstack([1.0 + ramp, zeros[:, :2]])
    turned = np.radians([20.0, 0.2]) * ramp / ramp.max()
    force = np.hstack([30.0 * ramp, -5.0 * ramp, 0.0 * ramp])
    topics = {
        "/guide": {"place": place, "held": place - [0.01, 0.0, 0.0]},
        "/arm": {"position": 0.3 + turned, "posture": np.full_like(turned, 0.3)},
        "/touch": {"force": force, "felt": 0.9 * force},
        "/truth/body": {"com": place},
    }
    carries = (time[:, None] % 1.0) < 0.5
    for side in SIDES:
        topics[f"/truth/{side}"] = {"position": place, "normal_force": 800.0 * carries}
    tables = {name: Table(time, dict(fields)) for name, fields in topics.items()}
    figure = draw_guide(Recording(Path("run.mcap"), topics=tables))
    ways, forces, joints = figure.axes
    drawn = {line.get_label(): line.get_ydata() for line in ways.lines}
    assert drawn["hand"][-1] == drawn["hand"].max() == place[-1, 0] - place[0, 0]
    assert np.isnan(drawn["left foot"]).sum() == (~carries).sum()
    assert max(line.get_ydata().max() for line in forces.lines) == force.max()
    assert [line.get_label() for line in joints.lines] == ["joint 1"]
    assert np.isclose(joints.lines[0].get_ydata().max(), 20.0)
