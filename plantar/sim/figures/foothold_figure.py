"""The walk in the plane, and the ZMP of skin and ankles (T 4.3.1, Fig. 61-64)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.percepts.sole_pose import feet_support_polygon
from plantar.plotting import COLOURS, new_figure
from plantar.recordings.recording import Recording

AXES = ("x forward [m]", "y left [m]")
"""Labels of the world's axes."""


@dataclass(frozen=True, eq=False)
class WalkPlane:
    """The plane from `low` to `high` (2,) in m; a walk along y has y to the right, x down."""

    low: NDArray[np.float64]
    high: NDArray[np.float64]

    @classmethod
    def around(cls, points: NDArray[np.float64], pad: float) -> "WalkPlane":
        """Returns the plane around `points` (n, 2) in m, without NaN, with margin `pad` in m."""
        return cls(np.nanmin(points, axis=0) - pad, np.nanmax(points, axis=0) + pad)

    @property
    def turn(self) -> list[int]:
        span = self.high - self.low
        return [1, 0] if span[1] > span[0] else [0, 1]

    @property
    def slenderness(self) -> float:
        """Height over width as drawn."""
        span = (self.high - self.low)[self.turn]
        return float(span[1] / span[0])

    def frame(self, axis: Any) -> None:
        """Set limits, labels and the legend of a plot."""
        x, y = self.turn
        low = self.low
        high = self.high
        axis.set(xlim=(low[x], high[x]), ylim=(high[y], low[y]) if x else (low[y], high[y]))
        axis.set(aspect="equal", xlabel=AXES[x], ylabel=AXES[y])
        axis.legend(ncol=7, fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.01), frameon=False)


_PAD = 0.06  # m around what is drawn


def draw_footholds(run: Recording) -> Any:
    """Figure of found supports, trajectories, and the ZMP against footholds.

    The `run` is a recording with topic "/foothold".
    """
    view = _View.of(run)
    tall = 11.0 * view.plane.slenderness
    figure, (plane, time) = new_figure(11.0, 4.2 + tall, 2, 1, height_ratios=[tall, 3.2])
    _draw_ground(plane, run, view)
    _draw_supports(plane, view)
    _draw_trajectories(plane, run, view)
    view.plane.frame(plane)
    _draw_time(time, run, view)
    return figure


@dataclass(frozen=True, eq=False)
class _View:
    """The supports of a walk and the plane around them.

    `last` of each step's last message on "/foothold"; `rings`: corners (k, 2) in m found for each step; `plane`: what
    of the ground is shown.
    """

    last: list[int]
    rings: dict[int, NDArray[np.float64]]
    plane: WalkPlane

    @classmethod
    def of(cls, run: Recording) -> "_View":
        steps = run.values("/foothold", "step")[:, 0].astype(int)
        last = [int(np.flatnonzero(steps == k)[-1]) for k in sorted(set(steps.tolist()))]
        polygons = run.values("/foothold", "polygon").reshape(len(steps), -1, 2)
        rings = {int(steps[i]): polygons[i][np.isfinite(polygons[i]).all(axis=1)] for i in last}
        points = np.vstack([run.values("/reference", "com")[:, :2], *rings.values()])
        return cls(last, rings, WalkPlane.around(points, _PAD))


def _draw_ground(plane: Any, run: Recording, view: _View) -> None:
    for n, outline in enumerate(run.metadata.get("ground", [])):
        closed = np.array(outline)[:, view.plane.turn]
        plane.fill(*closed.T, fc="#f1ece2", ec="#c9bfa8", lw=0.8, zorder=0, label="ground" if n == 0 else None)


def _draw_supports(plane: Any, view: _View) -> None:
    for n, ring in enumerate(view.rings.values()):
        closed = np.vstack([ring, ring[:1]])[:, view.plane.turn]
        name = "support found" if n == 0 else None
        plane.fill(*closed.T, color=COLOURS["edge"], alpha=0.22, lw=0.0, zorder=1, label=name)
        plane.plot(*closed.T, color=COLOURS["edge"], lw=0.7, zorder=2)


def _draw_trajectories(plane: Any, run: Recording, view: _View) -> None:
    shown = (
        ("/truth/body", "zmp", "left", 0.6, "ZMP true $p$"),
        ("/reference", "zmp_desired", "active", 0.9, "ZMP desired $p_d$"),
        ("/reference", "dcm", "polygon", 1.2, r"DCM reference $\xi_r$"),
        ("/reference", "com", "truth", 1.4, "CoM reference $x_r$"),
    )
    for order, (topic, name, colour, width, label) in enumerate(shown, start=3):
        points = run.values(topic, name)[:, view.plane.turn]
        plane.plot(*points.T, color=COLOURS[colour], lw=width, label=label, zorder=order)
    points = run.values("/foothold", "vrp")[view.last][:, view.plane.turn]
    plane.plot(*points.T, "s", color=COLOURS["cop"], ms=4.0, label="VRP $r$ over the support", zorder=7)


