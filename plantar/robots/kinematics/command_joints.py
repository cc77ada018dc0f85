"""A walking command as joint angles and torques of the legs."""

from plantar.common.sides import Side
from plantar.gait.command import Command
from plantar.robots.kinematics.leg_model import LegModel

REACH_ERROR = 0.02
"""Miss of a reached command in rad, or in m on a leg of 0.6 m; the motion of one control period leaves 8 mm."""

SPEED_SHARE = 0.9
"""Share of a joint's speed limit that its target may have: the joint itself overshoots by up to a tenth."""

SLOW = 0.0247
"""Rate in rad/beat from which a joint moves against its friction: 0.1 rad/s on a leg of 0.6 m."""

_LARGEST_STEP = 0.1  # rad of a joint in a control period: 20 rad/s at 200 Hz, three times what the robots' knees can
# Feet that miss their targets first, by whether the left and the right one carry no load
_YIELDING: dict[tuple[bool, bool], tuple[Side, ...]] = {
    (False, False): (),
    (True, False): ("left",),
    (False, True): ("right",),
    (True, True): ("left", "right"),
}


def follow_command(legs: LegModel, command: Command) -> float:
    """Solve a command for the joints; the angles are `legs.joints`.

    Returns largest task error before the last step, in units of length or rad; NaN if a target is.
    """
    left = command.feet["left"]
    right = command.feet["right"]
    return legs.follow_soles(
        command.com,
        command.rotation_torso,
        (left.position, left.rotation),
        (right.position, right.rotation),
        1,
        _YIELDING[left.force.item(2) <= 0.0, right.force.item(2) <= 0.0],
        _LARGEST_STEP,
    )


def carry_command(legs: LegModel, command: Command) -> float:
    """Torques that hold the last solution under a command's forces: `legs.torques`.

    Returns the left sole's share of the vertical force.
    """
    left = command.feet["left"]
    right = command.feet["right"]
    return legs.carry_soles(
        (left.force, left.center_of_pressure, left.position), (right.force, right.center_of_pressure, right.position)
    )
