from fractions import Fraction

import numpy as np
import pytest

import plantar
from plantar.common.arguments import instance, integer, items, number
from plantar.errors import InputError, LayoutError


@pytest.mark.parametrize("value", [1, 1.0, True, np.float32(1), np.int8(1), np.array(1.0), Fraction(1), np.True_])
def test_numbers_of_every_kind(value):
    if isinstance(value, Fraction):  # numpy holds it as an object
        with pytest.raises(InputError):
            number(value, "gain")
        return
    assert number(value, "gain") == 1.0
    assert isinstance(number(value, "gain"), float)


@pytest.mark.parametrize("value", [None, "1", b"1", 1j, [1.0], np.zeros(1), np.zeros(2), {}, 10**400, np.ma.masked])
def test_what_is_no_number_is_refused(value):
    with pytest.raises(InputError, match=r"^gain is .*; expected a number$"):
        number(value, "gain")


def test_a_number_says_whether_it_may_be_nan_or_infinite():
    assert number(np.inf, "gain") == np.inf
    assert np.isnan(number(np.nan, "gain", nan=True))
    for value in (np.inf, -np.inf, 1e101):
        with pytest.raises(InputError, match="expected a finite number"):
            number(value, "gain", finite=True)
    with pytest.raises(InputError, match="gain is NaN"):
        number(np.nan, "gain")


@pytest.mark.parametrize("value", [-1, 10, 1.0, "1", None, True, np.bool_(True), [1], 10**30])
def test_whole_numbers_in_a_range(value):
    assert integer(np.uint8(9), "frame", 0, 9) == 9
    with pytest.raises(InputError, match=r"^frame is .*; allowed: a whole number, 0 to 9$"):
        integer(value, "frame", 0, 9)


def test_things_in_a_row():
    assert items((p for p in "ab"), "poses") == ("a", "b")
    with pytest.raises(InputError, match=r"^poses is None; expected a list$"):
        items(None, "poses")


def test_an_object_is_of_its_class():
    assert instance("a", str, "name") == "a"
    with pytest.raises(LayoutError, match=r"^layout is an array of shape \(2,\); expected a str$"):
        instance(np.zeros(2), str, "layout", LayoutError)
    with pytest.raises(InputError, match=r"^layout is a str; expected a int$"):
        instance("long" * 100, int, "layout")


@pytest.mark.parametrize(
    ("door", "arguments", "words"),
    [
        ("read", (None,), "recording is None; expected a path"),
        ("load_robot", (3,), "robot is 3; expected a path"),
        ("load_scene", (["flat"],), "expected a path"),
        ("view", (None,), "recordings is None; expected a list"),
        ("run", ("flat", -1), "seed is -1; allowed: a whole number, 0 or more"),
        ("run", ("flat", 1.5), "seed is 1.5"),
        ("run", (None,), "scene is None; expected a path"),
        ("load_scene", ("flat", [3]), "setting 3 is not of the form key=value"),
        ("load_controller", ("h1", [1]), "tables is a list; expected a Mapping"),
    ],
)
def test_doors_refuse_what_is_no_path_or_seed(door, arguments, words):
    with pytest.raises(plantar.PlantarError, match=words):
        getattr(plantar, door)(*arguments)
