"""Simulated sole skin: taxel forces of MuJoCo's contacts, and electronics.

A rigid box lifts a corner by micrometres where rubber stays pressed: with a `gap` of 1 mm MuJoCo reports such corners,
and those within REACH belong to the patch.
"""

from collections import deque
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.kernels.contacts.foot_contacts import ContactsInSole
from plantar.kernels.contacts.pressed_sole import PressedSole
from plantar.kernels.sensors.noise_rows import SampleClock, TaxelSample
from plantar.kernels.sensors.sole_rays import SoleRays
from plantar.kernels.sensors.sole_sampling import SoleSampling
from plantar.layouts.layout import DEFAULT_RANGES, SoleLayout
from plantar.mechanics.same_time import SAME_TIME
from plantar.mujoco.named_id import named_id
from plantar.sensing.reading import Reading
from plantar.sim.model.contact_truth import REACH, ContactReader, FootContacts
from plantar.sim.plant.taxels import TaxelErrors
from plantar.sim.sensing.blind_rim import BlindRim
from plantar.sim.sensing.proximity import ProximitySensor
from plantar.sim.sensing.settings import Sensing
from plantar.sim.sensing.sole_pressure import SolePressure
from plantar.sim.sensing.white_noise import white_noise

if TYPE_CHECKING:
    from plantar.sim.sensing.elastic_pressure import ElasticPressure


class SoleSkin:
    """The skin of one sole.

    `site`: name of the sole frame's site; `rubber`: thickness in m, see `SolePressure`; `reach`: largest gap in m that
    the rubber closes; `layer`: thickness in m of an elastic layer; None for springs.
    """

    def __init__(
        self,
        model: Any,
        layout: SoleLayout,
        site: str,
        geoms: Sequence[str],
        *,
        rubber: float = 3e-3,
        reach: float = REACH,
        layer: float | None = None,
        rim_stiffness: float = 0.0,
    ) -> None:
        self.model = model
        self.layout = layout
        self.site_id = named_id(model, "site", site)
        self.geom_ids = frozenset(named_id(model, "geom", g) for g in geoms)
        if not self.geom_ids:
            raise RobotError("the sole has no collision geom; name at least one")
        self.pressure = _pressure_of(layout, rubber, layer)
        self._rim = BlindRim(layout, rim_stiffness, rubber) if rim_stiffness > 0.0 else None
        springs = self.pressure.springs if isinstance(self.pressure, SolePressure) else None
        self.springs: PressedSole | None = None if self._rim is not None else springs
        self._reach = reach
        self.data: Any = None  # in which contacts were last seen from the sole
        self._in_sole = ContactsInSole()

    def __len__(self) -> int:
        return len(self.layout)

    @property
    def pressed(self) -> int:
        """How often forces were spread over the taxels."""
        return int(self._in_sole.pressed)

    @property
    def in_air(self) -> int:
        """How often the sole carried no load."""
        return int(self._in_sole.in_air)

    def taxel_forces(self, data: Any, contacts: FootContacts | None = None) -> NDArray[np.float64]:
        """Normal taxel forces without noise. Returns (n,) in N, none negative."""
        contacts = self._seen_in(data, contacts)
        if self.springs is not None:
            self.springs.stand(contacts, self._in_sole, self._reach)
            return np.array(self.springs.forces)
        out = np.zeros(len(self.layout))
        self._in_sole.turn(contacts)
        for fz, tx, ty, patch in contacts.pair_loads(self._in_sole.vectors, self._reach):
            if fz > 0.0:
                part = self.pressure.spread(patch, fz, (-ty / fz, tx / fz))
                out += part if self._rim is None else part * self._rim.share(patch)
        return out

    def sampled(self, data: Any, contacts: FootContacts | None, sample: TaxelSample) -> NDArray[np.float64]:
        """What electronics read of the springs. Returns readings (n,) in N."""
        seen = self._seen_in(data, contacts)
        sampled: NDArray[np.float64] = sample.of_contacts(self.springs, seen, self._in_sole, self._reach)
        return sampled

    def sampling(
        self, clock: SampleClock, sample: TaxelSample, proximity: ProximitySensor | None, queue: deque[Reading]
    ) -> SoleSampling:
        """All that `SkinSensor.read` does of its springs, in one kernel, in the data that it read last."""
        samples = None if proximity is None else proximity.samples
        return SoleSampling(clock, sample, self.springs, self._in_sole, self._reach, samples, queue, Reading)

    def _seen_in(self, data: Any, contacts: FootContacts | None) -> FootContacts:
        """The sole's contacts, looked at from the sole."""
        if data is not self.data:
            self.data = data
            self._reader = ContactReader(self.model, data, (self.geom_ids,))
            self._in_sole.look_from(data.site_xpos[self.site_id], data.site_xmat[self.site_id].reshape(3, 3))
        return self._reader.read()[0] if contacts is None else contacts


