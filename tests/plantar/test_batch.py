import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError, ReadingError, batch, fit_ground_plane, hex_layout, kernels
from plantar.batch import blocks, loads, support_polygons, wrenches
from plantar.layouts.curved_sole import rotations_to_normals

from ..examples import examples

OUTLINE = [[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]]
SOLE = hex_layout(OUTLINE)
seeds = st.integers(0, 2**32 - 1)


def recording(seed, layout=SOLE, frames=25):
    """Frames of patches, some taxels dead, saturated or drifting."""
    rng = np.random.default_rng(seed)
    shape = (frames, len(layout))
    force = np.where(rng.random(shape) < rng.random((frames, 1)), rng.uniform(0.0, 60.0, shape), 0.0)
    return np.where(rng.random(shape) < 0.03, rng.choice([np.nan, np.inf, -np.inf, -5.0, 785.0, 1e9], shape), force)


def test_loads_are_those_of_each_frame_to_the_last_bit():
    """Also where forces are of any size and sign, faulty, or all active, on soles flat and not."""
    slope = 5.0 * SOLE.positions[:, 0]
    normals = np.column_stack([-np.sin(slope), np.zeros(len(SOLE)), np.cos(slope)])
    for sole in (SOLE, replace(SOLE, rotations=rotations_to_normals(normals))):
        force = recording(5, sole, frames=200) * np.where(np.arange(200) % 3, 1.0, -1.0)[:, None]
        force[::7] *= 1e300
        force[3] = -0.0
        for threshold in (None, 0.0, -np.inf):
            found = loads(sole, force, threshold)
            low = sole.force_threshold if threshold is None else threshold
            alone = np.array([sole.kernel.loads(row, (row > low) & (row < sole.force_limit)) for row in force])
            got = np.column_stack([found.wrench, found.contact_area, found.center_of_pressure])
            assert got.view(np.int64).tolist() == alone.view(np.int64).tolist()


def test_polygons_are_found_without_walking_from_the_start():
    """A frame at the end costs what one at the start does: the sizes are summed up once."""

    class Sizes(np.ndarray):
        read = 0

        def __getitem__(self, key):
            Sizes.read += np.size(super().__getitem__(key))
            return super().__getitem__(key)

    force = np.nan_to_num(recording(6, frames=400), nan=0.0, posinf=0.0, neginf=0.0)
    found = support_polygons(SOLE, force, vertices=True)
    last = found.polygon(399)
    assert found.polygon(-1).tolist() == last.tolist()
    counted = replace(found, size=found.size.view(Sizes))
    for frame in range(400):
        assert counted.polygon(frame).tolist() == found.polygon(frame).tolist()
    assert Sizes.read <= 2 * 400
    with pytest.raises(IndexError):
        found.polygon(400)


def test_a_recording_streams_from_disk(tmp_path):
    force = np.nan_to_num(recording(4, frames=103), nan=0.0, posinf=0.0, neginf=0.0)
    np.save(tmp_path / "force.npy", force)
    stored = np.load(tmp_path / "force.npy", mmap_mode="r")
    seen = 0
    for rows, part in blocks(stored, frames=10):
        assert np.shares_memory(part, stored)
        assert loads(SOLE, part).wrench.tolist() == loads(SOLE, force).wrench[rows].tolist()
        seen += len(part)
    assert seen == 103
    out = np.lib.format.open_memmap(tmp_path / "wrench.npy", "w+", np.float64, (103, 6))
    assert wrenches(SOLE, stored, out=out) is out
    assert out.tolist() == wrenches(SOLE, force).tolist()


def test_a_contiguous_recording_is_not_copied():
    import tracemalloc

    frames = 20000 if kernels.compiled else 500
    force = np.zeros((frames, len(SOLE)))
    wrenches(SOLE, force[:1])
    for function, size in ((wrenches, 6), (loads, 9), (support_polygons, 4)):
        tracemalloc.start()
        function(SOLE, force)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < frames * 8 * (size + 2) + 50_000, function.__name__


def test_the_empty_recording_and_the_unloaded_one():
    for frames in (0, 3):
        force = np.zeros((frames, len(SOLE)))
        assert wrenches(SOLE, force).tolist() == [[0.0] * 6] * frames
        assert loads(SOLE, force).contact_area.tolist() == [0.0] * frames
        polygons = support_polygons(SOLE, force, vertices=True)
        assert polygons.area.tolist() == [0.0] * frames
        assert polygons.vertices.shape == (0, 2)
        assert [polygons.polygon(i).shape for i in range(frames)] == [(0, 2)] * frames


def test_a_threshold_of_minus_infinity_counts_every_finite_force():
    force = np.full((1, len(SOLE)), -1.0)
    assert wrenches(SOLE, force, -math.inf)[0, 2] == -len(SOLE)


