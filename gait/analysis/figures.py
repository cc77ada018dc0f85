"""Figures of an analysis: pressure map with CoP path, regions, force over time and over stance, symmetry, wrench."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gait.analysis.measures import MEASURES
from gait.analysis.parameters import FootGait
from gait.analysis.regions import REGIONS
from plantar.formats.polygon_layout import subset
from plantar.layout import Side, SoleLayout
from plantar.plotting import COLOURS, draw_cells, draw_classes, new_figure, thinned
from plantar.pressure_recording import PressureRecording

__all__ = [
    "STANCE",
    "figure_force",
    "figure_pair",
    "figure_pressure",
    "figure_regions",
    "figure_steps",
    "figure_symmetry",
    "figure_wrench",
    "stance_curves",
]

MOST_PATHS = 60
"""CoP paths drawn a foot; of more steps every n-th."""

REGION_COLOURS = ("#4477aa", "#66ccee", "#228833", "#ccbb44", "#ee6677", "#aa3377", "#bbbbbb")
"""Colours of the regions: Tol's bright scheme, which colour-blind readers can tell apart."""


def _shown(gait: FootGait, platform: bool) -> tuple[SoleLayout, NDArray[np.int64]]:
    """The cells that a picture shows: all of a sole, of a platform those that are stepped on, with a frame around."""
    layout = gait.foot.layout
    assert layout is not None
    every = np.arange(len(layout))
    if not platform or gait.picture is None or not (gait.picture > 0.0).any():
        return layout, every
    hit = gait.picture > 0.0
    chosen = np.flatnonzero(hit | np.array([any(hit[j] for j in near) for near in layout.neighbours]))
    points = np.vstack([layout.cell_polygon(int(c)) for c in chosen])
    (x0, y0), (x1, y1) = points.min(axis=0) - 0.01, points.max(axis=0) + 0.01
    ring = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    return replace(subset(layout, chosen.tolist()), outline=ring), chosen


def _panels(
    feet: Mapping[Side, FootGait], platform: bool, columns: int, extra: float
) -> tuple[Any, Any, dict[Side, Any]]:
    """A figure with one upright panel a foot, and the cells that each shows."""
    shown = {side: _shown(gait, platform) for side, gait in feet.items()}
    extents = [np.ptp(layout.outline, axis=0) for layout, _ in shown.values()]
    slender = max(float(length / width) for length, width in extents)
    figure, axes = new_figure(3.2 * columns + extra, min(6.4, 1.8 + 2.5 * slender), columns=columns, squeeze=False)
    return figure, axes, shown


