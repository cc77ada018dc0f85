"""Faults at every phase of a step, in an order drawn once: `safety_campaign.py ROWS.json [SECONDS]`.

Each run begins a fault, or a pair of them, at one of eight times of a stride on flat ground, or while the robot stands,
and watches 5 s. Each robot walks once for many runs: a run is a copy of the process at the fault's begin, so that all
have the same walk before it, to the last bit. Runs that fell are repeated with a controller that knows the fault.
ROWS.json keeps what ran, so that a stopped campaign goes on; after SECONDS of processor time it stops.
"""

import json
import multiprocessing
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from campaign_faults import PAIRS, SINGLE, CampaignFault, parts_of, places_of
from campaign_page import LIMP, WATCHED, page
from resumable import processor_time, write_table

from plantar.common.sides import SIDES
from plantar.gait.command import Command, Sensors
from plantar.sensing.reading import Reading
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

FOLDER = Path(__file__).parent
MADE = FOLDER.parent / "out" / "introduced"
MODELS = {"JVRC-1": "robots/jvrc1/xml/jvrc1.xml", "Booster T1": "robots/booster_t1/t1.xml"}
"""Model of each introduced robot below `PLANTAR_REAL_DATA`."""

ROBOTS = ("h1", "hrp2kai", *MODELS)
PHASES = 8  # of a stride, after which the same foot swings again
DOWN = 0.5  # share of the CoM's height, and cosine of the trunk's tilt, of a robot that lies
BATCH = 200  # runs of the drawn order that share a walk of each robot

Row = dict[str, Any]


class Case(NamedTuple):
    """A run: fault, robot, phase (`PHASES`: standing), and what the controller knows of the fault ("": nothing)."""

    fault: str
    robot: str
    phase: int
    knows: str = ""

    @property
    def key(self) -> str:
        return "|".join(map(str, self[:3])) + (f"|{self.knows}" if self.knows else "")


def cases() -> list[Case]:
    """All runs, in the order in which they run."""
    names = [*SINGLE, *PAIRS]
    every = [Case(name, robot, phase) for name in names for robot in ROBOTS for phase in range(PHASES + 1)]
    return [every[i] for i in np.random.default_rng(69).permutation(len(every))]


def informed(rows: dict[str, Row]) -> list[Case]:
    """The runs that fell, each in the ways that a controller has that knows the fault at once."""
    found = []
    for key, row in rows.items():
        fault, robot, phase, *knows = key.split("|")
        if row["fell"] is not None and not knows:
            parts = parts_of(fault)
            ways = ["stop"]
            if all(part.known for part in parts):
                ways.append("walk")
            found += [Case(fault, robot, int(phase), way) for way in ways]
    return found


class Watched:
    """A walk on flat ground, tick by tick, with what is measured of it."""

    def __init__(self, robot: str) -> None:
        file = MADE / robot.replace(" ", "-") / "robot.toml"
        run = Simulation(load_scene("flat", ["steps=16"], str(file) if robot in MODELS else robot))
        self.run = run
        self.every = round(run.settings.period / run.world.period)
        timing = run.settings.timing
        stride = 2.0 * (timing.single_support + timing.double_support)
        begin = next(p.start for p in run.controller.schedule.phases if p.step == 1)
        times = [begin + phase * stride / PHASES for phase in range(PHASES)] + [0.7]
        self.onsets = [round(time / run.settings.period) for time in times]
        self.ticks = 0
        self.targets = np.zeros(0)
        self.angles = np.zeros(0)
        self.moves = (0.0, 0.0)
        self.height = 0.0
        self.stiffness = 1.0

    def tick(self, change: Callable[[Sensors], Sensors] | None = None, missing: bool = False) -> None:
        """A tick of control and its physics; `change`: of what is read; a tick that is `missing` leaves the drives."""
        run = self.run
        for step in range(self.every):
            if (self.ticks * self.every + step) % run.sensors.skin_every == 0:
                run.sensors.read_skins(run.controller.proximity_sides, False)
            if step == 0 and not missing:
                reading = run.sensors.read_body()
                command = run.controller.step(reading if change is None else change(reading))
                self.angles = run.servos.command(command)
                if run.controller.shell is not None:
                    run.controller.shell.commanded = self.angles
                self._measure(command)
            elif step == 0:  # drives hold where the last tick left them
                run.servos.follow(self.angles, run.legs.torques.copy())
            run.servos.drive()
            mujoco.mj_step(run.world.model, run.world.data)
        self.ticks += 1
        self.height = max(self.height, self.com)

    def _measure(self, command: Command) -> None:
        targets = np.array([command.com, *(command.feet[side].position for side in SIDES)])
        if len(self.targets):
            com, left, right = np.linalg.norm(targets - self.targets, axis=1)
            self.moves = (max(self.moves[0], float(com)), max(self.moves[1], float(left), float(right)))
        self.targets = targets
        self.stiffness = command.stiffness

    @property
    def com(self) -> float:
        return float(self.run.world.data.subtree_com[self.run.world.torso, 2])

    @property
    def lies(self) -> bool:
        turn = np.reshape(self.run.world.data.xmat[self.run.world.torso], (3, 3))
        return bool(self.com < DOWN * self.height or turn[2, 2] < DOWN)


