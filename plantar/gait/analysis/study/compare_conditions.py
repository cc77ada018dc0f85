"""Levels of a factor compared: participants count once a level, within participants if possible."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.gait.analysis.compare import unlike
from plantar.gait.analysis.measures import COMPARED
from plantar.gait.analysis.study.designs import Contrast, Design, any_differ, compare_levels, explain_levels
from plantar.gait.analysis.study.measured_table import (
    Cell,
    Foot,
    cells_of,
    level_of,
    means,
    measure_keys,
    participants_of,
)
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.statistics import Effect, adjusted, effect_of, with_margin

FEWEST = 3  # Participants a level from which a difference can be tested at all
MOST_LEVELS = 8  # Levels of a factor that are compared: 28 pairs
MAP_PERMUTATIONS = 500  # Of maps, which have 500 values: a p of 0.05 is known to 0.01
# Robust standard deviations from the median of a condition beyond which a participant is an outlier to look at.
_FAR = 3.5


class Outlier(NamedTuple):
    """Participant's mean far from those of the same condition."""

    participant: str
    condition: str
    key: str
    value: float
    median: float


@dataclass(frozen=True)
class AnyDifference:
    """Whether any levels of a factor differ in a measure: F, its degrees of freedom and probabilities."""

    f: float
    freedom: tuple[int, int]
    p: float
    p_all: float


@dataclass(frozen=True, eq=False)
class Comparison:
    """Levels A and B of a study's factor; curves, maps and tests are None with too few participants.

    Attributes:
        paired: Whether the same participants are in both.
        curve_unit: "N", "counts" or "% of body weight".
        curves: Mean vertical force curves (participants, 101) of A and B.
        curve_test: Where they differ.
        maps: Mean maps (participants, 36, 14) in Pa of A and B.
        map_test: Where they differ, among `places`.
        places: Map places (36, 14) that every participant has.
        note: Why nothing was compared, or empty.
        doubts: What else may explain a difference.
        factor: Name of the factor.
        levels: All its levels that are compared as one family.
        covariates: Names of what is allowed for.
        omnibus: Of three levels or more, whether any differ, by measure.
    """

    a: str
    b: str
    paired: bool
    effects: Mapping[str, Effect]
    curve_unit: str = "N"
    curves: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    curve_test: Contrast | None = None
    maps: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    map_test: Contrast | None = None
    places: NDArray[np.bool_] | None = None
    note: str = ""
    doubts: Sequence[str] = ()
    factor: str = "condition"
    levels: Sequence[str] = ()
    covariates: Sequence[str] = ()
    omnibus: Mapping[str, AnyDifference] = field(default_factory=dict)


def compare_conditions(
    results: Sequence[RecordingResult],
    factor: str = "condition",
    covariates: Sequence[str] = (),
    margin_percent: float | None = None,
) -> list[Comparison]:
    """Returns comparisons of every two levels of a factor, in order of appearance, tested as one family.

    Args:
        results: Recordings of the study.
        factor: "condition", "side", "affected", or a column of the table of participants.
        covariates: Columns or measures that are allowed for, as speed.
        margin_percent: Differences up to this share of A's mean in percent are called equivalent.
    """
    cells = cells_of(results, factor)
    levels = list(dict.fromkeys(cell.level for cell in cells))
    if len(levels) < 2:
        return []
    if len(levels) > MOST_LEVELS:
        note = f"{factor} has {len(levels)} levels; allowed: up to {MOST_LEVELS}"
        return [Comparison(levels[0], levels[1], False, {}, note=note, factor=factor)]
    doubts: list[str] = []
    if covariates:
        known = [c for c in cells if all(np.isfinite(c.covariate(name)) for name in covariates)]
        lost = len({c.participant for c in cells}) - len({c.participant for c in known})
        doubts += [f"{lost} participant(s) without {' and '.join(covariates)} are left out"] if lost else []
        cells = known
    every = levels
    chosen, levels, within, notes = _chosen(cells, levels)
    doubts += [f"{name} has too few participants and is left out" for name in every if name not in levels]
    doubts += _left_out(cells, chosen, levels, within)
    if notes:
        names = combinations(levels, 2)
        return [Comparison(*pair, False, {}, note=n, factor=factor) for pair, n in zip(names, notes, strict=True)]
    return _compared(chosen, levels, within, factor, covariates, margin_percent, doubts)


def _chosen(cells: Sequence[Cell], levels: list[str]) -> tuple[list[Cell], list[str], bool, list[str]]:
    """Cells and levels that are compared, whether within participants; else levels and why each pair is not."""
    people = participants_of(cells)
    for kept in _fuller(people, levels):
        whole = [who for who, own in people.items() if all(level in own for level in kept)]
        if len(whole) >= FEWEST:
            return [people[who][level] for who in whole for level in kept], kept, True, []
        alone = [cell for own in people.values() if sum(level in own for level in kept) == 1 for cell in own.values()]
        alone = [cell for cell in alone if cell.level in kept]
        if all(sum(cell.level == level for cell in alone) >= FEWEST for level in kept):
            return alone, kept, False, []
    notes = []
    for a, b in combinations(levels, 2):
        both = sum(a in own and b in own for own in people.values())
        of_a, of_b = (sum(level in own for own in people.values()) for level in (a, b))
        notes.append(
            f"{a} has {of_a} and {b} {of_b} participants, {both} of them in both: "
            f"differences take {FEWEST} in both, or {FEWEST} others in each"
        )
    return [], levels, False, notes


