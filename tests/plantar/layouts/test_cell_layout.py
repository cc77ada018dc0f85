import math

import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st

from plantar import LayoutError, Percept, Reading, grid_layout, hex_layout, joined_layout, layout_of_cells, mirrored
from plantar.layouts import layout_file
from plantar.layouts.cell_layout import edge_neighbours, shared_vertices

seeds = st.integers(0, 2**32 - 1)
SQUARE = np.array([[0.0, 0.0], [0.02, 0.0], [0.02, 0.02], [0.0, 0.02]])


def moved(ring: np.ndarray, x: float, y: float = 0.0) -> np.ndarray:
    return ring + np.array([x, y])


def insole(seed: int) -> list[np.ndarray]:
    """Cells of all sizes: a rectangle cut again and again, at random, never at the same height twice."""
    rng = np.random.default_rng(seed)
    boxes = [(-0.12, -0.05, 0.12, 0.05)]
    for _ in range(int(rng.integers(1, 25))):
        x0, y0, x1, y1 = boxes.pop(int(rng.integers(len(boxes))))
        t = rng.uniform(0.3, 0.7)
        if x1 - x0 > y1 - y0:
            x = x0 + t * (x1 - x0)
            boxes += [(x0, y0, x, y1), (x, y0, x1, y1)]
        else:
            y = y0 + t * (y1 - y0)
            boxes += [(x0, y0, x1, y), (x0, y, x1, y1)]
    angle, shift = rng.uniform(-3, 3), rng.normal(0, 0.2, 2)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    rings = [np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]) @ turn.T + shift for x0, y0, x1, y1 in boxes]
    return [ring if rng.random() < 0.5 else ring[::-1] for ring in rings]


@given(seeds)
@example(124)  # two corners within a thousandth of the smallest cell
@example(307)  # GEOS gave a whole cell as the overlap of two that touch
def test_cells_that_touch_along_a_part_of_an_edge_are_neighbours(seed):
    rings = insole(seed)
    layout = layout_of_cells(rings)
    polygons = [shapely.Polygon(r) for r in rings]
    for i, one in enumerate(polygons):
        for j, other in enumerate(polygons):
            common = one.buffer(1e-7).intersection(other.buffer(1e-7)).area / 2e-7  # length in m
            if j != i and not 1e-6 < common < 5e-5:  # less is a corner, in between the tolerance may say either
                assert (j in layout.neighbours[i]) == (common > 1e-6)
    assert layout.areas == pytest.approx([p.area for p in polygons], rel=1e-6)
    assert layout.positions[:, :2] == pytest.approx(np.array([p.centroid.coords[0] for p in polygons]), abs=1e-9)
    assert layout.sole_area == pytest.approx(0.24 * 0.1, rel=1e-6)


@given(seeds)
def test_every_edge_inside_is_shared_by_two_cells_and_no_more(seed):
    """What an exact outline of a contact rests on: edges that one cell alone has make the sole's own outline."""
    layout = layout_of_cells(insole(seed))
    count: dict[tuple[int, int], int] = {}
    for ring in layout.corners:
        for a, b in zip(ring, [*ring[1:], ring[0]], strict=True):
            count[min(a, b), max(a, b)] = count.get((min(a, b), max(a, b)), 0) + 1
    assert max(count.values()) <= 2
    rim = sum(math.dist(*layout.vertices[list(e), :2]) for e, n in count.items() if n == 1)
    assert rim == pytest.approx(2 * (0.24 + 0.1), rel=1e-6)


def test_a_percept_of_an_insole_counts_each_cells_own_area():
    layout = layout_of_cells(insole(11))
    force = np.where(np.arange(len(layout)) % 3 == 0, 20.0, 0.0)
    percept = Percept(layout, Reading(0.0, force))
    assert percept.contact_area == pytest.approx(layout.areas[::3].sum())
    cells = shapely.MultiPolygon([shapely.Polygon(layout.cell_polygon(i)) for i in range(0, len(layout), 3)])
    assert percept.support_area == pytest.approx(cells.convex_hull.area, rel=1e-9)


