"""How a standing robot takes pushes: true ZMP motion, and time to rest."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.sim.model.shove import Shove

_ZMP_BACK = 0.025  # leg from the reference: nearer counts as back; 15 mm for H1
_COM_BACK = 1 / 60  # leg
_CALM = 2.02  # beats for which it has to stay: half a second


class Recovery:
    """Follows true ZMP and CoM of a robot of size `body` through `shoves`."""

    def __init__(self, shoves: Sequence[Shove], body: BodyScale = REFERENCE_BODY) -> None:
        self._body = body
        self.shoves = tuple(shoves)
        self._now = -1
        self._off: list[float | None] = [None] * len(self.shoves)
        self._last_off = [s.start for s in self.shoves]  # last time at which it was not back yet
        self._seen = [-math.inf] * len(self.shoves)

    def update(
        self,
        time: float,
        zmp: NDArray[np.float64] | None,
        com: NDArray[np.float64],
        reference_zmp: NDArray[np.float64],
        reference_com: NDArray[np.float64],
    ) -> None:
        """Take ZMP and CoM at a control tick.

        `time` in s; `zmp`: True ZMP (2,) in m, or None; `com`: True CoM (2,) in m; `reference_zmp`: planned ZMP (2,) in
        m; `reference_com`: planned CoM (2,) in m.
        """
        while self._now + 1 < len(self.shoves) and time >= self.shoves[self._now + 1].start:
            self._now += 1
        i = self._now
        if i < 0:
            return
        self._seen[i] = time
        off = math.inf if zmp is None else math.dist(zmp, reference_zmp)
        if zmp is not None:
            self._off[i] = max(self._off[i] or 0.0, off)
        leg = self._body.leg
        if off > _ZMP_BACK * leg or math.dist(com, reference_com) > _COM_BACK * leg:
            self._last_off[i] = time

    def summary(self, applied: Sequence[NDArray[np.float64]]) -> dict[str, Any]:
        """Direction, impulse, largest ZMP deviation and time to rest by `applied` impulses (3,) in N s.

        None without a begun push, ZMP, or rest.
        """
        pushes: list[dict[str, Any]] = []
        for i, shove in enumerate(self.shoves):
            back = self._seen[i] - self._last_off[i] >= _CALM * self._body.beat
            x, y, _ = shove.impulse.tolist()
            off = self._off[i]
            pushes.append(
                {
                    "time_s": round(shove.start, 3),
                    "impulse_Ns": round(float(np.linalg.norm(applied[i])), 2) if i < len(applied) else None,
                    "direction_deg": round(math.degrees(math.atan2(y, x)), 1),
                    "zmp_off_max_m": None if off is None else round(off, 4),
                    "recovered_s": round(max(0.0, self._last_off[i] - shove.end), 3) if back else None,
                }
            )
        seen = [off for off in self._off if off is not None]
        return {
            "pushes": pushes,
            "recovered": sum(p["recovered_s"] is not None for p in pushes),
            "zmp_off_max_m": round(max(seen), 4) if seen else None,
        }
