"""The largest rectangle at any angle in outlines of cells at random: never less than what is known, the gap true."""

import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar import InputError
from plantar.geometry.inscribed import rectangle_in_outline, rectangle_in_outline_any_angle
from plantar.geometry.outline import Outline, concave_outline
from plantar.geometry.polygon import area
from plantar.kernels import is_compiled
from plantar.kernels.geometry import concave, corridors, node_heap
from plantar.layouts.tiling import grid_layout, hex_layout

from ..fuzz.dirty_rings import dirty_ring

pytestmark = pytest.mark.skipif(not is_compiled("outline_search"), reason="too slow for the interpreted form")

seeds = st.integers(0, 2**32 - 1)
CELL = 1e-4


def random_cells(seed, most=1200):
    """Outline of a lattice of hexagons or squares, each cell active with some probability."""
    rng = np.random.default_rng(seed)
    cells, share = math.exp(rng.uniform(math.log(50), math.log(most))), rng.uniform(0.3, 0.9)
    a = math.sqrt(cells * CELL * rng.uniform(0.3, 1.0))
    b = cells * CELL / a
    ring, turn = [[0, 0], [a, 0], [a, b], [0, b]], rng.uniform(0.0, 1.0)
    if seed % 3 == 0:
        layout = grid_layout(ring, pitch=(math.sqrt(CELL), math.sqrt(CELL)), angle=turn)
    else:
        layout = hex_layout(ring, cell_area=CELL, angle=turn)
    outline = concave_outline(layout, rng.random(len(layout)) < share)
    turn = rng.uniform(0.0, 3.0) if seed % 2 else 0.0
    c, s = math.cos(turn), math.sin(turn)
    return outline.moved([[c, -s], [s, c]], rng.normal(size=2) * 10.0 ** rng.integers(-2, 3))


def whole(outline, angle, floor=0.0):
    """Area of the largest rectangle at an angle by trapezoids of whole islands, without windows or columns."""
    kernel, out = concave.OutlineRectangles(False), np.zeros(8)
    best = floor
    for k in range(kernel.take(outline.points, outline.starts, outline.apart)):
        if kernel.choose(k) <= best:
            break
        best = kernel.largest(angle, best, out)
    return best


def outside(outline, corners):
    """Share of a rectangle that shapely finds outside an outline."""
    base, size = outline.points[0], float(np.ptp(outline.points, axis=0).max())
    parts = [shapely.Polygon((i[0] - base) / size, [(h - base) / size for h in i[1:]]) for i in outline.islands]
    rectangle = shapely.Polygon((corners - base) / size)
    return shapely.area(shapely.difference(rectangle, shapely.union_all(parts))) / shapely.area(rectangle)


