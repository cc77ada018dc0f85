"""Conditions of a study compared: participants count once a condition, paired if possible."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.gait.analysis.compare import unlike
from plantar.gait.analysis.measures import COMPARED, raw_name
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.statistics import Effect, PermutationTest, effect_of, permutation_test

_Group = Sequence[Sequence[RecordingResult]]  # Recordings of each participant
FEWEST = 3  # Participants a condition from which a difference can be tested at all
MOST_PAIRS = 6  # Pairs of conditions that are compared: those of four conditions
# Robust standard deviations from the median of a condition beyond which a participant is an outlier to look at.
_FAR = 3.5


class Outlier(NamedTuple):
    """Participant's mean far from those of the same condition."""

    participant: str
    condition: str
    key: str
    value: float
    median: float


@dataclass(frozen=True, eq=False)
class Comparison:
    """Conditions A and B of a study; curves, maps and tests are None with too few participants.

    Attributes:
        paired: Whether the same participants are in both.
        curve_unit: "N", "counts" or "% of body weight".
        curves: Mean vertical force curves (participants, 101) of A and B.
        curve_test: Where they differ.
        maps: Mean maps (participants, 36, 14) in Pa of A and B.
        map_test: Where they differ, among `places`.
        places: Map places (36, 14) that every participant has.
        note: Why nothing was compared, or empty.
    """

    a: str
    b: str
    paired: bool
    effects: Mapping[str, Effect]
    curve_unit: str = "N"
    curves: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    curve_test: PermutationTest | None = None
    maps: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    map_test: PermutationTest | None = None
    places: NDArray[np.bool_] | None = None
    note: str = ""
    doubts: Sequence[str] = ()


def compare_conditions(results: Sequence[RecordingResult]) -> list[Comparison]:
    """Comparisons of every two conditions in order of appearance; six pairs at most."""
    names = list(dict.fromkeys(r.who.condition for r in results if r.who.condition and not r.error))
    return [_compared(results, a, b) for a, b in list(combinations(names, 2))[:MOST_PAIRS]]


def _compared(results: Sequence[RecordingResult], a: str, b: str) -> Comparison:
    of_a, of_b = (_by_participant(results, name) for name in (a, b))
    shared = [who for who in of_a if who in of_b]
    paired = len(shared) >= FEWEST
    first, second = (
        (shared, shared) if paired else ([w for w in of_a if w not in of_b], [w for w in of_b if w not in of_a])
    )
    if min(len(first), len(second)) < FEWEST:
        note = (
            f"{a or 'A'} has {len(of_a)} and {b or 'B'} {len(of_b)} participants, {len(shared)} of them in both: "
            f"differences take {FEWEST} in both, or {FEWEST} others in each"
        )
        return Comparison(a, b, False, {}, note=note)
    recordings_a = [of_a[w] for w in first]
    recordings_b = [of_b[w] for w in second]
    unit, curves = _curves(recordings_a, recordings_b)
    chain = [] if curves is None else grid_neighbours(np.ones((1, curves[0].shape[1]), dtype=bool))
    curve_test = None if curves is None else permutation_test(*curves, paired, chain)
    maps, places, map_test = _maps(recordings_a, recordings_b, paired)
    effects = _effects(recordings_a, recordings_b, paired)
    one, other = ({r.sensor for own in group for r in own} for group in (recordings_a, recordings_b))
    doubts = unlike(one, other, a, b)
    return Comparison(a, b, paired, effects, unit, curves, curve_test, maps, map_test, places, doubts=doubts)


def _by_participant(results: Sequence[RecordingResult], condition: str) -> dict[str, list[RecordingResult]]:
    out: dict[str, list[RecordingResult]] = {}
    for result in results:
        if result.who.condition == condition and not result.error and any(f["steps"] for f in result.feet.values()):
            out.setdefault(result.who.participant, []).append(result)
    return out


def mean_of(recordings: Sequence[RecordingResult], key: str) -> float:
    """Returns participant's mean of a measure's key over recordings and feet; NaN without any."""
    values = [foot[key] for r in recordings for foot in r.feet.values() if key in foot]
    return float(np.mean(values)) if values else float("nan")


