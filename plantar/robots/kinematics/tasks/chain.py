"""Which velocities of a model move a body."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["chain"]


def chain(model: mujoco.MjModel, body: int) -> NDArray[np.intp]:
    """Velocities of a model that move a body.

    Returns:
        Their numbers (c,), from the body to the root; none for one that stands still.
    """
    while body and not model.body_dofnum[body]:  # fixed to its parent
        body = int(model.body_parentid[body])
    moving: list[int] = []
    velocity = int(model.body_dofadr[body] + model.body_dofnum[body]) - 1 if body else -1
    while velocity >= 0:
        moving.append(velocity)
        velocity = int(model.dof_parentid[velocity])
    return np.array(moving, dtype=np.intp)
