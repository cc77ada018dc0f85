"""Corners and faces of a MuJoCo model's meshes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def mesh_surface(model: Any, mesh: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns corners (v, 3) in m, in geoms' frame, and corner numbers (f, 3) of faces of a `model`'s `mesh`, an id."""
    first = int(model.mesh_vertadr[mesh])
    face = int(model.mesh_faceadr[mesh])
    corners = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])]
    faces = model.mesh_face[face : face + int(model.mesh_facenum[mesh])]
    return corners.astype(np.float64), faces.astype(np.int64)
