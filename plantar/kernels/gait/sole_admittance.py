"""Kernel of `plantar.gait.balance.foot_admittance` for one sole."""

from ..base import fused, memory, vectors
from ..mechanics import rotations

__all__ = ["SoleAdmittance", "pressed", "risen", "turned"]


# rad and m: below what any servo resolves a correction that fades is exactly none; derived: a tenth of a micrometre or
# microradian, a thousandth of an encoder's step
_NONE = 1e-7


class SoleAdmittance:
    """Correction of one commanded sole: `roll`, `pitch` in rad about its axes, `shift` upwards in m.

    `period`: control period in s; `share`: share of new measurement in its low pass; `turn_gain`: turning rate in rad/s
    per N m of moment error; `back`: rate in 1/s of return to zero in stance, may change; `release` in the air;
    `largest_turn`: largest turn about an axis in rad; `largest_lift`: largest shift in m.
    """

    def __init__(self, period, share, turn_gain, back, release, largest_turn, largest_lift):
        self.period = period
        self.share = share
        self.turn_gain = turn_gain
        self.back = back
        self.keep = max(0.0, 1.0 - release * period)
        self.largest_turn = largest_turn
        self.largest_lift = largest_lift
        self.roll = 0.0
        self.pitch = 0.0
        self.shift = 0.0
        self.stands = False
        self.fz = 0.0
        self.tx = 0.0
        self.ty = 0.0

    def fade(self):
        """One tick in the air."""
        # There is no load to compare with, and the filter must restart at touchdown.
        self.stands = False
        self.roll = self.keep * self.roll
        self.pitch = self.keep * self.pitch
        self.shift = self.keep * self.shift
        # An exponential never ends.
        if abs(self.roll) + abs(self.pitch) + abs(self.shift) < _NONE:
            self.roll = 0.0
            self.pitch = 0.0
            self.shift = 0.0

    def acts(self):
        """Whether the sole is corrected."""
        return self.roll != 0.0 or self.pitch != 0.0 or self.shift != 0.0

    def turn(self, measured, wanted):
        """Turn by a tick under load from the measured to the desired wrench (6,) in sole frame in N and N m.

        Returns error in N of normal force.
        """
        now = memory.values(measured)
        goal = memory.values(wanted)
        # Only fz, tx and ty: a sole turns and lifts for these; friction carries the other three.
        fz = now[2]
        tx = now[3]
        ty = now[4]
        if not (fz - fz == 0.0 and tx - tx == 0.0 and ty - ty == 0.0):
            return 0.0  # a wrench that is no number turns nothing
        if self.stands:
            fz = self.fz + self.share * (fz - self.fz)
            tx = self.tx + self.share * (tx - self.tx)
            ty = self.ty + self.share * (ty - self.ty)
        self.stands = True
        self.fz = fz
        self.tx = tx
        self.ty = ty
        self.roll = self._moved(self.roll, self.turn_gain * (tx - goal[3]), self.largest_turn)
        self.pitch = self._moved(self.pitch, self.turn_gain * (ty - goal[4]), self.largest_turn)
        return fz - goal[2]

    def lift(self, rate):
        """Shift by a tick under load, at a rate in m/s upwards."""
        self.shift = self._moved(self.shift, rate, self.largest_lift)

    def _moved(self, value, rate, largest):
        value += self.period * (rate - self.back * value)
        if not value > -largest:
            value = -largest
        return value if value < largest else largest


def turned(level, x, y):
    """Rotation (3, 3) of a sole turned by `x`, `y` (axis times angle in rad) about its axes from `level` (3, 3)."""
    before = memory.values(level)
    xx, xy, xz, yx, yy, yz, zx, zy, zz = rotations._exponential(x, y, 0.0)
    made = memory.new_matrix(3, 3)
    out = memory.room(made)
    for i in range(3):
        a = before[3 * i]
        b = before[3 * i + 1]
        c = before[3 * i + 2]
        out[3 * i] = fused.multiply_add(c, zx, fused.multiply_add(b, yx, a * xx))
        out[3 * i + 1] = fused.multiply_add(c, zy, fused.multiply_add(b, yy, a * xy))
        out[3 * i + 2] = fused.multiply_add(c, zz, fused.multiply_add(b, yz, a * xz))
    return made


def risen(position, center, roll, pitch, shift):
    """Returns `position` (3,) in m of a sole that turns by `roll` and `pitch` in rad about its frame's origin; its
    `center` (2,) rises by `shift` in m.
    """
    place = memory.values(position)
    middle = memory.values(center)
    rise = shift + pitch * middle[0] - roll * middle[1]
    return vectors.vector(place[0], place[1], place[2] + rise)


def pressed(wrench, level, position, center):
    """Returns force (3,) in N of a `wrench` (6,) about a sole's origin, and point (2,) in m, seen from above, at which
    it acts: `center` (2,) without pressure. The sole's frame turns by `level` (3, 3), from a `position` (3,).
    """
    w = memory.values(wrench)
    r = memory.values(level)
    place = memory.values(position)
    middle = memory.values(center)
    x, y = (-w[4] / w[2], w[3] / w[2]) if w[2] > 0.0 else (middle[0], middle[1])
    force = vectors.vector(
        fused.multiply_add(r[2], w[2], fused.multiply_add(r[0], w[0], r[1] * w[1])),
        fused.multiply_add(r[5], w[2], fused.multiply_add(r[3], w[0], r[4] * w[1])),
        fused.multiply_add(r[8], w[2], fused.multiply_add(r[6], w[0], r[7] * w[1])),
    )
    acts = vectors.vector2(
        place[0] + fused.multiply_add(r[0], x, r[1] * y), place[1] + fused.multiply_add(r[3], x, r[4] * y)
    )
    return force, acts
