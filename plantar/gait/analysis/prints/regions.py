"""Regions of the foot, from the footprint.

Toes begin at a gap, or pressure valley, in front of the metatarsal heads. The toeless print is cut into length thirds,
its forefoot into width thirds; the hallux is the medial part of the toes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from statistics import median

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.masks import SEVEN, TEN
from plantar.gait.analysis.prints.footprint import Footprint

REGIONS: Mapping[str, str] = dict(SEVEN)
"""Names of the regions, from heel to toes, with their titles."""

_STRIPS = 4
_DEPTH = 0.6  # A valley in front of the forefoot is no more than this share of the lower one of the peaks next to it
_TOE_PEAK = 0.08  # Toes carry at least this share of the forefoot's peak pressure
_HALLUX = 0.40  # Share of the width of the toes, from the medial side, that is the hallux
# Shares of the length with toes at which heel and midfoot end, and of the forefoot's width from the medial edge at
# which the metatarsals meet: those of novel's automatic mask, as the R package pressuRe (0.2.7) draws it.
_HEEL_ENDS = 0.27
_MIDFOOT_ENDS = 0.55
_METATARSALS = (0.30, 0.47, 0.64, 0.81)
_TOES_OF_SOLE = 0.82  # Share of an insole's length at which its toe region begins where the pressure shows no valley


def with_toe_line(print_: Footprint) -> Footprint:
    """Footprint with its toe line, if found.

    In each strip along the foot the valley beyond the highest pressure between 45 and 80 % of the length counts if
    below 60 % of what follows. Strips without one use their neighbours' line.
    """
    low, high = (end[:, 0] for end in print_.ends)
    extent = high - low
    pitch = float(np.median(extent)) if len(extent) else 0.0
    if np.ptp(print_.centres[:, 1]) < 2.0 * pitch or print_.length < 6.0 * pitch:
        return print_
    found = _valleys(print_, pitch)
    if len(found) < 2 and not (found and _whole_gap(print_, pitch)):
        return print_
    middle = median(at for _, at in found)
    kept = [(place, at) for place, at in found if abs(at - middle) < 0.12 * print_.length]
    return replace(print_, toe_line=np.array(kept))


def _valleys(print_: Footprint, pitch: float) -> list[tuple[float, float]]:
    v = print_.centres[:, 1]
    edges = np.linspace(float(v.min()) - 1e-9, float(v.max()) + 1e-9, _STRIPS + 1)
    strips = [(v >= a - 0.25 * pitch) & (v <= b + 0.25 * pitch) for a, b in pairwise(edges)]
    places, heights = _profiles(print_, np.array(strips), pitch)
    found: list[tuple[float, float]] = []
    for (a, b), height in zip(pairwise(edges.tolist()), heights, strict=True):
        at = _valley(print_.length, places, height)
        if at is not None:
            found.append((0.5 * (a + b), at))
    return found


def _profiles(
    print_: Footprint, strips: NDArray[np.bool_], pitch: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places (p,) along the foot in m, and the largest pressure (s, p) there of the cells (s, n) of each strip."""
    places = np.arange(0.40 * print_.length, print_.length, 0.5 * max(pitch, print_.length / 200.0))
    low, high = print_.ends
    begin = np.searchsorted(places, low[:, 0], "left")
    end = np.searchsorted(places, high[:, 0], "right")
    strip, cell = np.nonzero(strips & (begin < end))
    begin = begin[cell]
    end = end[cell]
    pressure = print_.pressure[cell]
    heights = np.zeros((len(strips), len(places)))
    for place in range(int((end - begin).max(initial=0))):  # a cell lies over a few places side by side
        over = begin + place < end
        np.maximum.at(heights, (strip[over], begin[over] + place), pressure[over])
    return places, heights


