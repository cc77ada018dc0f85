"""DSP-Opt: double support's length for the DCM to reach the next single support's start (K 34-38).

The DCM at its end T (K 34; x = T - T_c, u* the VRP now, p of `ankle_strategy.double_support_pull`) is

    xi(T) = u_e - u_w + e^(w x) (xi_c - u_e + u_w + (u_e - u*) p(x, T)).

The cost need not be convex: it is sampled, and its derivative's zero bracketed.
"""

import math
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arrays import array
from plantar.common.settings.part import Part
from plantar.common.settings.schema import number
from plantar.errors import InputError
from plantar.gait.balance.ankle_strategy import MOST_GROWTH, NODES, SHORTEST_TIME, WEIGHTS, double_support_pull

_SAMPLES = np.linspace(0.0, 1.0, 33)  # chosen: tests compare with a dense scan
_LEVELS = 6  # derived: each with samples 16 times as close as the one before; 16^-6, a rounding of single precision
_SMALL = 1e-3  # nature: 1 - cos(w_d x) below which the closed form of the pull cancels too many digits
_TURNS = 100  # derived: far more than any bracket takes, halved now and then, to come to its last bit


class DspWeights(
    Part, table="dsp_weights", needs={"control.step_adjustment": (True,), "step_adjustment.double_support": (True,)}
):
    """Weights of a double support change (K Table 1).

    Attributes:
        dynamics: w_d of the final DCM error.
        nominal: w_n of the difference from nominal, times confidence.
        smooth: w_s of the difference from the last tick, times 1 - confidence.
        longer: Factor w_+ on longer durations.
        least: gamma_min, share of the nominal duration.
        most: gamma_max, share of the nominal duration.
    """

    dynamics: float = number(15.0, "1", 1e-3, 1e6)  # nature: K Table 1
    nominal: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1
    smooth: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1
    longer: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1
    shorter: ClassVar[float] = 5.0  # Factor w_- on shorter durations; nature: K Table 1
    least: float = number(0.5, "1", 0.0, 1.0)  # nature: K Table 1
    most: float = number(5.0, "1", 1.0, 100.0)  # nature: K Table 1


class DspProblem(NamedTuple):
    """A double support now, world frame.

    Attributes:
        omega: Pendulum's in rad/s.
        dcm: xi_c (2,) in m.
        goal: xi_d (2,) in m at the next single support's start.
        vrp: u* (2,) in m now, cut to the support.
        end: u_e (2,) in m, middle of the next carrying foot.
        offset: Push's u_w (2,) on the VRP in m.
        elapsed: T_c since its start in s.
        target: Last tick's T_d in s.
        nominal: T_d in s, above 0.
        confidence: c: 1 keeps the nominal duration, 0 the last tick's.
    """

    omega: float
    dcm: ArrayLike
    goal: ArrayLike
    vrp: ArrayLike
    end: ArrayLike
    offset: ArrayLike
    elapsed: float
    target: float
    nominal: float
    confidence: float = 0.0


class DspSolution(NamedTuple):
    """The best duration.

    `time`: T_d in s; `missed`: final DCM error (2,) in m; `at_bound`: -1 at the shortest, 1 at the longest, else 0;
    `residual`: cost slope in an allowed direction, relative to its largest term.
    """

    time: float
    missed: NDArray[np.float64]
    at_bound: int
    residual: float


