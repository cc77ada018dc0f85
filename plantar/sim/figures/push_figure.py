"""Figures of pushes and a partner after K's Fig. 7, 8, 10, 13 and 14, and of a guide."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.gait.plan.phases import PhaseKind
from plantar.plotting import COLOURS, new_figure
from plantar.recordings.pressure_recording import true_runs
from plantar.recordings.recording import Recording
from plantar.sim.figures.foothold_figure import sole_outline

_PUSHED = 0.01  # of the largest force: less is no push
_AXES = ("x (forward)", "y (left)")
_PARTNER = "#7b5ea7"
_STEPS_A_PANEL = 6


def draw_pushes(run: Recording) -> Any:
    """Figure of CoM, DCM, VRP, ZMP, footsteps and skin force over time (K Fig. 7, 14), from "/touch"."""
    figure, axes = new_figure(11.0, 7.0, 2, 1, grid=True, sharex=True)
    time = run.topics["/truth/body"].time
    for i, axis in enumerate(axes):
        axis.plot(time, run.values("/truth/body", "zmp")[:, i], color=COLOURS["truth"], lw=0.5, label="ZMP")
        plan = run.topics["/reference"]  # whose ZMP is the VRP: it knows of no push
        axis.plot(plan.time, plan.fields["zmp"][:, i], "--", color=COLOURS["reference"], lw=1.0, label="VRP, planned")
        _draw_body(axis, run, i)
        _draw_force(axis, run, i)
    _name(axes, [f"{name} [m]" for name in _AXES])
    return figure


def draw_swing(run: Recording) -> Any:
    """Figure of the swing foot's commanded and true path (K Fig. 8), from "/touch"."""
    figure, axes = new_figure(11.0, 8.0, 3, 1, grid=True, sharex=True)
    for side in SIDES:
        true = run.topics[f"/truth/{side}"]
        for i, axis in enumerate(axes):
            axis.plot(true.time, true.fields["position"][:, i], color=COLOURS[side], lw=1.4, label=f"{side}, true")
            wanted = run.topics["/feet"]
            axis.plot(wanted.time, wanted.fields[side][:, i], "--", color="black", lw=0.7, label=f"{side}, commanded")
    for axis in axes:
        for begin, end in _pushed_spans(run):
            axis.axvspan(begin, end, color=COLOURS["active"], alpha=0.25, lw=0)
    _name(axes, [f"{name} [m]" for name in (*_AXES, "z (up)")])
    return figure


def draw_partner(run: Recording) -> Any:
    """Figure of robot and partner: ways, force, support durations (K Fig. 10), from "/partner"."""
    figure, axes = new_figure(11.0, 8.0, 3, 1, grid=True, sharex=True)
    _draw_body(axes[0], run, 0)
    partner = run.topics["/partner"]
    axes[1].plot(partner.time, -partner.fields["moved"][:, 0], color=_PARTNER, label="partner")
    axes[1].plot(partner.time, -partner.fields["reference"][:, 0], "--", color=COLOURS["reference"], label="reference")
    axes[1].legend(ncol=2, fontsize=8, loc="upper left")
    force = axes[1].twinx()
    force.fill_between(partner.time, partner.fields["force"][:, 0], color=COLOURS["active"], alpha=0.4, lw=0)
    force.set_ylabel("force on its hand [N]")
    for kind, name, mark in ((PhaseKind.SINGLE_SUPPORT, "SSP", "o"), (PhaseKind.DOUBLE_SUPPORT, "DSP", "s")):
        begins, lasts = _durations(run, kind)
        axes[2].plot(begins, lasts, mark, ms=5, label=name)
    axes[2].legend(ncol=2, fontsize=8)
    _name(axes, ("robot, x [m]", "partner, x [m]", "duration [s]"))
    return figure


