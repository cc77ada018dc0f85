"""Every figure of a run's summary, against one from the simulator's own contacts at every physics step.

Nothing of the judge is used: forces are MuJoCo's by `mj_contactForce`, hulls are scipy's, distances shapely's.
"""

import math
from collections import Counter
from itertools import groupby, pairwise
from typing import Any

import mujoco
import numpy as np
import pytest
import shapely
from scipy.spatial import ConvexHull, QhullError

from plantar.common.sides import SIDES
from plantar.mechanics.lip import GRAVITY
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.terrain import CORNERS

WALK = ["steps=3", "walk.start=0.5", "settle=0.3", "walk.end=0.5"]
COPLANAR = ("flat", "beam", "beam-yaw", "partial-inner", "push", "turn")
COMMANDED = ["until=4", "walk.start=0.5", "settle=0.3"]


class Watched(Simulation):
    """A run of which each physics step is kept: what MuJoCo computed in it belongs to the instant it began."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        self.rows: list[dict[str, Any]] = []
        self.estimates: list[tuple[float, np.ndarray, Any]] = []
        self.moved: list[Any] = []
        model = self.world.model
        root = int(model.body_rootid[self.world.torso])
        self.robot_geoms = set(np.flatnonzero(model.body_rootid[model.geom_bodyid] == root).tolist())
        step = self.controller.step

        def kept(sensors: Any) -> Any:
            command = step(sensors)
            self.estimates.append((sensors.time, command.state.com.copy(), command.state.zmp))
            self.moved += command.moved_steps
            return command

        self.controller.step = kept

    def step_physics(self) -> None:
        time, pushed = float(self.world.data.time), self.world.data.xfrc_applied[self.world.torso, :3].copy()
        super().step_physics()
        w, data = self.world, self.world.data
        row: dict[str, Any] = {"time": time, "pushed": pushed, "points": [], "loads": [], "wrench": np.zeros(6)}
        row["height"] = 0.0
        row["pieces"] = Counter()
        own = [set(w.sole_geoms[side]) for side in SIDES]
        for soles in own:
            load, points = 0.0, []
            for i in range(data.ncon):
                contact = data.contact[i]
                pair = contact.geom.tolist()
                if len(soles & set(pair)) != 1 or len(self.robot_geoms & set(pair)) != 1:
                    continue
                local = np.zeros(6)
                mujoco.mj_contactForce(w.model, data, i, local)
                sign = 1.0 if pair[1] in soles else -1.0
                axes = contact.frame.reshape(3, 3)
                force, torque = sign * local[:3] @ axes, sign * local[3:] @ axes
                row["wrench"] += [*force, *(np.cross(contact.pos, force) + torque)]
                row["height"] += force[2] * contact.pos[2]
                load += force[2]
                other = w.model.geom((set(pair) - soles).pop()).name.removesuffix(CORNERS)
                row["pieces"][other] += force[2]
                if contact.efc_address >= 0 or contact.dist <= w.reach:
                    points.append(contact.pos[:2].copy())
            row["loads"].append(load)
            row["points"].append(points)
        row["com"], row["up"] = data.subtree_com[w.torso].copy(), float(data.xmat[w.torso, 8])
        row["heading"] = math.atan2(data.xmat[w.torso, 3], data.xmat[w.torso, 0])
        row["soles"] = [data.site_xpos[w.sole_sites[side]].copy() for side in SIDES]
        row["torque"] = data.actuator_force[w.servos].copy()
        row["speed"] = data.qvel[w.joint_qvel].copy()
        self.rows.append(row)


def hull_of(points: list[np.ndarray]) -> shapely.Geometry:
    """Hull by Qhull; of points on a line, by shapely."""
    try:
        return shapely.Polygon(np.array(points)[ConvexHull(np.array(points), qhull_options="QJ1e-14").vertices])
    except (QhullError, ValueError):
        return shapely.MultiPoint(points).convex_hull


def margin_of(row: dict[str, Any], least: float) -> tuple[float, np.ndarray] | None:
    """Margin of the ZMP in m, and the ZMP; None without load."""
    fx, fy, fz, tx, ty, _ = row["wrench"]
    if fz < least:
        return None
    height = row["height"] / fz
    zmp = np.array([(height * fx - ty) / fz, (height * fy + tx) / fz])
    ring = hull_of([p for points in row["points"] for p in points])
    point = shapely.Point(zmp)
    if ring.area > 0.0 and ring.contains(point):
        return ring.exterior.distance(point), zmp
    return -ring.distance(point), zmp


def check(run: Watched, summary: dict[str, Any]) -> None:
    """Compare all figures of the summary with those of the kept steps."""
    w, rows = run.world, run.rows
    period, weight, beat = w.period, w.body.weight, w.body.beat
    loads = np.array([row["loads"] for row in rows])
    margins = [margin_of(row, 0.0012 * weight) for row in rows]
    depth = np.array([math.nan if m is None else m[0] for m in margins])
    assert summary["zmp_margin_min_m"] == pytest.approx(np.nanmin(depth), abs=2e-5)
    if run.scene.name in COPLANAR:  # forces that only push cannot have their centre outside of where they act
        assert np.nanmin(depth) >= -1e-4
    # Landings: force after 0.6 beats without.
    touches, airborne = loads >= 0.0237 * weight, round(0.607 * beat / period)
    landings = []
    for foot in range(2):
        steps = np.flatnonzero(touches[:, foot])
        gaps = np.diff(steps, prepend=-1)
        landings += [(int(k), foot) for k, gap in zip(steps, gaps, strict=True) if gap > airborne]
    landings.sort()
    assert summary["landings_s"] == [pytest.approx(rows[k]["time"], abs=6e-4) for k, _ in landings]
    assert summary["landing_sides"] == [SIDES[foot] for _, foot in landings]
    for number, (k, foot) in enumerate(landings):
        until = landings[number + 1][0] if number + 1 < len(landings) else len(rows)
        window = slice(k, k + round(0.202 * beat / period) + 1)
        assert summary["impacts_N"][number] == pytest.approx(loads[window, foot].max(), abs=0.06)
        assert summary["zmp_margins_m"][number] == pytest.approx(np.nanmin(depth[k:until]), abs=6e-5)
        sole = 4.0 * np.prod(run.robot.sole_rectangle(SIDES[foot])[1])
        settled = [row["points"][foot] for row in rows[k : k + round(2.43 * beat / period) + 1 : 5]]
        area = max(hull_of(p).area if len(p) > 2 else 0.0 for p in settled)
        assert summary["contact_area_ratio"][number] == pytest.approx(area / sole, abs=0.02)
        assert summary["contact_area_ratio"][number] >= area / sole - 6e-4
    check_stance(run, summary, [k for k, _ in landings], depth)
    check_outcome(run, summary, loads, [(k, foot, k + round(0.202 * beat / period) + 1) for k, foot in landings])
    # Stands and slips, the first ones too.
    slips = [0.0]
    for foot in range(2):
        starts = [0, *(k for k, side in landings if side == foot), len(rows)]
        for a, b in pairwise(starts):
            stood = [rows[k]["soles"][foot][:2] for k in range(a, b) if loads[k, foot] >= 0.25 * weight]
            slips += [math.dist(stood[0], place) for place in stood]
    assert summary["slip_max_m"] == pytest.approx(max(slips), abs=6e-5)
    tilt = math.degrees(math.acos(min(1.0, min(row["up"] for row in rows))))
    assert summary["tilt_max_deg"] == pytest.approx(tilt, abs=6e-4)
    # Joints.
    torques = np.abs([row["torque"] for row in rows])
    held = torques >= 0.999 * w.model.actuator_forcerange[w.servos, 1]
    assert summary["torque_limit"]["share_of_time"] == pytest.approx(held.any(axis=1).mean(), abs=6e-5)
    assert sum(summary["torque_limit"]["joints"].values()) == pytest.approx(held.mean(axis=0).sum(), abs=6e-4)
    limits = np.array([*run.robot.velocity_limits] * 2)
    fastest = (np.abs([row["speed"] for row in rows]) / limits).max()
    assert summary["joint_speed"]["share_of_limit"] == pytest.approx(fastest, abs=6e-4)
    # Estimates at the instants of the ticks.
    at = {round(row["time"] / period): k for k, row in enumerate(rows)}
    pairs = [(rows[k], margins[k], com, zmp) for t, com, zmp in run.estimates for k in [at[round(t / period)]]]
    errors = np.max([np.abs(com - row["com"]) for row, _, com, _ in pairs], axis=0)
    assert summary["estimate"]["com_error_max_m"] == pytest.approx(errors, abs=6e-5)
    off = [math.dist(zmp, m[1]) for _, m, _, zmp in pairs if zmp is not None and m is not None]
    assert summary["estimate"]["zmp_error_rms_m"] == pytest.approx(np.sqrt(np.mean(np.square(off))), abs=6e-6)
    # The end.
    last = rows[-1]
    lower = min(place[2] for place in last["soles"])
    assert summary["final"]["height_m"] == pytest.approx(last["com"][2] - lower, abs=6e-5)
    assert summary["final"]["tilt_deg"] == pytest.approx(math.degrees(math.acos(min(1.0, last["up"]))), abs=6e-4)
    if run.velocities is not None:
        ends = [commanded_course(run)]
    else:  # as planned at the start, or as moved last where the judge took that
        ends = [planned_end(run, {}), planned_end(run, moved_places(run, summary))]
    away = min(math.dist(last["com"][:2], place) for place, _ in ends)
    assert summary["final"]["position_error_m"] == pytest.approx(away, abs=1e-3)
    turned = min(abs(math.degrees(math.remainder(last["heading"] - yaw, 2.0 * math.pi))) for _, yaw in ends)
    assert summary["final"]["heading_error_deg"] == pytest.approx(turned, abs=0.02)
    if run.velocities is not None:
        assert summary["steps_planned"] is None
        assert summary["steps_taken"] == len(summary["landings_s"]) > 2
    pushed = period * np.sum([row["pushed"] for row in rows], axis=0)
    if "push" in summary:
        assert summary["push"]["impulse_Ns"] == pytest.approx(np.linalg.norm(pushed), abs=6e-5)


def check_outcome(
    run: Watched, summary: dict[str, Any], loads: np.ndarray, landings: list[tuple[int, int, int]]
) -> None:
    """Count what the run's ground, landings and motors show, and compare it with the reasons that the judge gives.

    `landings` are each one's first step, foot, and end of the steps in which its impact is looked for.
    """
    w = run.world
    weight = w.body.weight
    given = {reason["criterion"] for reason in summary["reasons"]}
    hardest = max((loads[a:b, foot].max() for a, foot, b in landings), default=0.0) / weight
    names = [f"ground_{i}" for i in range(len(run.ground.solids))]
    tops = {round(solid.top, 4) for solid in run.ground.solids}
    level = run.scene.name in COPLANAR
    assert not level or tops <= {0.0}
    assert ("impact" in given) == (hardest > (1.0 if level else 1.5))
    held = np.abs([row["torque"] for row in run.rows]) >= 0.999 * w.model.actuator_forcerange[w.servos, 1]
    assert ("torque_limit" in given) == (held.any(axis=1).mean() > 0.1)
    assert not given & {"outside_force", "ground_contact"}
    on_pieces = np.array([[row["pieces"][name] for name in names] for row in run.rows])
    if "soft_landings" in run.scene.outcome:
        assert ("soft_landings" in given) == (hardest > 0.5)
    if run.judge.pieces is None:
        return
    carries = on_pieces >= 0.25 * weight
    for piece, name in enumerate(names):
        assert run.judge.pieces.largest(piece) == pytest.approx(on_pieces[:, piece].max(), abs=1e-6), name
        longest = max((len(list(g)) for on, g in groupby(carries[:, piece]) if on), default=0)
        assert run.judge.pieces.longest(piece) == pytest.approx(longest * w.period), name
    if "never_stood_on" in run.scene.outcome:
        stood = max(run.judge.pieces.longest(piece) for piece in range(len(names)))
        assert ("never_stood_on" in given) == (stood > run.scene.outcome["never_stood_on"].longest)


def check_stance(run: Watched, summary: dict[str, Any], landings: list[int], depth: np.ndarray) -> None:
    """Compare how steady the ground's force is, over runs of single support of 21 steps and more."""
    w, rows = run.world, run.rows
    loads = np.array([row["loads"] for row in rows])
    single = (loads >= 0.0237 * w.body.weight).sum(axis=1) == 1
    if single.any():
        assert summary["zmp_edge_share"] == pytest.approx((depth[single] < 2e-3).mean(), abs=2e-5)
    since = np.arange(len(rows)) - np.maximum.accumulate(np.isin(np.arange(len(rows)), landings) * np.arange(len(rows)))
    if landings:
        since[: landings[0]] = len(rows)
    counts = single & (since >= round(0.1 / w.period))
    mass, span = w.model.body_subtreemass[w.torso], round(0.01 / w.period)
    height = np.array([row["com"][2] for row in rows])
    off = [
        loads[k].sum() / mass / GRAVITY
        - 1.0
        - (height[k + span] - 2.0 * height[k] + height[k - span]) / (0.01**2 * GRAVITY)
        for k in range(span, len(rows) - span)
        if counts[k - span : k + span + 1].all()
    ]
    assert summary["stance_force_rms"] == pytest.approx(np.sqrt(np.mean(np.square(off))) if off else None, abs=2e-5)