def solve_dsp(problem: DspProblem, weights: DspWeights) -> DspSolution:
    """Best double support duration (K 37-38); past the longest it ends now.

    Example:
        The DCM lags behind: the double support lasts longer.

        >>> late = DspProblem(3.44, [0.16, 0.0], [0.23, 0.0], [0.06, 0.0], [0.2, 0.0], [0.0, 0.0], 0.1, 0.2, 0.2)
        >>> found = solve_dsp(late, DspWeights())
        >>> round(found.time, 4), found.at_bound, found.residual < 1e-8
        (0.3437, 0, True)
    """
    if not (0.0 < problem.omega < math.inf and 0.0 < problem.nominal < math.inf):
        raise InputError(
            f"pendulum frequency and nominal duration are {problem.omega} rad/s and {problem.nominal} s; "
            "allowed: finite values above 0"
        )
    cost = _Cost(problem, weights)
    low = max(weights.least * problem.nominal, problem.elapsed + SHORTEST_TIME)
    high = min(weights.most * problem.nominal, problem.elapsed + MOST_GROWTH / problem.omega)
    if high <= low:
        return DspSolution(low, np.array(cost.slope(low)[2]), 1, 0.0)  # no direction is allowed
    left = low
    right = high
    for _ in range(_LEVELS):
        times = left + (right - left) * _SAMPLES
        k = int(cost.values(times).argmin())
        left = float(times[max(k - 1, 0)])
        right = float(times[min(k + 1, len(times) - 1)])
        at_left = cost.slope(left)[0]
        at_right = cost.slope(right)[0]
        if at_left < 0.0 < at_right:
            return _solution(cost, _zero(cost, left, right, at_left, at_right), 0)
        if at_left >= 0.0 and left == low:
            return _solution(cost, low, -1)
        if at_right <= 0.0 and right == high:
            return _solution(cost, high, 1)
        # Next to the least sample the cost falls away from it: there is another minimum between, to be sampled finer.
    return _solution(cost, float(times[k]), 0)


def _solution(cost: "_Cost", time: float, bound: int) -> DspSolution:
    slope, size, missed = cost.slope(time)
    left = abs(slope) if bound == 0 else max(0.0, -slope if bound < 0 else slope)
    return DspSolution(time, np.array(missed), bound, left / max(size, 1e-300))  # nature: floating point: 0 / 0 is 0


def _zero(cost: "_Cost", low: float, high: float, at_low: float, at_high: float) -> float:
    """Zero of the slope between ends of opposite sign (Chandrupatla, Advances in Engineering Software 28, 1997)."""
    a = low
    b = high
    fa = at_low
    fb = at_high
    share = fa / (fa - fb)
    best = b
    for _ in range(_TURNS):
        time = a + share * (b - a)
        slope, size, _ = cost.slope(time)
        best = time
        if abs(slope) <= 1e-12 * size:  # nature: floating point, 5000 roundings of a slope
            break
        c = a
        fc = fa
        if (slope > 0.0) != (fa > 0.0):
            c = b
            fc = fb
            b = a
            fb = fa
        a = time
        fa = slope
        if abs(b - a) <= 4e-16 * abs(b):  # nature: floating point, two roundings
            break
        xi = (a - b) / (c - b)
        phi = (fa - fb) / (fc - fb)
        share = 0.5
        if phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi:
            share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    return best