def _draw_time(axis: Any, run: Recording, view: _View) -> None:
    along = view.plane.turn[1]
    zmp = run.values("/truth/body", "zmp")[:, along]
    wanted = run.values("/reference", "zmp_desired")[:, along]
    clock = run.topics["/reference"].time
    swing = run.values("/reference", "phase")[:, 0] == 2
    step = run.values("/reference", "step")[:, 0].astype(int)
    label: str | None = "support in single support"
    for k, ring in view.rings.items():
        stance = np.flatnonzero(swing & (step == k + 1))
        if len(stance):
            low = float(ring[:, along].min())
            high = float(ring[:, along].max())
            spread = {"color": COLOURS["edge"], "alpha": 0.22, "lw": 0.0}
            axis.fill_between(clock[stance[[0, -1]]], low, high, label=label, **spread)
            label = None
    axis.plot(clock, zmp, color=COLOURS["left"], lw=0.6, label="ZMP true $p$")
    axis.plot(clock, wanted, color=COLOURS["active"], lw=0.9, label="ZMP desired $p_d$")
    axis.set(xlabel="time [s]", ylabel=AXES[along], xlim=(clock[0], clock[-1]))
    axis.grid(alpha=0.3)
    axis.legend(fontsize=7, ncol=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)


def sole_outline(run: Recording, side: Side, i: int) -> NDArray[np.float64]:
    """Returns the true outline (k, 2) in m of a sole in a `run`, at message `i` of "/truth/<side>"."""
    truth = run.topics[f"/truth/{side}"].fields
    turn = truth["rotation"][i].reshape(3, 3)[:2, :2]
    return np.asarray(run.layouts[side].outline @ turn.T + truth["position"][i, :2])


_FROM = 1.0  # s: before, filters and estimator settle


def draw_zmps(run: Recording) -> Any:
    """Figure of both ZMPs over time, from a recording with /zmp."""
    topic = run.topics["/zmp"]
    counts = topic.time >= _FROM
    time = topic.time[counts]
    skin = topic.fields["skin"][counts]
    ankles = topic.fields["force_torque"][counts]
    figure, axes = new_figure(11.0, 8.0, 4, 1, grid=True, sharex=True)
    for i, (value, difference) in enumerate(axes.reshape(2, 2)):
        value.plot(time, ankles[:, i], color=COLOURS["left"], lw=1.2, label="ankle force-torque sensors")
        value.plot(time, skin[:, i], color=COLOURS["right"], lw=0.9, label="skin")
        value.set_ylabel(f"ZMP {'xy'[i]} [m]")
        error = 1e3 * (ankles[:, i] - skin[:, i])
        rms = float(np.sqrt(np.nanmean(error**2)))
        difference.plot(time, error, color=COLOURS["truth"], lw=0.7, label=f"ankles - skin, RMS {rms:.2f} mm")
        difference.set_ylabel(f"difference {'xy'[i]}\n[mm]")
    for axis in axes:
        axis.legend(fontsize=8, loc="upper right", ncol=2)
    axes[-1].set_xlabel("time [s]")
    return figure


def draw_zmp_plane(run: Recording) -> Any:
    """Figure of a standing robot's ZMPs with soles and support polygon, from a recording with /zmp."""
    topic = run.topics["/zmp"]
    counts = topic.time >= _FROM
    figure, axis = new_figure(6.0, 6.0, grid=True)
    soles = [sole_outline(run, side, 0) for side in SIDES]
    for side, sole in zip(SIDES, soles, strict=True):
        axis.fill(*sole.T, color=COLOURS[side], alpha=0.15, label=f"{side} sole")
    support = feet_support_polygon(soles)
    axis.plot(*np.vstack([support, support[:1]]).T, color=COLOURS["polygon"], lw=1.0, label="support polygon")
    for name, colour, width, label in (("force_torque", "left", 1.2, "ankles"), ("skin", "right", 0.8, "skin")):
        axis.plot(*topic.fields[name][counts].T, color=COLOURS[colour], lw=width, label=f"ZMP, {label}")
    axis.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axis.legend(fontsize=8)
    return figure
