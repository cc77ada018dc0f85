"""Mutants of small files of all kinds through whole commands, a hundred in one process.

python -m tests.fuzz.command_mutants --count 20000 --seed 1

Whatever a file holds, a command ends by itself with 0, 1 or 2 (then with one line), within 10 s and a gigabyte.
"""

import argparse
import contextlib
import io
import json
import multiprocessing
import os
import re
import resource
import struct
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NamedTuple

import numpy as np

from plantar.common.sides import SIDES
from plantar.formats.nominal_insole import moticon_insole

from ..gait.analysis.vendor_texts import Writing, moticon, pedar
from ..gait.analysis.walks import made_walk
from ..plantar.formats import test_footscan as footscan
from ..plantar.formats import test_loadsol as loadsol
from ..plantar.formats import test_novel_emed as emed
from ..plantar.formats import test_tekscan as tekscan
from ..plantar.formats import test_xsensor as xsensor
from ..plantar.formats.test_excel_sheet import workbook
from ..plantar.formats.test_footprint_image import canvas, draw_foot, save
from ..plantar.formats.test_ros_bag import write_bag
from .made_plates import Laboratory, made_contact, write_c3d
from .mutants import mutant
from .taken_away import KINDS, made
from .targets import TARGETS

_EACH = 100  # mutants of a process
_LONGEST = 10.0
_LARGEST = 1e6  # kB
_WORDS = (b"inf", b"-inf", b"1e308", b"-0", b"nan", b"1e-320", b"9" * 30, b"\xff\xfe", b"\r", b"")
_VALUES = (np.inf, -np.inf, np.nan, -0.0, 3e38, 1e-40, -1e9, 2.0**31)
_NUMBER = re.compile(rb"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?")
_ANALYZE = ("analyze", "{file}", "-o", "{out}", "--no-figures")
_SHOE = ("shoe", "{file}", "--layout-only", "-o", "{out}")
_BODY = ("shoe", "{file}", "--body", "foot", "--layout-only", "-o", "{out}")


class Kind(NamedTuple):
    """A kind of file.

    Attributes:
        name: Of the file.
        command: With "{file}", "{out}" and "{good}", a table that is read.
        content: Of a whole file.
        often: How often it is drawn.
        seconds: Processor time in s that a whole file takes by what it is: a robot's trial walk is simulated.
    """

    name: str
    command: tuple[str, ...]
    content: bytes
    often: float = 4
    seconds: float = 0.0


def _of_file(make: Callable[[Path], object], name: str) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        make(path)
        return path.read_bytes()


def _c3d(path: Path) -> None:
    at = np.arange(0.0, 1.5, 1.0 / 200.0)
    random = np.random.default_rng(0)
    feet = (("left", 0.0), ("right", 0.5))
    contacts = [made_contact(random, at, f, 0.2 + 1.2 * x, 0.5, np.array([x, 0.1]), 700.0) for f, x in feet]
    write_c3d(path, Laboratory("type 2", 200.0, at, [[c] for c in contacts]), random, "markers")


def _bag() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        force = 30.0 * np.abs(np.sin(np.arange(40.0)[:, None] / 5.0 + np.arange(8.0)))
        write_bag(Path(folder) / "bag", {"/sole": force})
        return next((Path(folder) / "bag").glob("*.db3")).read_bytes()


_FOOT = np.array([(x, y, z) for z in (0, 30) for y in (0, 90) for x in (0, 250)])
_FACES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
_TRIANGLES = [(a, b, c) for w, x, y, z in _FACES for a, b, c in ((w, x, y), (w, y, z))]
_OBJ = "".join(f"v {x} {y} {z}\n" for x, y, z in _FOOT) + "".join(
    f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in _TRIANGLES
)
_SVG = (
    '<svg width="250mm" height="90mm" viewBox="0 0 250 90"><path d="M 45 0 L 205 0 C 230 0 250 20 250 45 '
    'C 250 70 230 90 205 90 L 45 90 A 45 45 0 0 1 45 0 Z"/></svg>'
)


def _stl() -> bytes:
    corners = _FOOT[np.array(_TRIANGLES)].astype("<f4")
    facets = b"".join(bytes(12) + facet.tobytes() + b"\0\0" for facet in corners)
    return bytes(80) + struct.pack("<I", len(corners)) + facets


