"""One walk or stand on flat ground with a fault."""

import mujoco
import numpy as np

from plantar.common.record import Record
from plantar.sim.bench.stress.faults import FAULTS
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

# m that a foot's target and the CoM move in a tick of an undisturbed walk, at most
_USUAL = {"h1": (4.65e-3, 1.84e-3), "hrp2kai": (3.02e-3, 1.64e-3)}

_BEGIN, _LASTS = 4.0, 1.4  # s at which the fault begins, and for which it is watched


class FaultRun(Record, frozen=True):
    """Outcome of a run.

    Attributes:
        jump: Largest move of a target in a tick, over an undisturbed walk's.
        state: Named state that it came to, or None.
        after: Time in s from fault to that state.
        named: Time in s from fault to its first name, by that state or in the log, or None.
        upright: Whether the robot ends on its feet.
    """

    jump: float
    state: str | None
    after: float
    named: float | None
    upright: bool


def run_with_fault(robot: str, walking: bool, fault: str, *, shell: bool = True) -> FaultRun:
    """Returns the outcome of a `fault` of `faults.FAULTS` on a `robot` ("h1" or "hrp2kai"), `walking` or standing, with
    safety `shell` or not.
    """
    settings = ["steps=6", "settle=0.5"] if walking else ["steps=1", "settle=4"]
    parts, change = Simulation(load_scene("flat", settings, robot)), FAULTS[fault]()
    world, sensors, controller, servos = parts.world, parts.sensors, parts.controller, parts.servos
    if not shell:
        controller.shell = None
    every = round(parts.settings.period / world.period)
    last, jump, state, after, named, words = None, 0.0, None, 0.0, None, 0
    usual_foot, usual_com = _USUAL[robot]
    for k in range(round((_BEGIN + _LASTS) / world.period)):
        if k % sensors.skin_every == 0:
            sensors.read_skins(controller.proximity_sides, False)
        if k % every == 0:
            now = float(world.data.time)
            reading = sensors.read_body()
            command = controller.step(reading if now < _BEGIN else change(reading, now - _BEGIN))
            if last is not None:
                feet = [np.linalg.norm(command.feet[s].position - last.feet[s].position) for s in command.feet]
                com = float(np.linalg.norm(command.com - last.com))
                jump = max(jump, com / usual_com, *(float(foot) / usual_foot for foot in feet))
            last = command
            if shell and now < _BEGIN:
                words = len(controller.shell.log.faults)
            elif shell and named is None and (controller.safe_state or len(controller.shell.log.faults) > words):
                named = now - _BEGIN
            if state is None and controller.safe_state is not None:
                state, after = controller.safe_state, now - _BEGIN
            angles = servos.command(command)
            if shell:
                controller.shell.commanded = angles
        servos.drive()
        mujoco.mj_step(world.model, world.data)
    return FaultRun(jump, state, after, named, bool(world.data.subtree_com[world.torso, 2] > 0.6))
