"""Which steps are in the means, and which are odd."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.steps.foot_gait import FootGait, Step

FEWEST_STEPS = 12
"""Steps a foot that reliable means of in-shoe pressure take (Arts & Bus 2011, Clin. Biomech. 26:880)."""

_FEWEST_TO_JUDGE = 5  # Steps of a foot from which a usual step differs from an odd one
_ODD = 4.0  # Robust standard deviations from the median beyond which a step is odd: one of 16,000 of a normal variable
# Measures by which a step is judged: the least standard deviation, as a share of the median; name and unit.
_JUDGED = {
    "contact_time_s": (0.03, "contact", "s"),
    "stride_time_s": (0.03, "stride", "s"),
    "peak_force_N": (0.04, "peak force", "N"),
    "impulse_Ns": (0.05, "impulse", "N s"),
}


def with_used_steps(
    gait: FootGait, options: AnalysisOptions, kind: str, raw: bool = False, activity: str = ""
) -> FootGait:
    """Returns foot's gait with steps marked as used or why not, and as odd, with warnings.

    Odd steps that start or end a walk are left out unless the options name steps. Only insoles and robots, by kind,
    have starting steps; raw forces are counts; activity limits the used steps.
    """
    others = [step for step in gait.steps if activity and step.activity not in ("", activity)]
    steps = [step for step in gait.steps if step not in others]
    if not steps:
        left = tuple(_of_other(step) for step in others)
        return replace(gait, steps=left) if left else gait
    odd = _odd(steps, raw) if len(steps) >= _FEWEST_TO_JUDGE and kind in ("insole", "robot") else [""] * len(steps)
    used = np.ones(len(steps), dtype=bool)
    notes = list(gait.warnings)
    side = gait.foot.side
    reason = ""
    if options.steps == "steady":
        ends = _ends(odd)
        if ends.any():
            used &= ~ends
            reason = "starts or stops the walk"
            numbers = np.array([step.number for step in steps])
            steady = numbers[~ends]
            verbs = ("starts or stops", "is") if ends.sum() == 1 else ("start or stop", "are")
            notes.append(
                f"steady walking of the {side} foot is steps {steady[0]}-{steady[-1]}: "
                f"{', '.join(map(str, numbers[ends]))} {verbs[0]} the walk and {verbs[1]} left out of the means "
                "(--steps all keeps them)"
            )
    elif options.steps != "all":
        first, last = options.steps
        used &= np.array([first <= step.number <= last for step in steps])
        reason = f"not one of the steps {first}-{last}"
    begin = -np.inf if options.begin is None else options.begin
    end = np.inf if options.end is None else options.end
    within = [step.heel_strike_s >= begin and step.toe_off_s <= end for step in steps]
    out = [
        replace(step, used=bool(u and w), unused=reason if not u else "" if w else "outside --from and --to", odd=o)
        for step, u, w, o in zip(steps, used, within, odd, strict=True)
    ]
    odd_used = (step for step in out if step.used and step.odd)
    notes += [f"step {step.number} of the {side} foot is odd and in the means: {step.odd}" for step in odd_used]
    count = sum(step.used for step in out)
    if count == 0:
        notes.append(f"no step of the {side} foot is among those that were asked for: it has {len(steps)}")
    elif count < FEWEST_STEPS and kind == "insole":
        notes.append(
            f"{count} step{'' if count == 1 else 's'} of the {side} foot {'is' if count == 1 else 'are'} in the means: "
            f"fewer than {FEWEST_STEPS} a foot are less reliable (Arts & Bus 2011)"
        )
    everything = sorted([*out, *map(_of_other, others)], key=lambda step: step.number)
    return replace(gait, steps=tuple(everything), warnings=tuple(notes))


def _of_other(step: Step) -> Step:
    return replace(step, used=False, unused=f"{step.activity}, which the means are not of")


def in_one_window(feet: Mapping[Side, FootGait]) -> dict[Side, FootGait]:
    """Feet without used steps over a stride outside the other foot's: both cover the same time."""
    used = {side: gait.used for side, gait in feet.items()}
    if len(feet) < 2 or not all(used.values()):
        return dict(feet)
    strides = [v for own in used.values() for s in own if np.isfinite(v := s["stride_time_s"])]
    if not strides:  # single steps of each foot, as on two plates
        return dict(feet)
    stride = float(np.median(strides))
    begin = max(own[0].heel_strike_s for own in used.values()) - stride
    end = min(own[-1].toe_off_s for own in used.values()) + stride
    out: dict[Side, FootGait] = {}
    for side, gait in feet.items():
        late = [s.number for s in gait.used if s.heel_strike_s < begin or s.toe_off_s > end]
        steps = tuple(
            replace(s, used=False, unused="outside the other foot's steps") if s.number in late else s
            for s in gait.steps
        )
        names = ", ".join(map(str, late))
        text = f"steps {names} of the {side} foot lie outside the other foot's steps in the means: left out"
        out[side] = replace(gait, steps=steps, warnings=(*gait.warnings, *([text] if late else [])))
    return out


def _odd(steps: Sequence[Step], raw: bool) -> list[str]:
    out = [""] * len(steps)
    for key, (least, word, unit) in _JUDGED.items():
        values = np.array([step[key] for step in steps])
        known = np.isfinite(values)
        if known.sum() < _FEWEST_TO_JUDGE:
            continue
        middle = float(np.median(values[known]))
        spread = max(1.4826 * float(np.median(np.abs(values[known] - middle))), least * abs(middle))
        for i in np.flatnonzero(known & (np.abs(values - middle) > _ODD * spread)):
            shown = unit.replace("N", "counts") if raw else unit
            out[i] = out[i] or f"{word} of {values[i]:.3g} {shown}, the median is {middle:.3g} {shown}"
    return out


def _ends(odd: Sequence[str]) -> NDArray[np.bool_]:
    bad = np.array([bool(text) for text in odd])
    ends = np.logical_and.accumulate(bad) | np.logical_and.accumulate(bad[::-1])[::-1]
    return ends if ends.sum() <= 0.5 * len(ends) else np.zeros(len(ends), dtype=bool)
