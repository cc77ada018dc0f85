"""Events that a file states: their contacts, and differences from own events."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.recordings.pressure_recording import StatedEvents

_SAME = 0.25  # Longest time in s between a stated event and a found one that are the same: less than half of a swing


def stated_contacts(time: NDArray[np.float64], events: StatedEvents) -> list[Contact]:
    """Returns contacts of stated `events` at `time` (n,) in s: heel strike to the toe off after it; cut at the ends."""
    strikes = events.heel_strikes
    lifts = events.toe_offs
    ends = np.append(strikes[1:], np.inf)[: len(strikes)]
    early = lifts[lifts <= strikes[0]] if len(strikes) else lifts[:0]
    pairs: list[tuple[float | None, float | None]] = [(None, float(early[-1]))] if len(early) else []
    for strike, end in zip(strikes, ends, strict=True):
        own = lifts[(lifts > strike) & (lifts < end)]
        pairs.append((float(strike), float(own[0]) if len(own) else None))
    out = []
    for begin, end in pairs:
        first = 0 if begin is None else int(np.searchsorted(time, begin))
        after = strikes[strikes > begin] if begin is not None and end is None else np.zeros(0)
        stop = end if end is not None else float(after[0]) if len(after) else float(time[-1]) + 1.0
        last = int(np.searchsorted(time, stop, side="right"))
        if last - first >= 2:
            out.append(Contact(begin, end, first, last))
    return out


def stated_beside_own(events: StatedEvents | None, gait: FootGait) -> dict[str, Any] | None:
    """Returns a foot's stated events and the times of those in its gait less the stated ones; None without events.

    Differences are None without an event within 0.25 s.
    """
    if events is None:
        return None
    out: dict[str, Any] = {}
    for name, stated, own in (
        ("heel_strike", events.heel_strikes, gait.heel_strikes),
        ("toe_off", events.toe_offs, gait.toe_offs),
    ):
        out[f"{name}s_s"] = stated.tolist()
        out[f"{name}_difference_s"] = [_difference(float(at), np.array(own)) for at in stated]
    return out


def _difference(at: float, own: NDArray[np.float64]) -> float | None:
    if len(own) == 0:
        return None
    nearest = float(own[np.argmin(np.abs(own - at))]) - at
    return nearest if abs(nearest) <= _SAME else None
