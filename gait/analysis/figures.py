"""Figures of an analysis: pressure map with CoP path, force over time with events, force curves of all steps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gait.analysis.parameters import FootGait
from plantar.layout import Side
from plantar.plotting import COLOURS, draw_cells, new_figure, thinned
from plantar.pressure_recording import PressureRecording

__all__ = ["figure_force", "figure_pressure", "figure_steps", "maximum_pressure"]

MOST_PATHS = 60
"""CoP paths drawn a foot; of more steps every n-th."""


def maximum_pressure(gait: FootGait) -> NDArray[np.float64] | None:
    """Maximum pressure picture (k,) in Pa: the mean over the complete steps of each cell's largest pressure.

    Of a foot without a complete step the largest pressure in the whole recording; None without geometry.
    """
    if gait.foot.layout is None:
        return None
    spans = [slice(c.begin, c.end) for c in gait.contacts if c.complete] or [slice(0, len(gait.foot.force))]
    highest = [np.where(np.isnan(f := gait.foot.force[span]), 0.0, f).max(axis=0) for span in spans]
    return np.asarray(np.mean(highest, axis=0) / gait.foot.layout.areas)


def figure_pressure(feet: Mapping[Side, FootGait]) -> Any | None:
    """Maximum pressure picture of each foot with the CoP paths of its complete steps; None without geometry."""
    maps = {side: maximum_pressure(gait) for side, gait in feet.items()}
    shown = {side: values for side, values in maps.items() if values is not None}
    if not shown:
        return None
    extents = [np.ptp(layout.outline, axis=0) for side in shown if (layout := feet[side].foot.layout) is not None]
    slender = max(float(length / width) for length, width in extents)
    height = min(6.4, 1.8 + 2.5 * slender)
    figure, axes = new_figure(3.2 * len(shown) + 1.6, height, columns=len(shown), squeeze=False)
    highest = max(float(values.max()) for values in shown.values()) / 1e3
    drawn = None
    for panel, (side, values) in zip(axes[0], shown.items(), strict=True):
        gait = feet[side]
        assert gait.foot.layout is not None
        drawn = draw_cells(panel, gait.foot.layout, values / 1e3, highest)
        complete = [contact for contact in gait.contacts if contact.complete]
        every = -(-len(complete) // MOST_PATHS) if complete else 1
        label: str | None = "CoP path of a step" + (f" (every {every}th)" if every > 1 else "")
        for contact in complete[::every]:
            if gait.cop is not None:
                path = gait.cop[contact.begin : contact.end]
                panel.plot(-path[:, 1], path[:, 0], color="#ffffff", linewidth=2.2, alpha=0.9)
                panel.plot(-path[:, 1], path[:, 0], color=COLOURS["cop"], linewidth=1.0, label=label)
                label = None
        panel.set_title(f"{side} foot, {len(gait.steps)} steps")
        panel.set_xlabel("to the right (m)")
        if label is None:
            low, high = panel.get_ylim()
            panel.set_ylim(low - 0.08 * (high - low), high)  # room for the legend below the heel
            panel.legend(loc="lower center", fontsize=8, framealpha=0.9)
    axes[0][0].set_ylabel("forward (m)")
    figure.colorbar(drawn, ax=list(axes[0]), label="maximum pressure, mean of the steps (kPa)", shrink=0.8)
    return figure


def figure_force(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any:
    """Vertical force of each foot over time, with heel strikes and toe offs.

    Args:
        recording: The recording.
        feet: The gait of its feet.

    Returns:
        The figure.
    """
    figure, axes = new_figure(10.0, 2.6 * len(feet) + 0.6, rows=len(feet), sharex=True, sharey=True, squeeze=False)
    for panel, (side, gait) in zip(axes[:, 0], feet.items(), strict=True):
        force = gait.foot.vertical_force
        panel.plot(*thinned(recording.time, force), color=COLOURS[side], linewidth=1.0, label=f"{side} foot")
        if gait.levels is not None:
            level = gait.levels.release
            panel.axhline(level, color=COLOURS["reference"], linewidth=0.8, linestyle="--", label="event level")
            strikes = [c.heel_strike for c in gait.contacts if c.heel_strike is not None]
            lifts = [c.toe_off for c in gait.contacts if c.toe_off is not None]
            for times, mark, name in ((strikes, "v", "heel strike"), (lifts, "^", "toe off")):
                if times:
                    panel.plot(times, [level] * len(times), mark, color="#111111", markersize=5, label=name)
        for contact in gait.contacts:
            if not contact.complete:
                begin, end = recording.time[contact.begin], recording.time[contact.end - 1]
                panel.axvspan(begin, end, color=COLOURS["cell"], zorder=0)
        panel.set_ylabel("vertical force (N)")
        panel.legend(loc="upper right", fontsize=8, ncols=4, framealpha=0.9)
        panel.grid(alpha=0.3)
        panel.margins(x=0.01)
    low, high = axes[0, 0].get_ylim()
    axes[0, 0].set_ylim(low, high + 0.22 * (high - low))  # room for the legend
    axes[-1, 0].set_xlabel("time (s); grey: contacts that the recording cuts, left out of the statistics")
    return figure


def figure_steps(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Force curves of the complete steps over the stance, with their mean and standard deviation.

    Args:
        recording: The recording.
        feet: The gait of its feet.

    Returns:
        The figure, or None where no foot has a complete step.
    """
    shown = {side: gait for side, gait in feet.items() if gait.steps}
    if not shown:
        return None
    figure, axes = new_figure(10.0, 3.6, columns=len(shown), sharey=True, squeeze=False)
    share = np.linspace(0.0, 1.0, 101)
    for panel, (side, gait) in zip(axes[0], shown.items(), strict=True):
        known = np.isfinite(gait.foot.vertical_force)
        curves = np.array(
            [
                np.interp(
                    step.heel_strike_s + share * step.contact_time_s,
                    recording.time[known],
                    gait.foot.vertical_force[known],
                )
                for step in gait.steps
            ]
        )
        colour = COLOURS[side]
        for i, curve in enumerate(curves[:: -(-len(curves) // 100)]):
            panel.plot(100 * share, curve, color=colour, linewidth=0.6, alpha=0.4, label=None if i else "one step")
        mean = curves.mean(axis=0)
        panel.plot(100 * share, mean, color="#111111", linewidth=1.6, label=f"mean of {len(curves)}")
        if len(curves) > 1:
            sd = curves.std(axis=0, ddof=1)
            panel.fill_between(100 * share, mean - sd, mean + sd, color=colour, alpha=0.25, label="± 1 SD", linewidth=0)
        panel.set_title(f"{side} foot")
        panel.set_xlabel("stance (%)")
        panel.legend(fontsize=8, loc="lower center")
        panel.grid(alpha=0.3)
    axes[0][0].set_ylabel("vertical force (N)")
    return figure