def _left_out(cells: Sequence[Cell], chosen: Sequence[Cell], levels: Sequence[str], within: bool) -> list[str]:
    """A line on participants of the compared levels who are not in the comparison."""
    kept = {cell.participant for cell in chosen}
    lost = list(dict.fromkeys(c.participant for c in cells if c.level in levels and c.participant not in kept))
    if not lost:
        return []
    names = ", ".join(lost[:5]) + (" and others" if len(lost) > 5 else "")
    why = "not in every level" if within else "in several levels"
    return [f"{len(lost)} participant(s) are {why} and left out: {names}"]


def _fuller(people: Mapping[str, Mapping[str, Cell]], levels: Sequence[str]) -> list[list[str]]:
    """Levels to compare: all, then without that of the fewest participants, and so on."""
    counts = {level: sum(level in own for own in people.values()) for level in levels}
    out = [list(levels)]
    for level in sorted(levels, key=lambda name: counts[name])[: max(0, len(levels) - 2)]:
        out.append([name for name in out[-1] if name != level])
    return out


def _compared(
    cells: Sequence[Cell],
    levels: Sequence[str],
    within: bool,
    factor: str,
    covariates: Sequence[str],
    margin_percent: float | None,
    doubts: Sequence[str],
) -> list[Comparison]:
    names = list(dict.fromkeys(cell.participant for cell in cells))
    design = Design(
        np.array([names.index(cell.participant) for cell in cells]),
        np.array([levels.index(cell.level) for cell in cells]),
        np.array([[cell.covariate(name) for name in covariates] for cell in cells]).reshape(len(cells), -1),
        within,
    )
    if covariates and explain_levels(design):
        note = f"{' and '.join(covariates)} alone shows which level it is: no difference is left when it is allowed for"
        return [Comparison(a, b, within, {}, note=note, factor=factor) for a, b in combinations(levels, 2)]
    keys = measure_keys(cells)
    effects, omnibus = _effects(means(cells, keys), keys, design, margin_percent)
    unit, curves = mean_curves(cells)
    line = None if curves is None else np.ones(curves.shape[1], dtype=bool)
    curve_tests = None if curves is None else compare_levels(curves, design, line)
    maps, places = mean_maps(cells)
    map_tests = None
    if maps is not None and places is not None:
        map_tests = compare_levels(maps[:, places], design, places, MAP_PERMUTATIONS)
    out = []
    for i, (a, b) in enumerate(combinations(range(len(levels)), 2)):
        of_a, of_b = (np.flatnonzero(design.level == level) for level in (a, b))
        first, second = ({r.sensor for k in rows.tolist() for r in cells[k].recordings} for rows in (of_a, of_b))
        out.append(
            Comparison(
                levels[a],
                levels[b],
                within,
                effects[i],
                unit,
                None if curves is None else (curves[of_a], curves[of_b]),
                None if curve_tests is None else curve_tests[i],
                None if maps is None else (maps[of_a], maps[of_b]),
                None if map_tests is None else map_tests[i],
                places,
                doubts=[*doubts, *unlike(first, second, levels[a], levels[b])],
                factor=factor,
                levels=tuple(levels),
                covariates=tuple(covariates),
                omnibus=omnibus,
            )
        )
    return out


def _effects(
    values: NDArray[np.float64], keys: Sequence[str], design: Design, margin_percent: float | None
) -> tuple[list[dict[str, Effect]], dict[str, AnyDifference]]:
    """Effects of each pair of levels by measure, and whether any levels differ."""
    pairs = list(combinations(range(design.levels), 2))
    if not keys:
        return [{} for _ in pairs], {}
    out = []
    for contrast in compare_levels(values, design):
        a, b = (values[design.level == level] for level in (contrast.a, contrast.b))
        own: dict[str, Effect] = {}
        for i, key in enumerate(keys):
            effect = effect_of(a[:, i], b[:, i], design.within, float(contrast.p[i]), float(contrast.p_all[i]))
            if design.covariates.shape[1]:
                effect = adjusted(effect, float(contrast.difference[i]), float(contrast.error[i]), contrast.freedom)
            if margin_percent is not None:
                effect = with_margin(effect, 0.01 * margin_percent * abs(effect.mean_a))
            own[key] = effect
        out.append(own)
    if len(pairs) == 1:
        return out, {}
    test = any_differ(values, design)
    rows = zip(keys, test.f.tolist(), test.p.tolist(), test.p_all.tolist(), strict=True)
    return out, {key: AnyDifference(f, test.freedom, p, p_all) for key, f, p, p_all in rows}


