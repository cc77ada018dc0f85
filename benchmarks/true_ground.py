"""Torques, ground and stand of every walking scene, at the physics rate.

`python benchmarks/true_ground.py ROWS.csv [SCENE...]` runs each once on both robots, unless ROWS.csv has it already.
"""

import math
import sys
from collections.abc import Sequence
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import shapely
from resumable import append_row, rows_of, write_table

from plantar.bench.tables import markdown_table
from plantar.common.sides import SIDES
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Scene, builtin_scenes, load_scene
from plantar.sim.run.scene_kind import open_scene

SCENES = [name for name in builtin_scenes() if isinstance(open_scene(name), Scene)]
RUNS = [run for run in product(SCENES, ("h1", "hrp2kai")) if run != ("guide", "hrp2kai")]  # which has no arms
COPLANAR = ("flat", "beam", "partial")  # kinds of terrain on which all contacts lie in one plane
CARRIES = 1.0  # N on a contact point, so that points that touch and carry nothing do not count
SETTLES = 10  # ms after a contact point starts or stops to carry, in which its impulse reaches the joints
COMPARED = 10_000  # support polygons of a run
EQUAL = 1e-12  # m, and m2, between two polygons that are the same
Point = tuple[float, float]
HEADS = {
    "scene": "scene",
    "robot": "robot",
    "failed": "failed",
    "torque_step": "torque step [% of the limit]",
    "joint": "of",
    "ripple": "force's ripple [% of weight]",
    "edge": "ZMP at an edge [%]",
    "margin_mm": "smallest margin [mm]",
    "hulls": "other hulls",
    "left_share": "left foot carries [%]",
    "off_mm": "CoPs off the middle line [mm]",
}


class Watched(Simulation):
    """A run that keeps what each physics step did to joints, contact points and support polygon."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.torques: list[np.ndarray] = []
        self.points: list[list[tuple[int, int]]] = []
        self.compared = self.other = 0

    def advance(self, steps: int = 1) -> int:
        super().advance(1)
        data = self.world.data
        self.torques.append(data.actuator_force[self.world.servos].copy())
        address = data.contact.efc_address[: data.ncon]  # -1 for points that only come near
        pressed = address >= 0
        pressed[pressed] = data.efc_force[address[pressed]] > CARRIES
        self.points.append(sorted(map(tuple, data.contact.geom[: data.ncon][pressed].tolist())))
        if self.compared < COMPARED:
            truth = self.judge.truth()
            self.other += not is_hull(truth.ring, [p for foot in truth.points for p in foot])
            self.compared += 1
        return 1

    def torque_steps(self) -> np.ndarray:
        """Largest torque step (k,) of each joint in 1 ms, over its limit, while no contact point came or went."""
        model, servos = self.world.model, self.world.servos
        ranges = model.actuator_forcerange[servos], model.jnt_actfrcrange[model.actuator_trnid[servos, 0]]
        limits = np.maximum(*(np.abs(r).max(axis=1) for r in ranges))
        steps = np.abs(np.diff(np.array(self.torques), axis=0)) / limits
        quiet = np.ones(len(steps), bool)
        for k in np.flatnonzero([a != b for a, b in pairwise(self.points)]):
            quiet[max(0, k - 1) : k + SETTLES] = False
        assert quiet.mean() > 0.5
        return np.asarray(steps[quiet].max(axis=0))

    def stand(self) -> tuple[float, list[float]]:
        """Share of the left foot now, and how far in m each foot's CoP is from its sole's middle line."""
        model, data = self.world.model, self.world.data
        loads, off = [], []
        for side in SIDES:
            load, moment, own = 0.0, 0.0, set(self.world.sole_geoms[side])
            site = self.world.sole_sites[side]
            for i, contact in enumerate(data.contact[: data.ncon]):
                if len(own & set(contact.geom.tolist())) == 1:
                    local = np.zeros(6)
                    mujoco.mj_contactForce(model, data, i, local)
                    force = abs(contact.frame.reshape(3, 3)[:, 2] @ local[:3])
                    load += force
                    moment += force * (data.site_xmat[site].reshape(3, 3).T @ (contact.pos - data.site_xpos[site]))[1]
            loads.append(load)
            off.append(moment / load - self.robot.sole_rectangle(side)[0][1] if load else math.nan)
        return loads[0] / max(sum(loads), 1e-9), off


def is_hull(ring: Sequence[Point], points: Sequence[Point]) -> bool:
    """Whether a ring (x, y) in m is GEOS's hull of the points, counter-clockwise."""
    if not ring or not points:
        return not ring and not points
    found, (x, y) = shapely.MultiPoint(points).convex_hull, np.transpose(ring)
    line = shapely.LineString([*ring, ring[0]])
    edge = found.boundary if found.area > 0.0 else found
    area = 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    return bool(shapely.hausdorff_distance(line, edge) <= EQUAL and abs(area - found.area) <= EQUAL)


def row_of(scene: str, robot: str, settings: tuple[str, ...] = ()) -> dict[str, Any]:
    """Figures of one run, as texts under the table's heads; bold where one is beyond its limit."""
    run = Watched(load_scene(scene, settings, robot), 0)
    found = run.run()
    steps, plane = run.torque_steps(), run.scene.terrain.kind in COPLANAR
    share, off = run.stand()
    ripple, edge, margin = (found[name] or 0.0 for name in ("stance_force_rms", "zmp_edge_share", "zmp_margin_min_m"))
    most = float(np.max(np.abs(off)))
    joints = run.world.model.actuator_trnid[run.world.servos, 0]
    return {
        "scene": scene,
        "robot": robot,
        "failed": " ".join(r["criterion"] for r in found["reasons"]),
        "torque_step": marked(100.0 * steps.max(), "{:.1f}", steps.max() > 0.1),
        "joint": run.world.model.joint(joints[steps.argmax()]).name,
        "ripple": marked(100.0 * ripple, "{:.2f}", ripple > (0.01 if plane else 0.02)),
        "edge": marked(100.0 * edge, "{:.2f}", edge > 0.002),
        "margin_mm": marked(1e3 * margin, "{:.2f}", plane and margin < -1e-4),
        "hulls": marked(run.other, f"{{}} of {run.compared}", run.other > 0),
        "left_share": marked(100.0 * share, "{:.1f}", plane and not 0.45 <= share <= 0.55),
        "off_mm": marked(1e3 * most, "{:.1f}", plane and not most <= 0.01),
    }


def marked(value: float, form: str, beyond: bool) -> str:
    return f"**{form.format(value)}**" if beyond else form.format(value)


if __name__ == "__main__":
    path = Path(sys.argv[1])
    rows = rows_of(path)
    for scene, robot in (run for run in RUNS if run[0] in (sys.argv[2:] or SCENES)):
        if not any((r["scene"], r["robot"]) == (scene, robot) for r in rows):
            append_row(path, tuple(HEADS), row := row_of(scene, robot))
            print(row, file=sys.stderr, flush=True)
    cells = [[r[name] or "-" for name in HEADS] for r in rows_of(path)]
    table = markdown_table(tuple(HEADS.values()), sorted(cells))
    write_table(Path(__file__).with_name("convergence.md"), [table], "scenes")
