"""Readings of soles without taxels: from force-torque sensors at the ankles, or from the torques of the leg motors.

The ground's wrench on a sole is spread over the cells of its layout as over an elastic foundation that cannot pull,

    f_i = max(0, a + b x_i + c y_i)      with a, b, c fitted to fz and the centre of pressure,

so that forces add up to fz; a centre of pressure beyond the outermost cells goes to the nearest point among them.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Sensors
from plantar.gait.estimate.ankle_sensor import AnkleSensor, SoleWrench
from plantar.geometry.polygon import convex_hull
from plantar.kernels.contacts.pressed_patch import PressedPatch
from plantar.kernels.geometry import convex
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.lip import GRAVITY
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.robot import LegNames
from plantar.sensing.cell_patch import pressed_patch
from plantar.sensing.reading import Reading

_MISSED = 1e-3  # m from the center of pressure above which other cells are tried
_TINY = 1e-12  # m^2: the square of a side that is none
_STRAIGHT = 0.02  # of the largest singular value of J: a straight leg's axial force does not show in its torques
_LYING = 1e-3  # sine between the base's x axis and the vertical, below which its z axis is ahead


class SoleSource(Protocol):
    """Makes the soles' readings from what else a robot measures."""

    def readings(self, sensors: Sensors) -> dict[Side, Reading]:
        """Readings at a tick; none where nothing usable was measured. Never raises."""
        ...


class LoadSpread:
    """Spreads a vertical load over the cells of a sole.

    Example:
        >>> from plantar import hex_layout
        >>> spread = LoadSpread(hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]))
        >>> force = spread.forces(100.0, (0.02, 0.01))
        >>> [round(float(v), 6) for v in (force.sum(), *(force @ spread.places / 100.0))]
        [100.0, 0.02, 0.01]
    """

    def __init__(self, layout: SoleLayout) -> None:
        self.places = layout.positions[:, :2].copy()
        self._hull = convex_hull(self.places)
        self._least = 2.0 * layout.force_threshold  # so that each of the cells reports what it carries
        self._whole = self._patch_of(np.arange(len(self.places)))
        away = ((self._hull[:, None] - self.places) ** 2).sum(axis=2)
        self._rim = away.argmin(axis=1)  # cell of each corner of the hull

    def _patch_of(self, cells: NDArray[np.intp]) -> PressedPatch:
        return pressed_patch(cells, np.ones(len(cells)), self.places[cells])

    def forces(self, load: float, at: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns forces (n,) in N of a `load` in N at a point (x, y) of the sole frame in m.

        A load that is too small for all cells is carried by some about the point, with the same center of pressure
        where three or more carry it.
        """
        count = len(self.places)
        if not load > 0.0:
            return np.zeros(count)
        point = convex.nearest(self._hull, *map(float, at))
        most = min(count, max(1, int(load / self._least)))
        if most == count:
            return _spread(self._whole, load, point, count)
        nearest = np.argsort(((self.places - point) ** 2).sum(axis=1), kind="stable")
        found = _spread(self._patch_of(nearest[:most]), load, point, count)
        missed = self._missed(found, load, point)
        if missed < _MISSED:
            return found
        # At the rim the nearest cells may all lie on one side: the two at the ends of the hull's side surround it.
        ends = self._side_at(point)
        cells = np.concatenate([ends, nearest[~np.isin(nearest, ends)]])[:most]
        other = _spread(self._patch_of(cells), load, point, count)
        return other if self._missed(other, load, point) < missed else found

    def _missed(self, forces: NDArray[np.float64], load: float, point: tuple[float, float]) -> float:
        """Distance in m of the forces' center from a point."""
        x, y = (forces @ self.places / load).tolist()
        return math.hypot(x - point[0], y - point[1])

    def _side_at(self, point: tuple[float, float]) -> NDArray[np.intp]:
        """The cells at the ends of the hull's side that is nearest to a point."""
        nexts = np.roll(self._hull, -1, axis=0)
        way = nexts - self._hull
        off = np.array(point) - self._hull
        along = np.clip((off * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), _TINY), 0.0, 1.0)
        side = int(((off - along[:, None] * way) ** 2).sum(axis=1).argmin())
        return np.asarray(self._rim[[side, (side + 1) % len(self._rim)]])


def _spread(patch: PressedPatch, load: float, point: tuple[float, float], count: int) -> NDArray[np.float64]:
    found = np.zeros(count)
    if not patch.spread(load, *point, found):
        patch.settle(load, found)
    return found


