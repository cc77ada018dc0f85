"""Poses and rotations as robot models write them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.arrays import is_finite
from plantar.errors import FootError
from plantar.mechanics.rotation import rotation_from_vector

__all__ = ["Pose", "mjcf_rotation"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pose:
    """A position and a rotation.

    Attributes:
        position: Position (3,) in m.
        rotation: Rotation (3, 3).
    """

    position: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(self.position + self.rotation @ other.position, self.rotation @ other.rotation)

    def moved(self, triangles: Array, scale: Array | None = None) -> Array:
        """Triangles in this pose.

        Args:
            triangles: Triangles (n, 3, 3) in the frame of the pose.
            scale: Scale (3,) along its axes before; one that mirrors keeps the outer side outside.

        Returns:
            The triangles (n, 3, 3) in the frame the pose is in.
        """
        if scale is not None:
            triangles = triangles * scale
            triangles = triangles[:, ::-1] if np.prod(scale) < 0.0 else triangles
        return np.asarray(triangles @ self.rotation.T + self.position)


def mjcf_rotation(attributes: Mapping[str, str], degrees: bool, sequence: str, where: str) -> Array:
    """Rotation (3, 3) from an MJCF element's quat, axisangle, euler, xyaxes or zaxis; none of them is no rotation.

    Args:
        attributes: The element's attributes.
        degrees: Whether angles are in degrees.
        sequence: Axes of euler angles, for example "xyz": small letters turn with the frame, capitals are fixed.
        where: What the element is, for messages.

    Returns:
        The rotation.

    Raises:
        FootError: If the numbers give none.
    """
    for name, count in (("quat", 4), ("axisangle", 4), ("euler", 3), ("xyaxes", 6), ("zaxis", 3)):
        if name not in attributes:
            continue
        try:
            values = np.array([float(v) for v in attributes[name].split()])
        except ValueError:
            values = np.array([])
        if len(values) != count or not is_finite(values):
            raise FootError(f"{where}: {name} is '{attributes[name][:40]}'; allowed: {count} finite numbers")
        try:
            return _rotation(name, values, degrees, sequence, where)
        except ZeroDivisionError:
            raise FootError(f"{where}: {name} is '{attributes[name][:40]}', which gives no direction") from None
    return np.eye(3)


def _unit(vector: Array) -> Array:
    length = float(np.linalg.norm(vector))
    if length < 1e-12:
        raise ZeroDivisionError
    return np.asarray(vector / length)


def _rotation(name: str, values: Array, degrees: bool, sequence: str, where: str) -> Array:
    unit = math.pi / 180.0 if degrees else 1.0
    if name == "quat":
        w, *v = _unit(values)
        sine = math.hypot(*v)
        return rotation_from_vector(2.0 * math.atan2(sine, w) * _unit(np.array(v))) if sine > 1e-12 else np.eye(3)
    if name == "axisangle":
        return rotation_from_vector(values[3] * unit * _unit(values[:3]))
    if name == "euler":
        if len(sequence) != 3 or sequence.lower().strip("xyz"):
            raise FootError(f"{where}: eulerseq is '{sequence[:40]}'; allowed: three of x, y, z, X, Y, Z")
        out = np.eye(3)
        for letter, angle in zip(sequence, values, strict=True):
            turn = rotation_from_vector(angle * unit * np.eye(3)["xyz".index(letter.lower())])
            out = turn @ out if letter.isupper() else out @ turn
        return out
    if name == "xyaxes":
        x = _unit(values[:3])
        y = _unit(values[3:] - (values[3:] @ x) * x)
        return np.column_stack([x, y, np.cross(x, y)])
    z = _unit(values)
    axis = np.cross([0.0, 0.0, 1.0], z)
    if np.linalg.norm(axis) < 1e-12:
        return np.eye(3) if z[2] > 0.0 else np.diag([1.0, -1.0, -1.0])
    return rotation_from_vector(math.acos(max(-1.0, min(1.0, float(z[2])))) * _unit(axis))
