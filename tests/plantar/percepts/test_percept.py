import copy
import inspect
import math
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import Percept, PerceptOptions, PlantarError, Reading, ReadingError, kernels
from plantar.geometry.outline import Outline
from plantar.kernels.skin.percept_fields import PerceptFields
from plantar.sensing.force import ground_reaction_wrench
from plantar.sensing.ground_plane import fit_ground_plane
from plantar.sensing.health import TaxelHealth
from plantar.sensing.proximity import preemptive_polygon
from plantar.sensing.temperature import temperature_footprint, temperature_wrench
from plantar.sensing.virtual_wrench import virtual_ground_reaction_wrench

from ...examples import examples
from ..fuzz.soles import numbers

MEMBERS = Percept.members()
seeds = st.integers(0, 2**32 - 1)


def test_nothing_is_computed_before_it_is_asked_for_and_nothing_twice(sole):
    percept = Percept(sole, Reading(0.0, np.full(len(sole), 5.0)))
    assert not set(MEMBERS) & set(vars(percept))
    assert percept.position_cop_in_sole is percept.position_cop_in_sole
    assert set(MEMBERS) & set(vars(percept)) == {"position_cop_in_sole"}


def test_a_controller_that_asks_for_the_cop_never_pays_for_the_polygon(sole, monkeypatch):
    found = []
    asked = PerceptFields._hull
    monkeypatch.setattr(Percept, "_hull", lambda self: found.append(asked(self)) or found[-1], raising=False)
    percept = Percept(sole, Reading(0.0, np.full(len(sole), 5.0)))
    assert percept.position_cop_in_sole is not None
    assert percept.wrench_in_sole[2] > 0.0
    assert found == []
    assert percept.support_area > 0.0
    assert percept.centroid_in_sole is not None
    assert percept.area_ratio > 0.0
    assert len(percept.support_polygon_in_sole) > 2
    assert len({id(hull) for hull in found}) == 1  # one walk for all of them


@pytest.mark.parametrize("first", ["support_area", "support_polygon_in_sole", "centroid_in_sole"])
def test_area_polygon_and_centroid_are_the_same_in_whatever_order_they_are_asked_for(sole, first):
    percept = Percept(sole, Reading(0.0, np.linspace(0.0, 20.0, len(sole))))
    getattr(percept, first)
    polygon, area, x, y = sole.kernel.hull(percept.active)
    assert percept.support_area == area
    assert percept.support_polygon_in_sole.tolist() == polygon.tolist()
    assert percept.centroid_in_sole.tolist() == [x, y]


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
    assert percept.zero_moment_wrench_in_sole is None
    assert percept.pressure_driven_wrench_in_sole.tolist() == [0.0] * 6


def test_the_layouts_threshold_holds_unless_another_is_given(sole):
    reading = Reading(0.0, np.full(len(sole), 1.0))
    assert Percept(sole, reading).force_threshold == sole.force_threshold == pytest.approx(1.4715)
    assert not Percept(sole, reading).active.any()
    assert Percept(sole, reading, force_threshold=0.5).active.all()
    assert Percept(sole, reading, force_threshold=0.0).active.all()


def test_faulty_taxels_are_left_out_of_every_sum_and_reported(sole):
    force = np.full(len(sole), 5.0)
    force[[2, 9]] = np.nan, 785.0
    stuck = np.arange(len(sole)) == 20
    percept = Percept(sole, Reading(0.0, force), stuck=stuck)
    sound = np.setdiff1d(np.arange(len(sole)), [2, 9, 20])
    assert np.flatnonzero(percept.health.faulty).tolist() == [2, 9, 20]
    assert str(percept.health) == f"1 dead, 1 saturated, 1 stuck of {len(sole)} taxels"
    assert np.flatnonzero(percept.active).tolist() == sound.tolist()
    assert percept.vertical_force == pytest.approx(5.0 * len(sound))
    assert percept.contact_area == pytest.approx(sole.areas[sound].sum())
    assert percept.wrench_in_sole == pytest.approx(
        ground_reaction_wrench(sole, np.isin(np.arange(len(sole)), sound) * 5.0)
    )
    assert percept.position_cop_in_sole == pytest.approx(sole.positions[sound, :2].mean(axis=0))
    assert np.isnan(percept.sound_force[[2, 9, 20]]).all()
    stuck[:] = True  # the percept has its own copy
    assert percept.health.stuck.sum() == 1


def test_faulty_taxels_can_take_their_neighbours_pressure(sole):
    force = 2e4 * sole.areas
    broken = force.copy()
    broken[[2, 30]] = np.nan, 785.0
    percept = Percept(sole, Reading(0.0, broken), options=PerceptOptions(fill=True))
    assert percept.active_force == pytest.approx(force)
    assert percept.wrench_in_sole == pytest.approx(ground_reaction_wrench(sole, force))
    assert percept.health.faulty.sum() == 2
    assert not Percept(sole, Reading(0.0, np.full(len(sole), np.nan)), options=PerceptOptions(fill=True)).active.any()