def _biped(name: str = "r") -> str:
    """A pelvis on two legs of a hip, a knee and an ankle of two axes each, with boxes for feet."""
    legs = "".join(
        f'<body name="{s}_thigh" pos="0 {y} -0.1"><joint name="{s}_hip_yaw" axis="0 0 1"/><joint name="{s}_hip_roll" '
        f'axis="1 0 0"/><joint name="{s}_hip" axis="0 1 0"/><geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.4"/>'
        f'<body name="{s}_shin" pos="0 0 -0.4"><joint name="{s}_knee" axis="0 1 0" range="0 2"/><geom type="capsule" '
        f'size="0.04" fromto="0 0 0 0 0 -0.4"/><body name="{s}_foot" pos="0 0 -0.4"><joint name="{s}_ankle" '
        f'axis="0 1 0"/><joint name="{s}_ankle_roll" axis="1 0 0"/><geom type="box" pos="0.03 0 -0.05" '
        f'size="0.12 0.05 0.02"/></body></body></body>'
        for s, y in (("left", 0.1), ("right", -0.1))
    )
    return (
        f'<mujoco model="{name}"><compiler angle="radian"/><default><joint range="-1 1" actuatorfrcrange="-200 200"/>'
        f'</default><worldbody><body name="pelvis" pos="0 0 1"><freejoint/><geom size="0.15"/>{legs}</body></worldbody>'
        "</mujoco>"
    )


def _dxf(path: Path) -> None:
    import ezdxf

    drawing = ezdxf.new(units=4)
    drawing.modelspace().add_lwpolyline([(0, 0), (250, 0), (250, 90), (0, 90)], close=True)
    drawing.saveas(path)


def _model_3mf(path: Path) -> None:
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in _FOOT)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in _TRIANGLES)
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    parts = f'<resources><object id="1" type="model">{mesh}</object></resources>'
    model = f'<model unit="millimeter" xmlns="{space}">{parts}'
    with zipfile.ZipFile(path, "w") as package:
        package.writestr("3D/3dmodel.model", model + '<build><item objectid="1"/></build></model>')


def _step(path: Path) -> None:
    import cadquery

    cadquery.exporters.export(cadquery.Workplane().box(250.0, 90.0, 30.0), str(path))


def _footprint(path: Path) -> None:
    image = canvas()
    draw_foot(image, 160, "left", (60, 60, 160))
    save(path, image)


def _of_makers() -> list[Kind]:
    """Exports of platforms and insoles: a foot that rolls over a matrix, by each maker's format."""
    share = np.linspace(0.0, 1.0, 30)[:, None, None]
    row = np.arange(24.0)[:, None]
    foot = np.exp(-(((row - 2.0 - 20.0 * share) / 4.0) ** 2)) * np.ones(10)
    foot = np.round(150.0 * np.sin(np.pi * share) ** 0.5 * foot, 1)
    writers = (
        ("walk.asf", lambda path: tekscan.export(path, foot)),
        ("step.lst", lambda path: emed.export(path, foot)),
        ("feet.xsn.csv", lambda path: xsensor.export(path, [foot, foot[::-1]])),
        ("plate_left.txt", lambda path: footscan.export(path, foot)),
        ("loads.txt", loadsol.export),
    )
    return [Kind(name, _ANALYZE, _of_file(write, name), 3) for name, write in writers]


