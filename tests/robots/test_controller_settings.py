"""Every setting of the controller's parts is reached by its dotted name: from a scene, `--set`, a robot file."""

from dataclasses import replace

import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.errors import RobotError, SceneError
from plantar.gait.controller_tables import CONTROLLER_TABLES, controller_keys, controller_settings_described
from plantar.gait.estimate.estimator import EstimatorGains
from plantar.robots.controller_settings import controller_settings
from plantar.robots.robot_file import load_robot
from plantar.sim.run.scene import load_scene

ALL_ON = ["pfc=true", "control.feasibility=skin", "conform=true", "footholds=skin"]
ALL_ON += ["control.step_adjustment=true", "control.learn_strides=true", "control.push_estimate=skin"]
ALL_ON += ["control.dcm_estimate=kalman", "control.swing_shape=fit"]
ALL_ON += ["step_adjustment.method=ssp_opt", "step_adjustment.double_support=true"]
PART_OF = {"swing_fit": "swing"}


def value_of(settings: object, table: str, name: str) -> object:
    part = getattr(settings, PART_OF.get(table, table))
    return getattr(part, name) if hasattr(part, name) else getattr(part.feet, name)


@pytest.mark.sample(6)
@pytest.mark.parametrize("table", CONTROLLER_TABLES)
def test_every_setting_is_reached_by_its_dotted_name(table):
    for robot in ("h1", "hrp2kai"):
        law = load_robot(robot).balance.get("law", "com_admittance")
        for told in controller_settings_described(table):
            kinds = [k for k in CONTROLLER_TABLES[table] if told.name in k.names()]
            if table == "balance" and not any(("Wrench" in k.__name__) == (law != "com_admittance") for k in kinds):
                continue
            other = {"true": "false", "false": "true"}.get(told.default)
            if other is None:
                words = told.allowed.split(", ")
                other = words[-1] if told.default.startswith('"') else str(float(told.default) * 0.5 or 1.0)
                if "whole" in told.allowed:
                    other = str(int(told.default) + 1)
            scene = load_scene("flat", [*ALL_ON, f"{table}.{told.name}={other}"], robot)
            found = value_of(controller_settings(scene, load_robot(robot), REFERENCE_BODY, {}), table, told.name)
            assert str(found).lower() in (other, f"{other}.0") or float(str(found)) == float(other), told


def test_a_scene_goes_before_the_robot_and_the_robot_before_the_default():
    robot = replace(load_robot("h1"), controller={"estimator": {"gravity": 0.3, "observer": 15.0}})
    made = controller_settings(load_scene("flat", ["estimator.gravity=0.4"]), robot, REFERENCE_BODY, {})
    assert (made.estimator.gravity, made.estimator.observer, made.estimator.tare) == (0.4, 15.0, EstimatorGains().tare)
    assert controller_settings(load_scene("flat", ["dcm_gain=2"]), robot, REFERENCE_BODY, {}).balance.dcm_gain == 2.0


def test_a_robots_gains_are_those_of_its_own_law_named_or_not():
    tuned = {"dcm_gain": 2.5}
    for own in ({}, {"law": "com_admittance"}):
        robot = replace(load_robot("h1"), balance={**own, **tuned})
        for law in ("com_admittance", "wrench_distribution"):
            made = controller_settings(load_scene("flat", [f"balance.law={law}"]), robot, REFERENCE_BODY, {})
            assert (made.balance.dcm_gain == 2.5) is (law == "com_admittance")


def test_a_robot_walks_as_low_as_its_steps_need():
    robot = load_robot("h1")

    def crouch(*settings: str) -> float:
        made = controller_settings(load_scene("flat", settings), robot, REFERENCE_BODY, {})
        return round(robot.com_height - made.com_height, 6)

    # A leg of 0.6 m that is 0.1 m off the vertical reaches sqrt(0.6^2 - 0.1^2) down: 8.4 mm less.
    assert crouch("walk.length=0.1") == pytest.approx(0.6 - (0.6**2 - 0.1**2) ** 0.5, rel=0.02)
    assert crouch("walk.length=0") == crouch("walk.crouch=0") == 0.0
    assert crouch() == crouch("walk.length=0", "walk.velocity=[0, 0, 0]") == crouch("length=0", "climb=0.02") == 0.03
    assert crouch("walk.length=0", "walk.sideways=0.2", "walk.crouch=0.02") == 0.02


