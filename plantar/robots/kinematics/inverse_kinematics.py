"""Inverse kinematics of tasks: Newton steps, stable near singularities, at limits and out of reach.

A step solves J^T J dq = J^T e, with 1e-8 on the diagonal, where that is well conditioned and within limits. Otherwise:

- **Levels.** Each is solved in the null space of those before (Siciliano and Slotine 1991): unloaded feet miss first.
- **Damping.** With a level's singular values s and near = max(0, 1 - (s / EPSILON)^2), a direction with residual r
  moves by s r / (s^2 + d), with

      d = near EPSILON^2 + S R.

The first term damps near singularities (Maciejewski and Klein 1988, Chiaverini 1997). R is the length of the
residual that no step removes, in the share `near` near a singularity and whole at joint limits: out of reach, Newton's
step would oscillate (Sugihara 2011). A limb bent by x near straight loses reach c x^2 / 2, s = c x, and x goes to 0
where d >= c R / 2. S is the level's largest singular value: c <= 2 S for up to 8 equal parallel links.
- **Posture.** The share `near` of a direction, and what no task uses, is drawn to the reference posture.
- **Scale.** One factor scales a step until no entry is too large.
- **Unit of length.** 1 rad counts as 1 m on a leg of 0.6 m, in proportion.
- **Limits.** Joints that would leave their limits stop there, the farthest first, and the step is solved again.
"""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.joints.task_step import Configuration, NewtonStep, TaskStep
from plantar.robots.kinematics.tasks.posture_task import PostureTask
from plantar.robots.kinematics.tasks.task import Task

_ROUNDING = 1e-8  # on the diagonal of the normal equations
# The largest step L must not carry a limb across the damped zone: c L / 2 <= _EPSILON; c is 0.13 m for a leg of 0.8 m.
# A level's residual counts with at most 1 (m and rad).
_EPSILON = 0.01  # singular value in m/rad below which damping sets in; walks stay above 0.019
# Pivot of the Cholesky factor from which on singular values are looked at. The least pivot is above the least
# singular value: 3.0 to 3.4 times in walks, so this is the pivot of 0.012, and walks stay above 0.052.
_SUSPECT = 0.04
_POSTURE_SHARE = 0.01  # of the way to the reference posture in a step: 0.5 s at 200 steps a second
_INSIDE = 1e-12  # rad or m inside its limit at which a joint stops: rounding does not carry it out
_NULL = 1e-9  # singular value over the largest below which a direction is in the null space


