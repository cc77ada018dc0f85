"""A wrench that knows how concentrated the contact is, and joint torques from a wrench."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.activation import active_taxels
from plantar.errors import InputError
from plantar.layout import SoleLayout

__all__ = ["joint_torque", "pressure_driven_wrench", "scaled_by_area"]


def pressure_driven_wrench(
    layout: SoleLayout, force: ArrayLike, reference_area: float, threshold: float | None = None
) -> NDArray[np.float64]:
    """Wrench that is amplified on a small contact area and damped on a large one (T 3.26-3.27).

    w_P = xi / sum(alpha_i) * w_f, with alpha_i the area A_i of each active taxel.

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) or (frames, n) in N; taxels that are dead or saturated are left out.
        reference_area: Gain xi in m^2: the contact area whose wrench is left as it is.
        threshold: Activation threshold epsilon_a in N; that of the layout where None.

    Returns:
        Wrench (6,) or (frames, 6) about the sole frame's origin in N and N m; zero without contact.

    Raises:
        InputError: If the reference area is not above 0.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], clip=False)
        >>> spread = np.full(len(layout), 60.0 / len(layout))
        >>> point = np.where(np.arange(len(layout)) == 3, 60.0, 0.0)
        >>> [round(float(pressure_driven_wrench(layout, f, 691e-6)[2]), 2) for f in (spread, point)]
        [3.16, 60.0]
    """
    readings = np.asarray(force, dtype=np.float64)
    active = active_taxels(readings, layout.force_threshold if threshold is None else threshold, layout.force_limit)
    return scaled_by_area(np.where(active, readings, 0.0) @ layout.wrench_map.T, active @ layout.areas, reference_area)


def scaled_by_area(wrench: ArrayLike, contact_area: ArrayLike, reference_area: float) -> NDArray[np.float64]:
    """A wrench scaled by the area it comes through: xi / area * w (T 3.27).

    Args:
        wrench: Wrench (6,) or (frames, 6) in N and N m.
        contact_area: Contact area () or (frames,) in m^2.
        reference_area: Gain xi in m^2.

    Returns:
        Wrench in the shape of `wrench` in N and N m; zero where the contact area is 0.

    Raises:
        InputError: If the reference area is not above 0.

    Example:
        >>> scaled_by_area([0, 0, 60.0, 0, 0, 0], 2e-3, 1e-3).tolist()
        [0.0, 0.0, 30.0, 0.0, 0.0, 0.0]
    """
    if not reference_area > 0.0:
        raise InputError(f"reference area is {reference_area} m^2; allowed: above 0")
    if isinstance(contact_area, float):  # one reading: without arrays for one number
        return np.asarray(
            np.asarray(wrench, dtype=np.float64) * (reference_area / contact_area if contact_area > 0.0 else 0.0)
        )
    area = np.asarray(contact_area, dtype=np.float64)[..., None]
    gain = np.divide(reference_area, area, out=np.zeros_like(area), where=area > 0.0)
    return np.asarray(np.asarray(wrench, dtype=np.float64) * gain)


def joint_torque(jacobian: ArrayLike, rotation_to_base: ArrayLike, wrench: ArrayLike) -> NDArray[np.float64]:
    """Joint torques of a real or virtual wrench at a link: tau = J^T E w (T 3.20, 3.28, 3.33, 3.38; A 13-14).

    Args:
        jacobian: Geometric Jacobian (6, joints) of the link's frame, linear rows first, in the base frame.
        rotation_to_base: Rotation (3, 3) from the link's (the sole's) frame to the base frame.
        wrench: Wrench (6,) or (frames, 6) about the link's origin in its frame in N and N m.

    Returns:
        Torques (joints,) or (frames, joints) in N m.

    Example:
        >>> slider_along_z = [[0.0], [0], [1], [0], [0], [0]]
        >>> joint_torque(slider_along_z, np.eye(3), [0, 0, 5.0, 1, 0, 0]).tolist()
        [5.0]
    """
    rotation, given = np.asarray(rotation_to_base, dtype=float), np.asarray(wrench, dtype=float)
    turned = np.concatenate([given[..., :3] @ rotation.T, given[..., 3:] @ rotation.T], axis=-1)
    return np.asarray(turned @ np.asarray(jacobian, dtype=float))
