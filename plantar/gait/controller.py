"""Walking controller: wires the rooms into a control tick.

    sense -> estimate -> swing -> propose -> decide -> apply -> balance -> feet

The swing foot comes first, since most proposals follow from its touchdown.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.gait.balance.law import BalanceState
from plantar.gait.balance.load_transfer import OpenLoop
from plantar.gait.command import Command, FootTarget, Motors, Sensors
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.foot_contacts import middle_of_sole, on_its_hull
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.body_sensors import BodySensors
from plantar.gait.estimate.estimator import LegKinematics
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.leg_momentum import EARLY, LATEST, LegMomentum
from plantar.gait.plan.phases import PhaseKind, WalkSchedule
from plantar.gait.plan.plan_change import MovedStep
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.decide import decide
from plantar.gait.propose.proposer import Proposer
from plantar.gait.safety.safe_stop import SafeStop
from plantar.gait.safety.shell import SafetyShell
from plantar.gait.safety.standing_command import standing_command
from plantar.gait.tick.body_targets import BodyTargets
from plantar.gait.tick.estimation import Estimation
from plantar.gait.tick.foot_targets import FootTargets
from plantar.gait.tick.footing import Footing
from plantar.gait.tick.proposers import proposers
from plantar.kernels import need_compiled
from plantar.kernels.safety.plausible import away_from_feet
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.lip import GRAVITY

__all__ = ["Command", "FootTarget", "Sensors", "Start", "WalkingController"]

_UNBOUNDED_REGION = np.empty((0, 2))  # leaves the desired ZMP free
_NO_STEPS: tuple[MovedStep, ...] = ()
_BRIDGED = 0.2  # derived: beats without encoders or IMU: a DCM that is not followed is a fifth farther off by then


@dataclass(frozen=True)
class Start:
    """Start of a walk.

    Attributes:
        feet: Initial feet.
        steps: Known footsteps, in order; others can come later.
        time: Start in s.
        commands: The caller's proposers, such as a velocity command.
    """

    feet: Mapping[Side, Footstep]
    steps: tuple[Footstep, ...] = ()
    time: float = 1.0  # chosen: as `begin` of a walk
    commands: tuple[Proposer, ...] = ()


class WalkingController:
    """Walks a footstep plan on plantar feedback.

    Args:
        settings: Settings.
        start: Start of the walk.
        layouts: Of each side.
        kinematics: The robot's forward kinematics.
        motors: Solves commands for joints; None leaves that to position servos.

    Attributes:
        plan: The walk's plan.
        estimation: State of the body.
        middles: VRP (2,) over each whole sole in m.
        footing: Commanded feet, and what they stand on.
        momentum: What swinging legs add to the plan.
        balance: Balance law.
        shell: Guards the tick (docs/safety.md); None runs without.
        replans: Plan changes, without steps that come one by one.
    """

    def __init__(
        self,
        settings: ControllerSettings,
        start: Start,
        layouts: Mapping[Side, SoleLayout],
        kinematics: LegKinematics,
        motors: Motors | None = None,
    ) -> None:
        need_compiled("walking")
        s = settings
        feet = start.feet
        begin = start.time - 1.0
        self.settings = settings
        layouts = {side: on_its_hull(layouts[side]) for side in SIDES}
        self.layouts = layouts
        self._motors = motors
        self.replans = 0
        legs = s.standing_legs
        limits = {
            side: AnkleLimits(strips, s.balance.zmp_offset, legs.get(side)) for side, strips in s.ankle_limits.items()
        }
        middles = {side: middle_of_sole(layouts[side], s.ankle_reach, limits.get(side), s.outward) for side in SIDES}
        self.middles = middles
        self.estimation = Estimation(s, feet, layouts, kinematics)
        omega = self.estimation.omega
        self.omega = omega
        self.plan = WalkPlan(feet, start.steps, s.timing, middles, omega, start.time)
        arrived = EARLY if s.compliance is not None else LATEST
        self.momentum = LegMomentum(self.plan, omega, s.leg_inertia.turning, arrived)
        self.balance = s.balance.law(omega, s.mass, s.period)
        self._open_loop = OpenLoop(s.mass)
        turns = not self.balance.wants_contacts
        self.footing = Footing(s, feet, layouts, self.plan, self.estimation, middles, limits, turns_stance=turns)
        self.body_targets = BodyTargets(s, self.footing)
        self.foot_targets = FootTargets(s, self.footing)
        asked = proposers(s, layouts, self.plan, feet, begin, middles, limits, self.footing.guard)
        own = tuple(kind.begin(layouts, s.period) for kind in s.proposers)
        self._proposers = (*asked, *own, *start.commands)
        self._gaps = BodySensors(s.period, _BRIDGED * s.body.beat)
        self._last: Command | None = None
        self._lost = False
        self._stop = SafeStop(s.period, s.body.leg, s.body.beat, s.body.weight)
        stand = standing_command(feet, self.plan, layouts, s.mass * GRAVITY, s.com_height, begin)
        self.shell: SafetyShell | None = SafetyShell(
            self._bridged,
            stand,
            layouts,
            None,
            s.period,
            s.mass,
            s.body.leg,
            s.com_height,
            start.time,
            self._stop,
            kinematics.posture,
        )

    @property
    def schedule(self) -> WalkSchedule:
        """Phases of the present plan."""
        return self.plan.schedule

    @property
    def end(self) -> float:
        """Time in s at which the walk is over and settled."""
        return self.schedule.end

    @property
    def raised(self) -> tuple[int, str]:
        """Ticks that raised, and the last error: the shell caught them."""
        return (0, "") if self.shell is None else (self.shell.errors, self.shell.error)

    @property
    def safe_state(self) -> str | None:
        """State that it stays in, None while it walks (docs/safety.md).

        "no way on": no footstep is left, it stands; "blind" (encoders, IMU or soles unusable) and "lost" (CoM farther
        from the feet than high): it sits down; "late" (times are no numbers) and "waiting" (no usable reading yet): it
        holds its last command; "fallen": it goes limp.
        """
        if self.shell is not None and self.shell.state is not None:
            return self.shell.state
        if self._gaps.blind:
            return "blind"
        if self._lost:
            return "lost"
        return "no way on" if self.footing.guard is not None and self.footing.guard.stopped else None

    @property
    def proximity_sides(self) -> tuple[Side, ...]:
        """Feet whose proximity the next tick needs."""
        return self.footing.proximity_sides

    def identified(self) -> dict[str, object]:
        """The robot's identified differences from its model."""
        return self.estimation.summary()

    def step(self, sensors: Sensors) -> Command:
        """One control tick, sensors to command; never raises under its `shell`."""
        command = self._bridged(sensors) if self.shell is None else self.shell.step(sensors)
        return command if self._motors is None else command.changed(joints=self._motors.targets(command, sensors))

    def _bridged(self, sensors: Sensors) -> Command:
        """A tick without encoders or IMU; if blind or lost, the last command."""
        measured = (sensors.joint_positions, sensors.gyro, sensors.accelerometer)
        bridged = self._gaps.usable(measured)
        if bridged is None or self._lost:
            return self._held()
        if bridged is not measured:
            joints, gyro, accelerometer = bridged
            sensors = sensors.changed(joint_positions=joints, gyro=gyro, accelerometer=accelerometer)
        command = self._tick(sensors)
        self._lost = self._last is not None and self._is_lost(command)
        if self._lost:
            return self._held()
        self._last = command
        return command

    def _held(self) -> Command:
        """Command of a blind or lost robot."""
        assert self._last is not None
        self._last = self._stop.after(self._last, self.safe_state)
        return self._last

    def _is_lost(self, command: Command) -> bool:
        """Whether the CoM is farther from the feet than high."""
        feet = command.feet
        away = away_from_feet(command.com, feet["left"].position, feet["right"].position)
        return bool(away > self.settings.com_height)

    def _tick(self, sensors: Sensors) -> Command:
        """A tick with encoders and IMU."""
        time = sensors.time
        footing = self.footing
        body = self.estimation.body
        sensed = self.estimation.sense(sensors, self.plan.view.schedule.at(time))
        legs = self.momentum.at(time)
        planned, swing = self.momentum.accelerations(self.plan.at(time), legs)
        state = self.estimation.update(sensors, sensed, planned, swing)
        whole, dcm = self.momentum.dcms(state, legs)
        feedback = self.settings.feedback and not self.estimation.stands
        if feedback:
            footing.align(state)
        feet = footing.swing(sensed, state, feedback)
        tick, region = footing.perceive(sensed, state, feet, dcm if feedback else None)
        phase = tick.phase
        moved = _NO_STEPS
        change = decide(self._proposers, tick)
        if change is not None:
            moved = self.plan.apply(change, time, region).moved
            self.replans += not change.following  # steps that come one by one are no other plan
            phase = self.schedule.at(time)
            region = footing.zmp_region(phase, footing.follow(phase, time))
        reference = self.plan.at(time)
        law = self.balance if feedback else self._open_loop
        region = region if feedback else _UNBOUNDED_REGION
        aim, region = footing.regulated(phase, time, reference, tick.pendulum, region)
        balanced = law.update(aim, dcm, state.zmp, region, tick.firm)
        if feedback:
            footing.conform(phase, balanced.zmp_desired, state, sensed)
        com, acceleration, momentum = self.momentum.added(balanced.com, balanced.com_acceleration, legs)
        balanced = BalanceState(balanced.zmp_desired, com, balanced.com_velocity, acceleration)
        com, torso, posture = self.body_targets.at(phase, balanced.com, 0.0 if body is None else body.lean, state)
        # Before the first step the feet stand as they were put, and do not press against each other.
        rests = feedback and phase.kind == PhaseKind.STANDING and phase.step > 0
        stand = self.foot_targets.states(phase, sensed.soles, law.wants_contacts, rests)
        targets = self.foot_targets.targets(stand, law.act(balanced, stand))
        if feedback:
            self.foot_targets.compensate(targets, phase, com, torso, posture, state)
        shift = None if body is None else body.com_shift
        return Command(
            com=com if shift is None else com - posture.dot(shift),
            rotation_torso=posture,
            feet=targets,
            phase=phase,
            reference=reference.plus(legs),
            zmp_desired=balanced.zmp_desired,
            state=state,
            dcm=whole,
            percepts=sensed.percepts,
            ankle_loads=sensed.ankles,
            footholds=tick.found,
            moved_steps=moved,
            momentum=momentum,
            joint_offsets=None if body is None else body.joint_offsets,
        )
