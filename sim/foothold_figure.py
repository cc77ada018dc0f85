"""The walk in the plane as the papers draw it: footholds, VRPs, DCM, CoM and ZMP, over the ground (T Fig. 61-64)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, new_figure
from plantar.recording import Recording

__all__ = ["draw_footholds"]

_PAD = 0.06  # m around what is drawn


def draw_footholds(run: Recording) -> Any:
    """Draw what the feet were found to stand on, and the trajectories over it.

    Args:
        run: A run's recording with topic "/foothold".

    Returns:
        The figure: above the plane, below the ZMP against the footholds over time.
    """
    felt = run.topics["/foothold"]
    steps = felt.fields["step"][:, 0].astype(int)
    last = [int(np.flatnonzero(steps == k)[-1]) for k in sorted(set(steps.tolist()))]
    rings = {int(steps[i]): _ring(felt.fields["polygon"][i]) for i in last}
    dcm, com = _field(run, "/reference", "dcm"), _field(run, "/reference", "com")[:, :2]
    zmp, wanted = _field(run, "/truth/body", "zmp"), _field(run, "/reference", "zmp_desired")
    every = np.vstack([com, *rings.values()]) if rings else com
    low, high = every.min(axis=0) - _PAD, every.max(axis=0) + _PAD
    upright = high[1] - low[1] > high[0] - low[0]
    turn = [1, 0] if upright else [0, 1]  # a walk along y is drawn lying down
    span = (high - low)[turn]
    tall = 11.0 * span[1] / span[0]
    figure, (plane, time) = new_figure(11.0, 4.2 + tall, 2, 1, height_ratios=[tall, 3.2])
    for n, outline in enumerate(run.metadata.get("ground", [])):
        closed = np.array(outline)[:, turn]
        plane.fill(*closed.T, fc="#f1ece2", ec="#c9bfa8", lw=0.8, zorder=0, label="ground" if n == 0 else None)
    for n, ring in enumerate(rings.values()):
        closed = np.vstack([ring, ring[:1]])[:, turn]
        name = "support felt" if n == 0 else None
        plane.fill(*closed.T, color=COLOURS["edge"], alpha=0.22, lw=0.0, zorder=1, label=name)
        plane.plot(*closed.T, color=COLOURS["edge"], lw=0.7, zorder=2)
    plane.plot(*zmp[:, turn].T, color=COLOURS["left"], lw=0.6, label="ZMP true $p$", zorder=3)
    plane.plot(*wanted[:, turn].T, color=COLOURS["active"], lw=0.9, label="ZMP desired $p_d$", zorder=4)
    plane.plot(*dcm[:, turn].T, color=COLOURS["polygon"], lw=1.2, label=r"DCM reference $\xi_r$", zorder=5)
    plane.plot(*com[:, turn].T, color=COLOURS["truth"], lw=1.4, label="CoM reference $x_r$", zorder=6)
    points = np.array([felt.fields["vrp"][i] for i in last])[:, turn]
    plane.plot(*points.T, "s", color=COLOURS["cop"], ms=4.0, label="VRP $r$ over the support", zorder=7)
    plane.set_xlim(low[turn[0]], high[turn[0]])
    plane.set_ylim(*((high[turn[1]], low[turn[1]]) if upright else (low[turn[1]], high[turn[1]])))
    plane.set_aspect("equal")
    names = ("x forward [m]", "y left [m]")
    plane.set_xlabel(names[turn[0]])
    plane.set_ylabel(names[turn[1]])
    plane.legend(ncol=7, fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.01), frameon=False)
    _draw_time(time, run, rings, zmp[:, turn[1]], wanted[:, turn[1]], turn[1], names[turn[1]])
    return figure


def _draw_time(
    axis: Any,
    run: Recording,
    rings: dict[int, NDArray[np.float64]],
    zmp: NDArray[np.float64],
    wanted: NDArray[np.float64],
    along: int,
    name: str,
) -> None:
    """ZMP across the walk over time, with the range of each stance's support behind it."""
    clock = run.topics["/reference"].time
    swing = _field(run, "/reference", "phase")[:, 0] == 2
    step = _field(run, "/reference", "step")[:, 0].astype(int)
    drawn = False
    for k, ring in rings.items():
        stance = np.flatnonzero(swing & (step == k + 1))
        if len(stance):
            ends = clock[stance[[0, -1]]]
            low, high = float(ring[:, along].min()), float(ring[:, along].max())
            label = None if drawn else "support in single support"
            axis.fill_between(ends, low, high, color=COLOURS["edge"], alpha=0.22, lw=0.0, label=label)
            drawn = True
    axis.plot(clock, zmp, color=COLOURS["left"], lw=0.6, label="ZMP true $p$")
    axis.plot(clock, wanted, color=COLOURS["active"], lw=0.9, label="ZMP desired $p_d$")
    axis.set_xlabel("time [s]")
    axis.set_ylabel(name)
    axis.set_xlim(clock[0], clock[-1])
    axis.grid(alpha=0.3)
    axis.legend(fontsize=7, ncol=3, loc="upper left")


def _ring(row: NDArray[np.float64]) -> NDArray[np.float64]:
    points = np.asarray(row).reshape(-1, 2)
    return points[np.isfinite(points).all(axis=1)]


def _field(run: Recording, topic: str, name: str) -> NDArray[np.float64]:
    return np.asarray(run.topics[topic].fields[name])
