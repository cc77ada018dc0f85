"""Ways of lines on a board of two layers: shortest paths on a grid around what lies there. Lengths in mm.

Each net keeps a clearance from all others: a node of the grid is free, a net's own, or blocked, for lines on each layer
and for vias through both.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

Array = NDArray[np.float64]

LINE = 0.2  # wide
CLEARANCE = 0.2  # between the copper of two nets
VIA = 0.5  # across its pad
HOLE = 0.3  # across
EDGE = 0.5  # copper to the board's edge
STEP = 0.5  # of the grid
BLOCKED = -1  # for every net

_AGAINST = 1.3  # a step across a layer's direction over one along it
_CHANGE = 8.0  # steps that a via is worth
_LATE = 0.6  # of a step across, that it costs more at the tail
_ZONE = 40.0  # steps from the tail, from which on it does not
NEAR = 0.5 * LINE + CLEARANCE + 0.5 * LINE  # between the middles of two lines

_ROOT2 = 1e-6


class Node(NamedTuple):
    """A node of the grid: layer 0 or 1, and its place along both axes."""

    layer: int
    i: int
    j: int


@dataclass
class GridRouter:
    """Grid of a board: node (i, j) lies at `origin + STEP (i along + j across)`, unit vectors (2,).

    `region`: shapely place of the middles of lines.
    """

    origin: Array
    along: Array
    across: Array
    shape: tuple[int, int]
    region: Any
    lines: NDArray[np.int32] = field(init=False)
    vias: NDArray[np.int32] = field(init=False)

    def __post_init__(self) -> None:
        i, j = np.meshgrid(np.arange(self.shape[0]), np.arange(self.shape[1]), indexing="ij")
        self._points = self.origin + STEP * (i[..., None] * self.along + j[..., None] * self.across)
        shapely.prepare(self.region)
        inside = shapely.contains_xy(self.region, self._points[..., 0], self._points[..., 1])
        self.lines = np.where(np.stack([inside, inside]), 0, BLOCKED).astype(np.int32)
        smaller = self.region.buffer(0.5 * (LINE - VIA))
        shapely.prepare(smaller)
        self.vias = np.where(
            shapely.contains_xy(smaller, self._points[..., 0], self._points[..., 1]), 0, BLOCKED
        ).astype(np.int32)
        self._edges = self._all_edges()

    def point(self, node: Node) -> Array:
        """Place (2,) of a node."""
        return np.asarray(self._points[node.i, node.j])

    def _box(self, shape: Any) -> tuple[slice, slice]:
        corners = np.array(shapely.box(*shape.bounds).exterior.coords) - self.origin
        i = corners @ self.along / STEP
        j = corners @ self.across / STEP
        return tuple(  # type: ignore[return-value]
            slice(max(0, int(np.floor(v.min()))), max(0, int(np.ceil(v.max())) + 1)) for v in (i, j)
        )

    def within(self, shape: Any, layer: int, net: int) -> list[Node]:
        """A net's own nodes of a layer in a shapely shape; none in an empty one."""
        if shape.is_empty:
            return []
        box = self._box(shape)
        points = self._points[box]
        shapely.prepare(shape)
        found = shapely.contains_xy(shape, points[..., 0], points[..., 1]) & (self.lines[layer][box] == net)
        return [Node(layer, int(i) + box[0].start, int(j) + box[1].start) for i, j in np.argwhere(found)]

    def block(self, shape: Any, layer: int) -> None:
        """Keep all lines off a shapely piece of copper on a layer, and vias."""
        self._mark(self.lines[layer], shape.buffer(CLEARANCE + 0.5 * LINE), BLOCKED)
        self._mark(self.vias, shape.buffer(CLEARANCE + 0.5 * VIA), BLOCKED)

    def occupy(self, shape: Any, layer: int, net: int) -> None:
        """Give a net a shapely piece of its copper on a layer, with its clearance."""
        self._mark(self.lines[layer], shape.buffer(CLEARANCE + 0.5 * LINE - _ROOT2), net)
        self._mark(self.vias, shape.buffer(CLEARANCE + 0.5 * VIA - _ROOT2), net)

    def _mark(self, grid: NDArray[np.int32], shape: Any, net: int) -> None:
        box = self._box(shape)
        points = self._points[box]
        shapely.prepare(shape)
        inside = shapely.contains_xy(shape, points[..., 0], points[..., 1])
        part = grid[box]
        part[inside & (part == 0)] = net
        part[inside & (part != net)] = BLOCKED

    def _all_edges(self) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
        count = self.shape[0] * self.shape[1]
        number = np.arange(count).reshape(self.shape)
        starts = []
        ends = []
        costs = []
        # Nearer to the tail (i = 0) a step across costs more: lines whose way there is short turn early, so that others
        # pass between them and the tail.
        near = 1.0 + _LATE * np.maximum(0.0, 1.0 - np.arange(self.shape[0]) / _ZONE)
        for layer, (of_i, of_j) in enumerate(((1.0, _AGAINST), (_AGAINST, 1.0))):
            along = (number[:-1], number[1:], np.full((self.shape[0] - 1, self.shape[1]), of_i))
            beside = (number[:, :-1], number[:, 1:], np.repeat(of_j * near[:, None], self.shape[1] - 1, axis=1))
            for a, b, cost in (along, beside):
                starts.append(a.ravel() + layer * count)
                ends.append(b.ravel() + layer * count)
                costs.append(cost.ravel())
        starts.append(number.ravel())
        ends.append(number.ravel() + count)
        costs.append(np.full(count, _CHANGE))
        return np.concatenate(starts), np.concatenate(ends), np.concatenate(costs)

    def route(self, net: int, sources: list[Node], targets: list[Node]) -> list[Node] | None:
        """Shortest way of a net from one of its source nodes to a target node, or None."""
        from scipy.sparse import csr_array  # 0.2 s: only where lines are routed
        from scipy.sparse.csgraph import dijkstra

        count = self.shape[0] * self.shape[1]
        free = ((self.lines == 0) | (self.lines == net)).reshape(2, count)
        through = ((self.vias == 0) | (self.vias == net)).ravel() & free[0] & free[1]
        passable = free.ravel()
        starts, ends, costs = self._edges
        kept = passable[starts] & passable[ends]
        kept[-count:] &= through
        graph = csr_array((costs[kept], (starts[kept], ends[kept])), shape=(2 * count, 2 * count))

        def number(node: Node) -> int:
            return node.layer * count + node.i * self.shape[1] + node.j

        begin = [n for n in map(number, sources) if passable[n]]
        aims = [n for n in map(number, targets) if passable[n]]
        if not begin or not aims:
            return None
        far, before, _ = dijkstra(graph, directed=False, indices=begin, min_only=True, return_predecessors=True)
        aim = min(aims, key=lambda n: float(far[n]))
        if not np.isfinite(far[aim]):
            return None
        way = [aim]
        while before[way[-1]] >= 0:
            way.append(int(before[way[-1]]))
        return [Node(n // count, n % count // self.shape[1], n % self.shape[1]) for n in reversed(way)]
