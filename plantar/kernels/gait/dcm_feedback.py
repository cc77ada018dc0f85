"""DCM feedback: desired ZMP, and admittance of the CoM reference (sources: `plantar.gait.balance`)."""

import math

from ..base import memory, vectors
from ..geometry import convex

__all__ = ["ComAdmittance", "DcmFeedback", "shared_load"]


class ComAdmittance:
    """Offset of the CoM reference from the plan (T 4.29): x, y in m, rates in m/s.

    `zmp_gain`: k_f in 1/s, from ZMP error to rate; `com_gain`: k_x in 1/s, rate of return to plan; `zmp_filter`: time
    constant in s of low-pass on ZMP error; `period`: control period in s; `largest`: largest offset in m.
    """

    def __init__(self, zmp_gain, com_gain, zmp_filter, period, largest=math.inf):
        self.x = 0.0
        self.y = 0.0
        self.rate_x = 0.0
        self.rate_y = 0.0
        # filtered
        self.error_x = 0.0
        self.error_y = 0.0
        self.zmp_gain = zmp_gain
        self.com_gain = com_gain
        self.share = period / (zmp_filter + period)
        self.period = period
        self.largest = largest

    @property
    def offset(self):
        """Offset (2,) in m."""
        return vectors.vector2(self.x, self.y)

    def update(self, error):
        """Advance by a tick with a ZMP error (2,) in m, measured less desired; zeros without load."""
        self.follow(error[0], error[1])

    def follow(self, x, y):
        """As `update`, with plain numbers."""
        # Keeps the noise of the taxels out of the CoM's reference.
        self.error_x += self.share * (x - self.error_x)
        self.error_y += self.share * (y - self.error_y)
        # The second term brings the CoM back onto the plan; without it a bias of the ZMP would add up to a drift.
        self.rate_x = self.zmp_gain * self.error_x - self.com_gain * self.x
        self.rate_y = self.zmp_gain * self.error_y - self.com_gain * self.y
        self.x += self.period * self.rate_x
        self.y += self.period * self.rate_y
        size = math.sqrt(self.x * self.x + self.y * self.y)
        if size > self.largest:
            self.x = self.x * (self.largest / size)
            self.y = self.y * (self.largest / size)


