"""Measures of one step alone: force curve, pressure, CoP, wrench, footprint."""

from collections.abc import Mapping
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.steps.cop_path import cop_measures, excursion_index, margin_to_outline
from plantar.gait.analysis.steps.events import LONGEST_BRIDGE, Contact
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.steps.pressure_measures import robot_measures
from plantar.gait.analysis.steps.step_load import StepLoad
from plantar.recordings.pressure_recording import PressureRecording


def step_measures(
    recording: PressureRecording,
    gait: FootGait,
    contact: Contact,
    print_: Footprint | None,
    pressures: Mapping[str, float],
    load: StepLoad | None = None,
) -> dict[str, float]:
    """Returns one step's known measures by key that need no other steps.

    `print_` of lengths and regions; None without geometry.
    """
    foot = gait.foot
    span = slice(contact.begin, contact.end)
    force = foot.vertical_force[span]
    time = recording.time[span]
    known = np.isfinite(force)
    strike = cast(float, contact.heel_strike)
    out = force_measures(time[known], force[known], strike, cast(float, contact.toe_off)) | dict(pressures)
    out["landing_impact_N"] = landing_impact(recording.time, foot.vertical_force, strike)
    if out.get("footprint_area_m2", 0.0) > 0.0:
        out["force_time_integral_area_Pas"] = out["impulse_Ns"] / out["footprint_area_m2"]
    if gait.cop is not None:
        out |= _cop_measures(recording, gait, time, gait.cop[span], print_)
    if load is not None and foot.layout is not None and gait.cop is not None:
        out |= robot_measures(load, foot.layout)
    if foot.wrench is not None:
        out |= _wrench_measures(recording, foot.wrench[span])
    if print_ is not None and recording.kind == "platform":
        out |= {"arch_index": print_.arch_index(), "foot_length_m": print_.length, "foot_width_m": print_.width}
    return {key: float(value) for key, value in out.items()}


def _cop_measures(
    recording: PressureRecording,
    gait: FootGait,
    time: NDArray[np.float64],
    cop: NDArray[np.float64],
    print_: Footprint | None,
) -> dict[str, float]:
    kind = recording.kind
    layout = gait.foot.layout
    # On a platform the foot's own axis is forward, in a sole the sole's, on a plate the way of the CoP.
    seen = _along_its_way(cop) if kind == "plate" else cop
    out = cop_measures(time, print_.in_foot(cop) if print_ is not None and kind == "platform" else seen)
    across = gait.sole if kind == "insole" else print_
    if across is not None and kind != "robot":
        out["cpei_percent"] = excursion_index(across, cop)
    if layout is not None:
        inside = cop[np.isfinite(cop[:, 0])]
        if kind in ("insole", "robot") and len(inside):
            out["cop_margin_m"] = margin_to_outline(layout, inside)
    return out