def draw_strides(run: Recording) -> Any:
    """Figure of CoM path and footholds from above, with body forces (K Fig. 13), from "/touch"."""
    step = run.values("/reference", "step")[:, 0]
    rounds = (int(step.max()) + 1) // _STEPS_A_PANEL
    columns = max(1, min(rounds, 4))
    rows = max(1, -(-rounds // columns))
    shared: dict[str, bool] = {"squeeze": False, "sharex": True, "sharey": True}
    figure, axes = new_figure(3.4 * columns, 5.2 * rows, rows, columns, **shared)
    time = run.topics["/truth/body"].time
    com = run.values("/truth/body", "com")[:, :2]
    force = run.values("/touch", "force")[:, :2]
    when = run.topics["/touch"].time
    largest = float(np.linalg.norm(force, axis=1).max(initial=0.0))
    for k, axis in enumerate(axes.ravel()[:rounds]):
        chosen = (step >= k * _STEPS_A_PANEL) & (step < (k + 1) * _STEPS_A_PANEL)
        begin = time[chosen][0]
        end = time[chosen][-1]
        for side in SIDES:
            _draw_footholds(axis, run, side, begin, end)
        axis.plot(com[chosen, 1], com[chosen, 0], color=COLOURS["polygon"], lw=1.4, label="CoM")
        pushed = np.flatnonzero((when >= begin) & (when <= end) & (np.linalg.norm(force, axis=1) > 0.2 * largest))
        for i in pushed[::10]:
            x, y = com[np.searchsorted(time, when[i])]
            dx, dy = 0.12 * force[i] / largest
            axis.annotate("", (y, x), (y - dy, x - dx), arrowprops={"arrowstyle": "-|>", "color": COLOURS["active"]})
        axis.set_title(f"steps {k * _STEPS_A_PANEL} to {(k + 1) * _STEPS_A_PANEL - 1}", fontsize=9)
        axis.set(aspect="equal", xlabel="y (left) [m]")
        axis.grid(alpha=0.3)
    axes[0, 0].invert_xaxis()  # left is to the left
    axes[0, 0].set_ylabel("x (forward) [m]")
    return figure


def _draw_body(axis: Any, run: Recording, i: int) -> None:
    time = run.topics["/truth/body"].time
    axis.plot(time, run.values("/estimate", "dcm")[:, i], color=COLOURS["active"], lw=1.0, label="DCM")
    axis.plot(time, run.values("/truth/body", "com")[:, i], color=COLOURS["polygon"], lw=1.4, label="CoM")
    for side in SIDES:
        axis.plot(time, _standing(run, side)[:, i], color=COLOURS[side], lw=2.5, alpha=0.7, label=f"{side} foot")


def _name(axes: Any, names: Sequence[str], columns: int = 6) -> None:
    """Name axes over time, with a legend of some columns above the first ones."""
    for axis, name in zip(axes, names, strict=True):
        axis.set_ylabel(name)
    axes[0].legend(ncol=columns, fontsize=8, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    axes[-1].set_xlabel("time [s]")


def _draw_footholds(axis: Any, run: Recording, side: Any, begin: float, end: float) -> None:
    topic = run.topics[f"/truth/{side}"]
    force = topic.fields["normal_force"][:, 0]
    for first, last in true_runs(force > 0.4 * force.max()):
        i = (first + last) // 2
        if begin <= topic.time[i] <= end:
            x, y = sole_outline(run, side, i).T
            axis.plot([*y, y[0]], [*x, x[0]], color=COLOURS[side], lw=0.9)


def _draw_force(axis: Any, run: Recording, i: int) -> None:
    touch = run.topics["/touch"]
    other = axis.twinx()
    other.fill_between(touch.time, touch.fields["felt"][:, i], color=COLOURS["active"], alpha=0.45, lw=0)
    other.plot(touch.time, touch.fields["force"][:, i], color=COLOURS["right"], lw=0.5)
    largest = max(1.0, float(np.abs(touch.fields["force"]).max(initial=0.0)))
    other.set_ylim(-2.5 * largest, 2.5 * largest)
    other.set_ylabel("force on the skin, measured [N]\n(line: true)", fontsize=8)


def _pushed_spans(run: Recording) -> list[tuple[float, float]]:
    touch = run.topics["/touch"]
    force = np.linalg.norm(touch.fields["force"], axis=1)
    on = force > _PUSHED * max(float(force.max(initial=0.0)), 1e-9)
    return [(float(touch.time[a]), float(touch.time[b - 1])) for a, b in true_runs(on)]


def _standing(run: Recording, side: Any) -> NDArray[np.float64]:
    """Where a foot is (n, 2) in m while it stands, else NaN."""
    topic = run.topics[f"/truth/{side}"]
    force = topic.fields["normal_force"][:, 0]
    place = np.array(topic.fields["position"][:, :2], dtype=float)
    place[force < 0.05 * force.max()] = np.nan
    return place


def _durations(run: Recording, kind: PhaseKind) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    topic = run.topics["/reference"]
    phases = topic.fields["phase"][:, 0]
    starts = np.flatnonzero(np.diff(phases, prepend=-1.0))
    ends = np.append(topic.time[starts[1:]], topic.time[-1])
    chosen = phases[starts] == kind
    return topic.time[starts][chosen], (ends - topic.time[starts])[chosen]


_TURNED = 1.0  # degrees that a joint has to turn by to be named


def draw_guide(run: Recording) -> Any:
    """Figure of hand, arm, CoM and feet along the hand's way, force, and arm joints.

    The `run` is a recording with "/guide" and "/arm".
    """
    figure, axes = new_figure(11.0, 8.0, 3, 1, grid=True, sharex=True)
    guide = run.topics["/guide"]
    body = run.topics["/truth/body"]
    place = guide.fields["place"][:, 0]
    held = guide.fields["held"][:, 0]
    com = body.fields["com"][:, 0]
    axes[0].plot(guide.time, place - place[0], color=_PARTNER, lw=1.6, label="hand")
    axes[0].plot(guide.time, held - held[0], color=COLOURS["active"], lw=1.0, label="forearm")
    axes[0].plot(body.time, com - com[0], color=COLOURS["polygon"], lw=1.2, label="CoM")
    for side in SIDES:
        foot = run.topics[f"/truth/{side}"]
        moved = _standing(run, side)[:, 0] - foot.fields["position"][0, 0]
        axes[0].plot(foot.time, moved, color=COLOURS[side], lw=2.5, alpha=0.7, label=f"{side} foot")
    touch = run.topics["/touch"]
    measured = touch.fields["felt"][:, :2]
    for i, name in enumerate(_AXES):
        colour = COLOURS["cop"] if i == 0 else COLOURS["left"]
        axes[1].plot(touch.time, measured[:, i], color=colour, lw=1.4, alpha=0.6, label=f"measured, {name}")
        axes[1].plot(touch.time, touch.fields["force"][:, i], color=COLOURS["truth"], lw=0.5)
    axes[1].legend(ncol=2, fontsize=8)
    arm = run.topics["/arm"]
    turned = np.degrees(arm.fields["position"] - arm.fields["posture"])
    for k in np.flatnonzero(np.abs(turned).max(axis=0) > _TURNED).tolist():
        axes[2].plot(arm.time, turned[:, k], lw=1.0, label=f"joint {k + 1}")
    if axes[2].lines:
        axes[2].legend(ncol=7, fontsize=8, title="from the shoulder", title_fontsize=8)
    names = ("from the start, x [m]", "force on the arm [N]\n(thin: true)", "arm, out of its posture [deg]")
    _name(axes, names, columns=5)
    return figure
