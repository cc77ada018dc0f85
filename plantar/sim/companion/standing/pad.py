"""Pads that press on a link along its normal and follow it."""

import math
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinPatch
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import AWAY, add_moved

_CLEAR = 0.03  # m off the skin while it does not press
_APPROACH = 0.15  # m/s
_SEARCH = 0.06  # m/s with which it comes near
_SOFTLY = 600.0  # 1/s: a large face comes slower, or it would land with far more than its force
_SETTLE = 60.0  # 1/s: how fast its force is corrected


class Pad:
    """A moved cylinder or box; its face stays on a taxel's normal.

    `name`: body and geom are called "pad " and this; `taxel`: index in patch of taxel at middle of its face; `face`:
    radius in m; `stiffness` of the skin under its face in N/m, about. Attributes `wanted`: force in N; 0 or less lifts
    it off; `parked`: whether it is far away; `middle`: middle (3,) of its face on link, link frame, in m.
    """

    def __init__(self, name: str, patch: SkinPatch, taxel: int, face: float, stiffness: float) -> None:
        self.name = f"pad {name}"
        self.patch = patch
        self.face = face
        self.wanted = 0.0
        self.parked = True
        self.middle = patch.positions[taxel]
        self._turn = patch.rotations[taxel]
        self._half = 0.02
        self._gap = _CLEAR
        self._stiffness = stiffness
        self._last: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None

    @property
    def inward(self) -> NDArray[np.float64]:
        """Direction (3,) in which it presses, in the link's frame."""
        return np.asarray(self._turn[:, 2])

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""
        add_moved(spec, self.name, mujoco.mjtGeom.mjGEOM_CYLINDER, (self.face, self._half, 0.0))

    def act(self, world: Any, force: float, period: float) -> None:
        """Move it in the `world`, each physics step, by its `force` in N and `period` in s."""
        if self.wanted > 0.0:
            rate = np.clip((force - self.wanted) * _SETTLE / self._stiffness, -_APPROACH, _APPROACH)
            rate = rate if force > 0.0 else -min(_SEARCH, _SOFTLY * self.wanted / self._stiffness)
            self._gap = max(self._gap + rate * period, -0.018)
        else:
            if self.parked:
                return
            self._gap = min(self._gap + _APPROACH * period, _CLEAR)
        origin, rotation = world.pose(self.patch.link)
        before = self._last or (origin, rotation)
        self._last = (origin, rotation)
        ahead = 2.0 * origin - before[0]
        turned = rotation @ before[1].T @ rotation
        inward = turned @ self.inward
        number = int(world.model.body(self.name).mocapid[0])
        self.parked = self.wanted <= 0.0 and self._gap >= _CLEAR
        if self.parked:  # out of everybody's way
            world.data.mocap_pos[number] = AWAY
            self._last = None
            return
        world.data.mocap_pos[number] = ahead + turned @ self.middle - (self._gap + self._half) * inward
        mujoco.mju_mat2Quat(world.data.mocap_quat[number], np.ascontiguousarray(turned @ self._turn).ravel())

    def touching(self, world: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Target (3,) of its face in the world in m, direction (3,) inwards."""
        origin, rotation = world.pose(self.patch.link)
        return origin + rotation @ self.middle, rotation @ self.inward

    def force(self, on_obstacles: dict[str, NDArray[np.float64]], rotation: NDArray[np.float64]) -> float:
        """Returns the axial force in N, from the skin's wrenches `on_obstacles` and the link's `rotation` (3, 3)."""
        return float(-on_obstacles[self.name][:3] @ (rotation @ self.inward))


_FIRST = 0.05  # of its force when it touches


@dataclass
class PlannedContact:
    """One pad that presses for a while; its force swells and fades.

    Attributes:
        begin: In s; `hold` for how long.
        force: In N.
        swell: Time in s over which its force grows; it fades in that time, and 0.6 s at least.
        against: Link against which the yield is measured; empty for centre of mass.
        rest: `place` before anything pressed.
        yielded: Largest yield in m from there along the pad, once its force has grown: until then a link may be on its
            way back from the contact before.
        measured: Largest true force in N.
    """

    pad: Pad
    begin: float
    hold: float
    force: float
    swell: float = 0.3
    against: str = ""
    rest: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    yielded: float = 0.0
    measured: float = 0.0
    _touched: float = field(default=math.inf, repr=False)

    def act(self, time: float, measured: float) -> None:
        """Set the pad's wanted force at `time` in s by the `measured` one."""
        left = self.begin + self.hold - time
        if time <= self.begin or left <= 0.0:
            self.pad.wanted = 0.0
            return
        if math.isinf(self._touched) and measured > 0.0:
            self._touched = time
        grown = 1.0 if math.isinf(self._touched) else max(_FIRST, (time - self._touched) / self.swell)
        self.pad.wanted = self.force * min(1.0, grown, left / max(0.6, self.swell))

    def judge(self, world: Any, force: float) -> None:
        """Note the link's yield in the `world` under `force` in N."""
        if force <= 0.0:
            return
        self.measured = max(self.measured, force)
        if self.rest is not None and world.data.time >= self._touched + self.swell:
            place, inward = self.rest
            self.yielded = max(self.yielded, float((self.place(world)[0] - place) @ inward))

    def place(self, world: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Target (3,) of the pad in m and its direction (3,), against what the yield is measured against."""
        place, inward = self.pad.touching(world)
        if self.against:
            origin, rotation = world.pose(self.against)
            return (place - origin) @ rotation, inward @ rotation
        return place - world.data.subtree_com[world.model.body(world.machine.base.link).id], inward

    @property
    def compliance(self) -> float:
        """In mm/N; 0 for a pad that never pressed."""
        return 1e3 * self.yielded / self.measured if self.measured > 0.0 else 0.0


def outer_taxel(robot: MujocoDynamics, patch: SkinPatch, trunk: str, rng: np.random.Generator) -> int:
    """Returns a random taxel, of `rng`, amid a `patch` facing away from the `trunk` of a `robot`."""
    origin, rotation = robot.pose(patch.link)
    places = patch.positions @ rotation.T + origin
    outward = -(patch.rotations[:, :, 2] @ rotation.T)
    away = places - robot.pose(trunk)[0]
    away[:, 2] = 0.0
    free = np.einsum("ij,ij->i", outward, away) > 0.0 if patch.link != trunk else np.ones(len(patch), dtype=bool)
    central = np.linalg.norm(patch.positions - patch.positions.mean(0), axis=1)
    order = np.argsort(np.where(free, central, math.inf), kind="stable")
    best = order[: max(1, int(free.sum()) // 4)]
    return int(rng.choice(best))
