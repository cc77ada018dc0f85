"""The largest push that robots survive in each direction and phase of a step, and what any controller could capture.

`python benchmarks/outcomes.py MINUTES survival_map`: hands push with a half sine of 0.1 s at the height of the CoM, in
8 directions at 8 phases of a step, in place and walking. Each cell is bisected over impulses of 5 to 60 N s, first with
85 % of the bound. The bound is `benchmarks/capture_limit.py` with the controller's own limits: region and acceleration
of the swing foot, times of a step, and the soles, or what ankles reach of them. Where the 85 % fail with a joint at its
torque limit, the run is repeated with that joint's motor four times as strong, and if that fails, too, with all motors.
"""

import functools
import math
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import gettempdir
from typing import Any, NamedTuple

import numpy as np
from resumable import FOLDER, Benchmark, Case, latest, origin, rows_of, write_table

from plantar.bench.tables import markdown_table

DIRECTIONS = tuple(range(0, 360, 45))
PHASES = tuple(k / 8 for k in range(8))
IMPULSES = tuple(float(v) for v in np.arange(5.0, 60.1, 2.5))
SHARE = 0.85
STEP, STEPS, SEED = 4, 10, 1000
ALL = "all joints"
SPEEDS = {"in place": 0.0, "0.1 m/s": 0.1, "0.2 m/s": 0.2}
MAPS = ("as it is", "hrp2kai")
"""Variants whose motors are lifted where they end a push."""
VARIANTS: dict[str, tuple[str, ...]] = {
    "as it is": (),
    "hrp2kai": (),
    "feet lift on time": ("control.step_timing=false",),
    "no lean": ("lean=false",),
    "ankle only": ("control.step_adjustment=false", "control.step_timing=false"),
    "feedback off": ("control.step_adjustment=false", "control.step_timing=false", "feedback=false"),
    "push measured by the skin": ("control.push_estimate=skin",),
    "push not estimated": ("control.push_estimate=off",),
}


class Cell(NamedTuple):
    """A cell of the map: variant, walk, direction in degrees, and phase of the step."""

    variant: str
    walk: str
    angle: int
    phase: float

    @property
    def robot(self) -> str:
        """Robot that is pushed."""
        return "hrp2kai" if self.variant == "hrp2kai" else "h1"

    def name(self, impulse: float, lifted: str = "") -> str:
        """Name of its run with an impulse in N s, and with a joint's stronger motor."""
        rest = f", {lifted} lifted" if lifted else ""
        return f"{self.variant}, {self.walk}, {self.angle} deg, {self.phase:.3f}, {impulse:g} N s{rest}"


def walks(variant: str) -> tuple[str, str]:
    """In place and walking: at 0.2 m/s hrp2kai's steps of 0.38 m fall without a push."""
    return "in place", "0.1 m/s" if variant == "hrp2kai" else "0.2 m/s"


CELLS = [Cell(v, w, a, p) for v in VARIANTS for w in walks(v) for a in DIRECTIONS for p in PHASES]


@functools.lru_cache
def simulation(robot: str) -> Any:
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    return Simulation(load_scene("push-step", ["push.impulse=0", "push.small=0", "outcome=none"], robot), 0)


def settings(cell: Cell, impulse: float) -> tuple[str, ...]:
    """Settings of a cell's run: the push falls into step 4, counted in strides from the single support before."""
    timing = simulation(cell.robot).settings.timing
    single, whole = timing.single_support, timing.single_support + timing.double_support
    cycle = (single + cell.phase * whole) / (2.0 * whole)
    return (
        "push.small=0",
        "outcome=none",
        "direction=angle",
        "push.with_swing=false",
        "push.duration=0.1",
        f"walk.steps={STEPS}",
        f"walk.length={SPEEDS[cell.walk] * whole}",
        "walk.settle=1",
        f"push.angle={cell.angle}",
        f"push.step={STEP - 1}",
        f"push.cycle={cycle}",
        f"push.impulse={impulse}",
        *VARIANTS[cell.variant],
    )


