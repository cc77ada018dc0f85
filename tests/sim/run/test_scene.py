import pytest

from plantar.common.settings.body_scale import BodyScale
from plantar.errors import SceneError
from plantar.gait.propose.velocity_command import Velocity
from plantar.sim.run.run_summary import shares_of
from plantar.sim.run.scene import builtin_scenes, load_scene
from plantar.sim.run.scene_kind import open_scene
from plantar.sim.terrain import Beam


@pytest.mark.parametrize("name", builtin_scenes())
def test_every_built_in_scene_loads_with_a_description(name):
    scene = open_scene(name)
    assert scene.name == name
    assert scene.description


def test_settings_override_by_section_bare_name_and_alias():
    scene = load_scene("flat", ["walk.steps=4", "feedback=false", "t_ss=1.1", "noise=0", "robot=h1"])
    assert scene.walk.steps == 4
    assert not scene.control.feedback
    assert scene.walk.single_support == 1.1
    assert scene.sensing.force_noise == 0.0


@pytest.mark.parametrize(
    ("setting", "word"),
    [
        ("steps", "key=value"),
        ("=4", "key=value"),
        ("walk.nothing=1", "no such key"),
        ("nothing=1", "no such key"),
        ("steps=many", "steps"),
        ("steps=-1", "0 to"),
        ("friction=0", "friction"),
        ("direction=up", "forward"),
    ],
)
def test_bad_settings_give_one_line(setting, word):
    with pytest.raises(SceneError, match=word) as caught:
        load_scene("flat", [setting])
    assert "\n" not in str(caught.value)


def test_a_scene_file_of_ones_own(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('robot = "h1"\n[walk]\nsteps = 2\n')
    scene = load_scene(path)
    assert (scene.name, scene.walk.steps) == ("mine", 2)
    path.write_text("[wolk]\nsteps = 2\n")
    with pytest.raises(SceneError, match=r"wolk.*allowed.*walk"):
        load_scene(path)
    path.write_text("steps = = 2\n")
    with pytest.raises(SceneError, match="not valid TOML"):
        load_scene(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="not valid TOML"):
        load_scene(path)


@pytest.mark.parametrize("name", ["nowhere", "../flat", "missing.toml", ""])
def test_unknown_scenes_list_the_known_ones_or_name_the_file(name):
    with pytest.raises(SceneError, match=r"flat|missing\.toml"):
        load_scene(name)


def test_a_key_of_two_sections_has_to_say_which():
    with pytest.raises(SceneError, match=r"allowed: terrain\.step, push\.step"):
        load_scene("partial-rear", ["step=1"])
    assert load_scene("partial-rear", ["push.step=1"]).push.step == 1


def test_a_kind_of_ground_that_is_no_text_is_refused(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbf" + b'[terrain]\nkind = ["flat"]\n')  # a byte order mark is no error
    with pytest.raises(SceneError, match=r"terrain\.kind is \['flat'\]; allowed: flat"):
        load_scene(path)


def test_a_setting_has_one_full_name():
    scene = load_scene("beam")
    names = {"t_ss": "walk.single_support", "kind": "terrain.kind", "width": "terrain.width", "robot": "robot"}
    assert {key: scene.setting_name(key) for key in names} == names
    assert scene.setting_name("push.impulse") == scene.setting_name("impulse") == "push.impulse"
    with pytest.raises(SceneError, match="no setting"):
        load_scene("flat").setting_name("width")


@pytest.mark.parametrize("text", ["", "# nothing\n", 'robot = "h1"\n', 'name = "mine"\n[push]\nimpulse = 20.0\n'])
def test_a_file_that_names_neither_ground_nor_gait_is_no_scene(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(SceneError, match=r"needs \[terrain\] or \[walk\]"):
        load_scene(path, ["steps=2"])
    path.write_text(text.split("[push]")[0] + "[walk]\nsteps = 3\n")
    assert load_scene(path).walk.steps == 3


def test_a_scene_grows_with_the_robot():
    body = BodyScale(mass=11.0, leg=0.3, sole=0.12, sole_width=0.08)
    beam = load_scene("beam", ["terrain.start=0.2", "walk.start=2 beat"]).for_body(body)
    assert isinstance(beam.terrain, Beam)
    assert (beam.terrain.width, beam.terrain.start) == (pytest.approx(0.48 * 0.12), 0.2)
    assert (beam.walk.sideways, beam.walk.start) == pytest.approx((0.04, 2.0 * body.beat))
    turn = load_scene("turn").for_body(body).walk.velocities(0)
    assert turn.commands[0] == Velocity(turn=0.0495 * (1.0 / body.beat))
    shares = shares_of(beam)
    assert shares["terrain.width"] == {"share": "0.48 sole", "value": 0.0576, "unit": "m"}
    assert "terrain.start" not in shares


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("walk.length=1 legs", "no unit 'legs'"),
        ("walk.length=1 weight", "weight is no unit of it"),
        ("push.dv=0.1 leg", "leg is no unit of it"),
        ('velocity=["1 leg", 0, 0]', "'1 leg'; allowed: a number in m/s"),
    ],
)
def test_a_share_of_something_else_is_refused(setting, words):
    with pytest.raises(SceneError, match=words):
        load_scene("flat", [setting])


def test_a_share_that_a_robot_makes_too_large_is_refused():
    scene = load_scene("flat", ["walk.length=0.8 leg"])
    with pytest.raises(SceneError, match=r"\[walk\] 'length' is '0.8 leg' = 0.72 m; allowed: .*with robot 'h1'"):
        scene.for_body(BodyScale(mass=95.0, leg=0.9, sole=0.3, sole_width=0.2))
