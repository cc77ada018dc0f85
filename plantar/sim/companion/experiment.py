"""An experiment of the companion: surroundings, actors, success, and its scene."""

import pkgutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.extensions import extensions
from plantar.common.settings.overrides import owner_of, put_settings, split_setting
from plantar.common.settings.schema import Settings, choice, number
from plantar.common.settings.unknown_keys import nearest, refuse_other_than_texts, refuse_unknown_keys
from plantar.errors import SceneError
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.electronics import SkinSensing
from plantar.sim.body_skin.surface import OBSTACLE_GROUP
from plantar.sim.companion.lidar import LidarSettings
from plantar.sim.companion.machine import Machine
from plantar.sim.figures.render import View
from plantar.sim.judging.unmet import unmet as unmet  # for experiments
from plantar.sim.papers.preset import with_paper
from plantar.wholebody.dynamics import RobotDynamics


class CompanionControl(Settings):
    """How the machine is controlled, and how well it knows its motion.

    Attributes:
        period: Control period.
        servo: Input of the drives; "machine": as in its file.
        encoder_noise: Standard deviation of joint positions, in rad or m.
        velocity_noise: Of joint speeds, in rad/s or m/s.
        gyro_noise: Of its angular velocity.
        model_error: Standard deviation of link masses and inertias, as a share; drawn once.
    """

    period: float = number(0.002, "s", 0.001, 0.1)
    servo: str = choice("machine", "torque", "velocity", "position")
    encoder_noise: float = number(2e-5, "rad", 0, 0.1)
    velocity_noise: float = number(1e-3, "rad/s", 0, 1)
    attitude_noise: ClassVar[float] = 0.0002  # rad: standard deviation of a floating base's orientation
    gyro_noise: float = number(2e-3, "rad/s", 0, 1)
    model_error: float = number(0.0, "1", 0, 0.3)


class Controller(Protocol):
    """What drives the machine."""

    def step(self, robot: RobotDynamics, reading: Reading) -> NDArray[np.float64]:
        """Returns joint torques (k,) in N m or N, gravity included, in the order of `robot.joints`.

        `robot` is at the measured state, `reading` that of the skin.
        """


class Verdict(NamedTuple):
    """Outcome of an experiment.

    Attributes:
        reasons: Criteria that are not met, of `unmet`.
        figures: The experiment's own figures by name; JSON values.
    """

    reasons: list[dict[str, Any]]
    figures: dict[str, Any]


AWAY = (0.0, 0.0, 5.0)
"""Place in m of a moved body that is not used."""


def add_moved(
    spec: Any, name: str, kind: Any, size: Sequence[float], rgba: Sequence[float] = (0.85, 0.6, 0.45, 1.0)
) -> None:
    """Add a moved body `name`, far away, to a `spec`: its geom of `kind`, `size`, `rgba` is measured by skin only."""
    body = spec.worldbody.add_body(name=name, mocap=True, pos=AWAY)
    shape = body.add_geom(name=name, type=kind, size=size, group=OBSTACLE_GROUP, rgba=rgba)
    shape.contype = 0
    shape.conaffinity = 0


