"""Activation, wrench, contact area and CoP of arrays of torch, JAX, CuPy or numpy.

Arrays of the array API standard, and torch's, keep library, device and type; sums are differentiable in active forces.
On a CPU `plantar.batch` is faster.
"""

import sys
from typing import Any, NamedTuple

import numpy as np

from plantar.common.arguments import instance, number
from plantar.errors import ReadingError
from plantar.layouts.layout import SoleLayout


class ArrayLoads(NamedTuple):
    """Sums of forces; "..." are dimensions before taxels.

    `wrench`: ground reaction wrench (..., 6) about sole origin in N and N m (T 4.23); `contact_area`: area (...) of
    active cells in m^2 (T 4.22); `center_of_pressure`: position (..., 2) in sole frame in m (T 4.21); NaN without load.
    """

    wrench: Any
    contact_area: Any
    center_of_pressure: Any


def active(layout: SoleLayout, force: Any, threshold: float | None = None) -> Any:
    """Active taxels (T 4.22): above the threshold, below the layout's force limit, not dead.

    `force`: normal forces (..., n) in N, floating point; `threshold`: activation threshold in N; layout's if None.
    Returns mask (..., n) of the same library.
    """
    instance(layout, SoleLayout, "layout")
    xp = _namespace(layout, force)
    low = layout.force_threshold if threshold is None else number(threshold, "activation threshold")
    above = (force > low) & (force < layout.force_limit)
    cell, sole = layout.contact_levels
    if not cell or low != layout.force_threshold:
        return above
    pressed = xp.where(force > 0.0, force, xp.zeros_like(force))  # without NaN
    touching = xp.any(pressed > cell, axis=-1, keepdims=True) | (xp.sum(pressed, axis=-1, keepdims=True) > sole)
    return above & touching


def loads(layout: SoleLayout, force: Any, threshold: float | None = None) -> ArrayLoads:
    """Wrench, contact area and CoP (T 4.21-4.23).

    Returns sums, of the same library, device, type. The derivative of a CoP without load is 0.
    """
    xp = _namespace(layout, force)
    on = active(layout, force, threshold)
    # What is not active must not come into a product: 0 times NaN is NaN, and so is its derivative.
    kept = xp.where(on, force, xp.zeros_like(force))
    # Copies, since torch warns of arrays that are read-only.
    columns = _constant(xp, np.array(layout.kernel.columns), force)
    areas = _constant(xp, np.array(layout.kernel.areas)[:, None], force)
    sums = kept @ columns
    ones = xp.where(on, xp.ones_like(force), xp.zeros_like(force))
    vertical = sums[..., 2:3]
    carries = (vertical > 0.0) & (vertical < float("inf"))
    whole = xp.where(carries, vertical, xp.ones_like(vertical))
    position = sums[..., 6:8] / whole
    nowhere = xp.full_like(position, float("nan"))
    return ArrayLoads(sums[..., :6], (ones @ areas)[..., 0], xp.where(carries, position, nowhere))


def _namespace(layout: SoleLayout, force: Any) -> Any:
    """Functions of an array's library."""
    kind = type(force)
    if hasattr(force, "__array_namespace__"):
        xp = force.__array_namespace__()
    elif kind.__module__.partition(".")[0] == "torch" and hasattr(force, "dtype"):
        xp = sys.modules["torch"]  # its functions are called as the standard's, as far as they are used here
    else:
        raise ReadingError(f"forces are of type {kind.__name__}; expected an array of a library with a namespace")
    if force.ndim < 1 or force.shape[-1] != len(layout):
        raise ReadingError(f"forces have shape {tuple(force.shape)}; expected (..., {len(layout)})")
    if "float" not in str(force.dtype):
        raise ReadingError(f"forces are of type {force.dtype}; expected real floating point numbers")
    return xp


def _constant(xp: Any, values: Any, like: Any) -> Any:
    """Sole's constant in the forces' library, type and device."""
    if not hasattr(like, "__array_namespace__"):
        return xp.as_tensor(values, dtype=like.dtype, device=like.device)
    # Where a library has several devices, what is not on the default one has to be stated; JAX moves it by itself.
    made = xp.asarray(values, dtype=like.dtype)
    there = getattr(like, "device", None)
    return made if xp.__name__.startswith("jax") or there == made.device else xp.asarray(made, device=there)
