from dataclasses import dataclass, field
from typing import Any

import pytest

from plantar.errors import SceneError
from sim.table import from_table, limits


@dataclass(frozen=True)
class Example:
    count: int = field(default=3, metadata=limits(0, 10))
    size: float = field(default=0.5, metadata=limits(0.0, 1.0))
    kind: str = field(default="a", metadata={"choices": ("a", "b")})
    on: bool = True


def test_values_take_the_field_types() -> None:
    made = from_table(Example, {"count": 4.0, "size": 1, "kind": "b", "on": False}, "t")
    assert made == Example(4, 1.0, "b", False)
    assert isinstance(made.count, int)
    assert isinstance(made.size, float)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"count": 11}, ("count", "11", "0 to 10")),
        ({"count": 2.5}, ("count", "whole")),
        ({"count": True}, ("count",)),
        ({"size": float("nan")}, ("size", "nan")),
        ({"size": "x"}, ("size", "'x'")),
        ({"kind": "c"}, ("kind", "a, b")),
        ({"on": 1}, ("on", "true, false")),
        ({"colour": 1}, ("colour", "count, size, kind, on")),
        ([1], ("table",)),
    ],
)
def test_each_error_names_the_key_and_what_is_allowed(table: Any, words: tuple[str, ...]) -> None:
    with pytest.raises(SceneError) as caught:
        from_table(Example, table, "[table] of t")
    text = str(caught.value)
    assert all(word in text for word in words)
    assert "\n" not in text
