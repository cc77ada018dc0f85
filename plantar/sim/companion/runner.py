"""Run a scene of the companion: physics, sensors, controller and judge, in the order in which they act."""

from __future__ import annotations

import math
import os
import time as clock
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.atomic import output_folder, parent_folder
from plantar.errors import InputError, SceneError
from plantar.sim.body_skin.sensing import SkinSensor
from plantar.sim.body_skin.surface import OBSTACLE_GROUP, skin_from_tables
from plantar.sim.companion.drives import Drives
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.encoders import Encoders
from plantar.sim.companion.experiment import World
from plantar.sim.companion.lidar import Lidar
from plantar.sim.companion.machine import Machine, ServoTable, load_machine
from plantar.sim.companion.scene import CompanionScene
from plantar.sim.figures.render import FRAME_RATE, Camera, VideoWriter

__all__ = ["Companion", "run_companion", "run_companion_to_files"]

Progress = Callable[[float, str], None]


class Companion:
    """A scene of the companion, built and ready to run.

    Args:
        scene: The scene.
        seed: Seed of sensor noise and of what the experiment leaves to chance.

    Attributes:
        world: The simulated world.
        experiment: The experiment.
        skin: The machine's skin sensor.

    Raises:
        RobotError: If the machine is not valid.
        SceneError: If the scene cannot be simulated.
    """

    def __init__(self, scene: CompanionScene, seed: int) -> None:
        self.scene, self.seed = scene, seed
        machine = load_machine(scene.robot)
        control = scene.control
        self.experiment = scene.experiment_type(machine, scene.experiment, control, seed)
        alone = machine.spec().compile()
        self.world = _build(machine, alone, self.experiment.add_to)
        body_skin = skin_from_tables(alone, machine.patches, f"machine '{machine.name}'")
        self.skin = SkinSensor(self.world.model, body_skin, scene.skin, seed)
        _misjudge(alone, control.model_error, seed)
        self.robot = MujocoDynamics(alone)
        self.controller: Any = self.experiment.controller(machine, body_skin)
        self.encoders = Encoders(self.world, control, seed)
        servo = machine.servo if control.servo == "machine" else ServoTable(kind=control.servo)
        self.drives = Drives(self.world, servo, control.period)
        self.lidar = None
        if scene.lidar is not None:
            self.lidar = Lidar(self.world.model, machine.base.link, scene.lidar, seed)
        self._scan_every = _steps(1.0 / scene.lidar.rate, self.world) if scene.lidar is not None else 0
        data = self.world.data
        data.qpos[self.world.positions[-len(machine.posture) :]] = machine.posture
        self.experiment.start(self.world)
        mujoco.mj_forward(self.world.model, data)

    def run(self, film: Callable[[], None] | None = None, progress: Progress | None = None) -> dict[str, Any]:
        """Run to the end of the experiment, or until the machine falls.

        Args:
            film: Called at every frame of a video.
            progress: Called about ten times a second with the fraction done and a text.

        Returns:
            The summary.

        Raises:
            SceneError: If the simulated physics becomes unstable.
        """
        world, data, experiment = self.world, self.world.data, self.experiment
        every, frame = _steps(self.scene.control.period, world), _steps(1.0 / FRAME_RATE, world)
        count = math.ceil(experiment.duration / world.model.opt.timestep)
        ticks: list[float] = []
        began = shown = clock.perf_counter()
        for k in range(count):
            experiment.act(world, float(data.time))
            mujoco.mj_step1(world.model, data)
            self.skin.apply(data)
            if self.lidar is not None and k % self._scan_every == 0:
                self.controller.scan(self.lidar.scan(data))
            if k % every == 0:
                self._check()
                ticks.append(self._tick())
            experiment.judge(world, self.skin, float(data.time))
            if experiment.fell or experiment.done:
                break
            if film is not None and k % frame == 0:
                film()
            if progress is not None and clock.perf_counter() - shown > 0.1:
                shown = clock.perf_counter()
                progress(data.time / experiment.duration, f"{data.time:.1f} of {experiment.duration:.1f} s")
            self.drives.drive()
            mujoco.mj_step2(world.model, data)
        return self._summary(ticks, clock.perf_counter() - began)

    def _tick(self) -> float:
        """One control period; how long it took in us."""
        reading = self.skin.read(self.world.data)
        qpos, qvel = self.encoders.read()
        start = clock.perf_counter()
        self.robot.update(qpos, qvel, float(self.world.data.time))
        torque = self.controller.step(self.robot, reading)
        took = clock.perf_counter() - start
        self.drives.command(self.robot, torque)
        return 1e6 * took

    def _check(self) -> None:
        data = self.world.data
        if not (np.isfinite(data.qpos).all() and np.abs(data.qvel).max(initial=0.0) < 1e3):
            raise SceneError(f"the simulation of scene '{self.scene.name}' became unstable at {data.time:.3f} s")

    def _summary(self, ticks: list[float], wall: float) -> dict[str, Any]:
        reasons, figures = self.experiment.verdict()
        time = float(self.world.data.time)
        return {
            "scene": self.scene.name,
            "robot": self.world.machine.name,
            "seed": self.seed,
            "completed": not reasons and not self.experiment.fell,
            "reasons": reasons,
            "fell": self.experiment.fell,
            "sim_time_s": round(time, 4),
            "wall_time_s": round(wall, 4),
            "real_time_factor": round(time / max(wall, 1e-9), 2),
            "control_us": {
                "p50": round(float(np.percentile(ticks, 50)), 1),
                "p99": round(float(np.percentile(ticks, 99)), 1),
            },
            "skipped": {"taxel_rays": self.skin.skipped, "taxel_rays_cast": self.skin.cast},
            **figures,
        }


