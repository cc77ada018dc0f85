"""The tool that compares walks sees a difference where there is one."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

_PATH = Path(__file__).resolve().parents[2] / "tools" / "same_motion.py"


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("same_motion", _PATH)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_last_bit_of_one_number_is_seen(tool):
    walk = np.linspace(0.0, 1.0, 7)
    changed = walk.copy()
    changed[3] = np.nextafter(changed[3], 2.0)
    assert tool._digest([walk]) == tool._digest([walk.copy()])
    assert tool._digest([walk]) != tool._digest([changed])


def test_the_first_second_that_differs_is_named(tool):
    before = {"/joints": ["a", "b", "c"], "/skin/left": ["d"], "/zmp": ["e"]}
    after = {"/joints": ["a", "x", "y"], "/skin/left": ["d"], "/new": ["f"]}
    assert tool.differences(before, before) == []
    assert tool.differences(before, after) == ["/joints differs from second 1 on", "/zmp is gone"]


def test_a_walk_that_ends_sooner_differs(tool):
    assert tool.differences({"/joints": ["a", "b"]}, {"/joints": ["a"]}) == ["/joints differs from second 1 on"]
