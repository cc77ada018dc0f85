"""Kinds of swing: built in, and entry points `plantar.swings`."""

from functools import cache

from plantar.common.extensions import extensions
from plantar.gait.feet.swing_fit import SwingFitRules
from plantar.gait.feet.swing_flight import PolynomialSwing
from plantar.gait.feet.swing_kind import SwingKind


@cache
def swing_kinds() -> dict[str, type[SwingKind]]:
    """Kinds by their `control.swing_shape` names; the first is the default.

    Example:
        >>> list(swing_kinds())[:2]
        ['polynomial', 'fit']
    """
    own = {"polynomial": PolynomialSwing, "fit": SwingFitRules}
    return {**own, **extensions("plantar.swings", SwingKind, tuple(own))}
