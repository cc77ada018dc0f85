"""A walking controller's task: its gait and running parts."""

import math
from collections.abc import Sequence
from itertools import chain, repeat
from typing import Any

import numpy as np

from plantar.common.settings.body_scale import BodyScale
from plantar.common.settings.schema import Settings, choice, number, share, switch, tables, whole
from plantar.errors import InputError
from plantar.gait.feet.swing_kinds import swing_kinds
from plantar.gait.plan.phases import Timing
from plantar.gait.propose.velocity_command import STOP, VelocityTable, table_of
from plantar.robots.robot import Robot

# Beats that the phases of a step last where neither scene nor robot states them: 0.9 and 0.3 s on a leg of 0.6 m
_SINGLE_SUPPORT = 3.64  # nature: T 4.4.5
_DOUBLE_SUPPORT = 1.21  # nature: T 4.4.5

# Paces that they last where a velocity is commanded, which quick steps follow soon: 0.5 and 0.1 s on h1
_QUICK_SINGLE = 2.02  # chosen: bounded by the knee's speed in a swing of that time
_QUICK_DOUBLE = 0.404  # chosen: shorter, loads jump from foot to foot

# Least time in s of the first and the last shift of the weight; chosen: a shift that is quicker leaves the feedback no
# time. A longer one sways farther, and turns soles without ankle roll
_LEAST_SHIFT = 0.2

_VELOCITY_UNITS = ("s", "m/s", "m/s", "rad/s")  # Units of a row of a velocity command