class DcmFeedback:
    """Desired ZMP and CoM reference at each tick.

    Args:
        omega: Pendulum frequency in rad/s.
        gain: k_xi of T 4.28 in 1/s.
        period: Control period in s.
        after: Whether acceleration uses offset after this tick, or before.
        held: Largest ZMP offset in m by ankles; for more the CoM reference goes along.
        press: Its rate in 1/s from ZMP error then.
    """

    def __init__(self, omega, gain, period, admittance, after, held=math.inf, press=0.0):
        self.omega = omega
        self.held = held
        self.press = press
        self.factor = 1.0 + gain / omega
        self.period = period
        self.admittance = admittance
        self.after = after
        self.away_x = 0.0
        self.away_y = 0.0

    def decide(self, vrp, planned, com, com_velocity, dcm, zmp, region, firm):
        """Advance by a tick: desired ZMP p_r + (1 + k_xi / w) (xi - xi_r), kept in a region (T 4.28,
        Algorithm 1), and CoM reference (T 4.29).

        `vrp`: planned VRP (2,) in m; `planned` DCM and `com` likewise; `com_velocity`: planned velocity (2,) of CoM in
        m/s; `dcm`: measured DCM (2,) in m; `zmp`: measured ZMP (2,) in m; None without load; `region`: convex polygon
        (k, 2) in m; empty for no limit; `firm`: whether a step can catch a fall, so that the CoM may go along. Returns
        desired ZMP (2,) in m; CoM reference (2,) in m, its velocity in m/s and acceleration in m/s^2.
        """
        offset = self.admittance
        at = memory.values(com)
        velocity = memory.values(com_velocity)
        x, y = self._desired(memory.values(vrp), memory.values(planned), memory.values(dcm), region)
        cx = at[0] + offset.x + self.away_x
        cy = at[1] + offset.y + self.away_y
        if zmp is None:
            offset.follow(0.0, 0.0)
        else:
            now = memory.values(zmp)
            offset.follow(now[0] - x, now[1] - y)
        rx, ry = self._go_along(memory.values(planned), memory.values(dcm), firm and len(region) > 0)
        px = at[0] + offset.x + self.away_x
        py = at[1] + offset.y + self.away_y
        if self.after:
            cx = px
            cy = py
        # The linear inverted pendulum, w^2 (c - p): what the feet should give, not the derivative of the offset.
        stiffness = self.omega * self.omega
        return (
            vectors.vector2(x, y),
            vectors.vector2(px, py),
            vectors.vector2(velocity[0] + offset.rate_x + rx, velocity[1] + offset.rate_y + ry),
            vectors.vector2(stiffness * (cx - x), stiffness * (cy - y)),
        )

    def _go_along(self, planned, dcm, may):
        """Rate in m/s of the CoM reference along a fall."""
        # A pendulum whose DCM is off by e leaves its plan with c' = w (e - c). Stiff joints would hold the posture, and
        # the whole body would tip over the stance foot's edge: no foot would land flat. What the ankle brings back is
        # left to it. Along the fall any ZMP fits, so the second term asks for the desired one.
        ex = dcm[0] - planned[0]
        ey = dcm[1] - planned[1]
        size = self.factor * math.sqrt(ex * ex + ey * ey)
        rx = -self.omega * self.away_x
        ry = -self.omega * self.away_y
        if may and size > self.held:
            share = 1.0 - self.held / size
            offset = self.admittance
            rx += share * (self.omega * ex + self.press * offset.error_x)
            ry += share * (self.omega * ey + self.press * offset.error_y)
        self.away_x += self.period * rx
        self.away_y += self.period * ry
        return rx, ry

    def _desired(self, vrp, planned, dcm, region):
        """Desired ZMP's two numbers."""
        ex = dcm[0] - planned[0]
        ey = dcm[1] - planned[1]
        x = vrp[0] + self.factor * ex
        y = vrp[1] + self.factor * ey
        if not len(region):
            return x, y
        # No foot can press outside its contact: what is wanted there is cut to what the ground can give.
        return convex.nearest(region, x, y)


_LEFT = 1  # nature: a bit of its own for each foot
_RIGHT = 2  # nature: a bit of its own for each foot


def shared_load(zmp, acceleration, mass, gravity, left, right, stance):
    """Share the pendulum's force, m (a_x, a_y, g), between two feet.

    `zmp`: desired ZMP (2,) in m; `acceleration`: acceleration (2,) of CoM in m/s^2; `mass`: mass m in kg; `gravity`: g
    in m/s^2; `left`: left foot: `position` (3,) in m and `rotation` (3, 3) of its sole frame, `center` (2,) to load;
    `right` likewise; `stance`: only carrying foot: 1 left, 2 right, 0 for none. Returns force (3,) on left foot in N,
    where it acts (2,) in m; right likewise.
    """
    goal = memory.values(zmp)
    rate = memory.values(acceleration)
    lx, ly = _loaded(left)
    rx, ry = _loaded(right)
    x = goal[0]
    y = goal[1]
    if stance == _LEFT:
        share = 1.0
    elif stance == _RIGHT:
        share = 0.0
    else:
        dx = lx - rx
        dy = ly - ry
        apart = dx * dx + dy * dy
        share = min(1.0, max(0.0, ((x - rx) * dx + (y - ry) * dy) / apart)) if apart > 0.0 else 0.5
    other = 1.0 - share
    fx = mass * rate[0]
    fy = mass * rate[1]
    fz = mass * gravity
    x = x - (share * lx + other * rx)
    y = y - (share * ly + other * ry)
    return (
        vectors.vector(share * fx, share * fy, share * fz),
        vectors.vector2(lx + x, ly + y),
        vectors.vector(other * fx, other * fy, other * fz),
        vectors.vector2(rx + x, ry + y),
    )


def _loaded(foot):
    place = memory.values(foot.position)
    turn = memory.values(foot.rotation)
    middle = memory.values(foot.center)
    x = middle[0]
    y = middle[1]
    return place[0] + (turn[0] * x + turn[1] * y), place[1] + (turn[3] * x + turn[4] * y)