class InverseKinematics:
    """Steps of a configuration towards tasks.

    `data`: its data, to which the tasks are bound; call `move` after a change from outside; `posture`: reference
    posture, for free directions; `columns`: velocities (n,) of model that a step may use, in order; `unit`: length in m
    that counts as 1 rad. Attributes `plain`: number of steps by normal equations.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        tasks: Sequence[Task],
        posture: PostureTask,
        columns: NDArray[np.int_],
        unit: float = 1.0,
    ) -> None:
        self._model = model
        self._data = data
        self._columns = np.asarray(columns, dtype=np.intp)
        self._configuration = data.qpos  # the data's own array
        self.tasks = tuple(tasks)
        self.posture = posture
        rows = sum(task.rows for task in tasks)
        self._jacobian = np.zeros((rows, model.nv))
        self._error = np.zeros(rows)
        ends = np.cumsum([task.rows for task in tasks]).tolist()
        self._rows = [slice(end - task.rows, end) for task, end in zip(tasks, ends, strict=True)]
        self._parts = [(t, self._error[r], self._jacobian[r]) for t, r in zip(tasks, self._rows, strict=True)]
        kernels = [(task, error, task.rows_for(error, jacobian)) for task, error, jacobian in self._parts]
        self._asked = [part for part, (_, _, kernel) in zip(self._parts, kernels, strict=True) if kernel is None]
        self._with_rows = [(task, error) for task, error, kernel in kernels if kernel is not None]
        self._velocity = np.zeros(model.nv)
        in_units = [np.repeat([1.0 / unit, 1.0], [task.lengths, task.rows - task.lengths]) for task in tasks]
        units = np.ones(model.nv)
        for joint in np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)):
            units[model.jnt_dofadr[joint] : model.jnt_dofadr[joint] + 3] = unit
        joint_of = model.dof_jntid[columns]
        kinds = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
        self._movable = np.flatnonzero(np.isin(model.jnt_type[joint_of], kinds))
        joints = joint_of[self._movable]
        self._places = model.jnt_qposadr[joints].astype(np.intp)
        free = model.jnt_limited[joints] == 0  # a joint without limits has the range 0 to 0 in the model
        self._lower = np.where(free, -np.inf, model.jnt_range[joints, 0])
        self._upper = np.where(free, np.inf, model.jnt_range[joints, 1])
        self._newton_jacobian = np.zeros((rows, len(columns)))
        self._newton_step = np.zeros(len(columns))
        self._newton = NewtonStep(
            *(self._columns, np.concatenate(in_units), units, self._movable, self._places),
            np.where(free, 0.0, model.jnt_range[joints].mean(axis=1)),
            np.where(free, np.inf, 0.5 * np.ptp(model.jnt_range[joints], axis=1)),
            *(_ROUNDING, _SUSPECT, (self._jacobian, self._error, self._configuration)),
            *(self._newton_jacobian, self._newton_step, self._velocity),
        )
        self._step_kernel = TaskStep(
            [kernel for *_, kernel in kernels if kernel is not None],
            self._newton,
            _moving(model, self._configuration, self._velocity),
        )
        self._levels: dict[tuple[int, ...], list[NDArray[np.int_]]] = {}
        self.plain = 0
        self.careful = 0
        self._placed = False
        self._drawn = np.zeros((posture.rows, model.nv))
        posture.jacobian(self._drawn)

    def solve(self, iterations: int = 1, largest_step: float = 0.5) -> float:
        """Newton steps from the configuration in the data.

        `largest_step`: largest entry in units of length and rad. Returns largest task error before the last step (units
        of length or rad); NaN if a target is.
        """
        kernel = self._step_kernel
        for _ in range(iterations):
            if not self._placed:
                self.place()
            for task, error, jacobian in self._asked:
                task.error(error)
                task.jacobian(jacobian)
            if kernel.step(largest_step):
                self.plain += 1
            else:
                self._step_with_care(largest_step)
            self._placed = False
        worst: float = self._newton.worst()
        return worst

    def place(self) -> None:
        """Update the data's poses, unless done; spares the next solution its kinematics."""
        if not self._placed:
            mujoco.mj_kinematics(self._model, self._data)
            mujoco.mj_comPos(self._model, self._data)
            self._placed = True

    def move(self) -> None:
        """Mark the configuration as changed from outside."""
        self._placed = False

    def _step_with_care(self, largest: float) -> None:
        kernel = self._step_kernel
        plain = False
        if not kernel.near:
            for task, error in self._with_rows:
                task.error(error)
            plain = self._newton.solve(largest)
        if plain:
            self.plain += 1
        else:
            self._newton_step[:] = self._careful(self._newton_jacobian, largest)
            self.careful += 1
        kernel.move()

    def _careful(self, jacobian: NDArray[np.float64], largest: float) -> NDArray[np.float64]:
        """Step (n,) by levels, damped, scaled, within limits; none if a target is NaN."""
        count = jacobian.shape[1]
        if not np.isfinite(self._error).all():
            return np.zeros(count)
        low = np.full(count, -np.inf)
        high = np.full(count, np.inf)
        here = self._configuration[self._places]
        low[self._movable] = self._lower + _INSIDE - here
        high[self._movable] = self._upper - _INSIDE - here
        pull = np.zeros(self.posture.rows)
        self.posture.error(pull)
        drawn = _POSTURE_SHARE * (pull @ self._drawn)[self._columns]
        stopped = np.zeros(count, dtype=bool)
        step = np.zeros(count)
        stop = step
        for _ in range(len(here) + 1):
            step = self._by_levels(jacobian, drawn, stop, ~stopped, largest)
            beyond = np.where(stopped, 0.0, np.maximum(low - step, step - high))
            worst = int(beyond.argmax())
            if beyond[worst] <= 0.0:
                break
            stopped[worst] = True
            # A joint that starts beyond its limit comes back no faster than others move.
            stop = stop.copy()
            stop[worst] = min(largest, max(-largest, min(high[worst], max(low[worst], step[worst]))))
        return step

    def _by_levels(
        self,
        jacobian: NDArray[np.float64],
        drawn: NDArray[np.float64],
        stop: NDArray[np.float64],
        free: NDArray[np.bool_],
        largest: float,
    ) -> NDArray[np.float64]:
        """Step (n,) level by level, given steps of stopped joints."""
        step = stop.copy()
        basis = np.eye(len(step))[:, free]  # of what the levels so far leave free
        for rows in self._rows_by_level():
            wanted = self._error[rows] - jacobian[rows] @ step
            wanted /= max(1.0, math.sqrt(float(wanted @ wanted)))
            left, values, right = np.linalg.svd(jacobian[rows] @ basis)
            rank = int((values > _NULL * values.max(initial=0.0)).sum())
            pulled = right[: len(values)] @ (drawn @ basis)
            amounts = _amounts(values, left.T @ wanted, pulled)
            more = basis @ (amounts[:rank] @ right[:rank])
            _add(step, more, largest)
            basis = basis @ right[rank:].T
        _add(step, basis @ (drawn @ basis), largest)
        return step

    def _rows_by_level(self) -> list[NDArray[np.int_]]:
        key = tuple(task.level for task in self.tasks)
        if key not in self._levels:
            levels: dict[int, list[slice]] = {}
            for task, rows in zip(self.tasks, self._rows, strict=True):
                levels.setdefault(task.level, []).append(rows)
            self._levels[key] = [np.r_[tuple(levels[level])] for level in sorted(levels)]
        return self._levels[key]


