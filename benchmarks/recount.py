"""Count outcomes anew from MuJoCo's own contacts: `python benchmarks/recount.py RUNS`.

Draws scene, robot, plant, seed, a part of the controller that is switched off and an attack by lot, watches the run
without anything of `plantar.sim.judging`, and compares which criteria fail with those that the run's summary names. A
row of recount.csv a run, appended as it ends; runs that are there are not made again. `... report` writes the page.

Forces are those of `mj_contactForce` at every physics step. A foot stands from a quarter of the weight on; the last
stand before the other foot's next one is its step. A step is taken where that stand is within a twelfth of the leg and
5 degrees of where the plan puts it from the stand before, or, on ground that is not level or after a push, of where the
controller said before it landed that it would be.
"""

import math
import random
import sys
from collections import Counter
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import shapely
from resumable import append_row, commit, rows_of, write_table

from plantar.common.sides import SIDES
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

FILE = Path(__file__).with_suffix(".csv")
PAGE = FILE.with_suffix(".md")
COLUMNS = ("lot", "scene", "robot", "seed", "settings", "attack", "completed", "judged", "recounted", "commit")

SHORT = {
    "flat": "steps=4",
    "beam": "steps=6",
    "stones": "steps=6",
    "uneven": "steps=6",
    "slopes": "steps=8",
    "pebbles": "steps=6",
    "mixed": "steps=8",
    "stairs": "steps=8",
    "push": "steps=6",
    "partial-front": "settle=0.3",
    "partial-rear": "settle=0.3",
    "partial-inner": "settle=0.3",
    "partial-outer": "settle=0.3",
    "obstacle": "settle=0.3",
    "tilt": "settle=0.3",
    "slide-in": "settle=0.3",
    "feasibility-1": "settle=0.3",
    "feasibility-2": "settle=0.3",
    "feasibility-3": "settle=0.3",
    "feasibility-4": "settle=0.3",
}
"""Scenes of one walk each, and what makes those shorter that can be."""

OFF = ("", "", "", "pfc=false footholds=off", "feasibility=off", "feedback=false", "step_adjustment=false")
ATTACKS = ("", "", "", "", "lifted", "lighter", "held", "ice")


def attack(simulation: Simulation, name: str) -> None:
    """What a policy that finds the simulation can do to it, at every tick."""
    data = simulation.world.data
    model = simulation.world.model
    if name == "lifted":
        data.xfrc_applied[simulation.world.torso, 2] = 5.0
    elif name == "held":
        data.qfrc_applied[simulation.world.joint_qvel[3]] = 1.0
    elif name == "lighter":
        model.opt.gravity[2] = -8.5
    elif name == "ice":
        model.geom_friction[:, 0] = 1e-3
        model.geom_priority[:] = 1


@dataclass
class Kept:
    """What is kept of each physics step.

    `loads`: vertical force in N on the left and right sole; `pieces`: on each piece of ground; `states`: CoM (3,), the
    torso's cosine of tilt and heading, then of each sole x, y, z and heading; `outside`: largest force or torque that
    no push of the scene explains; `pushed`: impulse (3,) in N s; `others`, `legs`: steps in which another part of the
    robot is on the ground, and in which the legs touch; `moved`: times and footsteps that the controller moved.
    """

    loads: list[tuple[float, float]] = field(default_factory=list)
    pieces: list[Counter[int]] = field(default_factory=list)
    states: list[tuple[float, ...]] = field(default_factory=list)
    torques: list[np.ndarray] = field(default_factory=list)
    speeds: list[np.ndarray] = field(default_factory=list)
    outside: float = 0.0
    pushed: np.ndarray = field(default_factory=lambda: np.zeros(3))
    others: int = 0
    legs: int = 0
    moved: list[tuple[float, Any]] = field(default_factory=list)


