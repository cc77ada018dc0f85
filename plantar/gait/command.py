"""What goes into a walking controller at a tick, and what comes out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from plantar.gait.contact.foot_contacts import FootholdFound
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.plan.phases import Phase
from plantar.gait.plan.plan_change import MovedStep
from plantar.gait.plan.vrp_plan import LipReference
from plantar.mechanics.base_state import BaseState
from plantar.percepts.percept import Percept
from plantar.record import Record
from plantar.sensing.link_skin import SkinReading
from plantar.sensing.reading import Reading
from plantar.sides import Side

__all__ = ["Command", "FootTarget", "JointTargets", "Motors", "Sensors"]


class Sensors(Record, frozen=True):
    """Input of a controller.

    Attributes:
        time: Time in s.
        joint_positions: Encoder readings (k,) in rad.
        gyro: Angular velocity (3,) of the base in its own frame in rad/s.
        accelerometer: Specific force (3,) of the base in its own frame in m/s^2.
        readings: Latest reading of each sole.
        ankles: Wrench (6,) that each foot exerts on its leg, in the frame of its force-torque sensor in N and N m;
            empty without such sensors.
        skin: Latest reading of the skin on the upper body (`ControllerSettings.skin`), or None.
        links: Origin (3,) in m and rotation (3, 3) in the base frame of each link with skin that moves against the
            base.
    """

    time: float
    joint_positions: NDArray[np.float64]
    gyro: NDArray[np.float64]
    accelerometer: NDArray[np.float64]
    readings: Mapping[Side, Reading]
    ankles: Mapping[Side, NDArray[np.float64]] = msgspec.field(default_factory=dict)
    skin: SkinReading | None = None
    links: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]] = msgspec.field(default_factory=dict)


class FootTarget(Record, frozen=True):
    """Desired pose and load of a sole.

    Attributes:
        position: Sole frame origin (3,) in the world frame in m.
        rotation: Rotation (3, 3) from the sole to the world frame.
        force: Force (3,) in N that the ground should exert on it.
        center_of_pressure: Point (2,) in the world frame in m at which it acts.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    force: NDArray[np.float64]
    center_of_pressure: NDArray[np.float64]


class JointTargets(NamedTuple):
    """Targets of leg joints: a drive exerts stiffness (angles - q) + damping (velocities - v) + torques.

    Attributes:
        angles: Joint angles (k,) in rad.
        torques: Torques (k,) in N m that the expected load takes.
        velocities: Rates (k,) of the angles in rad/s; None for at rest.
        stiffness: Gains (k,) in N m/rad; None leaves both gains to the drive.
        damping: Gains (k,) in N m s/rad.
    """

    angles: NDArray[np.float64]
    torques: NDArray[np.float64]
    velocities: NDArray[np.float64] | None = None
    stiffness: NDArray[np.float64] | None = None
    damping: NDArray[np.float64] | None = None


class Command(Record, frozen=True):
    """What the controller asks of the body, for inverse kinematics and servos.

    Attributes:
        com: CoM reference (3,) in m in the frame of the commanded footholds, which joints are solved in: desired CoM
            of the model.
        rotation_torso: Rotation (3, 3) from the torso to the same frame.
        feet: Target of each sole, same frame.
        phase: Phase of the walk.
        reference: The plan now.
        zmp_desired: Desired ZMP (2,) in m.
        state: Estimated state.
        dcm: Estimated DCM (2,) in m.
        percepts: What each sole senses.
        ankle_loads: Load of each sole by its ankle's force-torque sensor; empty without such sensors.
        footholds: What feet have been found to stand on at this tick.
        moved_steps: Footsteps that were moved at this tick.
        joint_offsets: What joint set-points have to be higher by (k,) in rad, as encoders err; None for zero.
        stiffness: Share of the joints' stiffness and load that servos should keep; 1, but of a robot that has fallen.
        joints: Targets of the joints with torques and gains (`control.drives`); None where servos solve for them.
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
    stiffness: float = 1.0
    joints: JointTargets | None = None


class Motors(Protocol):
    """What turns a command into targets of the joints."""

    def targets(self, command: Command, sensors: Sensors) -> JointTargets:
        """Returns targets for the `command` that answers the `sensors`; never raises."""
        ...
