"""Tests of robots share the one that is built in."""

from __future__ import annotations

import pytest

from plantar.robots import Robot, load_robot


@pytest.fixture(scope="session")
def h1() -> Robot:
    return load_robot("h1")
