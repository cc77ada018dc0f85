"""A wall that is low enough for the robot's other links to pass. In mm."""

from dataclasses import replace

import numpy as np
import shapely

from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import grown
from plantar.shoes.parameters import ShoeParameters

_STEP = 1.0
_LOWEST = 4.0  # a lower wall holds nothing
_BEND = 0.1  # more than the wall is thick: the outline's corners are cut


def lowered_wall(foot: Foot, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters with the highest wall that no link of the robot's model meets, and a note.

    Unchanged where links are unknown, or where even the lowest wall would be met: the check names that.
    """
    p = parameters
    if foot.links is None or not _met(foot, p.rim_height, p):
        return p, ()
    for height in np.arange(np.floor(p.rim_height - _STEP), _LOWEST - 1e-9, -_STEP).tolist():
        if not _met(foot, height, p):
            note = f"rim_height lowered from {p.rim_height:g} to {height:g} mm: other links of the robot pass there"
            return replace(p, rim_height=height), (note,)
    return p, ()


def _met(foot: Foot, height: float, p: ShoeParameters) -> bool:
    """Whether a link passes through a wall of a height."""
    assert foot.links is not None
    outline = foot.passing(height)
    wall = grown(outline, p.clearance + p.rim_thickness + _BEND).difference(grown(outline, p.clearance))
    near = foot.links[(foot.links[:, 2] > 0.0) & (foot.links[:, 2] <= height)]
    return bool(shapely.contains_xy(wall, near[:, 0], near[:, 1]).any())
