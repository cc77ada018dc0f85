"""The page: HTML, style, script, three.js and walks in one file.

three.js is its npm package's (0.170.0, `build/three.module.min.js`, 692 kB, MIT licence).
"""

import base64
import html
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from importlib.resources import files as package_files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, items
from plantar.common.atomic import keep_inputs, replacing
from plantar.common.pages.page import with_policy
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import FootRecording
from plantar.sensing.activation import active_of
from plantar.viewer.messages import Entity, Shape
from plantar.viewer.walk import Walk, read_walk

_MOST = 2  # walks side by side
_NOT_MEASURED = 0xFFFF
_LOADED = 0.02  # of the weight: a sole with less has no CoP
_FARTHEST = 1e9  # m, or s: what damaged numbers of 32 bits are limited to
_EXPORT = re.compile(r"export\s*\{([^}]*)\};?\s*$")


def write_page(
    recordings: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], path: str | os.PathLike[str] = "view.html"
) -> dict[str, Any]:
    """Write a page of one of the `recordings` (MCAP files), or two side by side, at `path` (HTML).

    Returns file, size in bytes, each walk's name, duration in s and number of log lines, and warnings. An InputError
    for too many or an unwritable file, a FormatError for one that is unreadable or without soles.
    """
    recordings = [recordings] if isinstance(recordings, str | os.PathLike) else items(recordings, "recordings")
    if not 1 <= len(recordings) <= _MOST:
        raise InputError(f"{len(recordings)} recordings to show; allowed: 1, or {_MOST} side by side")
    keep_inputs(instance(path, str | os.PathLike, "path"), recordings)
    walks = [read_walk(recording) for recording in recordings]
    if len({walk.name for walk in walks}) < len(walks):  # the same scene twice: files show them apart
        files = [Path(recording) for recording in recordings]
        known = [file.stem if len({f.stem for f in files}) == len(files) else str(file) for file in files]
        walks = [replace(walk, name=f"{walk.name} ({name})") for walk, name in zip(walks, known, strict=True)]
    with replacing(path) as temporary, temporary.open("wb") as file:
        size = sum(file.write(piece.encode()) for piece in _pieces(walks))
    return {
        "file": str(Path(path)),
        "bytes": size,
        "walks": [
            {"name": walk.name, "duration_s": round(float(np.ptp(walk.time)), 3), "log_lines": len(walk.events)}
            for walk in walks
        ],
        "warnings": [line for walk in walks for line in walk.warnings],
    }


def view_text(written: Mapping[str, Any]) -> str:
    """Summary of a written page."""
    walks = "\n".join(f"  {walk['name']}: {walk['duration_s']:.1f} s" for walk in written["walks"])
    return f"{walks}\n  {written['file']} ({written['bytes'] / 1e6:.1f} MB)"


def _pieces(walks: Sequence[Walk]) -> Iterator[str]:
    title = " and ".join(walk.name for walk in walks)
    views = "\n".join(_view(number, walk, len(walks) == 1) for number, walk in enumerate(walks))
    script = _three() + asset("soles.js") + asset("view.js")
    text = framed(title, asset("view.css"), asset("view.html").replace("{{VIEWS}}", views), script, "{{DATA}}")
    before, _, after = text.rpartition("{{DATA}}")
    yield before
    for number, walk in enumerate(walks):
        yield "[" if number == 0 else ","
        for piece in json.JSONEncoder(separators=(",", ":"), allow_nan=False).iterencode(_walk(walk)):
            yield _within_html(piece)
    yield "]" + after


def framed(title: str, style: str, main: str, script: str, data: str) -> str:
    """A page of the viewer: plain `title`, CSS, HTML below the title, script, and the JSON `data` that it reads."""
    parts = {
        "TITLE": html.escape(title),
        "STYLE": style,
        "MAIN": main,
        "DATA": _within_html(data),
        "SCRIPT": script,
    }
    return with_policy(re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], asset("frame.html")))


def _within_html(data: str) -> str:
    """JSON text without what could end the element around it."""
    return data.replace("<", "\\u003c")


def asset(name: str) -> str:
    """Text of a file of the viewer."""
    return package_files("plantar.viewer").joinpath(name).read_text(encoding="utf-8")


def _three() -> str:
    code = asset("three.module.min.js")
    exported = _EXPORT.search(code)
    assert exported is not None, "three.module.min.js ends with its exports"
    members = ",".join(f"{name[-1]}:{name[0]}" for name in (e.split(" as ") for e in exported[1].split(",")))
    return f"{code[: exported.start()]}\nconst THREE={{{members}}};\n"


