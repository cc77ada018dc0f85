"""Faults at every phase of a step, in an order drawn once: `safety_campaign.py ROWS.json [RUNS]`.

Each run begins one fault at one of eight times of a stride on flat ground, or while the robot stands, and watches 4 s.
ROWS.json keeps what ran, so that a stopped campaign goes on; the page counts what is there.
"""

import json
import sys
from pathlib import Path

import mujoco
import numpy as np
from resumable import write_table

from plantar.bench.tables import markdown_table
from plantar.sim.bench.stress.faults import FAULTS
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

ROBOTS = ("h1", "hrp2kai")
PHASES = 8  # of a stride, after which the same foot swings again
WATCHED = 4.0  # s after the fault's begin
DOWN = 0.5  # share of the CoM's height, and cosine of the trunk's tilt, of a robot that lies


def cases() -> list[tuple[str, str, int]]:
    """Fault, robot and phase (`PHASES`: standing) of each run, in the order in which they run."""
    every = [(fault, robot, phase) for fault in FAULTS for robot in ROBOTS for phase in range(PHASES + 1)]
    return [every[i] for i in np.random.default_rng(69).permutation(len(every))]


def onset(run: Simulation, phase: int) -> float:
    """Time in s at which a fault begins."""
    timing = run.settings.timing
    if phase == PHASES:
        return 0.7
    stride = 2.0 * (timing.single_support + timing.double_support)
    begin = next(p.start for p in run.controller.schedule.phases if p.step == 1)
    return float(begin + phase * stride / PHASES)


def outcome(fault: str, robot: str, phase: int) -> dict[str, object]:
    """Named state with the time to it, time to the fall (None for both: none), and stiffness at the end."""
    run = Simulation(load_scene("flat", ["steps=10"], robot))
    begin = onset(run, phase)
    change = FAULTS[fault]()
    world, controller = run.world, run.controller
    every = round(run.settings.period / world.period)
    height = 0.0
    state, named, fell, stiffness = None, None, None, 1.0
    for k in range(round((begin + WATCHED) / world.period)):
        if k % run.sensors.skin_every == 0:
            run.sensors.read_skins(controller.proximity_sides, False)
        if k % every == 0:
            now = float(world.data.time)
            reading = run.sensors.read_body()
            command = controller.step(reading if now < begin else change(reading, now - begin))
            run.servos.command(command)
            stiffness = command.stiffness
            center = float(world.data.subtree_com[world.torso, 2])
            height = max(height, center)
            lies = center < DOWN * height or np.reshape(world.data.xmat[world.torso], (3, 3))[2, 2] < DOWN
            if lies and fell is None:
                fell = round(now - begin, 3)
            if controller.safe_state is not None and named is None:
                state, named = controller.safe_state, round(now - begin, 3)
        run.servos.drive()
        mujoco.mj_step(world.model, world.data)
    last = controller.safe_state
    return {"state": state, "named": named, "last": last, "fell": fell, "stiffness": round(stiffness, 3)}


def table(rows: dict[str, dict[str, object]]) -> str:
    """Counts by robot, then each fall."""
    lines = []
    for robot in ROBOTS:
        own = [row for key, row in rows.items() if f"|{robot}|" in key]
        falls = [row for row in own if row["fell"] is not None]
        stiff = sum(row["stiffness"] != 0.0 and row["fell"] < WATCHED - 1.2 for row in falls)
        unnamed = sum(row["named"] is None or row["named"] > row["fell"] + 0.3 for row in falls)
        names = [row["named"] for row in own if row["named"] is not None]
        late = sum(time > 0.3 for time in names)
        lines.append((robot, len(own), len(falls), stiff, unnamed, len(names), late))
    titles = ("robot", "runs", "falls", "of them stiff", "of them unnamed", "named", "of them after 0.3 s")
    counted = markdown_table(titles, lines)
    fallen = [
        (
            *key.split("|"),
            f"{row['fell']} s",
            "unnamed" if row["named"] is None else f"{row['state']}, {row['named']} s",
        )
        for key, row in sorted(rows.items())
        if row["fell"] is not None
    ]
    return counted + "\n\n" + markdown_table(("fault", "robot", "phase", "fell after", "named"), fallen)


def main(arguments: list[str]) -> None:
    path = Path(arguments[0])
    most = int(arguments[1]) if len(arguments) > 1 else None
    rows: dict[str, dict[str, object]] = json.loads(path.read_text()) if path.exists() else {}
    for case in cases()[:most]:
        key = "|".join(map(str, case))
        if key not in rows:
            rows[key] = outcome(*case)
            path.write_text(json.dumps(rows))
    write_table(Path(__file__).with_suffix(".md"), [table(rows)])


if __name__ == "__main__":
    main(sys.argv[1:])