def _steps(period: float, world: World) -> int:
    """Physics steps in a period in s, one at least."""
    return max(1, round(period / float(world.model.opt.timestep)))


def _misjudge(model: Any, share: float, seed: int) -> None:
    """Change the masses of the model that the controller has, each by its own share."""
    if share:
        factors = 1.0 + np.clip(np.random.default_rng([seed, 0x3A55]).normal(0.0, share, model.nbody), -0.9, 0.9)
        model.body_mass[:] *= factors
        model.body_inertia[:] *= factors[:, None]
        mujoco.mj_setConst(model, mujoco.MjData(model))


def _build(machine: Machine, alone: Any, add_to: Callable[[Any], None]) -> World:
    """Compile the machine with what an experiment puts around it, and find its coordinates again."""
    spec = machine.spec()
    add_to(spec)
    try:
        model = spec.compile()
    except ValueError as error:
        raise SceneError(f"the world cannot be simulated: {' '.join(str(error).split())}") from None
    positions: list[int] = []
    speeds: list[int] = []
    for j in range(alone.njnt):
        body = alone.jnt_bodyid[j]
        there = model.body(alone.body(body).name).jntadr[0] + j - alone.body_jntadr[body]
        free = alone.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE
        positions += range(model.jnt_qposadr[there], model.jnt_qposadr[there] + (7 if free else 1))
        speeds += range(model.jnt_dofadr[there], model.jnt_dofadr[there] + (6 if free else 1))
    names = list(machine.joints)
    return World(
        machine=machine,
        model=model,
        data=mujoco.MjData(model),
        positions=np.array(positions),
        speeds=np.array(speeds),
        motors=np.array([model.actuator(name).id for name in names]),
        joints=np.array([model.joint(name).dofadr[0] for name in names]),
    )


def run_companion(scene: CompanionScene, seed: int = 0, progress: Progress | None = None) -> dict[str, Any]:
    """Run a scene of the companion.

    Args:
        scene: The scene.
        seed: Seed of sensor noise and of what the experiment leaves to chance.
        progress: Called about ten times a second with the fraction done and a text.

    Returns:
        The summary.
    """
    return Companion(scene, seed).run(progress=progress)


def run_companion_to_files(
    scene: CompanionScene,
    seed: int,
    *,
    record: str | os.PathLike[str] | None = None,
    video: Path | None = None,
    plot: Path | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Run a scene of the companion, film it and draw its figures.

    Args:
        scene: The scene.
        seed: Seed of what is left to chance.
        record: Must be None: recordings are of soles.
        video: File of the video, .mp4; None makes none.
        plot: Folder of the figures; None draws none.
        progress: Called with the fraction done and a text.

    Returns:
        The summary, with the paths of the figures under "figures" where they were drawn.

    Raises:
        InputError: If a recording is asked for, or a file cannot be written.
        SceneError: If the scene cannot be run.
    """
    if record is not None:
        raise InputError(f"scene '{scene.name}' has no soles to record; allowed: --plot, --video")
    with ExitStack() as stack:
        folder = None if plot is None else stack.enter_context(output_folder(plot))
        if video is not None:
            stack.enter_context(parent_folder(video))
        companion = Companion(scene, seed)
        film = None
        if video is not None:
            world = companion.world
            body, view = companion.experiment.view
            camera = Camera(
                world.model, world.model.body(body or world.machine.base.link).id, view=view, groups=[OBSTACLE_GROUP]
            )
            stack.callback(camera.close)
            writer = stack.enter_context(VideoWriter(video))

            def film() -> None:
                writer.add(camera.picture(world.data))

        summary = companion.run(film, progress)
        if plot is not None and folder is not None:
            summary["figures"] = [str(plot / file.name) for file in companion.experiment.plot(folder)]
    return summary
