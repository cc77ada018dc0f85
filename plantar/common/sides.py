"""Left and right: the names of a foot's side, in order."""

from typing import Literal

Side = Literal["left", "right"]
"""Which foot something belongs to."""

SIDES: tuple[Side, Side] = ("left", "right")
"""Both sides; sums over feet are taken in this order, so that they keep their last bit."""


def other_side(side: Side) -> Side:
    """Side of the other foot. `side`: "left" or "right".

    Example:
        >>> other_side("left"), [other_side(side) for side in SIDES]
        ('right', ['right', 'left'])
    """
    return "right" if side == "left" else "left"
