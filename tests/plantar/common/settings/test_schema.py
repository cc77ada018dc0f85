"""Settings check themselves when they are made, say what they allow, and come from tables."""

import copy
import pickle
from dataclasses import MISSING, FrozenInstanceError, asdict, dataclass, field, fields, replace

import numpy as np
import pytest

from plantar.common.settings.body_scale import BodyScale
from plantar.common.settings.schema import Settings, choice, number, switch, tables, text, whole
from plantar.errors import InputError, SceneError


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


def test_values_take_the_type_of_their_default():
    spring = Spring(stiffness=3, coils=4.0)
    assert (spring.stiffness, type(spring.stiffness)) == (3.0, float)
    assert (spring.coils, type(spring.coils)) == (4, int)
    assert Spring(stiffness=np.float32(3), coils=np.int64(4)) == spring
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
def test_a_wrong_value_is_refused_wherever_it_comes_from(name, value, allowed):
    message = rf"'{name}' is .*; allowed: {allowed.replace('+', '.')}$"
    with pytest.raises(InputError, match=message):
        Spring(**{name: value})
    with pytest.raises(InputError, match=message):
        replace(Spring(), **{name: value})
    with pytest.raises(SceneError, match=r"^\[spring\] " + message):
        Spring.from_table({name: value}, "[spring]", SceneError)


def test_an_unknown_key_is_refused_with_the_nearest_right_one():
    with pytest.raises(InputError, match=r"^\[spring\] has an unknown key 'stifness'; nearest: stiffness; "):
        Spring.from_table({"stifness": 3.0}, "[spring]")
    with pytest.raises(InputError, match=r"unknown key 'place'"):
        Spring.from_table({"place": []}, "[spring]")
    with pytest.raises(InputError, match="is not a table"):
        Spring.from_table([1], "[spring]")


def test_each_setting_says_all_that_there_is_to_say():
    told = {s.name: s for s in Spring.described()}
    assert tuple(told) == Spring.names() == ("stiffness", "coils", "metal", "loaded", "label")
    assert told["stiffness"] == (
        "stiffness",
        "100",
        "N/m",
        "a number 1 to 1e+06",
        "Force for each metre, over two lines.",
        "",
    )
    assert told["metal"][1:4] == ('"steel"', "", "steel, brass")
    assert told["loaded"][1:4] == ("false", "", "true, false")


def test_no_upper_bound_is_said_in_words():
    class Open(Settings):
        size: float = number(1.0, "m")

    with pytest.raises(InputError, match="a finite number, 0 or more"):
        Open(size=float("inf"))
    assert Open(size=1e300).size == 1e300


def test_deriving_makes_a_frozen_dataclass_of_keyword_and_positional_fields():
    spring = Spring(7.0, 2)
    assert [f.name for f in fields(Spring)] == ["stiffness", "coils", "metal", "loaded", "label", "place"]
    assert (spring.stiffness, spring.coils, spring == Spring(coils=2, stiffness=7)) == (7.0, 2, True)
    assert hash(spring) == hash(Spring(7.0, 2))
    for name in ("stiffness", "anything"):
        with pytest.raises(FrozenInstanceError):
            setattr(spring, name, 3.0)


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s)), replace])
def test_a_copy_is_equal_and_frozen(again):
    spring = Spring(stiffness=3.0, metal="brass", place=(1.0, 2.0))
    other = again(spring)
    assert other == spring
    assert asdict(other) == asdict(spring)
    with pytest.raises(FrozenInstanceError):
        other.coils = 3


def test_a_class_between_inherits_settings_and_may_check_more():
    class Damped(Spring):
        """A spring with a damper.

        Attributes:
            damping: Force for each metre a second.
        """

        damping: float = number(1.0, "N s/m", 0.0, 10.0)

        def __post_init__(self) -> None:
            super().__post_init__()
            if self.damping > self.stiffness:
                raise InputError("it creeps")

    assert Damped.names() == (*Spring.names(), "damping")
    assert Damped.described()[-1].meaning == "Force for each metre a second."
    for wrong in ({"damping": 11.0}, {"stiffness": -1.0}, {"damping": 3.0, "stiffness": 2.0}):
        with pytest.raises(InputError):
            Damped(**wrong)
    assert Spring.names()[-1] == "label"


@pytest.mark.parametrize("options", [{}, {"frozen": True}, {"frozen": True, "slots": True}])
def test_a_decorator_that_could_undo_it_is_refused(options):
    class Decorated(Settings):
        size: float = number(1.0, "m", 0.0, 2.0)

    with pytest.raises(TypeError):
        dataclass(**options)(Decorated)


def test_every_class_of_settings_in_the_repository_checks_its_settings():
    import plantar.gait.controller
    import plantar.sim.run.scene

    assert plantar.gait.controller
    assert plantar.sim.run.scene
    kinds = [kind for kind in _derived(Settings) if kind.__module__.startswith("plantar.")]
    assert len(kinds) > 12
    for kind in kinds:
        for item in fields(kind):
            if "unit" in item.metadata:
                wrong = 3 if isinstance(item.default, str | tuple) else "wrong"
                with pytest.raises(InputError, match=item.name):
                    replace(_instance(kind), **{item.name: wrong})


def _derived(kind: type[Settings]) -> list[type[Settings]]:
    return [found for below in kind.__subclasses__() for found in (below, *_derived(below))]


def _instance(kind: type[Settings]) -> Settings:
    """One with defaults; what has none is 1."""
    return kind(**{f.name: 1.0 for f in fields(kind) if f.default is MISSING and f.default_factory is MISSING})


def test_a_word_may_stand_instead_of_a_number_or_a_list():
    class Drawn(Settings):
        mass: float | str = number(1.0, "kg", 0.5, 2.0, ("random",))
        place: tuple[float, ...] | str = tables("a list [x, y]", ("random",))

    assert (Drawn(mass="random").mass, Drawn(mass="1.5 kg").mass, Drawn(place="random").place) == (
        "random",
        1.5,
        "random",
    )
    assert [told.allowed for told in Drawn.described()] == [
        'a number 0.5 to 2 or "random"',
        'a list [x, y] or "random"',
    ]
    with pytest.raises(InputError, match=r"'mass' is 'ranndom'; allowed: a number 0.5 to 2 or \"random\"$"):
        Drawn(mass="ranndom")
    with pytest.raises(InputError, match="'place' is 'chance'; allowed: a list"):
        Drawn(place="chance")


def test_a_member_of_a_list_is_told_in_si_for_the_body():
    spring = Spring().for_body(BodyScale(30.0, 0.5, 0.1, 0.05))
    assert (spring.in_si("0.1 leg", "m"), spring.in_si(0.3, "m"), spring.in_si("left", "m")) == (0.05, 0.3, "left")
    with pytest.raises(InputError, match=r"a list holds '2 N'; allowed: a number in m$"):
        spring.in_si("2 N", "m")
