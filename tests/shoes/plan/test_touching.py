"""Taxels that touch while their seats scatter: against one plate worked out by hand, and for every process."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog, minimize

from plantar.errors import FootError
from plantar.shoes.build import build_shoe
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.materials import PROCESSES
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.load_share import pad_modulus, spring_forces
from plantar.shoes.plan.strength import load_case
from plantar.shoes.plan.touching import check_touching, observability

FOOT = foot_from_dimensions("a", length=0.2, width=0.1, corner_radius=0.02, mass=60.0)


def test_foam_follows_the_figures_of_a_data_sheet():
    """Plastazote LD33: pressure at four compressions; the law has one constant, from the first of them."""
    p = ShoeParameters(pad_foam=40.0)
    for strain, pressure in ((0.25, 0.040), (0.40, 0.075), (0.50, 0.115), (0.60, 0.175)):
        assert pressure / strain == pytest.approx(pad_modulus(p, 1.0, 1.0, 1.0, pressure), rel=0.04)


def test_springs_balance_the_load_and_stay_below_the_energy_of_any_other_plate():
    chance = np.random.default_rng(3)
    points, heights = chance.uniform(-50, 50, (20, 2)), chance.normal(0.0, 0.1, (5, 20))
    points -= points.mean(axis=0)
    stiffness = chance.uniform(200, 800, 20)
    forces, _ = spring_forces(points, stiffness, -heights, 300.0)
    np.testing.assert_allclose(forces.sum(axis=1), 300.0, rtol=1e-6)
    np.testing.assert_allclose(forces @ points, 0.0, atol=1e-2)
    assert ((forces == 0.0).sum(axis=1) > 0).all()  # some do not touch
    u = np.column_stack([np.ones(20), points])
    for force, height in zip(forces, heights, strict=True):
        on = force > 0.0
        plate = np.linalg.lstsq(u[on], force[on] / stiffness[on] - height[on], rcond=None)[0]
        assert (u[~on] @ plate + height[~on]).max(initial=-1.0) <= 1e-6  # those that do not touch are above the ground

        def energy(x: np.ndarray, height: np.ndarray = height) -> float:
            return float(0.5 * stiffness @ np.maximum(u @ x + height, 0.0) ** 2 - 300.0 * x[0])

        assert energy(plate) <= minimize(energy, plate, method="Nelder-Mead").fun + 1e-6


def test_stiff_springs_touch_where_a_plate_rests_on_three():
    """Almost without load a plate rests on three seats: those that the lowest plane above all of them meets."""
    chance = np.random.default_rng(5)
    points, heights = chance.uniform(-50, 50, (12, 2)), chance.normal(0.0, 0.1, (1, 12))
    points -= points.mean(axis=0)
    touching = np.flatnonzero(spring_forces(points, np.full(12, 1e6), -heights, 1e-2)[0][0])
    u = np.column_stack([np.ones(12), points])
    plane = linprog([1.0, 0.0, 0.0], A_ub=-u, b_ub=-heights[0], bounds=[(None, None)] * 3).x
    assert set(touching) == set(np.flatnonzero(u @ plane - heights[0] < 1e-7))


@pytest.mark.sample(3)
@pytest.mark.parametrize("process", sorted(PROCESSES))
@pytest.mark.parametrize("mass", [4.0, 60.0])
def test_the_pad_is_soft_enough_for_every_process(process, mass):
    build = build_shoe(replace(FOOT, mass=mass), layout_only=True, parameters=ShoeParameters(process=process))
    assert build.touching.holds()
    p = build.parameters
    rubber = replace(p, pad_foam=0.0, pad_thickness=2.0)
    plan = build.shoes[0].plan
    hard = check_touching(plan, load_case(FOOT, p), rubber)
    assert hard.active < 0.6  # as the pad was before
    rough = replace(p, seat_scatter=3.0 * build.touching.scatter)
    assert check_touching(plan, load_case(replace(FOOT, mass=mass), p), rough).active < 0.95


def test_a_coupon_replaces_the_gaps_of_the_process():
    made = ShoeParameters(process="SLS", gap_slide=0.33, seat_scatter=0.02).made_by
    assert (made.name, made.slide, made.scatter, made.play) == ("SLS", 0.33, 0.02, PROCESSES["SLS"].play)
    assert ShoeParameters(material="PETG").made_by.name == "FDM"


def test_taxels_in_a_line_see_nothing_across_it():
    foot = foot_from_dimensions("a", length=0.2, width=0.04)
    seen = observability(build_shoe(foot, layout_only=True, taxels=5).shoes[0].plan)
    assert seen.across < 0.1
    assert not seen.holds


@pytest.mark.parametrize("length", [0.12, 0.24])
def test_cells_reach_farther_until_both_directions_are_seen(length):
    foot = foot_from_dimensions("a", length=length, width=0.5 * length, corner_radius=0.005)
    seen = observability(build_shoe(foot, layout_only=True).shoes[0].plan)
    assert seen.holds
    assert seen.error <= 0.4 * seen.width


def test_a_foot_on_which_no_cells_see_it_is_refused():
    with pytest.raises(
        FootError, match="do not see the center of pressure along and across this sole; allowed: --cell auto"
    ):
        build_shoe(foot_from_dimensions("a", length=0.065, width=0.03), layout_only=True)
