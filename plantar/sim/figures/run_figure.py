"""Figures of a run, drawn from its recording."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.recordings.pressure_recording import true_runs
from plantar.recordings.recording import Recording, read_mcap
from plantar.sim.figures.foothold_figure import (
    AXES,
    WalkPlane,
    draw_footholds,
    draw_zmp_plane,
    draw_zmps,
    sole_outline,
)
from plantar.sim.figures.push_figure import draw_guide, draw_partner, draw_pushes, draw_strides, draw_swing

_PAD = 0.03  # m: what is shown around the walk


def plot_run(recording: str | Path | Recording, folder: str | Path) -> list[Path]:
    """Draw figures of a `recording`, an MCAP file or its content, into a `folder`.

    Returns the files: balance.png, plane.png, feet.png; footholds.png; zmp.png and zmp_plane.png with ankle sensors;
    pushes.png, swing.png and strides.png with touches; partner.png; guide.png.
    """
    run = recording if isinstance(recording, Recording) else read_mcap(recording)
    folder = Path(folder)
    known = {"", *(name for name, topic in run.topics.items() if len(topic.time))}
    wanted = {name: draw for topic, figures in _FIGURES.items() if topic in known for name, draw in figures.items()}
    return [save_figure(draw(run), folder / f"{name}.png") for name, draw in wanted.items()]


def _balance(run: Recording) -> Any:
    figure, axes = new_figure(11.0, 8.0, 3, 1, grid=True, sharex=True)
    time = run.topics["/truth/body"].time
    lines = (
        ("/reference", "zmp", "-", "reference", 1.5, "VRP reference"),
        ("/reference", "zmp_desired", "-", "active", 1.5, "ZMP desired"),
        ("/truth/body", "zmp", "-", "truth", 0.8, "ZMP true"),
        ("/reference", "dcm", "--", "right", 1.5, "DCM reference"),
        ("/estimate", "dcm", "-", "right", 1.5, "DCM estimated"),
        ("/reference", "com", "--", "left", 1.5, "CoM reference"),
        ("/truth/body", "com", "-", "left", 1.5, "CoM true"),
    )
    for i, axis in enumerate(axes[:2]):
        for topic, field, style, colour, width, label in lines:
            axis.plot(time, run.values(topic, field)[:, i], style, color=COLOURS[colour], lw=width, label=label)
        axis.set_ylabel(AXES[i])
    axes[0].legend(ncol=4, fontsize=8)
    tilt = np.degrees(np.arccos(np.clip(run.values("/truth/body", "rotation")[:, 8], -1.0, 1.0)))
    axes[2].plot(time, tilt, color=COLOURS["truth"], label="torso tilt [deg]")
    margin = 100.0 * run.values("/truth/body", "zmp_margin")[:, 0]
    axes[2].plot(time, margin, color=COLOURS["polygon"], lw=0.8, label="true ZMP margin [cm]")
    axes[2].set(xlabel="time [s]", ylabel="deg, cm")
    axes[2].legend(fontsize=8)
    return figure


def _plane(run: Recording) -> Any:
    rings = {side: _footholds(run, side) for side in SIDES}
    lines = (
        ("/truth/body", "zmp", "truth", 0.7, "ZMP true"),
        ("/estimate", "dcm", "active", 1.0, "DCM estimated"),
        ("/truth/body", "com", "polygon", 1.4, "CoM true"),
    )
    paths = [run.values(topic, name)[:, :2] for topic, name, *_ in lines]
    plane = WalkPlane.around(np.vstack([*rings["left"], *rings["right"], *paths]), _PAD)
    figure, axis = new_figure(11.0, float(np.clip(1.2 + 9.5 * plane.slenderness, 2.2, 9.0)), grid=True)
    for side, own in rings.items():
        for n, ring in enumerate(own):
            label = f"{side} foothold" if n == 0 else None
            axis.plot(*np.vstack([ring, ring[:1]])[:, plane.turn].T, color=COLOURS[side], lw=0.8, label=label)
    for path, (_, _, colour, width, label) in zip(paths, lines, strict=True):
        axis.plot(*path[:, plane.turn].T, color=COLOURS[colour], lw=width, label=label)
    plane.frame(axis)
    return figure


def _footholds(run: Recording, side: Side) -> list[NDArray[np.float64]]:
    force = run.values(f"/truth/{side}", "normal_force")[:, 0]
    return [sole_outline(run, side, i) for i, _ in true_runs(force > 0.4 * force.max())]


def _feet(run: Recording) -> Any:
    figure, axes = new_figure(11.0, 5.0, 2, 1, grid=True, sharex=True)
    for side in SIDES:
        time = run.topics[f"/truth/{side}"].time
        axes[0].plot(time, run.values(f"/truth/{side}", "normal_force")[:, 0], color=COLOURS[side], lw=0.8, label=side)
        skin = run.topics[f"/skin/{side}"]
        axes[0].plot(skin.time, skin.fields["force"].sum(axis=1), color=COLOURS[side], lw=0.3, alpha=0.6)
        axes[1].plot(
            time, 1e3 * run.values(f"/truth/{side}", "position")[:, 2], color=COLOURS[side], lw=0.9, label=side
        )
    axes[0].set_ylabel("ground force [N]\n(thin: as the taxels measure it)")
    axes[1].set(ylabel="sole height [mm]", xlabel="time [s]")
    for axis in axes:
        axis.legend(fontsize=8)
    return figure


_FIGURES: Mapping[str, Mapping[str, Callable[[Recording], Any]]] = {
    "": {"balance": _balance, "plane": _plane, "feet": _feet},
    "/foothold": {"footholds": draw_footholds},
    "/zmp": {"zmp": draw_zmps, "zmp_plane": draw_zmp_plane},
    "/touch": {"pushes": draw_pushes, "swing": draw_swing, "strides": draw_strides},
    "/partner": {"partner": draw_partner},
    "/guide": {"guide": draw_guide},
}
"""What is drawn of each topic that holds messages; "" is any recording."""
