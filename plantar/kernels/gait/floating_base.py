"""Floating base from leg kinematics, IMU and loads (equations: `plantar.gait.estimate.estimator`).

Feet are numbered as `plantar.common.sides.SIDES`.
"""

import math

import numpy as np

from plantar.errors import InputError

from ..base import memory, vectors
from ..mechanics import rotations

__all__ = ["FloatingBase"]

_NONE = float("nan")


class FloatingBase:
    """Base that turns with the gyro and moves with carrying feet, and its CoM velocity.

    Args:
        omega: Pendulum frequency in rad/s.
        period: Control period in s.
        gravity: In m/s^2.
        gains: Averaging in s, correction of tilt and heading in 1/s, observer bandwidth in rad/s, least load in N
            (`EstimatorGains`).
        state: Caller's arrays to write: rotation (3, 3) from base to world, base position (3,), CoM (3,), its velocity
            (3,), sole origins (2, 3), sole rotations (2, 3, 3) to world, composite ZMP (2,) (NaN without load), base
            turn (3,) in rad by still soles; in m and m/s.
        bias: `gyro_bias.GyroBias`; None disables bias correction.
        steady: `SteadyLoad` that selects feet; None for all loaded.
        push: `PushFilter`; None disables it.
        legs: Share of the CoM's acceleration, and of the pendulum's, that a swinging foot's gives (`LegInertia`).
        anchor: Largest difference in m between footholds of one height, and share of the way to its feet's heights
            that the base goes in a tick.
    """

    def __init__(
        self,
        omega,
        period,
        gravity,
        gains,
        state,
        bias=None,
        steady=None,
        push=None,
        legs=(0.0, 0.0),
        anchor=(0.0, 0.0),
    ):
        self.omega = omega
        self.period = period
        self.gravity = gravity
        self.averaging, self.tilt_rate, self.yaw_rate, self.bandwidth, self.minimum_load = gains
        self.rotation, self.position, self.com, self.velocity = state[:4]
        self.places, self.turns, self.zmp, self.stood = state[4:]
        self.bias = bias
        self.steady = steady
        self.push = push
        self.leg_share, self.leg_turning = legs
        self.same_height, self.anchored = anchor
        self.heights = np.full(2, _NONE)
        self.samples = 0
        self.astray = 0.0
        self.headings = np.full(2, _NONE)
        self.com_in_base = np.zeros(3)
        # now, a tick ago
        self.places_in_base = np.zeros((2, 2, 3))
        self.turns_in_base = np.zeros((2, 2, 3, 3))
        self.loads = np.zeros(2)
        self.pressed = np.zeros(2, dtype=np.uint8)
        self.cops = np.zeros((2, 2))
        self.before = np.eye(3)
        self.matrix = np.zeros((3, 3))
        self.work = np.zeros((3, 3))
        self.vector = np.zeros(3)
        self.other = np.zeros(3)
        self.rate = np.zeros(3)
        self.specific = np.zeros(3)
        self.planned = np.zeros(2)
        self.watch(*np.zeros((3, 3)), *np.zeros((2, 3, 3)))

    def watch(self, com, left, right, turn_left, turn_right):
        """Keep a posture's arrays, in the base frame, which `take` reads.

        `com`: CoM (3,) in m; `left`: origin (3,) of left sole frame in m; `right` likewise; `turn_left`: rotation (3,
        3) from the left sole frame; `turn_right` likewise.
        """
        self.com_now = com
        self.left_now = left
        self.right_now = right
        self.turn_left_now = turn_left
        self.turn_right_now = turn_right

    def take(self):
        """Read this tick's posture; keep the last one."""
        com = self.com_now
        left = self.left_now
        right = self.right_now
        turn_left = self.turn_left_now
        turn_right = self.turn_right_now
        places = self.places_in_base
        turns = self.turns_in_base
        for i in range(3):
            self.com_in_base[i] = com[i]
            for side in range(2):
                places[1, side, i] = places[0, side, i]
            places[0, 0, i] = left[i]
            places[0, 1, i] = right[i]
            for j in range(3):
                for side in range(2):
                    turns[1, side, i, j] = turns[0, side, i, j]
                turns[0, 0, i, j] = turn_left[i, j]
                turns[0, 1, i, j] = turn_right[i, j]

    def stand(self, rotation, position, heading_left, heading_right):
        """Place the base: rotation (3, 3) to world, position (3,) in m, feet's headings in rad."""
        for i in range(3):
            self.position[i] = position[i]
            for j in range(3):
                self.rotation[i, j] = rotation[i, j]
                self.before[i, j] = rotation[i, j]
        rotations.turn(self.rotation, self.com_in_base, self.vector)
        for i in range(3):
            self.com[i] = self.position[i] + self.vector[i]
        self.headings[0] = heading_left
        self.headings[1] = heading_right

    def rest(self):
        """Zero velocity, correct heading."""
        self.velocity[0] = 0.0
        self.velocity[1] = 0.0
        self.velocity[2] = 0.0
        self.astray = 0.0

    def carry(self, side, load, pressed, x, y):
        """Set the load of a foot at this tick. `load`: vertical force in N; `x`: that in sole frame in m."""
        self.loads[side] = load
        self.pressed[side] = pressed
        self.cops[side, 0] = x
        self.cops[side, 1] = y

    def load(self, side, force, tare, cop):
        """`carry` by a vertical `force` in N less its `tare`, and `cop` (2,) in sole frame in m or None; returns the
        load in N: ground never pulls; what the tare leaves below zero is noise.
        """
        load = max(0.0, force - tare)
        if cop is None:
            self.carry(side, load, False, 0.0, 0.0)
        else:
            point = memory.values(cop)
            self.carry(side, load, True, point[0], point[1])
        return load

    def step(self, gyro, accelerometer, planned, swing):
        """`follow` by arrays, less what the swinging foot takes, and return to the feet's height; returns the ZMP.

        `gyro` (3,) in rad/s and `accelerometer` (3,) in m/s^2, base frame; `planned` CoM acceleration (2,) and the
        `swing` foot's (2,) in m/s^2.
        """
        rate = memory.values(gyro)
        force = memory.values(accelerometer)
        com = memory.values(planned)
        foot = memory.values(swing)
        x = self._of_base(com[0], foot[0])
        y = self._of_base(com[1], foot[1])
        zmp = self.follow(rate[0], rate[1], rate[2], force[0], force[1], force[2], x, y)
        self._anchor()
        return zmp

    def _of_base(self, planned, swing):
        """The base's acceleration of the CoM's, `planned`, and the swinging foot's, along one axis (`LegInertia`)."""
        mu = self.leg_share
        return (planned - mu * swing) / (1.0 - 2.0 * mu)

    def _anchor(self):
        """Return the base to its feet's landing height; else step errors (tilt times length) add up."""
        heights = self.heights
        error = 0.0
        total = 0.0
        for side in range(2):
            weight = self.loads[side] - self.minimum_load
            z = self.places[side, 2]
            if not weight > 0.0:
                heights[side] = _NONE
                continue
            if math.isnan(heights[side]):
                other = heights[1 - side]
                rise = z - self.places[1 - side, 2]
                if math.isnan(other):
                    heights[side] = z
                else:
                    heights[side] = other if abs(rise) < self.same_height else other + rise
            error = error + weight * (z - heights[side])
            total = total + weight
        if total > 0.0:
            self.position[2] -= self.anchored * error / total

    def settle(self, accelerometer, planned, swing, felt):
        """Compare base and pendulum for a push, and `observe` with it, or with a `felt` one (2,) in m/s^2, or None;
        other arguments as of `step`.
        """
        force = memory.values(accelerometer)
        com = memory.values(planned)
        foot = memory.values(swing)
        x = self.leg_turning * foot[0]
        y = self.leg_turning * foot[1]
        push = self.push
        if push is not None:
            if math.isnan(self.zmp[0]):
                push.rest()
            else:
                turn = self.rotation
                square = self.omega * self.omega
                push.update(
                    turn[0, 0] * force[0] + turn[0, 1] * force[1] + turn[0, 2] * force[2]
                    - (self._of_base(com[0], foot[0]) - com[0]),
                    turn[1, 0] * force[0] + turn[1, 1] * force[1] + turn[1, 2] * force[2]
                    - (self._of_base(com[1], foot[1]) - com[1]),
                    square * (self.com[0] - self.zmp[0]) + x,
                    square * (self.com[1] - self.zmp[1]) + y,
                )  # fmt: skip
            if felt is not None:
                pushed = memory.values(felt)
                x = pushed[0] + x
                y = pushed[1] + y
            elif push.acts:
                x = push.x + x
                y = push.y + y
        self.observe(x, y)

    def follow(self, gyro_x, gyro_y, gyro_z, specific_x, specific_y, specific_z, planned_x, planned_y):
        """Read this tick's posture, and turn and move the base; returns the ZMP as `place`.

        `gyro_x`: angular velocity about base's x in rad/s; `gyro_y` and `gyro_z` likewise; `specific_x`: specific force
        along base's x in m/s^2; `specific_y` and `specific_z` likewise; `planned_x`: planned CoM acceleration along
        world's x in m/s^2; `planned_y` likewise.
        """
        self.take()
        rate = self.rate
        bias = self.bias
        rate[0] = gyro_x
        rate[1] = gyro_y
        rate[2] = gyro_z
        self.specific[0] = specific_x
        self.specific[1] = specific_y
        self.specific[2] = specific_z
        self.planned[0] = planned_x
        self.planned[1] = planned_y
        if bias is None:
            self.turn(rate, self.specific, self.planned, False, None)
        else:
            self._identify(gyro_x, gyro_y, gyro_z)
            for i in range(3):
                rate[i] -= bias.value[i]
            self.turn(rate, self.specific, self.planned, True, bias.missed if bias.concluded else None)
        self.move()
        return self.place()

    def _identify(self, gyro_x, gyro_y, gyro_z):
        left = max(0.0, self.loads[0] - self.minimum_load)
        right = max(0.0, self.loads[1] - self.minimum_load)
        steady = self.steady
        stood = self.stood
        if steady is not None:
            steady.update(left, right)
            left = steady.left
            right = steady.right
        stands = self.stand_still(left, right)
        both = left > 0.0 and right > 0.0
        self.bias.update(gyro_x, gyro_y, gyro_z, stands, stood[0], stood[1], stood[2], both)

    def stand_still(self, weight_left, weight_right):
        """Weighted turn by still soles in this tick, sin a of R_s(k-1) R_s(k)^T; whether one is still."""
        turns = self.turns_in_base
        stood = self.stood
        total = 0.0
        sx = 0.0
        sy = 0.0
        sz = 0.0
        for side in range(2):
            weight = weight_left if side == 0 else weight_right
            if not weight > 0.0:
                continue
            x = 0.0
            y = 0.0
            z = 0.0
            for k in range(3):
                x += turns[1, side, 2, k] * turns[0, side, 1, k] - turns[1, side, 1, k] * turns[0, side, 2, k]
                y += turns[1, side, 0, k] * turns[0, side, 2, k] - turns[1, side, 2, k] * turns[0, side, 0, k]
                z += turns[1, side, 1, k] * turns[0, side, 0, k] - turns[1, side, 0, k] * turns[0, side, 1, k]
            sx += weight * x
            sy += weight * y
            sz += weight * z
            total += weight
        if not total > 0.0:
            stood[0] = 0.0
            stood[1] = 0.0
            stood[2] = 0.0
            return False
        stood[0] = 0.5 * sx / total
        stood[1] = 0.5 * sy / total
        stood[2] = 0.5 * sz / total
        return True

    def turn(self, rate, accelerometer, planned, by_legs, missed):
        """Turn the base by one tick.

        `rate`: angular velocity (3,) in base frame in rad/s, less bias; `accelerometer`: specific force (3,) in base
        frame in m/s^2; `planned`: planned horizontal CoM acceleration (2,) in m/s^2, or None; `by_legs`: whether
        `missed` or feet correct heading; `missed`: turn (3,) of legs beyond gyro in base frame in rad, or None.
        """
        rotation = self.rotation
        specific = self.other
        vector = self.vector
        before = self.before
        rx = rate[0]
        ry = rate[1]
        rz = rate[2]
        for i in range(3):
            vector[i] = accelerometer[i]
        rotations.turn(rotation, vector, specific)
        # Gravity: the specific force minus the body's acceleration points up.
        x = specific[0]
        y = specific[1]
        z = specific[2]
        if planned is not None:
            x -= planned[0]
            y -= planned[1]
        size = math.sqrt(x * x + y * y + z * z)
        # A swing jerks the base one way and brakes it longer the other way: the mean over a stride is gravity, of what
        # is left of it without its larger part it is not. Only hard impacts are left out, which sampling may miss.
        if 0.2 * self.gravity < size < 3.0 * self.gravity:  # chosen: wide of the 0.7 to 1.3 of a walk without impacts
            # While the robot holds still, the running mean of what came so far; then a slow filter. (Balance control
            # has to wait that long: it would sway the robot by a wrong tilt and the sway would look like more tilt.)
            self.samples += 1
            since = self.period * (self.samples + 1)
            gain = 1.0 / since if since < self.averaging else self.tilt_rate
            x, y = gain * y / self.gravity, -gain * x / self.gravity  # specific force x up
            rx += rotation[0, 0] * x + rotation[1, 0] * y
            ry += rotation[0, 1] * x + rotation[1, 1] * y
            rz += rotation[0, 2] * x + rotation[1, 2] * y
        if by_legs:
            if missed is not None:
                self.astray -= rotation[2, 0] * missed[0] + rotation[2, 1] * missed[1] + rotation[2, 2] * missed[2]
            error = self.astray
            self.astray -= self.period * self.yaw_rate * error
        else:
            error = self._heading_error()
        rx -= self.yaw_rate * error * rotation[2, 0]
        ry -= self.yaw_rate * error * rotation[2, 1]
        rz -= self.yaw_rate * error * rotation[2, 2]
        for i in range(3):
            for j in range(3):
                before[i, j] = rotation[i, j]
        rotations.exponential(self.period * rx, self.period * ry, self.period * rz, self.work)
        rotations.multiply(before, self.work, self.matrix)
        # Rounding would make the product of thousands of rotations shrink or shear.
        rotations.orthonormalise(self.matrix, self.work, rotation)

    def _heading_error(self):
        """Heading in rad ahead of each foot's at touchdown."""
        rotation = self.rotation
        headings = self.headings
        turns = self.turns_in_base
        total = 0.0
        error = 0.0
        for side in range(2):
            weight = self.loads[side] - self.minimum_load
            if not weight > 0.0:
                headings[side] = _NONE
                continue
            x = 0.0
            y = 0.0
            for k in range(3):
                x += rotation[0, k] * turns[0, side, k, 0]
                y += rotation[1, k] * turns[0, side, k, 0]
            yaw = math.atan2(y, x)
            if math.isnan(headings[side]):
                # The heading that the foot has when it comes to carry is held against the gyro, which drifts about the
                # vertical.
                headings[side] = yaw
            # Weights begin at zero, so that a foot joins and leaves without a jump.
            error += weight * math.remainder(yaw - headings[side], 2.0 * math.pi)
            total += weight
        return error / total if total > 0.0 else 0.0

    def move(self):
        """Move the base by one tick with the carrying feet."""
        sx = 0.0
        sy = 0.0
        sz = 0.0
        total = 0.0
        before = self.before
        now = self.rotation
        vector = self.vector
        other = self.other
        cops = self.cops
        for side in range(2):
            weight = self.loads[side] - self.minimum_load
            if not (self.pressed[side] and weight > 0.0):
                continue
            # The point of the sole that carries does not move while it rolls over the ground: its apparent move is the
            # base's.
            self._point(1, side, cops[side, 0], cops[side, 1], other)
            rotations.turn(before, other, vector)
            sx += weight * vector[0]
            sy += weight * vector[1]
            sz += weight * vector[2]
            self._point(0, side, cops[side, 0], cops[side, 1], other)
            rotations.turn(now, other, vector)
            sx -= weight * vector[0]
            sy -= weight * vector[1]
            sz -= weight * vector[2]
            total += weight
        if total > 0.0:
            self.position[0] += sx / total
            self.position[1] += sy / total
            self.position[2] += sz / total
        else:
            # No foot carries: the body goes on as it went.
            for i in range(3):
                self.position[i] += self.period * self.velocity[i]

    def _point(self, past, side, x, y, out):
        """Sole's point in the base frame, now (0) or a tick ago (1)."""
        places = self.places_in_base
        turns = self.turns_in_base
        for i in range(3):
            out[i] = places[past, side, i] + turns[past, side, i, 0] * x + turns[past, side, i, 1] * y

    def place(self):
        """Compute soles' poses and their loads' ZMP (2,) in m; None without; InputError if not finite."""
        loads = self.loads
        cops = self.cops
        rotation = self.rotation
        position = self.position
        places = self.places
        turns = self.turns
        total = 0.0
        x = 0.0
        y = 0.0
        for side in range(2):
            for i in range(3):
                places[side, i] = position[i]
                for k in range(3):
                    places[side, i] += rotation[i, k] * self.places_in_base[0, side, k]
            rotations.multiply(rotation, self.turns_in_base[0, side], turns[side])
            load = loads[side]
            if self.pressed[side] and load > 0.0:
                total += load
                x += load * (places[side, 0] + turns[side, 0, 0] * cops[side, 0] + turns[side, 0, 1] * cops[side, 1])
                y += load * (places[side, 1] + turns[side, 1, 0] * cops[side, 0] + turns[side, 1, 1] * cops[side, 1])
        if not total > 0.0:
            self.zmp[0] = _NONE
            self.zmp[1] = _NONE
            return None
        x = x / total
        y = y / total
        if not math.isfinite(x + y):
            raise InputError("the ZMP or the vertical force of a foot is not finite")
        self.zmp[0] = x
        self.zmp[1] = y
        return vectors.vector2(x, y)

    def snapshot(self):
        """Copies of the state.

        Returns rotation (3, 3) from base to world; base position, CoM in m and its velocity in m/s (3,); left and right
        sole origins (3,) in m; their rotations (3, 3) to world.
        """
        places = self.places
        turns = self.turns
        return (
            _matrix(self.rotation),
            _vector(self.position),
            _vector(self.com),
            _vector(self.velocity),
            _vector(places[0]),
            _vector(places[1]),
            _matrix(turns[0]),
            _matrix(turns[1]),
        )

    def observe(self, push_x, push_y):
        """Observe CoM and velocity for a tick, with a push's acceleration in m/s^2."""
        com = self.com
        velocity = self.velocity
        zmp = self.zmp
        period = self.period
        # Gains 2 b and b^2: with the pendulum's own fall the observer's poles lie at -b +- omega.
        near = min(1.0, 2.0 * self.bandwidth * period)
        fast = min(1.0, self.bandwidth * self.bandwidth * period)
        rotations.turn(self.rotation, self.com_in_base, self.vector)
        for i in range(3):
            acceleration = 0.0
            if i < 2:
                # Predicted by the pendulum over the measured ZMP; the kinematics corrects it.
                if not math.isnan(zmp[i]):
                    acceleration = self.omega * self.omega * (com[i] - zmp[i])
                acceleration += push_x if i == 0 else push_y
            com[i] += period * velocity[i]
            velocity[i] += period * acceleration
            error = self.position[i] + self.vector[i] - com[i]
            com[i] += near * error
            velocity[i] += fast * error


def _vector(v):
    return vectors.vector(v[0], v[1], v[2])


def _matrix(m):
    return vectors.matrix(m[0, 0], m[0, 1], m[0, 2], m[1, 0], m[1, 1], m[1, 2], m[2, 0], m[2, 1], m[2, 2])
