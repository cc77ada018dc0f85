"""Cells that names show to be missing: the figure covers what they would add."""

import re

import numpy as np
import pytest

from plantar.formats.field_names import heading_of
from plantar.formats.missing_cells import report_missing_cells

GONE = np.linspace(0.0, 1.0, 101)
CELLS = 100.0 * np.exp(-(((GONE[:, None] - np.array([0.2, 0.4, 0.6, 0.8, 0.2, 0.4, 0.6, 0.8])) / 0.3) ** 2))
NAMES = [f"{side} {place} [N]" for side in ("left", "right") for place in ("heel", "midfoot", "forefoot", "hallux")]


def notes(names: list[str], cells: list[int]) -> list[str]:
    warnings: list[str] = []
    report_missing_cells(CELLS[:, : len(names)], [heading_of(n) for n in names], cells, range(len(names)), warnings)
    return warnings


def test_whole_feet_lack_nothing():
    assert notes(NAMES, list(range(8))) == []
    assert notes(NAMES[:4], list(range(4))) == []  # of one foot nothing is known


@pytest.mark.parametrize("at", range(4, 8))
def test_a_cell_of_one_foot_alone_and_a_column_without_a_name_are_figured(at):
    rest = [i for i in range(8) if i != at]
    without = notes([n for i, n in enumerate(NAMES) if i != at], list(range(7)))
    nameless = notes(["[N]" if i == at else n for i, n in enumerate(NAMES)], rest)
    added = 100.0 * CELLS[:, at - 4].max() / CELLS[:, :4].sum(axis=1).max()
    assert f"the right foot has no cell {NAMES[at].split()[1]}" in without[0]
    assert f"column {at + 1} has no name" in nameless[-1]
    for text in (without[0], nameless[-1]):
        (figure,) = re.findall(r"up to (\d+) % too small", text)
        assert float(figure) == pytest.approx(added, abs=1.0)


def test_a_gap_in_the_numbers_is_reported():
    (note,) = notes([f"left {i} [N]" for i in (1, 2, 3, 5, 6, 7)], list(range(6)))
    assert "cells 1 to 7 without 4: forces are about 14 % too small" in note
