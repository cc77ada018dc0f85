"""Budget of the center of pressure: each cause alone against what follows by hand, and its limit by the use."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.shoes import ShoeParameters, build_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.plan.cop_budget import check_cop_budget
from plantar.shoes.plan.strength import load_case

FOOT = foot_from_dimensions("a", length=0.2, width=0.083, corner_radius=0.02, sole_center=(0.02, 0.0), mass=33.0)
CELL = replace(read_cell("velostat"), gain_scatter=0.0, hysteresis=0.0, crosstalk=0.0, rated_load=1e4, threshold=0.0)
QUIET = ShoeParameters(seat_scatter=1e-6)


def budget(**cell: float):
    build = build_shoe(FOOT, side="left", cell=replace(CELL, **cell), layout_only=True, parameters=QUIET)
    return build.cop, build


def test_without_faults_only_the_rim_is_left():
    found, build = budget()
    assert max(found.seats, found.gain, found.hysteresis, found.threshold, found.range, found.crosstalk) < 1e-6
    assert found.together == found.blind_rim
    assert 0.0 < found.blind_rim <= build.shoes[0].plan.blind_rim


def test_errors_of_gains_add_up_as_those_of_independent_cells():
    """The center of n equal loads is off by s sqrt(sum r^2) / n along each axis; 95 % of a plane's normal is 2.45."""
    found, build = budget(gain_scatter=0.1)
    at = build.shoes[0].plan.crossings
    spread = np.sqrt(((at - at.mean(axis=0)) ** 2).sum(axis=0))
    wanted = 0.1 * np.hypot(*spread) / len(at) * 2.45 / np.sqrt(2.0)
    # loads at the rim act on fewer cells, which are off by more
    assert wanted < found.gain < 3.0 * wanted
    assert found.together >= found.blind_rim
    assert budget(gain_scatter=0.2)[0].gain == pytest.approx(2.0 * found.gain, rel=0.1)


def test_what_is_not_read_or_read_by_others_moves_the_center():
    assert budget(threshold=1.5)[0].threshold > 0.2  # a light robot's layout lowers it
    assert budget(rated_load=2.0)[0].range > 1.0
    assert budget(crosstalk=0.2)[0].crosstalk > 0.1
    assert budget(hysteresis=0.2)[0].hysteresis > budget(hysteresis=0.1)[0].hysteresis > 0.1


def test_the_limit_is_that_of_the_use():
    _, build = budget()
    plan, p = build.shoes[0].plan, build.parameters
    length, width = np.subtract(plan.contact.bounds[2:], plan.contact.bounds[:2])
    limits = {
        use: check_cop_budget(plan, load_case(FOOT, p), replace(p, use=use)).limit
        for use in ("contact", "gait", "balance")
    }
    assert limits == pytest.approx({"contact": 0.4 * width, "gait": 0.05 * length, "balance": 0.05 * width}, abs=0.06)
