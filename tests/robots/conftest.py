"""Tests of robots share the one that is built in."""

import pytest

from plantar.robots import load_robot


@pytest.fixture(scope="session")
def h1():
    return load_robot("h1")
