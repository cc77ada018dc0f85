import copy
import math
import pickle

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout, kernels
from plantar.errors import InputError
from plantar.geometry.inscribed import rectangle_in_outline
from plantar.geometry.outline import Outline, concave_outline
from plantar.layouts.cell_edges import edge_table
from plantar.layouts.layout import SoleLayout

from ...examples import examples

seeds = st.integers(0, 2**32 - 1)


def layout_of(cells, weld=True):
    """A layout of given cells (polygons); equal corners share an index where `weld`."""
    vertices: list[tuple[float, float]] = []
    corners = []
    for cell in cells:
        ids = []
        for x, y in np.asarray(cell, dtype=float).tolist():
            if not weld or (x, y) not in vertices:
                vertices.append((x, y))
                ids.append(len(vertices) - 1)
            else:
                ids.append(vertices.index((x, y)))
        corners.append(tuple(ids))
    n = len(corners)
    polygons = [shapely.Polygon(c) for c in cells]
    x1, y1, x2, y2 = shapely.union_all(polygons).bounds
    return SoleLayout(
        name="cells",
        side="left",
        positions=np.array([[*p.centroid.coords[0], 0.0] for p in polygons]),
        rotations=np.broadcast_to(np.eye(3), (n, 3, 3)),
        vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
        corners=tuple(corners),
        neighbours=((),) * n,
        areas=np.array([p.area for p in polygons]),
        outline=np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]]),
        ids=np.arange(n),
        cell_shape="polygon",
    )


def squares(columns, rows, side=0.01, start=(0.0, 0.0)):
    x0, y0 = start
    return [
        [
            (x0 + i * side, y0 + j * side),
            (x0 + (i + 1) * side, y0 + j * side),
            (x0 + (i + 1) * side, y0 + (j + 1) * side),
            (x0 + i * side, y0 + (j + 1) * side),
        ]
        for i in range(columns)
        for j in range(rows)
    ]


def as_shape(outline):
    return shapely.union_all([shapely.Polygon(part[0], part[1:]) for part in outline.islands])


def check_against_shapely(layout, active):
    """Area, rings and place are those of shapely's union of the active cells."""
    outline = concave_outline(layout, active)
    cells = [shapely.Polygon(layout.cell_polygon(int(i))) for i in np.flatnonzero(active)]
    union = shapely.union_all(cells, grid_size=1e-9)  # on a grid: corners that differ in their last bits leave slivers
    assert outline.area == pytest.approx(sum(c.area for c in cells), rel=1e-12, abs=1e-18)
    islands = [g for g in shapely.get_parts(union) if g.geom_type == "Polygon"]
    assert len(outline.islands) >= len(islands)  # islands that meet in a point may count as one or as two
    assert len(outline) - len(outline.islands) == sum(len(p) - 1 for p in outline.islands)
    for part in outline.islands:
        assert shapely.Polygon(part[0], part[1:]).is_valid
    if len(outline):
        assert as_shape(outline).symmetric_difference(union).area < 1e-8 * math.sqrt(outline.area)
        centroid = shapely.union_all(cells, grid_size=1e-9).centroid.coords[0]
        assert outline.centroid == pytest.approx(centroid, abs=1e-8)
    for area, ring in zip(outline.ring_areas, outline.rings, strict=True):
        assert shapely.LinearRing(ring).is_ccw == (area > 0.0)
        assert len({tuple(p) for p in ring.tolist()}) == len(ring)
    return outline


@given(seeds, st.floats(0.0, 1.0), st.floats(-4.0, 4.0))
def test_outline_of_hexagons(seed, share, angle):
    layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], cell_area=4e-4, angle=angle)
    check_against_shapely(layout, np.random.default_rng(seed).random(len(layout)) < share)


def test_every_pattern_of_three_rows():
    """All 4096 patterns of 12 hexagons in three rows: islands, holes and corners that touch."""
    cells = [(q, r) for r in range(3) for q in range(4)]
    layout = hex_layout([[-1, -1], [1, -1], [1, 1], [-1, 1]], cell_area=4e-4, cells=cells)
    for pattern in range(2**12):
        active = (pattern >> np.arange(12) & 1).astype(bool)
        outline = concave_outline(layout, active)
        assert outline.area == pytest.approx(layout.areas[active].sum(), rel=1e-13)
        assert len(outline.islands) == _components(layout, active)
    ring = concave_outline(layout, np.array([0, 1, 1, 0, 1, 0, 1, 0, 1, 1, 0, 0], dtype=bool))
    assert [len(part) for part in ring.islands] == [2]


def _components(layout, active):
    """Number of groups of active cells that hang together by edges."""
    left = set(np.flatnonzero(active).tolist())
    groups = 0
    while left:
        groups += 1
        todo = [left.pop()]
        while todo:
            near = left & set(layout.neighbours[todo.pop()])
            left -= near
            todo += near
    return groups


