"""Gait parameters: measures of each step (docs/metrics.md)."""

import math
from bisect import bisect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import accumulate
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side, other_side
from plantar.errors import InputError
from plantar.gait.analysis.health import unequal_strides
from plantar.gait.analysis.masks import SEVEN_MASKS, Masks
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.prints.platform import PlatformPrint
from plantar.gait.analysis.prints.platform_walk import PAUSE
from plantar.gait.analysis.steps.baseline import resting_level
from plantar.gait.analysis.steps.cop_path import averaged_path
from plantar.gait.analysis.steps.events import (
    EVENT_LEVELS,
    Contact,
    Levels,
    find_contacts,
    force_levels,
    run_together,
    threshold_levels,
)
from plantar.gait.analysis.steps.foot_gait import FootGait, Step
from plantar.gait.analysis.steps.inertial_strides import inertial_strides
from plantar.gait.analysis.steps.pressure_measures import pressure_measures, region_measures
from plantar.gait.analysis.steps.segments import most_common, with_activities, without_standing
from plantar.gait.analysis.steps.stated import stated_contacts
from plantar.gait.analysis.steps.steady import in_one_window, with_used_steps
from plantar.gait.analysis.steps.step_footprint import (
    cells_in_polygons,
    footprint_of_step,
    print_of_contact,
    with_picture,
)
from plantar.gait.analysis.steps.step_load import CACHED, StepLoad, StepLoads, cell_threshold, usual_step
from plantar.gait.analysis.steps.step_measures import step_measures
from plantar.gait.analysis.steps.step_times import OtherFoot, longest_strides, stride_times, time_measures
from plantar.gait.analysis.steps.walk_geometry import Place, step_geometry
from plantar.recordings.pressure_recording import PressureRecording

# Time in s over which the centre of pressure is averaged, weighted by force: a path of noise has no length.
COP_WINDOW = 0.05
_Events = Mapping[Side, tuple[Levels | None, list[Contact]]]
_LONGEST = 3.0  # Longest contact in s of a person's single steps: patients who walk at 0.2 m/s have 2.5
# Heel strikes that show how far stated ones are, and the distance in s that is reported
_FEWEST = 3
_AWAY = 0.15
_BORNE = 0.5  # Share of its mean force at other times that a foot carries at least in contacts that a file states
# Share of both feet's contacts that is common where they step on and off at once, and time in s from which they stand.
_TOGETHER = 0.8
_STAND = 1.2
_LIGHT = 0.3  # Share of a foot's peak that a foot which drags in swing does not reach
_CARRIED = 0.2  # Share of a foot's peak that shoes and creases do not press in swing
# How many times its usual height the level of heel strikes is from which events move by more than 20 and 35 ms.
_RAISED = 1.4
_UNLOADED = 0.05  # Share of one foot's peak below which the other foot's sensor carries no foot
BACKWARDS = -0.02  # Median travel of the CoP in m over a step under which it looks as if the sensor were turned round


def analyse_feet(
    recording: PressureRecording, prints: Sequence[PlatformPrint] = (), options: AnalysisOptions | None = None
) -> dict[Side, FootGait]:
    """Returns gait of each foot, with lengths that need both.

    Args:
        recording: Platforms with feet separated.
        prints: Platform footprints.
        options: Steps in the means.

    Raises:
        InputError: No step is of the chosen segment.
    """
    known = options or AnalysisOptions()
    if known.events != "own":
        _check_stated(recording)
    measured = _measured_feet(recording, prints, known.events != "own", known.threshold, known.masks)
    feet = with_activities(_out_of_time(measured))
    names = [step.activity for gait in feet.values() for step in gait.steps if step.activity]
    chosen = known.segment or (most_common(names) if known.steps == "steady" else "")
    if known.segment is not None and known.segment not in names:
        found = ", ".join(dict.fromkeys(names)) or "none"
        raise InputError(f"--segment {known.segment}: no step is {known.segment}; the recording has {found}")
    feet = {side: with_used_steps(gait, known, recording.kind, recording.raw, chosen) for side, gait in feet.items()}
    return in_one_window(feet) if known.steps == "steady" else feet


# Measures that take both feet at one time.
_CROSS = ("step_time_s", "double_support_percent", "single_support_percent", "flight_time_s")


