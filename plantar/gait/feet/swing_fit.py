"""Swing path as a polynomial, fitted each tick to its landing (K 13-16).

Ridge regression (K 14) of the reference before, without the measured places that K has too, exact at both ends, or with
`ends` "printed" as K 16, which overwrites two coefficients; time is a share of the swing, the reference kept monotone
(K 2.4).
"""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.record import Record
from plantar.common.settings.schema import choice, number, whole
from plantar.gait.feet.swing_flight import PolynomialSwing, SwingFlight
from plantar.gait.feet.swing_kind import Swing, SwingKind, SwingStart
from plantar.kernels.gait.swing_fit import fit


class SwingFitRules(SwingKind, table="swing_fit", needs={"control.swing_shape": ("fit",)}):
    """What a swing path is fitted to (K Table 1).

    Attributes:
        order: n of the polynomial.
        damping: lambda on the coefficients' squares; the paper's 0.01 lands at 0.15 m/s.
        position: sigma_pos on position; on velocity and acceleration times the control period, counted in swings, and
            its square.
        ends: "kept" fits through both ends; "printed" weighs them like other conditions (K 14) and then overwrites the
            first and the last coefficient (K 16), which flattens the swing.
    """

    ends: str = choice("kept", "printed")
    order: int = whole(6, "1", 5, 9)  # nature: K Table 1
    # chosen: K Table 1 has 0.01 for poses in metres; here a share of the data
    damping: float = number(1e-6, "1", 1e-9, 1e3)
    position: float = number(1.0, "1", 1e-9, 1e3)  # nature: K Table 1
    # gamma: share of the swing after which, and before whose end, it is that high
    height_share: ClassVar[float] = 1.0 / 3.0  # nature: K Table 1

    def begin(self, start: SwingStart) -> Swing:
        """Fitted swing, or polynomials if it has to rise first."""
        flight = PolynomialSwing().begin(start)
        if start.rises_first:
            return flight
        fit = SwingFit(self, start.position, start.period, start.height)
        return _FittedSwing(**vars(flight), fit=fit)


class SwingPoint(Record, frozen=True):
    """Swing foot's desired position (3,) in m, velocity in m/s, acceleration in m/s^2."""

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]


