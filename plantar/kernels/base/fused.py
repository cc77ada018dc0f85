"""What the interpreted kernels call where the compiled ones have the processor's fused multiply-add
(`fused_in_c.pxd`).

Numpy leaves products of matrices to BLAS, which rounds a product and its sum at once where the processor can. A kernel
that takes over such a product keeps its bits by doing the same, on every machine.
"""

from __future__ import annotations

import math
from fractions import Fraction

__all__ = ["multiply_add"]


def multiply_add(a, b, c):
    """a b + c, rounded once: that of IEEE 754, here by exact fractions.

    Args:
        a: A number.
        b: A number.
        c: A number.

    Returns:
        The number nearest to a b + c; where one of them is not finite, or the result beyond all numbers, as the
        processor has it.
    """
    if math.isfinite(a) and math.isfinite(b) and math.isfinite(c):
        exact = Fraction(a) * Fraction(b) + Fraction(c)
        if exact:
            try:
                return float(exact)
            except OverflowError:
                return math.inf if exact > 0 else -math.inf
    return float(a) * float(b) + float(c)
