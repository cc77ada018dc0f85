"""Robot kinematics with identified encoder offsets and CoM."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.estimate.com_offset import com_offset
from plantar.gait.estimate.encoder_offsets import StandingTolerances, encoder_offsets, standing_base
from plantar.gait.estimate.estimator import LegKinematics, MovingKinematics, Posture, SoleLoad, live_kinematics
from plantar.gait.estimate.identification import IdentificationRules
from plantar.gait.estimate.opening_stand import OpeningStand
from plantar.kernels.base.vectors import vector
from plantar.mechanics.base_state import BaseState

# chosen: that the torso leans for: h1 then by 5 degrees, which brings its CoM 3 cm nearer to the hip
_TENTHS_MOST = 2.0

# chosen: share that hips carry more up to which the torso does not lean: what taxels' gains leave uncertain
_EVEN = 0.03
_MASS_RATIOS = (0.7, 1.4)  # chosen: that are believed of the mass over the model's; beyond, taxels are broken


class IdentifiedBody:
    """Identifies encoder offsets and CoM in the opening stand, then corrects kinematics.

    Measurements are corrected at once, commands gradually (`joint_offsets`, `com_shift`): joints do not jump.

    Attributes `encoder_offsets`: reading less true angle (k,) in rad; empty until known; `com_offset` from the model's
    (3,), base frame, in m; `mass_ratio`: mass by ground forces over the model's. `weight`: the model's in N; `feet`:
    initial soles: x, y, z in m and heading in rad; `period` of control in s.
    """

    def __init__(
        self,
        kinematics: LegKinematics,
        weight: float,
        feet: Mapping[Side, tuple[float, float, float, float]],
        rules: IdentificationRules,
        period: float,
    ) -> None:
        self.encoder_offsets = np.zeros(0)
        self.com_offset = np.zeros(3)
        self.mass_ratio = 1.0
        self.known = False
        self._weight = weight
        self._kinematics = kinematics
        self._live_posture = live_kinematics(kinematics)
        self._motions = kinematics.sole_motions if isinstance(kinematics, MovingKinematics) else None
        # whether encoders, and the CoM, are known to differ from the model
        self._reads_off = False
        self._lies_off = False
        self._com = np.zeros(3)
        self._corrected: tuple[Posture, Posture] | None = None  # the model's live posture, and the body's
        self._feet = feet
        self._rules = rules
        self._stand = OpeningStand()
        self._share = 0.0
        self._tenths = 0.0
        self._step = period / rules.fade
        self._period = period
        self._rested = 0.0
        self._beside = np.zeros(3)

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """Corrected forward kinematics of encoders (k,) in rad."""
        if not self.known:
            return self._kinematics.posture(joint_positions)
        read = joint_positions - self.encoder_offsets if len(self.encoder_offsets) else joint_positions
        posture = self._kinematics.posture(read)
        return Posture(posture.com + self.com_offset, posture.positions, posture.rotations)

    def live_posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """The same in the same arrays each call."""
        read = joint_positions - self.encoder_offsets if self._reads_off else joint_positions
        posture = self._live_posture(read)
        if not self._lies_off:
            return posture
        corrected = self._corrected
        if corrected is None or corrected[0] is not posture:
            corrected = posture, Posture(self._com, posture.positions, posture.rotations)
            self._corrected = corrected
        np.add(posture.com, self.com_offset, out=self._com)
        return corrected[1]

    def stand(
        self, joint_positions: NDArray[np.float64], accelerometer: NDArray[np.float64], soles: Mapping[Side, SoleLoad]
    ) -> None:
        """Add a tick of standing still: encoders `joint_positions` (k,) in rad, specific force `accelerometer` (3,) of
        the base, base frame, in m/s^2, and each sole's load, `soles`.
        """
        self._stand.update(joint_positions, accelerometer, soles)

    def conclude(self) -> None:
        """Identify from the finished stand."""
        stood = self._stand.mean()
        rules = self._rules
        self.known = True
        if stood is None:
            return
        self.encoder_offsets = np.zeros(len(stood.joint_positions))
        if rules.encoders:
            tolerances = StandingTolerances(rules.encoder_error, rules.place_error, rules.turn_error)
            found = encoder_offsets(
                self._live_posture, stood.joint_positions, stood.up, self._feet, tolerances, self._motions
            )
            # What noise explains stays out: it would turn the soles of a robot that equals its model, permanently.
            if float(np.sqrt(np.mean(found**2))) > rules.encoder_least:
                self.encoder_offsets = _limited(found, float(np.abs(found).max()), rules.encoder_largest)
        carried = sum(float(wrench[2]) for wrench in stood.wrenches.values())
        self.mass_ratio = min(_MASS_RATIOS[1], max(_MASS_RATIOS[0], carried / self._weight))
        if rules.com:
            posture = self._kinematics.posture(stood.joint_positions - self.encoder_offsets)
            rotation, _ = standing_base(posture, stood.up, self._feet)
            beside = com_offset(posture, rotation, self._feet, stood.wrenches)
            size = float(np.linalg.norm(beside))
            if size > rules.com_least:
                self.com_offset = _limited(beside, size, rules.com_largest)
        self._reads_off = bool(self.encoder_offsets.any())
        self._lies_off = bool(self.com_offset.any())
        lever = 0.5 * math.dist(self._feet["left"][:2], self._feet["right"][:2])
        more = self.mass_ratio * (1.0 + abs(float(self.com_offset[1])) / lever) - 1.0
        self._tenths = min(_TENTHS_MOST, 10.0 * more if more > _EVEN else 0.0)  # nature: tenths

    def rest(self, state: BaseState) -> None:
        """Add a tick of standing after the stand: a CoM that stays is over its ZMP.

        In the opening stand a sole may rest on an edge, and few taxels, whose gains shift the ZMP, carry it.
        """
        rules = self._rules
        moves_x, moves_y, _ = state.com_velocity.tolist()
        still = math.hypot(moves_x, moves_y) < rules.com_still
        self._rested = self._rested + self._period if still else 0.0
        if not rules.com or state.zmp is None or self._rested < rules.com_rest:
            return
        x, y = (state.zmp - state.com[:2]).tolist()
        share = self._period / rules.com_time
        # Filtered first: a body that follows its shift at once moves its ZMP by the more, the faster it does.
        beside = state.rotation_base_to_world.T.dot(vector(x, y, 0.0))
        self._beside = self._beside + share * (beside - self._beside)
        offset = self.com_offset + 0.5 * share * self._beside
        self.com_offset = _limited(offset, float(np.linalg.norm(offset)), rules.com_largest)
        self._lies_off = True

    def advance(self) -> None:
        """Advance commanded corrections by a tick after the stand."""
        self._share = min(1.0, self._share + self._step)

    @property
    def joint_offsets(self) -> NDArray[np.float64] | None:
        """Added to joint set-points (k,) in rad, since servos follow encoders; None for none."""
        return self._faded * self.encoder_offsets if self._reads_off else None

    @property
    def com_shift(self) -> NDArray[np.float64] | None:
        """Subtracted from the desired CoM (3,) in m, base frame, to get the model's; None for none."""
        return self._faded * self.com_offset if self._lies_off else None

    @property
    def lean(self) -> float:
        """Torso roll over the stance foot in rad per metre between CoM and feet's middle.

        It relieves the carrying hip, whose motor has a tenth of torque spare.
        """
        return self._faded * self._rules.lean * self._tenths

    @property
    def _faded(self) -> float:
        s = self._share
        # starts and ends without a jump in speed; nature: the cubic without speed at both ends, 3 s^2 - 2 s^3
        return s * s * (3.0 - 2.0 * s)

    def summary(self) -> dict[str, Any]:
        """Identified values, for a run's summary."""
        return {
            "encoder_offsets_deg": np.round(np.degrees(self.encoder_offsets), 4).tolist(),
            "com_offset_m": np.round(self.com_offset, 5).tolist(),
            "mass_ratio": round(self.mass_ratio, 4),
        }


def _limited(vector: NDArray[np.float64], size: float, largest: float) -> NDArray[np.float64]:
    return vector if size <= largest else vector * (largest / size)