def moved_places(run: Watched, summary: dict[str, Any]) -> dict[int, Any]:
    """The moves that the judge took: of each step in the summary the last one as far as it states."""
    places = {}
    for row in summary["moved_steps"]:
        planned = run.steps[row["step"]]
        far = [m for m in run.moved if m.step == row["step"]]
        far = [m for m in far if abs(math.dist((m.x, m.y), (planned.x, planned.y)) - row["moved_m"]) < 6e-5]
        places[row["step"]] = far[-1]
    return places


def planned_end(run: Watched, moved: dict[int, Any]) -> tuple[np.ndarray, float]:
    """Middle of the soles' centres where the last footsteps put them, and the last one's heading."""
    places = [moved.get(k, step) for k, step in enumerate(run.steps)]
    last = dict(run.feet) | {step.side: place for step, place in zip(run.steps, places, strict=True)}
    centers = []
    for side in SIDES:
        c, s = math.cos(last[side].yaw), math.sin(last[side].yaw)
        centers.append([last[side].x, last[side].y] + np.array([[c, -s], [s, c]]) @ run.centers[side])
    return np.mean(centers, axis=0), places[-1].yaw if places else 0.0


def commanded_course(run: Watched) -> tuple[np.ndarray, float]:
    """Where the commands lead from the start, with the delays that a walk has: one step, and its start."""
    timing = run.settings.timing
    step = timing.single_support + timing.double_support
    place, heading = planned_end(run, {})
    first = run.velocities.times[0] + timing.start
    times = [t for t, _, _ in run.estimates]
    for t in times[1:]:
        command = run.velocities.at(t - step)
        if command is None or t - step < 0.0 or t < first:
            continue
        c, s = math.cos(heading), math.sin(heading)
        dt = times[1] - times[0]
        place = place + dt * np.array([c * command.forward - s * command.left, s * command.forward + c * command.left])
        heading += dt * command.turn
    return place, heading


def run_and_check(scene: str, settings: list[str], seed: int) -> dict[str, Any]:
    run = Watched(load_scene(scene, settings), seed)
    summary = run.run()
    check(run, summary)
    return summary


def test_figures_of_a_flat_walk_are_the_simulators():
    summary = run_and_check("flat", ["steps=2", *WALK[1:]], 0)
    assert summary["completed"]


@pytest.mark.long
@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        ("beam", WALK),
        ("obstacle", [*WALK, "terrain.step=1"]),
        ("feasibility-2", [*WALK, "terrain.step=1", "feasibility=off"]),
        ("slide-in", [*WALK, "terrain.step=1"]),
        ("uneven", WALK),
        ("stones", WALK),
        ("partial-inner", WALK),
        ("push", [*WALK, "push.step=1", "push.duration=0.0015"]),
        ("turn", COMMANDED),
        ("beam-yaw", WALK),
    ],
)
def test_figures_of_a_scene_are_the_simulators(scene, settings):
    run_and_check(scene, settings, 1)
