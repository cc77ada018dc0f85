"""Foot damping and foot force difference control (Kajita et al. 2010, Caron et al. 2019).

Soles turn with the moment error; the more loaded foot goes up, the other down.
"""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, fixed, share
from plantar.common.sides import SIDES, Side
from plantar.kernels.gait.sole_admittance import SoleAdmittance


class AdmittanceGains(Settings):
    """Gains of the feet's admittance.

    Attributes:
        foot_turn_gain: Sole's rate in rad/s per N m of moment error.
        foot_lift_gain: Height difference's rate in m/s per N of force difference error.
        foot_return: Decay in 1/s of a standing foot's corrections.
    """

    # chosen: bounded by the delay of sensors and drives, 20 ms, with which a stiffer sole swings
    foot_turn_gain: float = share(0.0521, "rad/beat/weight/sole", 0, 1)
    foot_lift_gain: float = share(0.00695, "leg/beat/weight", 0, 0.1)  # chosen: bounded likewise
    foot_return: float = share(0.247, "1/beat", 0, 100)  # derived: as T Table 2's return of the CoM, 1 1/s
    # Rate in 1/s at which they do in the air; chosen: gone in a third of a swing
    foot_release: float = fixed(1.98, "1/beat")
    # Low-pass time constant in s of the measured wrench; derived: as `zmp_filter`
    foot_filter: float = fixed(0.0809, "beat")
    # Largest turn about an axis in rad; chosen: 4.6 degrees; soles that turn farther stand on their edges
    largest_turn: ClassVar[float] = 0.08
    largest_lift: float = fixed(1 / 30, "leg")  # Largest shift in m; chosen: 20 mm on h1


class FootAdmittance:
    """Admittance of both feet.

    Attributes `corrections` of each commanded sole: `roll`, `pitch` in rad about its axes, `shift` in m upwards.
    `period` of control in s.
    """

    def __init__(self, gains: AdmittanceGains, period: float) -> None:
        g = gains
        self.gains = gains
        rates = (period / (g.foot_filter + period), g.foot_turn_gain, g.foot_return, g.foot_release)
        self.corrections: Mapping[Side, SoleAdmittance] = {
            side: SoleAdmittance(period, *rates, g.largest_turn, g.largest_lift) for side in SIDES
        }

    @property
    def acts(self) -> bool:
        """Whether any sole is corrected."""
        return bool(self.corrections["left"].acts() or self.corrections["right"].acts())

    def fade(self) -> None:
        """A tick without a wanted wrench: corrections go back to none."""
        self.corrections["left"].fade()
        self.corrections["right"].fade()

    def update(
        self,
        wanted: Mapping[Side, NDArray[np.float64]],
        measured: Mapping[Side, NDArray[np.float64]],
        rests: bool = False,
    ) -> Mapping[Side, SoleAdmittance]:
        """Returns `corrections` after a tick by each standing foot's wrench (6,) by the world, sole frame, `wanted` and
        `measured`; those in the air fade, and none decays where the robot `rests`.
        """
        errors: list[float] = []
        for side, foot in self.corrections.items():
            foot.back = 0.0 if rests else self.gains.foot_return
            if side in wanted:
                errors.append(foot.turn(measured[side], wanted[side]))
            else:
                foot.fade()
        if len(errors) == 2:
            # Foot force difference control: one foot goes up as much as the other goes down, so that the body keeps
            # its height.
            rate = 0.5 * self.gains.foot_lift_gain * (errors[0] - errors[1])
            self.corrections["left"].lift(rate)
            self.corrections["right"].lift(-rate)
        else:
            for side in wanted:
                self.corrections[side].lift(0.0)
        return self.corrections
