"""Feet: loads and yielding, by the balance law."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.balance.law import Feet, FootAction, FootState
from plantar.gait.command import FootTarget
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.estimate.estimator import SoleLoad
from plantar.gait.plan.phases import Phase
from plantar.gait.tick.footing import Footing
from plantar.geometry.inscribed import safe_rectangle
from plantar.kernels.gait import lean_correction
from plantar.kernels.gait.sole_admittance import risen, turned
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.contact import Contact
from plantar.mechanics.rotation import level_rotation
from plantar.mechanics.wrench_cone import Rectangle

# nature: sole that a foot's centre of pressure keeps from the edge of its contact: 10 mm in T 4.4.4
_CONTACT_OFFSET = 0.0433


class FootTargets:
    """Soles' poses and loads, command frame."""

    def __init__(self, settings: ControllerSettings, footing: Footing) -> None:
        self._footing = footing
        self._offset = _CONTACT_OFFSET * settings.body.sole
        # derived: a tenth of a millimetre on h1, below which a contact is the same
        self._fine = 6000.0 / settings.body.leg
        self._rectangles: dict[Side, tuple[NDArray[np.float64], Rectangle]] = {}
        self._contacts: dict[Side, tuple[NDArray[np.float64], tuple[object, ...], Contact]] = {}

    def states(self, phase: Phase, soles: Mapping[Side, SoleLoad], contacts: bool, rests: bool) -> Feet:
        """Returns the feet for a balance law. `rests`: whether the robot stands after a walk; wrenches included."""
        states: dict[Side, FootState] = {}
        footing = self._footing
        motion = footing.motion
        looks = contacts or rests
        crept = self._crept() if contacts else ()
        for side, damping in footing.damping.items():
            level = motion.rotation(side)
            rotation = level
            x, y = damping.turn.tolist()
            if x or y:
                rotation = turned(level, x, y)
            contact = None
            wrench = None
            if looks and (phase.swing != side or motion.landed):
                contact = self._contact(side, crept) if contacts else None
                wrench = soles[side].wrench_in_sole
            states[side] = FootState(
                motion.footholds[side][0], level, rotation, footing.contacts.center(side), contact, wrench
            )
        return Feet(states, phase.stance, footing.frame, rests)

    def targets(self, feet: Feet, actions: Mapping[Side, FootAction]) -> dict[Side, FootTarget]:
        """Returns pose and load of each sole of `feet`, turned and shifted about its center by the law's actions."""
        targets: dict[Side, FootTarget] = {}
        for side, action in actions.items():
            foot = feet.states[side]
            roll = action.roll
            pitch = action.pitch
            shift = action.shift
            position = foot.position
            rotation = foot.rotation
            if roll or pitch or shift:
                x, y = self._footing.damping[side].turn.tolist()
                rotation = turned(foot.level, x + roll, y + pitch)
                position = risen(position, foot.center, roll, pitch, shift)
            targets[side] = FootTarget(position, rotation, action.force, action.center_of_pressure)
        return targets

    def compensate(
        self,
        feet: dict[Side, FootTarget],
        phase: Phase,
        com: NDArray[np.float64],
        torso: float,
        posture: NDArray[np.float64],
        state: BaseState,
    ) -> None:
        """Correct a swinging or just landed foot for body lean.

        `com`: commanded (3,) in m; `torso`: commanded heading in rad; `posture`: commanded torso rotation (3, 3).
        """
        footing = self._footing
        side = footing.motion.last_side
        if side is None:
            return
        frame = footing.frame
        compensation = footing.compensation
        foot = feet[side]
        # One that has landed before its support's end keeps its correction: following the body as it leans onto the
        # foot would take the load off it.
        if not footing.motion.landed:
            # The world's heading differs from the command frame's by the alignment; only the lean is corrected here.
            aligned = frame.aligned(foot.position, state.com)
            measured = lean_correction.headed(state.rotation_base_to_world, torso)
            compensation.update(phase.swing == side, foot.position, aligned, com, state.com, posture, measured)
        elif phase.swing != side:
            compensation.release()
        rotation = lean_correction.turned(compensation.turn, foot.rotation)
        feet[side] = FootTarget(foot.position + compensation.shift, rotation, foot.force, foot.center_of_pressure)

    def _crept(self) -> tuple[int, ...]:
        """Command frame's creep, in 1/6000 of the leg (0.1 mm for H1) and 0.1 mrad."""
        frame = self._footing.frame
        fine = self._fine
        x, y, z = frame.offset
        # derived: a tenth of a milliradian, likewise
        return round(x * fine), round(y * fine), round(z * fine), round(frame.turn * 1e4)

    def _contact(self, side: Side, crept: tuple[int, ...]) -> Contact:
        """Standing foot's contact; the same object until `_crept` steps."""
        contacts = self._footing.contacts
        frame = self._footing.frame
        polygon = contacts.polygon(side)
        rectangle = self._rectangles.get(side)
        if rectangle is None or rectangle[0] is not polygon:
            (x0, y0), _, (x1, y1), _ = safe_rectangle(polygon, self._offset).tolist()
            rectangle = (polygon, Rectangle(x0, x1, y0, y1))
            self._rectangles[side] = rectangle
        position, yaw = self._footing.motion.footholds[side]
        place = (rectangle[1], yaw, crept)
        known = self._contacts.get(side)
        if known is None or known[0] is not position or known[1] != place:
            x, y = contacts.center(side).tolist()
            turn = level_rotation(yaw + frame.turn)
            contact = Contact(frame.to_world(position), turn, rectangle[1], preferred=(x, y))
            known = (position, place, contact)
            self._contacts[side] = known
        return known[2]
