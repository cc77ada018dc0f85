"""One person against a group: every measure and region, force curves and pressure maps.

A measure is compared by Crawford & Howell's t (1998, Clin. Neuropsychol. 12:482), with the interval of the share of
the group's people that lie below (Crawford & Garthwaite 2002, Neuropsychologia 40:1196). The largest |t| of all
measures, places of a curve or places of a map is compared with that of each member of the group put in the person's
place: where the person is one of them, all n + 1 are alike, and an error is reported in 5 % of cases or fewer. That
takes a group of 19 or more.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.gait.analysis.measures import COMPARED, in_percent
from plantar.gait.analysis.study.compare_conditions import mean_curves, mean_maps
from plantar.gait.analysis.study.measured_table import Cell, feet_of, region_keys
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.statistics import student_quantile

FEWEST_IN_GROUP = 5  # of fewer the spread of a group is hardly known
ENOUGH_IN_GROUP = 19  # 1 / (19 + 1) is the first probability of 0.05 or less


@dataclass(frozen=True)
class Standing:
    """One value against a group's n.

    `low`, `high`: 95 % of people like the group are within; `t`: Crawford & Howell's; `p`: its probability of chance;
    `p_all`: of the largest of all measures; `below_percent`: estimated share of the group's people below the value,
    with its 95 % confidence interval.
    """

    value: float
    n: int
    mean: float
    sd: float
    low: float
    high: float
    t: float
    p: float
    p_all: float
    below_percent: float
    below_low: float
    below_high: float


@dataclass(frozen=True, eq=False)
class Deviation:
    """Curve or map of one person against a group's.

    `value`: the person's (k,); `mean`, `sd` of the group (k,); `t` (k,); `p_all` (k,): of the largest |t| of all.
    """

    value: NDArray[np.float64]
    mean: NDArray[np.float64]
    sd: NDArray[np.float64]
    t: NDArray[np.float64]
    p_all: NDArray[np.float64]

    @property
    def differs(self) -> NDArray[np.bool_]:
        """Places (k,) at which the person differs, with an error at any place in 5 % of cases."""
        return np.asarray(self.p_all <= 0.05)


@dataclass(frozen=True, eq=False)
class OneAgainstGroup:
    """Comparison of a participant with others, of each foot the same side's.

    `measures`: by side and measure's key; `curves`: by side, in `curve_unit`; `maps`: by side, in Pa at `places`
    (36, 14) of that side; `notes`: what limits the comparison.
    """

    participant: str
    group: str
    n: int
    measures: Mapping[Side, Mapping[str, Standing]]
    curves: Mapping[Side, Deviation]
    curve_unit: str
    maps: Mapping[Side, Deviation]
    places: Mapping[Side, NDArray[np.bool_]]
    notes: Sequence[str]


def standing_of(value: float, group: NDArray[np.float64], p_all: float = math.nan) -> Standing:
    """Returns where a value lies in a group (n,), n 2 or more.

    Example:
        >>> found = standing_of(78.0, np.array([100.0, 90.0, 110.0, 95.0, 105.0]))
        >>> round(found.t, 3), round(found.p, 3)
        (-2.54, 0.064)
    """
    from scipy.special import ndtr, stdtr

    n = len(group)
    mean = float(group.mean())
    sd = float(group.std(ddof=1))
    error = sd * math.sqrt((n + 1.0) / n)
    reach = student_quantile(0.975, n - 1) * error
    if sd <= 1e-12 * max(abs(mean), 1e-300):
        nothing = (math.nan,) * 6
        return Standing(value, n, mean, sd, mean - reach, mean + reach, *nothing[:2], p_all, *nothing[:3])
    t = (value - mean) / error
    scaled = math.sqrt(n) * (value - mean) / sd
    low, high = (_noncentrality(scaled, n - 1, share) / math.sqrt(n) for share in (0.975, 0.025))
    return Standing(
        value,
        n,
        mean,
        sd,
        mean - reach,
        mean + reach,
        t,
        2.0 * float(stdtr(n - 1, -abs(t))),
        p_all,
        100.0 * float(stdtr(n - 1, t)),
        100.0 * float(ndtr(low)),
        100.0 * float(ndtr(high)),
    )


def _noncentrality(t: float, freedom: int, share: float) -> float:
    """Noncentrality of Student's t of which a share is below t; scipy's own search for it ends at 1e-6."""
    from scipy.optimize import brentq
    from scipy.special import nctdtr

    # Outward until the share is passed: far beyond, the distribution is no number.
    step = 0.5 if share < 0.5 else -0.5
    end = t
    while (nctdtr(freedom, end, t) > share) == (share < 0.5):
        end += step
    near, far = sorted((end - step, end))
    return float(brentq(lambda d: nctdtr(freedom, d, t) - share, near, far, xtol=1e-13, rtol=1e-13))


def deviation_of(value: NDArray[np.float64], group: NDArray[np.float64]) -> Deviation:
    """Returns where values (k,) of one person differ from a group's (n, k), the error held over all k.

    Example:
        >>> random = np.random.default_rng(0)
        >>> found = deviation_of(np.array([0.0, 9.0]), random.normal(size=(24, 2)))
        >>> found.differs.tolist()
        [False, True]
    """
    everyone = np.vstack([value, group])
    n = len(group)
    total = everyone.sum(axis=0)
    mean = (total - everyone) / n
    centred = everyone - everyone.mean(axis=0)
    squares = (centred**2).sum(axis=0)
    # Of the others' squares about their own mean: leaving one out takes off its own by (n + 1) / n.
    rest = np.maximum(squares - centred**2 * (n + 1.0) / n, 0.0)
    error = np.sqrt(rest / (n - 1) * (n + 1.0) / n)
    away = everyone - mean
    t = np.where(np.abs(away) <= 1e-12 * np.abs(mean), 0.0, away / np.maximum(error, 1e-300))
    largest = np.abs(t).max(axis=1, initial=0.0)
    p_all = (largest[:, None] >= np.abs(t[0]) * (1.0 - 1e-9)).mean(axis=0)
    return Deviation(value, group.mean(axis=0), group.std(axis=0, ddof=1), t[0], p_all)


def one_against_group(
    results: Sequence[RecordingResult], participant: str, group: str | None = None
) -> OneAgainstGroup:
    """Returns comparison of a participant with the others of a study, or with those of one condition or group.

    A participant who has recordings of that condition is compared in these alone.

    InputError if the participant is unknown, or the group has fewer than five people.
    """
    own = [foot for foot in feet_of(results) if foot[0].who.participant == participant]
    if not own:
        names = ", ".join(dict.fromkeys(r.who.participant for r, _ in feet_of(results)))
        raise InputError(f"--patient {participant}: no measured recording; allowed: {names[:300]}")
    # Like with like: somebody who has the group's condition, too, is compared in that one.
    alike = [foot for foot in own if foot[0].who.condition == group]
    mixed = list(dict.fromkeys(foot[0].who.condition for foot in own)) if group and not alike else []
    own = alike or own
    others = [
        foot
        for foot in feet_of(results)
        if foot[0].who.participant != participant and group in (None, foot[0].who.condition)
    ]
    known = dict.fromkeys(r.who.participant for r, _ in others)
    if len(known) < FEWEST_IN_GROUP:
        conditions = ", ".join(dict.fromkeys(r.who.condition for r in results if r.who.condition)) or "none"
        raise InputError(
            f"--patient {participant}: {len(known)} other participants{f' in {group}' if group else ''}; allowed: "
            f"{FEWEST_IN_GROUP} or more ({ENOUGH_IN_GROUP} for curves and maps); conditions: {conditions}"
        )
    notes = []
    if len(mixed) > 1:
        notes.append(f"values of {participant} are means of {' and '.join(mixed)}, none of which is {group}")
    if len(known) < ENOUGH_IN_GROUP:
        notes.append(
            f"the group has {len(known)} people: p (all) cannot fall to 0.05 with fewer than {ENOUGH_IN_GROUP}; judge "
            "by the p of each measure, of which 1 in 20 is below 0.05 by chance"
        )
    cells = {side: _cells(others, side) for side in SIDES}
    mine = {side: Cell(participant, side, feet) for side in SIDES if (feet := [f for f in own if f[1] == side])}
    mine = {side: cell for side, cell in mine.items() if len(cells[side]) >= FEWEST_IN_GROUP}
    unit, curves = _curves(mine, cells)
    maps, places = _maps(mine, cells)
    return OneAgainstGroup(
        participant, group or "the others", len(known), _measures(mine, cells), curves, unit, maps, places, notes
    )


def _cells(feet: Sequence[tuple[RecordingResult, Side]], side: Side) -> list[Cell]:
    groups: dict[str, list[tuple[RecordingResult, Side]]] = {}
    for foot in feet:
        if foot[1] == side:
            groups.setdefault(foot[0].who.participant, []).append(foot)
    return [Cell(who, side, own) for who, own in groups.items()]


def _measures(mine: Mapping[Side, Cell], cells: Mapping[Side, Sequence[Cell]]) -> dict[Side, dict[str, Standing]]:
    everyone = [cell for side, cell in mine.items() for cell in (cell, *cells[side])]
    chosen: list[tuple[Side, str]] = []
    for name in (*COMPARED, *region_keys([*mine.values()])):
        percent = in_percent(name)
        key = percent if percent and all(np.isfinite(c.mean(percent)) for c in everyone) else name
        chosen += [
            (side, key)
            for side, cell in mine.items()
            if np.isfinite(cell.mean(key)) and all(np.isfinite(c.mean(key)) for c in cells[side])
        ]
    out: dict[Side, dict[str, Standing]] = {side: {} for side in mine}
    if not chosen:
        return out
    # Over both feet of the same people, so that the family is whole.
    people = [c.participant for c in next(iter(cells[side] for side in mine))]
    people = [who for who in people if all(any(c.participant == who for c in cells[side]) for side in mine)]
    of = {(side, c.participant): c for side in mine for c in cells[side]}
    group = np.array([[of[side, who].mean(key) for side, key in chosen] for who in people])
    value = np.array([mine[side].mean(key) for side, key in chosen])
    found = deviation_of(value, group)
    for i, (side, key) in enumerate(chosen):
        out[side][key] = standing_of(float(value[i]), group[:, i], float(found.p_all[i]))
    return out


def _curves(mine: Mapping[Side, Cell], cells: Mapping[Side, Sequence[Cell]]) -> tuple[str, dict[Side, Deviation]]:
    out: dict[Side, Deviation] = {}
    unit = "N"
    for side, cell in mine.items():
        unit, curves = mean_curves([cell, *cells[side]])
        if curves is not None:
            out[side] = deviation_of(curves[0], curves[1:])
    return unit, out


def _maps(
    mine: Mapping[Side, Cell], cells: Mapping[Side, Sequence[Cell]]
) -> tuple[dict[Side, Deviation], dict[Side, NDArray[np.bool_]]]:
    out: dict[Side, Deviation] = {}
    kept: dict[Side, NDArray[np.bool_]] = {}
    for side, cell in mine.items():
        maps, places = mean_maps([cell, *cells[side]])
        if maps is not None and places is not None:
            out[side] = deviation_of(maps[0][places], maps[1:][:, places])
            kept[side] = places
    return out, kept
