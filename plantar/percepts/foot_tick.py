"""One foot for a walking controller at every tick, for loops at 1 kHz and faster."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.common.plane_points import plane_point
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_values

_FLOAT = np.dtype(np.float64)


class FootTick(NamedTuple):
    """One foot at one tick, in sole frame; as a `Percept`, computed together.

    Attributes:
        active: Active taxels (n,) (T 4.22).
        wrench: Ground reaction wrench (6,) about the sole's origin in N and N m (T 4.23).
        contact_area: Of active cells in m^2 (T 4.22).
        position_cop: Centre of pressure (2,) in m; None without load (T 4.21).
        support_polygon: Convex (k, 2) in m, counter-clockwise; empty without contact (T 4.24).
        support_area: Its area in m^2.
        centroid: Its centroid (2,) in m; None without contact (T 4.4.2).
        safe_polygon: The same (m, 2) with edges moved inwards; its deepest point (1, 2) if that leaves none.
        clamped: Its point (2,) closest to the aim (T Algorithm 1); None without contact.

    Example:
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.05, 0.05))
        >>> air = walking_tick(layout, np.zeros(len(layout)), aim=(0.1, 0.05))
        >>> air.position_cop, air.support_area, air.support_polygon.shape
        (None, 0.0, (0, 2))
    """

    active: NDArray[np.bool_]
    wrench: NDArray[np.float64]
    contact_area: float
    position_cop: NDArray[np.float64] | None
    support_polygon: NDArray[np.float64]
    support_area: float
    centroid: NDArray[np.float64] | None
    safe_polygon: NDArray[np.float64]
    clamped: NDArray[np.float64] | None


def walking_tick(
    layout: SoleLayout,
    force: ArrayLike,
    aim: tuple[float, float] | NDArray[np.float64],
    offset: float = 0.0,
    threshold: float | None = None,
) -> FootTick:
    """Active taxels, CoP, wrench, support and safe polygon, and clamped point of one foot.

    Args:
        layout: Sole, n taxels.
        force: Normal forces (n,) in N.
        aim: Point in sole frame in m to clamp to safe polygon.
        offset: Distance in m of safe polygon from support polygon's edges.
        threshold: Activation threshold in N; layout's if None.

    Returns:
        Foot's percept.

    Raises:
        ReadingError, InputError: Forces do not fit.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> foot = walking_tick(layout, np.full(len(layout), 10.0), aim=(0.2, 0.0), offset=0.02)
        >>> foot.clamped.round(9).tolist(), round(foot.wrench[2]), walking_tick(layout, np.zeros(37), (0, 0)).clamped
        ([0.08, 0.0], 370, None)
    """
    # What comes as it should is looked at here: calls for it would take a twentieth of the tick.
    distance = offset if type(offset) is float else number(offset, "offset of the safe polygon", nan=True)
    if not distance >= 0.0:
        raise InputError(f"offset of the safe polygon is {offset} m; allowed: 0 or more")
    plain = type(force) is np.ndarray and force.dtype is _FLOAT and force.shape == (len(layout.corners),)
    readings = force if plain else taxel_values(layout, force)
    level = layout.force_threshold if threshold is None else number(threshold, "force threshold")
    if type(aim) is tuple and len(aim) == 2 and type(aim[0]) is type(aim[1]) is float:
        at_x, at_y = aim
    elif type(aim) is np.ndarray and aim.dtype is _FLOAT and aim.shape == (2,):
        at_x, at_y = aim.tolist()
    else:
        at_x, at_y = plane_point(aim, "aim")
    felt = layout.kernel.tick(readings, level, layout.force_limit, distance, at_x, at_y)
    return tuple.__new__(FootTick, felt)
