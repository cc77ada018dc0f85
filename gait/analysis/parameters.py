"""Gait parameters: what each step of a foot measures. Definitions: docs/metrics.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from gait.analysis.cop_path import averaged_path, cop_measures, excursion_index, margin_to_outline
from gait.analysis.events import Contact, Levels, find_contacts, force_levels
from gait.analysis.footprint import Footprint, footprint_of_cells
from gait.analysis.force_curve import force_measures, landing_impact
from gait.analysis.platform import PlatformPrint
from gait.analysis.pressure_measures import StepLoad, pressure_measures, region_measures, robot_measures
from gait.analysis.regions import REGIONS, regions_of, with_toe_line
from gait.analysis.walk_geometry import Place, step_geometry
from plantar.layout import Side
from plantar.pressure_recording import FootRecording, PressureRecording

__all__ = ["FootGait", "Step", "analyse_feet", "analyse_foot"]

COP_WINDOW = 0.05
"""Time in s over which the centre of pressure is averaged, weighted by force: a path of noise has no length."""

NOISE_FRAMES = 5000
"""Frames of swing from which a cell's noise is judged: enough for 2 %."""

PAUSE = 1.75
"""A stride longer than so many times the median of its foot holds a pause or a step that was not recorded."""


@dataclass(frozen=True, eq=False)
class Step:
    """One complete contact of one foot.

    Attributes:
        side: "left" or "right".
        number: 1 for the first complete contact of its foot.
        heel_strike_s: Time of heel strike.
        toe_off_s: Time of toe off.
        contact: The contact.
        measures: Measures by their key in `gait.analysis.measures.MEASURES`; what is not in it is not known.
        regions: Measures of each region of the foot.
        footprint: The footprint that lengths, arch index and regions are of; None without geometry.
        region: Index (k,) into `REGIONS` of each cell, -1 for none; None without geometry.
    """

    side: Side
    number: int
    heel_strike_s: float
    toe_off_s: float
    contact: Contact
    measures: Mapping[str, float]
    regions: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    footprint: Footprint | None = None
    region: NDArray[np.int64] | None = None

    def __getitem__(self, key: str) -> float:
        return self.measures.get(key, float("nan"))


@dataclass(frozen=True, eq=False)
class FootGait:
    """One foot's recording with its events and steps.

    Attributes:
        foot: What was measured.
        levels: Force levels of its events, None where the foot carries no load.
        contacts: All contacts, also those cut by the recording.
        steps: The complete ones, measured.
        cop: Centre of pressure (n, 2) of each frame in the sole frame in m, averaged over 50 ms; NaN without load, None
            without geometry.
        cell_threshold: Force in N (k,) above which a cell counts as loaded.
        picture: Maximum pressure picture (k,) in Pa: the mean over the steps of each cell's largest pressure, of a
            platform the largest of all; None without geometry.
        footprint: The footprint of that picture in an insole or sole; None without geometry, and of platforms.
        region: Index (k,) into `REGIONS` of each cell of the picture, -1 for none; None without geometry.
        footprint_measured: Whether the footprint is one of a foot, of which an arch index means something.
        warnings: What was found odd.
    """

    foot: FootRecording
    levels: Levels | None
    contacts: tuple[Contact, ...]
    steps: tuple[Step, ...]
    cop: NDArray[np.float64] | None
    cell_threshold: NDArray[np.float64]
    picture: NDArray[np.float64] | None = None
    footprint: Footprint | None = None
    region: NDArray[np.int64] | None = None
    footprint_measured: bool = False
    warnings: tuple[str, ...] = ()


def analyse_feet(recording: PressureRecording, prints: Sequence[PlatformPrint] = ()) -> dict[Side, FootGait]:
    """Find the contacts of every foot and measure its complete steps.

    Args:
        recording: The recording; that of a platform as `told_apart` gives it.
        prints: The footprints of a platform.

    Returns:
        The gait of each foot, with the lengths that need both.
    """
    feet = {side: analyse_foot(recording, side, prints) for side in recording.feet}
    places = {side: [p for s in gait.steps if (p := _place(recording, gait, s, prints))] for side, gait in feet.items()}
    if not all(len(places[side]) == len(gait.steps) for side, gait in feet.items()):
        return feet
    geometry = step_geometry(places)
    for side, gait in feet.items():
        steps = tuple(
            replace(step, measures={**step.measures, **extra})
            for step, extra in zip(gait.steps, geometry[side], strict=True)
        )
        feet[side] = replace(gait, steps=steps)
    return feet


