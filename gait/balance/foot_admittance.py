"""Foot damping and foot force difference control: feet that yield until they carry the wrenches they shall.

After Kajita et al. 2010 and Caron et al. 2019. A sole that feels too much moment about an axis turns along with it
until the moment is as wanted, which moves its centre of pressure; of two feet the one that carries too much goes up
and the other one down. All corrections return to zero slowly, and quickly for a foot in the air.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import Side
from plantar.settings.schema import Settings, number, share
from plantar.sides import SIDES

__all__ = ["AdmittanceGains", "FootAdmittance", "FootCorrection"]


class AdmittanceGains(Settings):
    """Gains of the feet's admittance.

    Attributes:
        foot_turn_gain: Turning rate of a sole in rad/s for each N m of moment error.
        foot_lift_gain: Rate of the feet's height difference in m/s for each N of error of their force difference.
        foot_return: Rate in 1/s at which corrections return to zero while the foot stands.
        foot_release: Rate in 1/s at which they do in the air.
        foot_filter: Time constant in s of the low-pass on the measured wrench.
        largest_turn: Largest turn of a sole about an axis in rad.
        largest_lift: Largest shift of a sole in m.
    """

    foot_turn_gain: float = share(0.0481, "rad/beat/weight/sole", 0, 1)
    foot_lift_gain: float = share(0.00695, "leg/beat/weight", 0, 0.1)
    foot_return: float = share(0.247, "1/beat", 0, 100)
    foot_release: float = share(1.98, "1/beat", 0, 200)
    foot_filter: float = share(0.0809, "beat", 0, 1)
    largest_turn: float = number(0.08, "rad", 0, 0.5)
    largest_lift: float = share(1 / 30, "leg", 0, 0.2)


@dataclass
class FootCorrection:
    """Correction of one commanded sole.

    Attributes:
        roll: Turn about the sole's x axis in rad.
        pitch: Turn about its y axis in rad.
        shift: Shift upwards in m.
    """

    roll: float = 0.0
    pitch: float = 0.0
    shift: float = 0.0


class FootAdmittance:
    """Admittance of both feet.

    Args:
        gains: The gains.
        period: Control period in s.
    """

    def __init__(self, gains: AdmittanceGains, period: float) -> None:
        self.gains = gains
        self.period = period
        self.corrections = {s: FootCorrection() for s in SIDES}
        self._measured: dict[Side, list[float] | None] = {"left": None, "right": None}

    def update(
        self, wanted: Mapping[Side, NDArray[np.float64]], measured: Mapping[Side, NDArray[np.float64]]
    ) -> Mapping[Side, FootCorrection]:
        """One control tick.

        Args:
            wanted: Wrench (6,) that each standing foot shall carry in its sole frame, by the world on the robot.
            measured: Wrench (6,) that it carries, for the same feet.

        Returns:
            Correction of each foot; that of a foot in the air fades.
        """
        g, dt = self.gains, self.period
        share = dt / (g.foot_filter + dt)
        errors: dict[Side, float] = {}
        for side in SIDES:
            foot = self.corrections[side]
            if side not in wanted:
                # A foot in the air has no load to compare with, and its filter must begin anew at touchdown.
                self._measured[side] = None
                keep = max(0.0, 1.0 - g.foot_release * dt)
                foot.roll, foot.pitch, foot.shift = keep * foot.roll, keep * foot.pitch, keep * foot.shift
                # An exponential never ends: below what any servo resolves the correction is exactly none.
                if abs(foot.roll) + abs(foot.pitch) + abs(foot.shift) < 1e-7:
                    foot.roll = foot.pitch = foot.shift = 0.0
                continue
            # Only fz, tx and ty: a sole turns and lifts for these; friction carries the other three.
            _, _, *now, _ = measured[side].tolist()
            last = self._measured[side]
            fz, tx, ty = (
                now if last is None else [old + share * (new - old) for old, new in zip(last, now, strict=True)]
            )
            self._measured[side] = [fz, tx, ty]
            _, _, wanted_fz, wanted_tx, wanted_ty, _ = wanted[side].tolist()
            foot.roll = self._moved(foot.roll, g.foot_turn_gain * (tx - wanted_tx), g.largest_turn)
            foot.pitch = self._moved(foot.pitch, g.foot_turn_gain * (ty - wanted_ty), g.largest_turn)
            errors[side] = fz - wanted_fz
        # Foot force difference control: one foot goes up as much as the other goes down, so that the body keeps its
        # height.
        if len(errors) == 2:
            rate = 0.5 * g.foot_lift_gain * (errors["left"] - errors["right"])
            for side, sign in (("left", 1.0), ("right", -1.0)):
                foot = self.corrections[side]
                foot.shift = self._moved(foot.shift, sign * rate, g.largest_lift)
        else:
            for side in errors:
                self.corrections[side].shift = self._moved(self.corrections[side].shift, 0.0, g.largest_lift)
        return self.corrections

    def _moved(self, value: float, rate: float, largest: float) -> float:
        """A correction after one tick at a rate, drawn back to zero and limited."""
        value += self.period * (rate - self.gains.foot_return * value)
        return min(largest, max(-largest, value))
