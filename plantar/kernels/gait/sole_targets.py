"""Kernel of a sole's commanded pose and force (products summed as BLAS does, `fused`)."""

from ..base import fused, memory, vectors
from ..mechanics import rotations

__all__ = ["pressed", "risen", "turned"]


def turned(level, x, y):
    """Rotation (3, 3) of a sole turned by `x`, `y` (axis times angle in rad) about its own axes from `level` (3, 3)."""
    before = memory.values(level)
    xx, xy, xz, yx, yy, yz, zx, zy, zz = rotations._exponential(x, y, 0.0)
    made = memory.new_matrix(3, 3)
    out = memory.room(made)
    for i in range(3):
        a, b, c = before[3 * i], before[3 * i + 1], before[3 * i + 2]
        out[3 * i] = fused.multiply_add(c, zx, fused.multiply_add(b, yx, a * xx))
        out[3 * i + 1] = fused.multiply_add(c, zy, fused.multiply_add(b, yy, a * xy))
        out[3 * i + 2] = fused.multiply_add(c, zz, fused.multiply_add(b, yz, a * xz))
    return made


def risen(position, center, roll, pitch, shift):
    """Position (3,) in m of a turned and shifted sole: its center rises by the shift, to first order.

    Args:
        position: Origin (3,) of its frame in m.
        center: The center (2,) in its frame in m.
        roll: Turn about its x axis in rad; `pitch` about y.
        shift: Shift upwards in m.
    """
    place, middle = memory.values(position), memory.values(center)
    rise = shift + pitch * middle[0] - roll * middle[1]
    return vectors.vector(place[0], place[1], place[2] + rise)


def pressed(wrench, level, position, center):
    """A wrench on a sole as a force at its center of pressure.

    Args:
        wrench: Wrench (6,) in the sole frame about its origin in N and N m.
        level: Rotation (3, 3) from the sole.
        position: Origin (3,) of its frame in m.
        center: Point of attack (2,) in the sole frame in m without pressure.

    Returns:
        The force (3,) in N, and the point (2,) in m, seen from above, at which it acts.
    """
    w, r, place, middle = memory.values(wrench), memory.values(level), memory.values(position), memory.values(center)
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
