"""A model file through MuJoCo's reader: every link and mesh of it stays."""

import pytest

from plantar.common.files.model_source import BELOW, read_model_source
from plantar.errors import RobotError

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def link(name: str, *meshes: str) -> str:
    shapes = "".join(f'<visual><geometry><mesh filename="{mesh}"/></geometry></visual>' for mesh in meshes)
    return f'<link name="{name}">{shapes}</link>'


def joint(parent: str, child: str) -> str:
    return f'<joint name="to {child}" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>'


def test_meshes_of_one_name_in_two_folders_are_two(tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "foot.obj").write_text(TETRAHEDRON)
    file = tmp_path / "robot.urdf"
    parts = link("base", "a/foot.obj") + link("toe", "b/foot.obj", "a/foot.obj") + joint("base", "toe")
    file.write_text(f'<robot name="r">{parts}</robot>')
    source = read_model_source(file, RobotError)
    spec = source.spec()
    assert [body.name for body in spec.bodies] == ["world", "base", "toe"]
    found = {mesh.name: source.mesh_path(spec, mesh).relative_to(tmp_path).as_posix() for mesh in spec.meshes}
    assert sorted(found.values()) == ["a/foot.obj", "b/foot.obj"]
    assert [found[geom.meshname] for geom in spec.geoms] == ["a/foot.obj", "b/foot.obj", "a/foot.obj"]


def test_several_roots_hang_on_a_link_below_them(tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text(f'<robot name="r">{link("world")}{link("foot")}</robot>')
    bodies = read_model_source(file, RobotError).spec().bodies
    assert [body.name for body in bodies] == ["world", BELOW, "world_link", "foot"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f'<robot name="r">{link("a")}{link("b")}{joint("a", "b")}{joint("b", "a")}</robot>', "no link that hangs on"),
        ("<sdf/>", "the outermost element is <sdf>; allowed: <mujoco> .MJCF., <robot> .URDF."),
        ("<mujoco><option timestep='nan'/></mujoco>", "<option>: timestep is 'nan'; allowed: finite numbers"),
    ],
)
def test_what_is_no_tree_of_links_is_refused(tmp_path, text, words):
    file = tmp_path / "model.xml"
    file.write_text(text)
    with pytest.raises(RobotError, match=words):
        read_model_source(file, RobotError)
