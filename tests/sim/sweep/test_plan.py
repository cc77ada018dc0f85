"""What a sweep refuses before its first run, and what it takes for the same."""

import pytest

from plantar.errors import InputError, RobotError, SceneError
from plantar.sim.sweep import Sweep


@pytest.mark.parametrize(
    ("grid", "settings", "error", "words"),
    [
        (["impulse"], [], InputError, "key=a,b,c"),
        (["impulse="], [], InputError, "key=a,b,c"),
        (["=1"], [], InputError, "key=a,b,c"),
        (["impulse=20,30,"], [], InputError, "empty"),
        (["nothing=1,2"], [], SceneError, "nothing"),
        (["impulse=1,x"], [], SceneError, "impulse"),
        (["feedback=true,True"], [], SceneError, "allowed: true, false"),
        (["impulse=20,30,20"], [], InputError, "20, 20"),
        (["steps=1.0,1"], [], InputError, "1.0, 1"),
        (["friction=0.10,0.1"], [], InputError, "0.10, 0.1"),
        (["direction=left,'left'"], [], InputError, "left, 'left'"),
        (["impulse=1", "impulse=2"], [], InputError, "push.impulse"),
        (["t_ss=1,2", "single_support=3"], [], InputError, "walk.single_support"),
        (["impulse=20,30"], ["push.impulse=10"], InputError, "--set"),
        (["steps=20,30"], ["impulse=10", "walk.steps=1"], InputError, "--set"),
        (["robot=h1,hrp2kai"], ["robot=h1"], InputError, "--set"),
        (["robot=h1,nobody"], [], RobotError, "unknown robot 'nobody'"),
    ],
)
def test_bad_grids_are_refused_before_the_first_run(grid, settings, error, words):
    with pytest.raises(error) as caught:
        Sweep.from_texts("push", grid, 1, None, settings)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_numbers_of_seeds_and_robots_that_are_none_are_refused():
    with pytest.raises(InputError, match="1 to 1000000"):
        Sweep("push", (), 0)
    with pytest.raises(InputError, match="first seed is -1; allowed: 0 to"):
        Sweep("push", (), 1, first_seed=-1)
    with pytest.raises(RobotError, match="unknown robot 'nobody'"):
        Sweep("flat", (), 1, "nobody")
    with pytest.raises(InputError, match="--robot"):
        Sweep("flat", (("robot", ("h1", "hrp2kai")),), 1, "h1")


def test_two_names_of_one_robot_are_one_point(repository):
    file = str(repository / "plantar" / "robots" / "h1" / "robot.toml")
    with pytest.raises(InputError, match="same run"):
        Sweep("flat", (("robot", ("h1", file)),))


def test_values_are_kept_in_one_form_and_lists_stay_whole():
    sweep = Sweep.from_texts("flat", ["friction=0.70, 8e-1", "lean=true,false"], 1)
    assert sweep.grid == (("friction", ("0.7", "0.8")), ("lean", ("true", "false")))
    assert len(sweep.points()) == 4
    stone = "[{size = [1, 1, 0.1], position = [0, 0, -0.1]}]"
    sweep = Sweep.from_texts("flat", [f"solid=[],{stone}"], 1, None, ["kind=course"])
    assert len(sweep.points()) == 2
    assert "size" in sweep.points()[1][0]


def test_seeds_begin_at_the_first_seed():
    sweep = Sweep.from_texts("push", ["impulse=20,30"], 2, first_seed=1000)
    assert list(sweep.runs({})) == [((f"impulse={i}",), seed) for seed in (1000, 1001) for i in (20, 30)]