def analyse_foot(recording: PressureRecording, side: Side, prints: Sequence[PlatformPrint] = ()) -> FootGait:
    """Find the contacts of one foot and measure its complete steps.

    Args:
        recording: The recording.
        side: A foot that it has.
        prints: The footprints of a platform.

    Returns:
        The foot's gait. Measures that need the other foot use its contacts where it was recorded.
    """
    foot = recording.feet[side]
    force = foot.vertical_force
    levels = force_levels(force, recording.kind)
    contacts = find_contacts(recording.time, force, levels) if levels is not None else []
    other: Side = "right" if side == "left" else "left"
    others: _OtherFoot | None = None
    if other in recording.feet:
        across = recording.feet[other].vertical_force
        contacts_across = find_contacts(recording.time, across, force_levels(across, recording.kind))
        others = _OtherFoot(recording, contacts_across)
    cop = foot.center_of_pressure(levels.release if levels is not None else np.inf)
    if cop is not None:
        cop = averaged_path(cop, np.where(np.isfinite(force), force, 1.0), round(COP_WINDOW * recording.rate_hz))
    threshold = _cell_threshold(recording, foot, contacts)
    gait = FootGait(foot, levels, tuple(contacts), (), cop, threshold)
    complete = [i for i, c in enumerate(contacts) if c.complete]
    loads = _StepLoads(recording, gait)
    gait = _with_picture(recording, gait, [loads.highest(contacts[i]) for i in complete])
    strides = _strides(contacts, complete)
    steps: list[Step] = []
    for k, i in enumerate(complete):
        contact = contacts[i]
        print_, region = _footprint(recording, gait, loads, contact, prints)
        time = _time_measures(contacts, i, strides[k], others)
        measures, regions = _measure(recording, gait, loads.of(contact), contact, print_, region)
        strike, lift = cast(float, contact.heel_strike), cast(float, contact.toe_off)
        own = {**time, **measures}
        steps.append(Step(side, k + 1, strike, lift, contact, own, regions, print_, region))
    return replace(gait, steps=tuple(steps), warnings=tuple(_doubts(recording, gait, contacts, complete)))


class _StepLoads:
    """Cuts contacts out of a recording: forces of all cells, gaps interpolated."""

    def __init__(self, recording: PressureRecording, gait: FootGait) -> None:
        self.recording, self.gait = recording, gait

    def of(self, contact: Contact) -> StepLoad:
        """Forces and pressures of one contact."""
        span = slice(contact.begin, contact.end)
        time = self.recording.time[span]
        force = self.gait.foot.force[span]
        if self.gait.foot.missing is not None and self.gait.foot.missing[span].any():
            force = _filled(time, force)
        areas = self.gait.foot.layout.areas if self.gait.foot.layout is not None else None
        pressure = force if self.recording.raw else None if areas is None else force / areas
        return StepLoad(time, force, pressure, force > self.gait.cell_threshold, areas)

    def highest(self, contact: Contact) -> NDArray[np.float64]:
        """Largest force (k,) of each cell in one contact."""
        part = self.gait.foot.force[contact.begin : contact.end]
        return np.asarray(np.where(np.isnan(part), 0.0, part).max(axis=0) if np.isnan(part).any() else part.max(axis=0))