def _out_of_time(feet: dict[Side, FootGait]) -> dict[Side, FootGait]:
    """Feet without measures of both, where strides differ too much for one walk."""
    difference = unequal_strides(feet)
    if difference is None:
        return feet
    note = (
        f"the left foot's strides are {100.0 * abs(difference):.0f} % {'longer' if difference > 0.0 else 'shorter'} "
        "than the right one's: two clocks, or two people in one file; double support and flight are not given"
    )
    out: dict[Side, FootGait] = {}
    for side, gait in feet.items():
        steps = tuple(replace(s, measures={k: v for k, v in s.measures.items() if k not in _CROSS}) for s in gait.steps)
        out[side] = replace(gait, steps=steps, warnings=(*gait.warnings, note))
    return out


def _check_stated(recording: PressureRecording) -> None:
    """Refuse stated events of one foot, another time base, or in swing."""
    begin = float(recording.time[0])
    end = float(recording.time[-1])
    if without := " and ".join(side for side in recording.feet if side not in recording.events):
        raise InputError(
            f"{recording.path.name} states no events of {without}; --events allows own, or a file of those of each foot"
        )
    for side in recording.feet:
        events = recording.events[side]
        stated = np.concatenate([events.heel_strikes, events.toe_offs])
        if len(stated) and not ((stated >= begin) & (stated <= end)).any():
            raise InputError(
                f"events of the {side} foot are stated from {stated.min():g} to {stated.max():g} s, the recording goes "
                f"from {begin:g} to {end:g} s; allowed: times in s by the recording's clock"
            )
        force = recording.feet[side].vertical_force
        time = recording.time
        on = np.zeros(len(time), dtype=bool)
        for contact in stated_contacts(time, events):
            on[contact.begin : contact.end] |= contact.complete
        off = ~on & (time >= stated.min(initial=np.inf)) & (time <= stated.max(initial=-np.inf))
        borne, other = (float(np.nan_to_num(force[part]).sum() / max(1, part.sum())) for part in (on, off))
        if on.any() and not borne > _BORNE * other:
            raise InputError(
                f"the {side} foot carries {borne:.3g} on average between its stated heel strikes and toe offs and "
                f"{other:.3g} else: are these two, or the feet, exchanged? Allowed: events of its contacts"
            )


def _measured_feet(
    recording: PressureRecording,
    prints: Sequence[PlatformPrint],
    stated: bool,
    threshold: float | None,
    masks: Masks,
) -> dict[Side, FootGait]:
    found = {side: _events_of(recording, side, stated, threshold) for side in recording.feet}
    brushes = {side: own for side in found if not stated and (own := _brushes(recording, side, found))}
    found = {s: (levels, [c for c in own if c not in brushes.get(s, ())]) for s, (levels, own) in found.items()}
    events = _by_passes(recording, prints, found)
    feet = {side: analyse_foot(recording, side, prints, stated, events, masks) for side in recording.feet}
    for side, own in brushes.items():
        note = (
            f"the {side} foot touches the ground lightly {len(own)} time(s) while the other one stands, first at "
            f"{recording.time[own[0].begin]:.1f} s: it drags, and these are no steps"
        )
        feet[side] = replace(feet[side], warnings=(*feet[side].warnings, note))
    if stated:
        feet = {side: replace(g, warnings=(*g.warnings, *_away(recording, g))) for side, g in feet.items()}
    placed = {side: [c for c in gait.contacts if c.complete or c.cut] for side, gait in feet.items()}
    places = {side: [_place(recording, gait, c, prints) for c in placed[side]] for side, gait in feet.items()}
    known = {side: [p for p in own if p is not None] for side, own in places.items()}
    if known != places:  # a step without a place would make a stride longer
        return feet
    rows = {s: zip(placed[s], own, strict=True) for s, own in step_geometry(known).items()}
    return {side: _with_measures(gait, [row for c, row in rows[side] if c.complete]) for side, gait in feet.items()}


def _brushes(recording: PressureRecording, side: Side, events: _Events) -> list[Contact]:
    # No step begins and ends while the other foot stands.
    levels, own = events[side]
    _, others = events.get(other_side(side), (None, []))
    if levels is None or recording.kind == "robot":
        return []
    force = recording.feet[side].vertical_force
    most = levels.rest + _LIGHT * (levels.peak - levels.rest)
    light = [c for c in own if np.nanmax(force[c.begin : c.end]) < most]
    return [c for c in light if any(o.begin < c.begin and c.end < o.end for o in others)]


