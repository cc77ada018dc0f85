"""A standing robot with a fault that is then pushed over."""

import mujoco
import numpy as np

from plantar.common.record import Record
from plantar.sim.bench.stress.faults import FAULTS
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

_BEGIN = 0.4  # s at which the fault begins
_SHOVE = (0.9, 1.4)  # s of the push
_FORCE = 500.0  # N to the side
_END = 3.4


class ShovedRun(Record, frozen=True):
    """Names of the states that it came to, in order, its stiffness at the end, and the cosine of its tilt."""

    states: tuple[str, ...]
    stiffness: float
    upright: float


def run_shoved(robot: str, fault: str | None, end: float = _END) -> ShovedRun:
    """Push over a `robot` with a `fault` of `faults.FAULTS`; None for none."""
    parts = Simulation(load_scene("flat", ["steps=1", "walk.begin=9"], robot))
    world = parts.world
    controller = parts.controller
    change = None if fault is None else FAULTS[fault]()
    every = round(parts.settings.period / world.period)
    states: list[str] = []
    command = None
    for k in range(round(end / world.period)):
        now = float(world.data.time)
        if k % parts.sensors.skin_every == 0:
            parts.sensors.read_skins(controller.proximity_sides, False)
        if k % every == 0:
            reading = parts.sensors.read_body()
            command = controller.step(reading if change is None or now < _BEGIN else change(reading, now - _BEGIN))
            state = controller.safe_state
            if state is not None and state not in states:
                states.append(state)
            parts.servos.command(command)
        world.data.xfrc_applied[world.torso, 1] = _FORCE if _SHOVE[0] < now < _SHOVE[1] else 0.0
        parts.servos.drive()
        mujoco.mj_step(world.model, world.data)
    assert command is not None
    tilt = np.reshape(world.data.xmat[world.torso], (3, 3))[2, 2]
    return ShovedRun(tuple(states), command.stiffness, float(tilt))