class Walk(Settings):
    """Gait of a scene. Lengths in m, times in s.

    Attributes:
        steps: Number of steps; the last one closes the feet.
        pattern: "straight"; "closing", whose every second step closes the feet; or a "box" of six steps a round whose
            side is `length`.
        length: Lead of a step over the other foot.
        climb: Planned height of each place ahead over the last, up to the middle of the walk, then down.
        sideways: Lateral lead of each opening step, positive to the left.
        stance_width: Distance of the ankles with feet together; 0 for the robot's own.
        wider: Additional distance of the ankles.
        first: Foot that moves first.
        single_support: t_ss; 0 for the robot's own.
        double_support: t_ds; 0 for the robot's own.
        swing_height: Clearance of the swing foot; less in quick steps.
        lean: Whether the trunk leans over the stance foot, which unloads hip roll (`trunk_lean`).
        crouch: How much lower than its own CoM height the robot walks, to reach further and lower ground; at most as
            its steps need (`lowered`), and `largest_crouch`; over a part of a sole less, as its knee needs.
        approach_height: Height above the expected ground from which a blind swing foot goes down slowly, after ground
            that was elsewhere; it then aims as far below.
        approach_speed: Its speed in m/s.
        start: Duration of the first weight shift.
        end: Duration of the last weight shift.
        confidence: Keep the robot's own steps (1) or follow a push (0), within balance (`step_adjustment.confidence`).
        yielding: How far steps follow a push (`step_adjustment.yielding`).
        led: Whether a person leads it by its arm: proximity to its skin is no push then.
        transfer: Share of each double support over which the VRP moves from foot to foot; 0 lets it jump in the middle,
            as papers plan it that keep it constant over a step (T 4.14).
        settle: Standing time simulated after the walk.
        begin: Standing time before the walk; the CoM leads the first weight shift by about 1 s.
        velocity: Velocity [forward, left, turn] in m/s, m/s and rad/s, or texts with units, instead of a number of
            steps; zeros step in place.
        commands: Such velocities over time: each [time, forward, left, turn], or [time, "stop"], in s after `begin`.
        wander: Largest velocity [forward, left, turn], either way, that the seed draws each `change_every`.
        change_every: Time between such velocities.
        until: Time at which a walk at a velocity is asked to stop.
    """

    steps: int = whole(20, "steps", 0, 100000)  # chosen: by scenes and callers
    pattern: str = choice("straight", "closing", "box")
    length: float = share(1 / 3, "leg", -0.5, 0.5)  # nature: T 4.4.5: 20 cm on a leg of 0.6 m
    climb: float = share(0.0, "leg", -0.5, 0.5)
    sideways: float = number(0.0, "m", -0.3, 0.3)
    stance_width: float = number(0.0, "m", 0, 0.6)
    wider: float = share(0.0, "leg", 0, 0.5)
    first: str = choice("left", "right")
    single_support: float = number(0.0, "s", 0, 10)
    double_support: float = number(0.0, "s", 0, 10)
    swing_height: float = share(2 / 15, "leg", 0.005, 0.25)  # nature: T 4.4.5: 8 cm on a leg of 0.6 m
    lean: bool = switch(True)
    # chosen: 30 mm on h1: less stretches knees on lower ground, more loads them
    crouch: float = share(0.05, "leg", 0, 0.15)
    # chosen: 15 mm on h1, what ground may be higher than expected by
    approach_height: float = share(0.025, "leg", 0, 0.1)
    # chosen: 60 mm/s on h1, twice the `speed` of a landing
    approach_speed: float = share(0.0247, "leg/beat", 0.005, 0.5)
    # chosen: four pendulum times of sqrt(h / g), so that the first shift is quasi-static
    start: float = share(4.85, "beat", 0.2, 60)
    end: float = share(4.04, "beat", 0.2, 60)  # chosen: 3.5 pendulum times
    confidence: float = number(0.0, "1", 0, 1)
    yielding: float = number(0.0, "1", 0, 2)
    led: bool = switch(False)
    transfer: float = number(1.0, "1", 0, 1)  # derived: all of it, the slowest motion of the VRP
    # chosen: seven pendulum times, in which a walk's last error has gone or grown
    settle: float = number(2.0, "s", 0, 600)
    # derived: the least that the CoM needs to lead (`Attributes`), and a mean of gravity
    begin: float = number(1.0, "s", 1, 60)
    velocity: tuple[float | str, ...] = tables("[forward, left, turn] in m/s, m/s, rad/s")
    commands: tuple[Sequence[float | str], ...] = tables('a list of [time, forward, left, turn] or [time, "stop"]')
    wander: tuple[float | str, ...] = tables("[forward, left, turn] in m/s, m/s, rad/s")
    # chosen: some ten quick steps, so that a velocity is reached before the next
    change_every: float = number(6.0, "s", 0.5, 600)
    until: float = number(10.0, "s", 0, 36000)  # chosen: by scenes and callers

    def __post_init__(self) -> None:
        super().__post_init__()
        given = [name for name in ("velocity", "commands", "wander") if getattr(self, name)]
        if len(given) > 1:
            raise InputError(f"{' and '.join(given)} are given; allowed: one of them")
        self.velocities(0)

    @property
    def commanded(self) -> bool:
        """Whether a velocity is commanded, rather than a number of steps."""
        return bool(self.velocity or self.commands or self.wander)

    @property
    def lowered(self) -> float:
        """Crouch in m: a leg a step s off the vertical reaches s^2 / (2 leg) less deep; all if unknown or climbing."""
        whole = self.commanded or self.climb != 0.0
        return self.crouch if whole else min(self.crouch, (self.length**2 + self.sideways**2) / (2.0 * self.body.leg))

    def velocities(self, seed: int) -> VelocityTable | None:
        """Commanded velocities over time in s; None for a number of steps."""
        rows: list[Sequence[float | str]] = [self._in_si(row) for row in self.commands]
        if self.velocity:
            rows = [self._in_si([0.0, *self.velocity])]
        if self.wander:
            wander = self._in_si([0.0, *self.wander])
            table_of([wander], 0.0)  # checks it
            # nature: any number: it keeps these draws apart from others of the seed
            rng = np.random.default_rng([seed, 0xC0])
            # nature: floating point: a quotient of decimals is whole to 1e-12
            count = max(1, math.ceil(self.until / self.change_every - 1e-9))
            # nature: velocities forward, left and turning
            drawn = rng.uniform(-1.0, 1.0, (count, 3)) * np.array(wander[1:], dtype=float)
            rows = [[k * self.change_every, *velocity] for k, velocity in enumerate(drawn.tolist())]
        if not rows:
            return None
        table = table_of(rows, self.begin)
        if table.commands[-1] is not STOP:
            if self.until <= rows[-1][0]:  # type: ignore[operator]
                raise InputError(f"until is {self.until:g} s; allowed: after the last velocity, at {rows[-1][0]:g} s")
            table = table_of([*rows, [self.until, "stop"]], self.begin)
        return table

    def _in_si(self, row: Any) -> Any:
        """A row of [time, forward, left, turn] with texts in SI; other values stay."""
        if not isinstance(row, Sequence) or isinstance(row, str):
            return row
        units = chain(_VELOCITY_UNITS, repeat("1"))
        return [self.in_si(value, unit, "a velocity command") for value, unit in zip(row, units, strict=False)]