def _effects(a: _Group, b: _Group, paired: bool) -> dict[str, Effect]:
    keys = list(dict.fromkeys(k for name in COMPARED for k in (name, raw_name(name))))
    first, second = (np.array([[mean_of(own, key) for key in keys] for own in group]) for group in (a, b))
    kept = np.isfinite(first).all(axis=0) & np.isfinite(second).all(axis=0)
    if not kept.any():
        return {}
    test = permutation_test(first[:, kept], second[:, kept], paired)
    names = [key for key, keep in zip(keys, kept, strict=True) if keep]
    return {
        key: effect_of(first[:, kept][:, i], second[:, kept][:, i], paired, float(test.p[i]), float(test.p_all[i]))
        for i, key in enumerate(names)
    }


def _curves(a: _Group, b: _Group) -> tuple[str, tuple[NDArray[np.float64], NDArray[np.float64]] | None]:
    everyone = [r for own in (*a, *b) for r in own]
    if not all(any(r.curves for r in own) for own in (*a, *b)) or len({r.raw for r in everyone}) > 1:
        return "N", None
    weighed = all(r.who.mass_kg is not None for r in everyone) and not everyone[0].raw

    def curve(own: Sequence[RecordingResult]) -> NDArray[np.float64]:
        scales = [100.0 / (r.who.mass_kg * GRAVITY) if weighed and r.who.mass_kg else 1.0 for r in own]
        return np.asarray(np.mean([s * c for s, r in zip(scales, own, strict=True) for c in r.curves.values()], axis=0))

    unit = "% of body weight" if weighed else "counts" if everyone[0].raw else "N"
    return unit, (np.array([curve(own) for own in a]), np.array([curve(own) for own in b]))


def _maps(
    a: _Group, b: _Group, paired: bool
) -> tuple[tuple[NDArray[np.float64], NDArray[np.float64]] | None, NDArray[np.bool_] | None, PermutationTest | None]:
    everyone = [r for own in (*a, *b) for r in own]
    if not all(any(r.maps for r in own) for own in (*a, *b)) or len({r.raw for r in everyone}) > 1:
        return None, None, None
    first, second = (
        np.array([np.mean([m for r in own for m in r.maps.values()], axis=0) for own in group]) for group in (a, b)
    )
    places = np.isfinite(first).all(axis=0) & np.isfinite(second).all(axis=0)
    if not places.any():
        return None, None, None
    test = permutation_test(first[:, places], second[:, places], paired, grid_neighbours(places), 500)
    return (first, second), places, test


def grid_neighbours(places: NDArray[np.bool_]) -> list[list[int]]:
    """Side neighbours' numbers of each kept grid place, numbered row by row.

    Example:
        >>> grid_neighbours(np.array([[True, True], [False, True]]))
        [[1], [0, 2], [1]]
    """
    number = np.full(places.shape, -1)
    number[places] = np.arange(int(places.sum()))
    padded = np.pad(number, 1, constant_values=-1)
    rows, columns = np.nonzero(places)
    around = [padded[rows + 1 + i, columns + 1 + j] for i, j in ((-1, 0), (0, -1), (0, 1), (1, 0))]
    return [[int(n) for n in one if n >= 0] for one in np.array(around).T]


def outliers(results: Sequence[RecordingResult]) -> list[Outlier]:
    """Participants with a mean far from their condition's, farthest first; of five or more."""
    found: list[tuple[float, Outlier]] = []
    for condition in dict.fromkeys(r.who.condition for r in results):
        people = _by_participant(results, condition)
        if len(people) < 5:
            continue
        for key in COMPARED:
            values = {who: mean_of(own, key) for who, own in people.items()}
            known = np.array([v for v in values.values() if np.isfinite(v)])
            if len(known) < 5:
                continue
            middle = float(np.median(known))
            spread = max(1.4826 * float(np.median(np.abs(known - middle))), 0.02 * abs(middle), 1e-12)
            for who, value in values.items():
                if abs(value - middle) > _FAR * spread:
                    found.append((abs(value - middle) / spread, Outlier(who, condition, key, value, middle)))
    return [outlier for _, outlier in sorted(found, key=lambda one: -one[0])]