def _filled(time: NDArray[np.float64], force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces with the missing values of each cell interpolated in time; 0 for cells that measured nothing."""
    out = force.copy()
    for cell in np.flatnonzero(np.isnan(force).any(axis=0)):
        known = np.isfinite(force[:, cell])
        out[~known, cell] = np.interp(time[~known], time[known], force[known, cell]) if known.any() else 0.0
    return out


def _with_picture(recording: PressureRecording, gait: FootGait, highest: list[NDArray[np.float64]]) -> FootGait:
    """The maximum pressure picture, its footprint and its regions."""
    layout = gait.foot.layout
    if layout is None:
        return gait
    if not highest:
        highest = [gait.foot.measured.max(axis=0, initial=0.0)]
    top = np.max(highest, axis=0) if recording.kind == "platform" else np.mean(highest, axis=0)
    picture = top if recording.raw else top / layout.areas
    gait = replace(gait, picture=np.asarray(picture))
    if recording.kind == "platform" or not gait.contacts:
        return gait
    print_ = footprint_of_cells(layout, picture, top > gait.cell_threshold, gait.foot.side)
    if print_ is None:
        return gait
    print_ = with_toe_line(print_)
    region = np.full(len(layout), -1)
    of_sole = float(layout.outline[:, 0].max() - print_.origin[0]) if recording.kind == "insole" else None
    region[top > gait.cell_threshold] = regions_of(print_, of_sole)
    return replace(gait, footprint=print_, region=region, footprint_measured=recording.kind == "insole")


def _footprint(
    recording: PressureRecording,
    gait: FootGait,
    loads: _StepLoads,
    contact: Contact,
    prints: Sequence[PlatformPrint],
) -> tuple[Footprint | None, NDArray[np.int64] | None]:
    """Footprint and regions of one step: the foot's own, on a platform this footprint's."""
    layout = gait.foot.layout
    if recording.kind != "platform" or layout is None:
        return gait.footprint, gait.region
    highest = loads.highest(contact)
    of_step = _print_of(contact, gait.foot.side, prints)
    loaded = highest > gait.cell_threshold
    forward = of_step.forward if of_step is not None else np.array([1.0, 0.0])
    pressure = highest if recording.raw else highest / layout.areas
    print_ = footprint_of_cells(layout, pressure, loaded, gait.foot.side, forward)
    if print_ is None:
        return None, None
    print_ = with_toe_line(print_)
    region = np.full(len(layout), -1)
    region[loaded] = regions_of(print_)
    return print_, region


def _print_of(contact: Contact, side: Side, prints: Sequence[PlatformPrint]) -> PlatformPrint | None:
    own = [p for p in prints if p.side == side and p.begin < contact.end and p.end > contact.begin]
    return max(own, key=lambda p: min(p.end, contact.end) - max(p.begin, contact.begin), default=None)


def _place(recording: PressureRecording, gait: FootGait, step: Step, prints: Sequence[PlatformPrint]) -> Place | None:
    """Where a step stands on the ground; None where the recording cannot tell."""
    placement = gait.foot.placement
    if placement is not None:
        middle = (step.contact.begin + step.contact.end) // 2
        x, y, turn = placement[middle]
        return Place(step.heel_strike_s, np.array([x, y]), np.array([np.cos(turn), np.sin(turn)]))
    if recording.kind != "platform" or step.footprint is None:
        return None
    of_step = _print_of(step.contact, step.side, prints)
    forward = None if of_step is None else of_step.forward
    return Place(step.heel_strike_s, step.footprint.origin, step.footprint.axis, forward)


def _cell_threshold(
    recording: PressureRecording, foot: FootRecording, contacts: Sequence[Contact]
) -> NDArray[np.float64]:
    """A cell counts as loaded above its layout's threshold, and above 3 standard deviations of its noise in swing."""
    n, k = foot.force.shape
    base = 1e-3 if foot.layout is None else 0.0 if recording.raw else foot.layout.force_threshold
    air = np.ones(n, dtype=bool)
    for contact in contacts:
        air[contact.begin : contact.end] = False
    pairs = np.flatnonzero(air[:-1] & air[1:])[:NOISE_FRAMES]
    steps = np.abs(foot.force[pairs + 1] - foot.force[pairs])
    steps = steps[np.isfinite(steps).all(axis=1)]
    if len(steps) < 20:
        return np.full(k, base)
    noise = np.median(steps, axis=0) / (0.6745 * np.sqrt(2.0))
    return np.asarray(np.maximum(base, 3.0 * noise))


def _strides(contacts: Sequence[Contact], complete: Sequence[int]) -> list[float]:
    """Stride time of each complete contact; NaN where the next heel strike is not the next step's.

    Strides lead from one complete contact to another: a contact that the recording cuts may be standing. Where a foot
    has no such stride, those to a cut contact are taken.
    """

    def strides(whole: bool) -> list[float]:
        out: list[float] = []
        for i in complete:
            after = contacts[i + 1] if i + 1 < len(contacts) else None
            counts = after is not None and after.heel_strike is not None and (after.complete or not whole)
            out.append(cast(float, after.heel_strike) - cast(float, contacts[i].heel_strike) if counts else np.nan)  # type: ignore[union-attr]
        return out

    raw = strides(whole=True)
    if not np.isfinite(raw).any():
        raw = strides(whole=False)
    known = [s for s in raw if np.isfinite(s)]
    limit = PAUSE * float(np.median(known)) if len(known) >= 3 else np.inf
    return [s if s <= limit else np.nan for s in raw]


def _time_measures(
    contacts: Sequence[Contact], index: int, stride: float, others: _OtherFoot | None
) -> dict[str, float]:
    contact = contacts[index]
    strike, lift = cast(float, contact.heel_strike), cast(float, contact.toe_off)
    previous = contacts[index - 1].heel_strike if index > 0 else None
    duration = lift - strike
    share = 100.0 * duration / stride
    out = {
        "contact_time_s": duration,
        "stride_time_s": stride,
        "swing_time_s": stride - duration,
        "stance_percent": share,
        "swing_percent": 100.0 - share,
    }
    if others is not None:
        between = others.strikes_between(strike if previous is None else previous, strike)
        if len(between) == 1:
            out["step_time_s"] = strike - float(between[0])
        both = 100.0 * others.overlap(strike, lift) / stride
        out["double_support_percent"] = both
        out["single_support_percent"] = share - both
    return out


class _OtherFoot:
    """The contacts of the other foot, as arrays that are searched quickly."""

    def __init__(self, recording: PressureRecording, contacts: Sequence[Contact]) -> None:
        time = recording.time
        self.strikes = np.array([c.heel_strike for c in contacts if c.heel_strike is not None])
        begin = [float(time[c.begin]) if c.heel_strike is None else c.heel_strike for c in contacts]
        end = [float(time[c.end - 1]) if c.toe_off is None else c.toe_off for c in contacts]
        self._begin, self._end = np.array(begin), np.array(end)

    def strikes_between(self, begin: float, end: float) -> NDArray[np.float64]:
        """Heel strikes after one time and before another."""
        first, last = np.searchsorted(self.strikes, begin, "right"), np.searchsorted(self.strikes, end, "left")
        return self.strikes[first:last]

    def overlap(self, strike: float, lift: float) -> float:
        """Time in s of one contact in which the other foot is on the ground too."""
        first, last = np.searchsorted(self._end, strike, "right"), np.searchsorted(self._begin, lift, "left")
        begin, end = self._begin[first:last], self._end[first:last]
        return float((np.minimum(end, lift) - np.maximum(begin, strike)).clip(0.0).sum())


def _measure(
    recording: PressureRecording,
    gait: FootGait,
    load: StepLoad,
    contact: Contact,
    print_: Footprint | None,
    region: NDArray[np.int64] | None,
) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    """Everything of one step that does not need other steps, and of its regions."""
    foot, layout = gait.foot, gait.foot.layout
    strike, lift = cast(float, contact.heel_strike), cast(float, contact.toe_off)
    span = slice(contact.begin, contact.end)
    force = foot.vertical_force[span]
    known = np.isfinite(force)
    out = force_measures(load.time[known], force[known], strike, lift)
    out["landing_impact_N"] = landing_impact(recording.time, foot.vertical_force, strike)
    regions: dict[str, dict[str, float]] = {}
    if load.pressure is not None:
        out |= pressure_measures(load, layout)
        if region is not None:
            regions = region_measures(load, region, list(REGIONS), lift - strike)
    if gait.cop is not None:
        points = gait.cop[span]
        if print_ is not None and recording.kind == "platform":
            out |= cop_measures(load.time, print_.in_foot(points))
        else:
            out |= cop_measures(load.time, points)
        inside = points[np.isfinite(points[:, 0])]
        if layout is not None and recording.kind in ("insole", "robot") and len(inside):
            out["cop_margin_m"] = margin_to_outline(layout, inside)
        if print_ is not None and recording.kind != "robot":
            out["cpei_percent"] = excursion_index(print_, points)
        if recording.kind == "robot" and layout is not None and not recording.raw:
            out |= robot_measures(load, layout, points)
    if foot.wrench is not None:
        fx, fy, _, tx, ty, tz = np.abs(foot.wrench[span]).max(axis=0)
        out |= {"fx_peak_N": fx, "fy_peak_N": fy, "tz_peak_Nm": tz} | (
            {"tx_peak_Nm": tx, "ty_peak_Nm": ty} if recording.kind == "robot" else {}
        )
    if print_ is not None and recording.kind == "platform":
        out |= {"arch_index": print_.arch_index(), "foot_length_m": print_.length, "foot_width_m": print_.width}
    return {key: float(value) for key, value in out.items()}, regions


def _doubts(
    recording: PressureRecording, gait: FootGait, contacts: Sequence[Contact], complete: Sequence[int]
) -> list[str]:
    """What looks odd about a foot's steps."""
    out: list[str] = []
    side = gait.foot.side
    if gait.footprint is not None and gait.footprint.toe_line is None and recording.kind == "insole":
        out.append(
            f"no valley of pressure tells the {side} foot's toes from its forefoot: its arch index is that of the "
            "whole print, and its toe regions begin at 82 % of the sole's length"
        )
    if gait.cop is not None and recording.kind == "insole" and len(complete) >= 2:
        travel = []
        for i in complete:
            path = gait.cop[contacts[i].begin : contacts[i].end, 0]
            path = path[np.isfinite(path)]
            if len(path) >= 4:
                travel.append(float(path[-1] - path[0]))
        if travel and float(np.median(travel)) < -0.02:
            out.append(
                f"the {side} foot's centre of pressure moves from front to back in most steps: is the sensor or its "
                "layout turned round?"
            )
    return out
