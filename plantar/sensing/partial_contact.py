"""Supported part of a sole, finer than a cell: straight ground edges fitted to partial loads.

With an elastic foundation under a rigid foot the pressure on the supported part S is linear:

    F_i = int_(cell i and S) (a + b x + c y) dA = a A_i + b Mx_i + c My_i,

with area and first moments of the cell's covered part. S is inside a few lines n . x <= h. For given lines the pressure
is linear least squares; the lines move by Gauss-Newton steps: an edge that moves out by dh adds to each cell its chord
times the pressure there (Leibniz).
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST, number
from plantar.common.arrays import array
from plantar.geometry.cell_cutting import CellCutter, half_planes
from plantar.geometry.polygon import closest_point, convex_hull, inner_offset, part_inside
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_mask, taxel_values
from plantar.sensing.proximity import cells_polygon

_MOST_EDGES = 4  # nature: the sides of a rectangle: more edges of a foothold are not told apart by taxels
# chosen: of the strongest neighbour's pressure: a cell with less is cut by an edge; half a cell carries half, a
# crosstalk of 10 % a twentieth
_WEAK = 0.4
# chosen: of a cell's size, prior spread of an edge about where the cells' corners put it; a uniform place in a cell of
# size 1 has 0.29, its corners 0.5
_RANGE = 0.38
# rad, turns that are tried of a line between cells; chosen: half a radian either side in steps of 0.025, a tenth of
# `_TURN`'s spread
_TURNS = np.linspace(-0.5, 0.5, 41)
_COS = np.cos(_TURNS)
_SIN = np.sin(_TURNS)
# chosen: prior spread of its direction; a row of five cells whose ends are uncertain by half a cell turns by 0.2 rad
_TURN = math.radians(12.0)


@dataclass(frozen=True)
class GroundEdges:
    """Straight ground edges under a sole, and the supported part.

    `lines`: edges (m, 3) in sole frame: outward normal of length 1, and distance from origin in m; `polygon`: supported
    part (k, 2) of cells' convex hull in sole frame in m, counter-clockwise; `deviation`: standard deviation (m,) of
    each edge's distance in m by noise; `residual`: RMS difference of loads and fit in N.
    """

    lines: NDArray[np.float64]
    polygon: NDArray[np.float64]
    deviation: NDArray[np.float64]
    residual: float


class PartialContact:
    """Finds the edges of the ground under one sole.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.12, -0.07], [0.12, -0.07], [0.12, 0.07], [-0.12, 0.07]], clip=False)
        >>> fit = PartialContact(layout)
        >>> covered = fit.cover(np.array([[1.0, 0.0, 0.031]]))[:, 0]
        >>> edges = fit.update(1e5 * covered, covered > 0.0, steps=8)
        >>> round(float(edges.lines[0, 2]), 4)
        0.031
    """

    def __init__(self, layout: SoleLayout) -> None:
        self.layout = layout
        n = len(layout)
        self._cells = CellCutter(layout)
        self._centers = np.ascontiguousarray(layout.positions[:, :2])
        self._hull = convex_hull(self._cells.points)
        self._cell = math.sqrt(layout.cell_area)
        most = max((len(near) for near in layout.neighbours), default=0)
        self._near = np.full((n, max(1, most)), -1, dtype=np.intp)
        for i, near in enumerate(layout.neighbours):
            self._near[i, : len(near)] = near
        self.edges: GroundEdges | None = None

    def reset(self) -> None:
        """Drop the edges: the foot lifts off."""
        self.edges = None

    def cover(self, lines: ArrayLike) -> NDArray[np.float64]:
        """Each cell's covered area in m^2 and moments in m^3 about the sole origin (n, 3).

        Args:
            lines: Half-planes (m, 3) n . x <= h in sole frame; InputError unless finite.
        """
        return self._cells.cut(lines)[0]

    def expected(self, load: float, center_of_pressure: ArrayLike, lines: ArrayLike) -> NDArray[np.float64]:
        """Forces (n,) of the taxels in N if the part inside the lines carried a load.

        The pressure is linear where positive, else zero, with the load as resultant, by Newton's method.

        `load`: vertical force in N; `center_of_pressure`: where it acts (2,) in sole frame in m; `lines`: half-planes
        (m, 3), see `cover`.

        Returns forces, none negative; InputError: not finite.
        """
        place = array(center_of_pressure, "center of pressure", (2,), finite=True)
        measure = self.cover(lines)
        field, on = self._field(measure, number(load, "load", finite=True), place)
        return np.where(on, np.maximum(measure @ field, 0.0), 0.0)

    def _field(
        self, measure: NDArray[np.float64], load: float, center_of_pressure: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Pressure (3,) a, b, c of a load on covered cells, and the pressed cells (n,)."""
        area = measure[:, 0]
        on = area > 1e-3 * self.layout.cell_area  # derived: a cell that is covered by less carries less than its noise
        if not on.any() or not load > 0.0:
            return np.zeros(3), np.zeros(len(area), dtype=bool)
        covered = on
        place = np.zeros_like(measure)
        place[on] = measure[on] / area[on, None]
        # The resultant cannot leave the cells' centres: a load on the rim goes to the outermost of them; derived: a
        # tenth of a taxel: a load just at the rim makes the field steep
        inside = closest_point(inner_offset(convex_hull(place[on, 1:]), 2e-3), center_of_pressure)
        x, y = (center_of_pressure if inside is None else inside).tolist()
        wanted = load * np.array([1.0, x, y])
        field: NDArray[np.float64] = np.zeros(3)
        for _ in range(12):
            normal = measure[on].T @ place[on]
            # nature: floating point: a ridge of the root of a rounding keeps the matrix regular
            normal.ravel()[::4] *= 1.0 + 1e-9
            normal.ravel()[::4] += 1e-15  # nature: floating point: the same where the trace is 0
            field = np.asarray(np.linalg.solve(normal, wanted), dtype=np.float64)
            positive = covered & (place @ field > 0.0)
            if not positive.any() or bool((positive == on).all()):
                break
            on = positive
        return field, on

    def update(
        self, load: ArrayLike, active: ArrayLike, noise: float = 1.0, steps: int = 1, start: ArrayLike | None = None
    ) -> GroundEdges:
        """Fit the edges to the loads, from the last fit while the active cells imply the same.

        `load`: force (n,) on each taxel in N; NaN where a taxel is faulty; `active`: mask (n,) of taxels that have been
        loaded; `noise`: standard deviation of `load` in N; `start`: first guess of edges (m, 3), see `between`; from
        loads if None.

        Returns edges; with no active taxel an empty polygon; ReadingError, InputError: loads or mask do not fit.
        """
        force = taxel_values(self.layout, load, "loads")
        mask = taxel_mask(self.layout, active, "mask of active taxels")
        given = None if start is None else half_planes(start, "lines to start from")
        sound = np.abs(force) <= LARGEST
        mask = mask & sound & (force > 0.0)
        if not mask.any():
            self.edges = None
            return GroundEdges(np.empty((0, 3)), np.empty((0, 2)), np.empty(0), 0.0)
        if given is None:
            strong = self._strong(force, mask)
            first = self.between(strong, sound & ~strong)
        else:
            first = given
        lines = first
        if self.edges is not None and len(self.edges.lines) == len(first) > 0:
            order = np.argmax(first[:, :2] @ self.edges.lines[:, :2].T, axis=1)
            if len(set(order.tolist())) == len(first):
                lines = self.edges.lines[order]
        force = np.where(sound, force, 0.0)
        deviation = np.empty(0)
        residual = 0.0
        for _ in range(steps):
            lines, deviation, residual = self._step(lines, first, force, sound, noise)
        self.edges = GroundEdges(lines, self.polygon(lines), deviation, residual)
        return self.edges

    def _strong(self, force: NDArray[np.float64], mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
        pressure = np.where(mask, force, 0.0) / self.layout.areas
        around = np.where(self._near >= 0, pressure[self._near], 0.0).max(axis=1, initial=0.0)
        return np.asarray(mask & (pressure > _WEAK * around))

    def between(self, supported: ArrayLike, idle: ArrayLike) -> NDArray[np.float64]:
        """Lines half way between supported and idle cells' centers.

        `supported`: mask (n,) of cells over ground; `idle`: mask (n,) of cells known not to be.

        Returns half-planes (m, 3), side with most idle cells first; m up to 4; ReadingError: a mask does not
        fit.
        """
        over = taxel_mask(self.layout, supported, "mask of supported taxels")
        inner = self._centers[over]
        outer = self._centers[taxel_mask(self.layout, idle, "mask of idle taxels")]
        hull = cells_polygon(self.layout, over)
        if len(hull) < 3 or not len(outer):
            return np.empty((0, 3))
        after = np.roll(hull, -1, axis=0) - hull
        weight = np.hypot(after[:, 0], after[:, 1])
        normal = np.column_stack([after[:, 1], -after[:, 0]]) / weight[:, None]
        height = (inner @ normal.T).max(axis=0)  # of the outermost supported centre
        place = outer @ normal.T
        beyond = place > height + 0.1 * self._cell  # chosen: a tenth of a cell, about the error of a fitted edge
        left = np.ones(len(outer), dtype=bool)
        chosen: list[tuple[float, float, float]] = []
        while (beyond[left].any()) and len(chosen) < _MOST_EDGES:
            best = int(np.argmax(beyond[left].sum(axis=0) + weight))  # the longer side where as many lie beyond
            side = outer[beyond[:, best]]
            left &= ~beyond[:, best]
            # Turned to where the gap between both sides is widest.
            ways = np.column_stack([_COS, _SIN]) * normal[best, 0] + np.column_stack([-_SIN, _COS]) * normal[best, 1]
            low = (inner @ ways.T).max(axis=0)
            high = (side @ ways.T).min(axis=0)
            # derived: it only decides between equals: the least turn
            widest = int(np.argmax(high - low - 1e-3 * self._cell * np.abs(_TURNS)))
            chosen.append((*ways[widest].tolist(), 0.5 * float(low[widest] + high[widest])))
        return np.array(chosen).reshape(-1, 3)

    def polygon(self, lines: ArrayLike) -> NDArray[np.float64]:
        """Part of the convex hull of all cells inside lines.

        Args:
            lines: Half-planes (m, 3) n . x <= h in sole frame; InputError unless finite.

        Returns:
            Convex polygon (k, 2) in sole frame in m, counter-clockwise.
        """
        left = self._hull
        for nx, ny, h in half_planes(lines).tolist():
            left = part_inside(left, nx, ny, h)
        return left

    def _step(
        self,
        lines: NDArray[np.float64],
        start: NDArray[np.float64],
        force: NDArray[np.float64],
        sound: NDArray[np.bool_],
        noise: float,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
        """One Gauss-Newton step of pressure and edges, with the cells' corners as prior."""
        m = len(lines)
        measure, chords = self._cells.cut(lines)
        measure[~sound] = 0.0
        load = float(force.sum())
        middle = force @ self._centers / load if load > 0.0 else np.zeros(2)
        field, on = self._field(measure, load, middle)
        measure[~on] = 0.0  # rubber does not pull: of what has lifted off nothing is known
        basis = measure / self.layout.cell_area
        field = field * self.layout.cell_area
        normal = basis.T @ basis
        residual = force - basis @ field
        if not m:
            return lines, np.empty(0), float(np.sqrt(np.mean(residual**2)))
        length = chords[:, :, 0]
        mx = chords[:, :, 1]
        my = chords[:, :, 2]
        pressure = (field[0] + field[1] * mx + field[2] * my) / self.layout.cell_area
        along = -lines[:, 1] * mx + lines[:, 0] * my  # place along each edge, from the foot of the origin's normal
        rate = np.where(on[:, None], length * np.maximum(pressure, 0.0), 0.0)
        # An edge turns about the middle of its chords, so that distance and direction do not mix.
        weight = rate.sum(axis=0) + 1e-12  # nature: floating point: 0 / 0 is 0
        pivot = (rate * along).sum(axis=0) / weight
        jacobian = np.hstack([basis, rate, rate * (pivot - along)]) / noise
        target = np.zeros(3 + 2 * m)
        hessian = jacobian.T @ jacobian
        gradient = jacobian.T @ (residual / noise)
        spread = _RANGE * self._cell
        prior = np.concatenate(
            [
                # nature: floating point: a ridge that keeps the matrix regular
                np.full(3, 1e-9 * np.trace(normal) / noise**2 + 1e-12),
                np.full(m, spread**-2),
                np.full(m, _TURN**-2),
            ]
        )
        # What the prior wants: distance at the pivot and direction of the start.
        turn = np.arctan2(
            lines[:, 0] * start[:, 1] - lines[:, 1] * start[:, 0], lines[:, 0] * start[:, 0] + lines[:, 1] * start[:, 1]
        )
        place = lines[:, 2:] * lines[:, :2] + pivot[:, None] * np.column_stack([-lines[:, 1], lines[:, 0]])
        target[3 : 3 + m] = start[:, 2] - (start[:, :2] * place).sum(axis=1)
        target[3 + m :] = turn
        inverse = np.linalg.inv(hessian + np.diag(prior))
        step = inverse @ (gradient + prior * target)
        move = np.clip(step[3 : 3 + m], -0.5 * self._cell, 0.5 * self._cell)
        # chosen: a step of the iteration, a fifth of a radian: the model is linear so far
        angle = np.clip(step[3 + m :], -0.2, 0.2)
        c = np.cos(angle)
        s = np.sin(angle)
        new = np.column_stack([c * lines[:, 0] - s * lines[:, 1], s * lines[:, 0] + c * lines[:, 1]])
        height = (new * (place + move[:, None] * lines[:, :2])).sum(axis=1)
        deviation = np.sqrt(np.diag(inverse)[3 : 3 + m])
        return np.column_stack([new, height]), deviation, float(np.sqrt(np.mean(residual**2)))
