"""Files that a command must refuse: for each format and each defect one, as small as shows it.

A defect is a count that the file does not hold, what unpacks or grows to any size, what is nested or refers to itself
without end, numbers that are none, text without an end, or what is no file at all.
"""

import io
import json
import os
import struct
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from .event_report import write_report

Content = bytes | str | Callable[[Path], object]
"""A file's content, or a function that makes the file."""

SHOE = ("shoe", "{file}", "--layout-only", "-o", "{out}")
BODY = ("shoe", "{file}", "--body", "foot", "--layout-only", "-o", "{out}")
ANALYZE = ("analyze", "{file}", "-o", "{out}")
COMMANDS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("stl", "obj", "ply", "off", "3mf", "step", "dxf", "svg", "geojson"), SHOE),
    **dict.fromkeys(("xml", "urdf"), BODY),
    **dict.fromkeys(("npz", "npy", "mcap", "bag", "db3", "c3d", "csv", "asf", "asc", "lst", "txt"), ANALYZE),
    **dict.fromkeys(("png", "jpg", "tif", "bmp"), (*ANALYZE, "--mm-per-pixel", "0.5")),
    "view.mcap": ("view", "{file}", "-o", "{out}"),
    **dict.fromkeys(("events.csv", "events.xlsx"), ("analyze", "{good}", "--events", "{file}", "-o", "{out}")),
    "participants.csv": ("analyze", "{folder}", "--participants", "{file}", "-o", "{out}"),
    "robot.xml": ("robot", "{file}", "-o", "{out}"),
    "layout.json": ("analyze", "{good}", "--layout", "{file}", "-o", "{out}"),
    "parameters.json": ("shoe", "--dimensions", "240x100", "--parameters", "{file}", "-o", "{out}"),
    "parameters.toml": ("shoe", "--dimensions", "240x100", "--parameters", "{file}", "-o", "{out}"),
    "scene.toml": ("sim", "{file}", "--plot", "{out}"),
    "robot.toml": ("sim", "flat", "--robot", "{file}", "--plot", "{out}"),
}
"""What reads a file of each kind."""


def _hole(path: Path) -> None:
    with path.open("wb") as stream:
        stream.truncate(8_000_000_000)  # a hole, which takes no room on the disk


def _device(path: Path) -> None:
    path.symlink_to("/dev/zero")


DEFECTS_OF_ANY: dict[str, Content] = {
    "empty": b"",
    "zeros": bytes(100_000),
    "random": np.random.default_rng(0).bytes(100_000),
    "8 GB": _hole,
    "pipe": os.mkfifo,
    "device": _device,
    "folder": Path.mkdir,
    "itself": lambda path: path.symlink_to(path),
    "brackets": b"[" * 200_000,
    "a line without an end": b"1 " * 4_000_000,
}
"""What may stand behind a name of any kind."""


