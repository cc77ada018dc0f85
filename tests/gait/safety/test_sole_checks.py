"""Sides, scale and order of the soles' taxels, by traces of a robot that leans."""

import numpy as np
import pytest

from plantar.gait.safety.bring_up.motion import FORWARD, LEANED, SIDEWAYS
from plantar.gait.safety.bring_up.sole_checks import check_leaning_soles

PERIOD = 0.005


def leaned(reversed_sides=()):
    """Trace of soles whose list of taxels goes to and fro, so that its reverse mixes both axes of the sole."""
    time = PERIOD * np.arange(round(LEANED / PERIOD))
    lean = np.zeros((len(time), 2))
    for axis, (begin, end) in enumerate((FORWARD, SIDEWAYS)):
        share = np.clip((time - begin) / (end - begin), 0.0, 1.0)
        lean[:, axis] = 0.01 * np.sin(2.0 * np.pi * share)
    roll = 0.012 * np.sin(2.0 * np.pi * 2.1 * time) * (time > FORWARD[0])  # of the torso, which moves both soles alike
    x, y = lean[:, 0], 0.2 * lean[:, 1] + roll
    wired, turned = np.column_stack([x, y]), np.column_stack([-0.4 * x - 1.2 * y, -0.3 * y])
    trace = {"time": time, "vrp": lean}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        trace[f"load_{side}"] = 300.0 * (1.0 + 4.0 * sign * lean[:, 1])
        flips = side in reversed_sides
        trace[f"center_{side}"], trace[f"reversed_{side}"] = (turned, wired) if flips else (wired, turned)
    return trace


@pytest.mark.parametrize("sides", [("left",), ("right",), ("left", "right")])
def test_a_reversed_order_that_mixes_both_axes_is_named(sides):
    causes = [finding.cause for finding in check_leaning_soles(leaned(sides))]
    assert causes == [f"taxel order of the {side} sole reversed" for side in sides]


def test_soles_in_order_pass():
    assert check_leaning_soles(leaned()) == []


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("slope", [-0.6, 2.8])
def test_a_reversed_sole_that_moves_too_much_forward_is_named_by_what_both_make(side, slope):
    trace = leaned()
    noise = 0.01 * np.sin(2.0 * np.pi * 3.3 * trace["time"])  # so that neither order is explained far better
    lean = trace["vrp"][:, 0]
    for order, part in (("center", slope), ("reversed", 0.9)):
        trace[f"{order}_{side}"] = np.column_stack([part * lean + noise, trace[f"{order}_{side}"][:, 1]])
    causes = [finding.cause for finding in check_leaning_soles(trace)]
    assert causes == [f"taxel order of the {side} sole reversed"]


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_sole_that_moves_against_the_lean_passes_where_both_follow_it(side):
    trace = leaned()
    yaw = 0.02 * np.sin(2.0 * np.pi * 1.1 * trace["time"])  # moves the centers apart, each by more than the lean does
    lean = trace["vrp"][:, 0]
    signs = {"left": 1.0, "right": -1.0} if side == "right" else {"left": -1.0, "right": 1.0}
    for s, sign in signs.items():
        along = (1.0 + 1.4 * sign) * lean + sign * yaw
        trace[f"center_{s}"] = np.column_stack([along, trace[f"center_{s}"][:, 1]])
        trace[f"reversed_{s}"] = np.column_stack([-0.5 * along, trace[f"center_{s}"][:, 1]])
    assert check_leaning_soles(trace) == []
