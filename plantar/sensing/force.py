"""Center of pressure and ground reaction wrench of a sole."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number, positive
from plantar.common.arrays import array
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_frames, taxel_values
from plantar.sensing.activation import active_of


def center_of_pressure(
    layout: SoleLayout, force: ArrayLike, threshold: float | None = None
) -> NDArray[np.float64] | None:
    """Center of pressure (2,) of one sole in its frame in m (T 4.21), or None without force.

    `force`: normal forces (n,) in N; only active taxels count; `threshold` in N; layout's if None.

    Returns point; for many frames see `plantar.batch.loads`; ReadingError or InputError for other shapes.
    """
    vertical = _active(layout, taxel_values(layout, force), threshold) * layout.rotations[:, 2, 2]
    total = float(vertical.sum())
    return np.asarray(vertical @ layout.positions[:, :2] / total) if total > 0.0 else None


def ground_reaction_wrench(layout: SoleLayout, force: ArrayLike, threshold: float | None = None) -> NDArray[np.float64]:
    """Ground reaction wrench at sole origin (T 4.23).

    `force`: normal forces (n,) or (frames, n) in N; only active taxels count; `threshold` in N; layout's if None.

    Returns wrench (6,) or (frames, 6) in sole frame in N and N m, by world on sole; ReadingError, InputError:
    forces not (..., taxels).
    """
    return np.asarray(_active(layout, taxel_frames(layout, force), threshold) @ layout.wrench_map.T)


def _active(layout: SoleLayout, force: NDArray[np.float64], threshold: float | None) -> NDArray[np.float64]:
    """Forces of active taxels, 0 elsewhere."""
    return np.where(active_of(layout, force, threshold), force, 0.0)


def pressure_driven_wrench(
    layout: SoleLayout, force: ArrayLike, reference_area: float, threshold: float | None = None
) -> NDArray[np.float64]:
    """Wrench amplified on a small contact area, damped on a large one (T 3.26-3.27): w_P = xi / sum(alpha_i) * w_f.

    `force`: normal forces (n,) or (frames, n) in N; `reference_area`: gain xi in m^2: contact area with unchanged
    wrench; `threshold`: activation threshold epsilon_a in N; layout's if None.

    Returns wrench (6,) or (frames, 6) about sole origin in N and N m; zero without contact; raises ReadingError,
    InputError: forces not (..., taxels).
    """
    readings = taxel_frames(layout, force)
    active = active_of(layout, readings, threshold)
    with np.errstate(over="ignore", invalid="ignore"):  # of forces as large as no sensor's, where no range is stated
        wrench = np.where(active, readings, 0.0) @ layout.wrench_map.T
    return scaled_by_area(wrench, active @ layout.areas, reference_area)


def scaled_by_area(wrench: ArrayLike, contact_area: ArrayLike, reference_area: float) -> NDArray[np.float64]:
    """Wrench scaled by its contact area: xi / area * w (T 3.27).

    `wrench`: wrench (6,) or (frames, 6) in N and N m; `contact_area`: contact area () or (frames,) in m^2;
    `reference_area`: gain xi in m^2.

    Returns wrench in shape of `wrench`; zero where contact area is 0; InputError: shapes differ, area not above
    0.
    """
    reference = positive(reference_area, "reference area", "m^2")
    given = array(wrench, "wrench", (..., 6))
    if isinstance(contact_area, float) and given.ndim == 1:  # one reading: without arrays for one number
        one = number(contact_area, "contact area", finite=True)
        return np.asarray(given * (reference / one if one > 0.0 else 0.0))
    area = array(contact_area, "contact area", (...,), finite=True)
    if area.shape != given.shape[:-1]:
        raise InputError(f"contact area has shape {area.shape}; expected one a wrench, {given.shape[:-1]}")
    with np.errstate(over="ignore", invalid="ignore"):  # of forces that are not finite
        gain = np.divide(reference, area[..., None], out=np.zeros((*area.shape, 1)), where=area[..., None] > 0.0)
        return np.asarray(given * gain)


def joint_torque(jacobian: ArrayLike, rotation_to_base: ArrayLike, wrench: ArrayLike) -> NDArray[np.float64]:
    """Joint torques of a wrench at a link: tau = J^T E w (T 3.20, 3.28, 3.33, 3.38; A 13-14).

    `jacobian`: geometric Jacobian (6, joints) of link's frame, linear rows first, in base frame; `rotation_to_base`:
    rotation (3, 3) from link's (the sole's) frame to base frame; `wrench`: wrench (6,) or (frames, 6) about link's
    origin in its frame in N and N m.

    Returns torques (joints,) or (frames, joints) in N m; InputError: another shape, not finite.
    """
    columns = array(jacobian, "jacobian", (6, "joints"), finite=True)
    rotation = array(rotation_to_base, "rotation", (3, 3), finite=True)
    given = array(wrench, "wrench", (..., 6))
    with np.errstate(over="ignore", invalid="ignore"):  # of forces that are not finite
        turned = np.concatenate([given[..., :3] @ rotation.T, given[..., 3:] @ rotation.T], axis=-1)
        return np.asarray(turned @ columns)