def _moving(model: mujoco.MjModel, configuration: NDArray[np.float64], velocity: NDArray[np.float64]) -> Configuration:
    kinds = model.jnt_type
    places = model.jnt_qposadr.astype(np.intp)
    rates = model.jnt_dofadr.astype(np.intp)
    free, ball = (kinds == int(kind) for kind in (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL))
    single = ~(free | ball)
    offsets = np.arange(3)
    return Configuration(
        np.concatenate([places[single], np.add.outer(places[free], offsets).ravel()]),
        np.concatenate([rates[single], np.add.outer(rates[free], offsets).ravel()]),
        np.concatenate([places[free] + 3, places[ball]]),
        np.concatenate([rates[free] + 3, rates[ball]]),
        *(configuration, velocity),
    )


def _amounts(
    values: NDArray[np.float64], along: NDArray[np.float64], pulled: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Step (k,) along each right singular vector, damped.

    `values`: singular values (k,); `along`: residual (m,) along left singular vectors; `pulled`: way (k,) to posture.
    """
    count = len(values)
    near = np.maximum(0.0, 1.0 - (values / _EPSILON) ** 2)
    stays = math.sqrt(float(near @ along[:count] ** 2) + float((along[count:] ** 2).sum()))
    damping = _ROUNDING + near * _EPSILON**2 + values.max(initial=0.0) * stays
    return np.asarray(values * along[:count] / (values**2 + damping) + near * pulled)


def _add(step: NDArray[np.float64], more: NDArray[np.float64], largest: float) -> None:
    """Add the largest share of `more` that keeps entries allowed."""
    room = np.where(more > 0.0, largest - step, largest + step)
    share = np.divide(room, np.abs(more), out=np.full(len(step), np.inf), where=more != 0.0).min(initial=1.0)
    step += max(0.0, float(share)) * more
