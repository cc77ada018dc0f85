import json
import shutil
from pathlib import Path

import pytest

from plantar.errors import RobotError
from plantar.robots import builtin_robots, load_robot


@pytest.mark.parametrize("name", builtin_robots())
def test_built_in_robots_load(name):
    robot = load_robot(name)
    assert robot.name == name
    assert set(robot.layouts) == set(robot.legs) == {"left", "right"}
    for side in ("left", "right"):
        assert len(robot.posture[side]) == len(robot.legs[side].joints)
        assert robot.layouts[side].side == side


@pytest.fixture
def own(tmp_path):
    folder = tmp_path / "mine"
    shutil.copytree(load_robot("h1").path.parent, folder)
    return folder / "robot.toml"


def test_a_robot_file_of_ones_own(own):
    assert load_robot(own).name == "h1"


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ('kind = "biped"', 'kind = "snake"', "biped, mjcf, urdf"),
        ('kind = "biped"', 'kind = "mjcf"\nfile = "none.xml"', "none.xml"),
        ("total_mass = 86.0", "", "total_mass"),
        ("total_mass = 86.0", "total_mass = nan", "total_mass"),
        ("thigh_length", "thigh_longth", "thigh_longth"),
        ("[servo]", "[servos]", "servo"),
        ("stiffness = 8000.0", "stiffness = -1", "stiffness"),
        ("left = [0.0, 0.0, -20.0, 40.0, -20.0, 0.0]", "left = [0.0]", "left"),
        ('layout = "layout_{side}.json"', 'layout = "none.json"', "none.json"),
        ('body = "base"', "", "body"),
        ("[legs.right]", "[wings.right]", "right"),
        ("effort_limits = [51.0, ", "effort_limits = [", "effort_limits"),
    ],
)
def test_bad_robot_files_name_the_field(own, old, new, word):
    text = own.read_text()
    assert old in text
    own.write_text(text.replace(old, new))
    with pytest.raises(RobotError, match=word) as caught:
        load_robot(own)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["nobody", "../h1", "none.toml", ""])
def test_unknown_robots_are_named(name):
    with pytest.raises(RobotError, match=r"h1|none\.toml"):
        load_robot(name)


def test_mass_and_thickness_come_with_the_shoes_layout(tmp_path):
    for name in ("robot.toml", "layout_left.json", "layout_right.json"):
        text = (Path(load_robot("h1").path).parent / name).read_text()
        if name == "robot.toml":
            lines = text.splitlines()
            start = lines.index("[shoe]")
            text = "\n".join(
                line for i, line in enumerate(lines) if i < start or not line.startswith(("thickness", "mass"))
            )
        else:
            table = json.loads(text) | {"shoe": {"mass": 0.4, "thickness": 0.015, "rim_stiffness": 1.5}}
            text = json.dumps(table)
        (tmp_path / name).write_text(text)
    robot = load_robot(tmp_path / "robot.toml")
    assert (robot.shoe_mass, robot.shoe_thickness, robot.rim_stiffness) == (0.4, 0.015, 1.5)
    assert robot.contact_damping == 1.0
    file = tmp_path / "robot.toml"
    file.write_text(file.read_text().replace("[shoe]\n", "[shoe]\ncontact_damping = 3.0\n"))
    assert load_robot(file).contact_damping == 3.0
    file.write_text(file.read_text().replace("= 3.0", "= 0.0"))
    with pytest.raises(RobotError, match=r"contact_damping.*0\.1"):
        load_robot(file)
