"""Where a foot comes from: one source at a time, and options that its kind knows."""

from itertools import combinations
from pathlib import Path

import pytest

from plantar.errors import InputError
from plantar.shoes.foot.source import foot_of_robot, read_foot
from plantar.shoes.order import FootSource

SOURCES = {"file": Path("foot.stl"), "robot": "h1", "dimensions": "240x95"}


def read(**source):
    return read_foot(FootSource(**source), sole_band=5.0)


def test_none_or_more_than_one_source_is_refused():
    for count in (0, 2, 3):
        for names in combinations(SOURCES, count):
            with pytest.raises(InputError, match="give one of"):
                read(**{name: SOURCES[name] for name in names})


@pytest.mark.parametrize("option", ["mesh_side", "unit", "up", "forward"])
@pytest.mark.parametrize("source", ["robot", "dimensions"])
def test_a_word_that_an_option_does_not_know_is_refused_whatever_the_source(option, source):
    with pytest.raises(InputError, match=f"--{option.replace('_', '-')} is 'sideways'; allowed: "):
        read(**{source: SOURCES[source], option: "sideways"})


@pytest.mark.parametrize("option", ["body", "sole_z", "up", "forward", "unit", "mesh_side"])
@pytest.mark.parametrize("source", ["robot", "dimensions"])
def test_an_option_of_files_is_refused_where_there_is_none(option, source):
    value = {"body": "foot", "sole_z": 5.0, "up": "x", "forward": "y", "unit": "in", "mesh_side": "right"}[option]
    name = option.replace("_", "-")
    with pytest.raises(InputError, match=f"--{name} is for a file of the foot; --{source} needs none"):
        read(**{source: SOURCES[source], option: value})


def test_a_box_that_is_wider_than_long_is_refused():
    with pytest.raises(InputError, match="--dimensions is '95x240', wider than long"):
        read(dimensions="95x240")


def test_a_box_has_the_size_that_is_written():
    foot, taxels = read(dimensions="240x95X10")
    low_x, low_y, high_x, high_y = foot.sole.bounds
    assert taxels is None
    assert (high_x - low_x, high_y - low_y) == pytest.approx((240.0, 95.0))
    assert foot.sole.area == pytest.approx(240 * 95 - (4 - 3.14159) * 10**2, rel=1e-3)


def test_a_robots_foot_is_the_same_by_either_way():
    foot, taxels = foot_of_robot("h1")
    again, same = read(robot="h1")
    assert taxels == same == 42
    assert again.sole.equals(foot.sole)
    assert (again.name, again.mass, again.notes) == (foot.name, foot.mass, foot.notes)


@pytest.mark.parametrize(
    ("name", "side"),
    [("sole_right", "right"), ("R-foot", "right"), ("left", "left"), ("foot_r2", None), ("sole", None)],
)
def test_the_side_is_that_of_the_files_name_or_assumed_with_a_note(name, side, tmp_path):
    def foot(name, **options):
        file = tmp_path / f"{name}.geojson"
        file.write_text(
            '{"type": "Polygon", "coordinates": [[[-70, -30], [120, -30], [140, 10], [-70, 30], [-70, -30]]]}'
        )
        return read(file=file, **options)[0]

    found, given = foot(name), foot("sole", mesh_side=side or "left")
    assert found.sole.equals(given.sole)
    assert any("taken to be a left foot" in note for note in found.notes) == (side is None)
    assert not any("taken to be a left foot" in note for note in given.notes)


@pytest.mark.parametrize(("body", "noted"), [("fuss_rechts", True), ("right_foot", False), ("l_foot", False)])
def test_the_side_of_a_robots_foot_is_that_of_its_name_or_assumed_with_a_note(body, noted, tmp_path):
    pytest.importorskip("mujoco")
    file = tmp_path / "robot.xml"
    shape = "<geom type='box' size='.1 .04 .02' pos='.03 0 -.08'/>"
    file.write_text(f"<mujoco><worldbody><body name='{body}'>{shape}</body></worldbody></mujoco>")
    notes = read(file=file, body=body)[0].notes
    assert any("taken to be a left foot" in note for note in notes) == noted
