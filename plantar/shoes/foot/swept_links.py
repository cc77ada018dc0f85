"""Where the robot's other links pass around its foot while the ankle moves."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot.model_source import ModelSource
from plantar.shoes.geometry.surface import corner_numbers, surface_points

__all__ = ["swept_points"]

_LINKS = 3  # above the foot that are looked at
_POSES = 5  # of each joint, from end to end of its range
_NEAR = 0.05  # m around the foot
_SPACING = 0.004  # m between points

Array = NDArray[np.float64]


def swept_points(source: ModelSource, name: str, surface: Array) -> tuple[Array | None, str]:
    """Points of the links above a foot over the range of its last two hinges.

    Args:
        source: The robot's model.
        name: The foot's body.
        surface: Its triangles (k, 3, 3) in m; only points near them are kept.

    Returns:
        Points (n, 3) in m about the body's origin, turned as at the zero pose, None if unknown; and a note.
    """
    try:
        surfaces, ranges, poses = source.links_above(name, _LINKS)
    except FootError as error:
        reason = str(error).removeprefix(f"{source.file}: ")[:100]
        return None, f"the robot's other links are not read: {reason}"
    if not surfaces:
        return None, "the links above the foot have no shape"
    clouds = [_thinned(surface_points(triangles, _SPACING)) for triangles in surfaces]
    low, high = surface.min(axis=(0, 1)) - _NEAR, surface.max(axis=(0, 1)) + _NEAR
    found = []
    for angles in itertools.product(*(np.linspace(*span, _POSES) for span in ranges)):
        for points, (turn, place) in zip(clouds, poses(angles), strict=True):
            near = points @ turn.T + place
            found.append(near[((near > low) & (near < high)).all(axis=1)])
    swept = _thinned(np.concatenate(found))
    spans = ", ".join(f"{np.degrees(end - start):.0f}" for start, end in ranges)
    note = f"the links above the foot are swept over {len(ranges)} joint(s), {spans} degrees"
    return (swept, note) if len(swept) else (None, "no link above the foot passes near it")


def _thinned(points: Array) -> Array:
    _, first = np.unique(corner_numbers(1e-3 * points / _SPACING), return_index=True)
    return np.asarray(points[first])
