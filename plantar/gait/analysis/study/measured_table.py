"""Means of participants in the levels of a factor, from the results of a study's recordings."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.formats.text import number
from plantar.gait.analysis.measures import COMPARED, REGION_COMPARED, in_percent, raw_name
from plantar.gait.analysis.study.one_recording import RecordingResult

_AFFECTED = ("affected", "affected_side", "involved_side")
_OWN = ("condition", "side", "affected")
"""Factors that are no column of the table of participants."""

Foot = tuple[RecordingResult, Side]


@dataclass(frozen=True, eq=False)
class Cell:
    """Feet of a participant's recordings in one level of a factor."""

    participant: str
    level: str
    feet: Sequence[Foot]

    def mean(self, key: str) -> float:
        """Mean of a measure over recordings and feet; NaN without any."""
        values = [result.feet[side][key] for result, side in self.feet if key in result.feet[side]]
        return float(np.mean(values)) if values else float("nan")

    def covariate(self, name: str) -> float:
        """Mean of a covariate over recordings and feet; NaN unless known of each."""
        values = [_covariate(foot, name) for foot in self.feet]
        return float(np.mean(values)) if values else float("nan")

    @property
    def recordings(self) -> list[RecordingResult]:
        """Its recordings."""
        return list(dict.fromkeys(result for result, _ in self.feet))


def feet_of(results: Sequence[RecordingResult]) -> Iterator[Foot]:
    """Measured feet with steps in the means."""
    return ((r, side) for r in results if not r.error for side, foot in r.feet.items() if foot["steps"])


def level_of(foot: Foot, factor: str) -> str:
    """Level of a foot in a factor; empty if unknown.

    Condition, side, affected (of a column "affected" that names the side), or any column of the table.
    """
    result, side = foot
    if factor == "condition":
        return result.who.condition
    if factor == "side":
        return side
    if factor == "affected":
        stated = next((v for name in _AFFECTED if (v := result.who.more.get(name))), "").lower()
        return ("affected" if stated == side else "unaffected") if stated in SIDES else ""
    return result.who.more.get(factor, "")


def _covariate(foot: Foot, name: str) -> float:
    result, side = foot
    own = {"mass_kg": result.who.mass_kg, "foot_length_m": result.who.foot_length_m}
    stated = own.get(name)
    if name in result.who.more:
        stated = number(result.who.more[name])
    if stated is None:
        stated = result.feet[side].get(name, result.walk.get(name))
    return float("nan") if stated is None else float(stated)


def check_names(results: Sequence[RecordingResult], factors: Sequence[str], covariates: Sequence[str]) -> None:
    """Refuse factors and covariates that no recording has, as an InputError that names those there are."""
    feet = list(feet_of(results))
    columns = dict.fromkeys(name for r in results for name in r.who.more)
    for factor in factors:
        found = list(dict.fromkeys(level for foot in feet if (level := level_of(foot, factor))))
        if feet and factor == "affected" and not found and any(name in columns for name in _AFFECTED):
            raise InputError("--factor affected: no recording's affected side is left or right; allowed: these")
        if feet and not found:
            names = ", ".join(dict.fromkeys([*_OWN, *columns]))
            raise InputError(f"--factor {factor}: no recording has it; allowed: {names}")
        if feet and len(found) < 2:
            raise InputError(f"--factor {factor}: all of it is {found[0]!r}; allowed: two levels or more")
    for covariate in covariates:
        if feet and not any(np.isfinite(_covariate(foot, covariate)) for foot in feet):
            known = dict.fromkeys([*columns, "mass_kg", "foot_length_m", *(k for r in results for k in r.walk)])
            raise InputError(
                f"--covariate {covariate}: no recording has a number of it; allowed: {', '.join(known)}, or a measure"
            )


def cells_of(results: Sequence[RecordingResult], factor: str) -> list[Cell]:
    """Cells of a factor in order of appearance; feet without a level are left out."""
    groups: dict[tuple[str, str], list[Foot]] = {}
    for foot in feet_of(results):
        level = level_of(foot, factor)
        if level:
            groups.setdefault((foot[0].who.participant, level), []).append(foot)
    return [Cell(who, level, feet) for (who, level), feet in groups.items()]


def measure_keys(cells: Sequence[Cell], names: Sequence[str] = COMPARED) -> list[str]:
    """Compared measures of foot and regions that every cell has, each in one unit: percent where all have it."""
    found = (key_of_all(cells, name) for name in (*names, *region_keys(cells)))
    return list(dict.fromkeys(key for key in found if key is not None))


def region_keys(cells: Sequence[Cell]) -> list[str]:
    """Compared measures of the regions that any foot of the cells has, in SI."""
    regions = dict.fromkeys(
        key.partition(".")[0] for cell in cells for r, side in cell.feet for key in r.feet[side] if "." in key
    )
    return [f"{region}.{name}" for region in regions for name in REGION_COMPARED]


def key_of_all(cells: Sequence[Cell], name: str) -> str | None:
    """A measure's key in the unit that every cell has: in percent, SI or counts; None where there is none."""
    forms = (in_percent(name), name, raw_name(name))
    return next((k for k in forms if k and all(np.isfinite(c.mean(k)) for c in cells)), None)


def means(cells: Sequence[Cell], keys: Sequence[str]) -> "np.ndarray[tuple[int, int], np.dtype[np.float64]]":
    """Means (cells, keys)."""
    return np.array([[cell.mean(key) for key in keys] for cell in cells]).reshape(len(cells), len(keys))


def participants_of(cells: Sequence[Cell]) -> Mapping[str, Mapping[str, Cell]]:
    """Cells of each participant by level."""
    out: dict[str, dict[str, Cell]] = {}
    for cell in cells:
        out.setdefault(cell.participant, {})[cell.level] = cell
    return out
