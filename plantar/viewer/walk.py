"""Content of a page: moving frames, shapes, and sole forces, at common times.

Without frames and shapes (topics "/tf" and "/scene/..." of `plantar sim`) soles are shown alone: at places in
"/truth/left", or side by side.
"""

import os
from array import array
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.rotation import vector_from_rotation
from plantar.recordings.foxglove import LEVELS, message_of
from plantar.recordings.mcap_content import McapContent, Sink, message_values
from plantar.recordings.recording import take_mcap
from plantar.viewer.messages import Entity, deleted_all, entities, transforms
from plantar.viewer.sampling import FramePoses, Latest

_HELD = 0.1  # s for which the last forces are shown where no more come, or 2.5 usual steps
_RATE = 50.0  # pictures a second, as many as "/tf" has
_MOST = 30_000  # pictures of a walk: 10 min; a longer one is shown with fewer a second
_CORNERS = 12  # of a support polygon
_APART = 0.2  # m between soles whose poses are not recorded
_HEAVIEST = 1e5  # kg
# characters
_LONGEST_NAME = 200
_LONGEST_LINE = 2000
_SEARCHED = 200  # messages of "/tf" in which the frames' names are looked for
_MOST_FRAMES = 200
_MOST_EVENTS = 10_000
_MOST_SHAPES = 500_000  # shapes, points and triangles on a page
_ROOTS = ("world", "map", "")
_POSE = ("position", "rotation")
_VALUES = {"skin": ("force",), "proximity": ("distance",)}  # by the first word of a topic
_WIDTHS = {"position": 3, "rotation": 9, "com": 3}

Fields = list[tuple[str, int]] | None


@dataclass(frozen=True)
class Event:
    """Log line at a time in s; level "info", "warning" or "error"."""

    time: float
    text: str
    level: str = "info"


@dataclass(frozen=True)
class Walk:
    """Recording at n times.

    Attributes:
        time: (n,) in s.
        poses: Each frame's position and quaternion (x, y, z, w), (n, 7), world in m.
        layouts: Soles, by side; frames "sole_left" and "sole_right".
        force: (n, k) in N on each sole's taxels, float32.
        near: Distance (n, k) in m of what is before each taxel, likewise; NaN where it was not sensed, inf beyond the
            range. Soles without proximity are left out.
        zmp: True zero moment point (n, 3) in m, NaN if unknown.
        polygon: True support polygon (n, 12, 3) in m, likewise.
        footsteps: Times in s, and footsteps planned from then on.
        weight: In N, to scale forces.
        warnings: A line for each missing part.
    """

    name: str
    time: NDArray[np.float64]
    poses: Mapping[str, NDArray[np.float64]]
    shapes: tuple[Entity, ...]
    layouts: Mapping[Side, SoleLayout]
    force: Mapping[Side, NDArray[np.float32]]
    near: Mapping[Side, NDArray[np.float32]]
    zmp: NDArray[np.float64]
    polygon: NDArray[np.float64]
    footsteps: tuple[tuple[float, tuple[Entity, ...]], ...]
    events: tuple[Event, ...]
    weight: float
    warnings: tuple[str, ...] = field(default=())


def read_walk(path: str | os.PathLike[str]) -> Walk:
    """Read a recording in two passes, in pieces, in constant memory; FormatError if unreadable or without layouts."""
    drawn = _Drawn()
    content = McapContent(drawn.sinks())
    take_mcap(path, content)
    layouts = {side: content.layouts[side] for side in drawn.skin if side in content.layouts}
    if not layouts:
        raise FormatError(f"{path}: no taxel forces (/skin/left, /skin/right) with layouts of the soles to show")
    for side, layout in layouts.items():
        if drawn.skin[side].width != len(layout):
            raise FormatError(f"{path}: the {side} sole has {drawn.skin[side].width} taxels, its layout {len(layout)}")
    time = _times(drawn, layouts)
    shown = _Shown(drawn, layouts, time)
    take_mcap(path, McapContent(shown.sinks()))
    shown.finish()
    total = sum(np.nan_to_num(values).sum(axis=1, dtype=float) for values in shown.force.values())
    mass = content.metadata.get("mass_kg")
    known = isinstance(mass, (int, float)) and 0.0 < mass < _HEAVIEST
    return Walk(
        name=_name(path, content.metadata),
        time=time,
        poses=shown.frames(),
        shapes=tuple(drawn.world),
        layouts=layouts,
        force=shown.force,
        near={side: distance for side, distance in shown.near.items() if not np.isnan(distance).all()},
        zmp=shown.zmp,
        polygon=shown.polygon,
        footsteps=tuple(drawn.footsteps),
        events=tuple(drawn.events),
        weight=GRAVITY * float(mass) if known and mass is not None else float(np.percentile(total, 90)) or 1.0,
        warnings=(*content.warnings, *drawn.warnings(), *shown.warnings()),
    )


