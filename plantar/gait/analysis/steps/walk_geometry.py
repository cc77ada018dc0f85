"""Places of steps: lengths, widths, strides, and foot angles to the walking line."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side, other_side

_LEAST_STRIDE = 0.05  # Distance in m under which two footprints of one foot give no direction
_LONGEST_STRIDE = 3.0  # Time in s after which a footprint is not the next one of a walk


@dataclass(frozen=True, eq=False)
class Place:
    """Place of one step.

    `time`: heel strike in s; `heel`: back of the heel (2,) on the ground in m; `axis`: foot direction (2,), heel to
    toes; `forward`: walking direction (2,), if known apart from the steps; `walk`: number of the pass, which no length
    leaves.
    """

    time: float
    heel: NDArray[np.float64]
    axis: NDArray[np.float64]
    forward: NDArray[np.float64] | None = None
    walk: int = 0


def step_geometry(places: Mapping[Side, Sequence[Place]]) -> dict[Side, list[dict[str, float]]]:
    """Lengths and angles of each step from each foot's places in order, if known.

    The walking line joins the heels of this foot's last footprint and this one, else it is the place's direction. Step
    length is along it from the other foot's last heel, step width that heel's distance from it (Huxham et al. 2006). A
    stride begins with its step; foot progression is outward positive.

    Example:
        >>> x = np.array([1.0, 0.0])
        >>> left = [Place(0.0, np.array([0.0, 0.1]), x), Place(1.0, np.array([1.2, 0.1]), x)]
        >>> right = [Place(0.5, np.array([0.6, 0.0]), x)]
        >>> first, second = step_geometry({"left": left, "right": right})["left"]
        >>> round(second["step_length_m"], 6), round(second["step_width_m"], 6), round(first["stride_length_m"], 6)
        (0.6, 0.1, 1.2)
    """
    out: dict[Side, list[dict[str, float]]] = {}
    for side, own in places.items():
        others = places.get(other_side(side), ())
        out[side] = [
            _step(side, place, own[i - 1] if i else None, others)
            | (_stride(place, own[i + 1])[0] if i + 1 < len(own) else {})
            for i, place in enumerate(own)
        ]
    return out


def _step(side: Side, place: Place, before: Place | None, others: Sequence[Place]) -> dict[str, float]:
    out: dict[str, float] = {}
    forward = place.forward if before is None else _stride(before, place)[1]
    if forward is None:
        return out
    left = np.array([-forward[1], forward[0]])
    outward = 1.0 if side == "left" else -1.0
    out["foot_progression_deg"] = outward * float(np.degrees(np.arctan2(place.axis @ left, place.axis @ forward)))
    earlier = [o for o in others if 0.0 < place.time - o.time <= _LONGEST_STRIDE and o.walk == place.walk]
    if earlier and (before is None or earlier[-1].time > before.time):
        step = place.heel - earlier[-1].heel
        out["step_length_m"] = float(step @ forward)
        out["step_width_m"] = abs(float(step @ left))
    return out


def _stride(place: Place, after: Place) -> tuple[dict[str, float], NDArray[np.float64] | None]:
    if after.time - place.time > _LONGEST_STRIDE or after.walk != place.walk:
        return {}, after.forward
    stride = after.heel - place.heel
    length = float(np.hypot(*stride))
    out = {"stride_length_m": length, "stride_velocity_m_s": length / (after.time - place.time)}
    return out, stride / length if length >= _LEAST_STRIDE else after.forward