def _view(number: int, walk: Walk, alone: bool) -> str:
    name = html.escape(walk.name)
    warnings = "".join(f"<li>{html.escape(line)}</li>" for line in walk.warnings)
    lines = "".join(
        f'<li class="{event.level}"><button type="button" data-time="{at:.3f}">{at:.2f} s</button> '
        f"{html.escape(event.text)}</li>"
        for event in walk.events
        for at in [event.time - walk.time[0]]
    )
    near = '<th scope="col">nearest below</th>' if walk.near else ""
    log = f'<ol class="log">{lines}</ol>' if lines else "<p>No messages.</p>"
    return f"""<section class="walk" id="walk-{number}" aria-labelledby="name-{number}">
<h2 id="name-{number}"{' class="hidden"' if alone else ""}>{name}</h2>
{f'<ul class="warnings">{warnings}</ul>' if warnings else ""}
<canvas class="space" tabindex="0" role="img"
aria-label="{name} in 3D; drag to turn, arrow keys to step in time"></canvas>
<p class="readout"></p>
<div class="small">
<figure><canvas class="soles" role="img" aria-label="Force on each taxel of both soles"></canvas>
<figcaption>Soles from above. Cross: CoP. <span class="convex">Green</span>: convex polygon.
<span class="concave">Orange</span>: concave polygon</figcaption></figure>
<figure><canvas class="forces" role="img" aria-label="Force on each sole over time"></canvas>
<figcaption>Force on each sole: <span class="left">left</span>, <span class="right">right</span></figcaption></figure>
</div>
<table class="perceived"><caption class="hidden">What each sole perceives at this time</caption>
<thead><tr><th scope="col">sole</th><th scope="col">force</th><th scope="col">taxels loaded</th>
<th scope="col">CoP forward, left</th><th scope="col">moment about x, y</th><th scope="col">convex polygon</th>
<th scope="col">concave polygon</th>{near}</tr></thead><tbody></tbody></table>
<h3>Log</h3>
<div class="scroll" tabindex="0" role="region" aria-label="Log of {name}">{log}</div>
</section>"""


def _walk(walk: Walk) -> dict[str, Any]:
    frames = list(walk.poses)
    return {
        "time": _packed(walk.time - walk.time[0], "<f4"),
        "frames": frames,
        "poses": _packed(np.stack([walk.poses[name] for name in frames], axis=1), "<f4"),
        "entities": [_entity(entity) for entity in walk.shapes],
        "soles": {
            side: {
                "cells": [layout.vertices[list(corners), :2].round(5).tolist() for corners in layout.corners],
                "outline": layout.outline.round(5).tolist(),
                **_forces(layout, walk.force[side], _LOADED * walk.weight),
                **_near(walk.near.get(side)),
            }
            for side, layout in walk.layouts.items()
        },
        "zmp": _packed(walk.zmp, "<f4"),
        "polygon": _packed(walk.polygon, "<f4"),
        "footsteps": [
            {"time": time - float(walk.time[0]), "entities": [_entity(entity) for entity in shown]}
            for time, shown in walk.footsteps
        ],
        "weight": walk.weight,
    }


def _forces(layout: SoleLayout, force: NDArray[np.float32], least: float) -> dict[str, str]:
    """Forces in 0.1 N as 16-bit numbers, the largest if unmeasured; in N where one does not fit; sum, which taxels are
    loaded, a bit each, and CoP of those.
    """
    foot = FootRecording(layout.side, force.astype(float), layout)
    active = active_of(layout, force)
    pressed = FootRecording(layout.side, np.where(active, force, 0.0).astype(float), layout)
    cop = _packed(np.asarray(pressed.center_of_pressure(least)), "<f4")
    known = np.isfinite(force)
    rounded = np.round(force * 10.0)
    small = (~known | ((rounded >= 0.0) & (rounded < _NOT_MEASURED))).all()
    name, values, kind = ("decinewtons", rounded, "<u2") if small else ("force", force, "<f4")
    cells = _packed(np.where(known, values, _NOT_MEASURED if small else np.nan), kind)
    total = _packed(foot.vertical_force, "<f4")
    return {name: cells, "total": total, "active": _packed(np.packbits(active), "u1"), "cop": cop}


def _near(distance: NDArray[np.float32] | None) -> dict[str, str]:
    """Distance in mm of what is nearest to each sole; NaN where nothing is near, or sensed."""
    if distance is None:
        return {}
    nearest = np.where(np.isfinite(distance), distance, np.inf).min(axis=1)
    return {"near": _packed(np.where(np.isfinite(nearest), 1e3 * nearest, np.nan), "<f4")}


def _entity(entity: Entity) -> dict[str, Any]:
    shapes = [_shape(shape) for shape in entity.shapes if shape.kind != "text"]
    return {"name": entity.name, "frame": entity.frame, "shapes": shapes}


def _shape(shape: Shape) -> dict[str, Any]:
    out: dict[str, Any] = {
        "kind": shape.kind,
        "pose": [round(v, 6) for v in shape.pose],
        "colour": [round(v, 3) for v in shape.colour],
    }
    if shape.size:
        out["size"] = [round(v, 6) for v in shape.size]
    if shape.points:
        out["points"] = _packed(shape.points, "<f4")
    if shape.indices:
        out["indices"] = _packed(shape.indices, "<u4")
    return out


def _packed(values: ArrayLike, kind: str) -> str:
    found = np.asarray(values)
    if kind == "<f4":
        found = np.clip(found, -_FARTHEST, _FARTHEST)
    return base64.b64encode(np.ascontiguousarray(found, dtype=kind).tobytes()).decode()
