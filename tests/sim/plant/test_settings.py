"""The `[plant]` table: what it takes, what `random` stands for, and what is refused."""

from dataclasses import replace

import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.errors import InputError, SceneError
from plantar.sim.plant.settings import RANDOM, Plant
from plantar.sim.run.scene import load_scene

SMALL = BodyScale(mass=3.0, leg=0.2, sole=0.1, sole_width=0.05)


def test_nothing_differs_by_default_and_everything_by_one_word():
    assert load_scene("flat").plant == Plant()
    drawn = load_scene("flat", ["plant=random", "plant.level=3"]).plant
    assert drawn.level == 3.0
    care = [name for name in drawn.items() if getattr(drawn, name) == RANDOM]
    assert (care[0], care[-1], len(care)) == ("gyro_bias", "actuation_delay", 11)
    every = load_scene("flat", ["plant=everything", "backlash=0"]).plant
    assert [name for name in every.items() if getattr(every, name) != RANDOM] == ["backlash"]


def test_what_is_stated_is_not_drawn_even_where_it_is_nominal():
    plant = load_scene("flat", ["plant=random", "mass_ratio=1", "com_offset=[]", "softness=0.02"]).plant
    assert (plant.mass_ratio, plant.com_offset, plant.softness) == (1.0, (), 0.02)
    assert replace(plant, level=1.0) == replace(plant.for_body(SMALL), level=1.0)
    assert replace(plant, level=1.0).mass_ratio == 1.0
    assert plant.crosstalk == plant.gyro_bias == RANDOM


def test_one_item_may_be_drawn_alone():
    plant = load_scene("flat", ["crosstalk=random", "level=1"]).plant
    assert [name for name in plant.items() if getattr(plant, name) == RANDOM] == ["crosstalk"]


def test_a_scene_file_states_it_as_a_word_or_as_a_table(tmp_path):
    word, table = tmp_path / "word.toml", tmp_path / "table.toml"
    word.write_text('plant = "random"\n[walk]\nsteps = 2\n')
    table.write_text('[walk]\nsteps = 2\n[plant]\ndraw = "random"\nmass_ratio = 1.1\n')
    assert load_scene(word).plant == Plant(draw=RANDOM)
    assert load_scene(word, ["mass_ratio=1.1"]).plant == load_scene(table).plant
    assert load_scene(word).setting_name("plant") == "plant.draw"


def test_a_list_is_in_metres_or_in_shares_of_the_body():
    plant = Plant(com_offset=(0.01, "1/30 leg", "-0.1 sole"))
    assert plant.vector("com_offset") == pytest.approx((0.01, 0.02, -0.1 * REFERENCE_BODY.sole))
    assert plant.for_body(SMALL).vector("com_offset") == pytest.approx((0.01, 0.2 / 30, -0.01))
    assert Plant().vector("gyro_bias") == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("setting", "allowed"),
    [
        ("plant=yes", "nominal, random, everything"),
        ("plant=[1]", "nominal, random, everything"),
        ("level=4", "a number 0 to 3"),
        ("mass_ratio=0.4", 'a number 0.5 to 2 or "random"'),
        ("stiffness_ratio=soft", 'a number 0.05 to 5 or "random"'),
        ("encoder_offset=true", 'a number 0 to 10 or "random"'),
        ("gyro_bias=0.01", 'a list [x, y, z] of -1 to 1 rad/s or "random"'),
        ("gyro_bias=[0.01, 0.01]", 'three numbers of -1 to 1 rad/s, or "random"'),
        ("gyro_bias=[0, 0, nan]", 'three numbers of -1 to 1 rad/s, or "random"'),
        ("com_offset=[0, 0.6, 0]", 'three numbers of -0.5 to 0.5 m, or "random"'),
        ('com_offset=[0, "1 N", 0]', "a number in m"),
        ("softness=1", 'a number 0 to 0.2 or "random"'),
    ],
)
def test_a_wrong_value_is_refused_in_one_line_with_what_is_allowed(setting, allowed):
    with pytest.raises(SceneError) as refused:
        load_scene("flat", [setting])
    message = str(refused.value)
    assert message.startswith("scene 'flat': [plant] '")
    assert message.endswith(f"allowed: {allowed}")
    assert "\n" not in message


def test_a_share_that_is_too_large_for_a_body_is_refused_for_it():
    plant = Plant(com_offset=(0.0, "0.6 leg", 0.0))
    assert plant.for_body(SMALL).vector("com_offset")[1] == pytest.approx(0.12)
    with pytest.raises(InputError, match="'com_offset'"):
        plant.for_body(BodyScale(95.0, 0.9, 0.3, 0.15)).vector("com_offset")
