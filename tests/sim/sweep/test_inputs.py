"""What a sweep's rows depend on: every file that a run reads, by content."""

import shutil

import pytest

from plantar.errors import InputError, RobotError, SceneError
from plantar.robots import load_robot
from plantar.sim.sweep import Sweep, run_sweep
from plantar.sim.sweep.inputs import changes, inputs_of
from plantar.sim.sweep.task import Task, run_task

STANDING = ("steps=0", "settle=0.0", "end=0.2", "start=0.2")


@pytest.fixture
def own(tmp_path, monkeypatch):
    """A working folder with a scene of one's own, stood in by a robot of one's own."""
    shutil.copytree(load_robot("h1").path.parent, tmp_path / "robot")
    (tmp_path / "scene.toml").write_text('robot = "robot/robot.toml"\n[walk]\nsteps = 0\nsettle = 0.0\nend = 0.2\n')
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_file_and_version_is_there():
    found = inputs_of("flat", "h1")
    assert set(found) == {
        "plantar",
        "mujoco",
        "scene file flat.toml",
        "robot file robot.toml",
        "layout layout_left.json",
        "layout layout_right.json",
    }
    assert inputs_of("flat", "h1") == found
    assert changes(found, found) == ""
    assert "robot file robot.toml has changed" in changes(found, inputs_of("flat", "hrp2kai"))
    with pytest.raises(SceneError):
        inputs_of("nowhere", "h1")
    with pytest.raises(RobotError):
        inputs_of("flat", "nobody")


def test_what_a_model_names_counts_too(own):
    robot = own / "robot" / "robot.toml"
    parts = {"robot.xml": '<compiler meshdir="meshes"/><include file="legs.xml"/><mesh file="foot.stl"/>'}
    parts |= {"legs.xml": "<mesh file='meshes/knee.obj'/><mesh file='none.stl'/>"}
    parts |= {"meshes/foot.stl": "foot", "meshes/knee.obj": "knee", "meshes/else.stl": "else"}
    (own / "robot" / "meshes").mkdir()
    for name, text in parts.items():
        (own / "robot" / name).write_text(text)
    robot.write_text(robot.read_text().replace('kind = "biped"', 'kind = "mjcf"\nfile = "robot.xml"', 1))
    robot.write_text(robot.read_text().replace("[shoe]", "[shoe]\norigin = [0.0, 0.0, 0.0]", 1))
    before = inputs_of("flat", str(robot))
    assert {"model robot.xml", "model file legs.xml", "model file foot.stl", "model file meshes/knee.obj"} <= set(
        before
    )
    (own / "robot" / "meshes" / "knee.obj").write_text("other knee")
    assert changes(before, inputs_of("flat", str(robot))) == "model file meshes/knee.obj has changed"


def test_a_file_that_changed_stops_a_resumed_sweep_and_a_run(own):
    sweep = Sweep("scene.toml", (), 1, None, STANDING)
    assert run_sweep(sweep, own / "out")["points"][0]["completed"] == 1
    assert run_sweep(Sweep("scene.toml", (), 2, None, STANDING), own / "out")["resumed"] == 1
    inputs = tuple(inputs_of("scene.toml", "robot/robot.toml").items())
    task = Task("scene.toml", "robot/robot.toml", STANDING, 0, inputs)
    for kind, file in (
        ("scene file", "scene.toml"),
        ("robot file", "robot/robot.toml"),
        ("layout", "robot/layout_left.json"),
    ):
        path, before = own / file, (own / file).read_text()
        words = f"{kind} {path.name} has changed since"
        path.write_text(before + "\n")
        with pytest.raises(InputError, match=f"{words} .*out was begun; bring that back, or choose another folder"):
            run_sweep(sweep, own / "out")
        with pytest.raises(InputError, match=f"{words} the sweep began .seen on"):
            run_task(task)
        path.unlink()
        with pytest.raises(InputError, match=r"exist|read.*since the sweep began .seen on"):
            run_task(task)
        path.write_text(before)
        assert run_sweep(sweep, own / "out")["resumed"] == 1
