"""A robot's walking controller and leg kinematics, for your own control loop, without a simulator."""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance, number
from plantar.common.arrays import array
from plantar.common.gravity import GRAVITY
from plantar.common.optional_library import missing_libraries
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import InputError, RecordingError, SceneError
from plantar.gait.command import Command, JointTargets, MotorCommand, Sensors
from plantar.gait.controller import WalkingController
from plantar.gait.controller_tables import CONTROLLER_TABLES, check_controller_table
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.gait.propose.velocity_command import STOP, Velocity, VelocityCommand
from plantar.gait.safety.bring_up.bring_up import BringUp
from plantar.gait.safety.bring_up.finding import Finding
from plantar.gait.safety.fault_log import Fault
from plantar.robots.bring_up import bring_up_of
from plantar.robots.controller_settings import com_height_of, controller_settings
from plantar.robots.kinematics.ankle_limits import ankle_limits, standing_legs
from plantar.robots.kinematics.ankle_sensors import ankle_sensors
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.command_joints import follow_command
from plantar.robots.kinematics.leg_inertia import leg_inertia
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.kinematics.standing_posture import solve_standing
from plantar.robots.motors.command_motors import Gains, MotorGains
from plantar.robots.motors.planned_motion import PlannedMotion
from plantar.robots.motors.torque_control import command_motors
from plantar.robots.robot import Robot
from plantar.robots.robot_file import load_robot
from plantar.robots.sole_readings import AnkleSoles, SoleSource, TorqueSoles
from plantar.robots.start import start_of_walk, velocity_command
from plantar.robots.walk import Control, Walk, crouch_of

__all__ = ["JointTargets", "MotorCommand", "RobotController", "load_controller", "without_taxels"]

_STANDS = 0.25  # of the servos' stiffness, 12 m g h: three times what two ankles need to stand
_SOLES = ("taxels", "force_torque", "torques")
_NO_TAXELS: Mapping[str, Any] = {"footholds": "off", "pfc": False, "conform": False, "feasibility": "off"}


