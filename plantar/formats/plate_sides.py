"""Foot of each plate contact: by names, markers, events, push or place."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side
from plantar.recordings.pressure_recording import StatedEvents, true_runs

LEAST = 20.0
"""Vertical force in N from which a plate counts as stepped on, and has a centre of pressure."""

_SHARE = 0.05  # Share of the plate's peak above which a foot is on it
# Contacts in s that are shorter are none; gaps in s that are shorter are bridged
_SHORTEST = 0.1
_BRIDGED = 0.1
_NEARER = 0.1  # How much nearer in m one foot's markers are to the CoP than the other's, at least
_REACH = 0.2  # Time in s between a contact's begin and a stated heel strike of its foot, at most
_TOGETHER = 0.1  # Time in s between heel strikes of both feet below which they land together, as after a jump
# Mean push to the middle in mid-stance, as a share of the peak, from which it shows the foot; walking has 0.03.
_INWARD = 0.01
_PAUSE = 1.0  # Time in s without load that ends a pass over the plates
_ACROSS = 0.02  # Distance in m of plates or contacts across the direction of walking that shows which are the left ones
_CARRIED = 0.2  # Mean way in m of the CoP in a belt's contacts from which the belt runs against it
_LONG = 1.4  # Contacts and gaps on a treadmill's belt of so many medians show that a foot was on the other belt


@dataclass(frozen=True, eq=False)
class Plate:
    """Measurements of one force plate; None if not in the file.

    Attributes:
        name: For messages, such as "plate 1".
        force: (n, 3) in N; horizontal ones NaN if unmeasured.
        moment: (n, 3) in N m about `origin`.
        cop: (n, 2) in m.
        free: Free moment (n,) in N m, if not from `moment`.
        origin: Surface point (2,) in m of moments.
        corners: (4, 2) in m.
        side: Foot named by file or user.
        placed: Whether laboratory place and axes are known.
        normal: Of the surface (3,), upwards.
    """

    name: str
    force: NDArray[np.float64]
    moment: NDArray[np.float64] | None = None
    cop: NDArray[np.float64] | None = None
    free: NDArray[np.float64] | None = None
    origin: NDArray[np.float64] = field(default_factory=lambda: np.zeros(2))
    corners: NDArray[np.float64] | None = None
    side: Side | None = None
    stepped: bool = True
    placed: bool = True
    normal: NDArray[np.float64] = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))


@dataclass(frozen=True)
class PlateContact:
    """Contact on a plate: its number, first frame, and the one after its last."""

    plate: int
    begin: int
    end: int


def plate_contacts(
    plate: int, vertical: NDArray[np.float64], rate: float, bridged: float = _BRIDGED
) -> list[PlateContact]:
    """Returns plate contacts by vertical force (n,) in N at a rate in Hz, cut ones too; none if throughout.

    `bridged`: gaps in s that are shorter are no end of a contact.
    """
    force = np.nan_to_num(vertical)
    loaded = force > max(LEAST, _SHARE * float(np.percentile(force, 99.5)))
    out: list[PlateContact] = []
    for a, b in true_runs(loaded):
        if out and a - out[-1].end < bridged * rate:
            out[-1] = PlateContact(plate, out[-1].begin, b)
        else:
            out.append(PlateContact(plate, a, b))
    return [c for c in out if c.end - c.begin >= _SHORTEST * rate and c.end - c.begin < len(force)]


def sides_of_contacts(
    plates: Sequence[Plate],
    contacts: Sequence[PlateContact],
    treadmill: bool,
    rate: float,
    given: Side | None,
    warnings: list[str],
    markers: Mapping[Side, NDArray[np.float64]] | None = None,
    events: Mapping[Side, StatedEvents] | None = None,
) -> list[Side]:
    """Returns foot of each of the plates' contacts; its reason is added to the warnings.

    `markers`: each foot's (n, 2) in m; `events`: each foot's heel strikes in s.
    """
    if treadmill:
        _report_crossings(plates, contacts, rate, warnings)
    named = _named_sides(plates, warnings)
    if all(side is not None for side in named):
        return [named[c.plate] or "left" for c in contacts]
    if given is not None and len(plates) == 1:
        return [given] * len(contacts)
    found, why = _found(plates, contacts, treadmill, rate, markers, events)
    found = [named[c.plate] or side for c, side in zip(contacts, found, strict=True)]
    if treadmill and any(found):
        found = _by_belt(len(plates), contacts, found)
    elif _walks_on_one_foot(contacts, found):
        found = [None] * len(contacts)
    if not any(found):
        return _assumed(plates, contacts, treadmill, warnings)
    out = _filled_in(contacts, found)
    names = ", ".join(
        f"{plates[i].name}: {' and '.join(sorted({s for c, s in zip(contacts, out, strict=True) if c.plate == i}))}"
        for i in sorted({c.plate for c in contacts})
    )
    warnings.append(f"which foot steps on each plate follows from {why} ({names}; --plates overrides)")
    return out


def _named_sides(plates: Sequence[Plate], warnings: list[str]) -> list[Side | None]:
    """Foot named for each plate; of two plates the one without a name is the other foot's."""
    named = [p.side for p in plates]
    if len(plates) != 2 or named.count(None) != 1:
        return named
    known = next(side for side in named if side is not None)
    plate = plates[named.index(None)]
    warnings.append(
        f"{plate.name} names no foot: it is the {other_side(known)} one's, as the other plate is the {known} one's"
    )
    return [side or other_side(known) for side in named]


