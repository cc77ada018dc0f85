"""A stated shank: where it is, what straps make of it, and what is no shank."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.errors import InputError
from plantar.shoes.foot.shank import shank_links, stated_shank
from plantar.shoes.foot.source import read_foot
from plantar.shoes.order import FootSource
from plantar.shoes.plan.keep_out import keep_out


def test_straps_keep_off_a_stated_shank():
    source = FootSource(dimensions="230x90", shank="-40,0,50")
    foot, _ = read_foot(source, sole_band=5.0)
    others = keep_out(foot)
    assert others.known
    low = others.links[others.links[:, 2] < 50.0]
    assert np.hypot(low[:, 0] + 40.0, low[:, 1]).max() <= 25.0
    assert any("--shank states it: -40,0,50" in note for note in foot.notes)
    assumed = keep_out(read_foot(replace(source, shank=None), sole_band=5.0)[0])
    assert not assumed.known
    assert np.abs(assumed.links[:, 0]).mean() < np.abs(others.links[:, 0]).mean()


def test_a_shank_leans_by_20_degrees_every_way():
    circle = stated_shank("0,0,40")
    links = shank_links(circle, circle, 40.0)
    high = links[links[:, 2] == links[:, 2].max()]
    grown = (links[:, 2].max() - 40.0) * np.tan(np.radians(20.0))
    assert np.hypot(*high[:, :2].T).max() == pytest.approx(20.0 + grown, abs=4.0)


@pytest.mark.parametrize("text", ["", "1,2", "0,0,-5", "0,0,999", "a,b,c", "nan,0,10"])
def test_what_is_no_shank_is_refused(text):
    with pytest.raises(InputError, match="allowed: X,Y,DIAMETER in mm"):
        stated_shank(text)
