"""Sensors that contradict each other while each of them is plausible."""

import math

import numpy as np

from ..base import memory

__all__ = ["ACCELERATION", "ENCODER_NOISE", "GYRO_NOISE", "LATE", "LOAD", "SELDOM", "TURN", "SensorWatch"]

# Codes, which add up
ACCELERATION = 1  # nature: a code
TURN = 2  # nature: a code
LOAD = 4  # nature: a code
GYRO_NOISE = 8  # nature: a code
ENCODER_NOISE = 16  # nature: a code
LATE = 32  # nature: a code of the left sole; of the right one twice that
SELDOM = 128  # nature: a code of the left sole; of the right one twice that

_NONE = float("nan")
_INFINITE = float("inf")

_LEAST_PULL = 3.0  # chosen: m/s^2: soles of a robot that falls carry nothing to compare with
_CARRIES = 0.3  # chosen: weight on a sole that does not turn; less may still come down, or lift off
_MOST_JITTER = 0.3  # chosen: rad/s: a shock counts as that much, so that it ends with the window


class SensorWatch:
    """Compares what encoders, IMU and soles report of one motion, tick by tick.

    Three comparisons learn what is usual, with every single support that ends, and notice what is more than a share of
    that and a constant: the accelerometer against the base's motion by encoders and gyro, in the mean of a window; the
    turn of the standing sole in a single support, by encoders and gyro, in those ticks in which it carries and presses
    as a flat one; the soles' load over the mass times the vertical specific force, more and less, in the mean of a
    shorter window. White noise of gyro and encoders shows in their second differences. The
    readings of a sole are late, or come seldom, beside the freshest and the most frequent ones.

    Args:
        joints: Number of angles.
        mass: Robot's in kg.
        gravity: In m/s^2.
        positions: Of the left and the right sole's taxels, (n, 3) and (m, 3) in m, sole frame.
        period: Of control in s.
        window: Of acceleration in ticks.
        mean: Ticks by which positions are differenced into speeds.
        short: Window of load and noise in ticks.
        share: Of what is usual.
        leasts: Constants: acceleration in m/s^2, turn in rad, load as a share; and load before the first single support
            has ended.
        older: Time in s by which the readings of a sole are late, or come seldom.
        readings: In turn that have to be late.
        flat: Spread of a flat sole's load in any direction, of that of an even load; one that rolls over an edge
            presses with a row of taxels.
        noises: Gyro's second difference in rad/s, and encoders' in rad; and the share of the joints that show it.

    Attributes:
        acceleration: Horizontal difference of the accelerometer in m/s^2.
        turn: Of the standing sole in rad, without what it turned by while it carried too little or pressed with an
            edge.
        later: Time in s by which readings of the left and the right sole come later than they did (2,), or for which
            none has come.
        late: Readings in turn that were late (2,).
        load: Soles' load over what the accelerometer shows.
    """

    def __init__(
        self,
        joints,
        mass,
        gravity,
        positions,
        period,
        window,
        mean,
        short,
        share,
        leasts,
        older,
        readings,
        flat,
        noises,
    ):
        self.joints = joints
        self.mass = mass
        self.gravity = gravity
        self.period = period
        self.window = window
        self.mean = mean
        self.short = short
        self.share = share
        self.least_acceleration, self.least_turn, self.least_load, self.first_load = leasts
        self.older = older
        self.readings = readings
        self.later = np.zeros(2)
        self.late = np.zeros(2)
        self.stamps = np.zeros(10)
        self.restart_clock()
        self.gyro_noise, self.encoder_noise, self.noisy = noises
        self.places = np.zeros(2 * (window + mean))
        left, right = (np.array(sole, dtype=np.float64)[:, :2] for sole in positions)
        self.left_positions = left.reshape(-1)
        self.right_positions = right.reshape(-1)
        self.left_even = _spread(left, flat)
        self.right_even = _spread(right, flat)
        self.left_count = len(left)
        self.right_count = len(right)
        self.stance = 0
        self.begun = False
        self.normal_x = 0.0
        self.normal_y = 0.0
        self.turn_x = 0.0
        self.turn_y = 0.0
        self.loads = np.zeros(4 * short)
        self.kept = np.zeros(2 * (joints + 3))
        self.speed_x = 0.0
        self.speed_y = 0.0
        self.way_x = 0.0
        self.way_y = 0.0
        self.ticks = 0
        self.sum_load = 0.0
        self.sum_pull = 0.0
        self.sum_gyro = 0.0
        self.sum_joints = 0.0
        self.walked = False
        self.largest_acceleration = 0.0
        self.recent_acceleration = 0.0
        self.largest_turn = 0.0
        self.recent_turn = 0.0
        self.largest_more = 0.0
        self.recent_more = 0.0
        self.largest_less = 0.0
        self.recent_less = 0.0
        self.acceleration = 0.0
        self.turn = 0.0
        self.load = 1.0

    def restart_clock(self):
        """The clock has another zero: readings have other ages."""
        stamps = memory.room(self.stamps)
        for i in range(2):
            stamps[5 * i] = _NONE  # time of the last reading
            stamps[5 * i + 1] = _NONE  # tick at which it came
            stamps[5 * i + 2] = _INFINITE  # smallest time between two
            stamps[5 * i + 3] = _INFINITE  # smallest age by the reported time
            stamps[5 * i + 4] = _INFINITE  # and by the plan's
        return 0

    def skip(self):
        """Ticks were missed: what was kept is not one period apart."""
        self.ticks = 0

    def begin_support(self, right):
        """A single support begins, on the `right` sole or the left one."""
        self.stance = 2 if right else 1
        self.begun = False
        self.turn = 0.0
        self.turn_x = 0.0
        self.turn_y = 0.0

    def end_support(self):
        """A single support has ended: what it showed is usual from now on."""
        self.walked = True
        self.stance = 0
        self.largest_acceleration = max(self.largest_acceleration, self.recent_acceleration)
        self.largest_turn = max(self.largest_turn, self.recent_turn)
        self.largest_more = max(self.largest_more, self.recent_more)
        self.largest_less = max(self.largest_less, self.recent_less)
        self.recent_acceleration = 0.0
        self.recent_turn = 0.0
        self.recent_more = 0.0
        self.recent_less = 0.0

    def update(self, sensors, command, left_load, right_load, reported):
        """Take a tick's `sensors` and the `command` that answers them.

        `left_load`, `right_load`: force in N on the soles; `reported`: the tick's time in s as it came.

        Returns the sum of the codes of what is noticed, 0 for none.
        """
        found = self._noise(memory.values(sensors.joint_positions), memory.values(sensors.gyro))
        a = memory.values(sensors.accelerometer)
        state = command.state
        turn = memory.values(state.rotation_base_to_world)
        self._accelerate(memory.values(state.position_base), turn, a)
        pull = turn[6] * a[0] + turn[7] * a[1] + turn[8] * a[2]
        self._weigh(left_load + right_load, pull)
        self.ticks += 1
        readings = sensors.readings
        time = sensors.time
        found += self._age(0, readings["left"].time, time, reported)
        found += self._age(1, readings["right"].time, time, reported)
        return found + self._noticed() + self.turned(sensors, command, left_load, right_load)

    def turned(self, sensors, command, left_load, right_load):
        """`TURN` where the standing sole has turned by more than usual, else 0: of a tick's `sensors` and the `command`
        that answers them, and the force in N on the soles; `update` does this, too.
        """
        if self.stance == 0:
            return 0
        right = self.stance == 2
        side = "right" if right else "left"
        rotation = memory.values(command.state.rotations_sole[side])
        x = rotation[2] - self.normal_x
        y = rotation[5] - self.normal_y
        self.normal_x = rotation[2]
        self.normal_y = rotation[5]
        load = right_load if right else left_load
        if not self.begun or load < _CARRIES * self.mass * self.gravity:
            self.begun = True
            return 0
        force = sensors.readings[side].force
        count = self.right_count if right else self.left_count
        positions = memory.values(self.right_positions if right else self.left_positions)
        even = memory.values(self.right_even if right else self.left_even)
        if memory.size(force) != count or not _is_flat(positions, even, memory.values(force), count):
            return 0
        self.turn_x += x
        self.turn_y += y
        self.turn = math.hypot(self.turn_x, self.turn_y)
        if self.turn > self.least_turn + self.share * self.largest_turn:
            return TURN
        self.recent_turn = max(self.recent_turn, self.turn)
        return 0

    def _age(self, side, stamp, time, reported):
        """`LATE` where a sole's readings come later than they did, `SELDOM` where none has come for too long, else 0.

        They have to be late by the `reported` time in s and by that of the plan, in s: after a stall the plan's is
        behind, and a clock that stood still makes all that comes after it late.
        """
        stamps = memory.room(self.stamps)
        later = memory.room(self.later)
        late = memory.room(self.late)
        k = 5 * side
        gap = time - stamps[k + 1]
        if stamp == stamps[k]:
            if gap > self.older + 2.0 * stamps[k + 2]:
                later[side] = gap
                return SELDOM << side
            return 0
        stamps[k] = stamp
        stamps[k + 1] = time
        if gap < stamps[k + 2]:
            stamps[k + 2] = gap
        stamps[k + 3] = min(stamps[k + 3], reported - stamp)
        stamps[k + 4] = min(stamps[k + 4], time - stamp)
        later[side] = min(reported - stamp - stamps[k + 3], time - stamp - stamps[k + 4])
        late[side] = late[side] + 1.0 if later[side] > self.older else 0.0
        return LATE << side if late[side] >= self.readings else 0

    def _noise(self, q, w):
        """Means of the second differences, of what came one period apart; the codes of those that are too large."""
        n = self.joints
        kept = memory.room(self.kept)
        loads = memory.room(self.loads)
        ticks = self.ticks
        many = 0.0
        for i in range(n):
            if math.fabs(q[i] - 2.0 * kept[i] + kept[n + i]) > self.encoder_noise:
                many += 1.0
            kept[n + i] = kept[i]
            kept[i] = q[i]
        spread = 0.0
        for i in range(2 * n, 2 * n + 3):
            spread += math.fabs(w[i - 2 * n] - 2.0 * kept[i] + kept[i + 3])
            kept[i + 3] = kept[i]
            kept[i] = w[i - 2 * n]
        many = many / n if ticks >= 2 else 0.0
        # nature: three axes
        spread = min(spread / 3.0, _MOST_JITTER) if ticks >= 2 else 0.0
        at = 4 * (ticks % self.short)
        if ticks == 0:
            self.sum_joints = 0.0
            self.sum_gyro = 0.0
        elif ticks >= self.short:
            self.sum_joints -= loads[at + 2]
            self.sum_gyro -= loads[at + 3]
        if not many >= 0.0:
            many = 0.0
        if not spread >= 0.0:
            spread = 0.0
        loads[at + 2] = many
        loads[at + 3] = spread
        self.sum_joints += many
        self.sum_gyro += spread
        found = 0
        if self.sum_gyro > self.gyro_noise * self.short:
            found += GYRO_NOISE
        if self.sum_joints > self.noisy * self.short:
            found += ENCODER_NOISE
        return found

    def _accelerate(self, x, turn, a):
        """The accelerometer's mean in the window less that of the base's motion.

        With s the position less the twice integrated specific force, that is the second difference of s.
        """
        dt = self.period
        places = memory.room(self.places)
        window = self.window
        mean = self.mean
        size = window + mean
        ticks = self.ticks
        if ticks == 0:
            self.speed_x = 0.0
            self.speed_y = 0.0
            self.way_x = 0.0
            self.way_y = 0.0
        self.speed_x += dt * (turn[0] * a[0] + turn[1] * a[1] + turn[2] * a[2])
        self.speed_y += dt * (turn[3] * a[0] + turn[4] * a[1] + turn[5] * a[2])
        self.way_x += dt * self.speed_x
        self.way_y += dt * self.speed_y
        now_x = x[0] - self.way_x
        now_y = x[1] - self.way_y
        self.acceleration = 0.0
        at = 2 * (ticks % size)  # where the oldest is, `size` ticks ago
        if ticks >= size:
            near = 2 * ((ticks - mean) % size)
            far = 2 * ((ticks - window) % size)
            share = 1.0 / (mean * dt * window * dt)
            dx = share * ((now_x - places[near]) - (places[far] - places[at]))
            dy = share * ((now_y - places[near + 1]) - (places[far + 1] - places[at + 1]))
            self.acceleration = math.hypot(dx, dy)
        places[at] = now_x
        places[at + 1] = now_y

    def _weigh(self, load, pull):
        """The soles' load over the mass times the vertical specific force."""
        loads = memory.room(self.loads)
        short = self.short
        ticks = self.ticks
        at = 4 * (ticks % short)
        if ticks == 0:
            self.sum_load = 0.0
            self.sum_pull = 0.0
        elif ticks >= short:
            self.sum_load -= loads[at]
            self.sum_pull -= loads[at + 1]
        loads[at] = load
        loads[at + 1] = pull
        self.sum_load += load
        self.sum_pull += pull
        self.load = 1.0
        if ticks >= short:
            self.load = self.sum_load / (self.mass * max(self.sum_pull, _LEAST_PULL * short))

    def _noticed(self):
        """The codes of what is more than usual, and learn what is not."""
        found = 0
        share = self.share
        if self.acceleration > self.least_acceleration + share * self.largest_acceleration:
            found += ACCELERATION
        else:
            self.recent_acceleration = max(self.recent_acceleration, self.acceleration)
        least = self.least_load if self.walked else self.first_load
        more = self.load - 1.0
        if more > least + share * self.largest_more or -more > least + share * self.largest_less:
            found += LOAD
        else:
            self.recent_more = max(self.recent_more, more)
            self.recent_less = max(self.recent_less, -more)
        return found


def _is_flat(positions, even, force, count):
    """Whether a sole's load spreads in every direction: by its covariance, less a share of that of an `even` one."""
    load = 0.0
    x = 0.0
    y = 0.0
    xx = 0.0
    xy = 0.0
    yy = 0.0
    for i in range(count):
        f = force[i]
        if f > 0.0:  # and is a number
            fx = f * positions[2 * i]
            fy = f * positions[2 * i + 1]
            load += f
            x += fx
            y += fy
            xx += fx * positions[2 * i]
            xy += fx * positions[2 * i + 1]
            yy += fy * positions[2 * i + 1]
    if load <= 0.0:
        return False
    x /= load
    y /= load
    xx = xx / load - x * x - even[0]
    xy = xy / load - x * y - even[1]
    yy = yy / load - y * y - even[2]
    return xx > 0.0 and xx * yy > xy * xy


def _spread(positions, share):
    """Covariance (xx, xy, yy) in m^2 of an even load on taxels (n, 2) in m, times the square of a `share`."""
    centered = positions - positions.mean(axis=0)
    squares = share * share / len(positions) * (centered.T @ centered)
    return np.array([squares[0, 0], squares[0, 1], squares[1, 1]])