@dataclass(frozen=True)
class World:
    """The simulated machine and its surroundings; `model` and `data` are the truth.

    `positions`: places (nq of machine alone,) in `data.qpos`, in its own model's order; `speeds` in `data.qvel`;
    `motors`: places (k,) of motors in `data.ctrl`; `joints` of their joints in `data.qvel`.
    """

    machine: Machine
    model: Any
    data: Any
    positions: NDArray[np.int64]
    speeds: NDArray[np.int64]
    motors: NDArray[np.int64]
    joints: NDArray[np.int64]

    def pose(self, body: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """True origin (3,) of a body in m, rotation (3, 3) to the world."""
        found = self.data.body(body)
        return found.xpos.copy(), found.xmat.reshape(3, 3).copy()


class Experiment:
    """Base of experiments; the `seed` draws places, times, forces, directions.

    Attributes:
        duration: Simulated time in s.
        fell: Whether the machine fell, which ends the run.
        done: Whether all is finished, likewise.
        temperature: True (N,) in degC of the skin's taxels by a heat model, or None.
        settings_type: Class of the scene's table `[experiment]`.
        control_type: Class of the scene's table `[control]`: the controller's gains and switches.
        columns: Names of those figures that a sweep writes into columns.
        claims: What it shows, by criterion: what `verdict` looks at.
        uses_lidar: Whether the controller's `scan` takes nearest points (m, 2) of things, base frame, in m.
        view: Body that a video follows (the base where empty), and from where.
    """

    settings_type: ClassVar[type[Settings]] = Settings
    control_type: ClassVar[type[CompanionControl]] = CompanionControl
    columns: ClassVar[tuple[str, ...]] = ()
    claims: ClassVar[Mapping[str, str]] = {}
    uses_lidar: ClassVar[bool] = False
    view: ClassVar[tuple[str, View]] = ("", View())

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        self.machine = machine
        self.settings = settings
        self.control = control
        self.seed = seed
        self.duration = 5.0
        self.fell = False
        self.done = False
        self.temperature: NDArray[np.float64] | None = None
        self.rng = np.random.default_rng([seed, 0xE])

    def add_to(self, spec: Any) -> None:
        """Add obstacles and probes to the `mujoco.MjSpec`; skin measures those of `OBSTACLE_GROUP`."""

    def start(self, world: World) -> None:
        """Put everything in its first place, the machine in its posture."""

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        """Returns the controller of a `machine` with `skin`; called once."""
        raise NotImplementedError

    def act(self, world: World, time: float) -> None:
        """Move actors in the `world` at `time` in s, each physics step, with forces in `data.qfrc_applied`."""

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        """Look at the true `world` and the skin, `sensor`, at `time` in s, each physics step."""

    def verdict(self) -> Verdict:
        """The verdict, after the run."""
        return Verdict([], {})

    def plot(self, folder: Path) -> Sequence[Path]:
        """Draw what happened into a folder, by `plantar.plotting`."""
        return ()


def experiment_names() -> tuple[str, ...]:
    """Names of all experiments: built-in, and of entry points `plantar.experiments`."""
    return tuple(sorted([*_built_in(), *_of_others()]))


def _built_in() -> tuple[str, ...]:
    package = Path(__file__).parent / "experiments"
    return tuple(found.name.replace("_", "-") for found in pkgutil.iter_modules([str(package)]))


def _of_others() -> dict[str, Any]:
    return extensions("plantar.experiments", Experiment, _built_in())


def experiment_class(name: str) -> type[Experiment]:
    """The class of an experiment, by its file's name with hyphens."""
    known = experiment_names()
    if name not in known:
        raise SceneError(f"unknown experiment '{name}'; {nearest(name, known)}allowed: {', '.join(known)}")
    if name in (others := _of_others()):
        return cast(type[Experiment], others[name])
    module = import_module(f"plantar.sim.companion.experiments.{name.replace('-', '_')}")
    own = [
        kind
        for kind in vars(module).values()
        if isinstance(kind, type) and issubclass(kind, Experiment) and kind.__module__ == module.__name__
    ]
    if len(own) != 1:
        raise TypeError(f"{module.__name__} has {len(own)} experiments; it needs one")
    return own[0]


_MACHINE = {"robot": "machine", "machine": "machine"}  # keys of settings that name it, by field


@dataclass(frozen=True)
class CompanionScene:
    """A scene: a machine `robot`, an experiment's `kind`, settings of both."""

    name: str
    description: str
    robot: str
    kind: str
    skin: SkinSensing
    experiment: Settings
    control: CompanionControl
    lidar: LidarSettings | None

    def setting_name(self, key: str) -> str:
        """Full name "table.name" of a setting's key, or "robot"."""
        if key.strip() in _MACHINE:
            return "robot"
        kinds = {section: kind.names() for section, kind in companion_tables(self.kind).items()}
        return ".".join(owner_of(key.strip(), "", kinds))

    def claims(self) -> dict[str, str]:
        """What its experiment shows, by criterion."""
        return dict(self.experiment_type.claims)

    @property
    def experiment_type(self) -> type[Experiment]:
        """The experiment's class."""
        return experiment_class(self.kind)


def companion_tables(kind: str) -> dict[str, type[Settings]]:
    """Settings class of each table of a scene, by the table's name."""
    found = experiment_class(kind)
    tables: dict[str, type[Settings]] = {
        "skin": SkinSensing,
        "experiment": found.settings_type,
        "control": found.control_type,
    }
    return tables | ({"lidar": LidarSettings} if found.uses_lidar else {})


def companion_scene(
    source: Mapping[str, Any], path: Path, settings: Sequence[str] = (), machine: str | None = None
) -> CompanionScene:
    """Returns the scene of a TOML file's content `source`, whose `experiment` is a name, or a table with it as `kind`.

    `path` names the file in messages; "key=value" `settings` and `machine` replace the file's. A SceneError if a field
    is invalid.
    """
    where = f"scene '{path.stem}'"
    result: dict[str, Any] = {k: dict(v) if isinstance(v, Mapping) else v for k, v in source.items()}
    experiment = result.pop("experiment")
    table = experiment if isinstance(experiment, dict) else {}
    kind = table.pop("kind", None) if isinstance(experiment, dict) else experiment
    if not isinstance(kind, str):
        raise SceneError(f"{where}: 'experiment' is {kind!r}; allowed: a name, or a table with kind = its name")
    result["experiment"] = table
    paper, settings = with_paper(settings, path.stem, machine or str(result.get("machine", "")))
    kinds = companion_tables(kind)
    names = {section: own.names() for section, own in kinds.items()}
    put_settings(result, map(split_setting, settings), _MACHINE, names)
    refuse_unknown_keys(result, ("name", "description", "machine", *kinds), where, SceneError)
    refuse_other_than_texts(result, ("name", "description", "machine"), where, SceneError)
    if not (machine or result.get("machine")):
        raise SceneError(f'{where} names no machine; it needs machine = "..."')
    parts: dict[str, Any] = {
        name: own.from_table(result.get(name, {}), f"{where}: [{name}]", SceneError) for name, own in kinds.items()
    }
    return CompanionScene(
        name=result.get("name", path.stem) + (f" as {paper}" if paper else ""),
        description=result.get("description", ""),
        robot=machine or result["machine"],
        kind=kind,
        **{"lidar": None, **parts},
    )