@dataclass(eq=False, repr=False)
class RobotController:
    """A walking controller and the legs that follow it. Made by `load_controller`.

    `joints`: leg joint names, in order of every joint vector; `period`: control period in s; call `step` once in each;
    `stance`: joint angles and torques before the start; `base_position`: base position (3,) in m in that stance, world
    frame; `began`: whether sensors were sound; `gains`: of the joints' motors.

    Before the first step it checks the robot for 6 s (docs/safety.md): it stands, leans and unloads each foot. What
    fails is in `findings`, and it then keeps standing.

    Example:
        >>> walker = load_controller("h1", {"walk": {"steps": 4}})
        >>> walker.period, len(walker.joints), round(walker.controller.end, 1)
        (0.005, 12, 9.7)
    """

    robot: Robot
    legs: LegModel
    controller: WalkingController
    joints: tuple[str, ...]
    period: float
    stance: JointTargets
    base_position: NDArray[np.float64] = field(repr=False)
    motion: PlannedMotion = field(repr=False)
    gains: MotorGains = field(repr=False)
    velocities: VelocityCommand = field(repr=False)
    soles: SoleSource | None = field(default=None, repr=False)
    began: bool = field(default=False, init=False)

    def __repr__(self) -> str:
        joints = len(self.joints)
        return f"RobotController({self.robot.name!r}: {joints} joints, {1e3 * self.period:g} ms, {self.end:.1f} s long)"

    @property
    def bring_up(self) -> BringUp | None:
        """The checks before the first step; None where they are taken off."""
        return None if self.controller.shell is None else self.controller.shell.bring_up

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What bring-up found wrong, each with its likely cause; empty while it checks, and where all is well."""
        return () if self.bring_up is None else self.bring_up.findings

    @property
    def state(self) -> str | None:
        """Named state, None while it walks: `WalkingController.safe_state`, "bring-up" or "refused"."""
        return self.controller.safe_state

    @property
    def end(self) -> float:
        """Time in s since the first tick at which the walk is over, with its bring-up."""
        return self.controller.end + (0.0 if self.bring_up is None else self.bring_up.duration)

    def set_velocity(self, forward: float, left: float, turn: float) -> None:
        """Walk at a velocity from the next touchdown on, or start to; at any tick, from any thread, until the next.

        Replaces what is left of a number of steps. Zeros step in place; `stop` stands. Larger velocities than the
        longest steps allow are walked by those (`plantar list settings stride`).

        Args:
            forward: In m/s, frame of the feet.
            left: In m/s.
            turn: In rad/s.

        Raises:
            InputError: A value is not finite.
        """
        self.velocities.set_velocity(Velocity(*map(float, (forward, left, turn))))

    def stop(self) -> None:
        """Close the feet with the next step and stand until the next `set_velocity`; at any tick, from any thread.

        `emergency_stop` ends the walk for good.
        """
        self.velocities.set_velocity(STOP)

    def emergency_stop(self, *, limp: bool = False) -> None:
        """From any thread: at the next tick it begins to put both feet down and sits; `limp` goes limp.

        It stays stopped: make a new controller to go on.
        """
        if self.controller.shell is not None:
            self.controller.shell.stop(limp=limp)

    def expect_heartbeat(self, longest: float) -> None:
        """Stop where `heartbeat` is not called for a time in s, such as by an operator's pendant."""
        if self.controller.shell is not None:
            self.controller.shell.expect_heartbeat(longest)

    def heartbeat(self) -> None:
        """The supervisor is there; from any thread."""
        if self.controller.shell is not None:
            self.controller.shell.heartbeat()

    @property
    def faults(self) -> tuple[Fault, ...]:
        """Faults so far, each with its time in s since the first tick."""
        return () if self.controller.shell is None else tuple(self.controller.shell.log.faults)

    def write_faults(self, path: str | os.PathLike[str]) -> None:
        """Write the faults and the 2 s before each as an MCAP recording; not in the loop: it takes some milliseconds.

        Raises:
            RecordingError: If it cannot be written, or the controller runs without its shell.
        """
        if self.controller.shell is None:
            raise RecordingError("the controller has no safety shell, which keeps the faults")
        self.controller.shell.log.write(path)

    def count_as_checked(self) -> None:
        """Walk without bring-up, as in a simulator whose sensors are known to be wired right."""
        if self.controller.shell is not None:
            self.controller.shell.bring_up = None

    def step(self, sensors: Sensors) -> Command:
        """One control tick: command of CoM, torso and soles. Until sensors were sound, InputError names what is not."""
        if self.soles is not None:
            sensors = sensors.changed(readings=self.soles.readings(sensors))
        self.began = self.began or self._sound(sensors)
        return self.controller.step(sensors)

    def _sound(self, sensors: Sensors) -> bool:
        number(sensors.time, "time", finite=True)
        for name, count in (("joint_positions", len(self.joints)), ("gyro", 3), ("accelerometer", 3)):
            given = getattr(sensors, name)
            if array(given, name, (count,), finite=True) is not given or not given.flags.c_contiguous:
                raise InputError(f"{name}: no contiguous array of float64; expected np.array(..., float)")
        for joint, angle in zip(map(self.legs.model.joint, self.joints), sensors.joint_positions, strict=True):
            low, high = np.add(joint.range, (-0.5, 0.5)) if self.legs.model.jnt_limited[joint.id] else (-np.inf, np.inf)
            if not low <= angle <= high:  # by more than an encoder's offset
                span = f"{low:.4g} to {high:.4g} rad, not degrees"
                raise InputError(f"joint_positions hold {angle:.4g} for {joint.name}; allowed: {span}")
        if not 0.5 * GRAVITY < (pull := float(np.linalg.norm(sensors.accelerometer))) < 2.0 * GRAVITY:
            raise InputError(f"accelerometer reads {pull:.4g}; allowed at the start: about {GRAVITY:.4g} m/s^2 (not g)")
        for side, layout in self.robot.layouts.items():
            name = f"forces of the {side} sole"
            if np.isnan(array(getattr(sensors.readings.get(side), "force", None), name, (len(layout),))).all():
                raise InputError(f"{name} hold no number; expected N, with NaN for dead taxels alone")
        return True

    def joint_targets(self, command: Command) -> JointTargets:
        """Inverse kinematics and dynamics of a command, within joint limits; returns the targets. Call it once a tick.

        Those of the command where motors are driven. Out of reach, the unloaded foot misses first.
        """
        if command.joints is not None:
            self._give(command.joints.angles)
            return command.joints
        follow_command(self.legs, command)
        self.motion.update()
        self.motion.carry(command)
        angles = self.legs.joints.copy()
        if command.joint_offsets is not None:
            angles += command.joint_offsets
        self._give(angles)
        return JointTargets(angles, self.legs.torques.copy())

    def motor_command(self, command: Command) -> MotorCommand:
        """A command as makers' low-level commands have it, for each joint; instead of `joint_targets`, once a tick.

        With the gains of `control.drives` (a robot's servos, its motors, or `load_controller`'s); while bring-up
        checks, which stands without balancing, at least a quarter of the servos' stiffness. A robot that goes limp
        keeps the damping alone.
        """
        targets = self.joint_targets(command)
        velocities = self.motion.velocity[6:] if targets.velocities is None else targets.velocities
        stiffness, damping = self.gains
        if self.bring_up is not None and not self.bring_up.passed:
            stiffness = np.maximum(stiffness, _STANDS * np.array([*self.robot.stiffness] * 2))
            damping = np.maximum(damping, math.sqrt(_STANDS) * np.array([*self.robot.damping] * 2))
        share = command.stiffness
        return MotorCommand(targets.angles, share * velocities, share * stiffness, damping, share * targets.torques)

    def _give(self, angles: NDArray[np.float64]) -> None:
        """Compare the next angles with these, a copy: the caller may change what it gets."""
        if self.controller.shell is not None:
            self.controller.shell.commanded = angles.copy()