def test_other_bad_input_is_named():
    with pytest.raises(ReadingError, match="out has shape"):
        wrenches(SOLE, np.zeros((2, len(SOLE))), out=np.empty((3, 6)))
    constant = np.empty((2, 6))
    constant.flags.writeable = False
    with pytest.raises(ReadingError, match="writeable"):
        wrenches(SOLE, np.zeros((2, len(SOLE))), out=constant)
    with pytest.raises(InputError, match="frames of a block"):
        next(blocks(np.zeros((2, 3)), 0))
    for wrong in ({"threshold": math.nan}, {"threshold": "x"}):
        with pytest.raises(InputError, match="activation threshold"):
            batch.loads(SOLE, np.zeros((2, len(SOLE))), **wrong)
    with pytest.raises(InputError, match="layout"):
        batch.loads(None, np.zeros(3))
    with pytest.raises(ReadingError, match="vertices=True"):
        support_polygons(SOLE, np.zeros((2, len(SOLE)))).polygon(0)


@given(seeds)
@examples(30)
def test_ground_planes_are_those_of_the_frames(seed):
    rng = np.random.default_rng(seed)
    slope = rng.uniform(-0.2, 0.2, (20, 1)) * SOLE.positions[:, 0]
    distance = 0.02 + slope + np.where(rng.random((20, len(SOLE))) < 0.2, rng.normal(0.0, 0.02, (20, len(SOLE))), 0.0)
    distance[rng.random(distance.shape) < 0.1] = rng.choice([np.nan, np.inf, -np.inf])
    distance[:3] = np.inf
    distance[3, 1:] = np.nan
    planes = batch.ground_planes(SOLE, distance)
    for k, row in enumerate(distance):
        plane = fit_ground_plane(SOLE, row)
        assert (plane is None) == (planes.directions[k] < 0)
        if plane is None:
            assert np.isnan([planes.height[k], *planes.slope[k], planes.residual[k]]).all()
            assert not planes.inliers[k].any()
        else:
            assert (planes.height[k], *planes.slope[k], planes.residual[k]) == (
                plane.height,
                *plane.slope,
                plane.residual,
            )
            assert (planes.inliers[k] == plane.inliers).all()
            assert planes.directions[k] == plane.directions


def test_ground_planes_take_any_array_of_numbers():
    distance = np.full((4, len(SOLE)), 0.03, dtype=np.float32)
    assert batch.ground_planes(SOLE, distance[::2]).height == pytest.approx([0.03, 0.03], rel=1e-6)
    assert batch.ground_planes(SOLE, distance[:0]).inliers.shape == (0, len(SOLE))
    with pytest.raises(ReadingError, match="distances have shape"):
        batch.ground_planes(SOLE, distance[:, 1:])
    with pytest.raises(InputError, match="tolerance of the ground plane"):
        batch.ground_planes(SOLE, distance, tolerance=0.0)


@pytest.mark.parametrize("lead", [(), (1,), (3, 4), (2, 3, 2), (0, 5), (5, 0, 2)])
@pytest.mark.parametrize("contiguous", [True, False])
def test_dimensions_before_the_taxels_are_those_of_the_results(lead, contiguous):
    """Environments, time and soles in any number: each frame is what it is alone."""
    n = len(SOLE)
    force = np.resize(recording(11, frames=12), (*lead, n))
    if not contiguous:
        force = np.asfortranarray(force)
    flat = force.reshape(-1, n)
    height = np.where(np.nan_to_num(force) > 0.0, 0.03, np.inf)
    found, alone = loads(SOLE, force), loads(SOLE, flat)
    polygons, hulls = support_polygons(SOLE, force, vertices=True), support_polygons(SOLE, flat, vertices=True)
    planes, plain = batch.ground_planes(SOLE, height), batch.ground_planes(SOLE, height.reshape(-1, n))
    pairs = [
        (wrenches(SOLE, force), wrenches(SOLE, flat)),
        (wrenches(SOLE, force, out=np.empty((*lead, 6))), wrenches(SOLE, flat)),
        (found.vertical_force, alone.vertical_force),
        *((getattr(found, name), getattr(alone, name)) for name in vars(alone)),
        *((getattr(polygons, name), getattr(hulls, name)) for name in ("area", "centroid", "size")),
        *((getattr(planes, name), getattr(plain, name)) for name in vars(plain)),
    ]
    for given_shape, of_frames in pairs:
        assert given_shape.shape == (*lead, *of_frames.shape[1:])
        np.testing.assert_array_equal(given_shape.reshape(of_frames.shape), of_frames)
    for i, frame in enumerate(np.ndindex(*lead)):
        assert polygons.polygon(*frame).tolist() == hulls.polygon(i).tolist()
    with pytest.raises(IndexError, match="one a dimension"):
        polygons.polygon(*[0] * (len(lead) + 1))
