"""Simulated sole skin: what the taxels feel of MuJoCo's contacts, and what its electronics deliver of that.

A rigid box under an eccentric load lifts a corner by micrometres, where rubber stays pressed. Give the sole's geoms a
`gap` of 1 mm: MuJoCo then reports such corners, and those within REACH belong to the patch.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError, RobotError
from plantar.kernels.contact_sums import pair_loads
from plantar.layout import DEFAULT_RANGES, SoleLayout
from plantar.reading import Reading
from sim.contact_truth import REACH, ContactSet, foot_contacts
from sim.proximity import ProximitySensor
from sim.sole_pressure import SolePressure

__all__ = ["SkinSensor", "SoleSkin"]


class SoleSkin:
    """The skin of one sole in a simulation.

    Args:
        model: The MjModel.
        layout: The sole.
        site: Name of the site that is the sole frame, for example "left_sole".
        geoms: Names of the sole's collision geoms.
        rubber: Thickness in m of the sole's rubber, see `SolePressure`.

    Raises:
        RobotError: If the model has no such site or geom.
        LayoutError: If a taxel does not face the ground.
    """

    def __init__(
        self,
        model: Any,
        layout: SoleLayout,
        site: str,
        geoms: Sequence[str],
        *,
        rubber: float = 3e-3,
    ) -> None:
        self.model = model
        self.layout = layout
        self.site_id = _id_of(model, mujoco.mjtObj.mjOBJ_SITE, "site", site)
        self.geom_ids = frozenset(_id_of(model, mujoco.mjtObj.mjOBJ_GEOM, "geom", g) for g in geoms)
        if not self.geom_ids:
            raise RobotError("the sole has no collision geom; name at least one")
        self.pressure = SolePressure(layout, rubber=rubber)

    def __len__(self) -> int:
        return len(self.layout)

    def contacts(self, data: Any) -> ContactSet:
        """The sole's contacts with the world, see `foot_contacts`."""
        return foot_contacts(self.model, data, self.geom_ids)

    def taxel_forces(self, data: Any, contacts: ContactSet | None = None) -> NDArray[np.float64]:
        """Normal force on each taxel, free of noise.

        Args:
            data: The MjData after `mj_step` or `mj_forward`.
            contacts: The sole's contacts where they are known already.

        Returns:
            Forces (n,) in N, none negative; zeros for a sole in the air.
        """
        if contacts is None:
            contacts = foot_contacts(self.model, data, self.geom_ids)
        if not contacts.size:
            return np.zeros(len(self.layout))
        rotation = data.site_xmat[self.site_id].reshape(3, 3)
        pairs = pair_loads(
            contacts.own_geoms,
            contacts.other_geoms,
            (contacts.positions - data.site_xpos[self.site_id]).dot(rotation),
            contacts.forces.dot(rotation),
            contacts.torques.dot(rotation),
            contacts.distances,
            REACH,
        )
        out: NDArray[np.float64] | None = None
        for fz, tx, ty, patch in pairs:
            if fz > 0.0:
                part = self.pressure.spread(patch, fz, (-ty / fz, tx / fz))
                out = part if out is None else out + part
        return np.zeros(len(self.layout)) if out is None else out