class _Cost:
    """Cost of a duration (K 35-37) and its derivative."""

    def __init__(self, problem: DspProblem, weights: DspWeights) -> None:
        x, y = array(problem.dcm, "DCM", (2,), finite=True).tolist()
        gx, gy = array(problem.goal, "goal of the DCM", (2,), finite=True).tolist()
        px, py = array(problem.vrp, "VRP", (2,), finite=True).tolist()
        ex, ey = array(problem.end, "end of the VRP", (2,), finite=True).tolist()
        ox, oy = array(problem.offset, "VRP offset", (2,), finite=True).tolist()
        self._omega = problem.omega
        self._elapsed = problem.elapsed
        self._dynamics = weights.dynamics
        self._begun = (x - ex + ox, y - ey + oy)
        self._ahead = (ex - px, ey - py)
        self._goal = (gx - ex + ox, gy - ey + oy)
        self._both = np.array((self._begun, self._ahead, self._goal))[:, :, None]
        c = min(max(problem.confidence, 0.0), 1.0)
        self._kept = (
            (c * weights.nominal, problem.nominal),
            ((1.0 - c) * weights.smooth, problem.target),
        )
        self._longer = weights.longer
        self._shorter = weights.shorter

    def slope(self, time: float) -> tuple[float, float, tuple[float, float]]:
        """Cost's derivative, its largest term's size, and the missed DCM."""
        w = self._omega
        ax, ay = self._begun
        bx, by = self._ahead
        left = time - self._elapsed
        grown = math.exp(min(w * left, MOST_GROWTH))
        pull, rate = _pull_and_rate(w, time, left)
        mx = ax + bx * pull
        my = ay + by * pull
        missed = (grown * mx - self._goal[0], grown * my - self._goal[1])
        dx = grown * (w * mx + bx * rate)
        dy = grown * (w * my + by * rate)
        total = self._dynamics * (missed[0] * dx + missed[1] * dy)
        size = self._dynamics * (abs(missed[0] * dx) + abs(missed[1] * dy))
        for weight, kept in self._kept:
            part = weight * (self._longer if time >= kept else self._shorter) * (time - kept)
            total += part
            size += abs(part)
        return total, size, missed

    def values(self, times: NDArray[np.float64]) -> NDArray[np.float64]:
        w = self._omega
        left = times - self._elapsed
        rate = (0.5 * math.pi) / times
        angle = rate * left
        cosine = np.cos(angle)
        decayed = np.exp(-w * left)
        c = w / (w * w + rate * rate)
        turned = c * (w * (cosine - decayed) + rate * np.sin(angle))
        # The first sample may lie where all of this cancels.
        cosine[0] = 0.0
        pull = (1.0 - decayed - turned) / (1.0 - cosine)
        pull[0] = double_support_pull(w, float(times[0]), float(left[0]))
        missed = (self._both[0] + self._both[1] * pull) / decayed - self._both[2]
        total: NDArray[np.float64] = (0.5 * self._dynamics) * (missed * missed).sum(axis=0)
        for weight, kept in self._kept:
            if weight > 0.0:
                off = times - kept
                off *= off
                total += off * np.where(times >= kept, 0.5 * weight * self._longer, 0.5 * weight * self._shorter)
        return total


def _pull_and_rate(omega: float, time: float, left: float) -> tuple[float, float]:
    """A VRP's pull over the rest of a double support, and its derivative by duration."""
    rate = 0.5 * math.pi / time
    angle = rate * left
    turning = rate * (1.0 - left / time)  # of the angle, by the duration
    half = math.sin(0.5 * angle) ** 2
    if 2.0 * half < _SMALL:
        return _pull_and_rate_near_the_end(omega, left, angle, turning)
    cosine = math.cos(angle)
    sine = math.sin(angle)
    decayed = math.exp(-omega * left)
    square = omega * omega + rate * rate
    c = omega / square
    slower = -rate / time  # of w_d
    c_rate = -2.0 * c * rate * slower / square
    kept = 1.0 - omega * c
    swing = omega * cosine + rate * sine
    whole = 1.0 - c * swing - decayed * kept
    swing_rate = turning * (rate * cosine - omega * sine) + slower * sine
    whole_rate = -c_rate * swing - c * swing_rate + decayed * (omega * kept + omega * c_rate)
    pull = whole / (2.0 * half)
    return pull, (whole_rate - pull * sine * turning) / (2.0 * half)


_SHARES = (0.5 * (NODES + 1.0)).tolist()  # derived: the nodes on 0 to 1
_PARTS = (0.5 * WEIGHTS).tolist()  # derived: their weights there


def _pull_and_rate_near_the_end(omega: float, left: float, angle: float, turning: float) -> tuple[float, float]:
    """The same by ten nodes, where the closed form cancels."""
    bottom = math.sin(0.5 * angle)
    back = 1.0 / math.tan(0.5 * angle)
    exponent = omega * left
    pull = 0.0
    slower = 0.0
    turned = 0.0
    for v, part in zip(_SHARES, _PARTS, strict=True):
        term = part * math.exp(-exponent * (1.0 - v)) * (math.sin(0.5 * angle * v) / bottom) ** 2
        pull += term
        slower += term * (1.0 - v)
        turned += term * (v / math.tan(0.5 * angle * v) - back)
    return exponent * pull, omega * pull - omega * exponent * slower + exponent * turned * turning
