"""The nominal 99-cell insole."""

import itertools

import numpy as np
import pytest

from plantar import InputError
from plantar.formats.nominal_insole import (
    CELL_AREAS,
    ROWS,
    WIDE_ROWS,
    moticon_insole,
    named_or_read_layout,
    nominal_insole,
)
from plantar.gait.analysis.analyse import analyse
from plantar.geometry.polygon import area, signed_margin


@pytest.mark.parametrize("size", sorted(CELL_AREAS))
def test_areas_tile_the_outline(size):
    layout = nominal_insole(size, "left")
    assert len(layout) == sum(ROWS) == 99
    assert layout.areas.sum() == pytest.approx(layout.sole_area)
    assert layout.areas == pytest.approx(CELL_AREAS[size])
    drawn = [area(layout.cell_polygon(i)) for i in range(99)]
    assert drawn == pytest.approx(layout.areas.tolist(), rel=0.12)  # cells in a row are trapezoids beside each other
    if len(size) == 1:
        assert layout.areas.std() / layout.areas.mean() < 0.02


def test_rows_of_a_wide_insole_end_in_two_of_five():
    assert sum(WIDE_ROWS) == 99
    layout = nominal_insole("xw", "left")
    assert len({round(float(x), 6) for x in layout.positions[-5:, 0]}) <= 5
    assert layout.positions[-5:, 0].min() > layout.positions[-10:-5, 0].max()


def test_numbering_runs_heel_to_toe_and_medial_to_lateral():
    for side, medial in (("left", -1.0), ("right", 1.0)):
        layout = nominal_insole("x", side)
        starts = np.concatenate([[0], np.cumsum(ROWS)])
        rows = [layout.positions[a:b] for a, b in itertools.pairwise(starts)]
        assert all(b[:, 0].min() > a[:, 0].max() for a, b in itertools.pairwise(rows))
        assert all((np.diff(row[:, 1]) * medial < 0).all() for row in rows)
        hallux = layout.positions[95, :2]
        assert hallux[1] * medial > 0.0


def test_positions_lie_in_their_cells_and_neighbours_are_mutual():
    layout = nominal_insole("y", "right")
    for i in range(len(layout)):
        assert signed_margin(layout.cell_polygon(i), layout.positions[i, :2]) > 0.003
        assert all(i in layout.neighbours[j] for j in layout.neighbours[i])
        assert 2 <= len(layout.neighbours[i]) <= 6


def test_an_insole_is_named_by_maker_and_size(tmp_path):
    """Sixteen numbered pressures of a table by the insole that they are of: the file's force is pressure times area."""
    layout = moticon_insole(5, "right")
    assert np.array_equal(named_or_read_layout("Moticon:5").areas, moticon_insole(5, "left").areas)
    time = np.arange(0.0, 6.0, 0.02)
    load = np.clip(np.sin(2.0 * np.pi * time / 1.2), 0.0, None) * 40.0
    names = ",".join(f"right {i} [kPa]" for i in range(1, 17))
    rows = "".join(f"{t:.2f}" + f",{p:.4f}" * 16 + "\n" for t, p in zip(time, load, strict=True))
    (tmp_path / "walk.csv").write_text(f"time [s],{names}\n{rows}")
    walk = analyse(tmp_path / "walk.csv", layout="moticon:5")
    assert walk.feet["right"].steps[0]["peak_force_N"] == pytest.approx(40e3 * layout.areas.sum(), rel=0.01)
    for wrong in ("moticon:12", "pedar:", "pedar:q"):
        with pytest.raises(InputError, match=r"unknown size '\w*' of a (moticon|pedar) insole; allowed: "):
            named_or_read_layout(wrong)
