"""Belts of a treadmill: each carries its foot backwards at a steady speed, as the centre of pressure (CoP) shows."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.formats.plate_sides import Plate, PlateContact

# `_OFTEN`, `_MIDDLE` and `_STRAIGHT` decide on little: of 20 made walks (belts of 0.3 to 1.8 m/s of one and two
# strides, walkways) and four public recordings none is judged otherwise with 2 to 8 contacts, with 0.1 to 0.25 left out
# at either end, or with a scatter of 0.025 to 0.3. Only 0.3 left out hides four slow belts more.
# Contacts on each of two plates from which they are a treadmill's even where no CoP is known.
_OFTEN = 4
_MIDDLE = (0.15, 0.85)  # Part of a contact in which the CoP is followed: it jumps about in landing and lift-off
_STRAIGHT = 0.1  # Largest scatter of a carried CoP about a steady motion, as a share of its way
# Way in m against the push of the foot from which a belt carries it; without a known push, that which no foot rolls.
_BACKWARD = 0.05
_FARTHER = 0.26
_PUSHES = 0.02  # Mean change of the horizontal force in a contact, as a share of the vertical, that is a clear push
_ROLL = 0.22  # Way in m that the CoP of a walking adult goes under the foot from heel to toes, within 0.04 m
_WALK_S = 0.45  # Contact in s that is longer than one of a run
_ALONE = 3  # Contacts that a belt alone carries, from which it is one
_STEADY_S = 0.25  # Shortest contact in s that shows a belt


def are_belts(plates: Sequence[Plate], contacts: Sequence[PlateContact], rate: float, warnings: list[str]) -> bool:
    """Returns whether plates are the belts of a treadmill, which see every step; its speed is added to `warnings`.

    Args:
        plates: On the surface, with their CoP.
        contacts: Of all plates.
        rate: Frames a second.
        warnings: Added to.
    """
    speeds: dict[int, list[float]] = {}
    for contact in contacts:
        speed = _carried(plates[contact.plate], contact, rate)
        if speed is not None:
            speeds.setdefault(contact.plate, []).append(speed)
    usual = float(np.median([c.end - c.begin for c in contacts])) / rate if contacts else 0.0
    # Of one belt alone, whose contacts are apart and as long as a walk's: two feet on it part in a run only.
    alone = len(plates) == 1 and usual > _WALK_S and sum(map(len, speeds.values())) >= _ALONE
    if len(speeds) >= 2 or alone:
        speed = float(np.median([v for own in speeds.values() for v in own]))
        warnings.append(
            f"these are belts: they carry the centre of pressure backwards at {speed:.2g} m/s, so that they run at "
            f"about {speed + _ROLL / usual:.2g} m/s, if a foot rolls over {_ROLL:g} m; each belt is one foot's"
        )
        return True
    often = np.bincount([c.plate for c in contacts], minlength=len(plates)) >= _OFTEN
    return bool(often.sum() >= 2)


def _carried(plate: Plate, contact: PlateContact, rate: float) -> float | None:
    """Speed in m/s at which a contact's CoP moves steadily backwards; None where it does not."""
    length = contact.end - contact.begin
    if plate.cop is None or length < _STEADY_S * rate:
        return None
    first, last = (contact.begin + round(share * length) for share in _MIDDLE)
    points = plate.cop[first:last]
    known = np.isfinite(points).all(axis=1)
    if known.sum() < 5:
        return None
    time = np.arange(last - first)[known] / rate
    velocity, start = np.polyfit(time, points[known], 1)
    way = velocity * float(np.ptp(time))
    scatter = np.hypot(*(points[known] - start - np.outer(time, velocity)).T).std()
    travel = float(np.hypot(*way))
    if travel <= _BACKWARD or scatter > _STRAIGHT * travel:
        return None
    forward = _push(plate, contact)
    carried = travel > _FARTHER if forward is None else float(way @ forward) < -_BACKWARD
    return float(np.hypot(*velocity)) if carried else None


def _push(plate: Plate, contact: PlateContact) -> NDArray[np.float64] | None:
    """Direction of walking (2,): a foot brakes first and pushes off last; None without a clear push."""
    force = np.nan_to_num(plate.force[contact.begin : contact.end])
    third = max(1, len(force) // 3)
    change = force[-third:, :2].mean(axis=0) - force[:third, :2].mean(axis=0)
    size = float(np.hypot(*change))
    return change / size if size > _PUSHES * float(force[:, 2].mean()) else None
