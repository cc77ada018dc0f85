"""Weights against the volumes of the shoe's own solids."""

from __future__ import annotations

import pytest

from plantar.shoes import build_shoe
from plantar.shoes.checks.weights import weigh
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.solid.pad import taxel_surfaces, volume_of


@pytest.mark.parametrize("rim", ["whole", "fine"])
@pytest.mark.parametrize("length", [0.24, 0.15])
def test_the_skin_weighs_what_its_taxels_enclose(rim: str, length: float) -> None:
    """A base is smaller than its cell by the rib around it."""
    foot = foot_from_dimensions("foot", length=length, width=0.4 * length, corner_radius=0.01)
    build = build_shoe(foot, side="left", rim=rim, layout_only=True)
    volume = sum(volume_of(surface) for surface in taxel_surfaces(build.shoes[0].plan, build.parameters))
    found = weigh(build.shoes[0], build, 1e5)
    assert found.skin == pytest.approx(1e-3 * volume * build.parameters.skin_density, abs=0.01)
