import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError, Percept, Reading, mirrored
from plantar.mechanics.zmp import zmp_of_feet
from plantar.percepts.feet import FeetPercept
from plantar.percepts.sole_pose import SolePose

seeds = st.integers(0, 2**32 - 1)


def random_feet(sole, seed):
    rng = np.random.default_rng(seed)
    soles, percepts = (sole, mirrored(sole)), []
    for s in soles:
        force = np.where(rng.random(len(s)) < rng.random(), rng.uniform(0, 40, len(s)), 0.0)
        percepts.append(Percept(s, Reading(0.0, force, proximity=rng.uniform(0.0, 0.08, len(s)))))
    poses = [SolePose.flat(*rng.uniform(-0.3, 0.3, 2), yaw=rng.uniform(-1, 1)) for _ in soles]
    return percepts, poses


@given(seeds)
def test_composite_quantities_are_those_of_the_parts(sole, seed):
    percepts, poses = random_feet(sole, seed)
    feet = FeetPercept(percepts, poses)
    cops = feet.positions_cop_in_world
    expected = zmp_of_feet([None if c is None else c[:2] for c in cops], [p.vertical_force for p in percepts])
    if expected is None:
        assert feet.position_zmp_in_world is None
    else:
        assert feet.position_zmp_in_world == pytest.approx(expected, abs=1e-9)
    assert feet.contact_area == pytest.approx(sum(p.contact_area for p in percepts))
    for name, polygon in (
        ("support_polygon_in_sole", feet.support_polygon_in_world),
        ("preemptive_polygon_in_sole", feet.preemptive_polygon_in_world),
    ):
        points = [
            pose.to_world(np.column_stack([getattr(p, name), np.zeros(len(getattr(p, name)))]))[:, :2]
            for p, pose in zip(percepts, poses, strict=True)
        ]
        hull = shapely.MultiPoint(np.concatenate(points).round(9)).convex_hull
        assert (shapely.Polygon(polygon).area if len(polygon) else 0.0) == pytest.approx(hull.area, rel=1e-6)
    assert feet.support_area == pytest.approx(shapely.Polygon(feet.support_polygon_in_world).area, abs=1e-15)


def test_feet_in_the_air_have_defined_answers(sole):
    percepts = [Percept(sole, Reading(0.0, np.zeros(len(sole)))) for _ in range(2)]
    feet = FeetPercept(percepts, [SolePose.flat(0, 0.1), SolePose.flat(0, -0.1)])
    assert not vars(feet).keys() & {"wrench_in_world", "position_zmp_in_world"}
    assert feet.position_zmp_in_world is None
    assert feet.positions_cop_in_world == (None, None)
    assert feet.support_polygon_in_world.shape == (0, 2)
    assert feet.preemptive_polygon_in_world is None
    assert (feet.support_area, feet.contact_area) == (0.0, 0.0)
    assert feet.wrench_in_world.tolist() == [0.0] * 6
    with pytest.raises(InputError, match="one pose a percept"):
        FeetPercept(percepts, [])