class SwingFit:
    """Path of one swing. `start`: sole (3,) at lift-off in m; `period` of control in s; `height`: delta z in m.

    Example:
        A step of 0.2 m whose goal moves by 0.1 m to the side half-way:

        >>> fit, path = SwingFit(SwingFitRules(), [0.0, 0.0, 0.0], 0.005, 0.05), []
        >>> for k in range(1, 161):
        ...     path.append(fit.aim([0.2, 0.0 if k < 80 else 0.1, 0.0], 0.005 * k, 0.8).position)
        >>> path[-1].round(4).tolist(), round(float(np.max(path, axis=0)[2]), 3)
        ([0.2, 0.1, 0.0], 0.063)
    """

    def __init__(self, rules: SwingFitRules, start: ArrayLike, period: float, height: float) -> None:
        self._period = period
        self._rules = rules
        self._height = height
        self._start: NDArray[np.float64] = np.array(start, dtype=float)
        self._state = np.array([self._start, np.zeros(3), np.zeros(3)])  # of the tick before
        self._falls = False
        n = rules.order
        # Conditions that every swing has, in shares of it: rest at both ends, and for z the two heights. With both ends
        # kept, a_n is the way less all others, which leaves a_1 to a_(n-1).
        g = rules.height_share
        weight = rules.position
        rests = [np.array([_rows(s, n)[d] for s in (0.0, 1.0)]) for d in (1, 2)]
        heights = np.array([_rows(s, n)[0] for s in (g, 1.0 - g)])
        # How they enter the normal equations: a matrix, and how height and way pull.
        high = weight * _reduced(heights).T @ np.column_stack([_reduced(heights), np.ones(2), -heights[:, n]])
        self._high = np.ascontiguousarray(high)
        # Damping, rest and no acceleration at the ends: their share of the matrix, and how they pull at a_n.
        same = [rules.damping * (np.eye(n - 1) + 1.0), *(weight * _reduced(r).T @ _reduced(r) for r in rests)]
        pulls = [np.full(n - 1, rules.damping), *(-weight * _reduced(r).T @ r[:, n] for r in rests)]
        self._same = np.array([np.column_stack(parts).ravel() for parts in zip(same, pulls, strict=True)])
        places = np.array([*(r for rest in rests for r in rest), *heights, _powers(0.0, n), _powers(1.0, n)])
        self._printed_rows = None if rules.ends == "kept" else places
        self._conditions = np.zeros((3, 4))
        self._work = np.zeros((6 + 2 * (n - 1), n + 1))

    def aim(self, goal: ArrayLike, elapsed: float, duration: float) -> SwingPoint:
        """Reference now towards a goal (K 13-16); at the goal after the duration.

        `goal`: landing place (3,) in m; `elapsed`: T_c since lift-off in s; a control period more each call;
        `duration`: T_s from lift-off to touchdown in s. Returns desired motion.
        """
        end = np.asarray(goal, dtype=float)
        if elapsed >= duration or duration <= 0.0:
            self._state = np.array([end, np.zeros(3), np.zeros(3)])
        else:
            fitted = self._fitted if self._printed_rows is None else self._printed
            found = fitted(end, elapsed, duration)
            self._keep_monotone(found, end, elapsed / duration)
            self._state = found
        return SwingPoint(*self._state.copy())

    @property
    def falls(self) -> float:
        """Downward speed in m/s at the last tick."""
        return -float(self._state[1, 2])

    def _fitted(self, end: NDArray[np.float64], now: float, lasts: float) -> NDArray[np.float64]:
        """Reference now (3, 3), a row a derivative."""
        rules = self._rules
        n = self._rules.order
        start = self._start
        conditions = self._conditions
        tick = self._period / lasts
        way = end - start
        units = np.array(((1.0,), (lasts,), (lasts * lasts,)))
        np.multiply(self._state, units, out=conditions[:, 1:])
        conditions[0, 1:] -= start
        conditions[:, 0] = rules.position, rules.position * tick, rules.position * tick * tick
        same = (np.array((1.0, tick, tick * tick)) @ self._same).reshape(n - 1, n)
        top = max(0.0, float(way[2])) + self._height
        found = np.empty((3, 3))
        before = max(now - self._period, 0.0) / lasts
        fit(n, now / lasts, before, conditions, same, self._high, top, way, self._work, found)
        found /= units
        found[0] += start
        return found

    def _printed(self, end: NDArray[np.float64], now: float, lasts: float) -> NDArray[np.float64]:
        """The same by K 14, all conditions weighed, and K 16, the way from the start in shares of the swing."""
        assert self._printed_rows is not None
        n = self._rules.order
        tick = self._period / lasts
        units = np.array(((1.0,), (lasts,), (lasts * lasts,)))
        way = end - self._start
        before = self._state * units
        before[0] -= self._start
        # At rest, without acceleration, twice at the height, at both ends, and where the reference was a tick ago.
        top = max(0.0, float(way[2])) + self._height
        values = np.vstack([np.zeros((4, 3)), np.full((2, 3), top), np.zeros(3), way, before])
        rows = np.vstack([self._printed_rows, _rows(max(now - self._period, 0.0) / lasts, n)])
        shares = np.array([tick, tick, tick**2, tick**2, 1.0, 1.0, 1.0, 1.0, 1.0, tick, tick**2])
        weights = self._rules.position * shares
        found = np.empty((3, 3))
        for axis in range(3):
            used = weights.copy()
            used[4:6] *= axis == 2
            matrix = (rows.T * used) @ rows + self._rules.damping * np.eye(n + 1)
            a = np.linalg.solve(matrix, (rows.T * used) @ values[:, axis])
            a[0] = 0.0
            a[n] = way[axis] - a[1:n].sum()
            found[:, axis] = np.array(_rows(now / lasts, n)) @ a
        found /= units
        found[0] += self._start
        return found

    def _keep_monotone(self, found: NDArray[np.float64], end: NDArray[np.float64], s: float) -> None:
        """Limit a reference that would turn or pass its goal."""
        self._falls = self._falls or s >= 0.5
        for k, (at, was, to) in enumerate(zip(found[0].tolist(), self._state[0].tolist(), end.tolist(), strict=True)):
            if k == 2:
                kept = min(at, was) if self._falls else max(at, was)
                kept = max(kept, to) if self._falls and was >= to else kept
            else:
                kept = min(max(at, min(was, to)), max(was, to))
            if kept != at:
                found[:, k] = kept, (kept - was) / self._period, 0.0


@dataclass(frozen=True)
class _FittedSwing(SwingFlight):
    """Fitted swing with its flight's heading and slow approach."""

    fit: SwingFit = field(kw_only=True)

    def at(self, time: float) -> tuple[NDArray[np.float64], float]:
        # A swing with a slow approach is above its place before that, and goes down along its flight.
        approaches = self.path.approach_height > 0.0
        share = self.path.arrived / self.path.duration if approaches else 1.0
        position = self.fit.aim(self.end, time, share * self.duration).position
        planned, yaw = self.along(time)
        if approaches:
            position[2] = planned.item(2)
        return position, yaw

    def falling(self, time: float, height: float) -> float:
        return self.fit.falls if self.path.approach_height == 0.0 else super().falling(time, height)


def _rows(s: float, order: int) -> tuple[list[float], list[float], list[float]]:
    """Basis [1, s, ..., s^n] (K 13, corrected) and two derivatives."""
    powers = _powers(s, order)
    first = [0.0] + [k * p for k, p in enumerate(powers[:-1], 1)]
    return powers, first, [0.0] + [k * p for k, p in enumerate(first[:-1], 1)]


def _powers(s: float, order: int) -> list[float]:
    powers = [1.0]
    power = 1.0
    for _ in range(order):
        power *= s
        powers.append(power)
    return powers


def _reduced(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Conditions (m, n + 1) as those (m, n - 1) on free coefficients."""
    return np.asarray(rows[:, 1:-1] - rows[:, -1:])