class SkinSensor:
    """A skin as its electronics deliver it: sampled, noisy, clipped to its range, late.

    A sample is taken at the first physics step at or after each multiple of the period, counted from the first call;
    between samples the last one stands.

    Args:
        skin: The noise-free skin.
        rate_hz: Sampling rate in Hz.
        noise_std_N: Standard deviation of the white noise on each taxel in N (0.15 kg by default, T Table 2).
        delay_periods: Whole sampling periods between taking a sample and delivering it; until the first one arrives
            the first sample is delivered.
        rng: Source of the noise; the same seed and calls give the same noise. None needs noise_std_N = 0.
        dead: Indices of dead taxels: they read NaN.
        proximity: Proximity of the same sole, sampled together with the forces; None where the skin has none.

    Raises:
        InputError: If an argument is outside what is allowed.
    """

    def __init__(
        self,
        skin: SoleSkin,
        rate_hz: float = 250.0,
        noise_std_N: float = 0.15 * 9.81,
        delay_periods: int = 0,
        rng: np.random.Generator | None = None,
        dead: Collection[int] = (),
        proximity: ProximitySensor | None = None,
    ) -> None:
        n = len(skin)
        if not (math.isfinite(rate_hz) and rate_hz > 0.0):
            raise InputError(f"skin rate is {rate_hz} Hz; allowed: a finite value above 0")
        if not (math.isfinite(noise_std_N) and noise_std_N >= 0.0):
            raise InputError(f"skin noise is {noise_std_N} N; allowed: a finite value of 0 or more")
        if int(delay_periods) != delay_periods or delay_periods < 0:
            raise InputError(f"skin delay is {delay_periods} periods; allowed: whole numbers of 0 or more")
        if rng is None and noise_std_N > 0.0:
            raise InputError("skin noise needs a random generator; pass rng=numpy.random.default_rng(seed)")
        if any(not 0 <= int(i) < n for i in dead):
            raise InputError(f"dead taxels {sorted(dead)} name one that does not exist; allowed: 0 to {n - 1}")
        self.skin = skin
        self.period = 1.0 / rate_hz
        self.noise_std = noise_std_N
        self.delay_periods = int(delay_periods)
        self.dead = np.array(sorted({int(i) for i in dead}), dtype=np.int64)
        self.range = skin.layout.ranges.get("force", DEFAULT_RANGES["force"])
        self.proximity = proximity
        self._rng = rng
        self._queue: deque[Reading] = deque(maxlen=self.delay_periods + 1)
        self._start = 0.0
        self._taken = 0

    def reset(self) -> None:
        """Forget all samples; the noise goes on where it is."""
        self._queue.clear()
        self._taken = 0

    def read(
        self, data: Any, contacts: ContactSet | None = None, *, near: bool = True, everything: bool = False
    ) -> Reading:
        """What the electronics deliver at this instant; call it at every physics step.

        Args:
            data: The MjData after `mj_step` or `mj_forward`.
            contacts: The sole's contacts where they are known already.
            near: Whether somebody asks for this sole's proximity.
            everything: Measure proximity in any case; the reading holds it only where it is asked for.

        Returns:
            The reading; its time is that of the sample in s, so `data.time - reading.time` is its age. The same object
            comes back until a newer sample arrives.
        """
        now = float(data.time)
        if not self._queue:
            self._start, self._taken = now, 0
        if now >= self._start + self._taken * self.period - 1e-9:
            # Count on from now: steps longer than the period skip samples, they do not pile up.
            self._taken = int((now - self._start) / self.period + 1e-6) + 1
            distance = None if self.proximity is None else self.proximity.read(data, near, everything)
            self._queue.append(Reading(time=now, force=self._sample(data, contacts), proximity=distance))
        return self._queue[0]

    def _sample(self, data: Any, contacts: ContactSet | None) -> NDArray[np.float64]:
        force = self.skin.taxel_forces(data, contacts)
        if self._rng is not None and self.noise_std > 0.0:
            force = force + self._rng.normal(0.0, self.noise_std, len(force))
        force = np.minimum(np.maximum(force, self.range[0]), self.range[1])
        force[self.dead] = np.nan
        return force


def _id_of(model: Any, kind: Any, word: str, name: str) -> int:
    found = int(mujoco.mj_name2id(model, kind, name))
    if found < 0:
        count = model.nsite if word == "site" else model.ngeom
        names = [mujoco.mj_id2name(model, kind, i) for i in range(count)]
        known = ", ".join(n for n in names if n) or "none"
        raise RobotError(f"the model has no {word} named {name!r}; it has: {known}")
    return found