@functools.lru_cache
def bounds(walk: str, robot: str, ankles: bool = False) -> dict[tuple[int, float], float]:
    """The largest push in N s that any footsteps, timing and ZMP (that `ankles` reach) capture, by direction, phase."""
    from capture_limit import CaptureLimits
    from periodic_walk import PeriodicWalk, capture_map

    from plantar.gait.contact.ankle_limits import AnkleLimits
    from plantar.gait.propose.ssp_opt import footstep_region, touching_distance
    from plantar.mechanics.lip import pendulum_frequency

    known = simulation(robot)
    chosen, robot = known.settings, known.robot
    rules, timing = chosen.step_adjustment, chosen.timing
    touching = touching_distance({side: layout.outline for side, layout in robot.layouts.items()})
    omega = float(pendulum_frequency(chosen.com_height))
    single, double = timing.single_support, timing.double_support
    sole = robot.layouts["left"].outline
    leg = chosen.standing_legs.get("left")
    limits = CaptureLimits(
        mass=chosen.mass,
        omega=omega,
        sole=AnkleLimits(chosen.ankle_limits["left"], 0.0, leg).within(sole) if ankles else sole,
        region=footstep_region(chosen.step_region, "left", (0.0, 0.0, 0.0), touching),
        shortest=(1.0 - rules.shortest) * single,
        longest=(1.0 + rules.longest) * single,
        double_support=double,
        swing_acceleration=rules.acceleration,
        swing_sideways=rules.sideways,
        landing=rules.least_left,
        lasts=0.1,
        times=6,
    )
    zmp = known.controller.middles["left"]
    length = SPEEDS[walk] * (single + double)
    plan = PeriodicWalk(omega, length, robot.stance_width, single, double, (float(zmp[0]), float(zmp[1])))
    found = capture_map(limits, plan, len(DIRECTIONS), len(PHASES), side="right")
    return {(a, p): float(found[j, i]) for i, a in enumerate(DIRECTIONS) for j, p in enumerate(PHASES)}


def first_push(out: dict[str, Any]) -> dict[str, Any] | None:
    return next(iter(out.get("push", {}).get("pushes", [])), None)


def delivered(simulation: Any, out: dict[str, Any]) -> float | str:
    """Horizontal impulse in N s that the hands delivered."""
    push = first_push(out)
    return "" if push is None else round(math.hypot(*push["delivered_Ns"][:2]), 2)


def most_held(simulation: Any, out: dict[str, Any]) -> str:
    """The joint that was longest at its torque limit."""
    held = out["torque_limit"]["joints"]
    return max(held, key=held.get, default="")


COLUMNS = {"impulse_Ns": "push.impulse_Ns", "delivered_Ns": delivered, "fell": "fell", "most_held": most_held}
BENCHMARK = Benchmark("survival_map", COLUMNS, ())


def goal(cell: Cell) -> float:
    """What has to be survived in N s: 85 % of the bound, on the grid of impulses."""
    wanted = SHARE * bounds(cell.walk, cell.robot)[cell.angle, cell.phase]
    return min((v for v in IMPULSES if v >= wanted - 1e-9), default=IMPULSES[-1])


def outcomes(rows: Sequence[dict[str, str]]) -> dict[str, tuple[bool, str]]:
    """Whether each run was survived, and which joint was most at its torque limit, by the run's name."""
    return {r["case"]: (r["fell"] == "False", r["most_held"]) for r in latest(rows)}


def survived(cell: Cell, known: dict[str, tuple[bool, str]]) -> tuple[float, float]:
    """The largest impulse that is survived, 0 for none, and the smallest one above it that is not, in N s."""
    tried = [(v, known[cell.name(v)][0]) for v in IMPULSES if cell.name(v) in known]
    failed = min((v for v, good in tried if not good), default=math.inf)
    return max((v for v, good in tried if good and v < failed), default=0.0), failed