def _valley(length: float, places: NDArray[np.float64], height: NDArray[np.float64]) -> float | None:
    """u of the middle of a strip's valley between forefoot and toes, by its heights (p,) at places along the foot."""
    fore = (places >= 0.45 * length) & (places <= 0.80 * length)
    if not fore.any() or height[fore].max() <= 0.0:
        return None
    peak = int(np.flatnonzero(fore)[np.argmax(height[fore])])
    within = (places >= 0.62 * length) & (places <= 0.92 * length)
    beyond = np.maximum.accumulate(height[::-1])[::-1]
    top = height[peak]
    after = np.append(beyond[1:], 0.0)
    low = (after >= _TOE_PEAK * top) & (height <= _DEPTH * np.minimum(after, top))  # next to the peak and to toes
    low[: peak + 1] = False
    candidates = np.flatnonzero(low & within)
    if not len(candidates):
        return None
    lowest = int(candidates[np.argmin(height[candidates])])
    higher = np.flatnonzero(height[lowest:] > height[lowest] + 1e-12)
    return float(places[lowest : lowest + higher[0]].mean())


def _whole_gap(print_: Footprint, pitch: float) -> bool:
    places, (height,) = _profiles(print_, np.ones((1, len(print_.areas)), dtype=bool), pitch)
    front = height[places > 0.6 * print_.length]
    return bool(len(front) and (front[: -1 if len(front) > 1 else None] == 0.0).any())


def regions_of(print_: Footprint, of_sole: float | None = None) -> NDArray[np.int64]:
    """Returns index (n,) into `REGIONS` of each cell of footprint `print_`, with its toe line if any.

    Else toes begin at 82 % of the length in m `of_sole` from the origin; None for no toes.
    """
    u = print_.centres[:, 0]
    toe = print_.is_toe
    if print_.toe_line is None and of_sole is not None:
        toe = u > _TOES_OF_SOLE * of_sole
    length = float(print_.ends[1][~toe, 0].max()) if (~toe).any() else print_.length
    out = np.zeros(len(u), dtype=np.int64)
    out[u > length / 3.0] = 1
    front = (u > 2.0 * length / 3.0) & ~toe
    for cells, names, shares in (
        (front, ("forefoot_lateral", "forefoot_central", "forefoot_medial"), (1.0 / 3.0, 2.0 / 3.0)),
        (toe, ("toes", "hallux"), (1.0 - _HALLUX,)),
    ):
        if cells.any():
            out[cells] = np.array([list(REGIONS).index(name) for name in names])[_parts_across(print_, cells, shares)]
    return out


def _parts_across(print_: Footprint, cells: NDArray[np.bool_], shares: Sequence[float]) -> NDArray[np.int64]:
    """Part from the lateral edge, from 0, in which each chosen cell lies: cells' width is parted at shares of it."""
    first, last = (end[cells, 1] for end in print_.ends)
    low = float(first.min())
    high = float(last.max())
    return np.asarray(np.searchsorted(low + np.array(shares) * (high - low), print_.centres[cells, 1]))


def ten_regions_of(print_: Footprint, of_sole: float | None = None) -> NDArray[np.int64]:
    """Returns index (n,) into `TEN` of each cell of a footprint; arguments as of `regions_of`.

    The heel is halved at the middle of its width.
    """
    u = print_.centres[:, 0]
    toe = print_.is_toe
    if print_.toe_line is None and of_sole is not None:
        toe = u > _TOES_OF_SOLE * of_sole
    names = [name for name, _ in TEN]
    length = print_.length
    heel = (u <= _HEEL_ENDS * length) & ~toe
    out = np.full(len(u), names.index("midfoot"))
    for cells, first, shares in (
        (heel, ("heel_lateral", "heel_medial"), (0.5,)),
        (
            (u > _MIDFOOT_ENDS * length) & ~toe,
            tuple(f"metatarsal_{n}" for n in (5, 4, 3, 2, 1)),
            tuple(1.0 - share for share in reversed(_METATARSALS)),
        ),
        (toe, ("toes", "hallux"), (1.0 - _HALLUX,)),
    ):
        if cells.any():
            out[cells] = np.array([names.index(name) for name in first])[_parts_across(print_, cells, shares)]
    return out
