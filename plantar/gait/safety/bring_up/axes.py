"""Names how a sensor's axes lie, by the matrix from what was expected to what was measured."""

import itertools
import math

import numpy as np
from numpy.typing import NDArray

_AXES = ("x", "y", "z")


def signed_permutation(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """Signed permutation (3, 3) nearest to a matrix (3, 3) but for its scale."""
    best = -math.inf
    found = np.eye(3)
    for order in itertools.permutations(range(3)):
        size = sum(abs(float(matrix[i, order[i]])) for i in range(3))
        if size > best + 1e-9:
            best = size
            found = np.zeros((3, 3))
            for i in range(3):
                found[i, order[i]] = math.copysign(1.0, matrix[i, order[i]])
    return found


def scale_of(matrix: NDArray[np.float64], axes: NDArray[np.float64]) -> float:
    """Median factor by which a matrix (3, 3) is larger than the signed permutation of its `axes` (3, 3)."""
    return float(np.median((matrix * axes).sum(axis=1)))


def described(axes: NDArray[np.float64], name: str) -> str:
    """How a sensor's signed permutation (3, 3) came about, such as "gyro's axes x and y exchanged"."""
    if np.allclose(axes, -np.eye(3)):
        return f"{name}'s signs turned"
    if np.linalg.det(axes) > 0.0:
        return f"{name} turned by {_turn(axes)}"
    moved = [i for i in range(3) if axes[i, i] == 0.0]
    turned = [i for i in range(3) if axes[i].sum() < 0.0]
    if not moved:
        return f"{name}'s sign of {' and '.join(_AXES[i] for i in turned)} turned"
    if len(moved) == 2 and not turned:
        return f"{name}'s axes {_AXES[moved[0]]} and {_AXES[moved[1]]} exchanged"
    return f"{name}'s axes and signs exchanged"


def _turn(axes: NDArray[np.float64]) -> str:
    """Angle and axis of a signed permutation (3, 3) that is a rotation."""
    angle = round(math.degrees(math.acos(min(1.0, max(-1.0, 0.5 * (float(np.trace(axes)) - 1.0))))))
    if angle == 180:
        fixed = [i for i in range(3) if axes[i, i] > 0.0]
        return f"180 degrees about {_AXES[fixed[0]]}" if fixed else "180 degrees"
    vector = np.array([axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]])
    along = [i for i in range(3) if abs(float(vector[i])) > 0.5]
    return f"{angle} degrees about {_AXES[along[0]]}" if len(along) == 1 else f"{angle} degrees"