class Control(Settings):
    """How the scene is controlled and computed.

    Attributes:
        feedback: False walks the plan in open loop.
        zmp_source: Source of loads and ZMP: "skin", or "force_torque" at the ankles.
        footholds: Source of a foothold's carrying part: "off" assumes a whole sole; "force" uses taxel forces, "skin"
            proximity, too.
        pfc: Preemptive foot compliance: proximity stops the swing before impact and turns the sole to the ground.
        feasibility: Rule that refuses a foothold higher than expected: "off", "skin" (supported area) or "force_torque"
            (moment at the ankle). Needs pfc.
        conform: Standing soles turn until the ground carries them where they should be loaded. For bumps; needs pfc.
        identify: Identify differences of robot and sensors from the model, such as the gyro's bias.
        step_timing: End a single support sooner or later where the DCM asks for it; not of a robot that rocks.
        step_adjustment: Footsteps move for balance, in place and time; not of a robot that rocks, and only in time on
            ground that does not carry everywhere.
        leg_momentum: Plan and estimate count on how swinging legs turn about the CoM and move it.
        learn_strides: Strides grow by the extra length of pushed steps; needs `step_adjustment`.
        push_estimate: Source of a push on the body: "off"; "soles", the acceleration that the ZMP does not explain;
            "skin" on the upper body, or the soles where that measures none.
        dcm_estimate: Estimator of CoM velocity and DCM: "observer", or "kalman", a Kalman filter that counts what
            neither ZMP nor push explain as a push.
        swing_shape: Path of the swing foot: "polynomial" changes only with the plan; "fit" is fitted at every tick to
            landing place and time; packages may add more ("plantar.swings").
        drives: "servo", position servos with the robot file's gains; "own", motors' own gains with torques of the
            planned motion and ground forces; "torque", whole-body torques, with those gains about the motion.
        joint_stiffness: Stiffness of every joint instead of the motors', for "own" and "torque"; 0 keeps those.
        period: Control period in s.
        physics_period: Time step of the simulated physics in s; a contact takes five.
        skip: "auto" computes what is needed; "none" everything, for comparison. The motion is the same.
    """

    feedback: bool = switch(True)
    zmp_source: str = choice("skin", "force_torque")
    footholds: str = choice("skin", "force", "off")
    pfc: bool = switch(True)
    feasibility: str = choice("skin", "force_torque", "off")
    conform: bool = switch(True)
    identify: bool = switch(True)
    step_timing: bool = switch(True)
    step_adjustment: bool = switch(True)
    leg_momentum: bool = switch(True)
    learn_strides: bool = switch(False)
    push_estimate: str = choice("skin", "soles", "off")
    dcm_estimate: str = choice("observer", "kalman")
    swing_shape: str = choice(*swing_kinds())
    drives: str = choice("servo", "own", "torque")
    joint_stiffness: float = number(0.0, "N m/rad", 0, 1e5)
    period: float = number(0.005, "s", 0.0005, 0.05)  # nature: K Table 1
    # chosen: a fifth of the control period; a contact takes five
    physics_period: float = number(0.001, "s", 0.0001, 0.002)
    skip: str = choice("auto", "none")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.joint_stiffness and self.drives == "servo":
            raise InputError("joint_stiffness does nothing to drives 'servo'; allowed: drives 'own' or 'torque'")


CONTROL_PERIOD = Control().period
"""Control period in s of a scene that does not state one."""


def crouch_of(walk: Walk, robot: Robot) -> float:
    """Returns a `robot`'s crouch in a `walk` in m."""
    return min(walk.lowered, robot.largest_crouch)


def walk_timing(walk: Walk, robot: Robot, body: BodyScale) -> Timing:
    """Returns phase durations by `walk`, `robot` or beats of `body`; InputError: `walk` times a rocking robot."""
    stated = walk.single_support, walk.double_support
    if robot.rocks and any(stated):
        raise InputError(
            f"walk.single_support = {stated[0]:g} s, double_support = {stated[1]:g} s: robot '{robot.name}' rocks from "
            "foot to foot in its own time; allowed: 0 for both"
        )
    if walk.commanded and not robot.rocks:
        single = stated[0] or _QUICK_SINGLE * body.pace
        double = stated[1] or _QUICK_DOUBLE * body.pace
    else:
        single = stated[0] or robot.single_support or _SINGLE_SUPPORT * body.beat
        double = stated[1] or robot.double_support or _DOUBLE_SUPPORT * body.beat
        if walk.approach_height > 0.0 and not robot.rocks and not stated[0]:
            single = max(single, robot.approach_support)
    start, end = (max(_LEAST_SHIFT, double),) * 2 if robot.rocks else (walk.start, walk.end)
    return Timing(single, double, start, end, walk.settle, walk.transfer)