def _found(
    plates: Sequence[Plate],
    contacts: Sequence[PlateContact],
    treadmill: bool,
    rate: float,
    markers: Mapping[Side, NDArray[np.float64]] | None,
    events: Mapping[Side, StatedEvents] | None,
) -> tuple[Sequence[Side | None], str]:
    placed = all(p.placed for p in plates)
    found = [_by_markers(plates[c.plate], c, markers) if placed else None for c in contacts]
    if any(found):
        return found, "markers of the feet"
    found = [_by_events(c, rate, events) for c in contacts]
    if any(found) or not placed:
        return found, "stated events"
    back = [] if treadmill else _walking_back(plates, contacts, rate)
    if any(back):
        one, other = ([c for c, b in zip(contacts, back, strict=True) if b == way] for way in (False, True))
        (sides, why), (turned, _) = (_found(plates, part, treadmill, rate, None, None) for part in (one, other))
        ways = iter(sides), iter(turned)
        return [next(ways[b]) for b in back], why
    forward = _forward(plates, contacts, treadmill)
    across = _by_place(plates, contacts, forward)
    if treadmill and across:
        return across, "the belts' places across the direction of walking"
    found = _by_push(plates, contacts, forward)
    agree = all(push in (None, place) for push, place in zip(found, across, strict=False))
    if across and agree and not all(found) and not _walks_on_one_foot(contacts, across):
        return across, "their places across the direction of walking"
    return found, "their push to the body's middle"


def _assumed(
    plates: Sequence[Plate], contacts: Sequence[PlateContact], treadmill: bool, warnings: list[str]
) -> list[Side]:
    if len(plates) == 1:
        text = "taken as the left one (--side or --plates overrides)"
        warnings.append(f"the file does not state which foot steps on the plate: {text}")
        return ["left"] * len(contacts)
    if treadmill:
        warnings.append(
            "the file does not state which belt is which: the first is taken as the left foot's (--plates R,L)"
        )
        return [SIDES[c.plate % 2] for c in contacts]
    warnings.append("the plates lie in one line: taken as stepped on by left and right in turns (--plates overrides)")
    order = sorted(range(len(contacts)), key=lambda i: contacts[i].begin)
    return [SIDES[order.index(i) % 2] for i in range(len(contacts))]


