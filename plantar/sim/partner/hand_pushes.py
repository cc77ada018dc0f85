"""Flat hands that push a walking robot, one a face of its upper body.

One hand does each component of a push, forward and left, without friction and through the robot's axis. It waits out of
range, approaches, presses with a half sine, and stops at the impulse.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.errors import SceneError
from plantar.mechanics.same_time import SAME_TIME
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.link_skin import BodySkin
from plantar.sim.body_skin.upper_body import FACES
from plantar.sim.model.world import World
from plantar.sim.partner.hand import Hand, HandTarget, body_point

_APART = 0.15  # leg, between a waiting hand and the skin: more than the skin sees
_NEAR = 0.003  # leg, at the begin of a push: 2 mm for H1
_APPROACH = 1.2  # beats before a push at which its hands come up: 0.3 s for H1
_REST = 0.3  # of the half sine's peak, with which a hand goes on that has not delivered its share
_LONGEST = 3.0  # durations after which a hand gives up
_LEAST = 1e-6  # N s: components below take no hand


@dataclass
class HandPush:
    """One push.

    Attributes:
        impulse: (2,) in N s, forward and to the left in the robot's frame.
        duration: In s of its half sine.
        when: Returns its planned begin in s.
        step: Its step, for the judge; -1 for none.
        start: In s, like `end`; infinite before.
        delivered: True impulse (3,) in N s, world frame.
        peak: Largest true force in N.
    """

    impulse: NDArray[np.float64]
    duration: float
    when: Callable[[], float]
    step: int = -1
    start: float = math.inf
    end: float = math.inf
    delivered: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    peak: float = 0.0

    def shares(self) -> dict[str, float]:
        """Impulse in N s of each hand, by face."""
        forward, left = self.impulse.tolist()
        found = {"back": forward, "front": -forward, "right": left, "left": -left}
        return {face: share for face, share in found.items() if share > _LEAST}


def faces_of(pushes: Sequence[HandPush]) -> tuple[str, ...]:
    """Faces that need hands, in the order of `FACES`."""
    needed = {face for push in pushes for face in push.shares()}
    return tuple(face for face in FACES if face in needed)


class HandPushes:
    """Hands that push, one push after another.

    `skin` in the base frame; `height`: returns the pushed height above the base's origin in m. Attributes `height`:
    above the base's origin in m; NaN before placing.
    """

    def __init__(
        self, pushes: Sequence[HandPush], skin: BodySkin, body: BodyScale, height: Callable[[World], float]
    ) -> None:
        self.pushes = tuple(pushes)
        self.hands = {face: Hand(face, body) for face in faces_of(self.pushes)}
        self.height = math.nan
        self._ask = height
        self._body = body
        self._faces = {face: skin.positions[skin.slices[face]] for face in self.hands}
        self._middles = {face: 0.5 * (at.min(axis=0) + at.max(axis=0))[:2] for face, at in self._faces.items()}
        self._given = dict.fromkeys(self.hands, 0.0)  # N s, in the push that is on
        self._next = 0
        self._base = 0

    def add_to(self, spec: Any) -> None:
        """Add the hands to a world."""
        for hand in self.hands.values():
            hand.add_to(spec)

    def bind(self, world: World) -> tuple[int, ...]:
        """Find the hands in the compiled world; returns their palms' ids."""
        self._base = int(world.model.body_rootid[world.torso])
        for hand in self.hands.values():
            hand.bind(world.model)
        return tuple(hand.geom for hand in self.hands.values())

    def place(self, world: World) -> None:
        """Put the hands where they wait, once the robot stands."""
        self.height = self._ask(world)
        frame = _Frame(world.data, self._base)
        for face, hand in self.hands.items():
            low = float(self._faces[face][:, 2].min())
            high = float(self._faces[face][:, 2].max())
            if not low <= self.height <= high:  # half a palm may hang over the edge
                origin = float(world.data.xpos[self._base, 2])
                raise SceneError(
                    f"a hand would push at a height of {self.height + origin:.3f} m; allowed: where the upper body has "
                    f"skin, {low + origin:.3f} to {high + origin:.3f} m"
                )
            hand.place(world.data, self._target(frame, face, _APART * self._body.leg))

    def near(self, time: float) -> bool:
        """Whether a hand is near at a time in s."""
        way = _APPROACH * self._body.beat
        if self._next and time <= self.pushes[self._next - 1].end + way:
            return True
        return self._next < len(self.pushes) and time >= self.pushes[self._next].when() - way

    def drive(self, world: World, skin: FoamSkins) -> None:
        """Move hands in the `world` for a physics step, after `skin`."""
        time = float(world.data.time) + SAME_TIME
        push = self.pushes[self._next] if self._next < len(self.pushes) else None
        if push is not None and push.start == math.inf and time >= push.when():
            push.start = float(world.data.time)
            self._given = dict.fromkeys(self.hands, 0.0)
        frame = _Frame(world.data, self._base)
        self._follow(push, time, world.period, skin, frame)
        for face, hand in self.hands.items():
            distance, force = self._wanted(push, face, time)
            hand.drive(world.data, self._target(frame, face, distance * self._body.leg, force))
        if push is not None and push.start < math.inf and self._over(push, time):
            push.end = float(world.data.time)
            self._next += 1

    def _wanted(self, push: HandPush | None, face: str, time: float) -> tuple[float, float | None]:
        if push is None or face not in push.shares():
            return _APART, None
        if push.start < math.inf:
            force = self._force(push, face, time)
            return (_APART if force is None else 0.0), force
        return (_NEAR if time >= push.when() - _APPROACH * self._body.beat else _APART), None

    def summary(self) -> dict[str, Any]:
        """Height in m; of each push begin, duration, wanted (robot frame) and true impulse (world), largest force."""
        rows: list[dict[str, Any]] = [
            {
                "step": push.step,
                "time_s": round(push.start, 3),
                "duration_s": round(push.end - push.start, 3) if push.end < math.inf else None,
                "wanted_Ns": [round(v, 2) for v in push.impulse.tolist()],
                "delivered_Ns": [round(v, 2) for v in push.delivered.tolist()],
                "peak_N": round(push.peak, 1),
            }
            for push in self.pushes
            if push.start < math.inf
        ]
        return {"height_above_base_m": round(self.height, 4), "pushes": rows}

    def _follow(self, push: HandPush | None, time: float, period: float, skin: FoamSkins, frame: "_Frame") -> None:
        if push is None or time < push.when() - _APPROACH * self._body.beat:
            if not self._next:
                return
            push = self.pushes[self._next - 1]
        force = skin.wrenches[:, :3].sum(axis=0)
        push.delivered += force * period
        push.peak = max(push.peak, float(np.linalg.norm(force)))
        for face, hand in self.hands.items():
            self._given[face] -= float(skin.on_obstacles[hand.name][:3] @ frame.inward(face)) * period

    def _force(self, push: HandPush, face: str, time: float) -> float | None:
        """Pressing force in N; None when done or given up."""
        share = push.shares()[face]
        since = (time - push.start) / push.duration
        if self._given[face] >= share or since >= _LONGEST:
            return None
        peak = 0.5 * math.pi * share / push.duration
        return peak * (math.sin(math.pi * since) if since < 0.5 else max(math.sin(math.pi * min(since, 1.0)), _REST))

    def _over(self, push: HandPush, time: float) -> bool:
        return all(self._force(push, face, time) is None for face in push.shares())

    def _target(self, frame: "_Frame", face: str, distance: float, force: float | None = None) -> HandTarget:
        point, velocity = frame.point(np.array([*self._middles[face], self.height]))
        inward = frame.inward(face)
        return HandTarget(point - distance * inward, velocity, frame.yaw, inward, force)


class _Frame:
    def __init__(self, data: Any, base: int) -> None:
        self._data = data
        self._base = base
        self._rotation = data.xmat[base].reshape(3, 3)
        self.yaw = math.atan2(float(self._rotation[1, 0]), float(self._rotation[0, 0]))

    def inward(self, face: str) -> NDArray[np.float64]:
        forward, left = FACES[face]
        return np.asarray(-forward * self._rotation[:, 0] - left * self._rotation[:, 1])

    def point(self, local: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Place in m and velocity in m/s (3,) of a base point (3,), in the world."""
        return body_point(self._data, self._base, self._base, local)
