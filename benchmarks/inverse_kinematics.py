"""Run time against error of one Newton step of `plantar.robots.kinematics.inverse_kinematics`, compared with mink.

Both follow the commands of the same four-step walk at 200 Hz, one step a tick, warm-started from the last tick.

    python benchmarks/inverse_kinematics.py        (writes benchmarks/inverse_kinematics.md)
"""

import math
import time
from pathlib import Path

import mink
import mujoco
import numpy as np

from plantar.bench.tables import markdown_table
from plantar.common.atomic import write_text
from plantar.robots import load_robot
from plantar.robots.kinematics.robot_model import build_leg_model, robot_spec
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SIDES = ("left", "right")


def walk_commands():
    simulation = Simulation(load_scene("flat", ["steps=4"]))
    start = simulation.legs.configuration
    commands = []
    step = simulation.controller.step

    def keep(sensors):
        commands.append(step(sensors))
        return commands[-1]

    simulation.controller.step = keep
    simulation.run()
    return commands, start


def task_error(model, data, qpos, command):
    """Largest error of CoM, torso and soles in m or rad."""
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    worst = np.abs(data.subtree_com[0] - command.com).max()
    pairs = [(data.body("base").xmat, command.rotation_torso)]
    for side in SIDES:
        site, foot = data.site(f"{side}_sole"), command.feet[side]
        worst = max(worst, np.abs(site.xpos - foot.position).max())
        pairs.append((site.xmat, foot.rotation))
    for actual, wanted in pairs:
        cosine = 0.5 * (np.trace(wanted.T @ actual.reshape(3, 3)) - 1.0)
        worst = max(worst, math.acos(min(1.0, max(-1.0, cosine))))
    return worst


def ours(robot, commands, start, iterations):
    legs = build_leg_model(robot)
    probe = mujoco.MjData(legs.model)
    legs.set_configuration(start[:3], start[3:7], start[7:])
    times, errors = [], []
    for c in commands:
        positions = {s: c.feet[s].position for s in SIDES}
        rotations = {s: c.feet[s].rotation for s in SIDES}
        begin = time.perf_counter()
        legs.follow(c.com, c.rotation_torso, positions, rotations, iterations)
        times.append(1e6 * (time.perf_counter() - begin))
        errors.append(task_error(legs.model, probe, legs.configuration, c))
    return times, errors


def with_mink(robot, commands, start, solver):
    model = robot_spec(robot).compile()
    probe = mujoco.MjData(model)
    configuration = mink.Configuration(model)
    configuration.update(start)
    center = mink.ComTask(cost=1.0)
    torso = mink.FrameTask("base", "body", position_cost=0.0, orientation_cost=1.0)
    soles = {s: mink.FrameTask(f"{s}_sole", "site", position_cost=1.0, orientation_cost=1.0) for s in SIDES}
    limits = [mink.ConfigurationLimit(model)]
    times, errors = [], []
    for c in commands:
        begin = time.perf_counter()
        center.set_target(c.com)
        torso.set_target(mink.SE3.from_rotation(mink.SO3.from_matrix(c.rotation_torso)))
        for s in SIDES:
            rotation = mink.SO3.from_matrix(c.feet[s].rotation)
            soles[s].set_target(mink.SE3.from_rotation_and_translation(rotation, c.feet[s].position))
        velocity = mink.solve_ik(
            configuration, [center, torso, *soles.values()], 1.0, solver, damping=1e-9, limits=limits
        )
        configuration.integrate_inplace(velocity, 1.0)
        times.append(1e6 * (time.perf_counter() - begin))
        errors.append(task_error(model, probe, configuration.data.qpos, c))
    return times, errors


def main() -> None:
    robot = load_robot("h1")
    commands, start = walk_commands()
    rows = [
        ("Newton step on MuJoCo's Jacobians, 1 a tick (chosen)", *ours(robot, commands, start, 1)),
        ("the same, 2 a tick", *ours(robot, commands, start, 2)),
        ("mink, solver daqp", *with_mink(robot, commands, start, "daqp")),
    ]
    base = float(np.median(rows[0][1]))
    lines = [
        "# Inverse kinematics: run time against error",
        "",
        f"H1, 18 unknowns, {len(commands)} control ticks of the scene `flat` with 4 steps, each from the last tick's",
        "solution. Error: largest deviation of CoM, torso and soles from the command after the tick (m or rad).",
        "Written by `python benchmarks/inverse_kinematics.py`.",
        "",
    ]
    cells = []
    for name, times, errors in rows:
        t, low, high = float(np.median(times)), np.median(errors), np.percentile(errors, 99)
        cells.append((name, f"{t:.0f}", f"{t / base:.1f}", f"{low:.1e}", f"{high:.1e}"))
    head = ("method", "median time of a tick [us]", "ratio", "median error", "99 % error")
    lines.append(markdown_table(head, cells))
    print(write_text(Path(__file__).with_suffix(".md"), "\n".join(lines) + "\n").read_text())


if __name__ == "__main__":
    main()
