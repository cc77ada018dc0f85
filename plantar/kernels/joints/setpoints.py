"""Set-points of joint servos."""

import numpy as np

from ..base import memory

__all__ = ["Setpoints"]

_NONE = float("nan")


class Setpoints:
    """Set-points of k joints, half of them each leg's, moving between control ticks without a jump.

    They follow their goal by a critically damped low pass of second order; without lag they would exceed a joint's
    speed limit.

    Attributes `reference`: desired joint angles (k,) in rad, first NaN; `velocity` in rad/s; `goal`: set-points (k,) in
    rad with which joints follow reference; `setpoint`: written set-points (k,) in rad.

    Args:
        controls: Set-points (n,) of all servos, read by simulator.
        servos: Index (k,) of each joint's servo there.
        stiffness: Position gains (k,) in N m/rad.
        damping: Gains (k,) in N m s/rad of servo and joint.
        per_way: One over largest change (k,) per control period in 1/rad; empty without limits.
        period: Control period in s; `step` that of `advance`.
        share: Share of way per step of each low-pass stage, above 0 to 1.
        left: Share left of a leg's lag per control period.
        joints: Desired joint angles (k,) in rad, and holding `torques` (k,) in N m, written by caller.
    """

    def __init__(self, controls, servos, stiffness, damping, per_way, period, step, share, left, joints, torques):
        self.controls = controls
        self.servos = servos
        self.stiffness = stiffness
        self.damping = damping
        self.per_way = per_way
        self.period = period
        self.step = step
        self.share = share
        self.left = left
        self.joints = joints
        self.torques = torques
        count = len(servos)
        self.reference = np.full(count, _NONE)
        self.velocity = np.zeros(count)
        self.behind = np.zeros(count)
        self.goal = np.zeros(count)
        self.between = np.zeros(count)
        self.setpoint = np.zeros(count)
        self.rate = np.zeros(count)

    def hold(self, joints, torques):
        """Hold joint angles (k,) in rad that take torques (k,) in N m."""
        for i in range(self.servos.shape[0]):
            self.reference[i] = joints[i]
            self.velocity[i] = 0.0
            self.rate[i] = 0.0
            self.behind[i] = 0.0
            self.goal[i] = joints[i] + torques[i] / self.stiffness[i]
            self.between[i] = self.goal[i]
            self.setpoint[i] = self.goal[i]

    def go_to(self):
        """Set the next tick's reference, each leg's as far as its fastest joint may move."""
        count = self.servos.shape[0]
        self._go_on(0, count // 2)
        self._go_on(count // 2, count)

    def _go_on(self, begin, end):
        joints = self.joints
        fastest = 0.0
        total = 0.0
        for i in range(begin, end if self.per_way.shape[0] else begin):
            if self.behind[i] != self.behind[i]:
                self.behind[i] = 0.0
            share = (joints[i] - self.left * self.behind[i] - self.reference[i]) * self.per_way[i]
            total += share * share
            if share < 0.0:
                share = -share
            if share > fastest:
                fastest = share
        late = fastest > 1.0 and total == total
        for i in range(begin, end):
            last = self.reference[i]
            if last != last:
                last = joints[i]
            goal = joints[i] - self.left * self.behind[i]
            if late:
                goal = last + (goal - last) / fastest
            self.behind[i] = joints[i] - goal
            self.velocity[i] = (goal - last) / self.period
            self.reference[i] = goal
            self.rate[i] = self.velocity[i] * self.step

    def load(self, friction=None, offsets=None):
        """Set the goal with which servos follow without lag or error.

        `friction`: additional torques (k,) in N m of joints, or None; `offsets`: angles (k,) in rad to add, a
        contiguous float64 array, or None.
        """
        for i in range(self.servos.shape[0]):
            torque = self.torques[i]
            if friction is not None:
                torque += friction[i]
            lead = self.damping[i] * self.velocity[i] + torque
            self.goal[i] = self.reference[i] + lead / self.stiffness[i]
        if offsets is not None:
            angles = memory.values(offsets)
            for i in range(self.servos.shape[0]):
                self.goal[i] = self.goal[i] + angles[i]

    def write(self):
        """Write the set-points."""
        for i in range(self.servos.shape[0]):
            self.controls[self.servos[i]] = self.setpoint[i]

    def advance(self):
        """Move the set-points on by a step."""
        for i in range(self.servos.shape[0]):
            self.setpoint[i] += self.share * (self.between[i] - self.setpoint[i])
            self.between[i] += self.share * (self.goal[i] - self.between[i])
            self.goal[i] += self.rate[i]

    def drive(self):
        """Write one physics step's set-points, and move them on."""
        self.write()
        self.advance()
