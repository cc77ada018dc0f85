"""Kernel of the set-points of joint servos: where the joints are to go, and what is written at each step."""

from __future__ import annotations

import numpy as np

from ..base import memory

__all__ = ["Setpoints"]

_NONE = float("nan")


class Setpoints:
    """The set-points of k joints, which move on between control ticks without a jump.

    A tick replaces their goal at once; what is written follows it by a critically damped low pass of second order.
    Without lag it would have to move at 1.2 times a joint's speed limit to catch up.

    Args:
        controls: Set-points (n,) of all servos, where the simulator reads them.
        servos: Place (k,) of each joint's servo there.
        stiffness: Position gains (k,) in N m/rad.
        damping: Gains (k,) in N m s/rad of servo and joint.
        per_way: One over the largest way (k,) of a set-point in a control period in 1/rad; empty without limits.
        period: Control period in s.
        step: Period in s in which `advance` is called.
        share: Share of its way that each stage of the low pass goes in a step, above 0 to 1.
        joints: Joint angles (k,) in rad to go to, written by the caller.
        torques: Torques (k,) in N m that hold them, likewise.

    Attributes:
        reference: Desired joint angles (k,) in rad; NaN before the first ones.
        velocity: Their rates (k,) in rad/s.
        goal: Set-points (k,) in rad with which the joints follow the reference.
        setpoint: What is written (k,) in rad.
    """

    def __init__(self, controls, servos, stiffness, damping, per_way, period, step, share, joints, torques):
        self.controls = controls
        self.servos = servos
        self.stiffness = stiffness
        self.damping = damping
        self.per_way = per_way
        self.period = period
        self.step = step
        self.share = share
        self.joints, self.torques = joints, torques
        count = len(servos)
        self.reference = np.full(count, _NONE)
        self.velocity = np.zeros(count)
        self.goal = np.zeros(count)
        self.between = np.zeros(count)
        self.setpoint = np.zeros(count)
        self.rate = np.zeros(count)

    def hold(self, joints, torques):
        """Hold a posture.

        Args:
            joints: Joint angles (k,) in rad.
            torques: Torques (k,) in N m that it takes.
        """
        for i in range(self.servos.shape[0]):
            self.reference[i] = joints[i]
            self.velocity[i] = self.rate[i] = 0.0
            self.goal[i] = self.between[i] = self.setpoint[i] = joints[i] + torques[i] / self.stiffness[i]

    def go_to(self):
        """Set the reference for the next tick: the joints' goal, or as far on the way as the fastest joint may go."""
        joints = self.joints
        count = self.servos.shape[0]
        fastest = total = 0.0
        for i in range(self.per_way.shape[0]):
            share = (joints[i] - self.reference[i]) * self.per_way[i]
            total += share * share
            if share < 0.0:
                share = -share
            if share > fastest:
                fastest = share
        late = fastest > 1.0 and total == total
        for i in range(count):
            last = self.reference[i]
            if last != last:
                last = joints[i]
            goal = last + (joints[i] - last) / fastest if late else joints[i]
            self.velocity[i] = (goal - last) / self.period
            self.reference[i] = goal
            self.rate[i] = self.velocity[i] * self.step

    def load(self, friction=None, offsets=None):
        """Set the goal of the set-points, with which servos follow the reference without lag or error.

        Args:
            friction: Torques (k,) in N m that the joints take in addition, or None.
            offsets: Angles (k,) in rad that are added, a contiguous array of float64, or None.
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
        """Hand the set-points to the simulator."""
        for i in range(self.servos.shape[0]):
            self.controls[self.servos[i]] = self.setpoint[i]

    def advance(self):
        """Let the set-points move on by a step."""
        for i in range(self.servos.shape[0]):
            self.setpoint[i] += self.share * (self.between[i] - self.setpoint[i])
            self.between[i] += self.share * (self.goal[i] - self.between[i])
            self.goal[i] += self.rate[i]

    def drive(self):
        """Write the set-points of one physics step, and let them move on."""
        self.write()
        self.advance()
