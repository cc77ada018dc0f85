"""A robot leans on a table with one forearm and reaches beyond its feet, one of them on an edge."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.geometry.polygon import convex_hull, signed_margin
from plantar.mujoco.foam_skins import FoamSkins
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sim.body_skin.surface import OBSTACLE_GROUP
from plantar.sim.companion.experiment import Controller, Verdict, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.lean_controller import HAND, PATCH, LeanControl, LeanController
from plantar.sim.companion.standing.standing import StandingExperiment
from plantar.sim.model.contact_truth import feet_contacts

_LOOK_EVERY = 5  # physics steps between two looks at the contacts
_SEEN_LOWER = 0.008  # m below the ground where taxels see it: skin that would carry has no stiction
_OUTSIDE = 0.01  # m: by which the centre of mass has to be outside the polygon of the feet


class LeanSettings(Settings):
    """Reach of the leaning robot.

    Attributes:
        reach: Forward distance of the left hand's target from the middle of the feet.
    """

    table_height: ClassVar[float] = 1.05  # m: height of the table's top that the robot expects
    height_error: ClassVar[float] = 0.03  # Largest difference of the true height from it, either way; the seed draws it
    # Distance of the table's edge from the middle of the feet; the seed moves it by up to 2 cm
    table_edge: ClassVar[float] = 0.32
    sole_share: ClassVar[float] = 0.3  # Share of the right sole that stands on ground; the seed draws which side of it
    # Distance of the centre of mass beyond the front of the ground under the soles, in m
    beyond: ClassVar[float] = 0.06
    reach: float = number(0.55, "m", 0.3, 1.5)

    @property
    def hand_target(self) -> NDArray[np.float64]:
        """Left hand's target (3,) from the middle of the feet in m."""
        return np.array([self.reach, 0.42, 1.15])