def test_activation_can_come_from_a_switch_with_hysteresis(sole):
    given = np.arange(len(sole)) < 5
    force = np.full(len(sole), 1.0)  # below the threshold of 1.47 N
    force[0] = np.nan
    percept = Percept(sole, Reading(0.0, force), active=given)
    assert np.flatnonzero(percept.active).tolist() == [1, 2, 3, 4]
    assert percept.vertical_force == pytest.approx(4.0)
    for name in ("active", "stuck"):
        with pytest.raises(ReadingError, match=f"mask '{name}'"):
            Percept(sole, Reading(0.0, force), **{name: given[:3]})


def test_a_modality_that_the_reading_lacks_is_none(sole):
    percept = Percept(sole, Reading(0.0, np.full(len(sole), 5.0)))
    ground = ("near", "preemptive_polygon_in_sole", "height_contours_in_sole", "virtual_wrench_in_sole")
    others = ("ground_plane_in_sole", "temperature_wrench_in_sole", "temperature_footprint_in_sole")
    for name in (*ground, *others, "acceleration_in_sole"):
        assert getattr(percept, name) is None, name


def test_members_of_the_other_modalities_are_those_of_their_functions(sole):
    rng = np.random.default_rng(4)
    n = len(sole)
    reading = Reading(
        0.0, np.full(n, 5.0), rng.uniform(0, 0.06, n), rng.uniform(20, 50, n), acceleration=rng.normal(0, 9, (n, 3))
    )
    percept = Percept(
        sole, reading, options=PerceptOptions(proximity_gain=80.0, contour_heights=(0.01, 0.03), reference_area=2e-3)
    )
    near = reading.proximity < 0.05
    assert percept.near.tolist() == near.tolist()
    assert percept.preemptive_polygon_in_sole.tolist() == preemptive_polygon(sole, reading.proximity, 0.05).tolist()
    assert [c.height for c in percept.height_contours_in_sole] == [0.01, 0.03]
    expected = virtual_ground_reaction_wrench(sole, reading.proximity, 80.0)
    assert percept.virtual_wrench_in_sole.tolist() == expected.tolist()
    assert percept.ground_plane_in_sole.height == fit_ground_plane(sole, reading.proximity).height
    assert percept.temperature_wrench_in_sole.tolist() == temperature_wrench(sole, reading.temperature).tolist()
    footprint = temperature_footprint(sole, reading.temperature)
    assert percept.temperature_footprint_in_sole.tolist() == footprint.tolist()
    assert percept.acceleration_in_sole == pytest.approx(reading.acceleration)  # level taxels
    point, wrench = percept.zero_moment_wrench_in_sole
    assert point[:2] == pytest.approx(percept.position_cop_in_sole)
    assert wrench == pytest.approx([0, 0, 5.0 * n, 0, 0, 0])
    gain = 2e-3 / percept.contact_area
    assert percept.pressure_driven_wrench_in_sole == pytest.approx(gain * percept.wrench_in_sole)


WILD = [np.nan, np.inf, -np.inf, 0.0, -0.0, -1.0, 1e-12, 0.02, 5.0, 40.0, 785.0, 1e9, 1e-300]


@given(seeds, st.booleans())
@examples(100 if kernels.compiled else 4)  # a search over angles takes seconds where it is interpreted
def test_no_reading_makes_a_member_raise_or_give_nan(sole, seed, fill):
    rng = np.random.default_rng(seed)
    wild = WILD if rng.random() < 0.5 else WILD[:4] + [30.0] * 4
    n = len(sole)
    reading = Reading(0.0, rng.choice(wild, n), rng.choice(wild, n), rng.choice(wild, n), rng.choice(wild, (n, 3)))
    percept = Percept(
        sole, reading, stuck=rng.random(n) < 0.1, active=rng.random(n) < 0.7, options=PerceptOptions(fill=fill)
    )
    for name in MEMBERS:
        found = numbers(getattr(percept, name))
        if name not in ("sound_force", "acceleration_in_sole"):  # where NaN stands for a dead taxel itself
            assert np.isfinite(found).all(), name


def test_a_reading_of_another_sole_is_refused(sole):
    with pytest.raises(ReadingError, match=f"reading has 3 taxels; layout 'test sole' has {len(sole)}"):
        Percept(sole, Reading(0.0, np.zeros(3)))


def arrays_in(value):
    """All arrays that a member's value holds, at any depth, and those that they are views of."""
    if isinstance(value, TaxelHealth):
        value = (value.dead, value.saturated, value.stuck, value.faulty)
    if isinstance(value, Outline):
        value = (value.points, value.rings, value.centroid, value.islands)
    if isinstance(value, tuple):
        return [a for part in value for a in arrays_in(part)]
    return [value] if isinstance(value, np.ndarray) else []


@pytest.mark.parametrize("name", MEMBERS)
def test_what_a_percept_keeps_cannot_be_changed(sole, name):
    n = len(sole)
    percept = Percept(sole, Reading(0.0, np.full(n, 5.0), np.full(n, 0.02), np.full(n, 40.0), np.zeros((n, 3))))
    for array in arrays_in(getattr(percept, name)):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


