"""Intentional contact (T 3.4.2): an arm's tip reaches its goal among things that it may push gently."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, choice, number, tables, text
from plantar.errors import SceneError
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.link_skin import BodySkin
from plantar.sim.companion.experiment import Experiment, Verdict, World, unmet
from plantar.sim.companion.handling.actors import come_and_go
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.reaching.free_way import Tip, free_way
from plantar.sim.companion.reaching.layout import KINDS, Layout, random_layout
from plantar.sim.companion.reaching.reach_controller import ReachControl, ReachController
from plantar.sim.companion.reaching.reach_record import ReachRecord
from plantar.sim.figures.render import View
from plantar.sim.model.contact_truth import feet_contacts

_EVERY = 0.02  # s between two records
# of a layout; m from its posts to the links' ends and middles at first
_DRAWS = 100
_CLEAR = 0.08
_TOUCHED = 1.0  # N on an obstacle, from which it counts as touched
_SHOVED_AFTER = (0.2, 1.0)  # s after the first touch
# s: how long, and how long it takes to come and go
_SHOVING = 1.5
_SHOVE_RAMP = 0.3
_MARGIN = 1.1  # of the tolerable force: what a run may have at most


class ReachSettings(Settings):
    """Goal and surroundings.

    Attributes:
        duration: Longest simulated time.
        tip_link: Link of the tip.
        tip: The tip in its frame in m.
        layout: "any" takes them in turn by the seed, a ring only if the tip cannot be lifted into it.
        force_limit: epsilon_c of T Table 1: tolerable force on what is touched.
        near: Least distance of the goal.
        far: Largest.
        least_angle: Least direction from tip to goal, counter-clockwise from x.
        largest_angle: Largest.
        half_height: Of the obstacles, whose middle is at the tip's height.
        tolerance: Distance at which the goal is reached.
        shove: Force on the first touched post, back towards the arm (T Fig. 24d).
    """

    duration: float = number(40.0, "s", 1.0, 600.0)
    tip_link: str = text("link7")
    tip: tuple[float, ...] = tables("a list of 3 numbers")
    layout: str = choice("any", *KINDS)
    force_limit: float = number(15.0, "N", 0.1, 1e3)
    near: float = number(0.4, "m", 0.05, 5.0)
    far: float = number(0.6, "m", 0.05, 5.0)
    least_angle: float = number(0.0, "deg", -360.0, 360.0)
    largest_angle: float = number(90.0, "deg", -360.0, 360.0)
    friction: ClassVar[tuple[float, float]] = (2.0, 5.0)  # N: range of the force that moves a post
    half_height: float = number(0.12, "m", 0.01, 1.0)
    tolerance: float = number(0.015, "m", 1e-3, 1.0)
    shove: float = number(20.0, "N", 0.0, 1e3)
    shove_speed: ClassVar[float] = 0.1  # m/s: speed from which it pushes no more, as a hand does


class IntentionalContactExperiment(Experiment):
    """A layout drawn by the seed; done after half a second at the goal."""

    settings_type = ReachSettings
    control_type = ReachControl
    view = ("", View(3.5, 90.0, -60.0))
    claims: ClassVar = {
        "goal": "the tip reaches its goal",
        "force": "nothing is pushed harder than allowed",
    }
    columns: ClassVar[tuple[str, ...]] = ("layout", "reached_s", "error_mm", "force_max_N", "contacts", "retreats")

    def __init__(self, machine: Machine, settings: ReachSettings, control: ReachControl, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        s = self.settings
        self.duration = s.duration
        point = np.array(s.tip if len(s.tip) else (0.0, 0.0, 0.0), dtype=float)
        self._tip = (s.tip_link, point)
        model = machine.spec().compile()
        data = mujoco.MjData(model)
        data.qpos[-len(machine.posture) :] = machine.posture
        mujoco.mj_kinematics(model, data)
        self.start_tip = Tip.of(model, data, s.tip_link, point)
        self._height = float(self.start_tip.place[2])
        self.layout = self._draw_layout(np.vstack([data.xpos, data.xipos]))
        self._goal = np.array([*self.layout.goal, self._height])
        self.record = ReachRecord(machine, self.layout, s.force_limit)
        self._since = math.inf
        self._reached = math.inf
        self._error = math.inf
        self._highest = 0.0
        self._due = 0.0
        self._pressed: dict[str, NDArray[np.float64]] = {}
        self._posts: dict[str, int] = {}
        self._shove: tuple[str, float, NDArray[np.float64]] | None = None  # which post, from when, and direction
        self._hand: ReachController

    def _draw_layout(self, arm: NDArray[np.float64]) -> Layout:
        # Layouts are drawn until one has no way without contact, and is clear of places (n, 3) of the arm.
        s = self.settings
        tip = self.start_tip
        kinds = KINDS[:-1] if tip.lifts else KINDS
        kind = s.layout if s.layout != "any" else kinds[self.seed % len(kinds)]
        reach = (s.near, s.far), (math.radians(s.least_angle), math.radians(s.largest_angle))
        for _ in range(_DRAWS):
            layout = random_layout(self.rng, kind, tip.place[:2], reach, s.friction)
            clear = min(post.distance(arm, self._height, s.half_height).min() for post in layout.posts) > _CLEAR
            goal = np.array([*layout.goal, self._height])
            if clear and not free_way(tip, goal, s.tolerance, layout.posts, s.half_height):
                return layout
        raise SceneError(f"{_DRAWS} layouts '{kind}' can be solved without contact or touch the arm at first")

    def add_to(self, spec: Any) -> None:
        spec.worldbody.add_light(pos=[0.5, 0.3, 4.0])
        for post in self.layout.posts:
            post.add_to(spec, self._height, self.settings.half_height)
        spec.worldbody.add_site(name="goal", pos=self._goal, size=[0.02, 0.02, 0.02], rgba=[0.2, 0.7, 0.3, 1.0])

    def start(self, world: World) -> None:
        self._posts = {post.name: world.model.geom(post.name).id for post in self.layout.posts}

    def controller(self, machine: Machine, skin: BodySkin) -> ReachController:
        self._hand = ReachController(machine, skin, self.control, self._tip, self.settings.force_limit)
        self._hand.goal.target_position = self._goal
        return self._hand

    def act(self, world: World, time: float) -> None:
        self._pressed = dict.fromkeys(self._posts, np.zeros(3))
        posts = list(self._posts.values())
        found = feet_contacts(world.model, world.data, [{geom} for geom in posts]) if world.data.ncon else ()
        for name, contacts in zip(self._posts, found, strict=False):
            others = ~np.isin(contacts.other_geoms, posts)  # of parts without skin; posts lean on each other too
            self._pressed[name] = contacts.forces[others].sum(axis=0)
        if self._shove is not None:
            name, begin, way = self._shove
            slides = [world.data.joint(f"{name}_{axis}") for axis in "xy"]
            speed = float(way @ [slide.qvel[0] for slide in slides])
            left = min(max(1.0 - speed / self.settings.shove_speed, 0.0), 1.0)
            size = self.settings.shove * left * come_and_go(time, begin, begin + _SHOVING, _SHOVE_RAMP)
            for slide, part in zip(slides, size * way, strict=True):
                slide.qfrc_applied[0] = part

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        origin, rotation = world.pose(self._tip[0])
        tip = origin + rotation @ self._tip[1]
        pushes = {name: w[:3] + self._pressed[name] for name, w in sensor.on_obstacles.items()}
        sizes = {name: float(np.sqrt(push @ push)) for name, push in pushes.items()}
        force = max(sizes.values())
        touched = [post.name for post in self.layout.posts if post.friction and sizes[post.name] > _TOUCHED]
        if self._shove is None and touched and self.settings.shove:
            way = -pushes[touched[0]][:2]
            self._shove = (touched[0], time + self.rng.uniform(*_SHOVED_AFTER), way / np.linalg.norm(way))
        self._highest = max(self._highest, force)
        self._error = float(np.linalg.norm(tip - self._goal))
        self._since = math.inf if self._error > self.settings.tolerance else min(self._since, time)
        if time - self._since >= 0.5 and math.isinf(self._reached):
            self._reached = self._since
        if time >= self._due:
            self._due += _EVERY
            self.record.add(world, time, tip, force, self._hand)
        self.done = math.isfinite(self._reached)

    def verdict(self) -> Verdict:
        s = self.settings
        limit = _MARGIN * s.force_limit
        goal = f"{1e3 * self._error:.0f} mm from the goal at the end"
        pressed = f"{self._highest:.1f} N on an obstacle; limit {limit:g} N"
        why = unmet(
            (math.isfinite(self._reached), "goal", self._error, s.tolerance, goal),
            (self._highest <= limit, "force", self._highest, limit, pressed),
        )
        changes = self.record.changes()
        figures = {
            "layout": self.layout.kind,
            "reached_s": round(self._reached, 3) if math.isfinite(self._reached) else None,
            "error_mm": round(1e3 * self._error, 2),
            "force_max_N": round(self._highest, 3),
            "contacts": changes.count("approach"),
            "retreats": changes.count("retreat"),
        }
        return Verdict(why, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        return [self.record.plot(folder / "reach.png", f"{self.layout.kind}, seed {self.seed}")]
