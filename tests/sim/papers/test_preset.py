"""Presets by source: each is complete, cited, refused where it states nothing, and set before a user's own settings."""

import re

import pytest

from plantar.errors import SceneError
from plantar.robots import load_robot
from plantar.robots.controller_settings import controller_settings
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.sim.papers.preset import paper_files, paper_settings, with_paper
from plantar.sim.run.scene import Scene
from plantar.sim.run.scene_kind import open_scene

ALL = sorted({(p, s) for p in paper_files() for f in paper_settings(p) for s in f.scenes})


@pytest.mark.parametrize(("paper", "scene"), ALL)
def test_every_setting_of_a_paper_is_known_and_used(paper, scene):
    walks = isinstance(open_scene(scene), Scene)
    for robot in ("h1", "hrp2kai"):
        opened = open_scene(scene, [f"paper={paper}"], robot if paper == "T" and walks else None)
        assert opened.name == f"{scene} as {paper}"
        if isinstance(opened, Scene):
            file = load_robot(opened.robot)
            body = body_of(file, build_leg_model(file).model)
            controller_settings(opened.for_body(body), file, body, {})  # refuses what would do nothing


def test_every_setting_cites_its_paper():
    for paper in paper_files():
        for found in paper_settings(paper):
            assert re.match(rf"{paper} \d|{paper} Table \d", found.source), found.source
            assert found.settings
            assert found.scenes


def test_own_settings_count_after_the_paper():
    paper, settings = with_paper(["walk.confidence=1", "paper=K"], "push-step", "h1")
    assert paper == "K"
    assert settings.index("walk.confidence=0") < settings.index("walk.confidence=1")
    assert open_scene("push-step", ["walk.confidence=1", "paper=K"]).walk.confidence == 1.0


def test_each_robot_has_its_own_times():
    for robot, single in (("h1", 0.9), ("hrp2kai", 1.4)):
        assert open_scene("flat", ["paper=T"], robot).walk.single_support == single
        assert open_scene("flat", ["paper=T", f"robot={robot}"]).walk.single_support == single


@pytest.mark.parametrize(
    ("scene", "settings", "words"),
    [
        ("flat", ["paper=K"], "paper K states nothing of scene 'flat'; allowed: box-step"),
        ("force-tracking-1", ["paper=T"], "paper T states nothing of scene 'force-tracking-1'"),
        ("flat", ["paper=X"], "no paper is called 'X'; allowed: A, K, T"),
        ("flat", ["paper=T", "paper=K"], "papers K and T are given; allowed: one of them"),
    ],
)
def test_a_paper_that_states_nothing_is_refused(scene, settings, words):
    with pytest.raises(SceneError, match=re.escape(words)):
        open_scene(scene, settings)
