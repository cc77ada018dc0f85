"""Figures of forces, wrenches and symmetry."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.measures import MEASURES
from plantar.gait.analysis.steps.events import Levels
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.plotting import COLOURS, new_figure, thinned
from plantar.recordings.pressure_recording import PressureRecording

STANCE = np.linspace(0.0, 100.0, 101)
"""Percent of stance at which force curves are given."""

MOST_CURVES = 40  # Curves drawn a foot; of more steps every n-th
# Measures whose symmetry is drawn.
_COMPARED = (
    "contact_time_s",
    "swing_time_s",
    "step_time_s",
    "peak_force_N",
    "first_peak_N",
    "second_peak_N",
    "loading_rate_N_s",
    "impulse_Ns",
    "peak_pressure_Pa",
    "pressure_time_integral_Pas",
    "contact_area_m2",
    "cop_path_m",
    "arch_index",
    "step_length_m",
)


def figure_force(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any:
    """Returns figure of vertical force and events of a recording's feet over time."""
    shared: dict[str, bool] = {"sharex": True, "sharey": True, "squeeze": False}
    figure, axes = new_figure(10.0, 2.6 * len(feet) + 0.6, rows=len(feet), grid=True, **shared)
    for panel, (side, gait) in zip(axes[:, 0], feet.items(), strict=True):
        force = gait.foot.vertical_force
        panel.plot(*thinned(recording.time, force), color=COLOURS[side], linewidth=1.0, label=f"{side} foot")
        if gait.levels is not None:
            _draw_events(panel, gait, gait.levels)
        _shade_cut_contacts(panel, recording, gait)
        panel.set_ylabel(force_label(recording))
        panel.legend(loc="upper right", fontsize=8, ncols=4, framealpha=0.9)
        panel.margins(x=0.01)
    low, high = axes[0, 0].get_ylim()
    axes[0, 0].set_ylim(low, high + 0.22 * (high - low))  # room for the legend
    axes[-1, 0].set_xlabel("time (s); grey: contacts that the recording cuts, left out of the statistics")
    return figure


def _draw_events(panel: Any, gait: FootGait, levels: Levels) -> None:
    for level in sorted({levels.release, levels.lift}):
        name = "event level" if level == levels.release else None
        panel.axhline(level, color=COLOURS["reference"], linewidth=0.8, linestyle="--", label=name)
    events = ((gait.heel_strikes, levels.release, "v", "heel strike"), (gait.toe_offs, levels.lift, "^", "toe off"))
    for times, level, mark, name in events:
        if times:
            panel.plot(times, [level] * len(times), mark, color="#111111", markersize=5, label=name)


def _shade_cut_contacts(panel: Any, recording: PressureRecording, gait: FootGait) -> None:
    for contact in gait.contacts:
        if not contact.complete:
            begin = recording.time[contact.begin]
            end = recording.time[contact.end - 1]
            panel.axvspan(begin, end, color=COLOURS["cell"], zorder=0)


def figure_steps(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Returns figure of a recording's forces of its feet over the stance, mean and SD; None without used steps."""
    shown = {side: gait for side, gait in feet.items() if gait.used}
    if not shown:
        return None
    figure, axes = new_figure(10.0, 3.6, columns=len(shown), grid=True, sharey=True, squeeze=False)
    for panel, (side, gait) in zip(axes[0], shown.items(), strict=True):
        curves = stance_curves(recording, gait)
        for i, curve in enumerate(curves[:: -(-len(curves) // MOST_CURVES)]):
            panel.plot(STANCE, curve, color=COLOURS[side], linewidth=0.6, alpha=0.4, label=None if i else "one step")
        panel.plot(STANCE, curves.mean(axis=0), color="#111111", linewidth=1.6, label=f"mean of {len(curves)}")
        draw_sd(panel, curves, color=COLOURS[side], alpha=0.25, label="± 1 SD")
        panel.set(title=f"{side} foot", xlabel="stance (%)")
        panel.legend(fontsize=8, loc="lower center")
    axes[0][0].set_ylabel(force_label(recording))
    return figure


def draw_sd(panel: Any, curves: NDArray[np.float64], **look: Any) -> None:
    """Draw one standard deviation around the mean of curves (steps, 101) over the stance in a panel, with a look."""
    if len(curves) > 1:
        mean = curves.mean(axis=0)
        sd = curves.std(axis=0, ddof=1)
        panel.fill_between(STANCE, mean - sd, mean + sd, linewidth=0, **look)


def stance_curves(recording: PressureRecording, gait: FootGait) -> NDArray[np.float64]:
    """Returns forces (steps, 101) in N of a recording over the stance of used steps of a gait."""
    known = np.isfinite(gait.foot.vertical_force)
    time = recording.time[known]
    force = gait.foot.vertical_force[known]
    moments = [s.heel_strike_s + 0.01 * STANCE * (s.toe_off_s - s.heel_strike_s) for s in gait.used]
    return np.array([np.interp(m, time, force) for m in moments]).reshape(-1, len(STANCE))


def figure_wrench(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Returns figure of each robot sole's wrench about its frame in a recording; None of other feet."""
    if recording.kind != "robot" or recording.raw:
        return None
    feet_of_cells = ((side, gait.foot, gait.foot.layout) for side, gait in feet.items())
    wrenches = {
        s: np.where(np.isnan(foot.vertical_force)[:, None], np.nan, foot.measured @ layout.wrench_map.T)
        for s, foot, layout in feet_of_cells
        if layout is not None
    }
    if not wrenches:
        return None
    figure, axes = new_figure(10.0, 5.6, rows=3, grid=True, sharex=True)
    for side, wrench in wrenches.items():
        for panel, index in zip(axes, (2, 3, 4), strict=True):
            panel.plot(
                *thinned(recording.time, wrench[:, index]), color=COLOURS[side], linewidth=0.9, label=f"{side} foot"
            )
    for panel, name in zip(axes, ("fz (N)", "tx (N·m)", "ty (N·m)"), strict=True):
        panel.set_ylabel(name)
        panel.margins(x=0.01)
    axes[0].legend(loc="upper right", fontsize=8, ncols=2, framealpha=0.9)
    axes[-1].set_xlabel("time (s); wrench of the ground on the sole about the sole frame's origin")
    return figure


def figure_symmetry(symmetry: Mapping[str, float | None]) -> Any | None:
    """Symmetry indices in percent by measure; None for fewer than two."""
    rows = [(MEASURES[k].title, value) for k in _COMPARED if (value := symmetry.get(k)) is not None]
    if len(rows) < 2:
        return None
    figure, axes = new_figure(8.0, 0.9 + 0.32 * len(rows))
    names, values = zip(*rows, strict=True)
    places = np.arange(len(rows))[::-1]
    colours = [COLOURS["left"] if v >= 0.0 else COLOURS["right"] for v in values]
    axes.axvspan(-10.0, 10.0, color=COLOURS["cell"], zorder=0)
    axes.barh(places, values, color=colours)
    axes.axvline(0.0, color="#111111", linewidth=0.8)
    axes.set_yticks(places, names)
    reach = max(20.0, 1.15 * float(np.abs(values).max()))
    axes.set(xlim=(-reach, reach), xlabel="symmetry index (%): above 0 larger on the left; grey: within 10 %")
    return figure


def force_label(recording: PressureRecording) -> str:
    """Axis label of vertical force, with unit."""
    return f"vertical force ({'counts' if recording.raw else 'N'})"
