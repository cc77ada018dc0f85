"""Edges of the ground across footholds, such as a beam's.

A landing sole presumes the last foothold's line until taxels contradict. With s along the last line and d across, an
edge is

    d = h + m s, least squares of (d_i - h - m s_i) / spread and (m - m_i) / turn over the footholds i.
"""

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale

_SPREAD = 0.012  # chosen: of a sole's length, standard deviation of an edge's place: 3 mm of a sole of 250 mm
_TURN = 0.05  # chosen: rad, that of its direction
_PARALLEL = 0.2  # derived: rad within which two lines may be the same edge; four of `_TURN`
_AGREEMENT = 0.1  # derived: of a sole's length from each other, at which they are not; eight of `_SPREAD`


class _Edge(NamedTuple):
    """Edge under one foothold, world frame: point (2,) in m, outward normal (2,)."""

    point: NDArray[np.float64]
    normal: NDArray[np.float64]


@dataclass
class _Foothold:
    """Edges found under one step's foot."""

    step: int
    edges: list[_Edge]


class EdgeMemory:
    """Edges under the last footholds."""

    # chosen: a sum of five has half the spread of one; more would hold on to a stone that is passed
    def __init__(self, body: BodyScale = REFERENCE_BODY, memory: int = 5) -> None:
        self._spread = _SPREAD * body.sole
        self._agreement = _AGREEMENT * body.sole
        self._footholds: deque[_Foothold] = deque(maxlen=memory)

    def update(
        self,
        step: int,
        lines: NDArray[np.float64],
        middle: NDArray[np.float64],
        position: NDArray[np.float64],
        rotation: NDArray[np.float64],
    ) -> None:
        """Store the edges `lines` (m, 3) n . x <= h, sole frame, of a `step`'s foothold, none if whole; replaces a
        stored one.

        `middle` (2,) of what carries is in the sole frame, `position` (3,) the sole origin in the world, in m;
        `rotation` sole to world (3, 3).
        """
        if self._footholds and self._footholds[-1].step >= step:
            self._footholds.pop()
        if self._footholds and self._footholds[-1].step != step - 1:
            self._footholds.clear()
        turn = rotation[:2, :2]
        place = position[:2]
        edges = []
        for line in lines:
            normal = line[:2]
            height = float(line[2])
            point = middle + (height - float(normal @ middle)) * normal
            edges.append(_Edge(place + turn @ point, turn @ normal))
        self._footholds.append(_Foothold(step, edges))

    def expected(self, step: int, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the last foothold's edges (m, 3) n . x <= h in a landing sole's frame, for a `step`, `position` (3,)
        in the world in m, and `rotation` sole to world (3, 3).
        """
        if not self._footholds or self._footholds[-1].step != step - 1:
            return np.empty((0, 3))
        turn = rotation[:2, :2]
        place = position[:2]
        lines = []
        for edge in self._footholds[-1].edges:
            point, normal = self._fitted(edge)
            normal = turn.T @ normal
            lines.append((*normal.tolist(), float(normal @ (turn.T @ (point - place)))))
        return np.array(lines).reshape(-1, 3)

    def _fitted(self, last: _Edge) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The last edge's point (2,) and normal (2,) by all consecutive footholds with it."""
        along = np.array([-last.normal[1], last.normal[0]])
        rows = [(0.0, 0.0, 0.0)]
        for foothold in reversed(list(self._footholds)[:-1]):
            row = self._same(last, along, foothold.edges)
            if row is None:
                break
            rows.append(row)
        s, d, m = np.array(rows).T
        count = len(rows)
        weight = (self._spread / _TURN) ** 2
        middle = float(s.mean())
        lever = s - middle
        slope = (float(lever @ d) + weight * float(m.sum())) / (float(lever @ lever) + weight * count)
        normal = last.normal - slope * along
        point = last.point + middle * along + float(d.mean()) * last.normal
        return point, np.asarray(normal / math.hypot(*normal.tolist()))

    def _same(self, last: _Edge, along: NDArray[np.float64], edges: list[_Edge]) -> tuple[float, float, float] | None:
        """Place along and across a line, and slope, of the continuing edge, or None."""
        for edge in edges:
            away = edge.point - last.point
            c = float(edge.normal @ last.normal)
            slope = -float(edge.normal @ along) / c if c > math.cos(_PARALLEL) else math.inf
            across = float(away @ last.normal)
            if abs(slope) < _PARALLEL and abs(across) < self._agreement:
                return float(away @ along), across, slope
        return None
