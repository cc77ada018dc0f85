"""Joint torques of a robot's motion, of the load that MuJoCo's inverse dynamics finds."""

import numpy as np

from ..base import memory

__all__ = ["JointMotion", "MotionLoad"]


class MotionLoad:
    """Inertial load of the legs, and the couple on the soles that changes the angular momentum.

    Args:
        state: Velocities and accelerations (nv,) that the inverse dynamics read.
        gravity: Acceleration (3,) of a falling body.
        rows: Velocities (6 + k,) of base and joints.
        load: Inverse dynamics' load (nv,).
        root: Position (3,) in m and rotation (9,) of the base, and the CoM (3,).
        axes: Each joint's axis (joints, 3) in the world, and the legs' places (k,) among them.
        armature: Of the legs' rotors (k,) in kg m^2.
        torques: Torques (k,) in N m of the legs, the left one's first, that the load is added to.
    """

    def __init__(self, state, gravity, rows, load, root, axes, armature, torques):
        self.velocity, self.acceleration = state
        self.gravity = gravity
        self.rows = rows
        self.load = load
        self.position, self.rotation, self.com = root
        self.axes, self.joints = axes
        self.armature = armature
        self.torques = torques

    def move(self, velocity, acceleration):
        """Write the motion (6 + k,) in m/s and rad/s, m/s^2 and rad/s^2, as if it fell: the weight is carried."""
        speeds = memory.values(velocity)
        changes = memory.values(acceleration)
        for i in range(self.rows.shape[0]):
            self.velocity[self.rows[i]], self.acceleration[self.rows[i]] = speeds[i], changes[i]
        for i in range(3):
            self.acceleration[i] += self.gravity[i]

    def add(self, acceleration, left, couple_x, couple_y, whole):
        """Add the load.

        Args:
            acceleration: Of `move`.
            left: Share of the weight on the left sole, the rest on the right one.
            couple_x: Couple in N m about x that the forces on the soles exert already; `couple_y` about y.
            whole: Whether an unloaded leg gets what moves it, too.
        """
        changes = memory.values(acceleration)
        load = self.load
        x = self.com[0] - self.position[0]
        y = self.com[1] - self.position[1]
        z = self.com[2] - self.position[2]
        fx = load[0]
        fy = load[1]
        fz = load[2]
        r = self.rotation
        tx = r[0] * load[3] + r[1] * load[4] + r[2] * load[5] - (y * fz - z * fy + couple_x)
        ty = r[3] * load[3] + r[4] * load[4] + r[5] * load[5] - (z * fx - x * fz + couple_y)
        tz = r[6] * load[3] + r[7] * load[4] + r[8] * load[5] - (x * fy - y * fx)
        count = self.torques.shape[0]
        for i in range(count):
            carried = left if i < count // 2 else 1.0 - left
            axis = self.joints[i]
            taken = load[self.rows[6 + i]] + self.armature[i] * changes[6 + i]
            about = self.axes[axis, 0] * tx + self.axes[axis, 1] * ty + self.axes[axis, 2] * tz
            self.torques[i] += (taken if whole else carried * taken) - carried * about


class JointMotion:
    """Velocity and acceleration of base and joints, of solutions a period apart.

    `moved`: velocities (nv,) of a solution since the last; `rows`: those (6 + k,) that count; `share` of a new
    acceleration in the low pass. Attributes `velocity` (6 + k,) in m/s and rad/s; `acceleration` likewise, low-passed.
    """

    def __init__(self, moved, rows, period, share):
        self.moved = moved
        self.rows = rows
        self.period = period
        self.share = share
        self.velocity = np.zeros(len(rows))
        self.acceleration = np.zeros(len(rows))

    def update(self):
        """Take in the velocities of the last solution."""
        velocity = memory.room(self.velocity)
        acceleration = memory.room(self.acceleration)
        for i in range(self.rows.shape[0]):
            speed = self.moved[self.rows[i]]
            acceleration[i] += self.share * ((speed - velocity[i]) / self.period - acceleration[i])
            velocity[i] = speed
