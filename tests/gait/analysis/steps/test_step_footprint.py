"""Regions of a footprint by the kind of what measured it."""

from dataclasses import replace

import pytest

from plantar.gait.analysis.parameters import analyse_foot
from plantar.gait.analysis.prints.regions import REGIONS


@pytest.mark.parametrize(("kind", "has_toes"), [("insole", True), ("robot", False)])
def test_only_an_insole_without_a_valley_has_toes_by_its_length(walk, kind, has_toes):
    gait = analyse_foot(replace(walk(steps=6).recording, kind=kind), "left")
    assert gait.footprint is not None
    assert gait.footprint.toe_line is None
    assert bool((gait.region == list(REGIONS).index("toes")).any()) == has_toes
