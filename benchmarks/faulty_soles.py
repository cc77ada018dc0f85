"""Soles with known faults, independent of the calibration: an uneven elastic pad under a rigid foot, cells and counts.

Contact: 24 points a cell on a pad whose pressure is k d^1.2, with a stiffness that scatters by 3 % and a surface that
is uneven by 0.1 mm; the foot's height and two tilts are solved for load and center of pressure. A cell leaks 10 % of
its force to its neighbours; unloading reads more than loading by up to 5 % of the peak (a branch of its own, 70 %, and
creep with 1.5 s, 30 %); c = g v / (1 + b v) bends by 25 %; gains lie within +-40 %; offsets, noise and a 12-bit
converter are added. `plantar.calibration` knows none of these forms.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import lfilter

from plantar import SoleLayout

Array = NDArray[np.float64]
GRAVITY = 9.80665
SIDES = ("left", "right")
RATE = 50.0
FULL = 150.0  # N of a cell at half of the converter's range


class Motion(NamedTuple):
    """`time` (k,) in s, `load` (k,) in N and `cop` (k, 2) in m of each sole; `slow` (k,): leaning, no steps."""

    time: Array
    load: Mapping[str, Array]
    cop: Mapping[str, Array]
    slow: NDArray[np.bool_]


def correlated(rng: np.random.Generator, frames: int, tau: float, columns: int = 1) -> Array:
    """Noise (k, columns) of standard deviation 1 that keeps for `tau` in s."""
    keep = np.exp(-1.0 / (RATE * tau))
    drawn = rng.normal(0.0, np.sqrt(1.0 - keep**2), (frames, columns))
    drawn[0] = rng.normal(0.0, 1.0, columns)
    return np.asarray(lfilter([1.0], [1.0, -keep], drawn, axis=0))


def stand_and_step(
    rng: np.random.Generator,
    weight: float,
    layouts: Mapping[str, SoleLayout],
    plan: tuple[float, float, float, float] = (4.0, 20.0, 20.0, 16.0),
    reach: float = 0.9,
) -> Motion:
    """Seconds on both feet, on the left, on the right, stepping; leaning goes to `reach` of the taxels' half width."""
    frames = round(sum(plan) * RATE)
    time = np.arange(frames) / RATE
    ends = np.round(np.cumsum(plan) * RATE).astype(int)

    def wander(count: int, low: float, high: float, tau: float) -> Array:
        path = gaussian_filter1d(correlated(rng, count, tau)[:, 0], 0.12 * RATE)
        return low + (high - low) * 0.5 * (1.0 + np.tanh(0.9 * path / max(path.std(), 1e-9)))

    share = np.zeros(frames)
    share[: ends[0]] = wander(ends[0], 0.12, 0.88, 0.8)
    share[ends[0] : ends[1]] = 1.0
    k = ends[2]
    left = True
    while k < frames:
        count = round(0.85 * rng.uniform(0.85, 1.15) * RATE)
        share[k : k + count] = float(left)
        k += count
        left = not left
    share = np.clip(gaussian_filter1d(share, 0.05 * RATE), 0.0, 1.0)
    share = np.where(share < 0.01, 0.0, np.where(share > 0.99, 1.0, share))
    lift = 0.05 * correlated(rng, frames, 0.3)[:, 0]
    lift[ends[2] :] = 1.2 * np.sin(2.0 * np.pi * time[ends[2] :] / 0.85)
    total = weight * (1.0 + gaussian_filter1d(lift, 0.04 * RATE) / GRAVITY)
    load = {"left": total * share, "right": total * (1.0 - share)}
    cop = {}
    for side in SIDES:
        places = layouts[side].positions[:, :2]
        way = np.column_stack([wander(frames, -reach, reach, 0.7), wander(frames, -reach, reach, 0.5)])
        on = np.concatenate([[False], load[side] > 1.0, [False]])
        begins = np.flatnonzero(on[1:] & ~on[:-1])
        stops = np.flatnonzero(~on[1:] & on[:-1])
        for begin, stop in zip(begins, stops, strict=True):
            begin = max(begin, ends[2])
            if stop > begin:
                u = np.linspace(0.0, 1.0, stop - begin)
                heel = rng.uniform(-0.85, -0.5)
                toe = rng.uniform(0.5, 0.85)
                way[begin:stop, 0] = np.interp(u, [0.0, 0.25, 0.75, 1.0], [heel, 0.5 * heel, 0.6 * toe, toe])
                way[begin:stop, 1] = np.interp(u, [0.0, 0.3, 0.7, 1.0], rng.uniform(-0.6, 0.6, 4))
        way = gaussian_filter1d(way, 0.03 * RATE, axis=0)
        way /= np.maximum(1.0, np.linalg.norm(way, axis=1) / 0.9)[:, None]
        middle = 0.5 * (places.max(axis=0) + places.min(axis=0))
        cop[side] = middle + 0.5 * np.ptp(places, axis=0) * way
    return Motion(time, load, cop, np.arange(frames) < ends[2])


