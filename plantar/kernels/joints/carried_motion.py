"""Joint torques of a walking command, of its ground forces and of its motion, in one call a tick."""

from ..base import memory

__all__ = ["CarriedMotion"]


class CarriedMotion:
    """Torques that carry a robot on its soles and move it.

    Args:
        place: Updates the poses of the last solution, unless done.
        static: `StaticLoad` of the legs.
        levers: `PointRows` of the left and right sole.
        motion: `MotionLoad` of the legs.
        turn: Updates the bodies' velocities.
        fall: Writes the load of the inverse dynamics.
        weight: In N.
    """

    def __init__(self, place, static, levers, motion, turn, fall, weight):
        self.place = place
        self.static = static
        self.levers = levers
        self.motion = motion
        self.turn = turn
        self.fall = fall
        self.weight = weight

    def take(self, left, right, velocity, acceleration, momentum, whole):
        """Write the torques.

        Args:
            left: `plantar.gait.command.FootTarget` of the left sole: force (3,) in N, center_of_pressure (2,) and
                position (3,) in m.
            right: Of the right one.
            velocity: Of base and joints (6 + k,) in m/s and rad/s; `acceleration` in m/s^2 and rad/s^2.
            momentum: (-L_y', L_x') / (m g) (2,) in m that the forces give already.
            whole: Whether an unloaded leg gets what moves it, too.

        ValueError, with no torques, unless all are contiguous float64 arrays.
        """
        couple = memory.values(momentum)
        self.place()
        share = self.static.stand(
            self.levers,
            left.force,
            left.center_of_pressure,
            left.position,
            right.force,
            right.center_of_pressure,
            right.position,
        )
        self.motion.move(velocity, acceleration)
        self.turn()
        self.fall()
        self.motion.add(acceleration, share, self.weight * couple[1], -self.weight * couple[0], whole)
