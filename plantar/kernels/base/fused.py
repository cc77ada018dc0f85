"""Fused multiply-add as of BLAS; interpreted counterpart of `fused_in_c.pxd`."""

import math
from fractions import Fraction

__all__ = ["multiply_add"]


def multiply_add(a, b, c):
    """Returns a b + c, rounded once (by exact fractions)."""
    if math.isfinite(a) and math.isfinite(b) and math.isfinite(c):
        exact = Fraction(a) * Fraction(b) + Fraction(c)
        if exact:
            try:
                return float(exact)
            except OverflowError:
                return math.inf if exact > 0 else -math.inf
    return float(a) * float(b) + float(c)