def _by_belt(count: int, contacts: Sequence[PlateContact], found: Sequence[Side | None]) -> list[Side | None]:
    # A belt is one foot's: the one most found on it, unless that were the same for all belts.
    belts: list[Side | None] = []
    for i in range(count):
        votes = [s for c, s in zip(contacts, found, strict=True) if c.plate == i and s]
        belts.append(None if not votes else "left" if 2 * votes.count("left") >= len(votes) else "right")
    return [None if len(set(belts)) == 1 < len(belts) else belts[c.plate] for c in contacts]


def _walks_on_one_foot(contacts: Sequence[PlateContact], found: Sequence[Side | None]) -> bool:
    """Whether contacts of one foot overlap as two feet's do: begins and ends some time apart."""
    for (a, one), (b, other) in itertools.combinations(zip(contacts, found, strict=True), 2):
        shared = min(a.end, b.end) - max(a.begin, b.begin)
        steps = 0 < shared < 0.5 * min(a.end - a.begin, b.end - b.begin)
        if a.plate != b.plate and steps and one is not None and one == other:
            return True
    return False


def _by_markers(plate: Plate, contact: PlateContact, markers: Mapping[Side, NDArray[np.float64]] | None) -> Side | None:
    if not markers or plate.cop is None:
        return None
    span = slice(contact.begin, contact.end)
    away = {}
    for side, track in markers.items():
        gap = np.hypot(*(track[span] - plate.cop[span]).T)
        away[side] = float(np.median(gap[np.isfinite(gap)])) if np.isfinite(gap).any() else np.inf
    if len(away) < 2:
        return next((s for s, d in away.items() if d < 2.0 * _NEARER), None)
    near = min(away, key=lambda s: away[s])
    return near if away[near] + _NEARER < away[other_side(near)] else None


def _by_events(contact: PlateContact, rate: float, events: Mapping[Side, StatedEvents] | None) -> Side | None:
    away = {
        side: float(np.abs(own.heel_strikes - contact.begin / rate).min())
        for side, own in (events or {}).items()
        if len(own.heel_strikes)
    }
    near = min(away, key=lambda s: away[s], default=None)
    if near is None or away[near] > _REACH or away.get(other_side(near), np.inf) - away[near] < _TOGETHER:
        return None
    return near


def _walking_back(plates: Sequence[Plate], contacts: Sequence[PlateContact], rate: float) -> list[bool]:
    """Whether each contact is of a pass against the direction of the first one."""
    passes: list[list[PlateContact]] = []
    for contact in sorted(contacts, key=lambda c: c.begin):
        if not passes or contact.begin - max(c.end for c in passes[-1]) > _PAUSE * rate:
            passes.append([])
        passes[-1].append(contact)
    ways = [(own, way) for own in passes if np.hypot(*(way := _way(plates, own))) > _ACROSS]
    turned = {id(c) for own, way in ways for c in own if way @ ways[0][1] < 0.0}
    return [id(c) in turned for c in contacts]