def figure_pressure(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Maximum pressure picture of each foot with the CoP paths of its complete steps.

    Args:
        recording: The recording.
        feet: The gait of its feet.

    Returns:
        The figure, or None where no foot has geometry.
    """
    shown = {side: gait for side, gait in feet.items() if gait.picture is not None}
    if not shown:
        return None
    factor = 1.0 if recording.raw else 1e-3
    platform = recording.kind == "platform"
    figure, axes, cells = _panels(shown, platform, len(shown), 1.6)
    highest = max(float(gait.picture.max()) for gait in shown.values() if gait.picture is not None) * factor
    drawn = None
    for panel, (side, gait) in zip(axes[0], shown.items(), strict=True):
        assert gait.picture is not None
        layout, chosen = cells[side]
        drawn = draw_cells(panel, layout, _hit(gait.picture[chosen] * factor), highest)
        complete = [contact for contact in gait.contacts if contact.complete]
        every = -(-len(complete) // MOST_PATHS) if complete else 1
        label: str | None = "CoP path of a step" + (f" (every {every}th)" if every > 1 else "")
        for contact in complete[::every]:
            if gait.cop is not None:
                path = gait.cop[contact.begin : contact.end]
                panel.plot(-path[:, 1], path[:, 0], color="#ffffff", linewidth=2.2, alpha=0.9)
                panel.plot(-path[:, 1], path[:, 0], color=COLOURS["cop"], linewidth=1.0, label=label)
                label = None
        panel.set_title(f"{side} foot, {len(gait.steps)} step{'' if len(gait.steps) == 1 else 's'}")
        panel.set_xlabel("to the right (m)")
        if label is None:
            low, high = panel.get_ylim()
            panel.set_ylim(low - 0.08 * (high - low), high)  # room for the legend below the heel
            panel.legend(loc="lower center", fontsize=8, framealpha=0.9)
    axes[0][0].set_ylabel("forward (m)")
    unit = "counts" if recording.raw else "kPa"
    what = "maximum pressure" if platform else "maximum pressure, mean of the steps"
    figure.colorbar(drawn, ax=list(axes[0]), label=f"{what} ({unit})", shrink=0.8)
    return figure


def figure_pair(recordings: Sequence[tuple[str, PressureRecording, Mapping[Side, FootGait]]]) -> Any | None:
    """Maximum pressure pictures of several recordings beside each other, on one scale.

    Args:
        recordings: Name, recording and feet of each.

    Returns:
        The figure, or None where one has no geometry.
    """
    panels = [(f"{n}, {s}", r, g) for n, r, feet in recordings for s, g in feet.items() if g.picture is not None]
    if not panels or any(all(g.picture is None for g in feet.values()) for _, _, feet in recordings):
        return None
    factor = 1.0 if panels[0][1].raw else 1e-3
    figure, axes = new_figure(2.6 * len(panels) + 1.4, 5.6, columns=len(panels), squeeze=False)
    highest = max(float(g.picture.max()) for _, _, g in panels if g.picture is not None) * factor
    drawn = None
    for panel, (name, recording, gait) in zip(axes[0], panels, strict=True):
        assert gait.picture is not None
        layout, chosen = _shown(gait, recording.kind == "platform")
        drawn = draw_cells(panel, layout, _hit(gait.picture[chosen] * factor), highest)
        panel.set_title(f"{name} foot")
        panel.set_xlabel("to the right (m)")
    axes[0][0].set_ylabel("forward (m)")
    unit = "counts" if panels[0][1].raw else "kPa"
    figure.colorbar(drawn, ax=list(axes[0]), label=f"maximum pressure ({unit})", shrink=0.8)
    return figure


def figure_regions(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """The regions of each foot, its axis and the thirds of the print without toes.

    Args:
        recording: The recording; of a platform the first footprint of each foot is shown.
        feet: The gait of its feet.

    Returns:
        The figure, or None where no foot has regions.
    """
    platform = recording.kind == "platform"
    shown: dict[Side, tuple[FootGait, NDArray[np.int64], Any]] = {}
    for side, gait in feet.items():
        region, print_ = gait.region, gait.footprint
        if platform and gait.steps and gait.steps[0].footprint is not None and gait.foot.layout is not None:
            print_ = gait.steps[0].footprint
            region = gait.steps[0].region
        if region is not None and print_ is not None:
            shown[side] = gait, region, print_
    if not shown:
        return None
    figure, axes, cells = _panels({s: g for s, (g, _, _) in shown.items()}, platform, len(shown), 1.8)
    used: set[int] = set()
    for panel, (side, (_, region, print_)) in zip(axes[0], shown.items(), strict=True):
        layout, chosen = cells[side]
        draw_classes(panel, layout, region[chosen], REGION_COLOURS)
        used |= set(region[region >= 0].tolist())
        low, high = float(print_.rings[:, :, 1].min()), float(print_.rings[:, :, 1].max())
        for k in range(4):
            u = k * print_.toeless_length / 3.0
            line = print_.from_foot(np.array([[u, low], [u, high]]))
            panel.plot(-line[:, 1], line[:, 0], color="#111111", linewidth=0.8, linestyle=":")
        line = print_.from_foot(np.array([[0.0, 0.0], [print_.length, 0.0]]))
        panel.plot(-line[:, 1], line[:, 0], color="#111111", linewidth=1.4)
        panel.set_title(f"{side} foot")
        panel.set_xlabel("to the right (m)")
    axes[0][0].set_ylabel("forward (m)")
    for i, (colour, title) in enumerate(zip(REGION_COLOURS, REGIONS.values(), strict=True)):
        if i in used:
            axes[0][-1].plot([], [], "s", color=colour, label=title)
    axes[0][-1].plot([], [], color="#111111", label="foot axis")
    axes[0][-1].plot([], [], ":", color="#111111", label="thirds without toes")
    figure.legend(loc="outside right center", fontsize=8)
    return figure


def figure_symmetry(symmetry: Mapping[str, float | None]) -> Any | None:
    """Symmetry index of the measures that have one; None where there are fewer than two.

    Args:
        symmetry: Index in percent of each measure, by its key.

    Returns:
        The figure, or None.
    """
    wanted = [
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
    ]
    rows = [(MEASURES[k].title, value) for k in wanted if (value := symmetry.get(k)) is not None]
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
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("symmetry index (%): above 0 larger on the left; grey: within 10 %")
    return figure


def figure_wrench(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Wrench of each sole about its frame's origin over time.

    Args:
        recording: The recording.
        feet: The gait of its feet.

    Returns:
        The figure, or None for recordings that are not of a robot.
    """
    if recording.kind != "robot" or recording.raw:
        return None
    shown = {side: gait for side, gait in feet.items() if gait.foot.layout is not None}
    if not shown:
        return None
    figure, axes = new_figure(10.0, 5.6, rows=3, sharex=True)
    for side, gait in shown.items():
        assert gait.foot.layout is not None
        wrench = gait.foot.measured @ gait.foot.layout.wrench_map.T
        for panel, index in zip(axes, (2, 3, 4), strict=True):
            panel.plot(
                *thinned(recording.time, wrench[:, index]), color=COLOURS[side], linewidth=0.9, label=f"{side} foot"
            )
    for panel, name in zip(axes, ("fz (N)", "tx (N·m)", "ty (N·m)"), strict=True):
        panel.set_ylabel(name)
        panel.grid(alpha=0.3)
        panel.margins(x=0.01)
    axes[0].legend(loc="upper right", fontsize=8, ncols=2, framealpha=0.9)
    axes[-1].set_xlabel("time (s); wrench of the ground on the sole about the sole frame's origin")
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
            levels = gait.levels
            for level in sorted({levels.release, levels.lift}):
                name = "event level" if level == levels.release else None
                panel.axhline(level, color=COLOURS["reference"], linewidth=0.8, linestyle="--", label=name)
            strikes = [c.heel_strike for c in gait.contacts if c.heel_strike is not None]
            lifts = [c.toe_off for c in gait.contacts if c.toe_off is not None]
            for times, mark, name, level in (
                (strikes, "v", "heel strike", levels.release),
                (lifts, "^", "toe off", levels.lift),
            ):
                if times:
                    panel.plot(times, [level] * len(times), mark, color="#111111", markersize=5, label=name)
        for contact in gait.contacts:
            if not contact.complete:
                begin, end = recording.time[contact.begin], recording.time[contact.end - 1]
                panel.axvspan(begin, end, color=COLOURS["cell"], zorder=0)
        panel.set_ylabel(_force_label(recording))
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
    for panel, (side, gait) in zip(axes[0], shown.items(), strict=True):
        curves = stance_curves(recording, gait)
        colour = COLOURS[side]
        for i, curve in enumerate(curves[:: -(-len(curves) // 100)]):
            panel.plot(STANCE, curve, color=colour, linewidth=0.6, alpha=0.4, label=None if i else "one step")
        mean = curves.mean(axis=0)
        panel.plot(STANCE, mean, color="#111111", linewidth=1.6, label=f"mean of {len(curves)}")
        if len(curves) > 1:
            sd = curves.std(axis=0, ddof=1)
            panel.fill_between(STANCE, mean - sd, mean + sd, color=colour, alpha=0.25, label="± 1 SD", linewidth=0)
        panel.set_title(f"{side} foot")
        panel.set_xlabel("stance (%)")
        panel.legend(fontsize=8, loc="lower center")
        panel.grid(alpha=0.3)
    axes[0][0].set_ylabel(_force_label(recording))
    return figure


STANCE = np.linspace(0.0, 100.0, 101)
"""Percent of stance at which force curves are given."""


def stance_curves(recording: PressureRecording, gait: FootGait) -> NDArray[np.float64]:
    """Vertical force of each complete step over its stance.

    Args:
        recording: The recording.
        gait: One foot of it.

    Returns:
        Forces (steps, 101) in N at each percent of the stance.
    """
    known = np.isfinite(gait.foot.vertical_force)
    time, force = recording.time[known], gait.foot.vertical_force[known]
    moments = [s.heel_strike_s + 0.01 * STANCE * (s.toe_off_s - s.heel_strike_s) for s in gait.steps]
    return np.array([np.interp(m, time, force) for m in moments]).reshape(-1, len(STANCE))


def _hit(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values with NaN for cells that are never loaded, which are drawn empty."""
    return np.where(values > 0.0, values, np.nan)


def _force_label(recording: PressureRecording) -> str:
    return f"vertical force ({'counts' if recording.raw else 'N'})"