@pytest.mark.parametrize(
    ("settings", "height"),
    [
        ([], 0.08),
        (["single_support=0.9"], 0.08),
        (["single_support=0.6", "length=0.24"], 0.051),
        (["single_support=0.6", "length=0.3"], 0.032),
        (["single_support=0.4", "length=0.3"], 0.02),
        (["walk.velocity=[0.1, 0, 0]"], 0.05),
    ],
)
def test_quick_and_long_steps_clear_less(settings, height):
    made = controller_settings(load_scene("flat", settings), load_robot("h1"), REFERENCE_BODY, {})
    assert made.swing_height == pytest.approx(height, abs=1e-3)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (["dcm_gian=2"], "nearest: balance.dcm_gain"),
        (["estimator.gravty=2"], "nearest: estimator.gravity"),
        (["estimator.gravity=-1"], r"\[estimator\] 'gravity' is -1; allowed: a number 0 to 50"),
        (["pfc=false", "compliance.damping=0.05"], "does nothing; allowed: with control.pfc = true"),
        (
            ["control.step_adjustment=true", "step_weights.dynamics=10"],
            "sets step_weights.dynamics, which does nothing; allowed: .* step_adjustment.method = 'ssp_opt'",
        ),
        (
            ["control.step_adjustment=false", "step_adjustment.method=ssp_opt"],
            "does nothing; allowed: with control.step_adjustment = true",
        ),
        (
            ["control.step_adjustment=true", "dsp_weights.dynamics=10"],
            "allowed: .* step_adjustment.double_support = true",
        ),
        (
            ["control.step_adjustment=true", "double_support_timing.pause=0.1"],
            "allowed: .* step_adjustment.double_support = true",
        ),
        (["landing.approach_height=0.01"], "no such key"),
        (["clearance=0.02"], "compliance.clearance, feasibility.clearance"),
    ],
)
def test_a_wrong_setting_is_refused_with_what_is_right(settings, words):
    with pytest.raises(SceneError, match=words):
        controller_settings(load_scene("flat", settings), load_robot("h1"), REFERENCE_BODY, {})


def test_a_setting_that_a_scene_gives_elsewhere_is_pointed_to(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('robot = "h1"\n[walk]\nsteps = 2\n[landing]\napproach_height = 0.01\n')
    with pytest.raises(SceneError, match=r"\[landing\] 'approach_height' is given by 'walk.approach_height'"):
        load_scene(path)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("[estimator]\ngravity = -1", r"\[estimator\] 'gravity' is -1"),
        ("[estimator]\ngravty = 1", "nearest: gravity"),
        ("[feasibility]\nattempts = 2.5", "a whole number"),
    ],
)
def test_a_robot_file_is_checked_when_it_is_read(lines, words, tmp_path):
    source = load_robot("h1").path
    text = source.read_text(encoding="utf-8").replace("layout_{side}.json", str(source.parent / "layout_{side}.json"))
    path = tmp_path / "robot.toml"
    for side in ("left", "right"):
        (tmp_path / f"layout_{side}.json").write_bytes((source.parent / f"layout_{side}.json").read_bytes())
    text = source.read_text(encoding="utf-8")
    path.write_text(text + "\n" + lines + "\n")
    with pytest.raises(RobotError, match=words):
        load_robot(str(path))
    path.write_text(text.replace("dcm_gain", "dcm_gian"))
    with pytest.raises(RobotError, match="nearest: dcm_gain"):
        load_robot(str(path))


def test_a_short_name_is_completed():
    scene = load_scene("flat")
    assert scene.setting_name("dcm_gain") == "balance.dcm_gain"
    assert scene.setting_name("estimator.gravity") == "estimator.gravity"
    with pytest.raises(SceneError, match="no setting 'clearance'"):
        scene.setting_name("clearance")
    assert "approach_height" not in controller_keys("landing")