@settings(max_examples=40, deadline=None)
@given(seeds, st.sampled_from([0.0, 1e5, 1e6, 2e7]))
def test_no_scan_finds_more_than_the_gap_allows(seed, budget):
    outline = random_cells(seed)
    if not len(outline):
        return
    corners, gap = rectangle_in_outline_any_angle(outline, budget)
    found, axes = area(corners), area(rectangle_in_outline(outline))
    rounding = 1e-13 * float(np.abs(outline.points).max()) / math.sqrt(CELL)  # of the coordinates, as areas see it
    assert found >= axes * (1.0 - rounding)
    assert outside(outline, corners) < 1e-9
    step = corners[1] - corners[0]
    own = math.atan2(step[1], step[0])
    steps = max(4, 20000 // len(outline.points))
    angles = [*np.linspace(0.0, 0.5 * math.pi, steps), *(own + s * 10.0**-k for k in range(1, 7) for s in (-1, 1))]
    best = max(whole(outline, float(a)) for a in angles)
    assert found * (1.0 + gap) >= best * (1.0 - 1e-9)
    if budget > 1e7:
        assert gap == 1e-6


@settings(max_examples=40, deadline=None)
@given(seeds, st.floats(-4.0, 4.0))
def test_windows_hold_the_largest_rectangle_at_an_angle(seed, angle):
    outline = random_cells(seed, 2500)
    if not len(outline):
        return
    corners = rectangle_in_outline(outline, angle)
    assert area(corners) == pytest.approx(whole(outline, angle), rel=1e-8)
    assert outside(outline, corners) < 1e-9


@settings(max_examples=12, deadline=None)
@given(seeds)
def test_more_work_gives_no_less(seed):
    outline = random_cells(seed, 5000)
    if not len(outline):
        return
    before, share = 0.0, math.inf
    for budget in (0.0, 1e4, 1e5, 1e6, 5e6, 2e7):
        first, second = (rectangle_in_outline_any_angle(outline, budget) for _ in range(2))
        assert np.array_equal(first.corners, second.corners)
        assert first.gap == second.gap
        assert area(first.corners) >= before * (1.0 - 1e-9)
        assert first.gap <= share * (1.0 + 1e-9)
        before, share = area(first.corners), first.gap


@settings(max_examples=60, deadline=None)
@given(seeds)
def test_dirty_rings_get_no_less_than_along_the_axes(seed):
    rng = np.random.default_rng(seed)
    ring = dirty_ring(rng)
    if area(ring) < 0.0:
        ring = ring[::-1]
    outline = Outline.of_rings([ring])
    if not len(outline):
        return
    corners, gap = rectangle_in_outline_any_angle(outline)
    size = float(np.abs(outline.points).max() * np.ptp(outline.points, axis=0).max())
    assert area(corners) >= area(rectangle_in_outline(outline)) - 1e-13 * size
    assert gap >= 1e-6


@settings(max_examples=60, deadline=None)
@given(seeds)
def test_columns_leave_boxes_around_all_that_is_large(seed):
    """The largest rectangle at an angle within an interval lies in one of its boxes, and under its bound."""
    outline = random_cells(seed, 300)
    if not len(outline):
        return
    rng = np.random.default_rng(seed)
    half = math.exp(rng.uniform(math.log(1e-3), math.log(0.1)))
    middle, pitch_share = rng.uniform(0.0, math.pi), rng.uniform(0.05, 0.5)
    found = rectangle_in_outline(outline, middle + rng.uniform(-half, half))
    sides = np.hypot(*(np.roll(found, -1, axis=0) - found).T)
    if sides[0] < sides[1]:
        middle += 0.5 * math.pi
    kernel = corridors.Corridors(False)
    points = np.ascontiguousarray((outline.points - outline.points[0]).ravel())
    floor = area(found) * rng.uniform(0.5, 0.999)
    starts = np.array(outline.starts, dtype=np.intp)
    pitch = pitch_share * math.sqrt(floor)
    kernel.sweep(points, starts, len(outline), middle, half, pitch, floor, False)
    c, s = math.cos(middle), math.sin(middle)
    x, y = ((found - outline.points[0]) @ [[c, -s], [s, c]]).T
    slack = 1e-9 * float(np.abs(outline.points).max())
    boxes = np.array(kernel.box)[: 5 * kernel.boxes].reshape(-1, 5)
    around = (boxes[:, 0] <= x.min() + slack) & (boxes[:, 1] >= x.max() - slack)
    around &= (boxes[:, 2] <= y.min() + slack) & (boxes[:, 3] >= y.max() - slack)
    assert (around & (boxes[:, 4] >= area(found) * (1.0 - 1e-9))).any()


def test_intervals_come_by_their_bounds_those_of_one_bound_in_order():
    rng = np.random.default_rng(0)
    heap, kept = node_heap.NodeHeap(False), []
    for i in range(3000):
        if kept and rng.random() < 0.4:
            heap.pop()
            expected = min(kept, key=lambda n: (-n[0], n[1]))
            kept.remove(expected)
            assert (heap.bound, heap.place, heap.low, heap.high) == (*expected, 1.0, 2.0)
        else:
            bound = float(rng.integers(40))
            heap.push(bound, 1.0, 2.0, i)
            kept.append((bound, i))
        assert heap.size == len(kept)


@pytest.mark.parametrize("budget", [-1.0, math.nan, "much", None])
def test_a_budget_is_a_number_of_0_or_more(budget):
    square = Outline.of_rings([[[0, 0], [1, 0], [1, 1], [0, 1]]])
    with pytest.raises(InputError, match="budget"):
        rectangle_in_outline_any_angle(square, budget)


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(
    "work", ["rectangle_in_outline_any_angle(outline, float('inf'))", "rectangle_in_outline(outline)"]
)
def test_an_interrupt_ends_the_work_soon(work):
    code = f"""
import numpy as np
from plantar.geometry.inscribed import rectangle_in_outline, rectangle_in_outline_any_angle
from plantar.geometry.outline import Outline
rng = np.random.default_rng(0)
t = np.linspace(0.0, 2.0 * np.pi, 40000, endpoint=False)
r = 1.0 + 0.3 * rng.random(len(t))
outline = Outline.of_rings([np.column_stack([r * np.cos(t), r * np.sin(t)])])
print("ready", flush=True)
try:
    while True:
        {work}
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.5)
        begin = time.perf_counter()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        assert time.perf_counter() - begin < 1.0  # 0.1 s on a quiet machine