class Recounted(Simulation):
    """A run of which each physics step is looked at with MuJoCo alone."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        model = self.world.model
        self.kept = Kept()
        root = model.body_rootid[self.world.torso]
        self._robot = model.body_rootid[model.geom_bodyid] == root
        self._soles = [set(self.world.sole_geoms[side]) for side in SIDES]
        self._dofs = np.flatnonzero(model.body_rootid[model.dof_bodyid] == root)
        self._side = {}
        for geom in range(model.ngeom):
            body = int(model.geom_bodyid[geom])
            while body and not self._side.get(geom):
                name = model.body(body).name
                self._side[geom] = next((s for s in SIDES if name.startswith(s)), "")
                body = int(model.body_parentid[body])
        step = self.controller.step

        def watched(sensors: Any) -> Any:
            command = step(sensors)
            self.kept.moved += [(sensors.time, m) for m in command.moved_steps]
            return command

        self.controller.step = watched

    def step_physics(self) -> None:
        world = self.world
        data = world.data
        applied = data.xfrc_applied.copy()
        joints = data.qfrc_applied[self._dofs].copy()
        super().step_physics()
        loads = [0.0, 0.0]
        pieces: Counter[int] = Counter()
        others = False
        legs = False
        force = np.zeros(6)
        for i, (a, b) in enumerate(data.contact.geom.tolist()):
            own = [g for g in (a, b) if self._robot[g]]
            if len(own) == 2:
                legs = legs or {self._side[a], self._side[b]} == set(SIDES)
                continue
            if not own:
                continue
            foot = next((k for k in range(2) if own[0] in self._soles[k]), None)
            if foot is None:
                others = True
                continue
            mujoco.mj_contactForce(world.model, data, i, force)
            up = float(force[:3] @ data.contact.frame[i].reshape(3, 3)[:, 2]) * (1.0 if b == own[0] else -1.0)
            loads[foot] += up
            name = world.model.geom(a if b == own[0] else b).name.removesuffix("_corners")
            if name.startswith("ground_"):
                pieces[int(name.removeprefix("ground_"))] += up
        self.kept.loads.append((loads[0], loads[1]))
        self.kept.pieces.append(pieces)
        self.kept.others += others
        self.kept.legs += legs
        pushes = applied[world.torso, :3].copy()
        if self.scene.push.strength > 0.0:
            self.kept.pushed += world.period * pushes
            applied[world.torso] = 0.0
        self.kept.outside = max(self.kept.outside, float(np.abs(applied).max()), float(np.abs(joints).max()))
        turned = data.xmat[world.torso]
        state = [*data.subtree_com[world.torso], turned[8], math.atan2(turned[3], turned[0])]
        for side in SIDES:
            site = world.sole_sites[side]
            state += [*data.site_xpos[site], math.atan2(data.site_xmat[site][3], data.site_xmat[site][0])]
        self.kept.states.append(tuple(state))
        self.kept.torques.append(data.actuator_force[world.servos].copy())
        self.kept.speeds.append(data.qvel[world.joint_qvel].copy())


def recount(run: Recounted) -> set[str]:
    """Criteria that a finished run fails, by what was kept of it."""
    world = run.world
    weight = world.body.weight
    beat = world.body.beat
    leg = world.body.leg
    period = world.period
    loads = np.array(run.kept.loads)
    states = np.array(run.kept.states)
    failed: set[str] = set()
    lower = np.minimum(states[:, 7], states[:, 11])
    standing = 0.6 * run.settings.com_height
    if states[:, 3].min() < math.cos(math.radians(40.0)) or (states[:, 2] - lower).min() < standing:
        failed.add("fall")
    landings = []
    for foot in range(2):
        steps = np.flatnonzero(loads[:, foot] >= 0.0237 * weight)
        gaps = np.diff(steps, prepend=-1)
        landings += [(int(k), foot) for k, gap in zip(steps, gaps, strict=True) if gap > round(0.607 * beat / period)]
    landings.sort()
    impacts = [loads[k : k + round(0.202 * beat / period) + 1, foot].max() / weight for k, foot in landings]
    hardest = max(impacts, default=0.0)
    level = all(s.shape == "box" and s.rotation[2, 2] > 0.9999 and not s.motions for s in run.ground.solids)
    level = level and all(abs(s.top - run.scene.terrain.height) < 1e-6 for s in run.ground.solids)
    if hardest > (1.0 if level else 1.5):
        failed.add("impact")
    torques = np.abs(np.array(run.kept.torques))
    if (torques >= 0.999 * world.model.actuator_forcerange[world.servos, 1]).any(axis=1).mean() > 0.1:
        failed.add("torque_limit")
    fast = np.abs(np.array(run.kept.speeds)) > np.array([*run.robot.velocity_limits] * 2)
    if max(_longest(fast[:, k]) for k in range(fast.shape[1])) * period > 0.02 + 1e-9:
        failed.add("joint_speed")
    if run.kept.others:
        failed.add("ground_contact")
    if run.kept.legs:
        failed.add("collision")
    strength = run.scene.push.strength
    if run.kept.outside > 1e-9 or (strength > 0.0 and np.linalg.norm(run.kept.pushed) > 1.01 * strength):
        failed.add("outside_force")
    if _ripple(loads, states, landings, weight, period, world) > 0.02 and "fall" not in failed:
        failed.add("stance_force")
    stands = _stands(loads, states, weight)
    taken = _taken(run, stands)
    if taken < len(run.steps):
        failed.add("steps")
    failed |= _ending(run, stands, taken, states[-1], leg)
    failed |= _experiment(run, hardest, loads, weight)
    if run.controller.safe_state is not None:
        failed.add("emergency_stop")
    return failed


def _longest(on: np.ndarray) -> int:
    return max((len(list(g)) for held, g in groupby(on.tolist()) if held), default=0)


def _ripple(
    loads: np.ndarray, states: np.ndarray, landings: list[tuple[int, int]], weight: float, period: float, world: Any
) -> float:
    """RMS of the ground's force less m (g + z'') in single support, 0.1 s after landings on, over the weight."""
    touching = loads >= 0.0237 * weight
    counts = touching.sum(axis=1) == 1
    for k, _ in landings:
        counts[k : k + round(0.1 / period)] = False
    span = round(0.01 / period)
    mass = float(world.model.body_subtreemass[world.torso])
    gravity = 9.81
    height = states[:, 2]
    off = []
    for k in range(span, len(loads) - span):
        if counts[k - span : k + span + 1].all():
            rise = (height[k + span] - 2.0 * height[k] + height[k - span]) / (span * period) ** 2
            off.append(loads[k].sum() / (mass * gravity) - 1.0 - rise / gravity)
    return float(np.sqrt(np.mean(np.square(off)))) if off else 0.0


