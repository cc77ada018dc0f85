"""A table with one thing taken away is right, refused, or a note names the option that makes it right."""

import re
from pathlib import Path

import numpy as np
import pytest

from plantar.errors import PlantarError
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import Analysis, analyse

from .taken_away import CHANGES, KINDS, PERIOD, SIDES, STANCE, Made, made, taken

COUNT = 400
_STEPS = 4  # of a foot, at least


def wrong(walk: Analysis, table: Made, sides: tuple[str, ...] = SIDES) -> str:
    """What differs from the truth by more than reading allows; empty if nothing does."""
    if not set(walk.feet) <= set(sides):
        return f"feet {sorted(walk.feet)}"
    for side, gait in walk.feet.items():
        steps = gait.steps
        if len(steps) < _STEPS:
            return f"{len(steps)} steps of the {side} foot"
        contact = float(np.median([s["contact_time_s"] for s in steps]))
        if abs(contact - STANCE * PERIOD) > 0.02:
            return f"contact {contact:.3f} s for {STANCE * PERIOD:.3f}"
        stride = float(np.nanmedian([s["stride_time_s"] for s in steps]))
        if abs(stride / PERIOD - 1.0) > 0.015:
            return f"stride {stride:.3f} s for {PERIOD}"
        peak = float(np.median([s["peak_force_N"] for s in steps]))
        if table.peak and abs(peak / table.peak[side] - 1.0) > 0.02:
            return f"{side} peak {peak:.0f} N for {table.peak[side]:.0f}"
    return ""


def peak_error(walk: Analysis, table: Made) -> float:
    """Largest relative error of a foot's peaks."""
    peaks = {side: np.median([s["peak_force_N"] for s in gait.steps]) for side, gait in walk.feet.items()}
    return float(max(abs(peak / table.peak[side] - 1.0) for side, peak in peaks.items()))


def true_options(table: Made) -> dict[str, ReadOptions]:
    """What an option states of the whole table, by its name."""
    return {
        "--unit": ReadOptions(unit=table.states["unit"]),
        "--rate": ReadOptions(rate_hz=float(table.states["rate"])),
        "--plates": ReadOptions(plates=("left", "right")),
        "--side": ReadOptions(side="right"),
    }


def verdict(table: Made, path: Path) -> str:
    """How a table ends: right, refused, noted; else what is wrong and unsaid."""
    path.write_text(table.text())
    try:
        walk = analyse(path)
    except PlantarError as error:
        return "refused" if "allowed" in str(error) or "no recording over time" in str(error) else f"refused: {error}"
    what = wrong(walk, table)
    if not what:
        return "right"
    notes = " ".join(walk.metrics["warnings"])
    for option, value in true_options(table).items():
        if option not in notes:
            continue
        try:
            if not wrong(analyse(path, options=value), table):
                return "noted"
        except PlantarError:
            pass
    figures = [float(x) for x in re.findall(r"(\d[\d.]*) % too small", notes)]
    covered = max(figures, default=0.0) + 1.0 >= 100.0 * peak_error(walk, table)
    spoilt = re.search(r"\d % are lost|not evenly spaced|values are missing|without \d", notes)
    return "noted" if (figures and covered) or spoilt else f"{what}, and of that only: {notes[:300]}"


@pytest.mark.parametrize("kind", range(len(KINDS)))
def test_a_whole_table_is_right(kind, tmp_path):
    assert verdict(made(kind), tmp_path / "walk.csv") == "right"


@pytest.mark.sample(8)
@pytest.mark.parametrize("seed", range(len(KINDS) * len(CHANGES)))
def test_one_thing_taken_away_is_right_refused_or_noted(seed, tmp_path):
    assert verdict(taken(seed), tmp_path / "walk.csv") in ("right", "refused", "noted")


@pytest.mark.long
@pytest.mark.parametrize("seed", range(len(KINDS) * len(CHANGES), COUNT))
def test_more_tables_with_one_thing_taken_away(seed, tmp_path):
    assert verdict(taken(seed), tmp_path / "walk.csv") in ("right", "refused", "noted")
