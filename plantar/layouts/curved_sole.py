"""A flat layout laid over a curved sole."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance
from plantar.common.arrays import array, is_finite, numbers
from plantar.errors import InputError, LayoutError
from plantar.layouts.layout import SoleLayout

Surface = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]
"""Height z (...) of the sole's outer face in m over positions x (...) and y (...) in m, in the sole frame."""

_STEP = 1e-5  # Half width in m of the differences that give the slope


def laid_over(layout: SoleLayout, surface: Surface) -> SoleLayout:
    """Layout on a curved sole z(x, y), unchanged from above (soleT_i of T 4.23).

    Each taxel turns the shortest way that brings its z axis onto the normal.

    Args:
        layout: The flat layout.
        surface: Height of sole's outer face in m; smooth, called with arrays.

    Returns:
        Layout on surface: positions, vertices, rotations R_i, areas.

    Raises:
        LayoutError: Not flat, or a height is not finite.

    Example:
        >>> from plantar import hex_layout
        >>> flat = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> rocker = laid_over(flat, lambda x, y: 0.5 * x**2 / 0.3)
        >>> toe = int(rocker.positions[:, 0].argmax())
        >>> bool(rocker.rotations[toe, 0, 2] < -0.2), bool(rocker.areas[toe] > flat.areas[toe])
        (True, True)
    """
    instance(layout, SoleLayout, "layout", LayoutError)
    if not callable(surface):
        raise LayoutError(f"surface is {surface!r}; expected a function of x and y")
    if np.abs(layout.vertices[:, 2]).max(initial=0.0) > 0.0 or np.abs(layout.positions[:, 2]).max(initial=0.0) > 0.0:
        raise LayoutError("the layout is curved already; lay a flat one over the surface")

    def height(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        try:
            z = numbers(surface(x, y), "height")
        except (TypeError, ValueError, InputError) as error:
            raise LayoutError(f"the surface gives no height: {error}") from None
        if z.shape not in ((), x.shape):
            raise LayoutError(f"the surface gives heights of shape {z.shape} for points of shape {x.shape}")
        if not is_finite(z):
            raise LayoutError("the surface gives a height that is not finite")
        return np.broadcast_to(z, x.shape)

    x = layout.positions[:, 0]
    y = layout.positions[:, 1]
    slope_x = (height(x + _STEP, y) - height(x - _STEP, y)) / (2.0 * _STEP)
    slope_y = (height(x, y + _STEP) - height(x, y - _STEP)) / (2.0 * _STEP)
    normals = np.column_stack([-slope_x, -slope_y, np.ones(len(layout))])
    positions = np.column_stack([x, y, height(x, y)])
    vertices = np.column_stack([layout.vertices[:, :2], height(*layout.vertices[:, :2].T)])
    return replace(
        layout,
        positions=positions,
        vertices=vertices,
        rotations=rotations_to_normals(normals) @ layout.rotations,
        areas=np.array([_fan(positions[i], vertices[list(c)]) for i, c in enumerate(layout.corners)]),
    )


def rotations_to_normals(normals: ArrayLike) -> NDArray[np.float64]:
    """Shortest rotations (n, 3, 3) that take the z axis onto directions (n, 3), any length, z above 0; else a
    LayoutError.
    """
    given = array(normals, "directions", ("n", 3), LayoutError, finite=True)
    if not (given[:, 2] > 0.0).all():
        raise LayoutError("a taxel does not face the ground: its z axis must point into the body, upwards")
    _, size = np.frexp(np.abs(given).max(axis=1, keepdims=True, initial=0.0))
    given = np.ldexp(given, -size)  # exact; squares of tiny and huge ones are not
    nx, ny, nz = (given / np.linalg.norm(given, axis=1, keepdims=True)).T
    k = 1.0 / (1.0 + nz)
    rows = [
        [1.0 - k * nx * nx, 0.0 - k * nx * ny, nx],
        [0.0 - k * nx * ny, 1.0 - k * ny * ny, ny],
        [0.0 - nx, 0.0 - ny, nz],
    ]
    return np.moveaxis(np.array([[np.asarray(v) for v in row] for row in rows]), -1, 0)


def _fan(centre: NDArray[np.float64], ring: NDArray[np.float64]) -> float:
    """Area in m^2 of triangles from a cell's center to its edges, signed as seen from above."""
    arm = ring - centre
    twice = np.cross(arm, np.roll(arm, -1, axis=0))
    return 0.5 * float(np.copysign(np.linalg.norm(twice, axis=1), twice[:, 2]).sum())
