"""A walking command as joint angles and torques of the legs."""

from plantar.gait.command import Command
from plantar.robots.kinematics.leg_model import LegModel

REACH_ERROR = 0.02
"""Miss of a reached command in rad, or in m on a leg of 0.6 m; the motion of one control period leaves 8 mm."""

SPEED_SHARE = 0.9
"""Share of a joint's speed limit that its target may have: the joint itself overshoots by up to a tenth."""

SLOW = 0.0247
"""Rate in rad/beat from which a joint moves against its friction: 0.1 rad/s on a leg of 0.6 m."""

_LARGEST_STEP = 0.1  # rad of a joint in a control period: 20 rad/s at 200 Hz, three times what the robots' knees can


def follow_command(legs: LegModel, command: Command) -> float:
    """Solve a command for the joints; the angles are `legs.joints`.

    Returns largest task error before the last step, in units of length or rad; NaN if a target is.
    """
    return legs.follow_command(command, _LARGEST_STEP)
