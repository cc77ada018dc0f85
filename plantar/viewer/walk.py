"""What a page shows of a recording: frames that move, shapes in them, and what the soles feel, at common times.

A recording of `plantar sim` brings frames and shapes with it (topics "/tf" and "/scene/..."). Of an older one, or one
of another robot, the soles are shown by themselves: where "/truth/left" says they are, or side by side.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.gravity import GRAVITY
from plantar.layouts.layout import SoleLayout
from plantar.recordings.foxglove import LEVELS
from plantar.recordings.protobuf import read_fields
from plantar.recordings.recording import Recording, read_mcap
from plantar.sides import SIDES, Side
from plantar.viewer.messages import Entity, deleted_all, entities, transforms

__all__ = ["Event", "Walk", "read_walk"]

_RATE = 50.0  # pictures a second, as many as "/tf" has
_MOST = 30_000  # pictures of a walk: 10 min; a longer one is shown with fewer a second
_CORNERS = 12  # of a support polygon
_APART = 0.2  # m between soles of which nobody says where they are


@dataclass(frozen=True)
class Event:
    """A line of the log.

    Attributes:
        time: When, in s.
        text: What happened.
        level: "info", "warning" or "error".
    """

    time: float
    text: str
    level: str = "info"


@dataclass(frozen=True)
class Walk:
    """What is shown of a recording at n times.

    Attributes:
        name: What it is called.
        time: Times (n,) in s, from 0 on.
        poses: Position and quaternion (x, y, z, w) of each frame (n, 7) in the world in m.
        shapes: What is drawn in the frames.
        layouts: The soles, by side; their frames are "sole_left" and "sole_right".
        force: Force (n, k) in N on the taxels of each sole.
        zmp: True zero moment point (n, 3) in m, NaN where there is none or none is known.
        polygon: Corners (n, 12, 3) of the true support polygon in m, likewise.
        footsteps: Times in s, and the footsteps that are planned from then on.
        events: The log.
        weight: Weight in N of who walks, to scale forces by.
        warnings: What was missing, one line each.
    """

    name: str
    time: NDArray[np.float64]
    poses: Mapping[str, NDArray[np.float64]]
    shapes: tuple[Entity, ...]
    layouts: Mapping[Side, SoleLayout]
    force: Mapping[Side, NDArray[np.float64]]
    zmp: NDArray[np.float64]
    polygon: NDArray[np.float64]
    footsteps: tuple[tuple[float, tuple[Entity, ...]], ...]
    events: tuple[Event, ...]
    weight: float
    warnings: tuple[str, ...] = field(default=())


def read_walk(path: str | os.PathLike[str]) -> Walk:
    """Read what is shown of a recording.

    Args:
        path: MCAP file with taxel forces.

    Returns:
        The walk.

    Raises:
        FormatError: If it cannot be read, or holds no taxel forces with layouts.
    """
    run = read_mcap(path, drawn=True)
    felt = {s: run.topics[f"/skin/{s}"] for s in SIDES if len(run.topics.get(f"/skin/{s}", ()))}
    layouts = {side: run.layouts[side] for side in felt if side in run.layouts}
    if not layouts:
        raise FormatError(f"{path}: no taxel forces (/skin/left, /skin/right) with layouts of the soles to show")
    time = _times(run, *(felt[side].time for side in layouts))
    known = _recorded_poses(run, time) or _sole_poses(run, time, layouts)
    force = {}
    for side, layout in layouts.items():
        values = felt[side].fields.get("force", np.empty((0, 0)))
        if values.shape[1] != len(layout):
            raise FormatError(f"{path}: the {side} sole has {values.shape[1]} taxels, its layout {len(layout)}")
        force[side] = _latest(felt[side].time, values, time)
    zmp, polygon = _balance(run, time)
    total = sum(np.nan_to_num(values).sum(axis=1) for values in force.values())
    mass = run.metadata.get("mass_kg")
    weight = GRAVITY * mass if isinstance(mass, (int, float)) and mass > 0 else float(np.percentile(total, 90)) or 1.0
    return Walk(
        name=_name(run),
        time=time,
        poses=known,
        shapes=tuple(e for _, message in run.drawn.get("/scene/world", ()) for e in entities(message)),
        layouts=layouts,
        force=force,
        zmp=zmp,
        polygon=polygon,
        footsteps=_footsteps(run),
        events=tuple(_event(time_s, message) for time_s, message in run.drawn.get("/log", ())),
        weight=weight,
        warnings=run.warnings,
    )


def _name(run: Recording) -> str:
    said = [str(run.metadata[key]) for key in ("scene", "robot") if key in run.metadata]
    seed = [f"seed {run.metadata['seed']}"] if "seed" in run.metadata else []
    return ", ".join([*said, *seed]) or Path(run.path).stem


def _times(run: Recording, *others: NDArray[np.float64]) -> NDArray[np.float64]:
    """When the walk is shown: at the times of its frames, else evenly as long as it lasts."""
    frames = np.array([time for time, _ in run.drawn.get("/tf", ())])
    if len(frames) > 1:
        return frames[:: -(-len(frames) // _MOST)]
    first, last = min(t[0] for t in others), max(t[-1] for t in others)
    count = int(np.clip((last - first) * _RATE, 1, _MOST - 1))
    return np.linspace(first, last, count + 1)


def _latest(time: NDArray[np.float64], values: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    """The last value (n, ...) before or at each time that is wanted; the first one before that."""
    rows = np.searchsorted(time, wanted + 1e-9, side="right") - 1
    return np.asarray(values[np.maximum(rows, 0)])


def _recorded_poses(run: Recording, time: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Poses of the frames of "/tf"; nothing where that lacks a sole."""
    messages = run.drawn.get("/tf", ())
    if not messages:
        return {}
    names, poses = transforms([message for _, message in messages])
    if not {f"sole_{side}" for side in SIDES} <= set(names):
        return {}
    poses = _latest(np.array([t for t, _ in messages]), poses, time)
    return {name: poses[:, i] for i, name in enumerate(names)}


