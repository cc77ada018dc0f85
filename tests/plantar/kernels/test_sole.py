"""Kernels of one sole against hulls in exact fractions; their sums are checked in tests/plantar/fuzz/members.py."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import ReadingError, hex_layout
from plantar.geometry.polygon import area, centroid, convex_hull
from plantar.kernels import python_form
from plantar.kernels.skin.sole import SoleKernel
from plantar.layouts.hex_lattice import HexLattice
from plantar.sensing.health import dead_taxels, saturated_taxels

from ...examples import examples
from ..references import hull_area_exact

OUTLINE = [[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]]
LAYOUTS = {
    "clipped": hex_layout(OUTLINE),
    "whole": hex_layout(OUTLINE, clip=False),
    "turned": hex_layout(OUTLINE, clip=False, angle=1.1, origin=(0.007, 0.002)),
    "upright": hex_layout(OUTLINE, clip=False, angle=math.pi / 2),
    "small": hex_layout(OUTLINE, cell_area=150e-6),
}
INTERPRETED = python_form("sole")
seeds = st.integers(0, 2**32 - 1)
layouts = st.sampled_from(sorted(LAYOUTS))


def kernel_arguments(layout):
    """What the kernel of a layout is made of."""
    cells = (layout.vertices[:, :2], layout.corner_start, layout.corner_vertex)
    return layout.positions, layout.rotations[:, :, 2], layout.areas, *cells


def corners_of(layout, active):
    """Corners of the active cells, cell by cell."""
    return np.concatenate([layout.cell_polygon(int(i)) for i in np.flatnonzero(active)])


@given(seeds, layouts)
@examples(100)
def test_hull_is_that_of_the_active_cells_corners(seed, name):
    layout = LAYOUTS[name]
    rng = np.random.default_rng(seed)
    active = rng.random(len(layout)) < rng.random()
    active[rng.integers(len(layout))] = True
    polygon, size, x, y = layout.kernel.hull(active)
    above = layout.kernel.hull_above(np.where(active, 5.0, 1.0), 1.0, 9.0)
    assert (above[0].tobytes(), *above[1:]) == (polygon.tobytes(), size, x, y)
    assert polygon.tolist() == convex_hull(corners_of(layout, active)).tolist()
    assert size == pytest.approx(hull_area_exact(corners_of(layout, active)), rel=1e-12)
    assert size == pytest.approx(area(polygon), rel=1e-15)
    assert (x, y) == pytest.approx(centroid(polygon).tolist(), rel=1e-15)


def test_every_pattern_of_three_rows_has_the_exact_hull():
    """All 511 patterns of a 3 x 3 lattice, turned by every 30 degrees; GEOS gets some of such patterns wrong."""
    axial = [(q - r // 2, r) for r in range(3) for q in range(3)]
    for angle in np.arange(4) * math.pi / 6:
        lattice = HexLattice(691e-6, (0.013, -0.02), float(angle))
        layout = hex_layout(np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.2, angle=float(angle), cells=axial)
        keys = lattice.corner_keys(np.array(axial))
        unit = 0.5 * lattice.width * 0.5 * lattice.side
        for pattern in itertools.product([False, True], repeat=9):
            active = np.array(pattern)
            polygon, size, _x, _y = layout.kernel.hull(active)
            if not active.any():
                assert polygon.shape == (0, 2)
                continue
            integers = keys[active].reshape(-1, 2).tolist()
            assert size == pytest.approx(hull_area_exact(integers) * unit, rel=1e-12)


def test_cells_that_lie_on_each_other_hide_no_corner():
    """Three copies of one hexagon have angles of a full turn at each corner, and yet no cell surrounds it."""
    angle = np.arange(6) * math.pi / 3
    vertices = np.column_stack([np.cos(angle), np.sin(angle)])
    kernel = SoleKernel(np.zeros((3, 3)), [[0, 0, 1.0]] * 3, [1.0] * 3, vertices, [0, 6, 12, 18], list(range(6)) * 3)
    polygon, size, _x, _y = kernel.hull(np.ones(3, dtype=bool))
    assert len(polygon) == 6
    assert size == pytest.approx(1.5 * math.sqrt(3.0))


def test_a_sole_without_taxels():
    kernel = SoleKernel(np.empty((0, 3)), np.empty((0, 3)), [], np.empty((0, 2)), [0], [])
    assert kernel.hull(np.empty(0, dtype=bool))[0].shape == (0, 2)
    assert kernel.loads(np.empty(0), np.empty(0, dtype=bool))[:7].tolist() == [0.0] * 7


@pytest.mark.parametrize("limit", [785.0, math.inf, -1.0])
def test_faults_are_the_dead_and_the_saturated_taxels(limit):
    values = np.array([np.nan, np.inf, -np.inf, 785.0, np.nextafter(785.0, 0.0), 1e300, 0.0, -0.0, -5.0])
    layout = LAYOUTS["clipped"]
    force = np.resize(values, len(layout))
    dead, saturated = layout.kernel.faults(force, limit)
    assert dead.tolist() == dead_taxels(force).tolist()
    assert saturated.tolist() == saturated_taxels(force, limit).tolist()


@given(seeds, layouts, st.sampled_from([-math.inf, 0.0, 1.0, 5.0]), st.sampled_from([30.0, 785.0, math.inf]))
@examples(100)
def test_loads_of_an_unsaturated_sole_are_those_of_all_columns(seed, name, threshold, saturation):
    layout, rng = LAYOUTS[name], np.random.default_rng(seed)
    flat = layout.kernel
    curved = SoleKernel(np.add(layout.positions, [0.0, 0.0, 1e-300]), *kernel_arguments(layout)[1:])
    form = INTERPRETED.SoleKernel(*kernel_arguments(layout))
    assert (flat.flat, curved.flat) == (True, False)
    force = rng.choice([0.0, -0.0, 3.0, -8.0, 29.0, math.nan, -math.inf], len(layout)) * rng.choice([1.0, rng.random()])
    if rng.random() < 0.3:
        force[rng.integers(len(layout))] = rng.choice([30.0, 785.0, math.inf])
    told = [kernel.unsaturated_loads(force, threshold, saturation) for kernel in (flat, curved, form)]
    if (force >= saturation).any():
        assert told == [None] * 3
        return
    wanted = flat.loads_above(force, threshold, saturation)
    carries = math.isfinite(wanted[7])
    for found in told:
        assert found[: 9 if carries else 7].tobytes() == wanted[: 9 if carries else 7].tobytes()
        assert np.isnan(found[7:]).all() != carries
    on = (force > threshold) & (force < saturation)
    assert wanted[2] == pytest.approx(math.fsum(force[on]), rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("form", ["compiled or not", "interpreted"])
def test_arrays_of_another_length_are_refused_and_not_read_past(form):
    layout = LAYOUTS["whole"]
    kernel = layout.kernel if form != "interpreted" else INTERPRETED.SoleKernel(*kernel_arguments(layout))
    n = len(layout)
    force, mask = np.ones(n), np.ones(n, dtype=np.uint8)
    for size in (0, 1, n - 1, n + 1):
        few, some = np.ones(size), np.ones(size, dtype=np.uint8)
        for call in (
            lambda few=few: kernel.active(few, 0.0, 9.0),
            lambda few=few: kernel.faults(few, 9.0),
            lambda few=few: kernel.loads(few, mask),
            lambda few=few: kernel.loads_above(few, 0.0, 9.0),
            lambda few=few: kernel.unsaturated_loads(few, 0.0, 9.0),
            lambda few=few: kernel.hull_above(few, 0.0, 9.0),
            lambda few=few: kernel.tick(few, 0.0, 9.0, 0.0, 0.0, 0.0),
        ):
            with pytest.raises(ReadingError, match=f"{size} forces for {n} taxels"):
                call()
        for call in (lambda some=some: kernel.loads(force, some), lambda some=some: kernel.hull(some)):
            with pytest.raises(ReadingError, match=f"mask has {size} values for {n} taxels"):
                call()
    for call in (lambda: kernel.loads(None, mask), lambda: kernel.loads(force, None), lambda: kernel.hull(None)):
        with pytest.raises(ReadingError, match="no"):
            call()
