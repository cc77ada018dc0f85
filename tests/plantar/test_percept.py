import math
from functools import cached_property

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar import Percept, Reading, ReadingError, center_of_pressure, ground_reaction_wrench
from plantar import polygon as polygon_module
from plantar.polygon import signed_margin

MEMBERS = (
    "active",
    "active_force",
    "vertical_force",
    "contact_area",
    "position_cop_in_sole",
    "wrench_in_sole",
    "support_polygon_in_sole",
    "support_area",
    "area_ratio",
    "centroid_in_sole",
)
seeds = st.integers(0, 2**32 - 1)


def random_force(seed, n):
    """Taxels loaded in patches, some dead (NaN, inf), some with negative drift."""
    rng = np.random.default_rng(seed)
    force = np.where(rng.random(n) < rng.random(), rng.uniform(0.0, 60.0, n), 0.0)
    force[rng.random(n) < 0.05] = np.nan
    force[rng.random(n) < 0.05] = np.inf
    force[rng.random(n) < 0.05] = -30.0
    return force


def test_members_are_all_there_are():
    assert {k for k, v in vars(Percept).items() if isinstance(v, cached_property)} == set(MEMBERS)


def test_nothing_is_computed_before_it_is_asked_for_and_nothing_twice(sole):
    percept = Percept(sole, Reading(0.0, np.full(len(sole), 5.0)))
    assert not set(MEMBERS) & set(vars(percept))
    assert percept.position_cop_in_sole is percept.position_cop_in_sole
    assert set(MEMBERS) & set(vars(percept)) == {"active", "active_force", "position_cop_in_sole"}


def test_a_controller_that_asks_for_the_cop_never_pays_for_the_polygon(sole, monkeypatch):
    calls = []
    hull = polygon_module.convex_hull
    monkeypatch.setattr(polygon_module, "convex_hull", lambda points: calls.append(1) or hull(points))
    percept = Percept(sole, Reading(0.0, np.full(len(sole), 5.0)))
    assert percept.position_cop_in_sole is not None
    assert percept.wrench_in_sole[2] > 0.0
    assert calls == []
    assert percept.support_area > 0.0
    assert percept.centroid_in_sole is not None
    assert percept.area_ratio > 0.0
    assert calls == [1]


@pytest.mark.parametrize("value", [0.0, -5.0, 1.0, math.nan, math.inf])
def test_an_unloaded_sole_has_defined_answers(sole, value):
    percept = Percept(sole, Reading(0.0, np.full(len(sole), value)), force_threshold=1.0)
    assert not percept.active.any()
    assert percept.active_force.tolist() == [0.0] * len(sole)
    assert percept.vertical_force == 0.0
    assert percept.contact_area == 0.0
    assert percept.position_cop_in_sole is None
    assert percept.wrench_in_sole.tolist() == [0.0] * 6
    assert percept.support_polygon_in_sole.shape == (0, 2)
    assert percept.support_area == 0.0
    assert percept.area_ratio == 0.0
    assert percept.centroid_in_sole is None


@given(seeds)
@settings(max_examples=50)
def test_members_agree_with_their_definitions(sole, seed):
    force = random_force(seed, len(sole))
    percept = Percept(sole, Reading(0.0, force), force_threshold=2.0)
    active = [bool(math.isfinite(f) and f > 2.0) for f in force]
    assert percept.active.tolist() == active
    clean = np.array([f if on else 0.0 for f, on in zip(force, active, strict=True)])
    assert percept.active_force.tolist() == clean.tolist()
    assert percept.vertical_force == pytest.approx(clean.sum())
    assert percept.contact_area == pytest.approx(sum(a for a, on in zip(sole.areas, active, strict=True) if on))
    assert percept.wrench_in_sole == pytest.approx(ground_reaction_wrench(sole, clean))
    cop, expected = percept.position_cop_in_sole, center_of_pressure(sole, clean)
    assert (cop is None) == (expected is None) == (not any(active))
    if cop is not None:
        assert cop == pytest.approx(expected)


@given(seeds)
@settings(max_examples=50)
def test_support_polygon_is_the_hull_of_the_active_cells(sole, seed):
    percept = Percept(sole, Reading(0.0, random_force(seed, len(sole))))
    cells = [shapely.Polygon(sole.cell_polygon(i)) for i in np.flatnonzero(percept.active)]
    reference = shapely.MultiPolygon(cells).convex_hull
    polygon = percept.support_polygon_in_sole
    assert percept.support_area == pytest.approx(reference.area, rel=1e-6, abs=1e-15)
    assert percept.support_area >= percept.contact_area * (1 - 1e-9)
    assert percept.area_ratio == pytest.approx(percept.support_area / sole.sole_area)
    if not cells:
        return
    assert shapely.LinearRing(polygon).is_ccw
    assert {tuple(p) for p in polygon.tolist()} <= {tuple(v) for v in sole.vertices[:, :2].tolist()}
    assert signed_margin(polygon, percept.position_cop_in_sole) > 0.0
    assert percept.centroid_in_sole == pytest.approx(np.array(reference.centroid.coords[0]), abs=1e-9)


def test_one_active_taxel_is_its_cell(sole):
    force = np.zeros(len(sole))
    force[7] = 20.0
    percept = Percept(sole, Reading(0.0, force))
    assert percept.position_cop_in_sole == pytest.approx(sole.positions[7, :2])
    assert percept.contact_area == sole.areas[7]
    assert percept.support_area == pytest.approx(sole.areas[7], rel=1e-6)


def test_the_layouts_threshold_holds_unless_another_is_given(sole):
    reading = Reading(0.0, np.full(len(sole), 1.0))
    assert Percept(sole, reading).force_threshold == sole.force_threshold == pytest.approx(1.4715)
    assert not Percept(sole, reading).active.any()
    assert Percept(sole, reading, force_threshold=0.5).active.all()
    assert Percept(sole, reading, force_threshold=0.0).active.all()


def test_a_reading_of_another_sole_is_refused(sole):
    with pytest.raises(ReadingError, match=f"reading has 3 taxels; layout 'test sole' has {len(sole)}"):
        Percept(sole, Reading(0.0, np.zeros(3)))
