"""A robot reads nothing but what came with it, unless the user says so; models of any shape are refused in one line."""

import os
from pathlib import Path

import pytest

from plantar.common.files.model_files import (
    VARIABLE,
    check_model,
    folders_of_model,
    mesh_of_urdf,
    named_file,
    parsed_model,
)
from plantar.common.files.xml_file import parse_xml
from plantar.errors import RobotError


@pytest.fixture
def package(tmp_path):
    """A package with its model in xml/ and meshes beside, and something next to it that is none of its business."""
    for folder in ("robot/xml", "robot/meshes", "other"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "robot" / "meshes" / "foot.stl").write_text("mesh")
    (tmp_path / "other" / "secret.stl").write_text("secret")
    return tmp_path / "robot"


def model(package: Path, inside: str, name: str = "model.xml") -> Path:
    path = package / "xml" / name
    path.write_text(f"<mujoco>{inside}</mujoco>")
    return path


ELSEWHERE = (
    "../../other/secret.stl",
    "/etc/passwd",
    "../meshes/../../other/secret.stl",
    "../../../../../../etc/passwd",
)


@pytest.mark.parametrize("name", ELSEWHERE)
@pytest.mark.parametrize(
    "inside",
    [
        '<asset><mesh file="{}"/></asset>',
        '<asset><texture type="2d" file="{}"/></asset>',
        '<asset><texture type="cube" fileright="{}"/></asset>',
        '<asset><hfield file="{}"/></asset>',
        '<asset><skin file="{}"/></asset>',
        '<include file="{}"/>',
        '<asset><model file="{}"/></asset>',
        '<compiler meshdir="."/><asset><mesh file="{}"/></asset>',
    ],
)
def test_a_model_that_leads_out_of_its_package_is_refused(package, inside, name):
    path = model(package, inside.format(name))
    with pytest.raises(RobotError, match=rf"lies elsewhere; allowed: .*{VARIABLE}") as caught:
        check_model(path, RobotError)
    assert "\n" not in str(caught.value)


def test_folders_for_assets_and_nested_models_lead_out_neither(package):
    path = model(package, '<compiler meshdir="../../other"/><asset><mesh file="secret.stl"/></asset>')
    with pytest.raises(RobotError, match="lies elsewhere"):
        check_model(path, RobotError)
    model(package, '<asset><mesh file="/etc/passwd"/></asset>', "inner.xml")
    for inside in ('<include file="inner.xml"/>', '<asset><model file="inner.xml"/></asset>'):
        with pytest.raises(RobotError, match="lies elsewhere"):
            check_model(model(package, inside), RobotError)


def test_a_link_leads_out_neither(package):
    (package / "meshes" / "foot.stl").unlink()
    (package / "meshes" / "foot.stl").symlink_to(package.parent / "other" / "secret.stl")
    path = model(package, '<asset><mesh file="../meshes/foot.stl"/></asset>')
    with pytest.raises(RobotError, match="lies elsewhere"):
        check_model(path, RobotError)
    (package / "meshes" / "loop.stl").symlink_to("loop.stl")
    with pytest.raises(RobotError, match=r"cannot be read|lies elsewhere"):
        named_file(package / "meshes" / "loop.stl", (package / "xml",), RobotError, "x")


def test_a_package_is_read_as_packages_are(package):
    (package / "xml" / "parts.xml").write_text('<mujoco><asset><mesh file="../meshes/foot.stl"/></asset></mujoco>')
    check_model(model(package, '<compiler meshdir="../meshes"/><asset><mesh file="foot.stl"/></asset>'), RobotError)
    check_model(model(package, '<include file="parts.xml"/>'), RobotError)
    assert folders_of_model(package / "xml" / "model.xml") == (package / "xml", package)


def test_the_user_can_allow_a_folder(package, monkeypatch):
    path = model(package, '<asset><mesh file="../../other/secret.stl"/></asset>')
    monkeypatch.setenv(VARIABLE, os.pathsep.join(["/nowhere", str(package.parent / "other")]))
    check_model(path, RobotError)
    with pytest.raises(RobotError, match="lies elsewhere"):
        check_model(model(package, '<asset><mesh file="/etc/passwd"/></asset>'), RobotError)


