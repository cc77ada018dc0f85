"""Legs collide with each other, and with nothing else."""

from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
import pytest

import plantar.sim.model.world
from plantar.errors import SceneError
from plantar.robots import Robot, load_robot
from plantar.robots.leg_shapes import COLLIDES
from plantar.sim.judging.leg_contact import LegContact, legs_that_touch
from plantar.sim.model.world import World, build_world
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.terrain import Ground

GROUND = Ground((), 0.0, 0.8)


def shapes(world: World, side: str) -> list[int]:
    return [g for g in range(world.model.ngeom) if world.model.geom_contype[g] == COLLIDES[side][0]]


def placed(world: World) -> None:
    """Put a world's robot into its posture, in the air."""
    for side, leg in world.robot.legs.items():
        for name, angle in zip(leg.joints, world.robot.posture[side], strict=True):
            world.data.joint(name).qpos[0] = angle
    world.data.qpos[2] = 2.0
    mujoco.mj_forward(world.model, world.data)


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_thigh_shank_and_foot_are_clear_of_the_other_leg_in_the_robots_posture(robot):
    world = build_world(load_robot(robot), GROUND)
    placed(world)
    assert legs_that_touch(world) is None
    bodies = {s: [world.model.body(world.model.geom_bodyid[g]).name for g in shapes(world, s)] for s in COLLIDES}
    assert bodies == {s: [f"{s}_thigh", f"{s}_shank", f"{s}_foot"] for s in COLLIDES}
    for a in shapes(world, "left"):
        for b in shapes(world, "right"):
            assert mujoco.mj_geomDistance(world.model, world.data, a, b, 1.0, None) > 0.005


def test_a_shape_meets_the_other_legs_shapes_and_above_the_foot_the_ground(h1):
    world = build_world(h1, GROUND)
    model = world.model
    ground = [model.geom("ground").id]
    for side, other in (("left", "right"), ("right", "left")):
        for g in shapes(world, side):
            meets = [
                k
                for k in range(model.ngeom)
                if model.geom_contype[g] & model.geom_conaffinity[k]
                or model.geom_contype[k] & model.geom_conaffinity[g]
            ]
            is_foot = model.geom(g).name == f"{side}_foot_shape"  # which has its sole for the ground
            assert meets == ([] if is_foot else ground) + shapes(world, other)


@pytest.mark.parametrize(("angle", "link"), [(-0.06, "foot"), (-0.25, "thigh")])
def test_a_leg_that_swings_into_the_other_is_seen(h1, angle, link):
    world = build_world(h1, GROUND)
    placed(world)
    watch = LegContact(world)
    watch.step()
    assert (watch.duration, watch.first) == (0.0, None)
    world.data.sensordata[world.leg_contact] = 1.0  # one point is a touch
    watch.step()
    assert watch.duration == 0.001
    world.data.joint("left_hip_roll").qpos[0] = angle
    mujoco.mj_forward(world.model, world.data)
    watch.step()
    watch.step()
    assert watch.first[1:] == (f"left_{link}", f"right_{link}")
    assert watch.duration == pytest.approx(0.003)


def test_legs_whose_first_links_have_no_name_are_seen_to_touch(h1, monkeypatch):
    named = plantar.robots.kinematics.robot_model.robot_spec

    def unnamed(robot: Robot) -> Any:
        spec = named(robot)
        for leg in robot.legs.values():
            spec.joint(leg.joints[0]).parent.name = ""
        return spec

    monkeypatch.setattr(plantar.sim.model.world, "robot_spec", unnamed)
    world = build_world(h1, GROUND)
    placed(world)
    watch = LegContact(world)
    world.data.joint("left_hip_roll").qpos[0] = -0.25
    mujoco.mj_forward(world.model, world.data)
    watch.step()
    assert watch.duration == pytest.approx(0.001)


def test_hips_that_are_close_together_get_thinner_thighs(h1):
    assert h1.biped is not None
    narrow = replace(h1, biped=replace(h1.biped, hip_offset=(0.0, 0.035, -0.1435), ankle_offset=(0.0, 0.04)))
    world, usual = build_world(narrow, GROUND), build_world(h1, GROUND)
    thigh = shapes(world, "left")[0]
    assert 0.0 < world.model.geom_size[thigh, 0] < 0.9 * usual.model.geom_size[thigh, 0]
    placed(world)
    assert legs_that_touch(world) is None


def test_feet_that_overlap_where_they_stand_are_refused():
    with pytest.raises(SceneError, match=r"0.100 m apart: left_foot and right_foot touch.*stance_width"):
        Simulation(load_scene("flat", ["stance_width=0.1"]))


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_legs_that_keep_apart_move_as_if_they_had_no_shapes_to_the_last_bit(robot):
    ends = []
    for kept in (True, False):
        simulation = Simulation(load_scene("flat", ["steps=1", "settle=0.2", "t_ss=0.9", "t_ds=0.3"], robot))
        if not kept:
            model = simulation.world.model
            of_legs = np.isin(model.geom_contype, [contype for contype, _ in COLLIDES.values()])
            model.geom_contype[of_legs] = model.geom_conaffinity[of_legs] = 0
        simulation.run()
        ends.append(simulation.world.data.qpos.copy())
    assert np.array_equal(*ends)


def test_a_shank_above_a_low_ankle_is_off_the_ground(h1):
    usual = build_world(h1, GROUND)
    lowered = replace(h1, biped=replace(h1.biped, ankle_height=0.03))
    world = build_world(lowered, GROUND)
    placed(world)
    for side, leg in lowered.legs.items():
        sole = world.data.site(leg.sole_site).xpos[2]
        for g in shapes(world, side):
            name = world.model.body(world.model.geom_bodyid[g]).name
            radius, half, _ = world.model.geom_size[g]
            if name != f"{side}_foot":
                lowest = world.data.geom_xpos[g, 2] - half * abs(world.data.geom_xmat[g, 8]) - radius
                assert lowest >= sole + 0.005 * lowered.com_height
                thinner = radius < usual.model.geom_size[g, 0]
                assert thinner == (name == f"{side}_shank")
