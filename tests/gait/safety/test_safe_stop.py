"""A robot that cannot go on sits down on both feet, or goes limp, without a jump."""

from itertools import pairwise

import numpy as np
import pytest

from plantar.gait.command import Command
from plantar.gait.safety.safe_stop import SafeStop
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


@pytest.fixture(scope="module")
def swinging():
    """A command in a single support, with the left foot 3 cm up."""
    run = Simulation(load_scene("flat", ["steps=2"]))
    run.sensors.read_skins()
    command = run.controller.step(run.sensors.read_body())
    phase = next(p for p in run.controller.schedule.phases if p.swing == "left")
    foot = command.feet["left"]
    up = foot.changed(position=foot.position + np.array([0.0, 0.0, 0.03]))
    return run, command.changed(phase=phase, feet={"left": up, "right": command.feet["right"]})


def after(run: Simulation, command: Command, state: str, seconds: float) -> list[Command]:
    s = run.settings
    stop, found = SafeStop(s.period, s.body.leg, s.body.beat, s.body.weight), [command]
    for _ in range(round(seconds / s.period)):
        found.append(stop.after(found[-1], state))
    return found


@pytest.mark.parametrize("state", ["blind", "lost"])
def test_a_blind_robot_puts_its_foot_down_and_then_sits(swinging, state):
    run, command = swinging
    found = after(run, command, state, 4.0)
    left, right = (found[-1].feet[side].position for side in ("left", "right"))
    assert left[2] == pytest.approx(right[2])
    assert found[-1].com[:2] == pytest.approx(0.5 * (left + right)[:2], abs=1e-9)
    assert command.com[2] - found[-1].com[2] == pytest.approx(0.08 * run.body.leg)
    down = next(k for k, c in enumerate(found) if c.feet["left"].position[2] == pytest.approx(right[2]))
    assert (found[down - 1].com == command.com).all()  # not before the foot is down
    forces = [found[-1].feet[side].force for side in ("left", "right")]
    assert np.sum(forces, axis=0)[2] == pytest.approx(sum(f.force[2] for f in command.feet.values()), rel=1e-6)
    ticks = [np.abs(b.com - a.com).max() for a, b in pairwise(found)]
    assert max(ticks) < 0.5e-3


def test_a_fallen_robot_goes_limp_in_half_a_second(swinging):
    run, command = swinging
    found = after(run, command, "fallen", 0.6)
    assert found[50].stiffness == pytest.approx(0.5)
    assert found[50].feet["right"].force == pytest.approx(0.5 * command.feet["right"].force)
    assert found[-1].stiffness == 0.0
    assert not found[-1].feet["right"].force.any()
    assert found[-1].feet["right"].position == pytest.approx(command.feet["right"].position)


def test_servos_of_a_limp_robot_hold_no_joint():
    run = Simulation(load_scene("flat", ["steps=2"]))
    run.sensors.read_skins()
    command = run.controller.step(run.sensors.read_body())
    run.servos.command(command.changed(stiffness=0.0))
    run.world.data.qpos[run.world.joint_qpos] += 0.1
    run.servos.drive()
    assert run.world.data.ctrl[run.world.servos] == pytest.approx(run.world.data.qpos[run.world.joint_qpos])


@pytest.mark.parametrize("state", ["late", "no way on"])
def test_other_states_hold(swinging, state):
    run, command = swinging
    held = after(run, command, state, 0.1)[-1]
    assert (held.com == command.com).all()
    assert held.feet["left"] is command.feet["left"]