def test_the_home_folder_is_no_package(tmp_path, monkeypatch):
    (tmp_path / "downloads").mkdir()
    monkeypatch.setenv("HOME", str(tmp_path))
    assert folders_of_model(tmp_path / "downloads" / "model.xml") == (tmp_path / "downloads",)
    assert folders_of_model(Path("/model.xml")) == (Path("/"),)
    assert Path("/") not in folders_of_model(Path("/srv/model.xml"))


@pytest.mark.parametrize(
    "name",
    [
        "package://robot/meshes/foot.stl",
        "package:///robot/meshes/foot.stl",
        "model://robot/meshes/foot.stl",
        "../meshes/foot.stl",
    ],
)
def test_a_mesh_of_a_urdf_is_found(package, name):
    found = mesh_of_urdf(package / "xml" / "robot.urdf", name, RobotError, "robot.urdf")
    assert found.resolve() == package / "meshes" / "foot.stl"


@pytest.mark.parametrize(("place", "name"), [("../meshes", "package://mine/cad/foot.stl"), ("../meshes/", "foot.stl")])
def test_the_folder_that_a_urdf_states_for_mujoco_counts(package, place, name):
    mesh = f'<link name="a"><visual><geometry><mesh filename="{name}"/></geometry></visual></link>'
    file = package / "xml" / "robot.urdf"
    file.write_text(f'<robot name="r"><mujoco><compiler meshdir="{place}"/></mujoco>{mesh}</robot>')
    found = next(parsed_model(file, RobotError).iter("mesh")).get("filename")
    assert (file.parent / found).resolve() == package / "meshes" / "foot.stl"


@pytest.mark.parametrize(
    "name", ["package://etc/passwd", "file:///etc/passwd", "/etc/passwd", "package://robot/../other/x"]
)
def test_a_mesh_of_a_urdf_leads_out_neither(package, name):
    try:
        found = mesh_of_urdf(package / "xml" / "robot.urdf", name, RobotError, "robot.urdf")
    except RobotError as error:
        assert "lies elsewhere" in str(error)  # noqa: PT017  or it is looked for inside, where it is not
    else:
        assert found.resolve().is_relative_to(package)
        assert not found.exists()


@pytest.mark.parametrize(
    ("inside", "words"),
    [
        ('<include file="model.xml"/>', "included twice"),
        ('<include file="a.xml"/><include file="a.xml"/>', "included twice"),
        ('<include file=""/>', "Is a directory"),
        ('<include file="pipe"/>', "it is a pipe"),
        ("<body>" * 300_000, "deep in each other"),
        ("<a/>" * 300_000, "more than 200000 elements"),
        ("<a" + " b='" + "x" * 11_000_000 + "'/>", "allowed: up to 10 MB"),
    ],
)
def test_models_without_end_are_one_line(package, within, inside, words):
    os.mkfifo(package / "xml" / "pipe")
    model(package, "", "a.xml")
    path = model(package, inside)
    with within(megabytes=250, seconds=5.0), pytest.raises(RobotError, match=words) as caught:
        parsed_model(path, RobotError)
    assert "\n" not in str(caught.value)


def test_entities_are_not_read(within):
    lines = ["<!DOCTYPE r [<!ENTITY e0 'ha'>"] + [f"<!ENTITY e{i} '{f'&e{i - 1};' * 10}'>" for i in range(1, 12)]
    with within(megabytes=20), pytest.raises(RobotError, match="declares entities"):
        parse_xml("".join([*lines, "]><r>&e11;</r>"]).encode(), RobotError, "x.xml")
    for encoding in ("utf-16", "utf-16-be"):
        data = "".join([*lines, "]><r>&e11;</r>"]).encode(encoding)
        with within(megabytes=20), pytest.raises(RobotError, match="declares entities"):
            parse_xml(data, RobotError, "x.xml")


def test_a_ros_package_is_found_by_the_name_that_its_manifest_states(tmp_path):
    folder = tmp_path / "checkout-main" / "urdf"
    folder.mkdir(parents=True)
    (folder.parent / "package.xml").write_text("<package><name>my_robot_description</name></package>")
    (folder.parent / "meshes").mkdir()
    mesh = folder.parent / "meshes" / "foot.stl"
    mesh.write_bytes(b"solid")
    named = "package://my_robot_description/meshes/foot.stl"
    assert mesh_of_urdf(folder / "robot.urdf", named, RobotError, "robot.urdf").resolve() == mesh.resolve()
