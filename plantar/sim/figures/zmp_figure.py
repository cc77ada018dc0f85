"""Figures of the ZMP from the skin against that from the ankles (T Fig. 42-43)."""

from __future__ import annotations

from typing import Any

import numpy as np

from plantar.percepts.sole_pose import feet_support_polygon
from plantar.plotting import COLOURS, new_figure
from plantar.recordings.recording import Recording
from plantar.sides import SIDES

__all__ = ["draw_zmp_plane", "draw_zmps"]

_FROM = 1.0  # s: before, filters and estimator settle


def draw_zmps(run: Recording) -> Any:
    """Figure of both ZMPs and their difference over time, from a recording with /zmp."""
    topic = run.topics["/zmp"]
    counts = topic.time >= _FROM
    time = topic.time[counts]
    skin, ankles = topic.fields["skin"][counts], topic.fields["force_torque"][counts]
    figure, axes = new_figure(11.0, 8.0, 4, 1, sharex=True)
    for i, name in enumerate(("x", "y")):
        value, difference = axes[2 * i], axes[2 * i + 1]
        value.plot(time, ankles[:, i], color=COLOURS["left"], lw=1.2, label="ankle force-torque sensors")
        value.plot(time, skin[:, i], color=COLOURS["right"], lw=0.9, label="skin")
        value.set_ylabel(f"ZMP {name} [m]")
        error = 1e3 * (ankles[:, i] - skin[:, i])
        rms = float(np.sqrt(np.nanmean(error**2)))
        difference.plot(time, error, color=COLOURS["truth"], lw=0.7, label=f"ankles - skin, RMS {rms:.2f} mm")
        difference.set_ylabel(f"difference {name}\n[mm]")
        for axis in (value, difference):
            axis.grid(alpha=0.3)
            axis.legend(fontsize=8, loc="upper right", ncol=2)
    axes[-1].set_xlabel("time [s]")
    return figure


def draw_zmp_plane(run: Recording) -> Any:
    """Figure of both ZMPs in the plane with soles and support polygon, from a standing robot's recording with /zmp."""
    topic = run.topics["/zmp"]
    counts = topic.time >= _FROM
    figure, axis = new_figure(6.0, 6.0)
    soles = []
    for side in SIDES:
        truth = run.topics[f"/truth/{side}"].fields
        rotation, place = truth["rotation"][0].reshape(3, 3), truth["position"][0]
        sole = run.layouts[side].outline @ rotation[:2, :2].T + place[:2]
        soles.append(sole)
        axis.fill(*sole.T, color=COLOURS[side], alpha=0.15, label=f"{side} sole")
    support = feet_support_polygon(soles)
    axis.plot(*np.vstack([support, support[:1]]).T, color=COLOURS["polygon"], lw=1.0, label="support polygon")
    for name, colour, width in (("force_torque", COLOURS["left"], 1.2), ("skin", COLOURS["right"], 0.8)):
        label = "ZMP, ankles" if name == "force_torque" else "ZMP, skin"
        axis.plot(*topic.fields[name][counts].T, color=colour, lw=width, label=label)
    axis.set_aspect("equal")
    axis.set_xlabel("x [m]")
    axis.set_ylabel("y [m]")
    axis.legend(fontsize=8)
    axis.grid(alpha=0.3)
    return figure
