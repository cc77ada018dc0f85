"""A robot with plantar skin as a Gymnasium environment."""

import math
import os
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance, number, positive
from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.mujoco.bound_skin import SkinReading
from plantar.mujoco.skin import Skin
from plantar.robots.controller_settings import com_height_of
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot_file import load_robot
from plantar.robots.start import start_of_walk
from plantar.robots.walk import Walk
from plantar.sensing.taxel_faults import TaxelFaults, WornFaults
from plantar.sim.environments.gymnasium_base import Env, spaces
from plantar.sim.environments.tasks import TASKS, Task
from plantar.sim.figures.render import Camera, View
from plantar.sim.model.world import DIVERGED, build_world
from plantar.sim.run.servos import LegServos
from plantar.sim.run.standing import stand
from plantar.sim.sensing.sensors import imu_to

_FALLEN_UP = math.cos(0.7)  # the torso's z against the world's
_FALLEN_HEIGHT = 0.7  # of the height of the torso when standing


class PlantarEnv(Env[dict[str, NDArray[np.float32]], NDArray[np.float32]]):
    """A robot with skin under its soles, and a task.

    An action (k,) of -1 to 1 moves the leg joints' set-points from standing by `scale` rad. Observed, in float32:

    - joints (2 k,): angles from standing in rad, velocities in rad/s;
    - imu (9,), in the torso's frame: gyro in rad/s, accelerometer in m/s^2, gravity's direction;
    - skin_left, skin_right (n,): force on each taxel in body weights;
    - task (m,): see `plantar.sim.environments.tasks`.

    An episode ends where the torso tilts by 40 degrees or sinks by 30 %, physics diverge, or the task can no longer be
    done, so that the action 0 ends most episodes of each task early. `info`: "time" in s, "velocity" (2,) in m/s in its
    heading, "load" of both soles in body weights, "fell" and "failed", and the task's.

    `task`: "stand", "step", "walk" or "board"; `period`: step in s, whole `physics_period`s; `faults` of taxels, drawn
    at each reset, or None; `scale`: angle in rad of an action of 1; `difficulty`: scales pushes, ground and commands; 0
    or more; `render_mode`: "rgb_array" or None.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}  # noqa: RUF012

    def __init__(
        self,
        task: str = "stand",
        robot: str | os.PathLike[str] = "h1",
        *,
        period: float = 0.02,
        physics_period: float = 0.002,
        skin: bool = True,
        faults: TaxelFaults | None = None,
        scale: float = 0.3,
        difficulty: float = 1.0,
        render_mode: str | None = None,
    ) -> None:
        if task not in TASKS:
            raise InputError(f"task is {task!r}; allowed: {', '.join(TASKS)}")
        if render_mode not in (None, "rgb_array"):
            raise InputError(f"render_mode is {render_mode!r}; allowed: rgb_array or None")
        step = positive(physics_period, "physics_period", "s")
        self._substeps = round(min(positive(period, "period", "s") / step, 1e6))
        self.period = self._substeps * step
        if not math.isclose(self.period, period, rel_tol=1e-6):
            raise InputError(f"period is {period} s; allowed: whole multiples of physics_period, {step} s")
        self.scale = number(scale, "scale", finite=True)
        self.difficulty = number(difficulty, "difficulty", finite=True)
        if self.difficulty < 0.0:
            raise InputError(f"difficulty is {difficulty}; allowed: 0 or more")
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": round(1.0 / self.period)}
        self.robot = load_robot(robot)
        self.faults = None if faults is None else instance(faults, TaxelFaults, "faults")
        legs = build_leg_model(self.robot)
        self.body = body_of(self.robot, legs.model)
        self.task: Task = TASKS[task](self)
        self.world = build_world(self.robot, self.task.ground(), step)
        self.model = self.world.model
        self.data = self.world.data
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE  # its boxes do not follow moved ground
        walk = Walk().for_body(self.body)
        height = com_height_of(walk, self.robot)
        feet = start_of_walk(walk, self.robot, height).feet
        centers = {s: vrp_of_step(feet[s], self.robot.middle_of_sole(s)) for s in SIDES}
        stand(self.world, legs, LegServos(self.world, legs, self.period), feet, centers, height)
        self._start = self.data.qpos.copy(), self.data.ctrl.copy()
        self._height = float(self.data.xpos[self.world.torso, 2])
        self.skins = {side: self._skin(side).bind(self.model) for side in SIDES}
        self.readings: dict[Side, SkinReading] = {}
        self._worn: dict[Side, WornFaults] = {}
        k = len(self.world.servos)
        self.last_action = np.zeros(k, dtype=np.float32)
        self.action_space = spaces.Box(-1.0, 1.0, (k,), np.float32)
        boxes = {"joints": _box(2 * k), "imu": _box(9), "task": _box(self.task.size)}
        if skin:
            low = 0.0 if faults is None else -np.inf
            boxes |= {f"skin_{side}": _box(len(self.robot.layouts[side]), low) for side in SIDES}
        self.observation_space = spaces.Dict(boxes)
        turn = imu_to(self.world, self.world.torso)
        self._imu_to_torso = np.eye(3) if turn is None else turn
        self._camera: Camera | None = None

    def _skin(self, side: Side) -> Skin:
        leg = self.robot.legs[side]
        geoms = [self.model.geom(g).name for g in self.world.sole_geoms[side]]
        return Skin(self.robot.layouts[side], leg.foot_body, site=leg.sole_site, geoms=geoms, reach=self.world.reach)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, Any]]:
        """Returns observation and info on ground drawn by `seed`, joints off by 0.01 rad; `options` are unused."""
        super().reset(seed=seed)
        data = self.data
        world = self.world
        mujoco.mj_resetData(self.model, data)
        self.task.reset(self.np_random)
        data.qpos[:], data.ctrl[:] = self._start
        data.qpos[world.joint_qpos] += self.np_random.normal(0.0, 0.01, len(world.joint_qpos))
        self.last_action[:] = 0.0
        mujoco.mj_forward(self.model, data)
        if self.faults is not None:
            layouts = self.robot.layouts
            self._worn = {s: self.faults.worn(layouts[s], self.np_random.integers(2**63)) for s in SIDES}
        self.task.disturb(self.np_random)  # its first target or command is observed
        return self._observe(), self._info()

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[dict[str, NDArray[np.float32]], float, bool, bool, dict[str, Any]]:
        """One control step.

        `action`: set-points (k,), clipped to -1..1. Returns observation, reward, whether it fell or failed the task,
        False (`TimeLimit` truncates), and info.
        """
        moved = np.clip(np.asarray(action, dtype=np.float32), -1.0, 1.0)
        if moved.shape != self.last_action.shape or not np.isfinite(moved).all():
            raise InputError(f"action has shape {moved.shape}; expected {self.last_action.shape} finite numbers")
        if not self.readings:
            raise InputError("the environment has no episode yet; call reset() before step()")
        data = self.data
        servos = self.world.servos
        data.ctrl[servos] = self._start[1][servos] + self.scale * moved
        self.task.disturb(self.np_random)
        mujoco.mj_step(self.model, data, self._substeps)
        observation = self._observe()
        reward = self.task.reward() - 0.05 * float(np.square(moved - self.last_action).mean())
        self.last_action[:] = moved
        height = data.xpos[self.world.torso, 2]
        lost = data.warning.number[list(DIVERGED)].any()  # MuJoCo has put it back to its reference pose
        fell = bool(lost or not self.up > _FALLEN_UP or height < _FALLEN_HEIGHT * self._height)
        failed = self.task.failed
        return observation, reward, fell or failed, False, {**self._info(), "fell": fell, "failed": failed}

    def render(self) -> Any:
        """A picture (480, 640, 3) of the robot; None without a render mode."""
        if self.render_mode is None:
            return None
        if self._camera is None:
            view = View(4.0 * self.body.leg, below=0.4 * self.body.leg)
            self._camera = Camera(self.model, self.world.torso, 640, 480, view, fast=True)
        return self._camera.picture(self.data)

    @property
    def up(self) -> float:
        """The torso's z, upwards."""
        return float(self.data.xmat[self.world.torso, 8])

    @property
    def velocity(self) -> NDArray[np.float64]:
        """The torso's velocity (forward, left) in m/s in its heading, and turn in rad/s."""
        data = self.data
        torso = self.world.torso
        root = self.model.body_rootid[torso]
        spin = data.xmat[root].reshape(3, 3) @ data.qvel[3:6]
        vx, vy, _ = data.qvel[:3] + np.cross(spin, data.xpos[torso] - data.xpos[root])
        c, s = data.xmat[torso, [0, 3]]
        length = math.hypot(c, s) or 1.0
        return np.array([(c * vx + s * vy) / length, (c * vy - s * vx) / length, float(spin[2])])

    def _observe(self) -> dict[str, NDArray[np.float32]]:
        data = self.data
        world = self.world
        self.readings = {side: self.skins[side](data) for side in SIDES}
        sensed = data.sensordata
        measured = (self._imu_to_torso @ sensed[at : at + 3] for at in (world.gyro, world.accelerometer))
        imu = [*measured, -data.xmat[world.torso].reshape(3, 3)[2]]
        joints = [data.qpos[world.joint_qpos] - self._start[0][world.joint_qpos], data.qvel[world.joint_qvel]]
        seen = {"joints": np.concatenate(joints), "imu": np.concatenate(imu), "task": self.task.observe()}
        if "skin_left" in self.observation_space.spaces:
            for side, reading in self.readings.items():
                force = reading.force
                if self._worn:
                    force = np.nan_to_num(self._worn[side].read(reading.time, force, reading.vectors))
                seen[f"skin_{side}"] = force / (self.body.mass * GRAVITY)
        return {name: np.asarray(value, dtype=np.float32) for name, value in seen.items()}

    def _info(self) -> dict[str, Any]:
        load = np.array([self.readings[s].wrench[2] for s in SIDES]) / (self.body.mass * GRAVITY)
        return {"time": float(self.data.time), "velocity": self.velocity[:2], "load": load, **self.task.info()}


def _box(size: int, low: float = -np.inf) -> spaces.Box:
    return spaces.Box(low, np.inf, (size,), np.float32)
