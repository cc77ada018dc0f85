"""Virtual wrenches of proximity, to stop a swing and turn a sole."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST, number
from plantar.common.arrays import array, is_finite
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_frames
from plantar.sensing.proximity import proximity_measure

# Frames that are worked on at once; chosen: 1024 frames of 42 taxels fit the cache; a time alone depends on it
_CHUNK = 1024


def virtual_ground_reaction_wrench(
    layout: SoleLayout, distance: ArrayLike, gain: float, sensing_range: float | None = None
) -> NDArray[np.float64]:
    """Virtual ground reaction wrench at the sole origin (T 4.26; T 3.30 corrected, 3.31-3.32).

    w_p = sum_i [R_i f_i, r_i x R_i f_i] with f_i = [0, 0, k_p rho_i]; printed T 3.30 attracts.

    Args:
        layout: Sole, n taxels.
        distance: Distances (n,) or (frames, n) in m; inf out of range, NaN if dead.
        gain: Repulsion k_p of each taxel in N/m.
        sensing_range: Range of sensors in m; layout's if None.

    Returns wrench (6,) or (frames, 6) in sole frame in N and N m; ReadingError, InputError: distances do not
    fit.
    """
    readings = taxel_frames(layout, distance, "distances")
    reach = layout.proximity_range if sensing_range is None else sensing_range
    stiffness = number(gain, "gain of proximity", finite=True)
    if readings.ndim < 2:
        return np.asarray(stiffness * layout.wrench_map.dot(proximity_measure(readings, reach)))
    into_wrench = stiffness * layout.wrench_map.T
    out = np.empty((*readings.shape[:-1], 6))
    for start in range(0, len(readings), _CHUNK):  # what is measured stays in the cache until it is summed
        part = slice(start, start + _CHUNK)
        np.matmul(proximity_measure(readings[part], reach), into_wrench, out=out[part])
    return out


def early_stop(virtual_wrench: ArrayLike, threshold: float) -> NDArray[np.bool_] | bool:
    """Whether the virtual force stops the swing: |f_p| > epsilon_stop (T 4.31, Fig. 49-c).

    `virtual_wrench`: virtual wrench (..., 6) in N and N m; `threshold`: threshold epsilon_stop in N.

    Returns bool for one wrench, a mask (...) for several; InputError: wrench not (..., 6).
    """
    stop = np.asarray(_size(array(virtual_wrench, "wrench", (..., 6))) > number(threshold, "threshold of the stop"))
    return bool(stop) if stop.ndim == 0 else stop


class SoleWrenchSwitch:
    """Wrench for preemptive foot compliance: contact plus virtual in the air, contact alone on the ground.

    T 4.30 corrected: printed, the virtual part vanishes where |w_f| > 0, which noise exceeds.

    `threshold`: force |f_f| in N above which the foot has landed; `release`: force in N at or below which it has
    lifted; half of `threshold` if None.

    Example:
        >>> up = np.array([0, 0, 1.0, 0, 0, 0])
        >>> switch = SoleWrenchSwitch(threshold=5.0)
        >>> [float(switch.update(force * up, 2.0 * up)[2]) for force in (0.0, 0.5, 9.0, 4.0)]
        [2.0, 2.5, 9.0, 4.0]
    """

    def __init__(self, threshold: float, release: float | None = None) -> None:
        self.threshold = number(threshold, "threshold", nan=True)
        self.release = 0.5 * self.threshold if release is None else number(release, "release", nan=True)
        if not self.release <= self.threshold:
            raise InputError(f"release is {self.release} N with a threshold of {threshold} N; allowed: not above it")
        self.landed = False

    def reset(self, landed: bool = False) -> None:
        """Start again, on the ground if `landed`."""
        self.landed = landed

    def update_force(self, force: float) -> bool:
        """Whether the sole has landed, by a vertical contact `force` in N alone; NaN or inf counts as zero."""
        size = abs(force) if math.isfinite(force) else 0.0
        self.landed = size > (self.release if self.landed else self.threshold)
        return self.landed

    def update(self, contact: ArrayLike, virtual: ArrayLike) -> NDArray[np.float64]:
        """Returns the wrench (6,) in N and N m of the next `contact` and `virtual` wrench (6,).

        NaN or inf counts as zero; InputError unless 6 numbers.
        """
        carried = _finite(contact, (6,))  # nature: the size of a wrench
        foreseen = _finite(virtual, (6,))  # nature: the size of a wrench
        force = math.hypot(*carried[:3].tolist())
        self.landed = force > (self.release if self.landed else self.threshold)
        return carried if self.landed else carried + foreseen


def _size(wrench: NDArray[np.float64]) -> NDArray[np.float64]:
    with np.errstate(over="ignore"):  # a force as large as none is beyond every threshold
        return np.asarray(np.hypot(np.hypot(wrench[..., 0], wrench[..., 1]), wrench[..., 2]))


def _finite(wrench: ArrayLike, shape: tuple[object, ...]) -> NDArray[np.float64]:
    given = array(wrench, "wrench", shape).copy()
    if not is_finite(given):
        given[~(np.abs(given) <= LARGEST).all(axis=-1)] = 0.0
    return given
