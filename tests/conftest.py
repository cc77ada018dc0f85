"""What all tests share: soles to test on, and the switch to the real data."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from plantar import SoleLayout, hex_layout

# The machine that runs the tests may be slow or busy: an example that takes long is no failure.
settings.register_profile("plantar", deadline=None, max_examples=100, print_blob=True)
settings.load_profile("plantar")


@pytest.fixture(scope="session")
def repository() -> Path:
    """Root folder of the project."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Folder with real recordings, feet and robots, from PLANTAR_REAL_DATA; the test is skipped where it is not set."""
    folder = os.environ.get("PLANTAR_REAL_DATA")
    if not folder:
        pytest.skip("PLANTAR_REAL_DATA is not set: no real data to test on")
    assert Path(folder).is_dir(), f"PLANTAR_REAL_DATA is {folder}, which is no folder"
    return Path(folder)


@pytest.fixture(scope="session")
def sole() -> SoleLayout:
    """A foot-shaped sole: a rounded outline of 240 x 100 mm with a waist, its cells clipped."""
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    x = 0.12 * np.cos(angle)
    y = 0.05 * np.sin(angle) * (1.0 - 0.25 * np.exp(-((x / 0.04) ** 2)))
    return hex_layout(np.column_stack([x, y]), name="test sole", cell_area=200e-6)
