"""Figure of a run in which a hand leads the robot by its arm."""

from __future__ import annotations

from typing import Any

import numpy as np

from plantar.plotting import COLOURS, new_figure
from plantar.recordings.recording import Recording
from plantar.sides import SIDES

__all__ = ["draw_guide"]

_HAND = "#7b5ea7"
_CARRIES = 0.05  # of the largest force on a foot, from which it is drawn as standing
_TURNED = 1.0  # degrees that a joint has to turn by to be named


def draw_guide(run: Recording) -> Any:
    """Figure of hand, arm, CoM and feet along the hand's way, the force between them, and the arm's joints.

    The `run` is a recording with "/guide" and "/arm".
    """
    figure, axes = new_figure(11.0, 8.0, 3, 1, sharex=True)
    guide, body = run.topics["/guide"], run.topics["/truth/body"]
    place, held = guide.fields["place"][:, 0], guide.fields["held"][:, 0]
    com = body.fields["com"][:, 0]
    axes[0].plot(guide.time, place - place[0], color=_HAND, lw=1.6, label="hand")
    axes[0].plot(guide.time, held - held[0], color=COLOURS["active"], lw=1.0, label="forearm")
    axes[0].plot(body.time, com - com[0], color=COLOURS["polygon"], lw=1.2, label="CoM")
    for side in SIDES:
        foot = run.topics[f"/truth/{side}"]
        force = foot.fields["normal_force"][:, 0]
        x = np.array(foot.fields["position"][:, 0], dtype=float)
        stands = np.where(force < _CARRIES * force.max(), np.nan, x - x[0])
        axes[0].plot(foot.time, stands, color=COLOURS[side], lw=2.5, alpha=0.7, label=f"{side} foot")
    axes[0].set_ylabel("from the start, x [m]")
    axes[0].legend(ncol=5, fontsize=8, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    touch = run.topics["/touch"]
    measured = touch.fields["felt"][:, :2]
    for i, name in enumerate(("x (forward)", "y (left)")):
        colour = COLOURS["cop"] if i == 0 else COLOURS["left"]
        axes[1].plot(touch.time, measured[:, i], color=colour, lw=1.4, alpha=0.6, label=f"measured, {name}")
        axes[1].plot(touch.time, touch.fields["force"][:, i], color=COLOURS["truth"], lw=0.5)
    axes[1].set_ylabel("force on the arm [N]\n(thin: true)")
    axes[1].legend(ncol=2, fontsize=8)
    arm = run.topics["/arm"]
    turned = np.degrees(arm.fields["position"] - arm.fields["posture"])
    for k in np.flatnonzero(np.abs(turned).max(axis=0) > _TURNED).tolist():
        axes[2].plot(arm.time, turned[:, k], lw=1.0, label=f"joint {k + 1}")
    axes[2].set_ylabel("arm, out of its posture [deg]")
    axes[2].set_xlabel("time [s]")
    if axes[2].lines:
        axes[2].legend(ncol=7, fontsize=8, title="from the shoulder", title_fontsize=8)
    for axis in axes:
        axis.grid(alpha=0.3)
    return figure
