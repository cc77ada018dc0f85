"""Meshes that MuJoCo does not read become binary STL files that it does."""

import re

import numpy as np
import pytest

from plantar.common.files import gate
from plantar.errors import RobotError
from plantar.robots.survey import surface_file
from plantar.robots.survey.surface_file import meshes_for_mujoco, stl_bytes

trimesh = pytest.importorskip("trimesh")
BOX = trimesh.creation.box((0.2, 0.1, 0.04))


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "converted").mkdir()
    return tmp_path / "converted"


def mesh_for_mujoco(path, folder):
    return meshes_for_mujoco([path], folder, folder / "robot.urdf")[path]


def read(path):
    return np.asarray(trimesh.load(path, process=False).triangles)


@pytest.mark.parametrize("kind", ["dae", "stl_ascii"])
def test_collada_and_text_become_binary_stl(tmp_path, folder, kind):
    path = tmp_path / f"foot.{kind[:3]}"
    BOX.export(path, file_type=kind)
    found = mesh_for_mujoco(path, folder)
    assert found.parent == folder
    np.testing.assert_allclose(read(found), BOX.triangles, atol=1e-7)


def test_the_nodes_and_the_unit_of_a_collada_file_count(tmp_path, folder):
    path = tmp_path / "foot.dae"
    BOX.export(path)
    moved = re.sub("(<node[^>]*>)", r"\1<translate>0.5 0 0</translate>", path.read_text(), count=1)
    path.write_text(re.sub("<up_axis>", '<unit name="cm" meter="0.01"/><up_axis>', moved, count=1))
    assert read(mesh_for_mujoco(path, folder))[..., 0].mean() == pytest.approx(0.005)


def test_a_binary_file_is_taken_as_it_is_up_to_the_faces_that_mujoco_reads(tmp_path, folder, monkeypatch):
    path = tmp_path / "foot.stl"
    path.write_bytes(stl_bytes(BOX.triangles))
    assert mesh_for_mujoco(path, folder) == path
    monkeypatch.setattr(surface_file, "_LARGEST", 11)
    assert mesh_for_mujoco(path, folder) == folder / mesh_for_mujoco(path, folder).name


@pytest.mark.sample(5)
@pytest.mark.parametrize(
    "data", [b"", b"solid x", b"<COLLADA/>", b'<!DOCTYPE a [<!ENTITY b "c">]><COLLADA/>', bytes(99)]
)
@pytest.mark.parametrize("kind", ["dae", "stl", "ply"])
def test_what_cannot_be_read_is_left_out(tmp_path, folder, kind, data):
    path = tmp_path / f"foot.{kind}"
    path.write_bytes(data)
    assert mesh_for_mujoco(path, folder) is None
    assert mesh_for_mujoco(tmp_path / "none.stl", folder) is None


def test_all_meshes_of_a_model_are_read_in_one_process(tmp_path, folder, monkeypatch):
    paths = [tmp_path / f"{i}.dae" for i in range(3)]
    for path, size in zip(paths, (0.1, 0.2, 0.3), strict=True):
        trimesh.creation.box((size, 0.1, 0.1)).export(path)
    paths[1].write_text("<COLLADA/>")
    asked = []
    monkeypatch.setattr(surface_file, "read_apart", lambda *words: asked.append(words) or gate.read_apart(*words))
    found = meshes_for_mujoco(paths, folder, tmp_path / "robot.urdf")
    assert len(asked) == 1
    assert found[paths[1]] is None
    assert [np.ptp(read(found[path])[..., 0]) for path in (paths[0], paths[2])] == pytest.approx([0.1, 0.3])


@pytest.mark.apart
def test_meshes_that_end_their_reader_are_refused_in_the_models_name(tmp_path, folder, monkeypatch):
    path = tmp_path / "foot.dae"
    BOX.export(path)
    monkeypatch.setitem(gate.HELPERS, "meshes", gate.HELPERS["meshes"]._replace(function="os:abort"))
    with pytest.raises(RobotError, match=r"robot\.urdf: not meshes that can be read"):
        meshes_for_mujoco([path], folder, tmp_path / "robot.urdf")
