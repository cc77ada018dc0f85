"""Tests of 3MF files: what is read back, and the bytes."""

import zipfile

import numpy as np
import trimesh

from plantar.shoes.foot.mesh_file import read_mesh
from plantar.shoes.papers.mesh_files import write_3mf, write_stl


def test_triangles_come_back_in_mm_and_bytes_repeat(tmp_path, box):
    surface = box((-10.25, 20), (0, 3.125), (1, 2))
    first = write_3mf(surface, 'a <shoe> & "left"', tmp_path / "a.3mf")
    second = write_3mf(surface, 'a <shoe> & "left"', tmp_path / "b.3mf")
    assert first.read_bytes() == second.read_bytes()
    triangles, unit = read_mesh(first)
    assert unit == "mm"
    np.testing.assert_allclose(triangles, surface)
    with zipfile.ZipFile(first) as package:
        assert package.testzip() is None
        assert {"[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"} == set(package.namelist())
        model = package.read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in model
    assert model.count("<vertex ") == len(np.unique(surface.reshape(-1, 3), axis=0))  # corners are shared


def test_triangles_without_area_are_left_out(tmp_path, box):
    surface = np.concatenate([box((0, 1), (0, 1), (0, 1)), np.zeros((1, 3, 3))])
    triangles, _ = read_mesh(write_3mf(surface, "a", tmp_path / "a.3mf"))
    assert len(triangles) == len(surface) - 1


def test_triangles_come_back_and_bytes_repeat(tmp_path, box):
    triangles = box((-10.5, 20), (0, 3), (1, 2))
    first, second = write_stl(triangles, tmp_path / "a.stl"), write_stl(triangles, tmp_path / "b.stl")
    assert first.read_bytes() == second.read_bytes()
    np.testing.assert_array_equal(read_mesh(first)[0], triangles.astype(np.float32))
    mesh = trimesh.load(first, force="mesh")
    assert mesh.is_watertight
    assert mesh.volume == 30.5 * 3
    normals = np.frombuffer(first.read_bytes(), np.uint8, offset=84).reshape(-1, 50)[:, :12].copy().view("<f4")
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert len(first.read_bytes()) == 84 + 50 * len(triangles)


def test_a_triangle_without_area_has_no_normal(tmp_path):
    path = write_stl(np.zeros((1, 3, 3)), tmp_path / "flat.stl")
    assert not any(path.read_bytes()[84:])
