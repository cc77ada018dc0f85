"""A robot without a simulator: random equations of motion, to try fusion on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray


@dataclass
class RandomRobot:
    """Only what fusion and the torque resolver ask for."""

    mass_matrix: NDArray[np.float64]
    bias: NDArray[np.float64]
    joints: NDArray[np.int64]
    velocity: NDArray[np.float64]
    joint_positions: NDArray[np.float64]
    time: float = 0.0


@pytest.fixture
def random_robot() -> Callable[..., RandomRobot]:
    """`random_robot(rng, size, base=0)`: `base` coordinates come first that no joint drives."""

    def make(rng: np.random.Generator, size: int, base: int = 0) -> RandomRobot:
        root = rng.normal(size=(size, size))
        joints = np.arange(base, size)
        return RandomRobot(
            root @ root.T + np.eye(size), rng.normal(size=size), joints, rng.normal(size=size), np.zeros(size - base)
        )

    return make
