import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout
from plantar.kernels import python_form
from plantar.kernels.geometry.cut_cells import cut_cells
from plantar.sensing.partial_contact import PartialContact
from plantar.sensing.proximity import cells_polygon

from ...examples import examples

SOLE = hex_layout([[-0.125, -0.075], [0.125, -0.075], [0.125, 0.075], [-0.125, 0.075]], clip=False)
CELLS = [shapely.Polygon(SOLE.cell_polygon(i)) for i in range(len(SOLE))]


def strip(width: float, middle: float, angle: float = 0.0) -> np.ndarray:
    n = np.array([math.cos(angle), math.sin(angle)])
    return np.array([[*n, middle + 0.5 * width], [*-n, -(middle - 0.5 * width)]])


def half_plane(line: np.ndarray) -> shapely.Polygon:
    normal, along = line[:2], np.array([-line[1], line[0]])
    foot = line[2] * normal
    return shapely.Polygon([foot + along, foot - along, foot - along - normal, foot + along - normal])


@examples(25)
@given(st.integers(0, 10**6))
def test_covered_cells_are_those_of_shapely(seed):
    rng = np.random.default_rng(seed)
    angles = rng.uniform(0.0, 2.0 * math.pi, int(rng.integers(0, 4)))
    lines = np.column_stack([np.cos(angles), np.sin(angles), rng.uniform(-0.05, 0.12, len(angles))])
    found = PartialContact(SOLE).cover(lines)
    for cell, row in zip(CELLS, found, strict=True):
        left = cell
        for line in lines:
            left = left.intersection(half_plane(line))
        assert row[0] == pytest.approx(left.area, abs=1e-15)
        if left.area > 1e-9:
            assert row[1:] / row[0] == pytest.approx([left.centroid.x, left.centroid.y], abs=1e-9)


def test_both_forms_of_the_kernel_agree_to_the_last_bit():
    rng = np.random.default_rng(4)
    points = np.ascontiguousarray(SOLE.vertices[SOLE.corner_vertex, :2])
    start = SOLE.corner_start.astype(np.intp)
    for _ in range(20):
        angles = rng.uniform(0.0, 2.0 * math.pi, 3)
        lines = np.column_stack([np.cos(angles), np.sin(angles), rng.uniform(-0.05, 0.12, 3)])
        results = []
        for form in (cut_cells, python_form("cut_cells").cut_cells):
            measure, chords = np.empty((len(SOLE), 3)), np.empty((len(SOLE), 3, 3))
            form(points, start, lines, np.empty((2, 12, 2)), np.empty((2, 12), dtype=np.intp), measure, chords)
            results.append((measure, chords))
        assert (results[0][0] == results[1][0]).all()
        assert (results[0][1] == results[1][1]).all()


@given(st.floats(0.07, 0.14), st.floats(-0.03, 0.03), st.floats(-0.08, 0.08), st.integers(0, 10**6))
def test_edges_of_a_strip_are_found_within_millimetres(width, middle, angle, seed):
    rng = np.random.default_rng(seed)
    fit, true = PartialContact(SOLE), strip(width, middle, angle)
    pressure = np.array([1.0, rng.uniform(-2.0, 2.0), rng.uniform(-4.0, 4.0)])
    load = fit.cover(true) @ pressure
    assert load.min() >= 0.0
    load *= 400.0 / load.sum()
    edges = fit.update(load, load > 1.0, noise=0.3, steps=12)
    whole = shapely.Polygon(fit.polygon(np.empty((0, 3))))
    truth = whole
    for line in true:
        truth = truth.intersection(half_plane(line))
    found = shapely.Polygon(edges.polygon)
    assert found.symmetric_difference(truth).area < 0.12 * truth.area
    corners = shapely.Polygon(cells_polygon(SOLE, load > 1.0))
    assert found.symmetric_difference(truth).area < corners.symmetric_difference(truth).area


@given(st.floats(-0.04, 0.04), st.floats(-0.03, 0.03), st.floats(1.0, 2000.0))
def test_expected_forces_carry_the_load_where_it_acts(x, y, load):
    forces = PartialContact(SOLE).expected(load, (x, y), strip(0.15, 0.0))
    assert forces.min() >= 0.0
    assert forces.sum() == pytest.approx(load, rel=1e-8)


def test_a_load_near_the_edge_lifts_the_rest_of_the_sole_off():
    fit = PartialContact(SOLE)
    even, heel = fit.expected(100.0, (0.0, 0.0), []), fit.expected(100.0, (-0.1, 0.0), [])
    assert (even > 0.0).all()
    assert (heel[SOLE.positions[:, 0] > 0.0] == 0.0).all()


def test_lines_between_seen_cells_turn_to_the_widest_gap():
    fit = PartialContact(SOLE)
    for angle in np.radians([-12.0, 0.0, 12.0]):
        supported = (SOLE.positions[:, :2] @ [math.cos(angle), math.sin(angle)]) < 0.02
        (line,) = fit.between(supported, ~supported)
        assert abs(math.atan2(line[1], line[0]) - angle) < math.radians(6.0)
        assert abs(line[2] - 0.02) < 0.008


def test_what_is_no_foothold_gives_no_edges():
    fit = PartialContact(SOLE)
    n = len(SOLE)
    assert len(fit.update(np.zeros(n), np.zeros(n, dtype=bool)).polygon) == 0
    assert len(fit.update(np.full(n, 10.0), np.ones(n, dtype=bool)).lines) == 0
    assert fit.between(np.zeros(n, dtype=bool), np.ones(n, dtype=bool)).shape == (0, 3)
    dead = np.full(n, 10.0)
    dead[3] = math.nan
    assert len(fit.update(dead, np.ones(n, dtype=bool)).lines) == 0
