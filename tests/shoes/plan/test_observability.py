"""What taxels see of the center of pressure."""

from __future__ import annotations

import pytest

from plantar.errors import FootError
from plantar.shoes.build import build_shoe
from plantar.shoes.foot.foot import foot_from_dimensions
from plantar.shoes.plan.observability import observability


def test_taxels_in_a_line_see_nothing_across_it() -> None:
    foot = foot_from_dimensions("a", length=0.2, width=0.04)
    seen = observability(build_shoe(foot, layout_only=True, taxels=5).shoes[0].plan)
    assert seen.across < 0.1
    assert not seen.holds


@pytest.mark.parametrize("length", [0.065, 0.08, 0.12, 0.24])
def test_cells_are_made_smaller_until_both_directions_are_seen(length: float) -> None:
    foot = foot_from_dimensions("a", length=length, width=0.5 * length, corner_radius=0.005)
    seen = observability(build_shoe(foot, layout_only=True).shoes[0].plan)
    assert seen.holds
    assert seen.error <= 0.4 * seen.width


def test_a_foot_on_which_no_cells_see_it_is_refused() -> None:
    with pytest.raises(FootError, match="no cells of 100 to 691"):
        build_shoe(foot_from_dimensions("a", length=0.08, width=0.018), layout_only=True)
