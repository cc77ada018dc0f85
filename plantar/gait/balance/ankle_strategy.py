"""Closed-form ankle strategy: VRP that brings the DCM to the next phase's start (K 17-27).

With a push's offset u_w, xi' = w (xi - u_ref + u_w); the reference VRP moves from u_i (single support) to u_e in double
support (K 17). Times are at least `SHORTEST_TIME`, growth at most e^`MOST_GROWTH`.
"""

import math
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import choice, switch
from plantar.common.settings.schema import number as number_setting
from plantar.geometry.polygon import closest_point

SHORTEST_TIME = 1e-6
"""Time in s in which the DCM shall reach its target at least. Derived: 1/5000 of a control period, so that no division
by it overflows."""

MOST_GROWTH = 100.0
"""Derived: largest exponent w t: a nanometre that has grown by e^100 is 1e34 m, so no two differ beyond it, and no
product of a few such numbers overflows."""

# nature: ten nodes integrate polynomials up to order 19, here the last digit of the pull where w t < 3
NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)


class AnkleRules(Part, table="ankle_strategy", needs={"control.step_adjustment": (True,)}):
    """How ankles balance, and their polygon share before steps change (K 27).

    Attributes:
        law: "tracking" feeds back the DCM error (T 4.28); "regulation" applies the VRP that reaches the goal by the
            phase's end, and changes steps only beyond the share (K 25-27).
        forward: Share beta_x of the polygon along the sole (K Table 1).
        sideways: Share beta_y across it.
        confident: Whether confidence enlarges the shares, up to the whole polygon; constant in K.
    """

    law: str = choice("tracking", "regulation")
    forward: float = number_setting(0.5, "1", 0, 1)  # nature: K Table 1
    sideways: float = number_setting(0.8, "1", 0, 1)  # nature: K Table 1
    confident: bool = switch(True)


class Saturation(StrEnum):
    """What limited a VRP."""

    NONE = "none"
    TIME = "shortest time"
    SUPPORT = "support polygon"


class AnkleVrp(NamedTuple):
    """VRP of the ankle strategy. `vrp`: u_ref (2,) in m; `gain`: derivative by the DCM, on both axes; above 1."""

    vrp: NDArray[np.float64]
    gain: float
    saturated: Saturation = Saturation.NONE


class TargetDcms(NamedTuple):
    """Desired DCM at the ends of the phases (K 21-24).

    `double_end`: xi_d (2,) in m; `single_end`: xi_s (2,) in m; `slope`: d xi_s / d u_e, on both axes.
    """

    double_end: NDArray[np.float64]
    single_end: NDArray[np.float64]
    slope: float


def target_dcms(
    place: ArrayLike,
    stance: ArrayLike,
    next_stride: ArrayLike,
    next_duration: float,
    double_support: float,
    offset: ArrayLike,
    omega: float,
) -> TargetDcms:
    """DCM at a step's end from which the next rests over its foot (K 21-24).

    K 22 ends the second step at u_n - u_w, not u_n as in the text: only that gives b_e in K 20 (corrected).

    Args:
        place: u_e (2,), touchdown, in m.
        stance: u_i (2,) in m.
        next_stride: s_n (2,) from `place` to the next footstep in m.
        next_duration: T_n of its single support in s, 0 or more.
        double_support: T_d in s, 0 or more; 0 transfers at once.
        offset: Push's u_w (2,) in m.
        omega: Pendulum's in rad/s.
    """
    end = np.asarray(place, dtype=float)
    start = np.asarray(stance, dtype=float)
    stride = np.asarray(next_stride, dtype=float)
    push = np.asarray(offset, dtype=float)
    ahead = stride * math.exp(-omega * max(next_duration, 0.0)) - push  # b_e
    if double_support <= 0.0:
        return TargetDcms(end + ahead, end + ahead, 1.0)
    kept = math.exp(-omega * double_support)
    swayed = sway_share(omega, double_support)
    single = end + ahead * kept - push * (1.0 - kept) + (end - start) * swayed
    return TargetDcms(end + ahead, single, 1.0 + swayed)


def sway_share(omega: float, double_support: float) -> float:
    """Share -1..0 of u_e - u_i for gradual VRPs (K 24), e^(-w T_d) (1 - C_d w) - (1 - C_d w_d).

    `omega`: pendulum's in rad/s; `double_support`: T_d in s, 0 or more. Returns the share.

    Example:
        >>> round(sway_share(3.5, 0.2), 4), sway_share(3.5, 0.0)
        (-0.2139, 0.0)
    """
    if double_support <= 0.0:
        return 0.0
    rate = 0.5 * math.pi / double_support
    c = omega / (omega * omega + rate * rate)
    return math.exp(-omega * double_support) * (1.0 - c * omega) - (1.0 - c * rate)


