"""The dimensions of a generated biped, checked however they are made."""

from dataclasses import asdict, replace

import pytest

from plantar.errors import RobotError
from plantar.robots import load_robot
from plantar.robots.biped import BipedParameters

H1 = load_robot("h1").biped
assert H1 is not None


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"hip_offset": (0.0, 0.1)}, "hip_offset needs 3 number"),
        ({"thigh_length": (0.4,)}, "thigh_length needs 1 number"),
        ({"armature": float("nan")}, "armature holds a value that is not a finite number"),
        ({"joint_lower": ("a",) * 6}, "joint_lower holds a value that is not a finite number"),
    ],
)
def test_wrong_dimensions_are_refused_when_they_are_made(bad, message):
    with pytest.raises(RobotError, match=message):
        replace(H1, **bad)
    table = {key: list(value) if isinstance(value, tuple) else value for key, value in {**asdict(H1), **bad}.items()}
    with pytest.raises(RobotError, match=rf"my robot: \[biped\] {message}"):
        BipedParameters.from_table(table, "my robot")


def test_a_table_gives_the_same_dimensions():
    table = {key: list(value) if isinstance(value, tuple) else value for key, value in asdict(H1).items()}
    assert BipedParameters.from_table(table, "my robot") == H1