class AnkleSoles:
    """Readings by the ankles' force-torque sensors (`Sensors.ankles`)."""

    def __init__(self, layouts: Mapping[Side, SoleLayout], sensors: Mapping[Side, AnkleSensor], legs: LegModel) -> None:
        self._spreads = {side: LoadSpread(layouts[side]) for side in SIDES}
        self._sensors = dict(sensors)
        self._legs = legs

    def readings(self, sensors: Sensors) -> dict[Side, Reading]:
        """Readings at a tick; none of a sole whose sensor reports no numbers. Never raises."""
        found: dict[Side, Reading] = {}
        if not _usable(sensors, len(self._legs.joints)):
            return found
        up = _upright(sensors.accelerometer)
        soles = self._legs.posture(sensors.joint_positions).rotations
        for side in SIDES:
            measured = sensors.ankles.get(side)
            if measured is not None and np.shape(measured) == (6,):
                wrench = self._sensors[side].sole_wrench(measured, up @ soles[side])
                _add(found, side, self._spreads[side], sensors.time, wrench)
        return found


class TorqueSoles:
    """Readings by the torques of the leg motors (`Sensors.torques`), as of legs at rest: J^T F = g - tau.

    J is the sole's Jacobian, g what gravity needs in the leg's joints along the measured specific force, and tau the
    measured torques. What moves a swinging leg counts as load; of a leg of fewer than six joints the wrench with the
    least norm is taken.
    """

    def __init__(self, layouts: Mapping[Side, SoleLayout], legs: LegModel, names: Mapping[Side, LegNames]) -> None:
        model = legs.model
        self._spreads = {side: LoadSpread(layouts[side]) for side in SIDES}
        self._model = model
        self._data = mujoco.MjData(model)
        self._data.qpos[:] = legs.configuration
        self._count = len(legs.joints)
        self._sites = {side: model.site(names[side].sole_site).id for side in SIDES}
        ids = {side: [model.joint(name).id for name in names[side].joints] for side in SIDES}
        self._places = model.jnt_qposadr[[*ids["left"], *ids["right"]]]
        self._dofs = {side: model.jnt_dofadr[ids[side]] for side in SIDES}
        half = len(ids["left"])
        self._own = {"left": slice(0, half), "right": slice(half, self._count)}

    def readings(self, sensors: Sensors) -> dict[Side, Reading]:
        """Readings at a tick; none where torques are missing or no numbers. Never raises."""
        found: dict[Side, Reading] = {}
        torques = sensors.torques
        if torques is None or np.shape(torques) != (self._count,) or not _usable(sensors, self._count):
            return found
        data = self._data
        model = self._model
        mujoco.mju_mat2Quat(data.qpos[3:7], _upright(sensors.accelerometer).ravel())
        data.qpos[self._places] = sensors.joint_positions
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        gravity = np.zeros(model.nv)
        mujoco.mj_rne(model, data, 0, gravity)  # of a robot at rest
        gravity *= float(np.linalg.norm(sensors.accelerometer)) / GRAVITY
        jacobian = np.zeros((6, model.nv))
        for side in SIDES:
            site = self._sites[side]
            mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], site)
            rotation = data.site_xmat[site].reshape(3, 3)
            dofs = self._dofs[side]
            own = np.vstack([rotation.T @ jacobian[:3, dofs], rotation.T @ jacobian[3:, dofs]])
            wrench = np.linalg.lstsq(own.T, gravity[dofs] - torques[self._own[side]], rcond=_STRAIGHT)[0]
            _add(found, side, self._spreads[side], sensors.time, SoleWrench(wrench))
        return found


def _usable(sensors: Sensors, count: int) -> bool:
    """Whether time, joint angles and specific force are numbers of the right shapes."""
    pull = sensors.accelerometer
    shapes = np.shape(pull) == (3,) and np.shape(sensors.joint_positions) == (count,)
    finite = shapes and np.isfinite(sensors.joint_positions).all() and np.isfinite(pull).all()
    return bool(finite and math.isfinite(sensors.time) and np.linalg.norm(pull) > 0.0)


def _upright(pull: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) from the base to a world whose z axis is along the specific force `pull` (3,)."""
    up = pull / np.linalg.norm(pull)
    ahead = np.array([1.0, 0.0, 0.0]) - up[0] * up
    if np.linalg.norm(ahead) < _LYING:
        ahead = np.array([0.0, 0.0, 1.0]) - up[2] * up
    ahead = ahead / np.linalg.norm(ahead)
    return np.array([ahead, np.cross(up, ahead), up])


def _add(found: dict[Side, Reading], side: Side, spread: LoadSpread, time: float, wrench: SoleWrench) -> None:
    """Add the reading of a `wrench` on a sole, if it holds numbers."""
    if np.isfinite(wrench.wrench_in_sole).all():
        point = wrench.position_cop_in_sole
        at = np.zeros(2) if point is None else point
        found[side] = Reading(time, spread.forces(wrench.vertical_force, at))
