"""The largest push that any footsteps, timing and ZMP within a robot's limits capture, by exhaustive search on the LIP.

On the pendulum with DCM xi and ZMP p, xi' = w (xi - p), a push that begins at time 0 is captured by a sequence of
supports if

    xi_0 + J g = sum_i (e^(-w a_i) - e^(-w b_i)) z_i + e^(-w b) z_end,

where z_i, the ZMP's mean in the support from a_i to b_i, is any point of its polygon, and z_end, the DCM at the last
touchdown, any point of the hull of both feet. For given times a linear program in the steps and J remains, solved
exactly. Times, and the ZMP's place between the feet in double support, are searched on a grid and refined, which makes
the limit too small.

Swing distances are bounded by polygons of 16 edges around a circle, at most 2 % too far. Feet take turns, and there is
no angular momentum.
"""

import itertools
import math
from dataclasses import dataclass, field
from typing import NamedTuple

import daqp
import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arrays import array, own
from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.geometry.polygon import convex_hull

_MOST = 2.0  # m of DCM: no robot comes near
_ROUND = np.array([(math.cos(a), math.sin(a)) for a in 2.0 * math.pi * np.arange(16) / 16])
_AXES = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
_REST = own(np.zeros(2))
_PEAK = 10.0 / math.sqrt(3.0)  # largest acceleration of a minimum-jerk motion over its way and time^2
_FLAT = 1e-9  # weight of the steps against that of the push: of all steps that capture as much, the shortest are chosen


def mirrored(polygon: ArrayLike) -> NDArray[np.float64]:
    """A `polygon` or point (..., 2) in m with y reversed."""
    return np.asarray(polygon, dtype=float) * (1.0, -1.0)


