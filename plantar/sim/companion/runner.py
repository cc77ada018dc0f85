"""An experiment on a machine with skin that is built and ready to run."""

import time as clock
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import SceneError
from plantar.kernels.judging.joint_extremes import JointExtremes
from plantar.mujoco.foam_skins import FoamSkins
from plantar.recordings.recorder import Channel, Recorder
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.electronics import SkinElectronics
from plantar.sim.body_skin.surface import OBSTACLE_GROUP, skin_from_tables
from plantar.sim.companion.drives import Drives, Encoders
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import CompanionScene, World
from plantar.sim.companion.lidar import Lidar
from plantar.sim.companion.machine import Machine, ServoTable, load_machine
from plantar.sim.figures.film import BodyFilm
from plantar.sim.judging.joint_limits import AT_LIMIT
from plantar.sim.judging.outside_force import OutsideForce
from plantar.sim.judging.run_limits import limit_reasons
from plantar.sim.loop import Result, Run
from plantar.sim.model.world import add_looks


class Companion(Run):
    """A scene, ready to run; `seed` draws noise and the experiment's choices."""

    def __init__(self, scene: CompanionScene, seed: int) -> None:
        self.scene = scene
        self.seed = seed
        machine = load_machine(scene.robot)
        control = scene.control
        self.experiment = scene.experiment_type(machine, scene.experiment, control, seed)
        alone = machine.spec().compile()
        self.world = _build(machine, alone, self.experiment.add_to)
        body_skin = skin_from_tables(alone, machine.patches, f"machine '{machine.name}'")
        obstacles = np.flatnonzero(self.world.model.geom_group == OBSTACLE_GROUP).tolist()
        sensing = scene.skin
        self.skin = FoamSkins(self.world.model, body_skin, obstacles, sensing.foam, everything=sensing.everything)
        self._electronics = SkinElectronics(body_skin, sensing, seed)
        _misjudge(alone, control.model_error, seed)
        self.robot = MujocoDynamics(alone)
        self.controller: Any = self.experiment.controller(machine, body_skin)
        self.encoders = Encoders(self.world, control, seed)
        servo = machine.servo if control.servo == "machine" else ServoTable(kind=control.servo)
        self.drives = Drives(self.world, servo, control.period)
        self.lidar = None
        if scene.lidar is not None:
            self.lidar = Lidar(self.world.model, machine.base.link, scene.lidar, seed)
            self._scan_every = max(1, round(1.0 / (scene.lidar.rate * self.world.model.opt.timestep)))
        self.periods = float(self.world.model.opt.timestep), control.period
        self.skipped = Counter(rendered_frames=0)
        self._channels: tuple[Channel[Any], ...] | None = None
        data = self.world.data
        data.qpos[self.world.positions[-len(machine.posture) :]] = machine.posture
        base = int(self.world.model.body_rootid[self.world.model.body(machine.base.link).id])
        self.hands = _Hands(data, self.skin)
        self.outside = OutsideForce(self.world.model, data, base, (self.skin, self.hands))
        self.joints = JointExtremes(
            data.qvel,
            self.world.joints.astype(np.intp),
            np.zeros(len(self.world.joints)),
            data.actuator_force,
            self.world.motors.astype(np.intp),
            1.0 / (AT_LIMIT * machine.efforts),
        )
        self.experiment.start(self.world)
        mujoco.mj_forward(self.world.model, data)

    @property
    def end(self) -> float:
        return self.experiment.duration

    @property
    def ended(self) -> bool:
        return self.experiment.fell or self.experiment.done

    def state_text(self) -> str:
        return f"{self.world.data.time:.1f} of {self.experiment.duration:.1f} s"

    def open_log(self, path: Path, files: ExitStack) -> None:
        world = self.world
        skin = self.skin.body_skin
        metadata = {"scene": self.scene.name, "robot": world.machine.name, "seed": self.seed}
        recorder = files.enter_context(Recorder(path, metadata))
        fields = [(f"link_{i}_{part}", 3) for i in range(len(skin.links)) for part in ("force", "moment")]
        self._channels = (
            recorder.channel("/body_skin", [("force", len(skin))]),
            recorder.channel("/joints", [("position", len(world.positions)), ("torque", len(world.motors))]),
            recorder.channel("/truth/skin", fields),
        )

    def open_film(self, path: Path, files: ExitStack) -> Callable[[], None]:
        body, view = self.experiment.view
        world = self.world
        film = BodyFilm(path, world.model, world.data, self.skin, body or world.machine.base.link, view)
        return files.enter_context(film).add

    def summary(self, result: Result) -> dict[str, Any]:
        reasons, figures = self.experiment.verdict()
        at_limit = self.joints.any_held / max(1, self.joints.steps)
        reasons = [*reasons, *limit_reasons((), True, at_limit), *self.outside.reasons()]
        self.skipped.update(taxel_rays=self.skin.skipped, taxel_rays_cast=self.skin.cast)
        names = self.scene.name, self.world.machine.name
        common = self.common(result, names, reasons, self.experiment.fell, float(self.world.data.time))
        return {**common, **figures}

    def plot(self, folder: Path, recording: Path) -> Sequence[Path]:
        return self.experiment.plot(folder)

    def sense(self, k: int) -> None:
        data = self.world.data
        self.experiment.act(self.world, float(data.time))
        mujoco.mj_step1(self.world.model, data)
        self.skin.press(data)
        self.hands.acted()
        self._read()  # samples at the skin's own rate, whatever the control period
        if self.lidar is not None and k % self._scan_every == 0:
            self.controller.scan(self.lidar.scan(data))

    def control(self) -> float:
        data = self.world.data
        if not (np.isfinite(data.qpos).all() and np.abs(data.qvel).max(initial=0.0) < 1e3):
            raise SceneError(f"the simulation of scene '{self.scene.name}' became unstable at {data.time:.3f} s")
        reading = self._read()
        qpos, qvel = self.encoders.read()
        start = clock.perf_counter()
        self.robot.update(qpos, qvel, float(data.time))
        torque = self.controller.step(self.robot, reading)
        used = 1e6 * (clock.perf_counter() - start)
        self.drives.command(self.robot, torque)
        if self._channels is not None:
            rows = (reading.force,), (qpos, torque), (self.skin.wrenches.ravel(),)
            for channel, row in zip(self._channels, rows, strict=True):
                channel.write(float(data.time), *row)
        return used

    def _read(self) -> Reading:
        data = self.world.data
        return self._electronics.read(float(data.time), partial(self.skin.whole, data), self.experiment.temperature)

    def advance(self, steps: int = 1) -> int:
        data = self.world.data
        self.experiment.judge(self.world, self.skin, float(data.time))
        if not self.ended:
            self.drives.drive()
            mujoco.mj_step2(self.world.model, data)
            self.outside.step()
            self.joints.step()
        return 1


class _Hands:
    """What the experiment applies to bodies by `xfrc_applied` in its `act`: it is an actor of the scene."""

    def __init__(self, data: Any, skin: FoamSkins) -> None:
        self._on_bodies = data.xfrc_applied
        self._skin = skin
        self._applied = np.zeros_like(self._on_bodies)

    def acted(self) -> None:
        """Notes what is applied other than by the skin, before the controller has had its turn."""
        self._applied[:] = 0.0
        self._skin.add_applied(self._applied)
        np.subtract(self._on_bodies, self._applied, out=self._applied)

    def add_applied(self, forces: NDArray[np.float64]) -> None:
        """Add it to `forces` (bodies, 6)."""
        forces += self._applied


def _misjudge(model: Any, share: float, seed: int) -> None:
    if share:
        factors = 1.0 + np.clip(np.random.default_rng([seed, 0x3A55]).normal(0.0, share, model.nbody), -0.9, 0.9)
        model.body_mass[:] *= factors
        model.body_inertia[:] *= factors[:, None]
        mujoco.mj_setConst(model, mujoco.MjData(model))


def _build(machine: Machine, alone: Any, add_to: Callable[[Any], None]) -> World:
    spec = machine.spec()
    add_looks(spec, machine.base.link)
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
