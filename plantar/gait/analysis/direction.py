"""Direction of a walk relative to the feet: forwards, backwards or sideways."""

from collections.abc import Mapping

import numpy as np

from plantar.common.sides import Side
from plantar.gait.analysis.steps.foot_gait import FootGait

_FEWEST = 3  # Steps that show a direction
_AHEAD = 45.0  # Largest angle in degrees between the feet and the way of a walk forwards


def direction_of(feet: Mapping[Side, FootGait]) -> str | None:
    """Returns "forwards", "backwards", "sideways to the left" or "... right"; None if the used steps do not show it.

    By the mean angle from the feet's axes to the way walked (of unit vectors, as angles turn over).
    """
    angles = [
        (1.0 if side == "left" else -1.0) * step["foot_progression_deg"]
        for side, gait in feet.items()
        for step in gait.used
        if np.isfinite(step["foot_progression_deg"])
    ]
    if len(angles) < _FEWEST:
        return None
    turn = -float(np.degrees(np.angle(np.exp(1j * np.radians(angles)).sum())))  # of the way, from the feet on, leftward
    if abs(turn) <= _AHEAD:
        return "forwards"
    if abs(turn) >= 180.0 - _AHEAD:
        return "backwards"
    return f"sideways to the {'left' if turn > 0.0 else 'right'}"


def direction_notes(feet: Mapping[Side, FootGait], direction: str | None) -> list[str]:
    """Returns a note on a walk that is not forwards: step lengths are along the way walked, widths across it."""
    if direction in (None, "forwards"):
        return []
    lengths = {side: np.array([step["step_length_m"] for step in gait.used]) for side, gait in feet.items()}
    each = " and ".join(
        f"{1e3 * np.nanmean(own):+.0f} mm of the {side} foot" for side, own in lengths.items() if np.isfinite(own).any()
    )
    return [
        f"this is walking {direction}: step lengths are along the way walked, from the other foot's heel"
        f"{f' ({each})' if each else ''}, step widths across it, along the feet where they are beside the way"
    ]
