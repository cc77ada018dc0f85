"""`plantar bench skip`: scenes with and without skipping, physics alone, time by room."""

import hashlib
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.bench.kind import BenchOptions, Case, Finding, Kind, PageTable, Row
from plantar.gait.command import Command
from plantar.percepts.percept import Percept
from plantar.sim.bench.room_times import ROOMS, RoomTimes
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Scene, load_scene


class WatchedSimulation(Simulation):
    """A simulation that keeps its controls and hashes its motion.

    `controls`: servo set-points at each physics step; `members`: how often each member of a percept was computed.
    """

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        data = self.world.data
        self._began = mujoco.MjData(self.world.model)
        mujoco.mj_copyData(self._began, self.world.model, data)
        self.controls: list[NDArray[np.float64]] = []
        self.members: Counter[str] = Counter()
        self.percepts = 0
        self._motion = hashlib.sha256()

    def step_physics(self) -> None:
        self.controls.append(self.world.data.ctrl.copy())
        super().step_physics()
        self._motion.update(self.world.data.qpos.tobytes())

    def compute_rest(self, command: Command, everything: bool) -> int:
        left_out = super().compute_rest(command, everything)
        for percept in command.percepts.values():
            self.members.update(percept.__dict__.keys() & set(percept.members()))
            self.percepts += 1
        return left_out

    @property
    def motion(self) -> str:
        """Hash of all positions of all physics steps."""
        return self._motion.hexdigest()


def replay_physics(run: WatchedSimulation) -> tuple[float, str]:
    """Physics alone of a run without pushes or moving ground: CPU time in s, motion hash."""
    model = run.world.model
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, run._began)
    control = data.ctrl
    step = mujoco.mj_step
    start = time.process_time()
    for row in run.controls:
        control[:] = row
        step(model, data)
    used = time.process_time() - start
    motion = hashlib.sha256()
    mujoco.mj_copyData(data, model, run._began)
    for row in run.controls:
        control[:] = row
        step(model, data)
        motion.update(data.qpos.tobytes())
    return used, motion.hexdigest()


SCENES: tuple[tuple[str, str, tuple[str, ...]], ...] = tuple(
    (scene, robot, settings)
    for scene, settings in (("flat", ("steps=6",)), ("beam", ("steps=4",)), ("uneven", ("steps=6",)))
    for robot in ("h1", "hrp2kai")
)
"""Scene, robot and settings of each row: a few steps of each, since later ones cost the same."""

_SEED = 1
_NONE = "control.skip=none"
_SHAPES = ("polygon", "outline", "box", "rectangle", "circle", "triangle", "parallelogram", "contours", "centroid")


@dataclass(frozen=True)
class SkipRow:
    """Cost of a scene with a robot: CPU times in s, medians.

    Attributes:
        everything_s: With all percepts, rays and recording.
        physics_s: Of the same motion by `mj_step` in a loop.
        factor: Everything but the physics over the physics.
        saved: The same with all computed, over the run's.
        same_motion: Whether both runs and the physics alone moved alike, to the last bit.
        shares: Of each room in the run's time.
        skipped: Counts of what was left out; `computed` of the rest.
    """

    scene: str
    robot: str
    settings: str
    seed: int
    sim_s: float
    run_s: float
    everything_s: float
    physics_s: float
    factor: float
    saved: float
    same_motion: bool
    motion: str
    shares: dict[str, float]
    skipped: dict[str, int]
    computed: dict[str, int]


def compare_skipping(scene: str, robot: str, settings: Sequence[str] = (), rounds: int = 3) -> SkipRow:
    """Returns the comparison of a `scene` without pushes and moving ground as needed, with everything, and its physics
    alone.

    Of a `robot` with `settings` as `key=value`, in medians of `rounds`, 1 or more. A SceneError if scene or setting is
    unknown, an InputError without a timer signal (see `RoomTimes`).
    """
    needed = load_scene(scene, tuple(settings), robot)
    everything = load_scene(scene, (*settings, _NONE), robot)
    watched = WatchedSimulation(needed, _SEED)
    full = WatchedSimulation(everything, _SEED)
    summary = watched.run()
    full.run()
    motions = {watched.motion, full.motion}
    times = []
    for _ in range(rounds):
        with TemporaryDirectory() as folder:
            used = _cpu_time(needed), _cpu_time(everything, Path(folder) / "run.mcap")
        alone, motion = replay_physics(watched)
        times.append((*used, alone))
        motions.add(motion)
    run, whole, physics = np.array(times).T
    simulation = Simulation(needed, _SEED)
    with RoomTimes() as rooms:
        simulation.run()
    return SkipRow(
        scene=scene,
        robot=robot,
        settings=" ".join(settings),
        seed=_SEED,
        sim_s=round(float(summary["sim_time_s"]), 3),
        run_s=float(np.median(run)),
        everything_s=float(np.median(whole)),
        physics_s=float(np.median(physics)),
        factor=float(np.median((run - physics) / physics)),
        saved=float(np.median((whole - physics) / (run - physics))),
        same_motion=len(motions) == 1,
        motion=watched.motion,
        shares=rooms.shares,
        **_counts(watched, summary),
    )