def compare_changes(results: Sequence[RecordingResult], factor: str, other: str) -> list[Comparison]:
    """Returns whether the difference of every two levels of a factor depends on another factor, as one family.

    The change of each participant is compared between the levels of the other factor: their interaction.
    """
    feet = cells_of(results, other)
    split = {cell: _by_level(cell, factor) for cell in feet}
    levels = list(dict.fromkeys(level for own in split.values() for level in own))
    whole = [cell for cell in feet if len(split[cell]) == len(levels)]
    if len(levels) < 2 or len(levels) > MOST_LEVELS or not whole:
        return []
    chosen, groups, within, notes = _chosen(whole, list(dict.fromkeys(cell.level for cell in whole)))
    if notes or len(groups) < 2 or len(groups) > MOST_LEVELS:
        return []
    pairs = list(combinations(levels, 2))
    keys = measure_keys([part for cell in chosen for part in split[cell].values()])
    values = {level: means([split[cell][level] for cell in chosen], keys) for level in levels}
    changes = np.hstack([values[b] - values[a] for a, b in pairs])
    names = list(dict.fromkeys(cell.participant for cell in chosen))
    design = Design(
        np.array([names.index(cell.participant) for cell in chosen]),
        np.array([groups.index(cell.level) for cell in chosen]),
        np.zeros((len(chosen), 0)),
        within,
    )
    labels = [f"{i}/{key}" for i in range(len(pairs)) for key in keys]
    effects, _ = _effects(changes, labels, design, None)
    out = []
    for (one, two), own in zip(combinations(groups, 2), effects, strict=True):
        for i, (a, b) in enumerate(pairs):
            part = {key: own[f"{i}/{key}"] for key in keys if f"{i}/{key}" in own}
            name = f"{b} less {a}" if len(pairs) > 1 or factor != "condition" else f"change from {a} to {b}"
            out.append(Comparison(one, two, within, part, factor=f"{other} ({name})", levels=tuple(groups)))
    return out


def _by_level(cell: Cell, factor: str) -> dict[str, Cell]:
    groups: dict[str, list[Foot]] = {}
    for foot in cell.feet:
        if level := level_of(foot, factor):
            groups.setdefault(level, []).append(foot)
    return {level: Cell(cell.participant, level, feet) for level, feet in groups.items()}


def mean_curves(cells: Sequence[Cell]) -> tuple[str, NDArray[np.float64] | None]:
    """Unit and mean vertical force curves (cells, 101); None where a cell has none."""
    everyone = [foot for cell in cells for foot in cell.feet]
    if not all(any(side in r.curves for r, side in c.feet) for c in cells) or len({r.raw for r, _ in everyone}) > 1:
        return "N", None
    raw = everyone[0][0].raw
    weighed = all(r.who.mass_kg is not None for r, _ in everyone) and not raw

    def curve(cell: Cell) -> NDArray[np.float64]:
        own = [
            (100.0 / (r.who.mass_kg * GRAVITY) if weighed and r.who.mass_kg else 1.0) * r.curves[side]
            for r, side in cell.feet
            if side in r.curves
        ]
        return np.asarray(np.mean(own, axis=0))

    return "% of body weight" if weighed else "counts" if raw else "N", np.array([curve(cell) for cell in cells])


def mean_maps(cells: Sequence[Cell]) -> tuple[NDArray[np.float64] | None, NDArray[np.bool_] | None]:
    """Mean maps of cells in Pa, and the places that every one has; None where a cell has none."""
    everyone = [foot for cell in cells for foot in cell.feet]
    if not all(any(side in r.maps for r, side in c.feet) for c in cells) or len({r.raw for r, _ in everyone}) > 1:
        return None, None
    maps = np.array([np.mean([r.maps[side] for r, side in c.feet if side in r.maps], axis=0) for c in cells])
    places = np.isfinite(maps).all(axis=0)
    return (maps, places) if places.any() else (None, None)


def outliers(results: Sequence[RecordingResult]) -> list[Outlier]:
    """Participants with a mean far from their condition's, farthest first; of five or more."""
    found: list[tuple[float, Outlier]] = []
    cells = cells_of(results, "condition")
    for condition in dict.fromkeys(cell.level for cell in cells):
        people = {cell.participant: cell for cell in cells if cell.level == condition}
        if len(people) < 5:
            continue
        for key in COMPARED:
            values = {who: own.mean(key) for who, own in people.items()}
            known = np.array([v for v in values.values() if np.isfinite(v)])
            if len(known) < 5:
                continue
            middle = float(np.median(known))
            spread = max(1.4826 * float(np.median(np.abs(known - middle))), 0.02 * abs(middle), 1e-12)
            for who, value in values.items():
                if abs(value - middle) > _FAR * spread:
                    found.append((abs(value - middle) / spread, Outlier(who, condition, key, value, middle)))
    return [outlier for _, outlier in sorted(found, key=lambda one: -one[0])]