def _away(recording: PressureRecording, gait: FootGait) -> list[str]:
    """Warning of stated heel strikes far from those in the force: another clock, or toe offs."""
    own = _contacts(recording, gait.foot.side, False, gait.levels)
    strikes = np.array([c.heel_strike for c in own if c.heel_strike is not None])
    if min(len(strikes), len(gait.heel_strikes)) < _FEWEST:
        return []
    away = float(np.median(np.abs(np.subtract.outer(gait.heel_strikes, strikes)).min(axis=1)))
    text = f"stated heel strikes of the {gait.foot.side} foot lie {away:.2g} s from those in its force"
    return [f"{text}: by another clock, or toe offs?"] if away > _AWAY else []


def _with_measures(gait: FootGait, extra: Sequence[Mapping[str, float]]) -> FootGait:
    steps = (replace(step, measures={**step.measures, **more}) for step, more in zip(gait.steps, extra, strict=True))
    return replace(gait, steps=tuple(steps))


def _by_passes(recording: PressureRecording, prints: Sequence[PlatformPrint], events: _Events) -> _Events:
    """Events whose contacts know the pass they belong to, and whether a platform's edge cuts them.

    Passes are parted by times in which no foot is on the ground; robots and single soles have one.
    """
    if recording.kind == "robot" or (recording.kind == "insole" and len(events) < 2):
        return events
    spans = sorted((recording.time[c.begin], recording.time[c.end - 1]) for _, own in events.values() for c in own)
    ends = [-np.inf, *accumulate((end for _, end in spans), max)]
    begins = [begin for (begin, _), last in zip(spans, ends, strict=False) if begin - last > PAUSE]

    def of_pass(contact: Contact, side: Side) -> Contact:
        found = print_of_contact(contact, side, prints)
        number = bisect(begins, recording.time[contact.begin])
        others = [] if other_side(side) not in events else events[other_side(side)][1]
        long = contact.complete and contact.end - contact.begin > _STAND * recording.rate_hz
        stands = contact.standing or (long and any(_together(contact, other) for other in others))
        return replace(contact, walk=number, cut=found is not None and found.cut, standing=stands)

    return {side: (levels, [of_pass(c, side) for c in own]) for side, (levels, own) in events.items()}


def _together(one: Contact, other: Contact) -> bool:
    common = min(one.end, other.end) - max(one.begin, other.begin)
    return common > _TOGETHER * (max(one.end, other.end) - min(one.begin, other.begin))


def analyse_foot(
    recording: PressureRecording,
    side: Side,
    prints: Sequence[PlatformPrint] = (),
    stated: bool = False,
    events: _Events | None = None,
    masks: Masks = SEVEN_MASKS,
) -> FootGait:
    """Returns gait of a side's foot of a recording; measures of both feet use the other's contacts.

    Platform footprints are in prints; events are both feet's levels and contacts, or those stated in the file; masks
    are the regions that are measured.
    """
    events = events or {s: _events_of(recording, s, stated) for s in recording.feet}
    gait = replace(_with_events(recording, side, *events[side]), masks=masks)
    loads = StepLoads(recording, gait.foot, gait.cell_threshold)
    gait = with_picture(recording, gait, loads)
    others = _other_foot(recording, side, events)
    most = longest_strides(gait.contacts)
    longest = iter(most)
    strides = iter(stride_times(gait.contacts, most))
    complete = [c for c in gait.contacts if c.complete]
    lengths = iter(_inertial(recording, gait))
    before = dict(zip(map(id, gait.contacts), [None, *gait.contacts], strict=False))
    steps: list[Step] = []
    robot = recording.kind == "robot" and not recording.raw
    for group, load, print_, region in _loads(recording, gait, loads, complete, prints):
        regions = _regions(
            gait, load, region, print_, [cast(float, c.toe_off) - cast(float, c.heel_strike) for c in group]
        )
        pressures = [{}] * len(group) if load.pressure is None else pressure_measures(load, gait.foot.layout)
        for contact, pressure, own in zip(group, pressures, regions, strict=True):
            times = time_measures(contact, before[id(contact)], next(strides), next(longest), others)
            part = loads.of(contact) if robot else None
            measures = {**times, **step_measures(recording, gait, contact, print_, pressure, part)}
            measures |= _of_stride(next(lengths), times["stride_time_s"])
            strike = cast(float, contact.heel_strike)
            lift = cast(float, contact.toe_off)
            steps.append(Step(side, len(steps) + 1, strike, lift, contact, measures, own, print_, region))
    gait = replace(gait, steps=tuple(steps))
    return replace(gait, warnings=tuple(_doubts(recording, gait)))