def _way(plates: Sequence[Plate], contacts: Sequence[PlateContact]) -> NDArray[np.float64]:
    """Sum (2,) of the ways of the CoP in contacts in m."""
    way = np.zeros(2)
    for contact in contacts:
        cop = plates[contact.plate].cop
        cop = np.zeros((0, 2)) if cop is None else cop[contact.begin : contact.end]
        cop = cop[np.isfinite(cop).all(axis=1)]
        if len(cop) > 4:
            way += cop[-1 - len(cop) // 10] - cop[len(cop) // 10]
    return way


def _forward(plates: Sequence[Plate], contacts: Sequence[PlateContact], treadmill: bool) -> NDArray[np.float64] | None:
    """Walking direction (2,): a foot brakes first and pushes off last; else the CoP's."""
    push = np.zeros(2)
    for contact in contacts:
        plate = plates[contact.plate]
        length = contact.end - contact.begin
        span = plate.force[contact.begin : contact.end, :2]
        if not np.isfinite(span).any(axis=0).all():
            continue  # of one axis alone the direction is not known
        span = np.nan_to_num(span)
        push += span[int(0.6 * length) :].sum(axis=0) - span[: int(0.4 * length)].sum(axis=0)
    way = _way(plates, contacts)
    if treadmill:  # a belt that runs carries the foot farther back than it rolls
        way = -way if np.hypot(*way) > _CARRIED * len(contacts) else np.zeros(2)
    total = sum(float(np.nansum(plates[c.plate].force[c.begin : c.end, 2])) for c in contacts)
    vector = push if np.hypot(*push) > 0.02 * total > 0.0 else way
    size = float(np.hypot(*vector))
    return vector / size if size > _ACROSS else None


def _by_push(
    plates: Sequence[Plate], contacts: Sequence[PlateContact], forward: NDArray[np.float64] | None
) -> list[Side | None]:
    out: list[Side | None] = []
    for contact in contacts:
        length = contact.end - contact.begin
        middle = plates[contact.plate].force[contact.begin + length // 5 : contact.end - length // 5]
        known = middle[np.isfinite(middle).all(axis=1)]
        if forward is None or not len(known):
            out.append(None)
            continue
        leftward = float((known[:, :2] @ np.array([-forward[1], forward[0]])).mean())
        clear = abs(leftward) > _INWARD * float(known[:, 2].max())
        out.append(("right" if leftward > 0.0 else "left") if clear else None)
    return out


def _by_place(
    plates: Sequence[Plate], contacts: Sequence[PlateContact], forward: NDArray[np.float64] | None
) -> list[Side]:
    """Foot of each contact by its plate's place across the walking direction; empty if in a line."""
    if forward is None or len(contacts) < 2:
        return []
    places = []
    for contact in contacts:
        cop = plates[contact.plate].cop
        corners = plates[contact.plate].corners
        own = None if cop is None else cop[contact.begin : contact.end]
        if own is not None and np.isfinite(own).all(axis=1).any():
            places.append(np.nanmean(own, axis=0))
        elif corners is not None:
            places.append(corners.mean(axis=0))
        else:
            return []
    leftward = np.array(places) @ np.array([-forward[1], forward[0]])
    if float(np.ptp(leftward)) < _ACROSS:
        return []
    middle = 0.5 * float(leftward.max() + leftward.min())
    return ["left" if y >= middle else "right" for y in leftward]


def _filled_in(contacts: Sequence[PlateContact], found: Sequence[Side | None]) -> list[Side]:
    order = sorted(range(len(contacts)), key=lambda i: contacts[i].begin)
    sides: dict[int, Side | None] = dict(enumerate(found))
    for way in (order, order[::-1]):
        for before, at in itertools.pairwise(way):
            known = sides[before]
            if sides[at] is None and known is not None:
                sides[at] = known if contacts[at].plate == contacts[before].plate else other_side(known)
    return [sides[i] or "left" for i in range(len(contacts))]


def _report_crossings(
    plates: Sequence[Plate], contacts: Sequence[PlateContact], rate: float, warnings: list[str]
) -> None:
    for i, plate in enumerate(plates):
        own = [c for c in contacts if c.plate == i]
        others = [c for c in contacts if c.plate != i]
        if len(own) < 4 or len(others) < 4:
            continue
        usual = float(np.median([c.end - c.begin for c in own]))
        gaps = np.array([b.begin - a.end for a, b in itertools.pairwise(others)])
        wide = [(a.end, b.begin) for a, b in itertools.pairwise(others) if b.begin - a.end > _LONG * np.median(gaps)]
        crossed = [
            c for c in own if c.end - c.begin > _LONG * usual and any(a < c.end and b > c.begin for a, b in wide)
        ]
        if crossed:
            at = ", ".join(f"{c.begin / rate:.1f}" for c in crossed[:5])
            warnings.append(
                f"both feet are on {plate.name} {len(crossed)} time(s), at {at} s: these contacts are of no one foot"
            )
