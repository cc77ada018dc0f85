"""Parts of a recording with one activity."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from statistics import median
from typing import cast

import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.foot_gait import FootGait, Step

# A contact over twice the median of the three before and the three after it, and over 1.2 s, is standing.
_LONG = 2.0
_LEAST = 1.2
_BESIDE = 3
# A stride of a run has a flight of more than 0.01 s and a stance below half of it, on average over both feet: they are
# longer off the ground than on it together. Of one foot, stance is below 45 %.
FLIGHT = 0.01
_HALF = 50.0
_RUN = 45.0
_SAME = 0.8  # Share of both feet's contacts that is common where both hop at once; walking has 0.2
# Measures of the stride from a step to the next one of its foot.
_OF_STRIDE = (
    *("stride_time_s", "swing_time_s", "stance_percent", "swing_percent", "double_support_percent"),
    *("single_support_percent", "stride_length_m", "stride_velocity_m_s"),
)
_IN_TURNS = ("step_time_s", "double_support_percent", "single_support_percent")  # Measures of feet that step in turns
_SHORTEST = 4  # Steps of both feet from which they are a segment and no odd step
_PAUSE = 3.0  # Usual strides without a step that part two segments


@dataclass(frozen=True)
class Segment:
    """Consecutive steps of one activity.

    `activity`: "walking", "running", "hopping" or "standing"; `begin`: first heel strike in s; `end`: last toe off in
    s.
    """

    activity: str
    begin: float
    end: float
    steps: Mapping[Side, tuple[int, ...]]

    @property
    def count(self) -> int:
        """Steps of both feet."""
        return sum(len(own) for own in self.steps.values())


def without_standing(contacts: Sequence[Contact], most: float = math.inf) -> list[Contact]:
    """Returns contacts, those too long for a step marked as standing: for their neighbours, or alone above `most` s."""
    known = [i for i, c in enumerate(contacts) if c.complete]
    lasts = {i: cast(float, contacts[i].toe_off) - cast(float, contacts[i].heel_strike) for i in known}
    out = list(contacts)
    for at, i in enumerate(known):
        around = [lasts[k] for k in known[max(0, at - _BESIDE) : at] + known[at + 1 : at + 1 + _BESIDE]]
        if lasts[i] > (max(_LEAST, _LONG * median(around)) if len(around) >= 2 else most):
            out[i] = replace(contacts[i], standing=True)
    return out


def with_activities(feet: Mapping[Side, FootGait]) -> dict[Side, FootGait]:
    """Feet with each step's activity: "walking", "running", "hopping", or empty if unknown."""
    hops = _both_at_once(feet)
    rows = sorted((s for g in feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)
    raw = ["hopping" if hops else _activity(rows, i) for i in range(len(rows))]
    # One odd step is no segment.
    steady = [most_common(raw[max(0, i - 2) : i + 3]) or name for i, name in enumerate(raw)]
    found = {(s.side, s.number): name for s, name in zip(rows, steady, strict=True)}
    out: dict[Side, FootGait] = {}
    for side, gait in feet.items():
        steps = [replace(s, activity=found[side, s.number]) for s in gait.steps]
        for i, (step, after) in enumerate(pairwise(steps)):
            if step.activity != after.activity:  # its stride is of neither
                steps[i] = replace(step, measures={k: v for k, v in step.measures.items() if k not in _OF_STRIDE})
        if hops:
            steps = [replace(s, measures={k: v for k, v in s.measures.items() if k not in _IN_TURNS}) for s in steps]
        out[side] = replace(gait, steps=tuple(steps))
    return out


def _both_at_once(feet: Mapping[Side, FootGait]) -> bool:
    if len(feet) < 2:
        return False
    left, right = ([c for c in feet[s].contacts if c.complete] for s in SIDES)
    if len(left) < 3 or len(right) < 3:
        return False
    one, other = (
        np.array([[cast(float, c.heel_strike), cast(float, c.toe_off)] for c in own]) for own in (left, right)
    )
    near = np.clip(np.searchsorted(other[:, 0], one[:, 0])[:, None] + np.array([-1, 0]), 0, len(other) - 1)
    begin = one[:, :1]
    end = one[:, 1:]
    common = np.minimum(end, other[near, 1]) - np.maximum(begin, other[near, 0])
    whole = np.maximum(end, other[near, 1]) - np.minimum(begin, other[near, 0])
    return float(np.median((common / whole).max(axis=1))) > _SAME


def _activity(rows: Sequence[Step], i: int) -> str:
    """Activity of the stride of both feet that a step is in: with the other foot's steps before and after it."""
    beside = [s for s in rows[max(0, i - 1) : i + 2] if s.side != rows[i].side]
    flights, stances = (_of_stride(rows[i], beside, key) for key in ("flight_time_s", "stance_percent"))
    if flights and stances:
        return "running" if max(flights) > FLIGHT and sum(stances) / len(stances) < _HALF else "walking"
    if math.isfinite(rows[i]["stance_percent"]):
        return "running" if rows[i]["stance_percent"] < _RUN else "walking"
    return ""


def _of_stride(step: Step, beside: Sequence[Step], key: str) -> list[float]:
    own, others = ([v for s in steps if math.isfinite(v := s[key])] for steps in ([step], beside))
    return [*own, sum(others) / len(others)] if others else own


def most_common(names: Sequence[str]) -> str:
    """Name that most have, empty ones left out; empty without any."""
    known = [n for n in names if n]
    return max(dict.fromkeys(known), key=known.count) if known else ""


def segments_of(feet: Mapping[Side, FootGait]) -> tuple[Segment, ...]:
    """Segments of feet with activities in time order; standing where a foot stays on the ground too long."""
    rows = sorted((s for g in feet.values() for s in g.steps), key=lambda s: s.heel_strike_s)
    strides = [v for s in rows if np.isfinite(v := s["stride_time_s"])]
    pause = _PAUSE * float(np.median(strides)) if strides else np.inf
    groups: list[list[Step]] = []
    for step in rows:
        last = groups[-1][-1] if groups else None
        apart = last is None or step.heel_strike_s - last.heel_strike_s > pause
        if last is None or apart or (step.activity and last.activity and step.activity != last.activity):
            groups.append([])
        groups[-1].append(step)
    out = [
        Segment(
            most_common([s.activity for s in group]) or "unknown",
            group[0].heel_strike_s,
            max(s.toe_off_s for s in group),
            {side: tuple(s.number for s in group if s.side == side) for side in feet},
        )
        for group in groups
        if len(group) >= min(_SHORTEST, len(rows))
    ]
    standing = [(c.heel_strike, c.toe_off) for g in feet.values() for c in g.contacts if c.standing]
    for begin, end in _common([(a, b) for a, b in standing if a is not None and b is not None]):
        out.append(Segment("standing", begin, end, {}))
    return tuple(sorted(out, key=lambda s: s.begin))


def _common(spans: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    joined: list[tuple[float, float]] = []
    for begin, end in sorted(spans):
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((begin, end))
    return joined