Stand = tuple[int, int, tuple[float, float, float]]
"""Foot, physics step of its touchdown, and place: x, y in m and heading in rad when it last carried a quarter."""


def _stands(loads: np.ndarray, states: np.ndarray, weight: float) -> list[Stand]:
    """Each foot's last stand before the other's next one, from its first landing on."""
    found: list[tuple[int, int, int]] = []
    for foot in range(2):
        touching = loads[:, foot] >= 0.0237 * weight
        at = 0
        for on, group in groupby(touching.tolist()):
            size = len(list(group))
            carried = np.flatnonzero(loads[at : at + size, foot] >= 0.25 * weight)
            if on and at > 0 and len(carried):
                found.append((at + int(carried[0]), at + int(carried[-1]), foot))
            at += size
    found.sort()
    merged: list[Stand] = []
    for begin, last, foot in found:
        x, y, _, yaw = states[last, 5 + 4 * foot : 9 + 4 * foot]
        if merged and merged[-1][0] == foot:
            merged[-1] = (foot, begin, (x, y, yaw))  # a probe came before
        else:
            merged.append((foot, begin, (x, y, yaw)))
    return merged


def _taken(run: Recounted, stands: list[Stand]) -> int:
    """Steps that were taken in order."""
    places = {side: (f.x, f.y, f.yaw) for side, f in run.feet.items()}
    steps = [(SIDES.index(s.side), (s.x, s.y, s.yaw)) for s in run.steps]
    planned_before = places[SIDES[1 - steps[0][0]]]
    true_before = planned_before
    period = run.world.period
    plain = run.scene.push.strength <= 0.0 and not run.ground.solids
    taken = 0
    landed = 0.0
    for foot, begin, place in stands:
        if taken == len(steps):
            break
        side, planned = steps[taken]
        if foot != side:
            continue
        wanted = [_way(planned_before, planned)]
        said = [m for t, m in run.kept.moved if m.step == taken and t <= begin * period + 0.1]
        if said and not plain:
            earlier = [m for t, m in run.kept.moved if m.step == taken - 1 and t <= landed]
            origin = (earlier[-1].x, earlier[-1].y, earlier[-1].yaw) if earlier else planned_before
            wanted += [_way(o, (m.x, m.y, m.yaw)) for m in said[-3:] for o in (origin, planned_before)]
        true = _way(true_before, place)
        near = run.world.body.leg / 12.0
        if any(
            math.dist(true[:2], w[:2]) <= near and abs(math.remainder(true[2] - w[2], math.tau)) <= math.radians(5.0)
            for w in wanted
        ):
            taken += 1
            planned_before = planned
            true_before = place
            landed = begin * period + 0.1
    return taken


