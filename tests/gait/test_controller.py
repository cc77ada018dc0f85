"""Parts of the control tick that a walk on the flat would not miss at once."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import msgspec
import numpy as np
import pytest

from plantar.gait.command import Command, FootTarget
from plantar.gait.plan.plan_change import PlanChange
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.rotation import level_rotation
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


@pytest.fixture
def controller():
    return Simulation(load_scene("flat", ["steps=2"])).controller


def rolled(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


@pytest.mark.parametrize("yaw", [0.0, 0.7])
@pytest.mark.parametrize("aside", [0.04, -0.04])
def test_the_trunk_leans_over_the_foot_that_the_com_moves_to(controller, yaw, aside):
    places = [controller.footing.motion.footholds[side][0][:2] for side in ("left", "right")]
    left = level_rotation(yaw)[:, 1]
    com = np.array([*np.mean(places, axis=0), 0.8]) + aside * left
    torso = controller.body_targets.posture(com, yaw, 2.0)
    assert torso @ torso.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(torso) == pytest.approx(1.0)
    assert torso[:, 0] == pytest.approx(level_rotation(yaw)[:, 0], abs=1e-12)  # along the feet
    reach = min(abs(aside), controller.settings.lean_reach)
    assert torso[:, 2] @ left == pytest.approx(math.copysign(math.sin(2.0 * reach), aside), abs=1e-9)
    upright = controller.body_targets.posture(com - aside * left, yaw, 2.0)
    assert upright[:, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)


@pytest.mark.parametrize("lean", [0.03, -0.03])
def test_a_swing_foot_of_a_body_that_leans_comes_to_its_place_in_the_world(controller, lean):
    """What is commanded, seen from the body and turned by its lean, is the place that was wanted."""
    side = "left"
    controller.footing.motion = SimpleNamespace(last_side=side, landed=False)
    place, com = np.array([0.1, 0.085, 0.03]), np.array([0.02, -0.05, 0.8])
    state: Any = BaseState(
        rotation_base_to_world=rolled(lean),
        position_base=np.zeros(3),
        com=com.copy(),
        com_velocity=np.zeros(3),
        zmp=None,
        loads={"left": 0.0, "right": 800.0},
        positions_sole={},
        rotations_sole={},
    )
    phase: Any = next(p for p in controller.schedule.phases if p.swing == side)
    for _ in range(400):
        feet = {side: FootTarget(place, np.eye(3), np.zeros(3), np.zeros(2))}
        controller.foot_targets.compensate(feet, phase, com, 0.0, np.eye(3), state)
    target = feet[side]
    executed = state.com + rolled(lean) @ (target.position - com)
    assert executed == pytest.approx(place, abs=2e-3)
    assert np.linalg.norm(target.position - place) > 0.01  # it is no small thing
    sole = rolled(lean) @ target.rotation
    assert sole == pytest.approx(np.eye(3), abs=5e-3)
    # Landed, it carries: it does not make way for the body that leans onto it.
    controller.footing.motion.landed = True
    lower = state.changed(com=com - np.array([0.0, 0.0, 0.05]))
    controller.foot_targets.compensate(
        feet := {side: FootTarget(place, np.eye(3), np.zeros(3), np.zeros(2))}, phase, com, 0.0, np.eye(3), lower
    )
    assert feet[side].position.tolist() == target.position.tolist()


def first_tick(robot: str = "h1", settings: tuple[str, ...] = (), body: Any = None) -> tuple[Simulation, Command]:
    """A robot that stands, and the first command that it is given."""
    run = Simulation(load_scene("flat", ["steps=2", *settings], robot))
    run.controller.estimation.body = body
    for _ in range(20):
        run.step_physics()
    run.sensors.read_skins()
    return run, run.controller.step(run.sensors.read_body())


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_the_feet_carry_the_weight_within_their_soles(robot):
    run, command = first_tick(robot)
    forces = {side: foot.force for side, foot in command.feet.items()}
    assert sum(force[2] for force in forces.values()) == pytest.approx(run.body.weight, rel=0.02)
    for side, foot in command.feet.items():
        off = foot.center_of_pressure - foot.position[:2]
        low, high = run.robot.layouts[side].outline.min(axis=0), run.robot.layouts[side].outline.max(axis=0)
        assert (low <= off).all()
        assert (off <= high).all()
        assert foot.rotation == pytest.approx(np.eye(3), abs=1e-6)
    height = command.com[2] - 0.5 * sum(foot.position[2] for foot in command.feet.values())
    assert height == pytest.approx(run.settings.com_height, abs=1e-6)
    assert command.com[:2] == pytest.approx(command.state.com[:2], abs=0.02)


@pytest.mark.parametrize("source", ["skin", "force_torque"])
def test_loads_of_the_ankles_are_those_of_the_soles(source):
    run, command = first_tick(settings=("sensing.force_torque=true", f"zmp_source={source}"))
    assert sum(load.vertical_force for load in command.ankle_loads.values()) == pytest.approx(run.body.weight, rel=0.1)
    for side, load in command.ankle_loads.items():
        skin = command.percepts[side]
        assert load.vertical_force == pytest.approx(skin.vertical_force, rel=0.1)
        assert load.position_cop_in_sole == pytest.approx(skin.position_cop_in_sole, abs=0.01)


def test_a_body_whose_com_is_elsewhere_is_commanded_so():
    shift = np.array([0.012, -0.007, 0.003])
    body: Any = SimpleNamespace(known=False, com_shift=shift, lean=0.0, joint_offsets=None, stand=lambda *_: None)
    (_, plain), (_, shifted) = first_tick(settings=("identify=false",)), first_tick(body=body)
    assert plain.com - shifted.com == pytest.approx(shifted.rotation_torso @ shift, abs=1e-6)


@pytest.mark.parametrize("feedback", [True, False])
def test_feet_are_compensated_for_the_lean_where_feedback_is_on(feedback):
    run, _ = first_tick(settings=(f"feedback={str(feedback).lower()}",))
    run.controller.estimation._ticks = 1000  # the stand before feedback is over
    seen: list[Any] = []
    run.controller.foot_targets.compensate = lambda targets, *_: seen.append(targets)
    sensors = run.sensors.read_body()
    command = run.controller.step(msgspec.structs.replace(sensors, time=sensors.time + run.settings.period))
    assert seen == [command.feet] * feedback


def test_where_the_feet_level_themselves_each_tick_teaches_the_slope(controller):
    seen: list[tuple[Any, ...]] = []
    slope: Any = SimpleNamespace(update=lambda *given: seen.append(given), slope=lambda side: np.zeros(2))
    state: Any = SimpleNamespace(rotations_sole={"left": np.eye(3)}, loads={"left": 400.0, "right": 400.0})
    phases = controller.schedule.phases
    for phase in (phases[0], next(p for p in phases if p.swing)):
        controller.footing._level(slope, phase, state)
    assert [given[2] for given in seen] == [True, False]
    assert all(given[:2] == (state.rotations_sole, state.loads) for given in seen)


def test_silent_encoders_are_bridged_for_a_fifth_of_a_beat():
    run, _ = first_tick()
    sensors, period = run.sensors.read_body(), run.settings.period
    for ticks in range(1, 100):
        silent = msgspec.structs.replace(sensors, time=sensors.time + ticks * period, gyro=np.full(3, np.nan))
        run.controller.step(silent)
        if run.controller.safe_state == "blind":
            break
    assert ticks == round(0.2 * run.body.beat / period) + 1


@pytest.mark.parametrize("one_by_one", [False, True])
def test_steps_that_come_one_by_one_are_no_other_plan(one_by_one):
    run, _ = first_tick()
    change = PlanChange("a test", 0, shift=(0.01, 0.0))
    if one_by_one:
        change = PlanChange("a test", -1, following=tuple(replace(step, x=step.x + 0.01) for step in run.steps))
    proposer: Any = SimpleNamespace(priority=0, propose=lambda tick: change)
    run.controller._proposers = [proposer]
    sensors = run.sensors.read_body()
    command = run.controller.step(msgspec.structs.replace(sensors, time=sensors.time + run.settings.period))
    assert command.moved_steps
    assert run.controller.replans == (not one_by_one)


def test_on_a_leg_that_is_held_the_torso_leans_by_what_its_hips_need_and_by_its_own(controller):
    targets = controller.body_targets
    own = controller.settings.trunk_lean
    beat = controller.settings.body.beat
    ticks = round(2.0 * beat / controller.settings.period)
    leans = [targets._lean(0.5, holds=True) for _ in range(ticks)]
    assert leans[0] == pytest.approx(max(own, 0.5), abs=1e-2)
    assert leans[-1] == pytest.approx(own + 0.5)
    assert np.all(np.diff(leans) >= 0.0)
    assert [targets._lean(0.5, holds=False) for _ in range(ticks)][-1] == pytest.approx(max(own, 0.5))
