"""Controller settings of a run: defaults, then the robot's tables, then the scene's."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.settings.part import Part
from plantar.common.sides import Side
from plantar.errors import InputError, SceneError
from plantar.gait.balance.balance_laws import balance_gains, law_of
from plantar.gait.balance.law import LawGains
from plantar.gait.contact.standing_leg import StandingLeg
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.controller_tables import CONTROLLER_TABLES, OPTIONAL_PARTS
from plantar.gait.estimate.ankle_sensor import AnkleSensor
from plantar.gait.feet.swing_kinds import swing_kinds
from plantar.gait.propose.proposer_kind import proposer_kinds
from plantar.mechanics.leg_inertia import LegInertia
from plantar.robots.robot import Robot
from plantar.robots.walk import Control, Walk, crouch_of, walk_timing
from plantar.sensing.link_skin import BodySkin

# measured: Heading correction by the loaded feet in 1/s where they meet ground that is not where it is expected: they
# turn a little as they land, which only the gyro shows. (Corrected by 2.0 a walk of 100 steps drifted 42 mm off to the
# side.)
_YAW_ON_UNKNOWN_GROUND = 0.1

_NO_LEGS = LegInertia()
# Leg, clearance of the swing foot of commanded steps at most; derived: `swing_height` of the controller's own settings
_QUICK_HEIGHT = 1 / 12
# Of steps whose time is stated, in leg/pace: what a knee bends of its leg's length, for clearance and for a step
_QUICK_BEND = 0.058  # chosen: by what knees of h1 reach in quick steps
_STEP_BEND = 0.35  # chosen: a step as long as half a leg leaves no clearance but the least
_LEAST_HEIGHT = 1 / 30  # chosen: 20 mm on h1, twice what a swing sags below its path


class Task(Protocol):
    """A controller's task; a scene of the simulator is one."""

    @property
    def name(self) -> str:
        """Name, for messages."""

    @property
    def walk(self) -> Walk:
        """The gait."""

    @property
    def control(self) -> Control:
        """Which parts of the controller run."""

    @property
    def controller(self) -> Mapping[str, Mapping[str, Any]]:
        """Settings of parts by table and name, as far as given."""

    @property
    def proximity_range(self) -> float:
        """Distance in m that the soles see."""


def controller_settings(
    scene: Task,
    robot: Robot,
    body: BodyScale,
    ankles: Mapping[Side, AnkleSensor],
    limits: Mapping[Side, NDArray[np.float64]] | None = None,
    skin: BodySkin | None = None,
    inertia: LegInertia = _NO_LEGS,
    standing: Mapping[Side, StandingLeg] | None = None,
) -> ControllerSettings:
    """Settings of the walking controller for a scene.

    `ankles`: force-torque sensors, if any; `limits`: where its weight may act on one foot (`ankle_limits`); None for
    anywhere; `skin`: skin of its upper body, base frame; None without; `standing`: how high its legs have to stand.
    """
    walk = scene.walk
    _refuse_unused(scene, robot)
    control = _possible(scene.control, robot)
    swing_height = walk.swing_height
    if walk.commanded or walk.single_support:  # quick steps have no time to go high
        bend = _QUICK_BEND * walk.single_support / body.pace - _STEP_BEND * (walk.length / body.leg) ** 2
        swing_height = min(swing_height, (_QUICK_HEIGHT if walk.commanded else max(_LEAST_HEIGHT, bend)) * body.leg)
    # A slow approach takes longer than quick swings, and a robot that rocks comes down as it rocks.
    approach = 0.0 if robot.rocks or walk.commanded else walk.approach_height
    defaults: Mapping[str, Mapping[str, Any]] = {
        "landing": {"approach_height": approach, "approach_speed": walk.approach_speed},
        "ground_map": {"sensing_range": scene.proximity_range},
        "feasibility": {"rule": control.feasibility},
        "estimator": {"yaw": _YAW_ON_UNKNOWN_GROUND} if control.pfc else {},
        "step_adjustment": {"confidence": walk.confidence, "yielding": walk.yielding},
        # A hand that holds the arm is near to its skin always.
        "push_felt": {"proximity_force": 0.0} if walk.led else {},
    }
    tables = {name: {**defaults.get(name, {}), **given} for name, given in _given(scene, robot).items()}
    swing = swing_kinds()[control.swing_shape]
    parts: dict[str, Any] = {"balance": _balance(scene, robot)}

    def runs(kind: type[Part]) -> bool:
        return kind.unmet(lambda key: _value(key, control, tables)) is None

    chosen = {kind.table for kind in (*swing_kinds().values(), *proposer_kinds())}  # several kinds, or none, at a time
    for name in CONTROLLER_TABLES.keys() - parts.keys() - chosen:
        (kind,) = CONTROLLER_TABLES[name]
        needed = name not in OPTIONAL_PARTS or runs(kind)
        parts[name] = kind.from_table(tables[name], f"[{name}]", SceneError) if needed else None
    proposers = tuple(
        kind.from_table(tables[kind.table], f"[{kind.table}]", SceneError).for_body(body)
        for kind in proposer_kinds()
        if runs(kind)
    )
    found = ControllerSettings(
        com_height=com_height_of(walk, robot),
        spare_crouch=max(0.0, robot.largest_crouch - walk.lowered),
        mass=body.mass,
        trunk_lean=robot.trunk_lean if walk.lean else 0.0,
        period=_period(control),
        timing=walk_timing(walk, robot, body),
        swing_height=swing_height,
        swing=swing.from_table(tables.get(swing.table, {}), f"[{swing.table}]", SceneError),
        ankle_reach=robot.ankle_reach,
        outward=robot.outward,
        feedback=control.feedback,
        zmp_source=control.zmp_source,
        ankles=ankles,
        ankle_limits=limits or {},
        standing_legs=standing or {},
        leg_inertia=inertia if control.leg_momentum else _NO_LEGS,
        footholds=control.footholds,
        skin=skin,
        proposers=proposers,
        **parts,
    )
    try:
        return found.for_body(body)
    except InputError as error:
        raise SceneError(f"scene '{scene.name}' with robot '{robot.name}': {error}") from None