def _way(before: tuple[float, float, float], place: tuple[float, float, float]) -> tuple[float, float, float]:
    dx = place[0] - before[0]
    dy = place[1] - before[1]
    c = math.cos(before[2])
    s = math.sin(before[2])
    return c * dx + s * dy, c * dy - s * dx, math.remainder(place[2] - before[2], math.tau)


def _ending(run: Recounted, stands: list[Stand], taken: int, last: np.ndarray, leg: float) -> set[str]:
    failed = set()
    feet = {side: (f.x, f.y, f.yaw) for side, f in run.feet.items()}
    where = dict(feet)
    for foot, _, place in stands:
        where[SIDES[foot]] = place
    planned = dict(feet)
    for step in run.steps:
        planned[step.side] = (step.x, step.y, step.yaw)
    moved = dict(planned)
    now = {k: (s.x, s.y, s.yaw) for k, s in enumerate(run.steps)}
    for _, m in run.kept.moved:
        now[m.step] = (m.x, m.y, m.yaw)
    for k, step in enumerate(run.steps):
        moved[step.side] = now[k]
    ends = [where] if taken == len(run.steps) else [planned, moved]
    offs = []
    for end in ends:
        middle = np.mean([_center(end[side], run.centers[side]) for side in SIDES], axis=0)
        yaw = end[run.steps[-1].side][2]
        offs.append((math.dist(middle, last[:2]), abs(math.degrees(math.remainder(last[4] - yaw, math.tau)))))
    off, turned = min(offs)
    if not off < leg / 6.0:
        failed.add("position")
    if not turned < 5.0:
        failed.add("heading")
    if not math.degrees(math.acos(min(1.0, last[3]))) < 5.0:
        failed.add("tilt")
    return failed


def _center(place: tuple[float, float, float], center: np.ndarray) -> np.ndarray:
    c = math.cos(place[2])
    s = math.sin(place[2])
    return np.array([place[0] + c * center[0] - s * center[1], place[1] + s * center[0] + c * center[1]])


