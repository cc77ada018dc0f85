"""A scene says terrain, robot, task, who disturbs and what is sensed; how the robot walks is its controller's."""

import re
from pathlib import Path

import pytest

from plantar.common.files.structured_text import read_toml
from plantar.gait.controller_tables import CONTROLLER_TABLES
from plantar.sim.run.scene import builtin_scenes, scene_file

ROOT = Path(__file__).parents[3]
OF_THE_CONTROLLER = {
    "walk": {
        *("single_support", "double_support", "swing_height", "lean", "crouch", "approach_height", "approach_speed"),
        *("start", "end"),
    },
    "control": {
        *("footholds", "pfc", "feasibility", "conform", "step_timing", "step_adjustment", "learn_strides"),
        *("push_estimate", "dcm_estimate", "swing_shape", "identify", "feedback"),
    },
}


def controllers_settings(text: str) -> list[str]:
    """The controller's settings that a scene's TOML holds, as "section.key"."""
    found, section = [], ""
    for line in text.splitlines():
        if heading := re.match(r"\[([\w.]+)\]", line):
            section = heading[1]
            if section in CONTROLLER_TABLES:
                found.append(section)
        elif (key := re.match(r"(\w+)\s*=", line)) and key[1] in OF_THE_CONTROLLER.get(section, ()):
            found.append(f"{section}.{key[1]}")
    return found


@pytest.mark.parametrize("name", builtin_scenes())
def test_no_built_in_scene_holds_a_setting_of_the_controller(name):
    path = scene_file(name)
    assert read_toml(path, ValueError, name)
    assert controllers_settings(path.read_text()) == []


@pytest.mark.parametrize("page", sorted((ROOT / "docs").rglob("*.md")), ids=lambda p: p.stem)
def test_no_documented_scene_holds_a_setting_of_the_controller(page):
    for block in re.findall(r"```toml\n(.*?)```", page.read_text(), re.DOTALL):
        if "[terrain]" in block or "[walk]" in block:
            assert controllers_settings(block) == []


def test_a_setting_of_the_controller_would_be_found():
    text = '[terrain]\nkind = "flat"\n[walk]\nsteps = 4\ncrouch = 0.02\n[control]\npfc = true\n[landing]\nspeed = 1\n'
    assert controllers_settings(text) == ["walk.crouch", "control.pfc", "landing"]
