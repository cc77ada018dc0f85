"""Settings check themselves when they are made, say what they allow, and come from tables."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from plantar.errors import InputError, SceneError
from plantar.settings.schema import Settings, choice, number, switch, text, whole


@dataclass(frozen=True)
class Spring(Settings):
    """A spring.

    Attributes:
        stiffness: Force for each metre,
            over two lines.
        coils: How many coils.
        metal: What it is made of.
        loaded: Whether it carries.
        label: What is written on it.
        place: Where it is; no setting.
    """

    stiffness: float = number(100.0, "N/m", 1.0, 1e6)
    coils: int = whole(5, "coils", 1, 50)
    metal: str = choice("steel", "brass")
    loaded: bool = switch(False)
    label: str = text("")
    place: tuple[float, ...] = field(default=())


def test_values_take_the_type_of_their_default() -> None:
    spring = Spring(stiffness=3, coils=4.0)  # type: ignore[arg-type]
    assert (spring.stiffness, type(spring.stiffness)) == (3.0, float)
    assert (spring.coils, type(spring.coils)) == (4, int)
    assert Spring.from_table({"metal": "brass"}, "[spring]") == Spring(metal="brass")


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("stiffness", 0.5, "a number 1 to 1e+06"),
        ("stiffness", float("nan"), "a number 1 to 1e+06"),
        ("stiffness", float("inf"), "a number 1 to 1e+06"),
        ("stiffness", True, "a number 1 to 1e+06"),
        ("stiffness", "3", "a number 1 to 1e+06"),
        ("stiffness", None, "a number 1 to 1e+06"),
        ("coils", 2.5, "a whole number 1 to 50"),
        ("metal", "Steel", "steel, brass"),
        ("metal", ["steel"], "steel, brass"),
        ("loaded", 1, "true, false"),
        ("label", 3, "a text"),
    ],
)
def test_a_wrong_value_is_refused_wherever_it_comes_from(name: str, value: Any, allowed: str) -> None:
    message = rf"'{name}' is .*; allowed: {allowed.replace('+', '.')}$"
    with pytest.raises(InputError, match=message):
        Spring(**{name: value})
    with pytest.raises(InputError, match=message):
        replace(Spring(), **{name: value})
    with pytest.raises(SceneError, match=r"^\[spring\] " + message):
        Spring.from_table({name: value}, "[spring]", SceneError)


def test_an_unknown_key_is_refused_with_the_nearest_right_one() -> None:
    with pytest.raises(InputError, match=r"^\[spring\] has an unknown key 'stifness'; nearest: stiffness; "):
        Spring.from_table({"stifness": 3.0}, "[spring]")
    with pytest.raises(InputError, match=r"unknown key 'place'"):
        Spring.from_table({"place": []}, "[spring]")
    with pytest.raises(InputError, match="is not a table"):
        Spring.from_table([1], "[spring]")


def test_each_setting_says_all_that_there_is_to_say() -> None:
    told = {s.name: s for s in Spring.described()}
    assert tuple(told) == Spring.names() == ("stiffness", "coils", "metal", "loaded", "label")
    assert told["stiffness"] == (
        "stiffness",
        "100",
        "N/m",
        "a number 1 to 1e+06",
        "Force for each metre, over two lines.",
    )
    assert told["metal"][1:4] == ('"steel"', "", "steel, brass")
    assert told["loaded"][1:4] == ("false", "", "true, false")


def test_no_upper_bound_is_said_in_words() -> None:
    @dataclass(frozen=True)
    class Open(Settings):
        size: float = number(1.0, "m")

    with pytest.raises(InputError, match="a finite number, 0 or more"):
        Open(size=float("inf"))
    assert Open(size=1e300).size == 1e300