@given(seeds, st.floats(0.0, 1.0))
def test_outline_of_a_square_grid_drops_straight_corners_and_parts_at_points(seed, share):
    layout = layout_of(squares(7, 5))
    active = np.random.default_rng(seed).random(35) < share
    outline = check_against_shapely(layout, active)
    for ring in outline.rings:
        before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
        assert (np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) > 1e-9).all()


def test_a_ring_that_touches_itself_is_a_rim_and_a_hole():
    """Eight squares round a missing one, one corner square missing too: the hole meets the outside in a point."""
    layout = layout_of(squares(3, 3))
    active = np.ones(9, dtype=bool)
    active[[0, 4]] = False
    outline = check_against_shapely(layout, active)
    assert sorted(round(a * 1e4, 9) for a in outline.ring_areas) == [-1.0, 8.0]


@given(seeds, st.floats(0.1, 1.0))
def test_outline_of_mixed_sizes_with_corners_inside_edges(seed, share):
    """Squares of 10, 5 and 10/3 mm side by side: T-junctions that no vertex index tells."""
    cells = squares(3, 4) + squares(4, 8, 0.005, (0.03, 0.0)) + squares(6, 12, 0.04 / 12, (0.05, 0.0))
    layout = layout_of(cells)
    active = np.random.default_rng(seed).random(len(cells)) < share
    check_against_shapely(layout, active)
    whole = concave_outline(layout, np.ones(len(cells), dtype=bool))
    assert (len(whole), len(whole.points)) == (1, 4)


@given(seeds)
def test_cells_that_share_no_vertices(seed):
    layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], cell_area=4e-4, angle=0.3)
    rng = np.random.default_rng(seed)
    cells = [layout.cell_polygon(i) + rng.normal(0.0, 1e-17, (len(c), 2)) for i, c in enumerate(layout.corners)]
    apart = layout_of(cells, weld=False)
    active = rng.random(len(cells)) < 0.7
    assert concave_outline(apart, active).area == pytest.approx(concave_outline(layout, active).area, rel=1e-12)
    assert len(concave_outline(apart, active)) == len(concave_outline(layout, active))


def test_clockwise_cells_are_turned():
    cells = [c[::-1] if i % 2 else c for i, c in enumerate(squares(4, 3))]
    assert concave_outline(layout_of(cells), np.ones(12, dtype=bool)).area == pytest.approx(12e-4, rel=1e-12)


@examples(30)
@given(seeds)
def test_cells_that_overlap_are_united(seed):
    rng = np.random.default_rng(seed)
    cells = [
        np.array([[0.0, 0.0], [0.02, 0.0], [0.02, 0.01], [0.0, 0.01]]) + rng.uniform(0.0, 0.05, 2) for _ in range(8)
    ]
    layout = layout_of(cells)
    union = shapely.union_all([shapely.Polygon(c) for c in cells])
    overlap = union.area < sum(shapely.Polygon(c).area for c in cells) * (1 - 1e-9)
    assert (edge_table(layout.vertices[:, :2], layout.corners) is None) == overlap
    assert concave_outline(layout, np.ones(8, dtype=bool)).area == pytest.approx(union.area, rel=1e-12)


@pytest.mark.parametrize(
    "cells",
    [
        [[(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (2, 1), (2, 2), (1, 2)]],
        [[(0, 0), (4, 0), (4, 4), (0, 4)]] * 2,
        [[(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 0), (4, 0), (4, 2), (0, 2)]],
    ],
)
def test_a_cell_inside_another_is_found(cells):
    layout = layout_of([np.array(c) * 0.01 for c in cells])
    outline = concave_outline(layout, np.ones(2, dtype=bool))
    assert (len(outline), round(outline.area, 12)) == (1, 16e-4)


def test_an_unloaded_sole_has_an_empty_outline(sole):
    outline = concave_outline(sole, np.zeros(len(sole), dtype=bool))
    assert (len(outline), outline.area, outline.centroid, outline.points.shape) == (0, 0.0, None, (0, 2))
    assert outline.islands == ()
    assert len(outline.moved(np.eye(2), [1.0, 0.0])) == 0


def test_a_layout_that_has_been_outlined_can_be_copied(sole):
    concave_outline(sole, np.ones(len(sole), dtype=bool))
    assert sole.kernel is not None  # compiled objects do not pickle; they are made anew
    for twin in (pickle.loads(pickle.dumps(sole)), copy.deepcopy(sole)):
        assert concave_outline(twin, np.ones(len(sole), dtype=bool)).area == pytest.approx(sole.areas.sum(), rel=1e-12)
        assert all(np.array_equal(getattr(twin, k), getattr(sole, k)) for k in ("positions", "vertices", "outline"))
        assert not twin.positions.flags.writeable


@given(st.floats(-math.pi, math.pi), st.floats(-1e6, 1e6))
def test_a_moved_outline_keeps_its_area(angle, shift):
    layout = layout_of(squares(3, 3))
    outline = concave_outline(layout, np.array([1, 1, 1, 1, 0, 1, 1, 1, 1], dtype=bool))
    c, s = math.cos(angle), math.sin(angle)
    moved = outline.moved([[c, -s], [s, c]], [shift, -shift])
    assert moved.area == pytest.approx(outline.area, rel=1e-13 + 1e-13 * abs(shift) * 1e3)
    mirrored = outline.moved(np.diag([1.0, -1.0]), [0.0, 0.0])
    assert mirrored.area == pytest.approx(outline.area, rel=1e-14)


SQUARE = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]


