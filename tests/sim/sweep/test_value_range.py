"""Values of a grid: cut where they end, and written in one way."""

import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.errors import InputError
from plantar.sim.sweep.value_range import canonical, split_values

LETTERS = st.characters(min_codepoint=32, max_codepoint=0x2FFF, exclude_categories=("Cs", "Cc"))
TEXTS = st.text(LETTERS, max_size=8).filter(str.isprintable)
VALUES = st.recursive(
    st.booleans() | st.integers(-(2**40), 2**40) | st.floats(allow_nan=False, allow_infinity=False) | TEXTS,
    lambda inner: st.lists(inner, max_size=3),
    max_leaves=5,
)


def toml(value: Any) -> str:
    """A TOML text of a value, by other means than the code's."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ",".join(map(toml, value)) + "]"
    return repr(value)


def meaning(text: str) -> Any:
    """What a setting takes a text for, as `plantar.sim.run.scene.override` does."""
    try:
        return tomllib.loads(f"v = {text}")["v"]
    except tomllib.TOMLDecodeError:
        return text


@given(VALUES)
def test_a_value_keeps_its_meaning_and_has_one_form(value):
    once = canonical(toml(value))
    assert meaning(once) == value
    assert canonical(once) == once
    assert canonical(f"  {toml(value)} ") == once


@given(st.lists(VALUES, min_size=1, max_size=4))
def test_a_list_is_cut_where_its_values_end(values):
    assert split_values(" , ".join(map(toml, values))) == [toml(v) for v in values]


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("20,30", ["20", "30"]),
        ("[1, 2],[3, 4]", ["[1, 2]", "[3, 4]"]),
        ("it's, left", ["it's", "left"]),
        ("a[1].toml,b", ["a[1].toml", "b"]),
        ('{a = "x,y"}, "\\",", \'\\\'', ['{a = "x,y"}', '"\\","', "'\\'"]),
    ],
)
def test_brackets_and_quotes_hold_their_commas(text, values):
    assert split_values(text) == values


@pytest.mark.parametrize("text", ["", ",", "1,", "1,,2", "[1, 2", '"a', "{a = 1", "[[1]"])
def test_what_has_no_end_or_no_value_is_refused(text):
    with pytest.raises(InputError):
        split_values(text)


@pytest.mark.parametrize("text", ["[1, x]", '"a" b', "{a}", "a\nb", "1\n2"])
def test_what_is_no_value_is_refused(text):
    with pytest.raises(InputError) as caught:
        canonical(text)
    assert "\n" not in str(caught.value)


def test_a_word_keeps_its_text():
    assert [canonical(t, word=True) for t in ("1.0", '"h1"', "my robot.toml", "0x10")] == [
        "1.0",
        "h1",
        "my robot.toml",
        "0x10",
    ]
