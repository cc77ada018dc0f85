"""Ids of named parts of a MuJoCo model."""

import difflib
from typing import Any

import mujoco

from plantar.errors import RobotError


def named_id(model: Any, kind: str, name: str) -> int:
    """Returns the id of a `name` of `kind` "body", "geom" or "site" in a `model`; RobotError if missing."""
    what = getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
    found = int(mujoco.mj_name2id(model, what, name))
    if found < 0:
        count = {"body": model.nbody, "geom": model.ngeom, "site": model.nsite}[kind]
        names = [n for i in range(count) if (n := mujoco.mj_id2name(model, what, i))]
        close = difflib.get_close_matches(name, names, 3, 0.5)
        hint = f"did you mean {' or '.join(close)}?" if close else f"it has: {', '.join(names[:20]) or 'none'}"
        raise RobotError(f"the model has no {kind} named '{name}'; {hint}")
    return found
