"""Made walks in two 99-cell insoles whose every property is chosen: for tests of what recordings may be like."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.formats.nominal_insole import nominal_insole
from plantar.recordings.pressure_recording import FootRecording, PressureRecording


@dataclass(frozen=True, eq=False)
class MadeWalk:
    """A recording and what is true of it.

    Attributes:
        recording: The recording.
        strikes: Heel strikes of each foot in s.
        lifts: Toe offs of each foot in s.
    """

    recording: PressureRecording
    strikes: dict[Side, NDArray[np.float64]]
    lifts: dict[Side, NDArray[np.float64]]


def two_humps(share: NDArray[np.float64], first: float = 1.1, valley: float = 0.75, second: float = 1.15) -> NDArray:
    """Force over the stance (share 0 to 1) in body weights: humps at 22 and 78 %, a valley between; 0 outside."""
    at = np.array([0.0, 0.05, 0.12, 0.22, 0.35, 0.5, 0.65, 0.78, 0.9, 0.96, 1.0])
    high = np.array([0.0, 0.3, 0.8, 1.0, 0.9, 1.0, 0.9, 1.0, 0.55, 0.2, 0.0])
    gain = np.interp(at, [0.0, 0.22, 0.5, 0.78, 1.0], [first, first, valley, second, second])
    return np.where((share > 0.0) & (share < 1.0), np.interp(share, at, high * gain), 0.0)


def made_walk(
    *,
    strides=9,
    stride=1.1,
    stance=0.62,
    weight=700.0,
    rate=100.0,
    offset=0.0,
    drift=0.0,
    crease=(),
    crease_force=20.0,
    noise=0.0,
    gains=None,
    slow_ends=1.0,
    forefoot=1.0,
    roll=((0.0, 0.15), (1.0, 0.85)),
    humps=(1.1, 0.75, 1.15),
    seed=0,
    layouts=None,
):
    """A walk from heel to toe.

    Args:
        strides: Contacts of each foot.
        stride: Stride time in s.
        stance: Contact time as a share of the stride.
        weight: Body weight in N.
        rate: Frames a second.
        offset: What each foot's cells read together in swing in N, unevenly over the cells.
        drift: By how much that rises until the end in N.
        crease: Cells that a crease loads in swing by `crease_force` and under load by little more.
        crease_force: That force in N.
        noise: Standard deviation of a cell's force in N.
        gains: Force of each stride relative to the others.
        slow_ends: How many times longer the first and the last contact of each foot are.
        forefoot: Pressure of the front half relative to the hind half's.
        roll: Where the load is over the stance: shares of the stance, and of the sole's length from the heel.
        humps: First peak, valley and second peak of the force in body weights.
        seed: Of noise and offsets.
        layouts: Other soles than 99-cell insoles, from the heel at x = 0 to the toes.
    """
    random = np.random.default_rng(seed)
    end = 1.0 + (strides + 1.2) * stride + 2.0 * slow_ends * stance * stride
    time = np.arange(0.0, end, 1.0 / rate)
    feet: dict[Side, FootRecording] = {}
    strikes: dict[Side, NDArray[np.float64]] = {}
    lifts: dict[Side, NDArray[np.float64]] = {}
    for side in SIDES:
        layout = nominal_insole("x", side) if layouts is None else layouts[side]
        length = float(layout.outline[:, 0].max())
        begin = 0.5 + (0.5 * stride if side == "right" else 0.0) + np.arange(strides) * stride
        lasts = np.full(strides, stance * stride)
        if slow_ends != 1.0:
            begin[1:] += (slow_ends - 1.0) * stance * stride
            lasts[[0, -1]] *= slow_ends
        force = np.zeros((len(time), len(layout)))
        for k, (on, last) in enumerate(zip(begin, lasts, strict=True)):
            frames = np.flatnonzero((time > on) & (time < on + last))
            share = (time[frames] - on) / last
            total = weight * two_humps(share, *humps) * (1.0 if gains is None else gains[k])
            centre = length * np.interp(share, *zip(*roll, strict=True))
            near = np.exp(-0.5 * ((layout.positions[:, 0] - centre[:, None]) / (0.2 * length)) ** 2) * layout.areas
            near *= np.where(layout.positions[:, 0] > 0.5 * length, forefoot, 1.0)
            force[frames] += total[:, None] * near / near.sum(axis=1, keepdims=True)
        if offset or drift:
            uneven = random.uniform(0.2, 1.8, len(layout))
            force += (offset + drift * time / time[-1])[:, None] * uneven / uneven.sum()
        for cell in crease:
            force[:, cell] = crease_force + 0.2 * force[:, cell]
        if noise:
            force += random.normal(0.0, noise, force.shape)
        feet[side] = FootRecording(side, force, layout)
        strikes[side], lifts[side] = begin, begin + lasts
    return MadeWalk(PressureRecording(Path("made"), "synthetic", rate, time, feet), strikes, lifts)
