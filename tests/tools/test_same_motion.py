"""The tool that compares walks sees a difference where there is one."""

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


@pytest.mark.parametrize(("by", "lines"), [(0.5e-9, 0), (2e-9, 1), (np.nan, 1)])
def test_a_difference_beyond_1e_9_is_seen(tool, by, lines):
    walk = np.linspace(0.0, 1.0, 14).reshape(7, 2)
    changed = walk.copy()
    changed[3, 1] += by
    found = tool.differences({"/joints/angle": walk}, {"/joints/angle": changed, "/new/field": walk})
    assert len(found) == lines
    assert all("differs from row 3 on" in line for line in found)


def test_what_is_gone_or_shorter_differs(tool):
    walk = {"/zmp/x": np.zeros(3), "/skin/left": np.full(4, np.nan)}
    assert tool.differences(walk, walk) == []
    assert tool.differences(walk, {"/zmp/x": np.zeros(2)}) == ["/zmp/x has shape (2,), was (3,)", "/skin/left is gone"]


def test_large_numbers_are_compared_by_their_share(tool):
    assert tool.differences({"/force/z": np.array([1e4])}, {"/force/z": np.array([1e4 + 9e-6])}) == []