def _loads(
    recording: PressureRecording,
    gait: FootGait,
    loads: StepLoads,
    contacts: Sequence[Contact],
    prints: Sequence[PlatformPrint],
) -> Iterator[tuple[list[Contact], StepLoad, Footprint | None, NDArray[np.int64] | None]]:
    """Contacts with their load, footprint and cells' regions; on a platform each alone, for it has its own print."""
    for group in [[c] for c in contacts] if recording.kind == "platform" else loads.blocks(contacts):
        print_, region = footprint_of_step(recording, gait, loads, group[0], prints)
        frame = usual_step(loads.times(group))
        for part in loads.blocks(group, CACHED):
            yield part, loads.of(*part, frame=frame), print_, region


def _inertial(recording: PressureRecording, gait: FootGait) -> list[float]:
    motion = gait.foot.motion
    if motion is None or recording.kind != "insole":
        return [math.nan] * sum(contact.complete for contact in gait.contacts)
    return inertial_strides(recording.time, motion, gait.contacts)


def _of_stride(length: float, time: float) -> dict[str, float]:
    known = math.isfinite(length) and math.isfinite(time)
    return {"stride_length_m": length, "stride_velocity_m_s": length / time} if known else {}


def _events_of(
    recording: PressureRecording, side: Side, stated: bool, threshold: float | None = None
) -> tuple[Levels | None, list[Contact]]:
    levels = _levels(recording, side)
    if threshold is not None and recording.raw:
        raise InputError(f"--threshold {threshold:g} is in N; {recording.path.name} holds raw counts or body weights")
    if threshold is not None and levels is not None:
        levels = threshold_levels(levels, threshold)
    return levels, _contacts(recording, side, stated, levels)


def _with_events(
    recording: PressureRecording, side: Side, levels: Levels | None, contacts: Sequence[Contact]
) -> FootGait:
    foot = recording.feet[side]
    force = foot.vertical_force
    cop = foot.center_of_pressure(levels.release if levels is not None else np.inf)
    if cop is not None:
        cop = averaged_path(cop, np.where(np.isfinite(force), force, 1.0), round(COP_WINDOW * recording.rate_hz))
    return FootGait(foot, levels, tuple(contacts), (), cop, cell_threshold(recording, foot, contacts))


def _other_foot(recording: PressureRecording, side: Side, events: _Events) -> OtherFoot | None:
    other = other_side(side)
    if other not in recording.feet or not recording.metadata.get("sees_every_step", True):
        return None  # plates in a walkway do not see what the other foot does next to them
    own = events[side][0]
    theirs = events[other][0]
    if own is not None and (theirs is None or theirs.peak < _UNLOADED * own.peak):
        return None  # a sensor that is not connected does not show what the foot does
    return OtherFoot.of_recording(recording, other, events[other][1])


def _contacts(recording: PressureRecording, side: Side, stated: bool, levels: Levels | None) -> list[Contact]:
    if stated:
        return stated_contacts(recording.time, recording.events[side])
    if levels is None:
        return []
    force = recording.feet[side].vertical_force
    found = find_contacts(recording.time, force, levels)
    joined = [run_together(force, recording.rate_hz, levels, c) > 1 for c in found]
    most = np.inf if recording.kind == "robot" else _LONGEST
    found = [replace(c, standing=True) if many else c for c, many in zip(found, joined, strict=True)]
    return without_standing(found, most)