def single_support_vrp(dcm: ArrayLike, target: ArrayLike, left: float, offset: ArrayLike, omega: float) -> AnkleVrp:
    """VRP for a target DCM at single support's end (K 25), unlimited (see `within_support`).

    `dcm` (2,) in m; `target`: xi_s (2,) in m; `left` in s, at least `SHORTEST_TIME`; `offset`: push's u_w (2,) in m;
    `omega`: pendulum's in rad/s.
    """
    now = np.asarray(dcm, dtype=float)
    goal = np.asarray(target, dtype=float)
    push = np.asarray(offset, dtype=float)
    exponent = -omega * max(left, SHORTEST_TIME)
    kept = math.exp(exponent)
    gain = -1.0 / math.expm1(exponent)
    # xi_c + u_w + (xi_c - xi_s) e^(-w T) / (1 - e^(-w T)): K 25 less what cancels.
    vrp = now + push + (now - goal) * kept * gain
    return AnkleVrp(vrp, gain, Saturation.TIME if left < SHORTEST_TIME else Saturation.NONE)


def double_support_vrp(
    dcm: ArrayLike,
    target: ArrayLike,
    end: ArrayLike,
    duration: float,
    begun: float,
    offset: ArrayLike,
    omega: float,
) -> AnkleVrp:
    """VRP now for a target DCM at double support's end (K 25-26), along K 17; unlimited.

    Args:
        dcm: (2,) in m.
        target: xi_d (2,) in m.
        end: u_e (2,), middle of the next carrying foot, in m.
        duration: T_d in s.
        begun: T_c since its begin in s; at least `SHORTEST_TIME` before its end.
        offset: Push's u_w (2,) in m.
        omega: Pendulum's in rad/s.
    """
    now = np.asarray(dcm, dtype=float)
    goal = np.asarray(target, dtype=float)
    rest = np.asarray(end, dtype=float) - np.asarray(offset, dtype=float)
    left = max(duration - begun, SHORTEST_TIME)
    kept = math.exp(-omega * left)
    gain = 1.0 / double_support_pull(omega, max(duration, left), left)
    vrp = np.asarray(end, dtype=float) - (kept * (goal - rest) - (now - rest)) * gain
    return AnkleVrp(vrp, gain, Saturation.TIME if duration - begun < SHORTEST_TIME else Saturation.NONE)


def double_support_pull(omega: float, duration: float, left: float) -> float:
    """DCM displacement in m, times e^(-w left), by a VRP 1 m before u_e along K 17.

    Integral of w e^(-w s) q(s), q from 1 to 0 as 1 - sin(w_d t); no 0 / 0 as in K 25.

    `omega`: pendulum's in rad/s; `duration`: T_d in s; `left`: time to its end in s, above 0.
    """
    rate = 0.5 * math.pi / duration
    half = math.sin(0.5 * rate * left) ** 2
    if omega * left < 3.0:  # derived: the closed form loses e^-3 of its digits there, below it more
        # The closed form below cancels its digits here, and ten nodes integrate the smooth integrand to the last.
        rest = 0.5 * left * (1.0 - NODES)
        total = float(WEIGHTS @ (np.exp(-omega * (left - rest)) * np.sin(0.5 * rate * rest) ** 2))
        return 0.5 * left * omega * total / half
    c = omega / (omega * omega + rate * rate)
    turned = c * (omega * math.cos(rate * left) + rate * math.sin(rate * left))
    return (1.0 - turned - math.exp(-omega * left) * (1.0 - c * omega)) / (2.0 * half)


def shrunk_support(
    polygon: NDArray[np.float64], rules: AnkleRules, middle: ArrayLike, yaw: float = 0.0
) -> NDArray[np.float64]:
    """Ankle strategy's part (k, 2) in m of a support polygon, f(c) S, f(c) = (beta_x, beta_y) (K 27).

    `polygon`: S (k, 2), world, in m; `rules`: shares along and across the sole; `middle`: stance foot's (2,) in m,
    about which it shrinks; `yaw`: sole's heading in rad.
    """
    about = np.asarray(middle, dtype=float)
    c = math.cos(yaw)
    s = math.sin(yaw)
    f = rules.forward
    across = rules.sideways
    turn = (f - across) * c * s
    scale = np.array([[f * c * c + across * s * s, turn], [turn, f * s * s + across * c * c]])
    return np.asarray(about + (polygon - about) @ scale)


def within_support(wanted: AnkleVrp, support: ArrayLike) -> AnkleVrp:
    """A VRP, or the closest in the support polygon (`Saturation.SUPPORT`: only a step reaches the target, K 27).

    `support`: convex, shrunk (k, 2) in m; empty for no limit.
    """
    nearest = closest_point(support, wanted.vrp)
    if nearest is None or (nearest[0] == wanted.vrp[0] and nearest[1] == wanted.vrp[1]):
        return wanted
    return AnkleVrp(nearest, wanted.gain, Saturation.SUPPORT)