def _pressure_of(layout: SoleLayout, rubber: float, layer: float | None) -> "SolePressure | ElasticPressure":
    if layer is None:
        return SolePressure(layout, rubber=rubber)
    from plantar.sim.sensing.elastic_pressure import ElasticPressure  # and scipy.linalg, 0.2 s

    return ElasticPressure(layout, thickness=layer, rubber=rubber)


class SkinSensor:
    """A skin as delivered: sampled, noisy, clipped, late.

    Samples are due at multiples of the period from the first call.

    `sensing`: rate, noise and delay of the soles' skin; `proximity`: sampled with the forces, or None; `errors` of the
    taxels, or None; `dead`: indices that read NaN.
    """

    def __init__(
        self,
        skin: SoleSkin,
        sensing: Sensing,
        rng: np.random.Generator,
        proximity: ProximitySensor | None = None,
        errors: TaxelErrors | None = None,
        dead: Collection[int] = (),
    ) -> None:
        self.skin = skin
        self.period = 1.0 / sensing.skin_rate
        self.proximity = proximity
        count = len(skin)
        limits = skin.layout.ranges.get("force", DEFAULT_RANGES["force"])
        noise = white_noise(rng, 0.0, sensing.force_noise, count)
        self._sample = TaxelSample(noise, count, *limits, np.array(sorted(dead), dtype=np.int64))
        self._errors = errors
        self._direct = isinstance(skin, SoleSkin) and skin.springs is not None and errors is None
        self._queue: deque[Reading] = deque(maxlen=sensing.delay_periods + 1)
        self._clock = SampleClock(self.period, SAME_TIME)
        self._data: Any = None  # in which the kernel samples
        self._sampling: SoleSampling | None = None
        self._rays: SoleRays | None = None

    def read(
        self, data: Any, contacts: FootContacts | None = None, *, near: bool = True, everything: bool = False
    ) -> Reading:
        """What is delivered now; call at every physics step.

        `everything`: measure it always; the reading holds it where wanted. Returns the reading; the same object until a
        newer sample arrives.
        """
        sampling = self._sampling
        if sampling is not None and data is self._data is self.skin.data and contacts is not None and not everything:
            delivered: Reading = sampling.read(data.time, contacts, self._rays if near else None)
            return delivered
        now = data.time
        queue = self._queue
        if not queue:
            self._clock.begin(now)
        if self._clock.due(now):
            distance = None if self.proximity is None else self.proximity.read(data, near, everything)
            if self._direct:
                force = self.skin.sampled(data, contacts, self._sample)
            else:
                force = self._sampled(now, data, contacts, distance)
            queue.append(Reading.taken_over(now, force, distance))
            if self._direct and data is not self._data:
                self._sample_by_kernel(data)
        return queue[0]

    def _sample_by_kernel(self, data: Any) -> None:
        """Let later samples in `data` be a kernel's, but for rays that only MuJoCo casts."""
        proximity = self.proximity
        self._rays = None if proximity is None else proximity.proximity.plain_rays(data)
        self._data = data
        if proximity is None or self._rays is not None:
            self._sampling = self.skin.sampling(self._clock, self._sample, proximity, self._queue)

    def _sampled(
        self, now: float, data: Any, contacts: FootContacts | None, distance: NDArray[np.float64] | None
    ) -> NDArray[np.float64]:
        """Sampled forces (n,) in N with taxel errors; silenced distances become NaN."""
        force = self.skin.taxel_forces(data, contacts)
        if self._errors is not None:
            force = self._errors.read(force, now)
        sample: NDArray[np.float64] = self._sample.of(force)
        if self._errors is not None:
            self._errors.silence(now, sample, distance)
        return sample