def test_a_layout_of_cells_survives_its_file_and_the_mirror(tmp_path):
    layout = layout_of_cells(insole(5), name="insole", side="right")
    again = layout_file.read_layout(layout_file.write_layout(layout, tmp_path / "layout.json"))
    assert again.corners == layout.corners
    assert again.vertices.tolist() == layout.vertices.tolist()
    assert mirrored(again).side == "left"


def test_triangles_pentagons_and_squares_go_together():
    triangle = np.array([[0.02, 0.0], [0.04, 0.01], [0.02, 0.02]])
    house = np.array([[0.0, 0.02], [0.02, 0.02], [0.02, 0.03], [0.01, 0.04], [0.0, 0.03]])
    layout = layout_of_cells([SQUARE, triangle, house], ids=[7, 8, 9], cell_shape="mixed")
    assert layout.neighbours == ((1, 2), (0,), (0,))
    assert layout.ids.tolist() == [7, 8, 9]
    assert len(layout.vertices) == 8
    assert layout.cell_area == pytest.approx(3e-4)
    assert layout.sole_area == pytest.approx(4e-4 + 2e-4 + 3e-4)


def test_cells_apart_have_their_hull_as_outline_unless_another_is_given():
    apart = [SQUARE, moved(SQUARE, 0.05)]
    assert layout_of_cells(apart).sole_area == pytest.approx(0.07 * 0.02)
    outline = [[-0.01, -0.01], [-0.01, 0.03], [0.08, 0.03], [0.08, -0.01]]  # clockwise
    layout = layout_of_cells(apart, outline=outline)
    assert layout.sole_area == pytest.approx(0.09 * 0.04)
    assert shapely.LinearRing(layout.outline).is_ccw


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ([], "one cell or more"),
        ([SQUARE[:2]], "cell 0 is not a list of 3"),
        ([SQUARE, "square"], "cell 1 is not a list"),
        ([SQUARE[[0, 1, 3, 2]]], "cell 0 is not a simple polygon"),
        ([SQUARE * [1, 0]], "cell 0 is not a simple polygon"),
        ([SQUARE, moved(SQUARE, 0.01)], "cells 0 and 1 overlap by 200 mm"),
        ([SQUARE, moved(0.5 * SQUARE, 0.005, 0.005)], "cells 0 and 1 overlap by 100 mm"),
        ([SQUARE * np.nan], "finite"),
    ],
)
def test_what_is_no_layout_is_refused(cells, message):
    with pytest.raises(LayoutError, match=message):
        layout_of_cells(cells)
    for outline in ("round", [[0, 0], [1, 1]], [[0, 0], [1, 1], [1, 0], [0, 1]]):
        with pytest.raises(LayoutError, match="outline is not"):
            layout_of_cells([SQUARE], outline=outline)
    with pytest.raises(LayoutError, match="positions"):
        layout_of_cells([SQUARE], positions=[[0.0, 0.0], [1.0, 0.0]])


def test_joined_parts_keep_cells_positions_and_rotations():
    heel = hex_layout([[-0.1, -0.05], [0, -0.05], [0, 0.05], [-0.1, 0.05]], minimum_fraction=0.0)
    toes = grid_layout([[0, -0.05], [0.1, -0.05], [0.1, 0.05], [0, 0.05]], pitch=(0.01, 0.01))
    sole = joined_layout([heel, toes], name="both")
    assert (sole.name, sole.cell_shape, len(sole)) == ("both", "mixed", len(heel) + len(toes))
    assert sole.positions == pytest.approx(np.concatenate([heel.positions, toes.positions]))
    assert sole.areas.sum() == pytest.approx(0.02, rel=1e-4)
    assert sole.sole_area == pytest.approx(0.02, rel=1e-4)
    at_border = [i for i in range(len(heel)) if heel.cell_polygon(i)[:, 0].max() > -1e-9]
    assert all(max(sole.neighbours[i]) >= len(heel) for i in at_border)
    assert joined_layout([toes]).cell_shape == "rectangle"
    for parts, message in (([], "one part or more"), ([heel, mirrored(toes)], "both sides"), ([heel, heel], "overlap")):
        with pytest.raises(LayoutError, match=message):
            joined_layout(parts)


def test_edges_and_vertices_of_nothing():
    assert edge_neighbours([]) == ()
    assert shared_vertices([], 1e-6)[0].shape == (0, 2)