def _sole_poses(
    run: Recording, time: NDArray[np.float64], layouts: Mapping[Side, SoleLayout]
) -> dict[str, NDArray[np.float64]]:
    """Poses of the soles alone, as "/truth/<side>" has them; side by side where that is not recorded."""
    poses = {}
    for number, side in enumerate(SIDES):
        if side not in layouts:
            continue
        pose = np.zeros((len(time), 7))
        pose[:, 1], pose[:, 6] = _APART * (0.5 - number), 1.0
        truth = run.topics.get(f"/truth/{side}")
        if truth is not None and len(truth) and {"position", "rotation"} <= set(truth.fields):
            pose[:, :3] = _latest(truth.time, truth.fields["position"], time)
            turns = _latest(truth.time, truth.fields["rotation"], time).reshape(-1, 3, 3)
            pose[:, 3:] = _quaternions(turns)
        poses[f"sole_{side}"] = pose
    body = run.topics.get("/truth/body")
    if body is not None and len(body) and "com" in body.fields:
        com = np.zeros((len(time), 7))
        com[:, :3], com[:, 6] = _latest(body.time, body.fields["com"], time), 1.0
        poses["center_of_mass"] = com
    return poses


def _quaternions(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quaternions (n, 4), x, y, z, w, of rotations (n, 3, 3)."""
    # Of w, x, y and z the one that is largest is found first, and the others by it (Shepperd, 1978).
    xx, yy, zz = turns[:, 0, 0], turns[:, 1, 1], turns[:, 2, 2]
    skew = np.column_stack(
        [turns[:, 2, 1] - turns[:, 1, 2], turns[:, 0, 2] - turns[:, 2, 0], turns[:, 1, 0] - turns[:, 0, 1]]
    )
    xy, xz, yz = turns[:, 0, 1] + turns[:, 1, 0], turns[:, 0, 2] + turns[:, 2, 0], turns[:, 1, 2] + turns[:, 2, 1]
    rows = np.stack(
        [
            np.column_stack([1 + xx - yy - zz, xy, xz, skew[:, 0]]),
            np.column_stack([xy, 1 - xx + yy - zz, yz, skew[:, 1]]),
            np.column_stack([xz, yz, 1 - xx - yy + zz, skew[:, 2]]),
            np.column_stack([skew, 1 + xx + yy + zz]),
        ],
        axis=1,
    )
    best = rows[np.arange(len(rows)), np.argmax(np.einsum("nii->ni", rows), axis=1)]
    return np.asarray(best / np.linalg.norm(best, axis=1, keepdims=True))


def _balance(run: Recording, time: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """ZMP (n, 3) and support polygon (n, 12, 3) in m, NaN where they are not drawn."""
    messages = run.drawn.get("/scene/balance", ())
    zmp, polygon = np.full((len(messages), 3), np.nan), np.full((len(messages), _CORNERS, 3), np.nan)
    for i, (_, message) in enumerate(messages):
        for found in entities(message):
            for shape in found.shapes:
                if found.name == "ZMP" and shape.colour[3] > 0.0:
                    zmp[i] = shape.pose[:3]
                if found.name == "support polygon" and shape.colour[3] > 0.0 and len(shape.points) == _CORNERS:
                    polygon[i] = shape.points
    if not messages:
        return np.full((len(time), 3), np.nan), np.full((len(time), _CORNERS, 3), np.nan)
    times = np.array([t for t, _ in messages])
    return _latest(times, zmp, time), _latest(times, polygon, time)


def _footsteps(run: Recording) -> tuple[tuple[float, tuple[Entity, ...]], ...]:
    """The footsteps that are drawn from each time on."""
    shown: tuple[Entity, ...] = ()
    out = []
    for time, message in run.drawn.get("/scene/footsteps", ()):
        shown = (*(() if deleted_all(message) else shown), *entities(message))
        out.append((time, shown))
    return tuple(out)


def _event(time: float, message: bytes) -> Event:
    found: dict[int, Any] = dict(read_fields(message))
    names = {number: name for name, number in LEVELS.items()}
    text: Callable[[int], str] = lambda number: bytes(found.get(number, b"")).decode(errors="replace")  # noqa: E731
    return Event(time, text(3), names.get(found.get(2, 2), "info"))
