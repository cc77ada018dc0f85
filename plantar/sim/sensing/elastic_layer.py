"""Contact with an elastic layer that is bonded to a rigid foot and frictionless on its face.

Displacement of a pressed square: Love's for the half-space, less what the foot holds back. With E* = E / (1 - nu^2),
thickness d and wave number q, a pressure p moves the surface by

    u(q) = 2 M(q d) p(q) / (E* q),
    M(s) = ((3 - 4 nu) sinh 2s - 2s) / ((3 - 4 nu) cosh 2s + 2 s^2 + 5 - 12 nu + 8 nu^2),

so the difference to the half-space (M = 1) at a distance r is

    g(r) = 1 / (pi E*) int_0^inf (1 - M(q d)) J0(q r) dq.

Sources: Johnson, Contact Mechanics (1985), 3.25, 5.8; Love, The stress produced in a semi-infinite solid (1929).
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg.lapack import dposv, dpotrf, dpotri

_FAR = 12.0  # Thicknesses from which a square moves nothing: the layer's surface gives way locally
# Sides from which a square counts as a point: off by half a per cent there, and less with the distance's square
_NEAR = 3.0
_ROUNDS = 80
_TOGETHER = 12
_FEW = 12  # Squares about the load that a search begins with where one from all squares fails
_LEAST = 1e-7  # Of the load: a square that pulls less, or is penetrated by less than this would press it, is right


def influence(points: ArrayLike, sides: ArrayLike, thickness: float, poisson: float = 0.4) -> NDArray[np.float64]:
    """Displacement of each point by a unit force on each square, for E* = 1.

    `points` (n, 2) in m; `sides` (m,) in m of squares about the first m points, evenly pressed; `thickness` in m;
    infinity for the half-space; `poisson`: poisson's ratio, 0 to below 0.5. Returns (n, m) in m for 1 N and E* of 1 Pa:
    divide by E*.

    Example:
        >>> round(float(influence([(0.0, 0.0)], [1.0], math.inf)[0, 0] * math.pi), 4)  # 4 ln(1 + sqrt 2)
        3.5255
    """
    place = np.asarray(points, dtype=np.float64)
    side = np.asarray(sides, dtype=np.float64)
    x = place[:, None, 0] - place[None, : len(side), 0]
    y = place[:, None, 1] - place[None, : len(side), 1]
    distance = np.hypot(x, y)
    with np.errstate(divide="ignore"):
        out = 1.0 / (math.pi * distance)  # of a force at a point, which a square is from afar
    near = np.nonzero(distance < _NEAR * side)
    x = x[near]
    y = y[near]
    own = side[near[1]]
    half = 0.5 * own
    corners = _love(x + half, y + half) - _love(x - half, y + half) - _love(x + half, y - half)
    out[near] = (corners + _love(x - half, y - half)) / (math.pi * own * own)
    if math.isinf(thickness):
        return np.asarray(out)
    held = _held_back(distance / thickness, poisson)
    held[near] = 0.0
    # g is smooth over a thickness, so that few Gauss points of a square are enough where it is not much larger.
    nodes, weights = np.polynomial.legendre.leggauss(min(8, 1 + math.ceil(float(side.max(initial=0.0)) / thickness)))
    for a, p in zip(nodes.tolist(), weights.tolist(), strict=True):
        for b, q in zip(nodes.tolist(), weights.tolist(), strict=True):
            held[near] += 0.25 * p * q * _held_back(np.hypot(x + a * half, y + b * half) / thickness, poisson)
    out -= held / (math.pi * thickness)
    out[distance > _FAR * thickness] = 0.0
    return np.asarray(out)


def _love(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Love's corner function; its second difference over corners is the displacement."""
    with np.errstate(divide="ignore", invalid="ignore"):
        first = np.where(x == 0.0, 0.0, x * np.arcsinh(y / np.abs(x)))
        second = np.where(y == 0.0, 0.0, y * np.arcsinh(x / np.abs(y)))
    return np.asarray(first + second)


def _held_back(distance: NDArray[np.float64], poisson: float) -> NDArray[np.float64]:
    """g(r) of a layer of thickness 1, times pi E*."""
    table = _held_back_table(poisson)
    return np.interp(distance, np.linspace(0.0, _FAR, len(table)), table)


@lru_cache(maxsize=8)
def _held_back_table(poisson: float) -> NDArray[np.float64]:
    """g of distances from 0 to `_FAR`, by Simpson's rule: 1 - M falls as s^2 exp(-2 s), to zero at 20."""
    from scipy.integrate import simpson
    from scipy.special import j0

    s = np.linspace(0.0, 20.0, 2001)
    k = 3.0 - 4.0 * poisson
    with np.errstate(over="ignore"):
        m = (k * np.sinh(2.0 * s) - 2.0 * s) / (
            k * np.cosh(2.0 * s) + 2.0 * s * s + 5.0 - 12.0 * poisson + 8.0 * poisson**2
        )
    return np.asarray(simpson(j0(np.outer(np.linspace(0.0, _FAR, 1201), s)) * (1.0 - m), x=s))


