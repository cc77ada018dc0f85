"""Checks of the polygons and shapes: exact hulls, areas of cells, and members as the functions give them."""

from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.geometry import enclosing, inscribed, polygon
from plantar.geometry.outline import concave_outline

from .. import references as exact
from .soles import Block, numbers

SHAPES = {
    "inscribed_triangle_in_sole": inscribed.inscribed_triangle,
    "inscribed_parallelogram_in_sole": inscribed.inscribed_parallelogram,
    "inscribed_rectangle_in_sole": inscribed.inscribed_rectangle,
    "inscribed_rectangle_any_angle_in_sole": inscribed.inscribed_rectangle_any_angle,
    "inscribed_circle_in_sole": inscribed.inscribed_circle,
    "bounding_box_in_sole": enclosing.bounding_box,
    "oriented_box_in_sole": enclosing.oriented_box,
    "enclosing_parallelogram_in_sole": enclosing.enclosing_parallelogram,
}
"""Members of a percept, each with the function of a convex polygon that it is; their own tests compare these with exact
references on odd polygons."""

OUTLINE_SHAPES = {
    "outline_rectangle_in_sole": inscribed.rectangle_in_outline,
}


def strictly_convex(ring: NDArray[np.float64]) -> bool:
    """Whether each corner of a ring (k, 2) turns left, in fractions; a ring of fewer than three has none."""
    corners = [(Fraction(x), Fraction(y)) for x, y in ring.tolist()]
    turns = zip(corners, corners[1:] + corners[:1], corners[2:] + corners[:2], strict=True)
    return len(ring) < 3 or all(exact.turn(*corner) > 0 for corner in turns)


def _percept_support(block: Block) -> None:
    """Support polygon of each percept: the hull of its cells, in fractions; its area and centroid, the CoP inside."""
    layout = block.layout
    for active, percept in zip(block.active, block.percepts, strict=True):
        hull = percept.support_polygon_in_sole
        used = [vertex for cell, on in zip(layout.corners, active, strict=True) if on for vertex in cell]
        corners = layout.vertices[used, :2]
        assert strictly_convex(hull)
        assert {*map(tuple, hull.tolist())} <= {*map(tuple, corners.tolist())}
        area = exact.hull_area_exact(corners) if len(corners) else 0.0
        assert percept.support_area == pytest.approx(area, rel=1e-12)
        assert percept.area_ratio * layout.sole_area == pytest.approx(area, rel=1e-12)
        if not active.any():
            assert percept.centroid_in_sole is None
            continue
        size = float(np.ptp(hull, axis=0).max())
        rounding = 1e-12 * size + 1e-15 * float(np.abs(hull).max())
        assert percept.centroid_in_sole == pytest.approx(exact.centroid_exact(hull), abs=rounding)
        if percept.position_cop_in_sole is not None:
            assert polygon.signed_margin(hull, percept.position_cop_in_sole) >= -1e-9 * size


def _percept_outline(block: Block) -> None:
    """Concave outline: its area is that of the cells, no more than that of the hull; moved outlines."""
    layout = block.layout
    turn, shift = block.pose.rotation_sole_to_world, block.pose.position_in_world
    cells = np.array([abs(polygon.area(layout.cell_polygon(i))) for i in range(len(layout))])
    for active, percept in zip(block.active, block.percepts, strict=True):
        outline, wanted = percept.concave_outline_in_sole, float(active @ cells)
        assert outline.area == pytest.approx(wanted, rel=1e-12)
        assert outline.area <= percept.support_area * (1.0 + 1e-12)
        assert (outline.centroid is None) == (not active.any())
        assert np.isfinite(numbers(outline.centroid)).all()
        assert sum(map(len, outline.islands)) == len(outline)
        reach = (float(np.abs(shift).max()) + 1.0) * (float(np.ptp(outline.points, axis=0).max()) if wanted else 1.0)
        rounding = 1e-12 * wanted + 64.0 * 2.3e-16 * reach * (len(outline.points) + 1)
        assert outline.moved(turn, shift).area == pytest.approx(wanted, abs=rounding)
        assert concave_outline(layout, np.ascontiguousarray(active)).area == outline.area


def _percept_shapes(block: Block) -> None:
    """The members that are shapes, to the last bit those that the functions give."""
    for percept in block.percepts:
        for member, function in SHAPES.items():
            one, other = numbers(getattr(percept, member)), numbers(function(percept.support_polygon_in_sole))
            assert one.tolist() == other.tolist(), member
        for member, function in OUTLINE_SHAPES.items():
            one, other = numbers(getattr(percept, member)), numbers(function(percept.concave_outline_in_sole))
            assert one.tolist() == other.tolist(), member


SHAPE_CHECKS = (_percept_support, _percept_outline, _percept_shapes)
"""The checks of this module, each a function of a block."""
