"""Parts of the control tick that a walk on the flat would not miss at once."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.gait.command import FootTarget
from plantar.gait.controller import WalkingController
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.rotation import level_rotation
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


@pytest.fixture
def controller() -> WalkingController:
    return Simulation(load_scene("flat", ["steps=2"])).controller


def rolled(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


@pytest.mark.parametrize("yaw", [0.0, 0.7])
@pytest.mark.parametrize("aside", [0.04, -0.04])
def test_the_trunk_leans_over_the_foot_that_the_com_moves_to(
    controller: WalkingController, yaw: float, aside: float
) -> None:
    places = [controller.motion.footholds[side][0][:2] for side in ("left", "right")]
    left = level_rotation(yaw)[:, 1]
    com = np.array([*np.mean(places, axis=0), 0.8]) + aside * left
    controller._least_lean = 2.0
    torso = controller._posture(com, yaw)
    assert torso @ torso.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(torso) == pytest.approx(1.0)
    assert torso[:, 0] == pytest.approx(level_rotation(yaw)[:, 0], abs=1e-12)  # along the feet
    reach = min(abs(aside), controller.settings.lean_reach)
    assert torso[:, 2] @ left == pytest.approx(math.copysign(math.sin(2.0 * reach), aside), abs=1e-9)
    upright = controller._posture(com - aside * left, yaw)
    assert upright[:, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


@pytest.mark.parametrize("lean", [0.03, -0.03])
def test_a_swing_foot_of_a_body_that_leans_comes_to_its_place_in_the_world(
    controller: WalkingController, lean: float
) -> None:
    """What is commanded, seen from the body and turned by its lean, is the place that was wanted."""
    side = "left"
    controller.motion = SimpleNamespace(last_side=side)  # type: ignore[assignment]
    place, com = np.array([0.1, 0.085, 0.03]), np.array([0.02, -0.05, 0.8])
    state: Any = BaseState(
        rotation_base_to_world=rolled(lean),
        position_base=np.zeros(3),
        com=com.copy(),
        com_velocity=np.zeros(3),
        zmp=None,
        loads={"left": 0.0, "right": 800.0},
        positions_sole={},
        rotations_sole={},
    )
    phase: Any = next(p for p in controller.schedule.phases if p.swing == side)
    for _ in range(400):
        feet = {side: FootTarget(place, np.eye(3), np.zeros(3), np.zeros(2))}
        controller._compensate(feet, phase, com, 0.0, np.eye(3), state)  # type: ignore[arg-type]
    target = feet[side]
    executed = state.com + rolled(lean) @ (target.position - com)
    assert executed == pytest.approx(place, abs=2e-3)
    assert np.linalg.norm(target.position - place) > 0.01  # it is no small thing
    sole = rolled(lean) @ target.rotation
    assert sole == pytest.approx(np.eye(3), abs=5e-3)
