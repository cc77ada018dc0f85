"""Figures of a run in which somebody touches the robot, from a recording whose numbers are known."""

from pathlib import Path

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.plan.phases import PhaseKind
from plantar.recordings.recording import Recording, Table
from plantar.robots import load_robot
from plantar.sim.figures.push_figure import draw_guide, draw_partner, draw_pushes, draw_strides, draw_swing

PERIOD, STEP = 0.02, 1.0


@pytest.fixture
def run():
    """Twelve steps in place of 1 s each, half of it on one foot; a push of 100 N for 0.2 s in the eighth."""
    time = np.arange(0.0, 12.0 * STEP, PERIOD)
    count, nothing = len(time), np.zeros((len(time), 3))
    index = np.floor(time / STEP)
    single = time % STEP >= 0.5 * STEP
    phase = np.where(single, PhaseKind.SINGLE_SUPPORT, PhaseKind.DOUBLE_SUPPORT)
    force = nothing.copy()
    force[(time >= 7.6) & (time < 7.8), 0] = 100.0
    com = np.column_stack([0.01 * time, 0.05 * np.sin(np.pi * time / STEP), np.full(count, 0.8)])
    topics = {
        "/truth/body": {"com": com, "zmp": com[:, :2]},
        "/estimate": {"dcm": com[:, :2]},
        "/reference": {"phase": phase[:, None], "step": index[:, None], "zmp": 0.5 * com[:, :2]},
        "/touch": {"force": force, "felt": 0.9 * force},
        "/feet": dict.fromkeys(SIDES, nothing),
        "/partner": {"moved": -com[:, :1], "reference": -com[:, :1], "force": -force[:, :1]},
    }
    for k, side in enumerate(SIDES):
        carries = ~(single & (index % 2 == k))
        topics[f"/truth/{side}"] = {
            "position": np.tile([0.0, 0.1 - 0.2 * k, 0.0], (count, 1)),
            "rotation": np.tile(np.eye(3).ravel(), (count, 1)),
            "normal_force": 800.0 * carries[:, None],
        }
    tables = {
        name: Table(time, {key: np.asarray(v, dtype=float) for key, v in f.items()}) for name, f in topics.items()
    }
    return Recording(Path("run.mcap"), layouts=load_robot("h1").layouts, topics=tables)


def test_pushes_show_measured_and_true_force_and_feet_only_while_they_stand(run):
    figure = draw_pushes(run)
    lines = {line.get_label(): line for line in figure.axes[0].lines}
    assert set(lines) == {"ZMP", "VRP, planned", "DCM", "CoM", "left foot", "right foot"}
    np.testing.assert_allclose(lines["VRP, planned"].get_ydata(), 0.5 * np.asarray(lines["CoM"].get_ydata()))
    swung = np.isnan(np.asarray(lines["left foot"].get_ydata(), dtype=float))
    assert swung.mean() == pytest.approx(0.25, abs=0.01)
    assert np.asarray(figure.axes[2].lines[0].get_ydata()).max() == 100.0


def test_the_swing_figure_marks_pushes(run):
    figure = draw_swing(run)
    assert len(figure.axes) == 3
    (span,) = figure.axes[2].patches
    assert (span.get_x(), span.get_x() + span.get_width()) == pytest.approx((7.6, 7.78), abs=1e-9)


def test_strides_have_a_panel_for_six_steps_with_arrows_where_it_was_pushed(run):
    figure = draw_strides(run)
    arrows = [len(axis.texts) for axis in figure.axes]
    assert arrows[0] == 0
    assert len(arrows) == 1 or arrows[1] > 0
    assert figure.axes[0].get_title() == "steps 0 to 5"


def test_the_partner_has_its_way_and_supports_their_durations(run):
    figure = draw_partner(run)
    single = next(line for line in figure.axes[2].lines if line.get_label() == "SSP")
    np.testing.assert_allclose(np.asarray(single.get_ydata())[:-1], 0.5 * STEP, atol=PERIOD)
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata(), 0.01 * run.topics["/partner"].time)


def test_it_shows_where_hand_and_feet_went_and_names_the_joints_that_turned():
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