class Lean(StandingExperiment):
    """A table, ground under one sole and 30 % of the other."""

    settings_type: ClassVar = LeanSettings
    control_type: ClassVar = LeanControl
    claims: ClassVar = {
        **StandingExperiment.claims,
        "beyond": "the centre of mass is beyond the feet",
        "forearm": "the forearm keeps the table",
        "reach": "the hand reaches its target",
    }
    columns: ClassVar = ("beyond_mm", "forearm_N", "reach_error_mm", "tilt_max_deg", "sole_part")

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.duration = 13.0
        s = self.settings
        self.part = str(self.rng.choice(["front", "rear", "inner", "outer"]))
        self.height = s.table_height + self.rng.uniform(-1.0, 1.0) * s.height_error
        self.edge = s.table_edge + self.rng.uniform(-0.02, 0.02)
        self._controller: LeanController | None = None
        self._carried = [0.0, 0.0]
        self._trace: list[tuple[float, ...]] = []

    def _first_posture(self) -> NDArray[np.float64]:
        qpos = super()._first_posture()
        names = list(self.machine.joints)
        for joint, angle in (("right_shoulder_pitch", -20.0), ("right_elbow", 130.0)):
            qpos[7 + names.index(joint)] = np.radians(angle)
        self.robot.update(qpos, np.zeros(self.robot.model.nv), 0.0)
        over = self.robot.com()[0] * [0.0, 0.0, 1.0] + self._middle()
        return self.stance.solve(self.robot, over, (self.machine.base.link, np.eye(3)), {})

    def _middle(self) -> NDArray[np.float64]:
        return np.asarray(np.mean(list(self.stance.places.values()), axis=0))

    def add_to(self, spec: Any) -> None:
        # As where robots walk: a sole with a load to the side would creep off its edge by 2 mm a second.
        spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        spec.option.impratio = 10.0
        add = spec.worldbody.add_geom
        box = mujoco.mjtGeom.mjGEOM_BOX
        carries = {"contype": 2, "conaffinity": 1, "friction": [0.8, 0.005, 0.0001]}
        shown = {"contype": 0, "conaffinity": 0}
        felt = {**shown, "group": OBSTACLE_GROUP}
        grey = (0.72, 0.74, 0.72)
        for side, (low, high) in self._ground().items():
            middle = 0.5 * (low + high)
            half = 0.5 * (high - low)
            add(name=f"{side}_ground", type=box, size=[*half, 0.05], pos=[*middle, -0.05], rgba=[*grey, 1.0], **carries)
            below = [*middle, -0.01 - _SEEN_LOWER]
            add(name=f"{side}_seen", type=box, size=[*half, 0.01], pos=below, rgba=[*grey, 0.0], **felt)
        plane = mujoco.mjtGeom.mjGEOM_PLANE
        add(name="below", type=plane, size=[5.0, 5.0, 0.1], pos=[0.0, 0.0, -0.1], material="ground", **shown)
        place = [self.stance.places["left_foot"][0] + self.edge + 0.3, -0.42, self.height - 0.02]
        add(name="table", type=box, size=[0.3, 0.3, 0.02], pos=place, rgba=[0.66, 0.5, 0.36, 1.0], **felt)

    def _ground(self) -> dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]]:
        found = {}
        for side in ("left", "right"):
            place = self.stance.places[f"{side}_foot"][:2]
            half = self.robot.model.geom(f"{side}_sole_box").size[:2]
            low = place - half
            high = place + half
            if side == "right":
                share = self.settings.sole_share
                axis = 0 if self.part in ("front", "rear") else 1
                cut = 2.0 * half[axis] * (1.0 - share)
                if self.part in ("front", "inner"):
                    low[axis] += cut
                else:
                    high[axis] -= cut
            found[side] = (low, high)
        return found

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        self._controller = LeanController(self, skin)
        return self._controller

    def act(self, world: World, time: float) -> None:
        if self._steps % _LOOK_EVERY == 0:  # forces of contacts belong to the contacts that there are until the step
            grounds = [{world.model.geom(name).id} for name in ("left_ground", "right_ground")]
            found = feet_contacts(world.model, world.data, grounds)
            self._carried = [-float(contacts.forces[:, 2].sum()) for contacts in found]

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        self._steps += 1
        if self._steps % _LOOK_EVERY:
            return
        self.look_at_trunk(world)
        com = world.data.subtree_com[world.data.body(self.machine.base.link).id].copy()
        corners = [
            [x, y] for low, high in self._ground().values() for x in (low[0], high[0]) for y in (low[1], high[1])
        ]
        beyond = -signed_margin(convex_hull(corners), com[:2])
        hand = world.pose("left_hand")
        target = self._middle() + self.settings.hand_target
        reached = float(np.linalg.norm(hand[0] + hand[1] @ HAND - target))
        self._trace.append((time, beyond, *self._carried, sensor.patch_force(PATCH), reached, *com))

    def verdict(self) -> Verdict:
        trace = np.array(self._trace)
        held = trace[trace[:, 0] > self.duration - 3.0]
        held = held if len(held) else trace[-1:]
        reasons = self.balance_reasons()
        beyond = held[:, 1].min()
        force = held[:, 4].min()
        error = held[:, 5].max()
        goals = unmet(
            (beyond >= _OUTSIDE, "beyond", beyond, _OUTSIDE, f"centre of mass {1e3 * beyond:.0f} mm beyond the feet"),
            (force > 0.0, "forearm", force, 0.0, "the forearm lost the table"),
            (error <= 0.03, "reach", error, 0.03, f"the hand stays {1e3 * error:.0f} mm off its target"),
        )
        figures = {
            "tilt_max_deg": round(self.tilt_max, 2),
            "sole_part": self.part,
            "table_off_mm": round(1e3 * (self.height - self.settings.table_height), 1),
            "beyond_mm": round(1e3 * float(beyond), 1),
            "forearm_N": [round(float(v), 1) for v in (force, held[:, 4].max())],
            "foot_loads_N": [round(float(v), 1) for v in held[:, 2:4].mean(axis=0)],
            "reach_error_mm": round(1e3 * float(error), 1),
        }
        return Verdict(reasons or goals[:1], figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        trace = np.array(self._trace)
        figure, (upper, lower) = new_figure(8.0, 6.5, rows=2)
        names = ("left foot", "right foot, on 30 % of its sole", "forearm")
        for i, (name, colour) in enumerate(zip(names, ("left", "right", "polygon"), strict=True)):
            upper.plot(trace[:, 0], trace[:, 2 + i] / self.weight, color=COLOURS.get(colour), label=name)
        upper.set(xlabel="time [s]", ylabel="true load [body weight]")
        upper.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize=8)
        lower.plot(trace[:, 0], 1e3 * trace[:, 1])
        lower.axhline(0.0, linewidth=0.8, color="0.5")
        lower.set(xlabel="time [s]", ylabel="true centre of mass\nbeyond the feet's polygon [mm]")
        return [save_figure(figure, folder / "lean.png")]