@missing_libraries("sim")
def load_controller(
    robot: str | os.PathLike[str],
    tables: Mapping[str, Mapping[str, Any]] | None = None,
    *,
    seed: int = 0,
    commanded: bool = False,
    gains: Gains | None = None,
    soles: str = "taxels",
) -> RobotController:
    """Load the walking controller of a robot.

    Args:
        robot: Built-in name (`plantar list robots`) or path of a robot TOML.
        tables: Tables of a scene file: "walk", "control", and those of the controller's parts (`plantar list
            settings`). Default: 20 steps forward.
        seed: Draws the velocities of a walk that wanders.
        commanded: Stand until `RobotController.set_velocity`, and step in the quick steps of commanded walks.
        gains: Of the motors of single joints, by name: stiffness in N m/rad, or (stiffness, damping in N m s/rad);
            others keep their own (`control.joint_stiffness`, the robot's file). For drives "own" and "torque".
        soles: What measures the soles' loads: "taxels"; "force_torque", sensors at the ankles (`Sensors.ankles`); or
            "torques" of the leg motors (`Sensors.torques`). Without taxels every foothold counts as a whole sole, and
            `Sensors.readings` may be empty.

    Returns:
        The controller, before its first tick. It takes no step before its bring-up has passed
            (`RobotController.findings`).

    Raises:
        RobotError, SceneError: If an argument is invalid.
    """
    own = load_robot(robot)
    legs = build_leg_model(own)
    body = body_of(own, legs.model)
    given = dict(instance(tables or {}, Mapping, "tables", SceneError))
    refuse_unknown_keys(given, ("walk", "control", *CONTROLLER_TABLES), "load_controller", SceneError)
    walk = Walk.from_table(_commanded(given.pop("walk", {}), commanded), "[walk]", SceneError).for_body(body)
    control = Control.from_table(_without_taxels(given.pop("control", {}), soles), "[control]", SceneError).for_body(
        body
    )
    parts = {name: check_controller_table(name, table, f"[{name}]", SceneError) for name, table in given.items()}
    task: Any = SimpleNamespace(name="load_controller", walk=walk, control=control, controller=parts)
    task.proximity_range = own.layouts["left"].proximity_range
    limits = ankle_limits(own, legs.model, body.weight)
    standing = standing_legs(own, legs.model, body.weight, crouch_of(walk, own))
    inertia = leg_inertia(own, legs, com_height_of(walk, own))
    ankles = ankle_sensors(legs.model, own)
    settings = controller_settings(task, own, body, ankles, limits, inertia=inertia, standing=standing)
    table = walk.velocities(seed)
    velocities = velocity_command(walk, own, settings.com_height, table)
    start = replace(start_of_walk(walk, own, settings.com_height, velocities=table), commands=(velocities,))
    motors = command_motors(own, legs, body, control, settings.period, gains or {})
    controller = WalkingController(settings, start, own.layouts, legs, motors)
    centers = {s: vrp_of_step(foot, controller.middles[s]) for s, foot in start.feet.items()}
    stance = JointTargets(*solve_standing(own, legs, start.feet, centers, settings.com_height))
    names = (*own.legs["left"].joints, *own.legs["right"].joints)
    motion = PlannedMotion(legs, settings.period, body.beat)
    place = legs.configuration[:3]
    if controller.shell is not None:
        controller.shell.bring_up = bring_up_of(own, controller, start.feet)
    source: SoleSource | None = None
    if soles == "force_torque":
        source = AnkleSoles(own.layouts, ankles, legs)
    elif soles == "torques":
        source = TorqueSoles(own.layouts, legs, own.legs)
    return RobotController(
        own,
        legs,
        controller,
        names,
        settings.period,
        stance,
        place,
        motion,
        MotorGains(np.array([*own.stiffness] * 2), np.array([*own.damping] * 2))
        if motors is None
        else MotorGains(motors.stiffness, motors.damping),
        velocities,
        source,
    )


def _commanded(walk: Mapping[str, Any], commanded: bool) -> Mapping[str, Any]:
    """A [walk] table that stands at first, if it is `commanded`."""
    if not commanded:
        return walk
    for name in ("steps", "velocity", "commands", "wander"):
        if name in walk:
            raise SceneError(f"[walk] {name} is given, and commanded, too; allowed: one of them")
    return {**walk, "commands": [[0.0, "stop"]]}


def without_taxels(zmp_source: str) -> dict[str, Any]:
    """A [control] table for which every foothold is a whole sole, with a source of loads and ZMP."""
    return {**_NO_TAXELS, "zmp_source": zmp_source}


def _without_taxels(control: Mapping[str, Any], soles: str) -> Mapping[str, Any]:
    """A [control] table that fits what measures the `soles`; SceneError for what they do not."""
    if soles not in _SOLES:
        raise SceneError(f"soles is {soles!r}; allowed: {', '.join(_SOLES)}")
    if soles == "taxels":
        return control
    without = without_taxels("force_torque" if soles == "force_torque" else "skin")
    for name, value in without.items():
        if control.get(name, value) != value:
            raise SceneError(f"[control] {name} is {control[name]!r}; allowed for soles = {soles!r}: {value!r}")
    return {**control, **without}