def com_height_of(walk: Walk, robot: Robot) -> float:
    """Returns a `robot`'s CoM height in m above carrying soles in a `walk`."""
    return robot.com_height - crouch_of(walk, robot)


def _period(control: Control) -> float:
    steps = control.period / control.physics_period
    # nature: floating point: a quotient of decimals is whole to 1e-12
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6:
        raise SceneError(
            f"control.period is {control.period:g} s; allowed: a whole number of physics steps of "
            f"{control.physics_period:g} s (control.physics_period)"
        )
    return control.period


def _possible(control: Control, robot: Robot) -> Control:
    looks = not robot.rocks and all("proximity" in layout.modalities for layout in robot.layouts.values())
    footholds = control.footholds if looks or control.footholds == "off" else "force"
    return replace(
        control,
        pfc=control.pfc and looks,
        footholds="off" if robot.rocks else footholds,
        step_timing=control.step_timing and not robot.rocks,
        step_adjustment=control.step_adjustment and not robot.rocks,
    )


def _given(scene: Task, robot: Robot) -> dict[str, dict[str, Any]]:
    return {name: {**robot.controller.get(name, {}), **scene.controller.get(name, {})} for name in CONTROLLER_TABLES}


def _value(key: str, control: Control, tables: Mapping[str, Mapping[str, Any]]) -> Any:
    table, _, name = key.partition(".")
    if table == "control":
        return getattr(control, name)
    return tables[table].get(name, CONTROLLER_TABLES[table][0].__dataclass_fields__[name].default)


def _balance(scene: Task, robot: Robot) -> LawGains:
    """Gains of the scene's law; the robot's are those of its own law."""
    stated = scene.controller.get("balance", {})
    both = {**robot.balance, **stated}
    return balance_gains(both if law_of(both) == law_of(robot.balance) else stated)


def _refuse_unused(scene: Task, robot: Robot) -> None:
    tables = _given(scene, robot)
    for name, stated in scene.controller.items():
        for kind in CONTROLLER_TABLES[name] if stated else ():
            given = [key for key in stated if f"{name}.{key}" not in kind.needs]  # a switch does something
            needed = kind.unmet(lambda key: _value(key, scene.control, tables))
            if given and needed is not None:
                keys = ", ".join(f"{name}.{key}" for key in given)
                raise SceneError(f"scene '{scene.name}' sets {keys}, which does nothing; allowed: with {needed}")
