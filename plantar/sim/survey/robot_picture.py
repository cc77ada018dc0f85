"""A picture of a standing robot with its sole frames."""

from itertools import pairwise
from pathlib import Path

import mujoco
import numpy as np

from plantar.common.sides import SIDES
from plantar.gait.plan.footsteps import straight_plan
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot import Robot
from plantar.robots.survey.plan_reach import settled
from plantar.sim.figures.render import Camera, Line, View, save_picture
from plantar.sim.model.world import World, build_world
from plantar.sim.terrain import Ground, Terrain

_VIEWS = ((180.0, -8.0), (90.0, -8.0), (145.0, -30.0))  # azimuth and elevation in degrees: front, side, from above
_WIDTH = 640
_HEIGHT = 900
_BONE = (0.25, 0.27, 0.3, 1.0)
_COLOURS = ((0.85, 0.2, 0.2, 1.0), (0.2, 0.65, 0.25, 1.0), (0.2, 0.35, 0.85, 1.0))


def draw_robot(robot: Robot, path: Path) -> Path:
    """Draw the `robot` at `path`, sole axes in red, green and blue; returns the path."""
    legs = build_leg_model(robot)
    settled(robot, legs, straight_plan(0, width=robot.stance_width)[0], robot.com_height)
    world = build_world(robot, Ground((), 0.0, Terrain.friction))
    data = world.data
    data.qpos[:] = legs.configuration
    mujoco.mj_forward(world.model, data)
    tall = float((data.geom_xpos[:, 2] + world.model.geom_rbound)[world.model.geom_bodyid > 0].max())
    length = 1.3 * float(robot.layouts["left"].outline[:, 0].max())  # ahead of the toes
    lines = _bones(robot, world)
    for side in SIDES:
        lines += _axes(data, world.sole_sites[side], length)
    pictures = []
    for azimuth, elevation in _VIEWS:
        above = float(data.xpos[world.torso, 2])
        view = View(1.5 * tall, azimuth, elevation, above - 0.5 * tall)
        if elevation < -20.0:
            view = View(0.75 * tall, azimuth, elevation, above - 0.1 * tall)
        camera = Camera(world.model, world.torso, _WIDTH, _HEIGHT, view)
        try:
            pictures.append(camera.picture(data, lines))
        finally:
            camera.close()
    return save_picture(np.concatenate(pictures, axis=1), path)


def _bones(robot: Robot, world: World) -> list[Line]:
    model = world.model
    data = world.data
    chains = {s: [data.xanchor[model.joint(n).id].copy() for n in robot.legs[s].joints] for s in SIDES}
    ends = [(chains["left"][0], chains["right"][0])]
    ends += [pair for chain in chains.values() for pair in pairwise(chain)]
    sizes = [float(np.linalg.norm(b - a)) for a, b in ends]
    return [Line(a, b, 0.03 * max(sizes), _BONE) for (a, b), size in zip(ends, sizes, strict=True) if size > 1e-3]


def _axes(data: mujoco.MjData, site: int, length: float) -> list[Line]:
    start = data.site_xpos[site].copy()
    rotation = data.site_xmat[site].reshape(3, 3)
    return [Line(start, start + length * rotation[:, i], 0.03 * length, colour) for i, colour in enumerate(_COLOURS)]