class Contact(NamedTuple):
    """A rigid body pressed on the layer.

    `forces` (n,) in N, none negative; `field` (3,): approach at the origin in m times E*, and its slopes along x, y;
    `on` (n,) that touch; `settled`: whether no square pulls and none is penetrated.
    """

    forces: NDArray[np.float64]
    field: NDArray[np.float64]
    on: NDArray[np.bool_]
    settled: bool


class LayerContact:
    """Presses rigid bodies on a layer of n squares, E* = 1.

    With forces F, approach f, gap g before, and depth s by which squares that do not touch lie under the body, C F = U
    f - g - s, U = (1, x, y). A primal-dual active set finds the squares that touch: F = 0 where s < 0. With B = C^-1,
    s_off = B_off,off^-1 (B (U f - g))_off; where most are off, those that touch are solved instead.

    `compliance`: symmetric (n, n), see `influence`; `points` (n, 2) in m.
    """

    def __init__(self, compliance: NDArray[np.float64], points: NDArray[np.float64]) -> None:
        self.compliance = compliance
        self.points = points
        self._u = np.column_stack([np.ones(len(points)), points])
        factor, failed = dpotrf(compliance, lower=1)
        if failed:
            raise np.linalg.LinAlgError("compliance is not positive definite")
        half = dpotri(factor, lower=1)[0]
        self._stiffness = np.tril(half) + np.tril(half, -1).T
        self._own = np.diag(compliance)
        self._stiff_u = self._stiffness @ self._u

    def press(
        self, load: NDArray[np.float64], gap: NDArray[np.float64] | None = None, start: NDArray[np.bool_] | None = None
    ) -> Contact:
        """Press a body with a given load.

        `load`: force in N, and times its x and y in N m, inside the points' hull; `gap`: undeformed (n,) in m times E*;
        None for 0; `start`: squares (n,) expected to touch; None for all. Returns the contact; not settled where no set
        of squares fits.
        """
        on = np.ones(len(self.points), dtype=bool) if start is None or int(start.sum()) < 3 else start
        contact = self._settled(load, gap, on, _TOGETHER)
        if contact is None or not contact.settled:  # a load at a corner, on a few squares of many
            distance = np.hypot(*(self.points - load[1:] / load[0]).T)
            contact = self._settled(load, gap, distance <= np.sort(distance)[: _FEW + 1][-1], 0) or contact
        if contact is None:
            nearest = np.arange(len(self.points)) == int(np.argmin(np.hypot(*(self.points - load[1:] / load[0]).T)))
            contact = Contact(np.where(nearest, load[0], 0.0), np.zeros(3), nearest, False)
        return contact

    def _settled(
        self, load: NDArray[np.float64], gap: NDArray[np.float64] | None, on: NDArray[np.bool_], together: int
    ) -> Contact | None:
        """The contact from squares expected to touch; None below three."""
        forces = np.zeros(len(on))
        field = np.zeros(3)
        for i in range(_ROUNDS):
            gains, apart = self.gains(on, gap)
            try:
                field = np.asarray(np.linalg.solve(self._u.T @ gains[:, :3], load - self._u.T @ gains[:, 3]))
            except np.linalg.LinAlgError:
                return None
            approach = np.array([*field, 1.0])
            forces = gains @ approach
            sunk = apart @ approach
            # What a square asks for as a force: less pull, or less penetration.
            wrong = np.where(on, -forces, sunk / self._own)
            wrong[wrong <= _LEAST * load[0]] = 0.0
            if not wrong.any():
                return Contact(np.maximum(forces, 0.0), field, on, True)
            # All at once is fast, and may go round in circles; then the worst one alone.
            on = on ^ (wrong > (0.0 if i < together else 0.999 * float(wrong.max())))
            if int(on.sum()) < 3:
                return None
        return Contact(np.maximum(forces, 0.0), field, on, False)

    def gains(
        self, on: NDArray[np.bool_], gap: NDArray[np.float64] | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """What an approach (1, x, y) and, last, the gap cause while the same squares touch.

        `on`: squares (n,) that touch; `gap`: undeformed (n,) in m times E*; None for 0. Returns forces (n, 4) on
        touching squares, and depth (n, 4) of the others, else 0.
        """
        off = np.flatnonzero(~on)
        rest = np.zeros(len(on)) if gap is None else gap
        sides = np.column_stack([self._u, -rest])
        forces = np.zeros_like(sides)
        sunk = np.zeros_like(sides)
        if 2 * len(off) <= len(on):
            whole = np.column_stack([self._stiff_u, -(self._stiffness @ rest) if gap is not None else rest])
            forces += whole
            if len(off):
                sunk[off] = _solved(self._stiffness[np.ix_(off, off)], whole[off])
                forces -= self._stiffness[:, off] @ sunk[off]
            forces[off] = 0.0
        else:
            touch = np.flatnonzero(on)
            forces[touch] = _solved(self.compliance[np.ix_(touch, touch)], sides[touch])
            sunk[off] = sides[off] - self.compliance[np.ix_(off, touch)] @ forces[touch]
        return forces, sunk


def _solved(matrix: NDArray[np.float64], sides: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(dposv(matrix, sides, lower=1)[1])
