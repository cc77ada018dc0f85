"""A scene with a `SceneSetting`, and its difference from a reference."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout
from plantar.robots.kinematics.robot_model import Visitor
from plantar.robots.robot import Robot
from plantar.robots.robot_file import load_robot
from plantar.sim.bench.scenes.scene_setting import SceneSetting
from plantar.sim.model.contact_truth import ContactReader, ground_truth
from plantar.sim.model.world import World
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SAMPLE = 0.01
"""Time in s that a sample of a trace is the mean of: a multiple of every physics step that is compared."""

_FORCES_EVERY = 0.001  # s between two looks at the contact forces that such a mean is made of
_CARRIED = 0.01  # of the weight: below it there is no ZMP
_SILENT = ("force", "proximity", "encoder", "gyro", "accelerometer")


class ChangedRun(Simulation):
    """A scene, run with a setting.

    `walk`: settings of scene in every run, such as a number of steps; `noisy`: whether sensors have the scene's noise.
    """

    def __init__(
        self, scene: str, robot: str, setting: SceneSetting, seed: int, walk: Sequence[str] = (), noisy: bool = True
    ) -> None:
        self._setting = setting
        silent = () if noisy else tuple(f"sensing.{name}_noise=0" for name in _SILENT)
        layouts = None if setting.cell_ratio == 1.0 else _layouts(load_robot(robot), setting.cell_ratio)
        super().__init__(load_scene(scene, (*walk, *silent, *setting.settings), robot), seed, layouts)
        if setting.iterations is not None:
            self.world.model.opt.iterations = setting.iterations

    def build_world(self, others: Sequence[Visitor]) -> World:
        world = super().build_world(others)
        model = world.model
        setting = self._setting
        if setting.contact_time is not None:
            own = model.geom_solref[world.sole_geoms["left"][0], 0]
            model.geom_solref[model.geom_solref[:, 0] == own, 0] = setting.contact_time
        return world


def _layouts(robot: Robot, ratio: float) -> dict[Side, SoleLayout]:
    found = {}
    for side in SIDES:
        own = robot.layouts[side]
        laid = hex_layout(own.outline, side=side, cell_area=ratio * own.cell_area)
        found[side] = replace(laid, ranges=own.ranges, thresholds=own.thresholds, modalities=own.modalities)
    return found


@dataclass(frozen=True)
class Trace:
    """True motion and forces of a run, in k means over 10 ms.

    `com`: centre of mass (k, 3) in m; `zmp`: ZMP (k, 2) of mean wrench in m, or NaN; `force`: vertical ground force (k,
    2) on left and right sole in N; `landings`: side, time in s and largest force in N of each; `leg`: leg length in m;
    `weight` in N.
    """

    com: NDArray[np.float64]
    zmp: NDArray[np.float64]
    force: NDArray[np.float64]
    landings: tuple[tuple[str, float, float], ...]
    leg: float
    weight: float


class TracedRun(ChangedRun):
    """A changed run whose motion and ground forces are kept. `keeping_s`: CPU time in s of keeping them."""

    def __init__(self, *args: Any, **named: Any) -> None:
        super().__init__(*args, **named)
        period = self.world.period
        self._every = max(1, round(_FORCES_EVERY / period))
        self._steps = 0
        self._of_sample = round(SAMPLE / period)
        self._contacts = ContactReader(self.world.model, self.world.data, [self.world.sole_geoms[s] for s in SIDES])
        self._touched = [self.world.touch[side] for side in SIDES]
        self._wrench = np.zeros(6)
        self._force = np.zeros(2)
        self._looks = 0
        self.keeping_s = 0.0
        self._landings: tuple[tuple[str, float, float], ...] = ()
        self._rows: list[tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]] = []

    def step_physics(self) -> None:
        super().step_physics()
        began = time.thread_time()
        self._keep()
        self.keeping_s += time.thread_time() - began

    def _keep(self) -> None:
        data = self.world.data
        self._steps += 1
        self._force += data.sensordata[self._touched]
        if self._steps % self._every == 0:
            self._wrench += ground_truth(self._contacts.read()).wrench
            self._looks += 1
        if self._steps % self._of_sample == 0:
            com = data.subtree_com[self.world.torso].copy()
            self._rows.append((com, self._wrench / self._looks, self._force / self._of_sample))
            self._wrench = np.zeros(6)
            self._force = np.zeros(2)
            self._looks = 0

    def keep_landings(self, summary: Mapping[str, Any]) -> None:
        """Keep the landings of the run's summary."""
        named = (summary["landing_sides"], summary["landings_s"], summary["impacts_N"])
        self._landings = tuple(zip(*named, strict=True))

    def trace(self) -> Trace:
        """The trace, after the run."""
        com, wrench, force = (np.array(part) for part in zip(*self._rows, strict=True))
        fz = np.where(wrench[:, 2] > _CARRIED * self.body.weight, wrench[:, 2], np.nan)
        height = self.scene.terrain.height
        zmp = (
            np.column_stack([height * wrench[:, 0] - wrench[:, 4], height * wrench[:, 1] + wrench[:, 3]]) / fz[:, None]
        )
        return Trace(com, zmp, force, self._landings, self.body.leg, self.body.weight)


PARTED = 1 / 60
"""Of the leg: distance of two centres of mass from which on runs count as two walks; 10 mm on H1."""

_SAME_LANDING = 0.05  # s between landings of two runs that are the same landing


class TraceError(NamedTuple):
    """Root mean square differences until the runs part.

    `force` of the vertical sole forces, over the body's weight; `impact` of the landings' impacts until then, over the
    reference's; NaN for none.
    """

    com_m: float
    zmp_m: float
    force: float
    impact: float
    together_s: float


def trace_error(trace: Trace, reference: Trace) -> TraceError:
    """Returns a run's `trace` against its noiseless `reference` of the same seed.

    Tiny differences may change a footstep, so they count until the centers of mass are `PARTED` of the leg apart.

    Example:
        >>> import numpy as np
        >>> still = Trace(np.zeros((3, 3)), np.zeros((3, 2)), np.ones((3, 2)), (("left", 0.01, 200.0),), 0.6, 800.0)
        >>> from dataclasses import replace
        >>> drifted = replace(still, com=np.array([[0.0, 0, 0], [0.001, 0, 0], [0.02, 0, 0]]))
        >>> round(trace_error(drifted, still).together_s, 3), round(1e3 * trace_error(drifted, still).com_m, 3)
        (0.02, 0.707)
    """
    k = min(len(trace.com), len(reference.com))
    apart = np.linalg.norm(trace.com[:k] - reference.com[:k], axis=1)
    far = np.flatnonzero(apart > PARTED * reference.leg)
    n = max(1, int(far[0]) if far.size else k)
    zmp = np.linalg.norm(trace.zmp[:n] - reference.zmp[:n], axis=1)
    force = (trace.force[:n] - reference.force[:n]) / reference.weight
    until = n * SAMPLE
    impacts = []
    for (side, at, impact), (other_side, other_time, other) in zip(trace.landings, reference.landings, strict=False):
        if side != other_side or abs(at - other_time) > _SAME_LANDING or other_time > until:
            break
        if other > 0.0:
            impacts.append((impact - other) / other)
    return TraceError(
        com_m=_rms(apart[:n]),
        zmp_m=_rms(zmp[np.isfinite(zmp)]),
        force=_rms(force),
        impact=_rms(np.array(impacts)) if impacts else float("nan"),
        together_s=until,
    )


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else 0.0
