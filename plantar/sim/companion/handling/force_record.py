"""A hand over time, drawn like A's Figures 5 to 8."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, new_figure, save_figure

_SHADES = {"touch": "#8fd19e", "person": "#f1a7a9", "turn": "#ffe08a", "circle": "#cfd8dc", "swing": "#b0bec5"}


class ForceRecord:
    """Samples of the truth. `rows`: time, wanted and true force, distance, moment (3,), hand (3,), base (3,), tilt."""

    def __init__(self) -> None:
        self.rows: list[list[float]] = []

    def add(self, *values: float | Sequence[float] | NDArray[np.float64]) -> None:
        """Add a sample, a row of `rows`."""
        self.rows.append(np.hstack(values).tolist())

    def plot(self, path: Path, title: str, windows: Mapping[str, Sequence[tuple[float, float]]], force: bool) -> Path:
        """Draw moments, hand, base, orientation and distance, with `force` for a contact phase, over time at `path`.

        `windows`, begin and end in s of each kind of interaction, are shaded below the `title`. Returns the path.
        """
        t, wanted, true, distance, *rest = np.array(self.rows).T
        moment = rest[:3]
        hand = rest[3:6]
        base = rest[6:9]
        tilt = rest[9]
        figure, axes = new_figure(9.0, 11.0 if force else 9.5, rows=6 if force else 5, sharex=True)
        axis = list(axes)
        if force:
            top = axis.pop(0)
            top.plot(t, wanted, color=COLOURS["reference"], label="wanted")
            top.plot(t, true, color=COLOURS["left"], linewidth=0.8, label="true")
            top.set(ylabel="force [N]", ylim=(0.0, max(8.0, 1.6 * float(np.nanmax(wanted, initial=0.0)))))
            top.legend(loc="upper right", ncols=2, fontsize=8)
        axis[0].plot(t, 1e3 * distance, color=COLOURS["left"])
        axis[0].set_ylabel("distance [mm]")
        _lines(axis[1], t, moment, "xyz", "moment [N m]")
        _lines(axis[2], t, [values - values[0] for values in hand], "xyz", "hand moved [m]")
        _lines(axis[3], t, base, ("x", "y", "yaw"), "base [m, rad]")
        axis[4].plot(t, tilt, color=COLOURS["left"])
        axis[4].set(xlabel="time [s]", ylabel="hand to\nsurface [deg]", xlim=(t[0], t[-1]))
        for ax in axes:
            for name, spans in windows.items():
                for i, (begin, end) in enumerate(spans):
                    ax.axvspan(begin, end, color=_SHADES[name], alpha=0.35, label=name if i == 0 else None, linewidth=0)
        axes[0].set_title(title)
        handles, labels = axis[0].get_legend_handles_labels()
        if handles:
            axis[0].legend(handles, labels, loc="upper right", ncols=5, fontsize=8)
        return save_figure(figure, path)


def _lines(axis: Any, t: NDArray[np.float64], values: Sequence[Any], names: Sequence[str], label: str) -> None:
    for name, line, colour in zip(names, values, ("left", "right", "polygon"), strict=True):
        axis.plot(t, line, color=COLOURS[colour], linewidth=1.0, label=name)
    axis.set_ylabel(label)
    axis.legend(loc="upper right", ncols=3, fontsize=8)