def informed_change(walk: Watched, case: Case, parts: list[CampaignFault]) -> Callable[[Sensors], Sensors]:
    """What a controller reads that knows the faults, and leaves them out or undoes them."""
    if case.knows == "stop":
        assert walk.run.controller.shell is not None
        walk.run.controller.shell.stop("it knows the fault")
        return lambda sensors: sensors

    def change(sensors: Sensors) -> Sensors:
        for part in parts:
            if part.known == "joints":
                angles = sensors.joint_positions.copy()
                angles[list(part.places)] = walk.angles[list(part.places)]
                sensors = sensors.changed(joint_positions=angles)
            elif part.known == "sole":
                sensors = sensors.changed(readings={s: r for s, r in sensors.readings.items() if s not in part.places})
            elif part.known == "taxels":
                readings = dict(sensors.readings)
                sides, places = part.places
                for side in sides:
                    force = readings[side].force.copy()
                    force[places_of(force, places)] = np.nan
                    readings[side] = Reading(readings[side].time, force, readings[side].proximity)
                sensors = sensors.changed(readings=readings)
        return sensors

    return change


def outcome(walk: Watched, case: Case) -> Row:
    """Watch a walk from the fault's begin on.

    Returns named state, time in s to the first word of it, to the fall (None for both: none), stiffness at the end,
    largest moves in m of CoM and feet in a tick, ticks that raised inside the shell, and the words.
    """
    parts = parts_of(case.fault)
    shell = walk.run.controller.shell
    assert shell is not None
    model = walk.run.world.model
    if case.knows:
        change = informed_change(walk, case, parts)
    else:
        made = [part.made() for part in parts]
        since = 0.0

        def change(sensors: Sensors) -> Sensors:
            for fault in made:
                sensors = fault(sensors, since)
            return sensors

    for part in parts:
        for joint, share in part.drives.items():
            which = walk.run.world.servos if joint is None else walk.run.world.servos[joint]
            model.actuator_gainprm[which, 0] *= share
            model.actuator_biasprm[which, 1:3] *= share
    words = len(shell.log.faults)
    period = walk.run.settings.period
    state, named, fell = None, None, None
    walk.moves = (0.0, 0.0)
    for k in range(round(WATCHED / period)):
        since = k * period
        walk.tick(change, any(part.missing(since) for part in parts))
        if fell is None and walk.lies:
            fell = round(since, 3)
        state = state or walk.run.controller.safe_state
        if named is None and (state is not None or len(shell.log.faults) > words):
            named = round(since, 3)
        if fell is not None and walk.stiffness == 0.0 and since > fell + LIMP:
            break
    return {
        "state": state,
        "named": named,
        "last": walk.run.controller.safe_state,
        "fell": fell,
        "stiffness": round(walk.stiffness, 3),
        "moves": walk.moves,
        "raised": walk.run.controller.raised[0],
        "words": shell.log.faults[words].text if len(shell.log.faults) > words else "",
    }


def _child(walk: Watched, case: Case, pipe: Any) -> None:
    try:
        pipe.send(outcome(walk, case))
    except BaseException as error:
        pipe.send({"error": f"{type(error).__name__}: {error}"})
    os._exit(0)


def walked(robot: str, chosen: list[Case]) -> Iterator[tuple[Case, Row]]:
    """Run cases of a robot, in the order of their begin, from one walk."""
    walk = Watched(robot)
    fork = multiprocessing.get_context("fork")
    for case in sorted(chosen, key=lambda case: walk.onsets[case.phase]):
        while walk.ticks < walk.onsets[case.phase]:
            walk.tick()
        mine, its = fork.Pipe(duplex=False)
        process = fork.Process(target=_child, args=(walk, case, its))
        process.start()
        yield case, mine.recv()
        process.join()


def usual_moves() -> dict[str, tuple[float, float]]:
    """Largest moves in m of CoM and feet in a tick of an undisturbed walk, of each robot."""
    found = {}
    for robot in ROBOTS:
        walk = Watched(robot)
        while walk.ticks < max(walk.onsets) + round(WATCHED / walk.run.settings.period):
            walk.tick()
        found[robot] = walk.moves
    return found


def introduce(data: Path) -> None:
    """Make the files of introduced robots that are missing."""
    for name, model in MODELS.items():
        folder = MADE / name.replace(" ", "-")
        if not (folder / "robot.toml").exists():
            command = [sys.executable, "-m", "plantar", "robot", str(data / model), "-o", str(folder)]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def run_missing(chosen: list[Case], rows: dict[str, Row], path: Path, seconds: float) -> None:
    """Run those of some cases that have no row, as long as there is processor time."""
    for robot in ROBOTS:
        mine = [case for case in chosen if case.robot == robot and case.key not in rows]
        if mine and processor_time() < seconds:
            for case, row in walked(robot, mine):
                rows[case.key] = row
                if processor_time() > seconds:
                    break
            path.write_text(json.dumps(rows))


def main(arguments: list[str]) -> None:
    path = Path(arguments[0])
    seconds = float(arguments[1]) if len(arguments) > 1 else np.inf
    introduce(Path(os.environ["PLANTAR_REAL_DATA"]))
    rows: dict[str, Row] = json.loads(path.read_text()) if path.exists() else {}
    order = cases()
    rows = {key: row for key, row in rows.items() if "error" not in row}
    for begin in range(0, len(order), BATCH):
        run_missing(order[begin : begin + BATCH], rows, path, seconds)
        run_missing(informed(rows), rows, path, seconds)
    write_table(Path(__file__).with_suffix(".md"), page(rows, usual_moves(), ROBOTS))


if __name__ == "__main__":
    main(sys.argv[1:])
