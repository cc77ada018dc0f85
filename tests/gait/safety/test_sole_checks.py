"""Sides, scale and order of the soles' taxels, by traces of a robot that sways as it leans."""

import numpy as np
import pytest

from plantar.gait.safety.bring_up.body_motion import BodyMotion, smoothed
from plantar.gait.safety.bring_up.motion import LEANED
from plantar.gait.safety.bring_up.sole_checks import check_leaning_soles

PERIOD = 0.005


def swayed(reversed_sides=()):
    """Trace and motion of soles whose list of taxels goes to and fro, so that its reverse mixes both axes."""
    time = PERIOD * np.arange(round(LEANED / PERIOD))
    zmp = 0.01 * np.column_stack([np.sin(2.0 * np.pi * 0.7 * time), np.sin(2.0 * np.pi * 0.6 * time + 1.0)])
    roll = 0.012 * np.sin(2.0 * np.pi * 2.1 * time)  # of the torso, which moves both soles alike
    x, y = zmp[:, 0], 0.2 * zmp[:, 1] + roll
    wired, turned = np.column_stack([x, y]), np.column_stack([-0.4 * x - 1.2 * y, -0.3 * y])
    trace = {"time": time}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        trace[f"load_{side}"] = 300.0 * (1.0 + 4.0 * sign * zmp[:, 1])
        flips = side in reversed_sides
        trace[f"center_{side}"], trace[f"reversed_{side}"] = (turned, wired) if flips else (wired, turned)
    shown = smoothed(zmp, PERIOD)
    return trace, BodyMotion(np.zeros((len(time), 3)), shown, np.zeros_like(shown), 0.8)


def causes(trace, motion):
    return [finding.cause for finding in check_leaning_soles(trace, motion)]


@pytest.mark.parametrize("sides", [("left",), ("right",), ("left", "right")])
def test_a_reversed_order_that_mixes_both_axes_is_named(sides):
    assert causes(*swayed(sides)) == [f"taxel order of the {side} sole reversed" for side in sides]


def test_soles_in_order_pass():
    assert causes(*swayed()) == []


def test_an_order_that_no_reversal_mends_is_named():
    trace, motion = swayed()
    for side in ("left", "right"):
        trace[f"center_{side}"] = trace[f"reversed_{side}"] = 0.02 * trace[f"center_{side}"]
    assert causes(trace, motion) == ["taxel order wrong"]


def test_exchanged_soles_are_named():
    trace, motion = swayed()
    trace["load_left"], trace["load_right"] = trace["load_right"], trace["load_left"]
    assert causes(trace, motion) == ["soles exchanged"]


def even(trace):
    """Share of the weight that hardly moves, so that soles far forward and back make no lever of it."""
    for side, sign in (("left", 1.0), ("right", -1.0)):
        trace[f"load_{side}"] = 300.0 + sign * 1e-3 * np.sin(2.0 * np.pi * 0.6 * trace["time"] + 1.0)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_sole_whose_reverse_moves_alike_is_judged_by_where_it_is_pressed(side):
    trace, motion = swayed()
    even(trace)
    for s, place in (("left", 0.06), ("right", -0.06)):  # on its toes, and on its heel
        wobble = 0.002 * np.sin(2.0 * np.pi * 3.3 * trace["time"])
        trace[f"center_{s}"] = trace[f"center_{s}"] + np.column_stack([place + wobble, wobble])
    trace[f"reversed_{side}"] = trace[f"center_{side}"] - [2.0 * np.mean(trace[f"center_{side}"][:, 0]), 0.0]
    assert causes(trace, motion) == []
    swapped = trace | {f"center_{side}": trace[f"reversed_{side}"], f"reversed_{side}": trace[f"center_{side}"]}
    assert causes(swapped, motion) == [f"taxel order of the {side} sole reversed"]


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("slope", [-0.6, 2.8])
def test_a_reversed_sole_that_moves_too_much_forward_is_named_by_what_both_make(side, slope):
    trace, motion = swayed()
    noise = 0.01 * np.sin(2.0 * np.pi * 3.3 * trace["time"])
    lean = 0.01 * np.sin(2.0 * np.pi * 0.7 * trace["time"])
    for order, part in (("center", slope), ("reversed", 0.9)):
        trace[f"{order}_{side}"] = np.column_stack([part * lean + noise, trace[f"{order}_{side}"][:, 1]])
    assert causes(trace, motion) == [f"taxel order of the {side} sole reversed"]


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_sole_that_moves_against_the_lean_passes_where_both_follow_it(side):
    trace, motion = swayed()
    even(trace)
    yaw = 0.02 * np.sin(2.0 * np.pi * 1.1 * trace["time"])  # moves the centers apart, each by more than the lean does
    lean = 0.01 * np.sin(2.0 * np.pi * 0.7 * trace["time"])
    signs = {"left": 1.0, "right": -1.0} if side == "right" else {"left": -1.0, "right": 1.0}
    for s, sign in signs.items():
        along = (1.0 + 1.4 * sign) * lean + sign * yaw
        trace[f"center_{s}"] = np.column_stack([along, trace[f"center_{s}"][:, 1]])
        trace[f"reversed_{s}"] = np.column_stack([-0.5 * along, trace[f"center_{s}"][:, 1]])
    assert causes(trace, motion) == []
