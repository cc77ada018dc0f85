"""Synthetic walks whose events and measures are known in closed form."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from plantar import SoleLayout, hex_layout, mirrored
from plantar.layouts.layout import Side
from plantar.recordings.pressure_recording import FootRecording, PressureRecording


@dataclass(frozen=True)
class Walk:
    """A robot that stands, walks and stands again, with the truth of its contacts."""

    recording: PressureRecording
    touchdowns: dict[str, list[float]]
    liftoffs: dict[str, list[float]]
    weight: float


def sole() -> SoleLayout:
    """A sole of 0.24 x 0.14 m with cells of 691 mm^2."""
    return hex_layout([[-0.08, -0.07], [0.16, -0.07], [0.16, 0.07], [-0.08, 0.07]], name="test sole")


def make_walk(*, steps=10, rate=250.0, noise=0.0, clip=False, rise=0.012, weight=843.7, seed=0):
    """Single support 0.9 s, double support 0.3 s, standing before and after; the landing carries half the weight."""
    random = np.random.default_rng(seed)
    single, double, start = 0.9, 0.3, 1.5137
    end = start + steps * (single + double) + 1.5
    time = np.arange(0.0, end, 1.0 / rate)
    share = {"left": np.full(len(time), 0.5), "right": np.full(len(time), 0.5)}
    touchdowns: dict[str, list[float]] = {"left": [], "right": []}
    liftoffs: dict[str, list[float]] = {"left": [], "right": []}
    for k in range(steps):
        swing, stance = ("left", "right") if k % 2 == 0 else ("right", "left")
        off = start + k * (single + double)
        on = off + single
        liftoffs[swing].append(off)
        touchdowns[swing].append(on)
        before = (time >= off - 0.1) & (time < off)
        share[swing] = np.where(before, 0.5 * (off - time) / 0.1, share[swing])
        share[stance] = np.where(before, 1.0 - share[swing], share[stance])
        air = (time >= off) & (time < on)
        share[swing] = np.where(air, 0.0, share[swing])
        share[stance] = np.where(air, 1.0, share[stance])
        landing = (time >= on) & (time < on + rise)
        share[swing] = np.where(landing, 0.5 * (time - on) / rise, share[swing])
        share[stance] = np.where(landing, 1.0 - share[swing], share[stance])
    layout = sole()
    feet: dict[Side, FootRecording] = {}
    for side, own in (("left", layout), ("right", mirrored(layout))):
        force = weight * share[side][:, None] * (layout.areas / layout.areas.sum())
        force = force + random.normal(0.0, noise, force.shape) if noise else force
        feet[own.side] = FootRecording(own.side, np.maximum(force, 0.0) if clip else force, own)
    recording = PressureRecording(Path("walk"), "synthetic", rate, time, feet, kind="robot")
    return Walk(recording, touchdowns, liftoffs, weight)


@pytest.fixture
def walk():
    """Maker of synthetic walks."""
    return make_walk


@pytest.fixture(autouse=True)
def _quick_figures(quick_figures):
    """Of all analyses here."""
