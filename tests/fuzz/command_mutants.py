"""Mutants of small files of all kinds through whole commands, a hundred in one process.

python -m tests.fuzz.command_mutants --count 20000 --seed 1

Whatever a file holds, a command ends by itself with 0, 1 or 2 (then with one line), within 10 s and a gigabyte.
"""

import argparse
import contextlib
import io
import json
import pickle
import resource
import subprocess
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from plantar.common.sides import SIDES
from plantar.formats.nominal_insole import moticon_insole

from ..gait.analysis.vendor_texts import Writing, moticon, pedar
from ..gait.analysis.walks import made_walk
from ..plantar.formats.test_excel_sheet import workbook
from ..plantar.formats.test_ros_bag import write_bag
from .made_plates import Laboratory, made_contact, write_c3d
from .mutants import mutant
from .taken_away import KINDS, made
from .targets import _MODEL, _OBJ, _SVG, TARGETS

_EACH = 100  # mutants of a process
_LONGEST = 10.0
_LARGEST = 1e6  # kB
_WORDS = (b"inf", b"-inf", b"1e308", b"-0", b"nan", b"1e-320", b"9" * 30, b"\xff\xfe", b"\r", b"")
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
    """

    name: str
    command: tuple[str, ...]
    content: bytes
    often: int = 4


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


def _dxf(path: Path) -> None:
    import ezdxf

    drawing = ezdxf.new()
    drawing.modelspace().add_lwpolyline([(0, 0), (250, 0), (250, 90), (0, 90)], close=True)
    drawing.saveas(path)


def _model_3mf(path: Path) -> None:
    corners = [(x, y, z) for z in (0, 30) for y in (0, 90) for x in (0, 250)]
    sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in corners)
    halves = [(a, b, c) for w, x, y, z in sides for a, b, c in ((w, x, y), (w, y, z))]
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in halves)
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    parts = f'<resources><object id="1" type="model">{mesh}</object></resources>'
    model = f'<model unit="millimeter" xmlns="{space}">{parts}'
    with zipfile.ZipFile(path, "w") as package:
        package.writestr("3D/3dmodel.model", model + '<build><item objectid="1"/></build></model>')


def _step(path: Path) -> None:
    import cadquery

    cadquery.exporters.export(cadquery.Workplane().box(250.0, 90.0, 30.0), str(path))


def kinds() -> list[Kind]:
    """Whole files of all kinds; those whose maker is not installed are left out."""
    out = [Kind(f"walk{i}.csv", _ANALYZE, made(i).text().encode(), 6) for i in range(len(KINDS))]
    walk = made_walk(strides=3, rate=50.0)
    soles = {side: moticon_insole(7, side) for side in SIDES}
    of_moticon = moticon(made_walk(strides=3, rate=50.0, layouts=soles), Writing(unit="n/cm2"))
    events = ("analyze", "{good}", "--events", "{file}", "-o", "{out}", "--no-figures")
    layout = ("analyze", "{good}", "--layout", "{file}", "-o", "{out}", "--no-figures")
    cells = [[0.01 * i, 700.5 * (i % 99 < 60), 650.0 * (i % 99 > 50)] for i in range(400)]
    corners = [[[0, 0], [0.25, 0], [0.25, 0.09], [0, 0]]]
    shape = '<collision><geometry><box size="0.2 0.1 0.03"/></geometry></collision>'
    out += [
        Kind("pedar.asc", _ANALYZE, pedar(walk, Writing())[:60_000]),
        Kind("moticon.txt", _ANALYZE, of_moticon[:60_000]),
        Kind("mapped.csv", (*_ANALYZE, "--columns", "left=2, time=1"), made(0).text().encode()),
        Kind("events.csv", events, b"side,heel_strike_s,toe_off_s\n" + b"left,1,1.6\nright,1.5,2.1\n" * 4),
        Kind("layout.json", layout, TARGETS["layout"].seeds(Path())[0], 2),
        Kind("walk.xls", _ANALYZE, workbook([["Time (s)", "Left Fz (N)", "Right Fz (N)"], *cells])),
        Kind("foot.svg", _SHOE, _SVG.encode(), 1),
        Kind("foot.obj", _SHOE, _OBJ.encode(), 2),
        Kind("foot.stl", _SHOE, TARGETS["stl"].seeds(Path())[0], 2),
        Kind("foot.geojson", _SHOE, json.dumps({"type": "Polygon", "coordinates": corners}).encode(), 1),
        Kind("foot.xml", _BODY, _MODEL.encode(), 2),
        Kind("foot.urdf", _BODY, f'<robot name="r"><link name="foot">{shape}</link></robot>'.encode(), 1),
        Kind("robot.xml", ("robot", "{file}", "-o", "{out}"), _MODEL.encode(), 1),
    ]
    with tempfile.TemporaryDirectory() as folder:
        out += [Kind(f"walk.{n}", _ANALYZE, TARGETS[n].seeds(Path(folder))[0], 3) for n in ("npz", "mcap")]
    for name, command, make, often in (
        ("walk.c3d", _ANALYZE, lambda: _of_file(_c3d, "a.c3d"), 6),
        ("walk.db3", _ANALYZE, _bag, 1),
        ("foot.dxf", _SHOE, lambda: _of_file(_dxf, "a.dxf"), 2),
        ("foot.3mf", _SHOE, lambda: _of_file(_model_3mf, "a.3mf"), 2),
        ("foot.step", _SHOE, lambda: _of_file(_step, "a.step"), 1),
    ):
        with contextlib.suppress(ImportError, ValueError):
            out.append(Kind(name, command, make(), often))
    return out


def damaged(content: bytes, random: np.random.Generator) -> bytes:
    """A mutant; a third have numbers replaced by extreme ones, too."""
    if random.random() < 0.33:
        cells = content.split(b",")
        for _ in range(int(random.integers(1, 5))):
            cells[int(random.integers(len(cells)))] = _WORDS[int(random.integers(len(_WORDS)))]
        content = b",".join(cells)
        if random.random() < 0.5:
            return content
    return mutant(content, random)


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


def what_fails(code: object, err: str, seconds: float) -> str:
    """What is wrong with how a command ended; empty if nothing is."""
    if code not in (0, 1, 2) or "Traceback" in err:
        return f"{code}: {err[-400:]}"
    if code == 2 and (err.count("\n") != 1 or not err.startswith("plantar: ")):
        return f"no line of its own: {err[:300]!r}"
    if seconds > _LONGEST:
        return f"takes {seconds:.0f} s"
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return f"{memory / 1e6:.2f} GB" if memory > _LARGEST else ""


def run_some(seed: int, count: int, known: list[Kind]) -> None:
    """Run mutants of a seed; prints a line of JSON for each kind of ending, and keeps what fails."""
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
            places = {"file": path, "out": folder / "out", "good": folder / "good.csv"}
            code, err, seconds = ended([a.format(**places) for a in kind.command])
            why = what_fails(code, err, seconds)
            endings["failed" if why else str(code)] += 1
            if why:
                kept = Path(tempfile.gettempdir()) / f"plantar-mutant-{seed}-{sum(endings.values())}-{kind.name}"
                kept.write_bytes(content)
                print(json.dumps({"kept": str(kept), "why": why}), flush=True)
    print(json.dumps(endings))


def main() -> None:
    """Fuzz commands from the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=_EACH)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kinds", type=Path, help="whole files, made by the process that starts others")
    given = parser.parse_args()
    known = pickle.loads(given.kinds.read_bytes()) if given.kinds else kinds()
    if given.count <= _EACH:
        run_some(given.seed, given.count, [Kind(*own) for own in known])
        return
    endings: Counter[str] = Counter()
    with tempfile.NamedTemporaryFile() as held:
        held.write(pickle.dumps([tuple(kind) for kind in known]))
        held.flush()
        for k in range(given.count // _EACH):
            start = [sys.executable, "-m", "tests.fuzz.command_mutants", "--kinds", held.name]
            command = [*start, "--seed", str(1000 * given.seed + k)]
            done = subprocess.run(command, capture_output=True, text=True)
            *failures, last = done.stdout.splitlines() or [""]
            print("".join(line + "\n" for line in failures), end="", flush=True)
            if done.returncode or not last:
                print(f"process {k} ended with {done.returncode}: {done.stderr[-500:]}", flush=True)
                endings["processes that ended"] += 1
            else:
                endings.update(json.loads(last))
                if k % 5 == 4:
                    print(json.dumps(endings), flush=True)
    print(json.dumps(endings))
    sys.exit(endings.keys() - {"0", "1", "2"} != set())


if __name__ == "__main__":
    main()
