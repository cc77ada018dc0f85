"""The files of a shoe opened as a maker would, by other programs' readers, and held against each other."""

import csv
import json
import re
import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
import shapely
import trimesh
from numpy.typing import NDArray

from ..shoe_witness import hits

SIDES = ("left", "right")

Triangles = NDArray[np.float64]


def bodies_of(path: Path) -> dict[str, tuple[str, Triangles]]:
    """Material and triangles (n, 3, 3) in mm of each named body of a 3MF package."""
    with zipfile.ZipFile(path) as package:
        root = ElementTree.fromstring(package.read("3D/3dmodel.model"))
    space = re.match(r"\{.*\}", root.tag)[0]
    assert root.get("unit") == "millimeter"
    materials = [base.get("name", "") for base in root.iter(f"{space}base")]
    out = {}
    for thing in root.iter(f"{space}object"):
        corners = np.array([[float(v.get(k, "nan")) for k in "xyz"] for v in thing.iter(f"{space}vertex")])
        faces = np.array([[int(t.get(k, "-1")) for k in ("v1", "v2", "v3")] for t in thing.iter(f"{space}triangle")])
        if len(faces):
            out[thing.get("name", "")] = (materials[int(thing.get("pindex", "-1"))], corners[faces])
    return out


def volume(triangles: Triangles) -> float:
    a, b, c = np.moveaxis(triangles, 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def inside(triangles: Triangles, points: Triangles) -> int:
    """How many points lie in a closed surface: rays upwards leave it an odd number of times."""
    way = np.array([1.3e-4, 2.1e-4, 1.0])
    return sum(len(hits(triangles, p, way)) % 2 for p in points)


@pytest.mark.parametrize("side", SIDES)
def test_the_parts_of_the_assembly_fit_and_nothing_intersects(exported, side):
    report, folder = exported
    bodies = bodies_of(folder / f"assembly_{side}.3mf")
    layout = json.loads((folder / f"layout_{side}.json").read_text())
    taxels = {name: b for name, b in bodies.items() if name.startswith("taxel ")}
    assert set(bodies) == {f"shoe {side}", "pad", *(f"taxel {t['id']}" for t in layout["taxels"])}
    assert {m for m, _ in taxels.values()} == {"skin"}
    assert bodies[f"shoe {side}"][0] == "PA12"
    print_, pad = bodies[f"shoe {side}"][1], bodies["pad"][1]
    for path, body in ((f"shoe_{side}.stl", print_), (f"pad_{side}.stl", pad)):
        assert volume(body) == pytest.approx(trimesh.load(folder / path, force="mesh").volume, rel=1e-4)
    p, plan = report.build.parameters, report.build.shoes[SIDES.index(side)].plan
    cells, pockets = (sum(shape.area for shape in shapes) for shapes in (plan.cells, plan.pockets))
    filled = cells * p.taxel_protrusion + pockets * p.pocket_depth
    assert sum(volume(body) for _, body in taxels.values()) == pytest.approx(filled, rel=1e-4)
    chance, deeper = np.random.default_rng(5), 0
    for t in layout["taxels"]:
        surface = taxels[f"taxel {t['id']}"][1]
        centre = 1e3 * np.array(t["position"])[:2]
        low, high = surface[..., 2].min(), surface[..., 2].max()
        np.testing.assert_allclose(surface[..., :2].reshape(-1, 2).mean(axis=0), centre, atol=4.0)
        some = surface.reshape(-1, 3)[chance.choice(3 * len(surface), 6)]
        some = some + 0.02 * (np.array([*centre, 0.5 * (low + high)]) - some)  # just within the taxel
        assert inside(print_, some) == inside(pad, some) == 0
        deeper += inside(print_, some + np.array([0.0, 0.0, 0.5]))
    assert deeper > len(taxels) / 2  # what is pushed in by half a millimetre is seen
    points = pad.reshape(-1, 3)[chance.choice(3 * len(pad), 60)]
    assert inside(print_, points + np.array([0.0, 0.0, 0.05])) == 0


@pytest.mark.parametrize("side", SIDES)
def test_the_mould_holds_the_pad_and_lets_it_out(exported, side):
    """Mould and pad fill the block between them; no face of the cavity looks down: the pad comes out upwards."""
    _, folder = exported
    mould, pad = (trimesh.load(folder / f"{name}_{side}.stl", force="mesh") for name in ("mould", "pad"))
    assert mould.is_watertight
    assert mould.body_count == 1
    flat = mould.triangles[..., 2].max(axis=1) < 1e-6
    block = float(mould.area_faces[flat].sum()) * float(mould.bounds[1, 2])
    assert block - mould.volume == pytest.approx(pad.volume, rel=1e-4)
    assert mould.face_normals[~flat, 2].min() > -1e-6


@pytest.mark.parametrize("side", SIDES)
def test_the_boards_outlines_are_closed_in_mm_and_free_of_the_ways(exported, side):
    report, folder = exported
    drawing: Any = ezdxf.readfile(folder / f"cells_{side}.dxf")
    assert drawing.header["$INSUNITS"] == 4
    shapes: dict[str, list[Any]] = {}
    for line in drawing.modelspace():
        assert line.is_closed
        shape = shapely.Polygon([v.dxf.location.vec2 for v in line.vertices])
        assert shape.is_valid
        shapes.setdefault(line.dxf.layer, []).append(shape)
    assert set(shapes) == {"CELLS", "POCKETS", "OUTLINE", "KEEPOUT", "BASES", "WINDOWS"}
    layout = report.build.shoes[SIDES.index(side)].layout
    assert len(shapes["CELLS"]) == len(shapes["POCKETS"]) == len(layout)
    assert sum(cell.area for cell in shapes["CELLS"]) == pytest.approx(1e6 * layout.areas.sum(), rel=1e-4)
    (face,) = shapes["OUTLINE"]
    face = face.buffer(1e-3)
    assert all(face.covers(cell) for cell in shapes["CELLS"])
    assert all(any(cell.covers(pocket) for cell in shapes["CELLS"]) for pocket in shapes["POCKETS"])
    keep = shapely.union_all(shapes["KEEPOUT"])
    with (folder / "wiring.csv").open() as file:
        ports = [(float(r["port_x_mm"]), float(r["port_y_mm"])) for r in csv.DictReader(file)
                 if r["side"] == side and r["from_cell"]]  # fmt: skip
    assert all(keep.distance(shapely.Point(port)) < 0.01 for port in ports)


@pytest.mark.long
@pytest.mark.parametrize("side", SIDES)
def test_the_step_file_is_the_stl_in_mm(exported, side):
    import cadquery

    _, folder = exported
    shape = cadquery.importers.importStep(str(folder / f"shoe_{side}.step")).val()
    mesh = trimesh.load(folder / f"shoe_{side}.stl", force="mesh")
    assert shape.isValid()
    assert len(shape.Solids()) == 1
    assert shape.Volume() == pytest.approx(mesh.volume, rel=5e-3)
    box = shape.BoundingBox()
    np.testing.assert_allclose([[box.xmin, box.ymin, box.zmin], [box.xmax, box.ymax, box.zmax]], mesh.bounds, atol=0.01)
    assert "SI_UNIT(.MILLI.,.METRE.)" in (folder / f"shoe_{side}.step").read_text()
