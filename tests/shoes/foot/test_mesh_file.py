"""Tests of mesh files: every format read gives the same triangles, and a bad file one clear line."""

import zipfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot import mesh_file
from plantar.shoes.foot.mesh_file import read_mesh

Shape = Callable[..., NDArray[np.float64]]

_MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="{unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
 <resources>
  <object id="1" type="model"><mesh>
   <vertices>{vertices}</vertices>
   <triangles>{triangles}</triangles>
  </mesh></object>
  <object id="2" type="model"><components>
   <component objectid="1" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>
  </components></object>
 </resources>
 <build>{items}</build>
</model>"""


def _write_3mf(path: Path, mesh: trimesh.Trimesh, unit: str, items: str) -> Path:
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in mesh.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces)
    with zipfile.ZipFile(path, "w") as package:
        package.writestr(
            "3D/3dmodel.model", _MODEL.format(unit=unit, vertices=vertices, triangles=triangles, items=items)
        )
    return path


def _mesh(box: Shape) -> trimesh.Trimesh:
    return trimesh.Trimesh(**trimesh.triangles.to_kwargs(box((-50, 150), (-40, 40), (0, 60))))


def _sorted(triangles: NDArray[np.float64]) -> NDArray[np.float64]:
    flat = triangles.reshape(len(triangles), 9)
    return np.asarray(flat[np.lexsort(flat.T)])


@pytest.mark.parametrize("ending", ["stl", "STL", "stl_ascii", "obj", "ply", "off"])
def test_every_format_gives_the_same_triangles(tmp_path, box, ending):
    mesh = _mesh(box)
    path = tmp_path / f"foot.{ending.split('_')[0]}"
    mesh.export(path, file_type=ending.lower())
    triangles, unit = read_mesh(path)
    assert unit is None
    np.testing.assert_allclose(_sorted(triangles), _sorted(mesh.triangles), atol=1e-4)


def test_an_obj_of_several_parts_is_put_together(tmp_path):
    path = tmp_path / "parts.obj"
    tetrahedron = "v 0 0 0\nv 90 0 0\nv 0 90 0\nv 0 0 90\n"
    path.write_text(f"o a\n{tetrahedron}f 1 3 2\nf 1 2 4\no b\n{tetrahedron}f 5 7 8\nf 6 8 7\nf 1/1/1 2/2/2 3/3/3\n")
    assert read_mesh(path)[0].shape == (5, 3, 3)


def test_3mf_items_are_placed_and_state_their_unit(tmp_path, box):
    mesh = _mesh(box)
    items = '<item objectid="1"/><item objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 5"/>'
    triangles, unit = read_mesh(_write_3mf(tmp_path / "foot.3mf", mesh, "centimeter", items))
    assert unit == "cm"
    n = len(mesh.faces)
    np.testing.assert_allclose(triangles[:n], mesh.triangles)
    x, y, z = np.moveaxis(mesh.triangles, -1, 0)
    np.testing.assert_allclose(triangles[n:], np.stack([-y, x + 10, z + 5], axis=-1))  # component, then item


@pytest.mark.parametrize(("unit", "factor"), [("micron", 1e-3), ("foot", 12.0)])
def test_3mf_units_without_a_name_here_are_scaled(tmp_path, box, unit, factor):
    mesh = _mesh(box)
    triangles, _ = read_mesh(_write_3mf(tmp_path / "foot.3mf", mesh, unit, '<item objectid="1"/>'))
    np.testing.assert_allclose(triangles, mesh.triangles * factor)


@pytest.mark.parametrize(
    "model",
    [
        "<model",
        "<model/>",
        _MODEL.format(unit="parsec", vertices="", triangles="", items=""),
        _MODEL.format(
            unit="meter", vertices="", triangles='<triangle v1="0" v2="1" v3="2"/>', items='<item objectid="1"/>'
        ),
        _MODEL.format(unit="meter", vertices="", triangles="", items='<item objectid="9"/>'),
    ],
)
def test_a_bad_3mf_gives_one_line(tmp_path, model):
    with zipfile.ZipFile(tmp_path / "foot.3mf", "w") as package:
        package.writestr("3D/3dmodel.model", model)
    with pytest.raises(FootError, match=r"foot\.3mf") as caught:
        read_mesh(tmp_path / "foot.3mf")
    assert "\n" not in str(caught.value)


@pytest.mark.sample(5)
@pytest.mark.parametrize("share", [0.02, 0.3, 0.5, 0.99])
@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "ply", "3mf"])
def test_a_truncated_file_gives_one_line(tmp_path, box, kind, share):
    mesh = _mesh(box)
    path = tmp_path / f"foot.{kind.split('_')[0]}"
    if kind == "3mf":
        _write_3mf(path, mesh, "millimeter", '<item objectid="1"/>')
    else:
        mesh.export(path, file_type=kind)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(FootError, match=r"cut short|no triangles|not an? .* that can be read") as caught:
        read_mesh(path)
    assert "\n" not in str(caught.value)


def test_what_is_wrong_is_named(tmp_path, box, stl):
    triangles = box((-50, 150), (-40, 40), (0, 60))
    broken = triangles.copy()
    broken[3, 1, 2] = np.nan
    broken[4, 0, 0] = np.inf
    with pytest.raises(FootError, match=r"2 of \d+ triangles hold a coordinate that is not finite"):
        read_mesh(stl(broken))
    with pytest.raises(FootError, match="has 2 triangles; a foot's body needs 4 or more"):
        read_mesh(stl(triangles[:2]))
    with pytest.raises(FootError, match=r"cannot be read \(No such file"):
        read_mesh(tmp_path / "none.stl")
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises(FootError, match=r"cannot be read \(Is a directory"):
        read_mesh(tmp_path / "folder.stl")
    with pytest.raises(FootError, match=r"'\.jpg' is no mesh format that is read; allowed: \.stl"):
        read_mesh(tmp_path / "foot.jpg")


def test_faces_of_an_obj_are_those_that_trimesh_finds(tmp_path):
    random = np.random.default_rng(0)
    lines = [f"v {x} {y} {z} 0.5 0.5 0.5" for x, y, z in random.uniform(-100, 100, (30, 3)).round(3).tolist()]
    for _ in range(40):
        ring = random.choice(30, int(random.integers(3, 7)), replace=False) + 1
        form = random.choice(["{0}", "{0}/{0}", "{0}//{0}", "{0}/{0}/{0}"])
        lines.append("f " + " ".join(form.format(i) for i in ring))
    path = tmp_path / "foot.obj"
    plain = "\n".join(line.replace("/", " ").split("#")[0] for line in lines)
    path.write_text("\n".join(lines))
    got = read_mesh(path)[0]
    rings = [[int(item.split("/")[0]) - 1 for item in line.split()[1:]] for line in lines if line[0] == "f"]
    corners = np.array([[float(v) for v in line.split()[1:4]] for line in plain.splitlines() if line[0] == "v"])
    fans = [(ring[0], b, c) for ring in rings for b, c in pairwise(ring[1:])]
    np.testing.assert_array_equal(got, corners[np.array(fans)])
    only = [line for line in lines if line[0] == "v" or len(line.split()) == 4]
    path.write_text("\n".join(only))
    theirs = trimesh.load(path, process=False, force="mesh")
    np.testing.assert_allclose(_sorted(read_mesh(path)[0]), _sorted(theirs.triangles))


def test_an_obj_may_count_back_and_go_on_in_the_next_line(tmp_path):
    corners = "v 0 0 0\nv 90 0 0\nv 0 90 0\nv 0 0 90\n"
    (tmp_path / "a.obj").write_text(f"{corners}f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3 # the last\n")
    (tmp_path / "b.obj").write_text(f"{corners}f -4 -2 \\\n-3\r\nf -4 -3 -1\nf -3 -2 \\\r\n -1\nf -4 -1 -2")
    np.testing.assert_array_equal(read_mesh(tmp_path / "a.obj")[0], read_mesh(tmp_path / "b.obj")[0])


def test_a_step_file_gives_the_triangles_that_cadquery_finds(tmp_path):
    cadquery = pytest.importorskip("cadquery")
    solid = cadquery.Workplane().box(200, 80, 60).edges("|Z").fillet(20).faces(">Z").hole(30)
    path = str(tmp_path / "foot.step")
    cadquery.exporters.export(solid, path)
    triangles, unit = read_mesh(path)
    vertices, faces = cadquery.importers.importStep(path).val().tessellate(0.05, 0.2)
    wanted = np.array([v.toTuple() for v in vertices])[np.array(faces)]
    assert unit == "mm"
    np.testing.assert_allclose(_sorted(triangles.round(9)), _sorted(wanted.round(9)), atol=1e-8)
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles))
    assert mesh.volume == pytest.approx(solid.val().Volume(), rel=2e-3)  # and so turned outwards


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", ["foot.stl", "text.stl", "foot.obj", "foot.ply", "foot.off", "foot.3mf"])
def test_a_mesh_of_too_many_triangles_is_refused(tmp_path, monkeypatch, box, name):
    mesh, path = _mesh(box).subdivide(), tmp_path / name
    if name == "text.stl":
        path.write_text(trimesh.exchange.stl.export_stl_ascii(mesh))
    elif name == "foot.3mf":
        _write_3mf(path, mesh, "millimeter", '<item objectid="1"/>')
    else:
        mesh.export(path)
    monkeypatch.setattr(mesh_file, "MOST_TRIANGLES", len(mesh.faces))
    assert len(read_mesh(path)[0]) == len(mesh.faces)
    monkeypatch.setattr(mesh_file, "MOST_TRIANGLES", len(mesh.faces) - 1)
    with pytest.raises(FootError, match=f"{len(mesh.faces) - 1}.*reduce the mesh"):
        read_mesh(path)


DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>
<unit name="u" meter="{metre}"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="{numbers}">{points}</float_array><technique_common><accessor source="#a"
count="{count}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{faces}"><input semantic="VERTEX" source="#v" offset="0"/><p>{corners}</p></triangles></mesh>
</geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">
<matrix>1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


@pytest.mark.parametrize("metre", [0.001, 1.0, 0.0254])
def test_collada_is_read_in_metres_with_its_nodes(tmp_path, box, metre):
    body = box((-60, 140), (-45, 45), (0, 40))
    points = body.reshape(-1, 3)
    (tmp_path / "foot.dae").write_text(
        DAE.format(
            metre=metre,
            numbers=points.size,
            points=" ".join(map(str, points.ravel())),
            count=len(points),
            faces=len(body),
            corners=" ".join(map(str, range(len(points)))),
        )
    )
    triangles, unit = read_mesh(tmp_path / "foot.dae")
    assert unit == "m"
    found = triangles.reshape(-1, 3)
    np.testing.assert_allclose([found.min(axis=0), found.max(axis=0)], metre * np.array([[-50, -45, 0], [150, 45, 40]]))
    (tmp_path / "foot.dae").write_text(DAE[:400])
    with pytest.raises(FootError, match=r"foot\.dae: not a DAE mesh"):
        read_mesh(tmp_path / "foot.dae")


def test_a_3mf_may_keep_its_objects_in_parts_of_their_own(tmp_path, box):
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(box((-60, 140), (-45, 45), (0, 40))))
    _write_3mf(tmp_path / "plain.3mf", mesh, "millimeter", '<item objectid="1"/>')
    with zipfile.ZipFile(tmp_path / "plain.3mf") as plain:
        part = plain.read("3D/3dmodel.model").decode()
    names = 'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" '
    names += 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
    use = '<component objectid="1" p:path="/3D/Objects/Foot.model" transform="1 0 0 0 1 0 0 0 1 0 0 5"/>'
    main = f'<model unit="millimeter" {names}><resources><object id="1"><components>{use}</components></object>'
    main += '</resources><build><item objectid="1"/></build></model>'
    with zipfile.ZipFile(tmp_path / "foot.3mf", "w") as package:
        package.writestr("3D/3dmodel.model", main)
        package.writestr("3D/Objects/Foot.model", part)
    triangles, _ = read_mesh(tmp_path / "foot.3mf")
    assert len(triangles) == len(mesh.faces)
    assert (triangles[..., 2].min(), triangles[..., 2].max()) == (5.0, 45.0)
    with zipfile.ZipFile(tmp_path / "foot.3mf", "w") as package:
        package.writestr("3D/3dmodel.model", main)
    with pytest.raises(FootError, match="names an object that it does not hold"):
        read_mesh(tmp_path / "foot.3mf")
