"""Shoe blocks: outlines at two heights and what is between. In mm."""

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.geometry.outline import ring


@dataclass(frozen=True)
class Block:
    """Body between outlines `low` and `high` (shapely, parallel edges), or a prism without `high`, maybe with holes."""

    low: Any
    z_low: float
    z_high: float
    high: Any | None = None


@dataclass(frozen=True)
class Groove:
    """Half V groove on the inner side of a closed `line`, its upper edge; `edge` is the lower, parallel one."""

    line: Any
    edge: Any
    z_low: float
    z_high: float


@dataclass(frozen=True)
class Step:
    """Blocks added to or cut from the body, limited to an outline `within`."""

    kind: Literal["add", "cut"]
    name: str
    blocks: tuple[Block | Groove, ...]
    within: Any | None = None


def box_block(low: tuple[float, float, float], high: tuple[float, float, float]) -> Block:
    """Gives box of corners low and high (x, y, z) in mm."""
    return Block(shapely.box(low[0], low[1], high[0], high[1]), low[2], high[2])


def mirrored_block(block: Block | Groove) -> Block | Groove:
    """Block with y reversed."""
    if isinstance(block, Groove):
        return replace(block, line=_flipped(block.line), edge=_flipped(block.edge))

    return replace(block, low=_flipped(block.low), high=None if block.high is None else _flipped(block.high))


def mirrored_step(step: Step) -> Step:
    """Step with y reversed."""
    blocks = tuple(mirrored_block(b) for b in step.blocks)
    return replace(step, blocks=blocks, within=None if step.within is None else _flipped(step.within))


def _flipped(polygon: Any) -> Any:
    flat = np.array([1.0, -1.0])
    holes = [np.asarray(h.coords)[:-1][::-1] * flat for h in polygon.interiors]
    return shapely.Polygon(ring(polygon)[::-1] * flat, holes)


def moved_edges(points: NDArray[np.float64], distance: float) -> NDArray[np.float64] | None:
    """Gives points (k, 2), counter-clockwise, with edges moved outwards by a distance in mm, or None where an edge
    would vanish or the ring cross itself.

    Example:
        >>> moved_edges(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]]), -0.5).tolist()
        [[0.5, 0.5], [3.5, 0.5], [3.5, 1.5], [0.5, 1.5]]
    """
    edge = np.roll(points, -1, axis=0) - points
    length = np.hypot(*edge.T)
    if not (length > 0.0).all():
        return None
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / length[:, None]
    before = np.roll(normal, 1, axis=0)
    open_up = 1.0 + np.einsum("ij,ij->i", before, normal)
    if (open_up < 0.2).any():
        return None
    moved = points + distance * (before + normal) / open_up[:, None]
    new_edge = np.roll(moved, -1, axis=0) - moved
    if (np.einsum("ij,ij->i", edge, new_edge) <= 1e-3 * length).any() or not shapely.Polygon(moved).is_valid:
        return None
    return np.asarray(moved)


def tapered(polygon: Any, start: float, end: float, z_low: float, z_high: float) -> Block | None:
    """Gives block from z_low to z_high of a polygon moved outwards by start mm below and end mm above, or None where an
    edge would vanish.
    """
    low = moved_edges(ring(polygon), start)
    high = moved_edges(ring(polygon), end)
    return None if low is None or high is None else Block(shapely.Polygon(low), z_low, z_high, shapely.Polygon(high))
