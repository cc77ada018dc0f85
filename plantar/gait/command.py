"""A walking controller's input and output at a tick."""

from collections.abc import Mapping
from typing import NamedTuple, Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.common.record import Record
from plantar.common.sides import Side
from plantar.gait.contact.foot_contacts import FootholdFound
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.plan.phases import Phase
from plantar.gait.plan.plan_change import MovedStep
from plantar.gait.plan.vrp_plan import LipReference
from plantar.mechanics.base_state import BaseState
from plantar.percepts.percept import Percept
from plantar.sensing.reading import Reading

_NOTHING = read_only(np.zeros(2))


class Sensors(Record, frozen=True):
    """Input of a controller.

    Attributes:
        time: Time in s.
        joint_positions: Encoders (k,) in rad.
        gyro: Angular velocity (3,) of the base, base frame, in rad/s.
        accelerometer: Specific force (3,) of the base, base frame, in m/s^2.
        readings: Latest of each sole.
        ankles: Wrench (6,) of each foot on its leg, frame of its force-torque sensor, in N and N m; empty without such
            sensors.
        skin: Latest reading of the upper body's skin (`ControllerSettings.skin`), or None.
        links: Origin (3,) in m and rotation (3, 3), base frame, of each moving link with skin.
        torques: Measured by the joints' motors (k,) in N m, for soles without sensors (`load_controller`), or None.
        sampled: Time in s at which joints and IMU were read, where that was before `time`; with it, what a sole sees is
            placed by the pose that the foot had then.
    """

    time: float
    joint_positions: NDArray[np.float64]
    gyro: NDArray[np.float64]
    accelerometer: NDArray[np.float64]
    readings: Mapping[Side, Reading]
    ankles: Mapping[Side, NDArray[np.float64]] = msgspec.field(default_factory=dict)
    skin: Reading | None = None
    links: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]] = msgspec.field(default_factory=dict)
    torques: NDArray[np.float64] | None = None
    sampled: float | None = None


class FootTarget(Record, frozen=True):
    """Desired pose and load of a sole.

    `position`: sole origin (3,), world frame, in m; `rotation`: sole to world (3, 3); `force`: force (3,) in N by the
    ground; `center_of_pressure`: its point (2,), world frame, in m.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    force: NDArray[np.float64]
    center_of_pressure: NDArray[np.float64]


class JointTargets(NamedTuple):
    """Joint targets: a drive exerts stiffness (angles - q) + damping (velocities - v) + torques.

    `angles` (k,) in rad; `torques`: expected load's (k,) in N m; `velocities` (k,) in rad/s; None for at rest;
    `stiffness` (k,) in N m/rad; None leaves both gains to the drive; `damping` (k,) in N m s/rad.
    """

    angles: NDArray[np.float64]
    torques: NDArray[np.float64]
    velocities: NDArray[np.float64] | None = None
    stiffness: NDArray[np.float64] | None = None
    damping: NDArray[np.float64] | None = None


class MotorCommand(NamedTuple):
    """Low-level command of leg motors: each exerts kp (q - angle) + kd (dq - rate) + torque.

    `q` (k,) in rad; `dq` (k,) in rad/s; `kp` (k,) in N m/rad; `kd` (k,) in N m s/rad; `torque` (k,) in N m.
    """

    q: NDArray[np.float64]
    dq: NDArray[np.float64]
    kp: NDArray[np.float64]
    kd: NDArray[np.float64]
    torque: NDArray[np.float64]


class Command(Record, frozen=True):
    """Controller's targets for inverse kinematics and servos.

    Attributes:
        com: Desired CoM (3,) of the model in m, in the frame of the commanded footholds, which joints are solved in.
        rotation_torso: Torso to that frame (3, 3).
        feet: Each sole's target, same frame.
        phase: The walk's phase.
        reference: The plan now.
        zmp_desired: (2,) in m.
        state: Estimated state.
        dcm: Estimate (2,) in m.
        percepts: Of each sole.
        ankle_loads: Of each sole by its ankle's sensor; empty without.
        footholds: Found at this tick.
        moved_steps: Moved at this tick.
        joint_offsets: Added to joint set-points (k,) in rad for encoder errors; None for zero.
        stiffness: Share of joint stiffness and load that servos keep; 1 unless fallen.
        momentum: (-L_y', L_x') / (m g) (2,) in m that the feet's forces give about the CoM (`LegMomentum`).
        joints: With torques and gains (`control.drives`); None where servos solve for them.
    """

    com: NDArray[np.float64]
    rotation_torso: NDArray[np.float64]
    feet: Mapping[Side, FootTarget]
    phase: Phase
    reference: LipReference
    zmp_desired: NDArray[np.float64]
    state: BaseState
    dcm: NDArray[np.float64]
    percepts: Mapping[Side, Percept]
    ankle_loads: Mapping[Side, SoleWrench] = msgspec.field(default_factory=dict)
    footholds: tuple[FootholdFound, ...] = ()
    moved_steps: tuple[MovedStep, ...] = ()
    joint_offsets: NDArray[np.float64] | None = None
    stiffness: float = 1.0  # derived: all of the motors' own
    momentum: NDArray[np.float64] = _NOTHING
    joints: JointTargets | None = None


class Motors(Protocol):
    """Turns a command into joint targets."""

    def targets(self, command: Command, sensors: Sensors) -> JointTargets:
        """Returns targets for the `command` that answers the `sensors`; never raises."""
        ...