def _name(path: str | os.PathLike[str], metadata: Mapping[str, Any]) -> str:
    words = [str(metadata[key])[:_LONGEST_NAME] for key in ("scene", "robot") if key in metadata]
    seed = [f"seed {metadata['seed']}"[:_LONGEST_NAME]] if "seed" in metadata else []
    return ", ".join([*words, *seed]) or Path(path).stem


@dataclass
class _Skin:
    width: int
    first: float
    last: float
    count: int = 0


class _Drawn:
    def __init__(self) -> None:
        self.skin: dict[Side, _Skin] = {}
        self.frame_times = array("d")
        self.first_frames = b""
        self.frames: list[str] = []
        self.elsewhere: set[str] = set()
        self.world: list[Entity] = []
        self.footsteps: list[tuple[float, tuple[Entity, ...]]] = []
        self.events: list[Event] = []
        self._shapes = 0
        self._damaged = 0
        self._dropped = 0

    def sinks(self) -> dict[str, Sink]:
        return {
            "/tf": self._guarded(self._take_frames),
            "/scene/world": self._guarded(self._take_world),
            "/scene/footsteps": self._guarded(self._take_footsteps),
            "/log": self._guarded(self._take_event),
            **{f"/skin/{side}": partial(self._take_skin, side) for side in SIDES},
        }

    def warnings(self) -> list[str]:
        out = [f"{self._damaged} damaged message(s) of what is drawn were left out"] if self._damaged else []
        if self._dropped:
            out.append(f"{self._dropped} message(s) were left out: more is drawn, or logged, than a page can show")
        if self.elsewhere:
            out.append(f"{len(self.elsewhere)} frame(s) whose parent is not the world are not shown")
        return out

    def _guarded(self, take: Callable[[float, bytes], None]) -> Sink:
        def sink(time: float, message: bytes, fields: Fields) -> None:
            try:
                take(time, message)
            except ValueError:
                self._damaged += 1

        return sink

    def _take_skin(self, side: Side, time: float, message: bytes, fields: Fields) -> None:
        if (span := _span(fields, "force")) is not None:
            found = self.skin.setdefault(side, _Skin(span[1] - span[0], time, time))
            found.first = min(found.first, time)
            found.last = max(found.last, time)
            found.count = found.count + 1

    def _take_frames(self, time: float, message: bytes) -> None:
        self.frame_times.append(time)
        if len(self.frame_times) > _SEARCHED:
            return
        for name, parent, _ in transforms(message):
            if parent not in _ROOTS:
                self.elsewhere.add(name)
            elif name not in self.frames and len(self.frames) < _MOST_FRAMES:
                self.frames.append(name)
        self.first_frames = self.first_frames or message

    def _take_world(self, time: float, message: bytes) -> None:
        self.world += self._counted(entities(message))

    def _take_footsteps(self, time: float, message: bytes) -> None:
        before = () if deleted_all(message) or not self.footsteps else self.footsteps[-1][1]
        updated = {entity.name: entity for entity in (*before, *entities(message))}
        self.footsteps.append((time, tuple(self._counted(list(updated.values())))))

    def _take_event(self, time: float, message: bytes) -> None:
        if len(self.events) >= _MOST_EVENTS:
            self._dropped += 1
            return
        line = message_of("foxglove.Log", message)
        names = {number: name for name, number in LEVELS.items()}
        self.events.append(Event(time, line.message[:_LONGEST_LINE], names.get(line.level, "info")))

    def _counted(self, found: list[Entity]) -> list[Entity]:
        count = sum(1 + len(shape.points) + len(shape.indices) // 3 for e in found for shape in e.shapes)
        if self._shapes + count > _MOST_SHAPES:
            self._dropped += 1
            return []
        self._shapes += count
        return found


class _Shown:
    def __init__(self, drawn: _Drawn, layouts: Mapping[Side, SoleLayout], time: NDArray[np.float64]) -> None:
        n = len(time)
        self._damaged = 0
        self._drawn = drawn
        self._layouts = layouts
        self._time = time
        self.force = {side: np.full((n, len(layout)), np.nan, np.float32) for side, layout in layouts.items()}
        self.near = {side: np.full_like(force, np.nan) for side, force in self.force.items()}
        self.zmp = np.full((n, 3), np.nan)
        self.polygon = np.full((n, _CORNERS, 3), np.nan)
        self._poses = _sole_poses(n, layouts)
        self._latest = {}
        for side, skin in ((side, drawn.skin[side]) for side in layouts):
            reach = max(_HELD, 2.5 * (skin.last - skin.first) / skin.count)
            self._latest[f"/skin/{side}"] = Latest(time, self.force[side].__setitem__, reach)
            self._latest[f"/proximity/{side}"] = Latest(time, partial(self._keep_near, side), _HELD)
        self._latest["/scene/balance"] = Latest(time, self._keep_balance)
        self._framed: FramePoses | None = None
        if {f"sole_{side}" for side in SIDES} <= set(drawn.frames):
            self._framed = FramePoses(drawn.first_frames, drawn.frames, time)
            self._latest["/tf"] = self._framed.latest
        else:
            for topic, keep in ((f"/truth/{side}", partial(self._keep_sole, side)) for side in layouts):
                self._latest[topic] = Latest(time, keep)
            self._latest["/truth/body"] = Latest(time, self._keep_body)

    def sinks(self) -> dict[str, Sink]:
        out: dict[str, Sink] = {}
        for topic, latest in self._latest.items():
            wanted = ("com",) if topic == "/truth/body" else _VALUES.get(topic.split("/")[1], _POSE)
            out[topic] = partial(self._take_numbers, latest, wanted)
        out["/scene/balance"] = self._take_balance
        if self._framed is not None:
            out["/tf"] = self._take_frames
        return out

    def finish(self) -> None:
        for latest in self._latest.values():
            latest.finish()

    def frames(self) -> dict[str, NDArray[np.float64]]:
        if self._framed is not None:
            return {name: self._framed.poses[:, i] for i, name in enumerate(self._drawn.frames)}
        return self._poses

    def warnings(self) -> list[str]:
        late = sum(latest.late for latest in self._latest.values())
        out = [f"{late} message(s) that are not in the order of time were left out"] if late else []
        return out + ([f"{self._damaged} damaged message(s) of poses or ZMP were left out"] if self._damaged else [])

    def _take_numbers(self, latest: Latest, names: tuple[str, ...], time: float, data: bytes, fields: Fields) -> None:
        spans = [_span(fields, name) for name in names]
        if None not in spans:
            with suppress(ValueError):  # of another size: counted in the warnings of the file
                values = message_values(data, fields or [])
                latest.take(time, lambda: np.concatenate([values[slice(*span)] for span in spans if span is not None]))

    def _take_frames(self, time: float, message: bytes, fields: Fields) -> None:
        assert self._framed is not None
        try:
            self._framed.take(time, message)
        except ValueError:
            self._damaged += 1

    def _take_balance(self, time: float, message: bytes, fields: Fields) -> None:
        self._latest["/scene/balance"].take(time, lambda: message)

    def _keep_balance(self, rows: slice, message: bytes) -> None:
        try:
            found = entities(message)
        except ValueError:
            self._damaged += 1
            return
        for entity in found:
            for shape in entity.shapes:
                if shape.colour[3] <= 0.0:
                    continue
                if entity.name == "ZMP":
                    self.zmp[rows] = shape.pose[:3]
                elif entity.name == "support polygon" and len(shape.points) == _CORNERS:
                    self.polygon[rows] = shape.points

    def _keep_near(self, side: Side, rows: slice, values: NDArray[np.float64]) -> None:
        if len(values) == self.near[side].shape[1]:
            self.near[side][rows] = values

    def _keep_sole(self, side: Side, rows: slice, values: NDArray[np.float64]) -> None:
        pose = self._poses[f"sole_{side}"]
        pose[rows, :3] = values[:3]
        pose[rows, 3:] = _quaternion(values[3:].reshape(3, 3))

    def _keep_body(self, rows: slice, values: NDArray[np.float64]) -> None:
        pose = self._poses.setdefault("center_of_mass", np.zeros((len(self._time), 7)))
        pose[rows, :3] = values
        pose[rows, 6] = 1.0


def _span(fields: Fields, wanted: str) -> tuple[int, int] | None:
    start = 0
    for name, width in fields or ():
        if name == wanted:
            return (start, start + width) if width == _WIDTHS.get(name, width) else None
        start += width
    return None


def _times(drawn: _Drawn, layouts: Mapping[Side, SoleLayout]) -> NDArray[np.float64]:
    frames = np.unique(np.array(drawn.frame_times))
    if len(frames) > 1:
        return np.asarray(frames[:: -(-len(frames) // _MOST)])
    first = min(drawn.skin[s].first for s in layouts)
    last = max(drawn.skin[s].last for s in layouts)
    return np.linspace(first, last, int(np.clip((last - first) * _RATE, 1, _MOST - 1)) + 1)


def _sole_poses(count: int, layouts: Mapping[Side, SoleLayout]) -> dict[str, NDArray[np.float64]]:
    poses = {}
    for number, side in enumerate(SIDES):
        if side in layouts:
            pose = np.zeros((count, 7))
            poses[f"sole_{side}"] = pose
            pose[:, 1] = _APART * (0.5 - number)
            pose[:, 6] = 1.0
    return poses


def _quaternion(turn: NDArray[np.float64]) -> NDArray[np.float64]:
    vector = vector_from_rotation(turn)
    half = 0.5 * float(np.linalg.norm(vector))
    return np.array([*(0.5 * np.sinc(half / np.pi) * vector), np.cos(half)])