@pytest.mark.parametrize(
    ("points", "starts", "areas", "text"),
    [
        (SQUARE, [0, 100], [1.0], r"offsets of an outline are \[0, 100\]; expected 0 to 4"),
        (SQUARE, [0, 4, 10**9], [1.0, 1.0], "offsets"),
        (SQUARE, [-5, 4], [1.0], "offsets"),
        (SQUARE, [0, 4, 4], [1.0, 0.0], "offsets"),
        (SQUARE, [4, 0], [1.0], "offsets"),
        (SQUARE, [0], [], "offsets"),
        (SQUARE, [], [], "offsets"),
        (SQUARE, [0, 4.0], [1.0], "whole numbers"),
        (SQUARE, None, [1.0], "whole numbers"),
        (SQUARE, [0, 4], [2.0], "areas of an outline are .2.; those of its rings are .1."),
        (SQUARE, [0, 4], [np.nan], "not finite"),
        (SQUARE, [0, 4], 1.0, "areas of an outline: shape"),
        ([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], [0, 3], [0.0], "areas"),
        (np.zeros((4, 3)), [0, 4], [1.0], "points of an outline: shape"),
        ([*SQUARE[:3], [0.0, np.nan]], [0, 4], [1.0], "not finite"),
        (None, [0, 4], [1.0], "not numeric"),
        ([], [0, 4], [1.0], "offsets"),
    ],
)
def test_an_outline_made_by_hand_is_checked(points, starts, areas, text):
    """Compiled kernels go where the offsets say: they once read what is not there, and the process died."""
    with pytest.raises(InputError, match=text):
        Outline(points, starts, areas)


def test_an_outline_made_by_hand_is_one():
    made, right = Outline(SQUARE, [0, 4], [1.0]), Outline.of_rings([SQUARE])
    assert made.points.tolist() == right.points.tolist()
    assert (made.area, made.starts, made.centroid.tolist()) == (1.0, (0, 4), [0.5, 0.5])
    assert rectangle_in_outline(made).tolist() == rectangle_in_outline(right).tolist()


def outlines(sole):
    given = np.array(SQUARE)
    yield "of rings", Outline.of_rings([given])
    yield "by hand", Outline(given, [0, 4], [1.0])
    yield "of a contact", concave_outline(sole, np.ones(len(sole), dtype=bool))
    yield "moved", Outline.of_rings([given]).moved(np.eye(2), [1.0, 0.0])
    given[:] = 7.0  # a change to what an outline was made of


def test_outlines_and_their_copies_are_read_only(sole):
    for name, outline in outlines(sole):
        for one in (outline, copy.copy(outline), copy.deepcopy(outline), pickle.loads(pickle.dumps(outline))):
            assert one.points.tolist() == outline.points.tolist(), name
            assert (one.starts, one.ring_areas) == (outline.starts, outline.ring_areas), name
            for array in (one.points, *one.rings, one.centroid, *one.islands[0]):
                with pytest.raises(ValueError, match="read-only"):
                    array[0] = 0.0
            with pytest.raises(TypeError, match="item assignment"):
                one.starts[1] = 10**6


@pytest.mark.skipif(not kernels.compiled, reason="plain Python cannot keep others from assigning")
def test_an_outline_keeps_what_it_is(sole):
    outline = Outline.of_rings([SQUARE])
    for name in ("points", "starts", "ring_areas"):
        with pytest.raises(AttributeError):
            setattr(outline, name, None)


def test_rings_that_are_none_and_what_is_no_rotation_are_refused_by_name():
    with pytest.raises(InputError, match="rings is None"):
        Outline.of_rings(None)
    with pytest.raises(InputError, match="rotation"):
        Outline.of_rings([SQUARE]).moved(2.0 * np.eye(2), [0, 0])
