"""No public function takes a wrong argument in silence, or answers it with anything but one line of Plantar's own."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import plantar
from plantar.errors import InputError

from ...examples import examples
from .arguments import MEMBERS, complaint, same_answer
from .public_calls import INNER, ROOMS, Argument, Call, array_functions, public_calls

CALLS = {call.name: call for call in public_calls()}
ARRAYS = [(name, array) for name, call in CALLS.items() for array in call.arrays]


def test_every_public_function_that_takes_arrays_has_a_call():
    found = set(array_functions())
    assert found - CALLS.keys() - INNER == set(), "give each a call in public_calls.py"
    assert found >= INNER, "names of functions that are gone"
    assert not CALLS.keys() & INNER


def test_what_the_package_exports_lies_in_the_rooms_that_are_walked():
    doors = {"read", "analyse", "analyze", "sole", "view", "mujoco", "run"}
    doors |= {"load_robot", "load_controller", "load_scene", "calibrate"}
    for name in {*plantar.__all__} - doors:
        module = getattr(getattr(plantar, name), "__module__", "plantar.errors") or "plantar.errors"
        assert module.split(".")[1] in (*ROOMS, "errors", "layouts", "batch"), name


@pytest.mark.parametrize("name", CALLS)
def test_a_right_call_answers_the_same_each_time(name):
    assert same_answer(CALLS[name](), CALLS[name]())


@pytest.mark.parametrize("name", CALLS)
def test_an_eighth_of_the_wrong_arguments(name):
    turn = list(CALLS).index(name)
    faults = [
        (array, member, fault)
        for i, array in enumerate(CALLS[name].arrays)
        for k, member in enumerate(MEMBERS)
        if (i + k + turn) % 8 == 0 and (fault := complaint(CALLS[name], array, member, np.random.default_rng(k)))
    ]
    assert faults == []


@pytest.mark.long
@pytest.mark.parametrize(("name", "array"), ARRAYS)
def test_all_wrong_arguments(name, array):
    faults = {m: fault for m in MEMBERS if (fault := complaint(CALLS[name], array, m, np.random.default_rng(1)))}
    assert faults == {}


@given(st.sampled_from(ARRAYS), st.sampled_from(sorted(MEMBERS)), st.integers(0, 2**32 - 1))
@examples(100)
def test_any_wrong_argument(place, member, seed):
    name, array = place
    assert complaint(CALLS[name], array, member, np.random.default_rng(seed)) is None


def fake(function: Callable[[Any], Any], nan: bool = False) -> Call:
    return Call(
        "fake.function", lambda forces: function(forces), {"forces": Argument(np.arange(3.0), (3,), "force", nan)}
    )


def raising(error: Exception) -> Callable[[Any], Any]:
    def function(forces: Any) -> Any:
        raise error

    return function


@pytest.mark.parametrize(
    ("function", "member", "words"),
    [
        (raising(TypeError("numpy's words")), "text", "raises TypeError: numpy's words"),
        (raising(InputError("forces are\nbad")), "text", "is no line"),
        (raising(InputError("something is wrong")), "text", "does not name the argument"),
        (raising(InputError("forces are refused")), "float32", "the same numbers are refused"),
        (lambda forces: 1.0, "text", "answers '1.0'"),
        (lambda forces: np.sum(forces), "column", "answers '3.0'"),
        (lambda forces: np.sum(forces), "NaN", "answers 'nan'"),
        (lambda forces: np.asarray(forces).dtype.str, "other byte order", None),
        (lambda forces: np.asarray(forces).strides[0] + 0.0, "stride", "otherwise"),
        (lambda forces: np.log(np.asarray(forces) - 1e9), "list", "raises RuntimeWarning"),
    ],
)
def test_faults_are_found(function, member, words):
    fault = complaint(fake(function), "forces", member, np.random.default_rng(0))
    assert fault is None if words is None else words in str(fault)


def test_a_shape_fits_by_itself_and_with_the_others():
    frames = Argument(np.zeros((4, 3)), (..., "n"), "force")
    call = Call("fake", lambda **_: None, {"a": frames, "b": Argument(np.zeros((3, 6)), ("n", 6), "wrench")})
    assert call.taken("a", (3,))
    assert call.taken("a", (2, 5, 3))
    assert not call.taken("a", (4,))
    assert not call.taken("b", (3, 5))
    assert not call.taken("b", (3,))
    assert Argument(np.zeros((4, 2)), ("k", 2), "points").fits((0,))
    assert not Argument(np.zeros((4, 2)), ("k", 2), "points", least=3).fits((0,))
