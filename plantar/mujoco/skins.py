"""Several skins of one model, read in one call."""

from collections.abc import Iterator, Sequence
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance, integer, items
from plantar.errors import InputError
from plantar.mujoco.bound_skin import MOST_DATA, BoundSkin, SkinReading, SkinView, shared_work
from plantar.mujoco.contacts import ContactReader
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading


class Skins:
    """Bound skins of one model, read together: the simulator's contacts are looked through once.

    Args:
        skins: The skins.

    Attributes:
        skins: The skins.

    Raises:
        InputError: For none, or skins of several models.

    Example:
        >>> import mujoco
        >>> from plantar.mujoco import Skin, Skins
        >>> model = mujoco.MjModel.from_xml_string('''<mujoco><worldbody><body name="a"><freejoint/><geom size=".1"/>
        ...   </body><body name="b" pos="0 0 1"><freejoint/><geom size=".1"/></body></worldbody></mujoco>''')
        >>> both = Skins([Skin(body=name).bind(model) for name in "ab"])
        >>> data = mujoco.MjData(model)
        >>> mujoco.mj_forward(model, data)
        >>> [bool(reading.wrench.any()) for reading in both(data)]
        [False, False]
    """

    def __init__(self, skins: Sequence[BoundSkin]) -> None:
        self.skins = tuple(instance(skin, BoundSkin, "skin") for skin in items(skins, "skins"))
        if not self.skins:
            raise InputError("skins are empty; expected one bound skin or more")
        self.model = self.skins[0].model
        if any(skin.model is not self.model for skin in self.skins):
            raise InputError("the skins are bound to several models; allowed: skins of one")
        links = [self.model.body(skin.body).name for skin in self.skins]
        self._by_link = sorted(range(len(links)), key=links.__getitem__)
        self._views: dict[int, _Views] = {}
        self._most = MOST_DATA

    def __len__(self) -> int:
        return len(self.skins)

    def __iter__(self) -> Iterator[BoundSkin]:
        return iter(self.skins)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_views": {}}

    def __call__(self, data: Any) -> tuple[SkinReading, ...]:
        """Each skin's reading after a step or `mj_forward`; InputError for another model's MjData."""
        views = self._views.get(id(data)) or self._look_in(data)
        with views.lock:
            return views.read(data.time)

    @property
    def body_skin(self) -> BodySkin:
        """All taxels, as `plantar.wholebody` takes them; a body's second skin is called BODY_2."""
        patches: list[SkinPatch] = []
        for skin in self.skins:
            patch = skin.patch
            count = sum(p.link == patch.link for p in patches)
            name = patch.link if not count else f"{patch.link}_{count + 1}"
            patches.append(patch.named(name))
        return BodySkin(patches)

    def whole(self, data: Any) -> Reading:
        """One reading of all taxels, in the order of `body_skin`."""
        readings = self(data)
        ordered = [readings[i] for i in self._by_link]
        force = np.concatenate([reading.force for reading in ordered])
        distance = np.concatenate([reading.distance for reading in ordered])
        return Reading.taken_over(float(data.time), force, distance)

    def many(self, datas: Sequence[Any], threads: int = 1) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Read the skins in many simulations.

        Args:
            datas: MjData of model, after `mj_step` or `mj_forward`.
            threads: Number of threads.

        Returns:
            Of each skin: force (b, n, 3) on each taxel in N and wrench (b, 6), sole frame.
        """
        datas = items(datas, "datas")
        found = [(np.empty((len(datas), len(skin), 3)), np.empty((len(datas), 6))) for skin in self.skins]
        self._most = max(self._most, len(datas))
        views = [self._views.get(id(d)) or self._look_in(d) for d in datas]

        def work(start: int) -> None:
            for i in range(start, len(views), threads):
                with views[i].lock:
                    for (vectors, wrenches), load in zip(found, views[i].loads(), strict=True):
                        vectors[i] = load.vectors
                        wrenches[i] = load.wrench

        shared_work(work, integer(threads, "threads", 1))
        return found

    def _look_in(self, data: Any) -> "_Views":
        for skin in self.skins:
            skin.check(data)
        if len(self._views) >= self._most:
            self._views.pop(next(iter(self._views)), None)
        views = _Views(self.skins, data)
        self._views[id(data)] = views
        return views


class _Views:
    """Skins' contacts in one MjData, alive with it."""

    def __init__(self, skins: Sequence[BoundSkin], data: Any) -> None:
        self.lock = Lock()
        self._reader = ContactReader(skins[0].model, data, [skin.geom_ids for skin in skins])
        self._views = [SkinView(skin, data) for skin in skins]

    def read(self, time: float) -> tuple[SkinReading, ...]:
        readings = []
        for view, foot in zip(self._views, self._reader.read(), strict=True):
            readings.append(view.reading(foot, time) if foot.size or view.looks else view.still(time))
        return tuple(readings)

    def loads(self) -> Iterator[Any]:
        """Each skin's load now, a `TaxelLoad` or `PatchLoad`."""
        for view, foot in zip(self._views, self._reader.read(), strict=True):
            yield view.press(foot)