def _experiment(run: Recounted, hardest: float, loads: np.ndarray, weight: float) -> set[str]:
    """What the scene's `[outcome]` asks, of those criteria that these scenes have."""
    failed = set()
    outcome = run.scene.outcome
    pieces = range(len(run.ground.solids))
    on = np.array([[row[p] for p in pieces] for row in run.kept.pieces]).reshape(len(loads), -1)
    carries = on >= 0.25 * weight
    if "soft_landings" in outcome and hardest > outcome["soft_landings"].largest:
        failed.add("soft_landings")
    if "never_stood_on" in outcome:
        longest = max((_longest(carries[:, p]) for p in pieces), default=0) * run.world.period
        if longest > outcome["never_stood_on"].longest:
            failed.add("never_stood_on")
    if "stood_on" in outcome:
        soles = []
        for step in run.steps:
            middle, half = run.robot.sole_rectangle(step.side)
            ring = middle + half * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
            c = math.cos(step.yaw)
            s = math.sin(step.yaw)
            soles.append(shapely.Polygon(ring @ np.array([[c, s], [-s, c]]) + (step.x, step.y)))
        for p, (solid, seen) in enumerate(zip(run.ground.solids, run.ground.seen_from_above(), strict=True)):
            face = shapely.Polygon(np.array(seen) + solid.at(np.inf)[:2] - solid.position[:2]).convex_hull
            under = any(face.intersection(s).area >= outcome["stood_on"].covers * s.area for s in soles)
            if solid.shape not in ("sphere", "ellipsoid") and under and not carries[:, p].any():
                failed.add("stood_on")
    if "pushed" in outcome and np.linalg.norm(run.kept.pushed) < outcome["pushed"].least * run.scene.push.strength:
        failed.add("pushed")
    return failed


def drawn(lot: int) -> tuple[str, str, int, list[str], str]:
    """Scene, robot, seed, settings and attack of a lot."""
    chance = random.Random(f"recount {lot}")
    scene = chance.choice(sorted(SHORT))
    settings = [SHORT[scene], *chance.choice(OFF).split()]
    level = chance.choice((0, 2, 2))
    if level:
        settings += ["plant=random", f"level={level}"]
    return scene, chance.choice(("h1", "hrp2kai")), chance.randrange(2**28), settings, chance.choice(ATTACKS)


def run_lot(lot: int, made: str) -> None:
    """Run a lot and append its row."""
    scene, robot, seed, settings, name = drawn(lot)
    run = Recounted(load_scene(scene, settings, robot), seed)
    step = run.controller.step

    def attacked(sensors: Any) -> Any:
        attack(run, name)
        return step(sensors)

    run.controller.step = attacked
    summary = run.run()
    judged = {reason["criterion"] for reason in summary["reasons"]}
    row = (lot, scene, robot, seed, " ".join(settings), name, summary["completed"])
    texts = (" ".join(sorted(judged)), " ".join(sorted(recount(run))), made)
    append_row(FILE, COLUMNS, dict(zip(COLUMNS, (*row, *texts), strict=True)))
    print(lot, scene, robot, name, texts, file=sys.stderr, flush=True)


def report() -> None:
    """Write the table and the runs that differ."""
    rows = rows_of(FILE)
    lines = ["| criterion | failed by both | by the judge alone | by the recount alone |", "|---|---|---|---|"]
    sets = [(set(r["judged"].split()), set(r["recounted"].split())) for r in rows]
    for name in sorted({n for pair in sets for both in pair for n in both}):
        both = sum(name in a and name in b for a, b in sets)
        lines.append(
            f"| {name} | {both} | {sum(name in a - b for a, b in sets)} | {sum(name in b - a for a, b in sets)} |"
        )
    same = sum((not a) == (not b) for a, b in sets)
    exact = sum(a == b for a, b in sets)
    completed = sum(not a for a, _ in sets)
    attacked = [r for r in rows if r["attack"]]
    refused = sum(r["completed"] != "True" for r in attacked)
    lines += ["", f"{len(rows)} runs drawn by lot, {completed} of them completed: the outcome is the same in {same},"]
    lines += [f"every criterion in {exact}. Of {len(attacked)} attacked runs {refused} do not count."]
    made = Counter(r["commit"] for r in rows)
    lines += ["Runs by commit: " + ", ".join(f"{n} of {name}" for name, n in made.items()) + "."]
    write_table(PAGE, lines)


def main() -> None:
    if sys.argv[1:] == ["report"]:
        report()
        return
    if len(sys.argv) != 2 or not sys.argv[1].isdigit():
        sys.exit(f"recount.py: a number of runs, or `report`; got {sys.argv[1:]}")
    done = {int(r["lot"]) for r in rows_of(FILE)}
    made = commit()
    for lot in range(int(sys.argv[1])):
        if lot not in done:
            run_lot(lot, made)
    report()


if __name__ == "__main__":
    main()
