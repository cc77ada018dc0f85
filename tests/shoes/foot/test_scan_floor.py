"""Tests of the floor around a scanned foot: it is left out with the foot as it was, and no plate is one."""

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.foot.scan_floor import floor_of_scan

from ..foot_family import FAMILY, box, oval, prism, turned

OUTLINE = oval(250.0, 95.0, 40.0)


def scan(noise: float = 0.0) -> NDArray[np.float64]:
    """A foot without its lower side, as it stands on the floor of a scanner."""
    foot = prism(OUTLINE, 0.0, 60.0)
    foot = foot[~(foot[..., 2] == 0.0).all(axis=1)]
    low, high = OUTLINE.min(axis=0) - 60.0, OUTLINE.max(axis=0) + 60.0
    room = shapely.box(*low, *high).difference(shapely.Polygon(OUTLINE))
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(room.segmentize(20.0)))
    flat = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3]
    a, b = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    across = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    flat[across < 0.0] = flat[across < 0.0][:, ::-1]
    floor = np.concatenate([flat, np.zeros((len(flat), 3, 1))], axis=2)
    chance = np.random.default_rng(1)
    return np.concatenate([foot, floor + noise * chance.uniform(0.0, 1.0, floor.shape)])


@pytest.mark.parametrize(("noise", "pitch"), [(0.0, 0.0), (0.8, 0.0), (0.0, 4.0)])
def test_a_floor_around_a_scan_is_left_out(noise, pitch):
    foot = foot_from_triangles("scan", turned(scan(noise), 0.0, pitch, 0.0), where="scan")
    assert any("a floor around the foot is left out" in note for note in foot.notes)
    bare = shapely.Polygon(OUTLINE)
    assert foot.sole.area == pytest.approx(bare.area, rel=0.02)
    assert np.ptp(np.reshape(foot.sole.bounds, (2, 2)), axis=0) == pytest.approx([250.0, 95.0], abs=2.0)


def test_a_rough_floor_that_is_tilted_is_refused():
    with pytest.raises(FootError, match="no flat sole"):
        foot_from_triangles("scan", turned(scan(0.8), 0.0, 4.0, 0.0), where="scan")


@pytest.mark.parametrize("name", sorted(FAMILY))
def test_no_foot_of_the_family_has_a_floor(name):
    assert not floor_of_scan(FAMILY[name]()).any()


@pytest.mark.parametrize("thickness", [2.0, 4.0, 5.5, 8.0])
def test_a_thin_plate_below_an_ankle_is_a_sole(thickness):
    """Of one that is thicker than a floor may be rough, the lower side alone lies where a floor would."""
    plate = np.concatenate([box((-80, 150), (-45, 45), (0, thickness)), box((-20, 20), (-20, 20), (thickness, 60))])
    assert not floor_of_scan(plate).any()
    foot = foot_from_triangles("plate", plate, where="plate", file_unit="mm")
    assert np.ptp(np.reshape(foot.sole.bounds, (2, 2)), axis=0) == pytest.approx([230.0, 90.0], abs=0.1)
    assert foot.height == pytest.approx(60.0)