def repeated(text: str, count: int, head: str = "", tail: str = "") -> Callable[[Path], None]:
    """Makes a file of a text over and over."""

    def make(path: Path) -> None:
        with path.open("w") as stream:
            stream.write(head)
            for _ in range(count // 10_000):
                stream.write(text * 10_000)
            stream.write(text * (count % 10_000) + tail)

    return make


def later(make: Callable[..., bytes | str], *arguments: Any) -> Callable[[Path], None]:
    """Makes a file of what a function gives, when it is asked for."""

    def write(path: Path) -> None:
        content = make(*arguments)
        path.write_bytes(content.encode() if isinstance(content, str) else content)

    return write


# --- meshes ---------------------------------------------------------------------------------------------------------

TETRAHEDRON = np.array([[0, 0, 0], [200, 0, 0], [0, 80, 0], [0, 0, 60]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
NUMBERS = ("nan", "inf", "1e300", "-1e39", "1e400", "0x10", "1" * 100_000)


def _stl(triangles: np.ndarray, stated: int | None = None) -> bytes:
    records = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    with np.errstate(over="ignore"):
        records["v"] = triangles
    return bytes(80) + struct.pack("<I", len(triangles) if stated is None else stated) + records.tobytes()


def _stl_hole(path: Path) -> None:
    with path.open("wb") as stream:
        stream.write(bytes(80) + struct.pack("<I", 1_000_000))
        stream.truncate(84 + 50_000_000)


FACET = "facet normal 0 0 1\nouter loop\nvertex {} 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\n"


def _meshes() -> Iterator[tuple[str, str, Content]]:
    good = TETRAHEDRON[FACES]
    yield "stl", "4 billion triangles", _stl(good, 2**32 - 1)
    yield "stl", "no triangles", _stl(good[:0])
    yield "stl", "a million triangles of zeros", _stl_hole
    for value in (np.nan, np.inf, 1e300, 1e38):
        wrong = good.copy()
        wrong[1, 2, 0] = value
        yield "stl", f"coordinate {value}", _stl(wrong)
    yield "stl", "one point", _stl(np.zeros((1000, 3, 3)))
    yield (
        "stl",
        "a crowd",
        later(lambda: _stl(np.random.default_rng(1).uniform(-1, 1, (200_000, 3, 3)) * [100, 50, 30])),
    )
    yield "stl", "text, 30 MB", repeated(FACET.format(0), 260_000, "solid a\n", "endsolid a\n")
    yield "stl", "text, corners without facets", repeated("vertex 1 2 3\n", 2_000_000, "solid a\nfacet\n", "endsolid")
    yield "stl", "text, words of any length", "solid a\nfacet\n" + "vertex" * 500_000 + "\nendsolid"
    for value in NUMBERS:
        yield "stl", f"text, number {value[:8]}", f"solid a\n{FACET.format(value) * 4}endsolid a\n"
        obj = f"v {value} 0 0\nv 200 0 0\nv 0 80 0\nv 0 0 60\nf 1 2 3 4\nf 1 2 4\nf 2 3 4\n"
        yield "obj", f"number {value[:8]}", obj
        ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        ply += "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
        yield "ply", f"number {value[:8]}", ply + f"{value} 0 0\n200 0 0\n0 80 0\n0 0 60\n" + "3 0 1 2\n" * 4
        yield "off", f"number {value[:8]}", f"OFF\n4 4 0\n{value} 0 0\n9 0 0\n0 9 0\n0 0 9\n" + "3 0 1 2\n" * 4
    corners = "v 0 0 0\nv 200 0 0\nv 0 80 0\nv 0 0 60\n"
    yield "obj", "index 4 billion", corners + "f 1 2 4000000000\n" * 4
    yield "obj", "index 10^30", corners + f"f 1 2 {10**30}\n" * 4
    yield "obj", "index 0", corners + "f 0 1 2\n" * 4
    yield "obj", "index back before the first", corners + "f -9 1 2\n" * 4
    yield "obj", "a face of a million corners", corners + "f" + " 1 2 3" * 400_000 + "\n"
    yield "obj", "a line that goes on without an end", corners + "f 1 2 3 \\\n" * 200_000
    yield "obj", "vertices, 40 MB", repeated("v 1 2 3\n", 5_000_000)
    yield "obj", "faces, 20 MB", repeated("f 1 2 3\n", 2_500_000, corners)
    yield "obj", "materials elsewhere", "mtllib ../../../../etc/passwd\nusemtl a\n" * 50_000 + corners
    for form in ("ascii", "binary_little_endian", "binary_big_endian"):
        head = f"ply\nformat {form} 1.0\nelement vertex {{}}\nproperty float x\nproperty float y\nproperty float z\n"
        faces = "element face {}\nproperty list {} int vertex_indices\nend_header\n"
        yield (
            "ply",
            f"{form}, 4 billion vertices",
            (head.format(4 * 10**9) + faces.format(4, "uchar")).encode() + bytes(9),
        )
        yield (
            "ply",
            f"{form}, 4 billion faces",
            (head.format(4) + faces.format(4 * 10**9, "uchar")).encode() + bytes(99),
        )
        list_of_all = (head.format(1) + faces.format(1, "uint")).encode() + bytes(12) + b"\xff" * 4 + bytes(99)
        yield "ply", f"{form}, a list of 4 billion", list_of_all
        yield "ply", f"{form}, negative counts", (head.format(-1) + faces.format(-4, "uchar")).encode() + bytes(99)
    yield (
        "ply",
        "a header without an end",
        repeated("property float x\n", 2_000_000, "ply\nformat ascii 1.0\nelement a 1\n"),
    )
    yield "ply", "element within element", "ply\nformat ascii 1.0\n" + "element vertex 1\n" * 100_000 + "end_header\n"
    yield "off", "4 billion vertices", "OFF\n4000000000 4000000000 0\n0 0 0\n"
    yield "off", "a face of a billion corners", "OFF\n4 1 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n1000000000 0 1 2\n"
    yield "off", "index 4 billion", "OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n" + "3 0 1 4000000000\n" * 4
    yield "off", "faces, 40 MB", repeated("3 0 1 2\n", 5_000_000, "OFF\n4 5000000 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n")


# --- 3MF and STEP ---------------------------------------------------------------------------------------------------

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
VERTEX, TRIANGLE = '<vertex x="1" y="2" z="3"/>', '<triangle v1="0" v2="1" v3="2"/>'


def _3mf(*blocks: str | tuple[str, int], compression: int = zipfile.ZIP_DEFLATED) -> Callable[[Path], None]:
    """Makes a package of a model of texts, some of them many times over."""

    def make(path: Path) -> None:
        with zipfile.ZipFile(path, "w", compression) as package, package.open("3D/3dmodel.model", "w") as part:
            for block in blocks:
                text, count = (block, 1) if isinstance(block, str) else block
                whole = text.encode()
                for _ in range(count):
                    part.write(whole)

    return make


def _zip_of_parts(names: list[str]) -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as package:
        for name in names:
            package.writestr(name, "")
    return held.getvalue()


def _model(objects: str, items: str = '<item objectid="1"/>', head: str = "") -> str:
    return f'{head}<model xmlns="{CORE}"><resources>{objects}</resources><build>{items}</build></model>'


def _3mf_of_components(deep: int, wide: int) -> Callable[[Path], None]:
    mesh = f"<mesh><vertices>{VERTEX * 3}</vertices><triangles>{TRIANGLE * 4}</triangles></mesh>"
    objects = [f'<object id="0">{mesh}</object>']
    for i in range(1, deep):
        uses = f'<component objectid="{i - 1}"/>' * wide
        objects.append(f'<object id="{i}"><components>{uses}</components></object>')
    return _3mf(_model("".join(objects), f'<item objectid="{deep - 1}"/>'))


def _step(data: str) -> str:
    schema = "FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','','');FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));"
    return f"ISO-10303-21;\nHEADER;{schema}\nENDSEC;\nDATA;\n{data}\nENDSEC;\nEND-ISO-10303-21;\n"


def _packages() -> Iterator[tuple[str, str, Content]]:
    head, tail = f'<model xmlns="{CORE}"><resources><object id="1"><mesh><vertices>', "</vertices></mesh></object>"
    yield "3mf", "unpacks to 280 MB", _3mf(head, (VERTEX * 100_000, 104), tail)
    yield "3mf", "stored, 54 MB", _3mf(head, (VERTEX * 100_000, 20), tail, compression=zipfile.ZIP_STORED)
    yield "3mf", "spaces, 90 MB", _3mf(head, (" " * 1_000_000, 90), tail)
    yield "3mf", "components of components", _3mf_of_components(8, 30)
    yield "3mf", "components deep in each other", _3mf_of_components(2000, 1)
    itself = '<object id="1"><components><component objectid="1"/><component objectid="1"/></components></object>'
    yield "3mf", "a component of itself", _3mf(_model(itself))
    entities = "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10 if i else "aaaaaaaaaa"}">' for i in range(10))
    yield "3mf", "entities", _3mf(_model("&a9;", head=f"<!DOCTYPE m [{entities}]>"))
    yield "3mf", "elements deep in each other", _3mf(head, ("<a>" * 100_000, 20))
    yield "3mf", "an attribute without an end", _3mf(head, '<vertex x="', ("1" * 1_000_000, 90))
    for value in NUMBERS:
        vertices = f'<vertex x="{value}" y="0" z="0"/>' + VERTEX * 3
        mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{TRIANGLE * 4}</triangles></mesh>"
        yield "3mf", f"number {value[:8]}", _3mf(_model(f'<object id="1">{mesh}</object>'))
        moved = f'<item objectid="1" transform="{value} 0 0 0 1 0 0 0 1 0 0 0"/>'
        mesh = mesh.replace(vertices, VERTEX * 3 + '<vertex x="0" y="0" z="1e300"/>')
        yield "3mf", f"transform of {value[:8]}", _3mf(_model(f'<object id="1">{mesh}</object>', moved))
    yield "3mf", "5000 parts", later(_zip_of_parts, [f"{i}.model" for i in range(5000)])
    yield "3mf", "no model", later(_zip_of_parts, ["3D/3dmodel.noodle"])
    yield "step", "the first line only", "ISO-10303-21;\n"
    yield "step", "no shapes", _step("")
    yield "step", "brackets", later(lambda: _step("#1=A(" + "(" * 1_000_000))
    yield "step", "a text without an end", later(lambda: _step("#1=A('" + "a" * 20_000_000))
    yield (
        "step",
        "points, 20 MB",
        later(lambda: _step("".join(f"#{i}=CARTESIAN_POINT('',(1.,2.,3.));\n" for i in range(1, 400_000)))),
    )
    yield "step", "one shape that is not there", _step("#1=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#2),#3);")
    ring = "".join(f"#{i}=SHELL_BASED_SURFACE_MODEL('',(#{i % 999 + 1}));\n" for i in range(1, 1000))
    yield "step", "references in a ring", _step(ring)
    yield "step", "random behind the header", b"ISO-10303-21;\nHEADER;" + np.random.default_rng(2).bytes(300_000)


# --- drawings -------------------------------------------------------------------------------------------------------


def _dxf(entities: str, blocks: str = "") -> str:
    named = f"0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n" if blocks else ""
    return f"{named}0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"


def _drawings() -> Iterator[tuple[str, str, Content]]:
    line = "0\nLINE\n8\n0\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n"
    insert = "0\nINSERT\n2\nB{}\n10\n0\n20\n0\n70\n9999\n71\n9999\n44\n1\n45\n1\n"
    blocks = "".join(f"0\nBLOCK\n2\nB{i}\n10\n0\n20\n0\n{insert.format(i - 1) * 10}0\nENDBLK\n" for i in range(1, 20))
    yield "dxf", "blocks of blocks", _dxf(insert.format(19), blocks)
    itself = f"0\nBLOCK\n2\nB1\n10\n0\n20\n0\n{insert.format(1)}0\nENDBLK\n"
    yield "dxf", "a block of itself", _dxf(insert.format(1), itself)
    yield (
        "dxf",
        "fifty thousand lines",
        later(lambda: _dxf("".join(line.format(i, i * 7 % 99, i + 1, 3) for i in range(100_000)))),
    )
    yield (
        "dxf",
        "a polyline of 4 billion points",
        _dxf("0\nLWPOLYLINE\n100\nAcDbPolyline\n90\n4000000000\n70\n1\n10\n0\n20\n0\n10\n9\n20\n0\n"),
    )
    tangle = np.random.default_rng(4).uniform(0.0, 200.0, (19_000, 2)).round(2).tolist()
    points = "".join(f"10\n{x}\n20\n{y}\n" for x, y in tangle)
    yield (
        "dxf",
        "a line through itself everywhere",
        _dxf(f"0\nLWPOLYLINE\n100\nAcDbPolyline\n90\n19000\n70\n1\n{points}"),
    )
    knots = "40\n0\n" * 400_000
    yield "dxf", "a spline of knots alone", _dxf(f"0\nSPLINE\n70\n8\n71\n3\n72\n400000\n73\n0\n{knots}")
    yield (
        "dxf",
        "a spline of degree 30000",
        _dxf("0\nSPLINE\n70\n8\n71\n30000\n72\n99\n73\n9\n" + "40\n0.5\n" * 99 + "10\n1\n20\n2\n30\n0\n" * 9),
    )
    for value in ("nan", "inf", "1e300", "-1e300", "1e400", "x", "9" * 100_000):
        yield "dxf", f"number {value[:8]}", _dxf(line.format(value, 0, 9, 9) + line.format(9, 9, 0, 9))
        yield "dxf", f"radius {value[:8]}", _dxf(f"0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n{value}\n")
        ring = f"[[[0,0],[{value},0],[200,80],[0,80]]]"
        yield "geojson", f"number {value[:8]}", f'{{"type":"Polygon","coordinates":{ring}}}'.replace("nan", "NaN")
        yield "svg", f"number {value[:8]}", f'<svg><path d="M 0 0 L {value} 0 L 200 80 L 0 80 Z"/></svg>'
        yield "svg", f"scale {value[:8]}", f'<svg><g transform="scale({value})"><rect width="9" height="9"/></g></svg>'
        yield (
            "svg",
            f"width {value[:8]}",
            f'<svg width="{value}mm" viewBox="0 0 1 1"><rect width="9" height="9"/></svg>',
        )
        yield "svg", f"arc {value[:8]}", f'<svg><path d="M 0 0 A {value} {value} 0 1 1 9 9 Z"/></svg>'
    entities = "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10 if i else "aaaaaaaaaa"}">' for i in range(10))
    yield "svg", "entities", f"<!DOCTYPE svg [{entities}]><svg>&a9;</svg>"
    yield "svg", "entities of a file", '<!DOCTYPE s [<!ENTITY x SYSTEM "file:///etc/passwd">]><svg>&x;</svg>'
    yield "svg", "groups in groups", "<svg>" + "<g>" * 100_000
    yield "svg", "half a million shapes", repeated('<rect width="9"/>', 500_000, "<svg>", "</svg>")
    yield "svg", "a path of a million lines", '<svg><path d="M 0 0' + " L 9 9" * 1_000_000 + '"/></svg>'
    yield "svg", "a path of arcs", '<svg><path d="M 0 0' + " A 9 9 0 1 1 9 9" * 100_000 + '"/></svg>'
    yield "svg", "a transform without an end", f'<svg><g transform="{"a" * 2_000_000}"><rect width="9"/></g></svg>'
    crossed = " L ".join(f"{x} {y}" for x, y in tangle)
    yield "svg", "a line through itself everywhere", f'<svg><path d="M {crossed} Z"/></svg>'
    yield "geojson", "collections in collections", '{"type":"GeometryCollection","geometries":[' * 50_000
    pairs = "[1,2],[3,4]," * 500_000
    yield "geojson", "a million points", f'{{"type":"Polygon","coordinates":[[{pairs}[5,6]]]}}'
    yield "geojson", "a line through itself everywhere", f'{{"type":"Polygon","coordinates":[{json.dumps(tangle)}]}}'
    weave = [[i % 977, i * 7 % 991] for i in range(19_000)]
    yield "geojson", "a line along itself everywhere", json.dumps({"type": "Polygon", "coordinates": [weave]})
    star = [[100.0 * np.cos(a), 40.0 * np.sin(a)] if i % 2 else [0, 0] for i, a in enumerate(np.arange(0, 6.28, 3e-4))]
    yield "geojson", "lines that meet in a point", json.dumps({"type": "LineString", "coordinates": star})
    for kind, held in (("null", None), ("text", "a"), ("numbers", [1, 2]), ("mixed", [[[0, 0], [1, "a"], [2]]])):
        yield "geojson", f"coordinates {kind}", json.dumps({"type": "Polygon", "coordinates": held})


# --- models of robots -----------------------------------------------------------------------------------------------


def _mjcf(geoms: str, head: str = "", body: str = "") -> str:
    return f'<mujoco>{head}<worldbody><body name="foot" {body}>{geoms}</body></worldbody></mujoco>'


def _with_mesh(text: str, count: int, name: str = "m.stl") -> Callable[[Path], None]:
    def make(path: Path) -> None:
        mesh = np.random.default_rng(3).uniform(-0.1, 0.1, (50_000, 3, 3))
        (path.parent / name).write_bytes(_stl(mesh))
        path.write_text(text.replace("%", '<geom type="mesh" mesh="m"/>' * count))

    return make


def _models() -> Iterator[tuple[str, str, Content]]:
    asset = '<asset><mesh name="m" file="{}"/></asset>'
    yield "xml", "one mesh 200 times", _with_mesh(_mjcf("%", asset.format("m.stl")), 200)
    yield "xml", "one mesh 10000 times", _with_mesh(_mjcf("%", asset.format("m.stl")), 10_000)
    yield "xml", "a mesh elsewhere", _mjcf('<geom type="mesh" mesh="m"/>', asset.format("../../../../etc/passwd"))
    yield (
        "xml",
        "a mesh that is a pipe",
        lambda path: (
            os.mkfifo(path.parent / "m.stl"),
            path.write_text(_mjcf('<geom type="mesh" mesh="m"/>', asset.format("m.stl"))),
        ),
    )
    yield "xml", "a hundred thousand spheres", _mjcf('<geom type="sphere" size="1"/>' * 100_000)
    yield "xml", "bodies in bodies", _mjcf("<body>" * 100_000)
    yield "xml", "includes itself", lambda path: path.write_text(_mjcf(f'<include file="{path.name}"/>'))
    yield "xml", "defaults in defaults", "<mujoco>" + '<default class="a">' * 100_000
    entities = "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10 if i else "aaaaaaaaaa"}">' for i in range(10))
    yield "xml", "entities", f"<!DOCTYPE m [{entities}]>" + _mjcf("&a9;")
    for value in ("nan", "inf", "1e300", "1e400", "x", "", "9" * 100_000):
        for name, geom in (
            ("size", f'<geom type="box" size="{value} 1 1"/>'),
            ("radius", f'<geom type="capsule" size="{value} 1"/>'),
            ("place", f'<geom type="sphere" size="1" pos="{value} 0 0"/>'),
            ("turn", f'<geom type="sphere" size="1" quat="{value} 0 0 0"/>'),
            ("ends", f'<geom type="capsule" size="1" fromto="{value} 0 0 1 1 1"/>'),
        ):
            yield "xml", f"{name} {value[:8]}", _mjcf(geom)
    yield "xml", "axes of another alphabet", _mjcf('<geom euler="1 2 3"/>', '<compiler eulerseq="abc"/>')
    yield "xml", "five axes", _mjcf('<geom euler="1 2 3"/>', '<compiler eulerseq="xyzxy"/>')
    link = '<robot name="a"><link name="foot"><visual><geometry>{}</geometry></visual></link>{}</robot>'
    yield "urdf", "a mesh elsewhere", link.format('<mesh filename="../../../../../etc/passwd"/>', "")
    yield "urdf", "a mesh without an ending", link.format('<mesh filename="package://"/>', "")
    joint = '<joint type="fixed"><parent link="foot"/><child link="foot"/></joint>'
    yield "urdf", "fixed to itself", link.format('<box size="1 1 1"/>', joint)
    chain = "".join(
        f'<link name="l{i}"/><joint type="fixed"><parent link="{"foot" if not i else f"l{i - 1}"}"/>'
        f'<child link="l{i}"/></joint>'
        for i in range(30_000)
    )
    yield "urdf", "a chain of thirty thousand", link.format('<box size="nan 1 1"/>', chain)
    for value in ("nan", "1e300", "x", "9" * 100_000):
        yield "urdf", f"box {value[:8]}", link.format(f'<box size="{value} 1 1"/>', "")
        yield "urdf", f"scale {value[:8]}", link.format(f'<mesh filename="m.stl" scale="{value} 1 1"/>', "")


# --- recordings and settings ----------------------------------------------------------------------------------------


def _npz(blocks: int, shape: tuple[int, ...]) -> bytes:
    held = io.BytesIO()
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": shape})
    with (
        zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("force.npy", "w", force_zip64=True) as part,
    ):
        part.write(head.getvalue())
        for _ in range(blocks):
            part.write(bytes(1_000_000))
    return held.getvalue()


def _recordings() -> Iterator[tuple[str, str, Content]]:
    yield "npz", "400 MB of zeros", later(_npz, 400, (500_000, 100))
    yield "npz", "a shape that is not there", later(_npz, 1, (10**9, 10**9))
    for shape in ((10**12, 100), (-5, 5), (2**63, 1), (10**9, 10**9)):
        head = io.BytesIO()
        np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": shape})
        yield "npy", f"shape {shape}", head.getvalue() + bytes(80)
    yield (
        "npy",
        "a header that computes",
        b"\x93NUMPY\x01\0\xf0\0" + b"{'descr': '<f8', 'shape': (9**9**9**9,)}".ljust(240),
    )
    pickled = io.BytesIO()
    np.save(pickled, np.array([[{}, {}], [{}, {}]], dtype=object), allow_pickle=True)
    yield "npy", "Python objects", pickled.getvalue()
    yield "csv", "a hundred thousand columns", ",".join(f"left {i}" for i in range(100_000)) + "\n" + "1\n" * 500_000
    yield "csv", "no line ends", repeated("1,", 10_000_000, "time,left 1,left 2,left 3\n")
    yield "csv", "numbers of any length", "time,left 1,left 2,left 3\n" + ("1" * 100_000 + ",2,3,4\n") * 20
    tekscan = "DATA_TYPE MOVIE\nROWS {}\nCOLS {}\nROW_SPACING 5 mm\nCOL_SPACING 5 mm\nSECONDS_PER_FRAME {}\nUNITS KPa\n"
    tekscan += "FILENAME left.fsx\nASCII_DATA @@\n\n"
    frames = "".join(f"Frame {i}\n" + "1,2,3\n" * 3 for i in range(1, 9))
    for seconds in ("1e-300", "0", "-1", "nan", "1e300"):
        yield "asf", f"{seconds} seconds a frame", tekscan.format(3, 3, seconds) + frames
    yield "asf", "a matrix of 10^18", tekscan.format(10**9, 10**9, 0.01) + frames
    yield "asf", "a frame without an end", repeated("0,0,0\n", 9_000_000, tekscan.format(3, 3, 0.01) + "Frame 1\n")
    yield "c3d", "4 billion points", b"\x02\x50" + b"\xff" * 600 + bytes(5000)
    mcap = b"\x89MCAP0\r\n"
    yield (
        "asc",
        "a header alone",
        "file type:\tx\nsensor type:\tX99L\nscanning rate[Hz]:\t1e300\n\n" + "1.0\t" * 500_000,
    )
    yield "lst", "a matrix of any size", "Page 1\nFile: 1.dat \tMatrix: 999999999x999999999\n" + "1.0\t" * 500_000
    yield "txt", "a header without an end", "# start: x\n# time" + "\tleft pressure 1[N/cm2]" * 100_000 + "\n"
    yield "mcap", "a record of 2^62 bytes", mcap + b"\x06" + struct.pack("<Q", 2**62) + bytes(999)
    yield "bag", "a header of 2 GB", b"#ROSBAG V2.0\n" + struct.pack("<I", 2**31 - 1) + bytes(999)
    yield "db3", "SQLite, cut short", b"SQLite format 3\0" + bytes(999)
    yield (
        "png",
        "30000 x 30000",
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + struct.pack(">II", 30_000, 30_000) + b"\x08\2\0\0\0" + bytes(99),
    )
    frame = b"\0\x11\x08\xff\xdc\xff\xdc\x03\x01\x11\0\x02\x11\0\x03\x11\0"
    yield "jpg", "4 GB of pixels", b"\xff\xd8\xff\xc2" + frame + b"\xff\xd9"
    yield "bmp", "10^9 x 10^9", b"BM" + bytes(12) + struct.pack("<IiiHH", 40, 10**9, -(10**9), 1, 24) + bytes(100)
    yield "tif", "directories in a ring", b"II*\0\x08\0\0\0\0\0\x08\0\0\0"


def _beside_recordings() -> Iterator[tuple[str, str, Content]]:
    """What is read beside a recording: events, participants; and what is shown, or made a robot of."""
    head = "side,heel_strike_s,toe_off_s\n"
    yield "events.csv", "UTF-16 without rows", head.encode("utf-16")
    yield "events.csv", "a quote without an end", head + 'left,"1,2\n' * 200_000
    yield "events.csv", "a side that is none", head + "up,1,2\n"
    yield "events.csv", "zero bytes", head + "left,1\0,2\n"
    yield "events.csv", "a million columns", "side" + ",heel_strike_s" * 1_000_000 + "\nleft\n"
    yield "events.xlsx", "3000 sheets", partial(write_report, sheets=["Left Steps"] * 3000, rows=0)
    yield "events.xlsx", "200,000 rows", partial(write_report, sheets=["Left Steps"], rows=200_000)
    yield (
        "events.xlsx",
        "a part that unpacks to 900 MB",
        partial(write_report, sheets=["Left Steps"], rows=1, padding=900),
    )
    yield "participants.csv", "a file elsewhere twice", "file,participant,condition\n/dev/zero,a,b\n/dev/zero,a,b\n"
    yield "participants.csv", "a quote without an end", 'file,participant,condition\n"a,b,c\n'
    for name, inside in (
        ("a hundred million replicas", '<replicate count="100000000"><geom size="1"/></replicate>'),
        ("replicas of replicas", '<replicate count="3000">' * 3 + '<geom size="1"/>' + "</replicate>" * 3),
    ):
        yield "robot.xml", name, _mjcf(inside)
        yield "xml", name, _mjcf(inside)
    field = _mjcf("", '<hfield name="h" nrow="60000" ncol="60000" size="1 1 1 1"/>')
    yield "robot.xml", "a height field of 3.6 billion points", field
    yield "xml", "a height field of 3.6 billion points", field
    yield (
        "robot.xml",
        "a texture of 10 billion pixels",
        _mjcf("", '<texture type="2d" width="100000" height="100000"/>'),
    )
    yield "robot.xml", "memory of a terabyte", _mjcf("", '</asset><size memory="1T"/><asset>')
    yield "view.mcap", "a record of 2^62 bytes", b"\x89MCAP0\r\n\x06" + struct.pack("<Q", 2**62) + bytes(999)


def _settings() -> Iterator[tuple[str, str, Content]]:
    for kind in ("parameters.toml", "scene.toml", "robot.toml"):
        yield kind, "nested without an end", "a = " + "[" * 100_000
        yield kind, "keys of keys", ".".join("a" * 100_000) + " = 1"
        yield kind, "tables of tables", "".join(f"[{'.'.join('a' * i)}]\n" for i in range(1, 400))
        yield kind, "an integer of a million digits", "a = " + "9" * 100_000
        yield kind, "only a comment", "# nothing\n"
        yield kind, "unknown words", '[walk]\nsteps = "many"\nnosuch = nan\n'
    yield "robot.toml", "a model elsewhere", 'model = "../../../../etc/passwd"\n[feet]\n'
    yield "scene.toml", "steps without an end", '[scene]\nname = "a"\n[walk]\nsteps = 1e300\n'
    for kind in ("parameters.json", "layout.json"):
        yield kind, "nested without an end", '{"a":' * 100_000
        yield kind, "an integer of a million digits", '{"a": ' + "9" * 100_000 + "}"
        yield kind, "NaN for everything", '{"schema": NaN, "name": NaN, "cells": NaN}'
        yield kind, "a list", "[1, 2, 3]"
        yield kind, "a number", "7"


FAMILIES: dict[str, tuple[str, Content]] = {
    f"{kind}: {defect}": (kind, content)
    for family in (_meshes, _packages, _drawings, _models, _recordings, _beside_recordings, _settings)
    for kind, defect, content in family()
}
"""Kind and content of the file with each defect."""
