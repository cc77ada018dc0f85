"""Whether soles are mirrored, by their load: arch and hallux lie inside.

Matrices of cells show swapped feet or columns; insoles with mirrored numbers, such as pedar's, do not.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.recordings.pressure_recording import PressureRecording
from plantar.sides import Side

__all__ = ["inward_of_toes", "mirrored_doubts"]

_MIDFOOT, _TOES = (0.30, 0.55), (0.78, 1.01)
"""Parts of the sole's length from the heel on."""

_MIRRORED = -0.1
"""Mean of both feet from which they look mirrored; in the feet of three vendors' recordings it is 0.17 to 0.98."""


def mirrored_doubts(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> list[str]:
    """Returns a warning about a recording of two insoles whose feet are loaded as the other foot, where steps show
    it.
    """
    if recording.kind != "insole" or len(feet) < 2 or not all(gait.steps for gait in feet.values()):
        return []
    inward = [inward_of_toes(gait) for gait in feet.values()]
    if not all(value < 0.0 for value in inward) or float(np.mean(inward)) > _MIRRORED:
        return []
    return [
        "both feet carry more inside at the midfoot and outside at the toes, as mirrored feet do: check which insole "
        "is left and which right, and from which side the columns of cells are counted"
    ]


def inward_of_toes(gait: FootGait) -> float:
    """Distance of the toes' load inside of the midfoot's, in half widths of the sole; NaN without load or geometry."""
    layout, picture = gait.foot.layout, gait.picture
    if layout is None or picture is None:
        return float("nan")
    x, y = layout.positions[:, 0], layout.positions[:, 1] * (1.0 if gait.foot.side == "right" else -1.0)
    back, front = (float(v) for v in (layout.outline[:, 0].min(), layout.outline[:, 0].max()))
    along = (x - back) / (front - back)
    half = 0.5 * float(np.ptp(layout.outline[:, 1]))
    toes, midfoot = (_inward(y, layout.areas, picture, (along >= a) & (along < b)) for a, b in (_TOES, _MIDFOOT))
    return (toes - midfoot) / half


def _inward(
    y: NDArray[np.float64], areas: NDArray[np.float64], pressure: NDArray[np.float64], part: NDArray[np.bool_]
) -> float:
    """Distance in m of the load of some cells inside of their middle; NaN without load."""
    load = pressure[part] * areas[part]
    if not load.sum() > 0.0:
        return float("nan")
    return float((y[part] * load).sum() / load.sum() - (y[part] * areas[part]).sum() / areas[part].sum())