def _levels(recording: PressureRecording, side: Side) -> Levels | None:
    """Levels of a foot's force; high least load without a flat sensor level means no lifted foot."""
    force = recording.feet[side].vertical_force
    levels = force_levels(force, recording.kind)
    if levels is None or levels.rest <= _CARRIED * levels.peak or resting_level(force, recording.rate_hz) is not None:
        return levels
    return force_levels(force, recording.kind, lifted=False)


def _regions(
    gait: FootGait,
    load: StepLoad,
    region: NDArray[np.int64] | None,
    print_: Footprint | None,
    lasts: Sequence[float],
) -> list[dict[str, dict[str, float]]]:
    if region is None or load.pressure is None:
        return [{} for _ in lasts]
    names = [name for name, _ in gait.masks.names]
    whole = gait.sole or print_
    if gait.masks.kind != "polygons" or whole is None or gait.foot.layout is None:
        return region_measures(load, region, names, lasts)
    out: list[dict[str, dict[str, float]]] = [{} for _ in lasts]
    for name, inside in zip(names, cells_in_polygons(gait.masks, gait.foot.layout, whole), strict=True):
        for row, own in zip(out, region_measures(load, np.where(inside, 0, -1), [name], lasts), strict=True):
            row.update(own)
    return out


def _place(
    recording: PressureRecording, gait: FootGait, contact: Contact, prints: Sequence[PlatformPrint]
) -> Place | None:
    if contact.cut:
        return Place(float(recording.time[contact.begin]), np.full(2, np.nan), np.full(2, np.nan), walk=contact.walk)
    placement = gait.foot.placement
    if placement is None and recording.kind != "platform":
        return None
    step = next(s for s in gait.steps if s.contact is contact)
    if placement is not None:
        x, y, turn = placement[(contact.begin + contact.end) // 2]
        return Place(step.heel_strike_s, np.array([x, y]), np.array([np.cos(turn), np.sin(turn)]))
    if step.footprint is None:
        return None
    of_step = print_of_contact(contact, step.side, prints)
    forward = None if of_step is None else of_step.forward
    return Place(step.heel_strike_s, step.footprint.origin, step.footprint.axis, forward, contact.walk)


def _doubts(recording: PressureRecording, gait: FootGait) -> list[str]:
    out: list[str] = []
    side = gait.foot.side
    if recording.kind != "insole":
        return out
    if any("stride_length_m" in step.measures for step in gait.steps):
        out.append(
            f"strides of the {side} foot are integrated from its inertial sensor, to about 6 % (docs/metrics.md)"
        )
    if gait.footprint is not None and gait.footprint.toe_line is None:
        out.append(
            f"no valley of pressure parts the {side} foot's toes from its forefoot: its toe regions begin at 82 % "
            "of the "
            "sole's length"
        )
    noisy = _RAISED * EVENT_LEVELS[recording.kind].strike
    if gait.levels is not None and gait.levels.clear is not None and _release_share(gait.levels) > noisy:
        out.append(
            f"the {side} foot's force scatters by {gait.levels.noise:.3g} N in swing: heel strikes are found at "
            f"{100.0 * _release_share(gait.levels):.0f} % of its range and so later than usual, toe offs sooner"
        )
    for contact in gait.contacts if gait.levels is not None else ():
        steps = run_together(gait.foot.vertical_force, recording.rate_hz, cast(Levels, gait.levels), contact)
        if steps > 1:
            begin, end = (float(recording.time[i]) for i in (contact.begin, contact.end - 1))
            out.append(
                f"the {side} foot seems to be on the ground from {begin:.1f} to {end:.1f} s, but lands {steps} times "
                "in that: its sensor's offset joins these steps, which are in no mean that can be trusted"
            )
    travel = _travel_of_steps(gait)
    if len(gait.steps) >= 2 and travel and float(np.median(travel)) < BACKWARDS:
        out.append(
            f"the {side} foot's centre of pressure moves from front to back in most steps: is the sensor or its "
            "layout turned round?"
        )
    return out


def _release_share(levels: Levels) -> float:
    return (levels.release - levels.rest) / (levels.peak - levels.rest)


def _travel_of_steps(gait: FootGait) -> list[float]:
    if gait.cop is None:
        return []
    ahead = [gait.cop[c.begin : c.end, 0] for c in gait.contacts if c.complete]
    return [float(known[-1] - known[0]) for path in ahead if len(known := path[np.isfinite(path)]) >= 4]