class Pad:
    """The elastic pad of one sole."""

    def __init__(self, layout: SoleLayout, rng: np.random.Generator) -> None:
        n = len(layout)
        points = []
        for i in range(n):
            ring = layout.cell_polygon(i)
            middle = ring.mean(axis=0)
            for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
                ab = 0.5 * (a + b)
                ma = 0.5 * (middle + a)
                mb = 0.5 * (middle + b)
                points += [(middle + ma + mb) / 3, (a + ma + ab) / 3, (b + mb + ab) / 3, (ab + ma + mb) / 3]
        self._points = np.array(points)
        self._each = len(points) // n
        waves = rng.normal(0.0, 25.0, (6, 2))
        phases = rng.uniform(0.0, 2.0 * np.pi, 6)
        long_waves = 1e-4 * np.cos(self._points @ waves.T + phases).sum(axis=1) / np.sqrt(3.0)
        self._rise = long_waves + np.repeat(rng.normal(0.0, 5e-5, n), self._each)
        stiff = np.repeat(rng.normal(1.0, 0.03, n) * layout.areas / self._each, self._each)
        self._stiff = 4e8 * stiff
        self._n = n

    def forces(self, load: Array, cop: Array) -> Array:
        """Forces (k, n) in N of cells that have this load and center of pressure."""
        out = np.zeros((len(load), self._n))
        on = load > 1.0
        arms = np.column_stack([np.ones(len(self._points)), self._points])
        wanted = load[on, None] * np.column_stack([np.ones(on.sum()), cop[on]])
        pose = np.tile([1.5e-3, 0.0, 0.0], (len(wanted), 1))
        force = np.zeros((len(wanted), len(arms)))
        for _ in range(60):
            depth = np.maximum(pose @ arms.T + self._rise, 0.0)
            force = self._stiff * depth**1.2
            slope = 1.2 * self._stiff * depth**0.2 * (depth > 0.0)
            off = force @ arms - wanted
            if np.abs(off / wanted[:, :1]).max() < 1e-6:
                break
            moments = np.stack([slope @ (arms * arms[:, [j]]) for j in range(3)], axis=1)
            change = np.linalg.solve(moments + 1e-9 * np.eye(3), off[..., None])[..., 0]
            most = np.abs(change @ arms.T).max(axis=1)
            pose = pose - change * np.minimum(1.0, 6e-4 / np.maximum(most, 1e-12))[:, None]
        out[on] = force.reshape(len(wanted), self._n, self._each).sum(axis=2)
        return out


def rolled(
    rng: np.random.Generator, layout: SoleLayout, seconds: float = 60.0, least: float = 20.0, most: float = 90.0
) -> tuple[Array, Array]:
    """Time (k,) and cells' forces (k, n) of a ball of 12 mm footprint that is rolled over a sole, row after row."""
    frames = round(seconds * RATE)
    time = np.arange(frames) / RATE
    places = layout.positions[:, :2]
    low = places.min(axis=0)
    high = places.max(axis=0)
    rows = np.round(np.ptp(places[:, 1]) / 0.012) + 1
    u = np.linspace(0.0, rows, frames, endpoint=False)
    x = low[0] + (high[0] - low[0]) * (1.0 - np.abs((u % 2.0) - 1.0))
    y = low[1] + (high[1] - low[1]) * u / rows
    way = np.column_stack([x, y]) + gaussian_filter1d(0.004 * correlated(rng, frames, 0.5, 2), 5, axis=0)
    force = least + (most - least) * 0.5 * (
        1.0 + np.tanh(gaussian_filter1d(3.0 * correlated(rng, frames, 0.7)[:, 0], 5))
    )
    distance = np.linalg.norm(way[:, None] - places, axis=2)
    share = np.exp(-0.5 * (distance / 0.012) ** 2)
    return time, force[:, None] * share / share.sum(axis=1, keepdims=True)


@dataclass(frozen=True)
class Faults:
    """Faults of one sole's cells, drawn once; `counts` reads forces (k, n)."""

    gain: Array
    bend: Array
    offset: Array
    mix: Array
    loop: float = 0.05
    noise: float = 7e-4

    @classmethod
    def drawn(
        cls, rng: np.random.Generator, layout: SoleLayout, gain: float = 0.4, cross: float = 0.1, **more: Any
    ) -> "Faults":
        n = len(layout)
        mix = np.eye(n) * (1.0 - cross)
        for i, near in enumerate(layout.neighbours):
            mix[list(near), i] = cross / len(near)
        return cls(
            rng.uniform(1.0 - gain, 1.0 + gain, n),
            0.25 * rng.uniform(0.8, 1.2, n),
            rng.uniform(0.01, 0.06, n),
            mix,
            **more,
        )

    def counts(self, force: Array, rng: np.random.Generator) -> Array:
        """Counts (k, n) of a 12-bit converter."""
        held = self._held(force @ self.mix.T)
        share = self._bent(held)
        read = 0.5 * self.gain * share + self.offset + rng.normal(0.0, 0.5 * self.noise, force.shape)
        return np.round(4095.0 * np.clip(read, 0.0, 1.0))

    def newtons_per_count(self, at: float) -> Array:
        """True gain (n,): N per count at `at` N, in the middle of a loop to twice that in 4 s."""
        half = np.linspace(0.0, 2.0 * at, round(2.0 * RATE) + 1)
        held = self._held(np.tile(np.concatenate([half, half[-2::-1]])[:, None], len(self.gain)))
        middle = (len(half) - 1) // 2
        level = 0.5 * (held[middle] + held[-1 - middle])
        return at / (4095.0 * 0.5 * self.gain * self._bent(level))

    def _bent(self, force: Array) -> Array:
        share = force / FULL
        return share * (1.0 + self.bend) / (1.0 + self.bend * share)

    def _held(self, force: Array) -> Array:
        out = np.empty_like(force)
        branch = np.zeros(force.shape[1])
        peak = np.full(force.shape[1], 0.5)
        last = force[0]
        crept = force[0]
        for k, now in enumerate(force):
            peak = np.where(now < 0.2, 0.5, np.maximum(peak, now))
            branch = np.clip(branch - (now - last) / (0.1 * peak), 0.0, 1.0)
            last = now
            share = np.clip(now / peak, 0.0, 1.0)
            crept = crept + (now - crept) / (RATE * 1.5)
            lens = (4.0 * share * (1.0 - share)) ** 0.7
            out[k] = now + 0.7 * self.loop * peak * lens * branch + 0.6 * self.loop * (crept - now)
        return out
