"""A tip's way to its goal, and its figure."""

from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sim.companion.experiment import World
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.reaching.layout import Layout
from plantar.sim.companion.reaching.reach_controller import ReachController

_SHADES = {"approach": "#f3d9a4", "retreat": "#eeb4b4"}
_POSES = 6  # of the arm that are drawn


class ReachRecord:
    """Notes of a `machine`'s run, with tolerable force `limit` in N."""

    def __init__(self, machine: Machine, layout: Layout, limit: float) -> None:
        self._layout = layout
        self._limit = limit
        self._links = [body.name for body in machine.spec().bodies if body.name not in ("", "world")]
        self._rows: list[tuple[float, ...]] = []
        self._arrangements: list[str] = []
        self._arms: list[NDArray[np.float64]] = []
        self._posts: list[NDArray[np.float64]] = []

    def add(self, world: World, time: float, tip: NDArray[np.float64], force: float, hand: ReachController) -> None:
        """Note `world` at `time` in s, `tip` (3,) in m, true `force` in N and controller `hand`."""
        signs = hand.signs
        share = hand.policy.range_share
        self._rows.append((time, force, signs.contact, signs.near, min(signs.speed, 1.0), share))
        self._arrangements.append(hand.policy.arrangement)
        self._arms.append(np.array([*(world.data.body(name).xpos[:2] for name in self._links), tip[:2]]))
        self._posts.append(np.array([world.data.body(p.name).xpos[:2] for p in self._layout.posts]))

    def changes(self) -> list[str]:
        """The arrangements in their order."""
        return [name for name, _ in groupby(self._arrangements)]

    def plot(self, path: Path, title: str) -> Path:
        """Draw T Figures 24-25 at `path` with a `title`. Returns the path."""
        figure, axes = new_figure(12.0, 6.5, 4, 2, squeeze=False, gridspec_kw={"width_ratios": [1.2, 1.0]})
        for axis in axes[:, 0]:
            axis.remove()
        plan = figure.add_subplot(axes[0, 0].get_gridspec()[:, 0])
        self._draw_plan(plan)
        plan.set_title(title)
        time, force, measured, near, speed, share = np.array(self._rows).T
        over = axes[:, 1]
        over[0].plot(time, force, color=COLOURS["left"], label="true force", linewidth=1.0)
        over[0].plot(time, measured, color=COLOURS["right"], label="measured", linewidth=0.7)
        over[0].axhline(self._limit, color="black", linestyle="--", linewidth=0.8, label="tolerable")
        for axis, values, label in (
            (over[0], None, "force [N]"),
            (over[1], near, "virtual force of\nwhat is near [N]"),
            (over[2], speed, "speed of the\ntip [m/s]"),
            (over[3], share, "used share of\nsensing range"),
        ):
            if values is not None:
                axis.plot(time, values, color=COLOURS["left"], linewidth=1.0)
            axis.set_ylabel(label)
            self._shade(axis, time)
        for name, shade in _SHADES.items():
            over[0].axvspan(0.0, 0.0, color=shade, linewidth=0, label=name)
        over[0].legend(fontsize=7, ncols=5, loc="lower center", bbox_to_anchor=(0.5, 1.0))  # hides no peak
        over[3].set_xlabel("time [s]")
        return save_figure(figure, path)

    def _shade(self, axis: Any, time: NDArray[np.float64]) -> None:
        at = 0
        for name, run in groupby(self._arrangements):
            length = len(list(run))
            if name in _SHADES:
                axis.axvspan(time[at], time[min(at + length, len(time) - 1)], color=_SHADES[name], linewidth=0)
            at += length

    def _draw_plan(self, axis: Any) -> None:
        chosen = np.unique(np.linspace(0, len(self._arms) - 1, _POSES).astype(int))
        for i in chosen.tolist():
            strength = 0.15 + 0.85 * i / max(1, chosen[-1])
            axis.plot(*self._arms[i].T, "o-", color=COLOURS["left"], alpha=strength, markersize=2.5, linewidth=2)
        tips = np.array([arm[-1] for arm in self._arms])
        axis.plot(*tips.T, color="black", linewidth=1.0, label="way of the tip")
        angle = np.linspace(0.0, 2.0 * np.pi, 60)
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        for k, post in enumerate(self._layout.posts):
            colour, name = (COLOURS["right"], "movable") if post.friction else ("black", "fixed")
            axis.plot(*(post.place + post.radius * circle).T, "--", color=colour, linewidth=0.8)
            axis.fill(*(self._posts[-1][k] + post.radius * circle).T, color=colour, alpha=0.5, label=name)
        axis.plot(*self._layout.goal, "*", color="green", markersize=14, linestyle="", label="goal")
        axis.set(aspect="equal", xlabel="x [m]; dashed: at first, filled: at the end", ylabel="y [m]")
        named = dict(zip(*reversed(axis.get_legend_handles_labels()), strict=True))
        axis.legend(named.values(), named, fontsize=7)
