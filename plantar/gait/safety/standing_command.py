"""Stand as the walk begins, before the first sound reading."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, FootTarget
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.percepts.percept import Percept
from plantar.sensing.reading import Reading


def standing_command(
    feet: Mapping[Side, Footstep],
    plan: WalkPlan,
    layouts: Mapping[Side, SoleLayout],
    weight: float,
    com_height: float,
    time: float,
) -> Command:
    """Stand where a walk begins, weight halved between feet.

    `weight`: robot's in N; `com_height`: CoM over the soles in m; `time` of the plan in s. Returns with targets as
    state and unloaded percepts.
    """
    reference = plan.at(time)
    phase = plan.schedule.at(time)
    ground = float(np.mean([feet[side].z for side in SIDES]))
    com = np.array([*reference.com[:2], ground + com_height])
    places: dict[str, NDArray[np.float64]] = {side: np.array(feet[side].position, dtype=float) for side in SIDES}
    turns: dict[str, NDArray[np.float64]] = {
        side: np.array(feet[side].rotation_sole_to_world, dtype=float) for side in SIDES
    }
    half = np.array([0.0, 0.0, 0.5 * weight])
    targets: dict[Side, FootTarget] = {
        side: FootTarget(places[side], turns[side], half.copy(), places[side][:2].copy()) for side in SIDES
    }
    state = BaseState(
        rotation_base_to_world=turns["left"].copy(),
        position_base=com.copy(),
        com=com.copy(),
        com_velocity=np.zeros(3),
        zmp=None,
        loads=dict.fromkeys(SIDES, 0.0),
        positions_sole=places,
        rotations_sole=turns,
    )
    return Command(
        com=com,
        rotation_torso=turns["left"].copy(),
        feet=targets,
        phase=phase,
        reference=reference,
        zmp_desired=reference.vrp,  # the plan's own: nothing is balanced yet, which motors go by
        state=state,
        dcm=com[:2].copy(),
        percepts={side: Percept(layouts[side], Reading(0.0, np.zeros(len(layouts[side])))) for side in SIDES},
    )
