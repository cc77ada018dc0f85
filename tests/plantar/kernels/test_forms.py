"""The compiled and the interpreted form of the kernels: the same source, the same bits."""

import os
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout, kernels
from plantar.kernels.geometry import clean, convex, hull
from plantar.kernels.skin import frames, sole

from ...examples import examples
from ..fuzz.dirty_rings import dirty_ring

ROOT = Path(__file__).resolve().parents[3]
CLEAN, CONVEX, FRAMES, HULL, SOLE = map(kernels.python_form, ("clean", "convex", "frames", "hull", "sole"))
seeds = st.integers(0, 2**32 - 1)
OUTLINE = [[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]]
LAYOUTS = [
    hex_layout(OUTLINE),
    hex_layout(OUTLINE, clip=False, angle=0.3, origin=(0.01, 0.003)),
    hex_layout(OUTLINE, clip=False, cell_area=200e-6),
]


def cloud_of(seed):
    """Points at any scale and place, with duplicates, lines and lattices, some not finite."""
    rng = np.random.default_rng(seed)
    cloud = rng.normal(size=(int(rng.integers(1, 90)), 2)) * 10.0 ** rng.integers(-6, 4)
    kind = rng.integers(4)
    if kind == 0:
        cloud = np.round(cloud, 1)
    elif kind == 1:
        cloud[:, 1] = 0.3 * cloud[:, 0]
    elif kind == 2:
        cloud[rng.random(len(cloud)) < 0.1] = rng.choice([np.nan, np.inf, -np.inf, 1e300])
    return cloud + rng.normal(size=2) * 10.0 ** rng.integers(-3, 7)


def same(a, b):
    """Whether two results agree to the last bit, NaN with NaN."""
    return np.array_equal(np.asarray(a, dtype=float), np.asarray(b, dtype=float), equal_nan=True)


def test_the_forms_come_from_one_source():
    for module, form in ((clean, CLEAN), (convex, CONVEX), (frames, FRAMES), (hull, HULL), (sole, SOLE)):
        assert Path(form.__file__).suffix == ".py"
        assert Path(form.__file__).parent == Path(module.__file__).parent
        assert form is not module
    assert SOLE.convex is CONVEX
    assert kernels.compiled == (not convex.__file__.endswith(".py"))


@given(seeds)
@examples(100)
def test_convex_kernels_agree_to_the_last_bit(seed):
    cloud = cloud_of(seed)
    rng = np.random.default_rng(seed)
    ring = hull.convex_hull(cloud)
    assert same(ring, HULL.convex_hull(cloud))
    if len(ring) == 0:
        return
    if rng.random() < 0.3:
        ring = ring[::-1]
    assert convex.area(ring) == CONVEX.area(ring)
    assert same(convex.area_and_centroid(ring), CONVEX.area_and_centroid(ring))
    x, y = (ring.mean(axis=0) + rng.normal(size=2) * np.ptp(ring) * rng.choice([0.0, 0.1, 1.0])).tolist()
    assert same(convex.closest_point(ring, x, y), CONVEX.closest_point(ring, x, y))
    assert same(convex.nearest(ring, x, y), convex.closest_point(ring, x, y))
    assert same(CONVEX.nearest(ring, x, y), CONVEX.closest_point(ring, x, y))
    assert same(convex.signed_margin(ring, x, y), CONVEX.signed_margin(ring, x, y))
    if len(ring) > 2:
        distance = float(np.ptp(ring, axis=0).max() * rng.choice([1e-9, 0.1, 0.3, 2.0]))
        assert same(convex.inner_offset(ring, distance), CONVEX.inner_offset(ring, distance))


@given(seeds)
@examples(100)
def test_dirty_rings_agree_to_the_last_bit(seed):
    rng = np.random.default_rng(seed)
    ring = dirty_ring(rng)
    x, y = ring[rng.integers(len(ring))].tolist()
    for x0, y0, near in ((0.0, 0.0, 0.0), (x, y, 0.0), (x, y, float(np.ptp(ring)) * 1e-3)):
        assert clean.turning(ring, x0, y0, near) == CLEAN.turning(ring, x0, y0, near)
        assert same(clean.clean_ring(ring, x0, y0, near), CLEAN.clean_ring(ring, x0, y0, near))
    assert clean.extent(ring) == CLEAN.extent(ring)
    x, y = (ring.mean(axis=0) + rng.normal(size=2) * np.ptp(ring)).tolist()
    assert same(convex.closest_point(ring, x, y), CONVEX.closest_point(ring, x, y))
    assert convex.signed_margin(ring, x, y) == CONVEX.signed_margin(ring, x, y)
    distance = float(np.ptp(ring, axis=0).max() * rng.choice([1e-9, 0.1, 2.0]))
    assert same(convex.inner_offset(ring, distance), CONVEX.inner_offset(ring, distance))


@given(seeds, st.sampled_from(LAYOUTS))
@examples(60)
def test_kernels_of_a_sole_agree_to_the_last_bit(seed, layout):
    rng = np.random.default_rng(seed)
    n = len(layout)
    force = np.where(rng.random((5, n)) < rng.random((5, 1)), rng.uniform(0.0, 60.0, (5, n)), rng.choice([0.0, np.nan]))
    k = layout.kernel
    prepared = (layout.positions, layout.rotations[:, :, 2], layout.areas, layout.vertices[:, :2])
    p = SOLE.SoleKernel(*prepared, layout.corner_start, layout.corner_vertex)
    for row in force:
        active = row > 1.47
        assert same(k.loads(row, active), p.loads(row, active))
        (one, *measures), (two, *expected) = k.hull(active), p.hull(active)
        assert same(one, two)
        assert same(measures, expected)
    results = []
    for module, kernel in ((frames, k), (FRAMES, p)):
        wrench, sums = np.empty((5, 6)), np.empty((5, 9))
        size, measure, points = np.empty(5, dtype=np.intp), np.empty((5, 3)), np.zeros((300, 2))
        module.wrenches(kernel, force, 1.47, 50.0, wrench)
        module.loads(kernel, force, 1.47, 50.0, sums)
        done = module.hulls(kernel, force, 1.47, 50.0, size, measure, points)
        results.append([wrench, sums, size, measure, points, done])
    for a, b in zip(*results, strict=True):
        assert same(a, b)


def test_the_interpreted_form_divides_by_nothing():
    """Where C gives inf or NaN in silence, Python raises or warns: neither may ever come to it."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for ring in ([[0.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]], [[1.0, 1.0]] * 3, [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]):
            polygon = np.array(ring)
            HULL.convex_hull(polygon)
            CONVEX.area_and_centroid(polygon)
            CONVEX.closest_point(polygon, 0.0, 0.0)
            if len(polygon) > 2:
                CONVEX.inner_offset(polygon, 0.1)


def test_an_environment_variable_runs_the_sources():
    code = "from plantar import kernels, polygon\nfrom plantar.kernels.geometry import convex\n"
    code += "print(kernels.compiled, convex.__file__, polygon.area([[0, 0], [2, 0], [2, 1]]))"
    for wanted, form in (("python", False), ("", not kernels.problem)):
        environment = {**os.environ, "PLANTAR_KERNELS": wanted}
        done = subprocess.run(
            [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True, cwd=ROOT
        )
        compiled, file, area = done.stdout.split()
        assert compiled == str(form)
        assert file.endswith(".so" if form else ".py")
        assert float(area) == 1.0