def _along_its_way(cop: NDArray[np.float64]) -> NDArray[np.float64]:
    known = cop[np.isfinite(cop[:, 0])]
    few = max(1, len(known) // 8)
    way = known[-few:].mean(axis=0) - known[:few].mean(axis=0) if len(known) else np.zeros(2)
    x, y = way / np.hypot(*way) if way.any() else (1.0, 0.0)
    return np.asarray(cop @ np.array([[x, -y], [y, x]]))


def _wrench_measures(recording: PressureRecording, wrench: NDArray[np.float64]) -> dict[str, float]:
    """Largest magnitudes of a wrench (m, 6); of a force plate, whose origin is elsewhere, without tx and ty."""
    wrench = wrench[np.isfinite(wrench).all(axis=1)]
    if not len(wrench):
        return {}
    fx, fy, _, tx, ty, tz = np.abs(wrench).max(axis=0)
    out = {"fx_peak_N": fx, "fy_peak_N": fy, "tz_peak_Nm": tz}
    return out | ({"tx_peak_Nm": tx, "ty_peak_Nm": ty} if recording.kind == "robot" else {})


IMPACT_WINDOW = 0.05  # Time in s after touchdown in which the landing impact is looked for
_DEPTH = 0.02  # How deep a valley has to be, as a share of the lower peak, to separate two peaks
# Share of the largest force of its half of the stance that a peak has; the transient of a heel strike has less.
_HUMP = 0.75
_ALIKE = 0.95  # A hump lower than this share of another one of its half is a shoulder of the loading
_UNKNOWN = {
    f"{name}_{unit}": float("nan") for name in ("first_peak", "valley", "second_peak") for unit in ("N", "percent")
}
_UNKNOWN |= {"loading_rate_N_s": float("nan"), "loading_rate_max_N_s": float("nan")}


def force_measures(
    time: NDArray[np.float64], force: NDArray[np.float64], strike: float, lift: float
) -> dict[str, float]:
    """Returns force curve measures of one contact by key; NaN for peaks and valley without two peaks.

    The impulse runs from strike to lift; pieces beyond the end frames count as triangles.

    `time`: measured frames' times (m,) in contact in s, 2 or more; `force`: vertical (m,) in N; `strike`: heel strike
    in s; `lift`: toe off in s.

    Example:
        >>> t = np.linspace(0.0, 1.0, 201)
        >>> two_humps = 800.0 * np.sin(np.pi * t) + 200.0 * np.sin(3.0 * np.pi * t)
        >>> m = force_measures(t, two_humps, 0.0, 1.0)
        >>> round(m["first_peak_percent"]), round(m["valley_N"]), round(m["impulse_Ns"], 1)
        (28, 600, 551.7)
    """
    duration = lift - strike
    impulse = float(((time[1:] - time[:-1]) * (force[1:] + force[:-1]) / 2.0).sum())
    impulse += 0.5 * max(0.0, float(time[0]) - strike) * float(force[0])
    impulse += 0.5 * max(0.0, lift - float(time[-1])) * float(force[-1])
    top = int(np.argmax(force))
    out = {
        **_UNKNOWN,
        "peak_force_N": float(force[top]),
        "mean_force_N": impulse / duration if duration > 0.0 else np.nan,
        "impulse_Ns": impulse,
    }
    share = (time - strike) / duration
    early = int(np.count_nonzero(share <= 0.5))
    late = int(np.count_nonzero(share > 0.5))
    rise = top
    if early >= 3 and late >= 3:
        first = _first_hump(force, early, _HUMP * float(force[:early].max()))
        second = len(force) - 1 - _first_hump(force[::-1], late, _HUMP * float(force[early:].max()))
        low = first + int(np.argmin(force[first : second + 1])) if first < second else first
        if share[first] <= 0.5 < share[second] and first < low < second:
            rise = first
            for name, at in (("first_peak", first), ("valley", low), ("second_peak", second)):
                out[f"{name}_N"] = float(force[at])
                out[f"{name}_percent"] = 100.0 * float(share[at])
    out |= _loading(time[: rise + 1], force[: rise + 1], strike)
    return out


def _first_hump(force: NDArray[np.float64], half: int, least: float) -> int:
    """Index of the first hump of at least `least` that is not much lower than another before frame `half`."""
    width = max(1, 2 * (len(force) // 60) + 1)  # 3 % of the stance: noise makes no hump
    margin = width // 2
    even: list[float] = (_evened(force, margin) if margin else force).tolist()
    humps: list[int] = []
    top = 0
    highest = even[0]
    valley = highest * (1.0 - _DEPTH if highest > 0.0 else 1.0 + _DEPTH)  # below zero: an offset
    for i, value in enumerate(even):
        if valley <= value <= highest:
            continue
        if value < valley and highest >= least:
            humps.append(top)
        top = i
        highest = value
        valley = value * (1.0 - _DEPTH if value > 0.0 else 1.0 + _DEPTH)
    if not humps:
        return int(np.argmax(force))
    highest = max(even[k] for k in humps if k < half or k == humps[0])
    chosen = next(k for k in humps if even[k] >= _ALIKE * highest)
    begin = max(0, chosen - width)
    return begin + int(np.argmax(force[begin : chosen + width + 1]))


def _evened(force: NDArray[np.float64], margin: int) -> NDArray[np.float64]:
    """Mean force (m,) over as many frames before and after each; the ends go on as they are."""
    padded = np.empty(len(force) + 2 * margin)
    padded[:margin] = force[0]
    padded[margin : margin + len(force)] = force
    padded[margin + len(force) :] = force[-1]
    width = 2 * margin + 1
    return np.convolve(padded, np.full(width, 1.0 / width), mode="valid")


def _loading(time: NDArray[np.float64], force: NDArray[np.float64], strike: float) -> dict[str, float]:
    """Loading rates to the first peak: mean slope between 20 and 80 % of the rise's time, and largest."""
    if len(time) < 3 or time[-1] <= strike:
        return {}
    begin = strike + 0.2 * (time[-1] - strike)
    end = strike + 0.8 * (time[-1] - strike)
    low, high = np.interp([begin, end], time, force)
    return {
        "loading_rate_N_s": float((high - low) / (end - begin)),
        "loading_rate_max_N_s": float((np.diff(force) / np.diff(time)).max()),
    }


def landing_impact(time: NDArray[np.float64], force: NDArray[np.float64], strike: float) -> float:
    """Returns largest vertical force (n,) in N within 50 ms of a strike in s, at time (n,) in s; NaN if unknown."""
    end = strike + IMPACT_WINDOW
    after = int(np.searchsorted(time, end, side="right"))
    window = force[np.searchsorted(time, strike) : after]
    if 0 < after < len(time) and time[after] - time[after - 1] <= LONGEST_BRIDGE:
        window = np.append(window, np.interp(end, time[after - 1 : after + 1], force[after - 1 : after + 1]))
    window = window[np.isfinite(window)]
    return float(window.max()) if len(window) else float("nan")
