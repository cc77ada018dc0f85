"""What is fuzzed: each reader with small files that it reads."""

import io
import json
import os
import struct
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from plantar.common.files.model_limits import check_model_size
from plantar.common.files.structured_text import parse_toml
from plantar.common.files.xml_file import parse_xml
from plantar.errors import PlantarError
from plantar.formats import read_recording
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.study.participants import read_participants
from plantar.layouts.layout_file import layout_to_dict, read_layout
from plantar.recordings.recording import read_mcap
from plantar.shoes.foot.mesh_file import read_mesh
from plantar.shoes.foot.outline_file import read_outline
from plantar.viewer.walk import read_walk

from ..event_report import write_report
from ..plantar.viewer.small_walk import soles, write_walk


class Target(NamedTuple):
    """A reader under test.

    Attributes:
        read: Reads a file; raises a PlantarError, or a ValueError where its caller expects one.
        seeds: Makes files that it reads, in a folder.
        suffix: Ending of the file's name.
    """

    read: Callable[[Path], object]
    seeds: Callable[[Path], list[bytes]]
    suffix: str


def _made(*contents: bytes | str) -> Callable[[Path], list[bytes]]:
    return lambda folder: [c.encode() if isinstance(c, str) else c for c in contents]


def _real(pattern: str) -> list[bytes]:
    """Real files of a kind, where this machine has some, cut to what is quick to read."""
    folder = os.environ.get("PLANTAR_REAL_DATA")
    return [p.read_bytes()[:60_000] for p in sorted(Path(folder, "recordings").glob(pattern))] if folder else []


@cache
def _walk(folder: Path) -> bytes:
    return write_walk(folder / "seed.mcap").read_bytes()


def _npz(folder: Path) -> bytes:
    out = io.BytesIO()
    force = np.abs(np.sin(np.arange(60.0)[:, None] / 5.0 + np.arange(8.0))) * 30.0
    layout = json.dumps(layout_to_dict(soles()["left"]))
    np.savez(out, time=0.01 * np.arange(60.0), left=force, layout_left=layout)
    return out.getvalue()


def _read_model(path: Path) -> object:
    root = parse_xml(path.read_bytes(), PlantarError, "m")
    check_model_size(root, PlantarError, "m")
    return root


def _stl() -> bytes:
    corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0], [0, 0, 1]]], dtype="<f4")
    facets = b"".join(struct.pack("<3f", 0, 0, 1) + facet.tobytes() + b"\0\0" for facet in corners)
    return bytes(80) + struct.pack("<I", len(corners)) + facets


_TABLE = "time,left 1,left 2,left 3\n" + "".join(f"{0.01 * i:.2f},{i % 7},{i % 5},3\n" for i in range(60))
_EVENTS = "side,heel_strike_s,toe_off_s\n" + "left,1,1.6\nright,1.5,2.1\n" * 4
_PEOPLE = "file,participant,condition,mass_kg\n" + "".join(f"{i}.csv,p{i},a,70\n" for i in range(5))
_MODEL = '<mujoco><asset><hfield name="h" nrow="9" ncol="9"/></asset><worldbody><replicate count="3"><body>'
_MODEL += '<geom size="1"/></body></replicate></worldbody></mujoco>'
_SVG = '<svg width="100mm" height="250mm" viewBox="0 0 100 250"><path d="M0 0 C 10 20 30 40 50 60 L 0 60 Z"/></svg>'
_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1/1/1 3/2/2 4/3/3\n"
_TOML = 'title = "a"\n[walk]\nsteps = 4\nlengths = [0.1, 0.2]\n[walk.turn]\n"a b" = 1e3\n'

TARGETS: Mapping[str, Target] = {
    "view": Target(read_walk, lambda f: [_walk(f)], ".mcap"),
    "mcap": Target(read_mcap, lambda f: [_walk(f)], ".mcap"),
    "events": Target(
        read_events,
        lambda f: [
            _EVENTS.encode(),
            _EVENTS.encode("utf-16"),
            write_report(f / "seed.xlsx", ["Left Steps"], 1).read_bytes(),
        ],
        "",
    ),
    "participants": Target(read_participants, _made(_PEOPLE, _PEOPLE.encode("utf-16")), ".csv"),
    "layout": Target(read_layout, lambda f: [json.dumps(layout_to_dict(soles()["left"])).encode()], ".json"),
    "table": Target(read_recording, lambda f: [_TABLE.encode(), _TABLE.encode("utf-16"), *_real("*.csv")], ".csv"),
    "pedar": Target(read_recording, lambda f: _real("*.asc"), ".asc"),
    "emed": Target(read_recording, lambda f: _real("*.lst"), ".lst"),
    "tekscan": Target(read_recording, lambda f: _real("*.asf"), ".asf"),
    "moticon": Target(read_recording, lambda f: _real("*.txt"), ".txt"),
    "npz": Target(read_recording, lambda f: [_npz(f)], ".npz"),
    "stl": Target(read_mesh, lambda f: [_stl()], ".stl"),
    "obj": Target(read_mesh, _made(_OBJ), ".obj"),
    "svg": Target(read_outline, _made(_SVG), ".svg"),
    "toml": Target(lambda p: parse_toml(p.read_bytes().decode(errors="replace")), _made(_TOML), ".toml"),
    "model": Target(_read_model, _made(_MODEL), ".xml"),
}
"""The readers by name; those whose seeds are real files have none where there are no such files."""