def _cpu_time(scene: Scene, record: Path | None = None) -> float:
    simulation = Simulation(scene, _SEED)
    start = time.process_time()
    simulation.run(record=record)
    return time.process_time() - start


def _counts(run: WatchedSimulation, summary: Mapping[str, Any]) -> dict[str, dict[str, int]]:
    shapes = [name for name in Percept.members() if any(word in name for word in _SHAPES)]
    others = [name for name in Percept.members() if name not in shapes]
    skins = [sensor.skin for sensor in run.sensors.skins.values()]
    counted = summary["skipped"]
    computed = {
        "polygons and other shapes": sum(run.members[name] for name in shapes),
        "other percept members": sum(run.members[name] for name in others),
        "taxel forces": sum(len(skin) * skin.pressed for skin in skins),
        "proximity rays": sum(s.cast for s in run.sensors.proximity.values()),
        "steps of the IK with projectors": run.legs.inverse.careful,
        "recorded ticks": 0,
        "rendered frames": 0,
    }
    skipped = {
        "polygons and other shapes": len(shapes) * run.percepts - computed["polygons and other shapes"],
        "other percept members": len(others) * run.percepts - computed["other percept members"],
        "taxel forces": sum(len(skin) * skin.in_air for skin in skins),
        "proximity rays": int(counted.get("proximity_rays", 0)),
        "steps of the IK with projectors": run.legs.inverse.plain,
        "recorded ticks": int(counted["recorded_ticks"]),
        "rendered frames": int(counted["rendered_frames"]),
    }
    return {"skipped": skipped, "computed": computed}


def _cases(options: BenchOptions) -> list[Case]:
    scenes, rounds = (SCENES[:1], 1) if options.quick else (SCENES, 3)
    return [
        Case((scene, robot, " ".join(settings)), partial(_measure, scene, robot, settings, rounds))
        for scene, robot, settings in scenes
    ]


def _measure(scene: str, robot: str, settings: Sequence[str], rounds: int) -> list[Row]:
    return [asdict(compare_skipping(scene, robot, settings, rounds))]


def _find(rows: Sequence[Row], options: BenchOptions) -> Finding:
    times = [
        (
            *(r["scene"], r["robot"], r["settings"], r["sim_s"] / r["run_s"], r["run_s"], r["everything_s"]),
            *(r["physics_s"], r["factor"], f"{r['saved']:.1f} x", "yes" if r["same_motion"] else "**no**"),
        )
        for r in rows
    ]
    head = ("scene", "robot", "settings", "real-time factor", "run [s]", "with everything [s]", "physics alone [s]")
    shares = [(r["scene"], r["robot"], *(f"{100.0 * r['shares'].get(room, 0.0):.0f}" for room in ROOMS)) for r in rows]
    counts = [
        (r["scene"], r["robot"], *(f"{n} of {n + r['computed'][name]}" for name, n in r["skipped"].items()))
        for r in rows
    ]
    tables = [
        PageTable("Times", (*head, "rest / physics", "saved", "same motion"), times),
        PageTable("Time by room, in percent of the run", ("scene", "robot", *ROOMS), shares),
        PageTable("What was skipped", ("scene", "robot", *rows[0]["skipped"]), counts),
    ]
    same = all(row["same_motion"] for row in rows)
    failed = "a run that skips what its scene does not need moves otherwise than one that does not"
    return Finding({"scenes": list(rows), "same_motion": same}, tables, () if same else (failed,))


SKIPPING = Kind(
    page="skipping",
    title="What a scene's time goes to, and what is skipped",
    lead="""\
"Physics alone" is the same motion by `mj_step` in a loop; "rest / physics" is everything else over it. "With
everything" computes every member of each percept, casts every ray and records the run; "saved" is the factor by which
everything but physics is cheaper without. "Same motion" compares a hash of all positions. Rooms are sampled each
millisecond.""",
    table="skipping.csv",
    keys=("scene", "robot", "settings"),
    columns=tuple(f.name for f in fields(SkipRow) if f.name not in ("scene", "robot", "settings")),
    cases=_cases,
    find=_find,
    resumes=False,
)
"""`plantar bench skip`."""
