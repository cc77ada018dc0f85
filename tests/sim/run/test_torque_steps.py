"""The servos' torques at the physics rate: no control tick makes them jump, on any ground."""

import tomllib
from itertools import pairwise

import numpy as np
import pytest

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import builtin_scenes, load_scene, scene_file

LIMIT = 0.1  # of a joint's torque limit in a millisecond
CARRIES = 1.0  # N on a contact point, so that points that touch and carry nothing do not count
SETTLES = 10  # ms after a contact point starts or stops to carry, in which its impulse reaches the joints

WALKS = [name for name in builtin_scenes() if "machine" not in tomllib.loads(scene_file(name).read_text())]


def torque_steps(scene: str, robot: str, settings: tuple[str, ...] = (), seed: int = 0) -> np.ndarray:
    """Largest torque step (k,) of each joint in 1 ms, as a share of its limit, while no contact point came or went."""
    run = Simulation(load_scene(scene, settings, robot), seed)
    world, data = run.world, run.world.data
    joints = world.model.actuator_trnid[world.servos, 0]
    ranges = world.model.actuator_forcerange[world.servos], world.model.jnt_actfrcrange[joints]
    limits = np.maximum(*(np.abs(r).max(axis=1) for r in ranges))
    torques, points, physics = [], [], run.step_physics

    def step() -> None:
        physics()
        torques.append(data.actuator_force[world.servos].copy())
        address = data.contact.efc_address[: data.ncon]  # -1 for points that only come near
        pressed = address >= 0
        pressed[pressed] = data.efc_force[address[pressed]] > CARRIES
        points.append(sorted(map(tuple, data.contact.geom[: data.ncon][pressed].tolist())))

    run.step_physics = step
    run.run()
    steps = np.abs(np.diff(np.array(torques), axis=0)) / limits
    quiet = np.ones(len(steps), bool)
    for k in np.flatnonzero([a != b for a, b in pairwise(points)]):
        quiet[max(0, k - 1) : k + SETTLES] = False
    assert quiet.mean() > 0.5
    return np.asarray(steps[quiet].max(axis=0))


@pytest.mark.parametrize(("scene", "robot"), [("uneven", "h1"), ("flat", "hrp2kai")])
def test_no_torque_jumps_in_a_short_walk(scene, robot):
    assert torque_steps(scene, robot, ("steps=4",)).max() <= LIMIT


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("scene", WALKS)
def test_no_torque_jumps_in_any_scene(scene, robot):
    assert torque_steps(scene, robot).max() <= LIMIT