@dataclass(frozen=True)
class CaptureLimits:
    """Limits of a robot. Polygons are the left foot's; the right foot has their mirror images.

    Attributes:
        mass: In kg.
        omega: Pendulum frequency in rad/s.
        sole: Where the ZMP may be under the left foot alone (k, 2), from the foot's origin, in m.
        region: Where the left foot may land (k, 2), from the right foot's origin, in m.
        shortest: Shortest single support in s.
        longest: Longest one in s.
        double_support: Duration in s between two steps.
        swing_speed: Largest mean speed of the swing foot over the ground in m/s.
        swing_acceleration: Its largest in m/s^2, on a minimum-jerk path: from rest it covers a t^2 / 5.77.
        swing_sideways: Share of that acceleration to the side; in between along an ellipse.
        landing: Least time in s from the push to a touchdown.
        lasts: Duration of the push in s, at constant force; 0 for an impulse.
        height: Height in m of the push above the CoM.
        steps: Most steps, 4 at most.
        times: Number of tried durations of each single support.
        shares: Number of tried places of the ZMP between the feet in each double support.

    Raises:
        InputError: If a polygon is not (k, 2) with one vertex at least, or a number is out of its range.
    """

    mass: float
    omega: float
    sole: NDArray[np.float64]
    region: NDArray[np.float64]
    shortest: float
    longest: float
    double_support: float = 0.0
    swing_speed: float = math.inf
    swing_acceleration: float = math.inf
    swing_sideways: float = 1.0
    landing: float = 0.0
    lasts: float = 0.0
    height: float = 0.0
    steps: int = 2
    times: int = 8
    shares: int = 3
    _normals: tuple[NDArray[np.float64], ...] = field(default=(), init=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("sole", "region"):
            hull = convex_hull(array(getattr(self, name), name, ("k", 2), finite=True))
            if not len(hull):
                raise InputError(f"{name} has no vertices; it needs one at least")
            object.__setattr__(self, name, hull)
        for name in ("mass", "omega", "swing_speed", "swing_acceleration", "swing_sideways"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{name} is {getattr(self, name)}; allowed: above 0")
        for name in ("shortest", "double_support", "landing", "lasts"):
            if not 0.0 <= getattr(self, name) < math.inf:
                raise InputError(f"{name} is {getattr(self, name)}; allowed: 0 or more, finite")
        if not self.shortest <= self.longest < math.inf:
            raise InputError(f"longest is {self.longest}; allowed: {self.shortest} (shortest) or more, finite")
        if not (0 <= self.steps <= 4 and self.times >= 1 and self.shares >= 2):
            raise InputError(
                f"steps, times and shares are {self.steps}, {self.times} and {self.shares}; "
                "allowed: 0 to 4, 1 or more, 2 or more"
            )
        sides = [np.vstack([_normals(self.sole * m), _AXES]) for m in ((1.0, 1.0), (1.0, -1.0))]
        object.__setattr__(self, "_normals", tuple(sides))


class Instant(NamedTuple):
    """A walk at the moment of a push, relative to its stance foot: x forward, y to the left.

    Attributes:
        side: The stance foot; in double support the next one.
        dcm: DCM (2,) in m.
        swing: The other foot's origin (2,) in m.
        elapsed: Time since the single support began in s; 0 in double support.
        double_left: Time until it begins in s; 0 in single support.
        velocity: Velocity (2,) of the other foot in m/s.
    """

    side: str
    dcm: NDArray[np.float64]
    swing: NDArray[np.float64]
    elapsed: float = 0.0
    double_left: float = 0.0
    velocity: NDArray[np.float64] = _REST


class LandedStep(NamedTuple):
    """A step of a sequence that captures a push.

    Attributes:
        time: Touchdown in s from the push.
        place: Foothold (2,) in m from the stance foot at the time of the push.
        share: Where the ZMP is in the double support after it: 0 at the other foot, 1 at this one.
    """

    time: float
    place: NDArray[np.float64]
    share: float


class CaptureLimit(NamedTuple):
    """The largest captured push.

    Attributes:
        impulse: In N s; 0 where no push is captured.
        steps: Steps that capture it; empty where the ZMP alone does.
    """

    impulse: float
    steps: tuple[LandedStep, ...]


class _Sequences(NamedTuple):
    """Sequences of supports, a row each: durations (b, n) of the single supports in s, and ZMP shares (b, n)."""

    times: NDArray[np.float64]
    shares: NDArray[np.float64]


class _Found(NamedTuple):
    """What a sequence captures: pushes of the DCM from `least` to `most` in m, the largest by these steps (n, 2)."""

    most: float
    steps: NDArray[np.float64]
    times: NDArray[np.float64]
    shares: NDArray[np.float64]


def capture_limit(limits: CaptureLimits, instant: Instant, direction: ArrayLike) -> CaptureLimit:
    """The largest captured push in a `direction` (2,) of any length, with all smaller ones, and steps that capture
    it."""
    toward = array(direction, "direction", (2,), finite=True)
    length = math.hypot(*toward)
    if length == 0.0:
        raise InputError("direction has no length; a push goes somewhere")
    if instant.side not in ("left", "right"):
        raise InputError(f"side of an instant is {instant.side!r}; allowed: left, right")
    flip = np.array((1.0, 1.0 if instant.side == "left" else -1.0))
    seen = instant._replace(
        side="left", dcm=instant.dcm * flip, swing=instant.swing * flip, velocity=instant.velocity * flip
    )
    programs = [_Program(limits, seen, toward / length * flip, count) for count in range(limits.steps + 1)]
    best = _connected(programs)
    if best is None:
        return CaptureLimit(0.0, ())
    lever = (1.0 + limits.omega**2 * limits.height / GRAVITY) * _spread(limits.omega * limits.lasts)
    ends = best.times.cumsum() + limits.double_support * np.arange(len(best.times)) + instant.double_left
    ends = ends - instant.elapsed
    places = best.steps.cumsum(axis=0) * flip
    landed = (LandedStep(float(t), p, float(s)) for t, p, s in zip(ends, places, best.shares, strict=True))
    return CaptureLimit(best.most * limits.mass * limits.omega / lever, tuple(landed))


def _spread(exponent: float) -> float:
    """Remaining share of a push of some duration, (1 - e^(-w T)) / (w T)."""
    return 1.0 if exponent < 1e-9 else -math.expm1(-exponent) / exponent


def _connected(programs: list["_Program"]) -> _Found | None:
    """The largest push below which all are captured, or None."""
    found = [(f, p) for p in programs for f in p.search()]
    found.sort(key=lambda item: item[0].most, reverse=True)
    above: list[tuple[float, _Found]] = []
    for item, program in found:
        least = program.least(item)
        if least > 1e-7:
            above.append((least, item))
            continue
        best = item
        for low, higher in reversed(above):  # from the lowest end up
            if low <= best.most + 1e-7:
                best = max(best, higher, key=lambda f: f.most)
        return best
    return None


class _Program:
    def __init__(self, limits: CaptureLimits, instant: Instant, toward: NDArray[np.float64], count: int) -> None:
        self._limits, self._instant, self._count = limits, instant, count
        soles = (limits.sole, mirrored(limits.sole))
        hull = convex_hull(np.vstack([soles[0], instant.swing + soles[1]]))
        both = instant.double_left > 0.0
        normals = np.vstack([*limits._normals, _normals(hull)]) if both else np.vstack(limits._normals)
        self._by_side = [(normals @ s.T).max(axis=1) for s in soles]
        self._by_both = (normals @ hull.T).max(axis=1) if both else np.zeros(len(normals))
        regions = (limits.region, mirrored(limits.region))
        size, k = 1 + 2 * count, len(normals)
        rows, upper = [np.zeros((k, size))], [normals @ -instant.dcm]
        rows[0][:, 0] = normals @ toward
        for j in range(count):  # the first step is the right foot's
            edges = _normals(regions[(j + 1) % 2])
            row = np.zeros((len(edges), size))
            row[:, 1 + 2 * j : 3 + 2 * j] = edges
            rows.append(row)
            upper.append((edges @ regions[(j + 1) % 2].T).max(axis=1))
        self._circles = sum(len(r) for r in rows)
        self._stretch = np.array((1.0, limits.swing_sideways))
        for most, edges in ((limits.swing_speed, _ROUND), (limits.swing_acceleration, _ROUND / self._stretch)):
            for j in range(count if math.isfinite(most) else 0):
                row = np.zeros((len(edges), size))
                row[:, 1 + 2 * j : 3 + 2 * j] = edges
                if j:
                    row[:, 2 * j - 1 : 2 * j + 1] = edges
                rows.append(row)
                upper.append(edges @ instant.swing if j == 0 else np.zeros(len(edges)))
        self._normals = normals
        self._rows, self._upper = np.vstack(rows), np.concatenate([[_MOST], *upper])
        self._lower = np.full(len(self._upper), -1e30)
        self._lower[0] = 0.0
        self._hessian = np.diag([1.0] + [_FLAT] * (2 * count))

    def search(self) -> list[_Found]:
        limits, instant, n = self._limits, self._instant, self._count
        begun = max(limits.shortest, instant.elapsed + max(0.0, limits.landing - instant.double_left))
        first = np.linspace(begun, max(begun, limits.longest), limits.times)
        later = np.linspace(limits.shortest, limits.longest, limits.times)
        axes = [first, *[later] * (n - 1)][:n] + [np.linspace(0.0, 1.0, limits.shares)] * n
        grid = np.array(list(itertools.product(*axes)), dtype=float)
        found = self._solve(_Sequences(grid[:, :n], grid[:, n:]))
        if found and n:
            found.append(self._refined(max(found, key=lambda f: f.most), axes))
        return found

    def least(self, found: _Found) -> float:
        """The smallest push in m that the times and shares of a sequence capture."""
        again = self._solve(_Sequences(found.times[None], found.shares[None]), wanted=0.0)
        return min((f.most for f in again), default=found.most)

    def _refined(self, best: _Found, axes: list[NDArray[np.float64]]) -> _Found:
        """A sequence whose times and shares are moved between the points of the grid, one after the other."""
        low, high = (np.array([pick(a) for a in axes]) for pick in (np.min, np.max))
        step = np.array([a[1] - a[0] if len(a) > 1 else 0.0 for a in axes])
        for _ in range(4):
            step = 0.5 * step
            for k in range(len(axes)):
                at = np.concatenate([best.times, best.shares])
                tried = np.array([at, at])
                tried[:, k] = np.clip(at[k] + step[k] * np.array([-1.0, 1.0]), low[k], high[k])
                moved = self._solve(_Sequences(tried[:, : self._count], tried[:, self._count :]))
                best = max([best, *moved], key=lambda f: f.most)
        return best

    def _solve(self, sequences: _Sequences, wanted: float = _MOST) -> list[_Found]:
        """What sequences capture, the push nearest to a wanted one; those that capture none are left out."""
        supports, leads, circles = self._terms(sequences)
        k, n = len(self._normals), self._count
        gradient = np.zeros(1 + 2 * n)
        gradient[0] = -wanted
        rows, upper = self._rows.copy(), self._upper.copy()
        found = []
        for b in range(len(sequences.times)):
            for j in range(n):
                np.multiply(self._normals, -leads[b, j], out=rows[:k, 1 + 2 * j : 3 + 2 * j])
            upper[1 : 1 + k] = self._upper[1 : 1 + k] + supports[b]
            upper[1 + self._circles :] = self._upper[1 + self._circles :] + circles[b]
            z, _, flag, _ = daqp.solve(self._hessian, gradient, rows, upper, self._lower, primal_tol=1e-9)
            if flag == 1:
                found.append(_Found(float(z[0]), z[1:].reshape(n, 2), sequences.times[b], sequences.shares[b]))
        return found

    def _terms(self, sequences: _Sequences) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Support function (b, k) of all soles together, weight (b, n) of each step, and how far feet swing (b, r)."""
        limits, instant, n = self._limits, self._instant, self._count
        times, shares, w = sequences.times, sequences.shares, limits.omega
        count = len(times)
        at = np.full(count, instant.double_left)
        total = np.tile(-math.expm1(-w * instant.double_left) * self._by_both, (count, 1))
        leads = np.zeros((count, n))
        for i in range(n):
            single = times[:, i] - (instant.elapsed if i == 0 else 0.0)
            weight = np.exp(-w * at) - np.exp(-w * (at + single))
            total += weight[:, None] * self._by_side[i % 2]
            leads[:, :i] += weight[:, None]
            at = at + single
            # The double support behind it; the last one never ends.
            end = at + (limits.double_support if i < n - 1 else math.inf)
            weight = np.exp(-w * at) - np.exp(-w * end)
            share = shares[:, i]
            total += (weight * (1.0 - share))[:, None] * self._by_side[i % 2]
            total += (weight * share)[:, None] * self._by_side[(i + 1) % 2]
            leads[:, :i] += weight[:, None]
            leads[:, i] += weight * share
            at = end
        if n == 0:  # it stays as it is
            total = np.tile(self._by_both if instant.double_left > 0.0 else self._by_side[0], (count, 1))
        return total, leads, self._swings(times - np.where(np.arange(n) == 0, instant.elapsed, 0.0))

    def _swings(self, airborne: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far feet get (b, r) in the times (b, n) that they swing, along each edge of their circles."""
        limits, v = self._limits, self._instant.velocity / self._stretch
        found = [np.zeros((len(airborne), 0))]
        if math.isfinite(limits.swing_speed):
            found.append(np.repeat(limits.swing_speed * airborne, len(_ROUND), axis=1))
        if math.isfinite(limits.swing_acceleration) and self._count:
            reach = limits.swing_acceleration * airborne**2
            reach[:, :1] -= float(v @ v) / limits.swing_acceleration
            edges = np.repeat(np.maximum(reach, 0.0) / _PEAK, len(_ROUND), axis=1)
            edges[:, : len(_ROUND)] += 0.5 * airborne[:, :1] * (_ROUND @ v)
            found.append(edges)
        return np.hstack(found)


def _normals(polygon: NDArray[np.float64]) -> NDArray[np.float64]:
    """Outward normals (k, 2) of a convex polygon's edges, of length 1; for a line or a point, of a box around it."""
    hull = convex_hull(polygon)
    if len(hull) < 2:
        return _AXES
    along = np.roll(hull, -1, axis=0) - hull
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    out = np.column_stack([along[:, 1], -along[:, 0]])
    return out if len(hull) > 2 else np.vstack([out, along])