def kinds() -> list[Kind]:
    """Whole files of all kinds; those whose maker is not installed are left out."""
    out = [Kind(f"walk{i}.csv", _ANALYZE, made(i).text().encode(), 6) for i in range(len(KINDS))]
    walk = made_walk(strides=3, rate=50.0)
    soles = {side: moticon_insole(7, side) for side in SIDES}
    of_moticon = moticon(made_walk(strides=3, rate=50.0, layouts=soles), Writing(unit="n/cm2"))
    events = ("analyze", "{good}", "--events", "{file}", "-o", "{out}", "--no-figures")
    layout = ("analyze", "{good}", "--layout", "{file}", "-o", "{out}", "--no-figures")
    cells = [[0.01 * i, 700.5 * (i % 99 < 60), 650.0 * (i % 99 > 50)] for i in range(400)]
    corners = [[[0, 0], [0.25, 0], [0.25, 0.09], [0, 0.09], [0, 0]]]
    shape = '<collision><geometry><box size="0.2 0.1 0.03"/></geometry></collision>'
    out += [
        Kind("pedar.asc", _ANALYZE, pedar(walk, Writing())[:60_000]),
        Kind("moticon.txt", _ANALYZE, of_moticon[:60_000]),
        Kind("mapped.csv", (*_ANALYZE, "--columns", "left=2, time=1"), made(0).text().encode()),
        Kind("events.csv", events, b"side,heel_strike_s,toe_off_s\n" + b"left,1,1.6\nright,1.5,2.1\n" * 4),
        Kind("layout.json", layout, TARGETS["layout"].seeds(Path())[0], 2),
        Kind("walk.xls", _ANALYZE, workbook([["Time (s)", "Left Fz (N)", "Right Fz (N)"], *cells])),
        Kind("foot.svg", _SHOE, _SVG.encode(), 0.5),
        Kind("foot.obj", _SHOE, _OBJ.encode(), 1),
        Kind("foot.stl", _SHOE, _stl(), 1),
        Kind("foot.geojson", _SHOE, json.dumps({"type": "Polygon", "coordinates": corners}).encode(), 0.5),
        Kind("foot.xml", ("shoe", "{file}", "--body", "left_foot", *_SHOE[2:]), _biped().encode(), 1),
        Kind("foot.urdf", _BODY, f'<robot name="r"><link name="foot">{shape}</link></robot>'.encode(), 0.5),
        Kind("robot.xml", ("robot", "{file}", "-o", "{out}"), _biped().encode(), 0.1, 20.0),
    ]
    out += _of_makers()
    with tempfile.TemporaryDirectory() as folder:
        npz, mcap = (TARGETS[name].seeds(Path(folder))[0] for name in ("npz", "mcap"))
    out += [
        Kind("walk.npz", _ANALYZE, npz, 3),
        Kind("walk.mcap", _ANALYZE, mcap, 3),
        Kind("viewed.mcap", ("view", "{file}", "-o", "{out}/view.html"), mcap, 2),
        Kind("again.mcap", ("live", "replay:{file}", "--seconds", "0.05", "-o", "{out}/live.mcap"), mcap, 2),
        Kind("sole.npz", ("sole", "{file}", "-o", "{out}"), npz, 1),
    ]
    for name, command, make, often in (
        ("walk.c3d", _ANALYZE, lambda: _of_file(_c3d, "a.c3d"), 6),
        ("walk.db3", _ANALYZE, _bag, 1),
        ("print.png", _ANALYZE, lambda: _of_file(_footprint, "a.png"), 1),
        ("foot.dxf", _SHOE, lambda: _of_file(_dxf, "a.dxf"), 1),
        ("foot.3mf", _SHOE, lambda: _of_file(_model_3mf, "a.3mf"), 1),
        ("foot.step", _SHOE, lambda: _of_file(_step, "a.step"), 0.5),
    ):
        with contextlib.suppress(ImportError, ValueError):
            out.append(Kind(name, command, make(), often))
    return out


def damaged(content: bytes, random: np.random.Generator) -> bytes:
    """A mutant; a third have numbers replaced by extreme ones, too."""
    if random.random() < 0.33:
        for _ in range(int(random.integers(1, 5))):
            content = _with_an_extreme(content, random)
        if random.random() < 0.5:
            return content
    return mutant(content, random)


def _with_an_extreme(content: bytes, random: np.random.Generator) -> bytes:
    """A number after a random place is an extreme one: a text's as a word, a binary file's as four or eight bytes."""
    begin = int(random.integers(max(1, len(content))))
    if b"\0" in content[:4096]:
        code = str(random.choice(["<f", "<d"]))
        new = struct.pack(code, _VALUES[int(random.integers(len(_VALUES)))])
        begin -= begin % 4
        return content[:begin] + new + content[begin + len(new) :]
    found = _NUMBER.search(content, begin)
    if found is None:
        return content
    return content[: found.start()] + _WORDS[int(random.integers(len(_WORDS)))] + content[found.end() :]