def following(cell: Cell, known: dict[str, tuple[bool, str]]) -> Case | None:
    """The next run of a cell, or None."""

    def case(impulse: float, lifted: str = "") -> Case:
        file = str(stronger(lifted, cell.robot)) if lifted else ""
        return Case(cell.name(impulse, lifted), "push-step", cell.robot, settings(cell, impulse), 0, file=file)

    first = goal(cell)
    if cell.name(first) not in known:
        return case(first)
    good, held = known[cell.name(first)]
    if not good and held and cell.variant in MAPS:
        for lifted in (held, ALL):
            if cell.name(first, lifted) not in known:
                return case(first, lifted)
            if known[cell.name(first, lifted)][0]:
                break
    low, high = survived(cell, known)
    open_ones = [v for v in IMPULSES if low < v < high]
    return case(open_ones[len(open_ones) // 2]) if open_ones else None


def stronger(joint: str, robot: str) -> Path:
    """File of a robot whose motors of one kind, or all, are four times as strong."""
    from plantar.robots.robot_file import load_robot

    kinds = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
    kind = "all" if joint == ALL else joint.split("_", 1)[1]
    source = load_robot(robot).path
    folder = Path(gettempdir()) / f"plantar_{robot}_{kind}"
    if not folder.exists():
        shutil.copytree(source.parent, folder)
        lines = source.read_text(encoding="utf-8").splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith("effort_limits"))
        limits = [float(v) for v in lines[at].partition("[")[2].partition("]")[0].split(",")]
        limits = [4.0 * v if kind in ("all", name) else v for name, v in zip(kinds, limits, strict=True)]
        lines[at] = f"effort_limits = {limits}"
        (folder / "robot.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder / "robot.toml"


def missing() -> Iterator[tuple[int, Case, tuple[str, int]]]:
    """The next run of each cell, cells of the same rank in turn: goals first, the comparisons last."""
    known = outcomes(rows_of(BENCHMARK.path))
    for i, cell in enumerate(CELLS):
        case = following(cell, known)
        if case is not None:
            begun = sum(cell.name(v) in known for v in IMPULSES)
            yield 10000 * (cell.variant not in MAPS) + 1000 * begun + i * 37 % 128, case, ("exact", SEED)


def report() -> None:
    from plantar.plotting import new_figure, save_figure

    rows = rows_of(BENCHMARK.path)
    known = outcomes(rows)
    lines = []
    head = (
        "variant",
        "walk",
        "cells at 85 % of the bound",
        "of those within the joints' torques",
        "median share of the bound",
        "of the others, at 85 % with motors four times as strong",
        "joints that end it",
    )
    figure, axes = new_figure(11.0, 4.5, 1, 2)
    for variant in VARIANTS:
        for axis, walk in zip(axes, walks(variant), strict=True):
            cells = [c for c in CELLS if (c.variant, c.walk) == (variant, walk) and c.name(goal(c)) in known]
            if not cells:
                continue
            # Where the goal was missed and nothing smaller was tried yet, nothing is known.
            asked = [c for c in cells if survived(c, known)[0] > 0.0 or following(c, known) is None]
            shares = [survived(c, known)[0] / bounds(walk, c.robot)[c.angle, c.phase] for c in asked]
            reached = [known[c.name(goal(c))][0] for c in cells]
            able = bounds(walk, cells[0].robot, ankles=True)
            can = [good for c, good in zip(cells, reached, strict=True) if goal(c) <= able[c.angle, c.phase]]
            held: dict[str, list[bool | None]] = {}
            strong: list[bool] = []
            for c in cells:
                good, joint = known[c.name(goal(c))]
                if not good and joint:
                    held.setdefault(joint, []).append(known.get(c.name(goal(c), joint), (None,))[0])
                    lifted = [known[c.name(goal(c), j)][0] for j in (joint, ALL) if c.name(goal(c), j) in known]
                    strong += [any(lifted)] if any(lifted) or len(lifted) == 2 else []
            middle = f"{np.median(shares):.2f} of {len(asked)}" if asked else "-"
            ended_by = ", ".join(
                f"{joint} {len(alone)}" + f" (lifted {alone.count(True)} of {tried})" * (tried > 0)
                for joint, alone in sorted(held.items(), key=lambda item: -len(item[1]))
                for tried in (len(alone) - alone.count(None),)
            )
            saved = f"{sum(strong)} of {len(strong)}" if strong else "-"
            lines.append(
                (
                    variant,
                    walk,
                    f"{sum(reached)} of {len(cells)}",
                    f"{sum(can)} of {len(can)}",
                    middle,
                    saved,
                    ended_by or "-",
                )
            )
            if variant == "as it is":
                missed = {(c.angle, c.phase) for c, good in zip(cells, reached, strict=True) if not good}
                known_shares = {(c.angle, c.phase): s for c, s in zip(asked, shares, strict=True)}
                figure.colorbar(draw(axis, walk, known_shares, missed), ax=axis, shrink=0.8)
    save_figure(figure, FOLDER / "survival_map.png")
    write_table(FOLDER / "survival_map.md", [markdown_table(head, lines), "", origin(BENCHMARK)])


def draw(axis: Any, walk: str, shares: dict[tuple[int, float], float], missed: set[tuple[int, float]]) -> Any:
    """Draw one walk's map: direction across, phase upwards, colour by the share of the bound, an x where 85 % fail."""
    values = np.array([[shares.get((a, p), math.nan) for a in DIRECTIONS] for p in PHASES])
    mesh = axis.imshow(values, cmap="RdYlGn", vmin=0.0, vmax=1.2, origin="lower", aspect="auto")
    axis.set_facecolor("#dddddd")
    axis.set_xticks(range(len(DIRECTIONS)), [f"{a}" for a in DIRECTIONS], fontsize=8)
    axis.set_yticks(range(len(PHASES)), [f"{p:g}" for p in PHASES], fontsize=8)
    axis.set(xlabel="direction [deg], 0 forward, 90 left", ylabel="phase of the step, left foot swings")
    axis.set_title(f"{walk}: largest survived push over the bound", fontsize=9)
    for i, angle in enumerate(DIRECTIONS):
        for j, phase in enumerate(PHASES):
            share = shares.get((angle, phase))
            words = ("" if share is None else f"{share:.2f}") + (" x" if (angle, phase) in missed else "")
            axis.text(i, j, words, ha="center", va="center", fontsize=7)
    return mesh