@pytest.mark.parametrize("name", ["wrench_in_sole", "position_cop_in_sole"])
def test_no_member_is_a_way_to_the_sums_that_others_are_made_of(sole, name):
    percept = Percept(sole, Reading(0.0, np.full(len(sole), 5.0)))
    view = getattr(percept, name)
    for array in (view, view.base):
        with pytest.raises(ValueError, match=r"WRITEABLE|read-only"):
            view.setflags(write=True)
        with pytest.raises(ValueError, match="read-only"):
            array[:] = 0.0
    assert percept.vertical_force == pytest.approx(5.0 * len(sole))


@pytest.mark.parametrize(
    ("argument", "value", "text"),
    [
        ("layout", None, "layout is None; expected a SoleLayout"),
        ("reading", np.zeros(3), "reading is an array of shape .3,.; expected a Reading"),
        ("force_threshold", "1", "force threshold is '1'"),
        ("force_threshold", np.nan, "force threshold is NaN"),
        ("options", {"fill": True}, "options is .*; expected a PerceptOptions"),
        ("active", "all", "mask 'active': holds"),
        ("stuck", [0, 4], "mask 'stuck': holds"),
    ],
)
def test_wrong_arguments_are_refused_by_name(sole, argument, value, text):
    given = {"layout": sole, "reading": Reading(0.0, np.zeros(len(sole))), argument: value}
    with pytest.raises(PlantarError, match=text):
        Percept(**given)


@pytest.mark.parametrize(
    ("option", "value", "text"),
    [
        ("fill", 1, "'fill' is 1; allowed: True or False"),
        ("proximity_gain", np.inf, "proximity gain is inf"),
        ("contour_heights", 0.01, r"heights of contours: shape \(\)"),
        ("contour_heights", ["low"], "heights of contours: not numeric"),
        ("reference_area", 0.0, "allowed: a finite value above 0"),
    ],
)
def test_wrong_options_are_refused_by_name(option, value, text):
    with pytest.raises(PlantarError, match=text):
        PerceptOptions(**{option: value})


def test_a_copied_percept_says_the_same(sole):
    active, stuck = np.arange(len(sole)) % 3 == 0, np.arange(len(sole)) % 5 == 0
    percept = Percept(sole, Reading(0.5, np.linspace(0.0, 30.0, len(sole))), 2.0, active=active, stuck=stuck)
    for again in (copy.copy(percept), copy.deepcopy(percept), pickle.loads(pickle.dumps(percept))):
        assert again.active.tolist() == percept.active.tolist()
        assert again.wrench_in_sole.tolist() == percept.wrench_in_sole.tolist()
        assert (again.force_threshold, again.reading.time) == (2.0, 0.5)


def test_signatures_are_told_though_a_kernel_constructs():
    assert list(inspect.signature(Percept).parameters)[:3] == ["layout", "reading", "force_threshold"]
    assert list(inspect.signature(Reading).parameters)[:2] == ["time", "force"]
    with pytest.raises(TypeError, match="argument"):
        Reading(0.0)


@pytest.mark.parametrize("time", [np.float64(1.0), 1, np.float32(1.0)])
def test_a_reading_takes_what_is_not_plain(time):
    near = [0.01, 0.02]
    reading = Reading(time, [1, 2], near, temperature=np.float32([20.0, 21.0]))
    assert isinstance(reading.time, float)
    assert reading.time == 1.0
    assert reading.proximity.tolist() == near
    assert reading.temperature.tolist() == [20.0, 21.0]
    assert not reading.proximity.flags.writeable
    for wrong in (np.zeros(3), np.zeros((2, 1)), ["a", "b"]):
        with pytest.raises(ReadingError, match="proximity"):
            Reading(time, [1, 2], wrong)
        with pytest.raises(ReadingError, match="proximity"):
            Reading(0.0, np.array([1.0, 2.0]), wrong)
    with pytest.raises(ReadingError, match="time"):
        Reading(np.nan, np.zeros(2))


def test_interpreted_kernels_construct_the_same():
    code = """
from dataclasses import FrozenInstanceError
import numpy as np
from plantar import Percept, Reading, hex_layout, kernels
from plantar.kernels.skin.percept_fields import unsaturated
layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
force = np.linspace(0.0, 20.0, len(layout))
told = [kernels.compiled]
for reading in (Reading(0.5, force), Reading.taken_over(0.5, force.copy())):
    for percept in (Percept(layout, reading), unsaturated(Percept, layout, reading)):
        told += [percept.vertical_force, percept.wrench_in_sole.tolist(), percept.support_area, percept.reading.time]
        told += [percept.contact_area, percept.force_threshold, percept.centroid_in_sole.tolist()]
    try:
        reading.time = 1.0
    except FrozenInstanceError:
        told.append("closed")
print(told)
"""
    found = []
    for form in ("", "python"):
        environment = {**os.environ, "PLANTAR_KERNELS": form}
        run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        found.append(run.stdout.partition(",")[2])
    assert found[0] == found[1]
    assert found[0].count("closed") == 2