def ended(arguments: list[str]) -> tuple[object, str, float]:
    """Exit code, what was written to stderr, and processor time in s of a command in this process."""
    from plantar import cli

    out = io.StringIO()
    err = io.StringIO()
    before = sys.argv
    sys.argv = ["plantar", *arguments]
    begun = time.process_time()
    code: object = 0
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            cli.main()
    except SystemExit as end:
        code = end.code
    except BaseException as error:
        code = f"{type(error).__name__}: {error}"
    sys.argv = before
    return code, err.getvalue(), time.process_time() - begun


def what_fails(code: object, err: str, seconds: float, by_nature: float = 0.0) -> str:
    """What is wrong with how a command ended; empty if nothing is."""
    if code not in (0, 1, 2) or "Traceback" in err:
        return f"{code}: {err[-400:]}"
    if code == 2 and (err.count("\n") != 1 or not err.startswith("plantar: ")):
        return f"no line of its own: {err[:300]!r}"
    if seconds > _LONGEST + by_nature:
        return f"takes {seconds:.0f} s"
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return f"{memory / 1e6:.2f} GB" if memory > _LARGEST else ""


def run_some(seed: int, count: int, known: list[Kind]) -> Counter[str]:
    """Endings of mutants of a seed; what fails is kept, and printed as a line of JSON."""
    random = np.random.default_rng(seed)
    weights = np.array([kind.often for kind in known], dtype=float)
    endings: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as made_folder:
        folder = Path(made_folder)
        (folder / "good.csv").write_text(made(0).text())
        for _ in range(count):
            kind = known[int(random.choice(len(known), p=weights / weights.sum()))]
            content = damaged(kind.content, random)
            path = folder / kind.name
            path.write_bytes(content)
            out = folder / kind.command[0]
            places = {"file": path, "out": out, "good": folder / "good.csv"}
            begun = time.time() - 0.1  # clocks of file systems are coarser
            code, err, seconds = ended([a.format(**places) for a in kind.command])
            why = what_fails(code, err, seconds, kind.seconds)
            if kind.command[0] == "analyze" and code == 0 and not why:
                others = [p.name for p in out.iterdir() if p.stat().st_mtime < begun]
                why = f"of an earlier recording: {others}" if others else ""
            endings["failed" if why else str(code)] += 1
            if why:
                kept = Path(tempfile.gettempdir()) / f"plantar-mutant-{seed}-{sum(endings.values())}-{kind.name}"
                kept.write_bytes(content)
                print(json.dumps({"kept": str(kept), "why": why}), flush=True)
    return endings


def import_all(known: list[Kind]) -> None:
    """Run what is quick on whole files, so that processes begin with its modules."""
    with tempfile.TemporaryDirectory() as made_folder:
        folder = Path(made_folder)
        for kind in known:
            if kind.seconds == 0.0 and "{good}" not in kind.command:
                path = folder / kind.name
                path.write_bytes(kind.content)
                ended([a.format(file=path, out=folder / "out") for a in kind.command])


def main() -> None:
    """Fuzz commands from the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=_EACH)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    os.environ.setdefault("MUJOCO_GL", "egl")
    known = kinds()
    import_all(known)
    endings: Counter[str] = Counter()
    forks = multiprocessing.get_context("fork")
    for k in range(-(-given.count // _EACH)):
        count = min(_EACH, given.count - k * _EACH)
        ours, theirs = forks.Pipe(duplex=False)
        with ours, theirs:
            process = forks.Process(target=_send_some, args=(theirs, 1000 * given.seed + k, count, known))
            process.start()
            theirs.close()
            with contextlib.suppress(EOFError):
                endings.update(ours.recv())
            process.join()
        if process.exitcode:
            print(f"process {k} ended with {process.exitcode}", flush=True)
            endings["processes that ended"] += 1
        if k % 5 == 4:
            print(json.dumps(endings), flush=True)
    print(json.dumps(endings))
    sys.exit(endings.keys() - {"0", "1", "2"} != set())


def _send_some(to: Connection, seed: int, count: int, known: list[Kind]) -> None:
    to.send(run_some(seed, count, known))


if __name__ == "__main__":
    main()
