"""Tests of printability: overhangs, bridges, directions and the bed."""

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.shoes import build_shoe
from plantar.shoes.checks.printability import choose_direction, weigh
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.solid.pad import taxel_surfaces
from plantar.shoes.solid.polyhedron import volume_of

P = ShoeParameters()


def by_name(surface: NDArray[np.float64], p: ShoeParameters = P) -> dict[str, tuple[float, float]]:
    return {f.direction: (f.overhang, f.bridges) for f in choose_direction(surface, p)}


def test_a_box_overhangs_nowhere(box):
    directions = choose_direction(box((0, 80), (0, 50), (0, 20)), P)
    assert {d.overhang for d in directions} == {0.0}
    assert directions[0].size == (80.0, 50.0, 20.0)  # the flattest comes first
    assert directions[0].direction == "sole down"


def test_ceilings_bridge_up_to_a_width(box):
    wide = by_name(box((0, 100), (0, 60), (0, 5)) + np.array([0, 0, 10.0]))
    assert wide["sole down"] == (0.0, 0.0)  # it lies on the bed
    pair = np.concatenate([box((0, 100), (0, 60), (10, 15)), box((200, 210), (0, 60), (0, 10))])
    assert by_name(pair)["sole down"] == (6000.0, 0.0)
    bridging = ShoeParameters(bridge_max=70.0)
    assert by_name(pair, bridging)["sole down"] == (0.0, 6000.0)


def test_slopes_count_beyond_45_degrees(prism):
    def roof(lean: float) -> NDArray[np.float64]:
        side = np.array([[0, 0], [20, 0], [20 + lean, 20], [0, 20]], dtype=float)
        return prism(side, 0, 40)[..., [0, 2, 1]][:, ::-1]  # leans out along x, upwards

    assert by_name(roof(19.9))["sole down"][0] == 0.0
    assert by_name(roof(21.0))["sole down"][0] == pytest.approx(40 * np.hypot(21, 20), rel=1e-3)


def test_what_does_not_fit_the_bed_is_told(box):
    small = ShoeParameters(bed_length=100.0, bed_width=60.0, bed_height=60.0)
    assert choose_direction(box((0, 50), (0, 90), (0, 20)), small)[0].fits
    assert not any(d.fits for d in choose_direction(box((0, 50), (0, 120), (0, 20)), small))


@pytest.mark.parametrize("rim", ["whole", "fine"])
@pytest.mark.parametrize("length", [0.24, 0.15])
def test_the_skin_weighs_what_its_taxels_enclose(rim, length):
    """A base is smaller than its cell by the rib around it."""
    foot = foot_from_dimensions("foot", length=length, width=0.4 * length, corner_radius=0.01)
    build = build_shoe(foot, side="left", rim=rim, layout_only=True)
    volume = sum(volume_of(surface) for surface in taxel_surfaces(build.shoes[0].plan, build.parameters))
    found = weigh(build.shoes[0], build, 1e5)
    assert found.skin == pytest.approx(1e-3 * volume * build.parameters.skin_density, abs=0.01)
