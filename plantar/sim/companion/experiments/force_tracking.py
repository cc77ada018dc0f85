"""The four experiments of A (4.3): force or distance of a hand on a surface while base, person and object move."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number, tables
from plantar.errors import InputError
from plantar.mechanics.rotation import rotation_from_angles
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.link_skin import BodySkin
from plantar.sim.body_skin.surface import OBSTACLE_GROUP
from plantar.sim.companion.experiment import Experiment, Verdict, World, unmet
from plantar.sim.companion.handling.actors import Fist, Push, Visit, Visitor, come_and_go
from plantar.sim.companion.handling.force_record import ForceRecord
from plantar.sim.companion.handling.hand_controller import HandControl, HandController
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.stance import add_floor
from plantar.sim.figures.render import View

_AFTER = 1.0  # s after an interaction that still count as disturbed by it
_SETTLING = 4.0  # s after the sigmoid, or after coming near, from which force or distance count
_ARM = {"forearm": (0.045, (0.1, 0.3)), "upper_arm": (0.055, (0.15, 0.35))}  # radius and places along it in m
# s: the shortest touch, three ramps long, and between touches
_SHORTEST = 1.2
_PAUSES = (0.2, 0.6)
_EVERY = 5  # physics steps from one look at how things move to the next
_HALF_THICK = 0.02  # m of the object


class ForceTrackingSettings(Settings):
    """Windows are [begin, end] in s; empty for none.

    Attributes:
        duration: Simulated time.
        force: Mean wanted force.
        amplitude: Of its sine.
        distance: Wanted distance before contact.
        contact: Start of the contact phase; 0 for never.
        gap: First distance of hand and object.
        pitch: Range of the object's lean back in degrees; below 0 it hangs over.
        yaw: Range of its first turn about the vertical in degrees.
        circle: When the base is commanded along a circle.
        circle_radius: Its radius.
        swing: When the base is commanded to swing sideways.
        touch: Windows of touches on the arm.
        touch_force: Range of these forces in N.
        person: Windows of a person near the base.
        turn: When the object is turned about the vertical, and back.
        turn_angle: In degrees.
        largest_free: Limit of the force's RMS error without interactions; 0 for none.
        largest_disturbed: The same with interactions.
        tolerance: Limit of the distance's error without contact.
        guided: Least way of a hand that is guided before contact.
    """

    duration: float = number(30.0, "s", 0.5, 600)
    force: float = number(4.0, "N", 0, 100)
    amplitude: float = number(0.0, "N", 0, 100)
    sine_period: ClassVar[float] = 4.0  # Period of its sine
    distance: float = number(0.03, "m", 0.005, 0.1)
    contact: float = number(0.0, "s", 0, 600)
    gap: float = number(0.12, "m", 0.0, 0.5)
    pitch: tuple[float, float] = tables("[low, high] in degrees")
    yaw: tuple[float, float] = tables("[low, high] in degrees")
    circle: tuple[float, float] = tables("[begin, end] in s")
    circle_radius: float = number(0.2, "m", 0, 2)
    swing: tuple[float, float] = tables("[begin, end] in s")
    swing_amplitude: ClassVar[float] = 0.3  # Amplitude of that
    base_period: ClassVar[float] = 8.0  # s: period of both
    touch: tuple[tuple[float, float], ...] = tables("a list of windows [begin, end] in s")
    touch_force: tuple[float, float] = tables("[low, high] in N")
    person: tuple[tuple[float, float], ...] = tables("a list of windows [begin, end] in s")
    too_near: ClassVar[float] = 0.1  # m: how far inside of where the base was the person wants to stand
    turn: tuple[float, float] = tables("[begin, end] in s")
    turn_angle: float = number(15.0, "deg", 0, 90)
    largest_free: float = number(0.0, "N", 0, 100)
    largest_disturbed: float = number(0.0, "N", 0, 100)
    tolerance: float = number(0.005, "m", 0, 1)
    guided: float = number(0.0, "m", 0, 1)

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("pitch", "yaw", "circle", "swing", "touch_force", "turn"):
            _check_pair(name, getattr(self, name))
        for name in ("touch", "person"):
            for window in getattr(self, name):
                _check_pair(name, window, empty=False)

    def windows(self) -> dict[str, list[tuple[float, float]]]:
        """Every interaction's windows in s."""
        single = {name: [getattr(self, name)] for name in ("circle", "swing", "turn") if getattr(self, name)}
        return {"touch": list(self.touch), "person": list(self.person), **single}


def _check_pair(name: str, value: Any, empty: bool = True) -> None:
    good = isinstance(value, list | tuple) and len(value) == 2 and all(isinstance(v, int | float) for v in value)
    if not ((empty and value == ()) or (good and value[0] <= value[1])):
        raise InputError(f"setting '{name}' is {value!r}; allowed: two numbers, the lower one first")


class ForceTracking(Experiment):
    """A hand on an object: one of four experiments, by settings."""

    settings_type = ForceTrackingSettings
    control_type = HandControl
    uses_lidar = True
    view = ("hand", View(3.2, 60.0, -18.0))
    claims: ClassVar = {
        "force_free": "the force follows its target",
        "force_disturbed": "also while touched, turned or visited",
        "contact": "contact is kept",
        "distance": "before contact, the distance is kept",
        "person": "the person is not touched",
        "collision": "base and arm do not hit the object",
        "guidance": "the hand goes along with the one that guides it",
    }
    columns: ClassVar[tuple[str, ...]] = (
        *("force_rms_free_N", "force_rms_disturbed_N", "force_max_N", "contact_lost_s", "distance_error_max_mm"),
        *("person_nearest_m", "guided_m", "hand_moved_mm", "tilt_max_deg", "base_moved_m"),
    )

    def __init__(self, machine: Machine, settings: ForceTrackingSettings, control: HandControl, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        s = self.settings
        self.duration = s.duration
        self._sine = self.rng.uniform(0.0, 2.0 * math.pi)
        self._pitch, self._yaw = (math.radians(self.rng.uniform(*(r or (0.0, 0.0)))) for r in (s.pitch, s.yaw))
        self._offset = self.rng.uniform(-0.05, 0.05, 2)
        self._sign = self.rng.choice([-1.0, 1.0])
        self._fist = Fist(self._pushes())
        self._visitor = Visitor(self._visits())
        self._hand: HandController
        self.record = ForceRecord()
        self._errors: dict[str, list[float]] = {"free": [], "disturbed": [], "distance": []}
        self._measured = 0.0
        self._lost = 0.0
        self._highest = 0.0
        self._tilt = 0.0
        self._moved = 0.0
        self._nearest = math.inf
        self._bumped = 0.0
        self._guided = 0.0
        self._steps = 0
        self._base = np.zeros(3)
        self._places: dict[str, NDArray[np.float64]] = {}

    def _pushes(self) -> list[Push]:
        # Touches in pairs that cancel.
        found: list[Push] = []
        for begin, end in self.settings.touch:
            time = begin
            while end - time >= 2.0 * _SHORTEST + _PAUSES[1]:
                link = str(self.rng.choice(list(_ARM)))
                radius, (low, high) = _ARM[link]
                along = self.rng.uniform(low, high)
                angle = self.rng.uniform(0.0, 2.0 * math.pi)
                force = self.rng.uniform(*(self.settings.touch_force or (5.0, 10.0)))
                pause = self.rng.uniform(*_PAUSES)
                length = min(self.rng.uniform(1.5, 2.5), (end - time - pause) / 2.0)
                for side in (angle, angle + math.pi):
                    found.append(Push(time, time + length, link, along, side, radius, force))
                    time += length + pause
        return found

    def _visits(self) -> list[Visit]:
        half = np.abs(np.array(self.machine.base.footprint, dtype=float)).max(axis=0)
        found = []
        for begin, end in self.settings.person:
            angle = self.rng.choice([-1.0, 1.0]) * math.radians(self.rng.uniform(60.0, 130.0))
            way = np.array([math.cos(angle), math.sin(angle)])
            edge = way * float(np.min(half / np.maximum(np.abs(way), 1e-9)))
            goal = edge + way * (0.2 - self.settings.too_near)
            found.append(Visit(begin, end, goal, goal + 2.0 * way, self.rng.uniform(0.5, 0.8)))
        return found

    def add_to(self, spec: Any) -> None:
        add_floor(spec, carries=False)
        board = spec.worldbody.add_body(name="object", pos=[2.0, 0.0, 1.0], mocap=True)
        board.add_geom(
            name="object",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[_HALF_THICK, 0.75, 0.85],
            group=OBSTACLE_GROUP,
            rgba=[0.6, 0.75, 0.65, 0.6],
        )
        self._fist.add_to(spec)
        self._visitor.add_to(spec)

    def start(self, world: World) -> None:
        mujoco.mj_kinematics(world.model, world.data)
        hand, rotation = world.pose("hand")
        self._places["pivot"] = hand + rotation[:, 2] * self.settings.gap + np.array([0.0, *self._offset])
        self._place_object(world, 0.0)

    def controller(self, machine: Machine, skin: BodySkin) -> HandController:
        self._hand = HandController(machine, skin, self.control)
        self._posture = machine.posture
        return self._hand

    def wanted(self, time: float) -> float:
        """The wanted force in N at a time in s."""
        s = self.settings
        return float(s.force + s.amplitude * math.sin(2.0 * math.pi * time / s.sine_period + self._sine))

    def act(self, world: World, time: float) -> None:
        s = self.settings
        self._hand.wanted_force = self.wanted(time)
        self._hand.force.target_distance = s.distance
        if s.contact and time >= s.contact:
            self._hand.enter_contact(time)
        self._command_base(time)
        self._place_object(world, time)
        self._fist.act(world, time, self._measured)
        self._visitor.act(world, time)

    def _command_base(self, time: float) -> None:
        s = self.settings
        rate = 2.0 * math.pi / self.settings.base_period
        target = self._posture.copy()
        speed = np.zeros(len(self._posture))
        for window, sizes in ((s.circle, (s.circle_radius, s.circle_radius)), (s.swing, (0.0, s.swing_amplitude))):
            if window and window[0] <= time < window[1]:
                phase = rate * (time - window[0])
                share = come_and_go(time, window[0], window[1], 2.0)
                target[:2] += share * np.array(sizes) * (math.cos(phase), math.sin(phase))
                speed[:2] = share * rate * np.array(sizes) * (-math.sin(phase), math.cos(phase))
        self._hand.posture.target = target
        self._hand.posture.target_velocity = speed

    def _place_object(self, world: World, time: float) -> None:
        turn = 0.0
        if self.settings.turn:
            begin, end = self.settings.turn
            third = max((end - begin) / 3.0, 1e-9)
            share = come_and_go(time, begin, end, third)
            turn = self._sign * math.radians(self.settings.turn_angle) * share
        rotation = rotation_from_angles(self._yaw + turn, self._pitch)
        place = world.model.body("object").mocapid[0]
        world.data.mocap_pos[place] = self._places["pivot"] + _HALF_THICK * rotation[:, 0]
        mujoco.mju_mat2Quat(world.data.mocap_quat[place], rotation.ravel())

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        self._measured = math.sqrt(float(np.square(sensor.on_obstacles["fist"][:3]).sum()))
        force = sensor.patch_force("hand")
        self._bumped += 1e-3 * (world.data.ncon > 0)  # skin has no contacts of MuJoCo's, so it is the base or the arm
        if self._in_contact(time):
            self._highest = max(self._highest, force)
            if self._counts(time):
                name = "disturbed" if self._disturbed(time) else "free"
                self._errors[name].append(force - self.wanted(time))
                self._lost += 1e-3 * (force == 0.0)
        self._steps += 1
        if self._steps % _EVERY == 0:
            self._judge_motion(world, sensor, time, force)

    def _judge_motion(self, world: World, sensor: FoamSkins, time: float, force: float) -> None:
        hand, rotation = world.pose("hand")
        middle, turned = world.pose("object")
        front = -turned[:, 0]
        distance = float((hand - middle) @ front) - _HALF_THICK
        tilt = math.degrees(math.acos(min(1.0, float(-front @ rotation[:, 2]))))
        in_contact = self._in_contact(time)
        if in_contact and self._counts(time):
            self._places.setdefault("held", hand)
            self._moved = max(self._moved, float(np.linalg.norm(hand - self._places["held"])))
            self._tilt = max(self._tilt, tilt)
        elif not in_contact and time >= _SETTLING:
            self._errors["distance"].append(distance - self.settings.distance)
        if not self.settings.touch or time <= self.settings.touch[0][0]:
            self._places["guided from"] = hand
        elif not in_contact:
            self._guided = max(self._guided, float(np.linalg.norm(hand - self._places["guided from"])))
        base = world.data.qpos[world.positions[:3]]
        self._base = np.maximum(self._base, np.abs(base))
        if self.settings.person:
            self._nearest = min(self._nearest, self._clearance(world))
        moment = rotation.T @ sensor.wrenches[sensor.body_skin.links.index("hand"), 3:]
        self.record.add(time, self.wanted(time) if in_contact else math.nan, force, distance, moment, hand, base, tilt)

    def _in_contact(self, time: float) -> bool:
        return bool(0.0 < self.settings.contact <= time)

    def _counts(self, time: float) -> bool:
        return bool(time >= self.settings.contact + self.control.sigmoid + _SETTLING)

    def _disturbed(self, time: float) -> bool:
        spans = (span for spans in self.settings.windows().values() for span in spans)
        return any(begin <= time < end + _AFTER for begin, end in spans)

    def _clearance(self, world: World) -> float:
        # Distance in m of person and base footprint, negative inside.
        place = world.data.body("person").xpos[:2]
        base, rotation = world.pose(self.machine.base.link)
        local = rotation[:2, :2].T @ (place - base[:2])
        outside = np.abs(local) - np.abs(np.array(self.machine.base.footprint, dtype=float)).max(axis=0)
        apart = float(np.linalg.norm(np.maximum(outside, 0.0))) + min(float(outside.max()), 0.0)
        return apart - 0.2

    def verdict(self) -> Verdict:
        s = self.settings
        rms = {n: float(np.sqrt(np.mean(np.square(e)))) if e else math.nan for n, e in self._errors.items()}
        worst = max((abs(v) for v in self._errors["distance"]), default=0.0)
        forces = []
        limits = {"free": s.largest_free, "disturbed": s.largest_disturbed if any(s.windows().values()) else 0.0}
        for name, limit in limits.items():
            found = f"RMS error {rms[name]:.3f} N" if self._errors[name] else "there was no time to measure it"
            met = not limit or rms[name] <= limit
            forces.append((met, f"force_{name}", rms[name], limit, f"{found}; limit {limit:g} N"))
        off = f"{1e3 * worst:.1f} mm off; limit {1e3 * s.tolerance:g} mm"
        guided = f"hand guided {self._guided:.3f} m; at least {s.guided:g} m"
        why = unmet(
            *forces,
            (not self._lost, "contact", self._lost, 0.0, f"contact was lost for {self._lost:.3f} s"),
            (bool(s.contact) or worst <= s.tolerance, "distance", worst, s.tolerance, off),
            (self._nearest > 0.0, "person", self._nearest, 0.0, "the base was touched by the person"),
            (not self._bumped, "collision", self._bumped, 0.0, f"base or arm hit the object for {self._bumped:.3f} s"),
            (not s.guided or self._guided >= s.guided, "guidance", self._guided, s.guided, guided),
        )
        figures = {
            "force_rms_free_N": _rounded(rms["free"]),
            "force_rms_disturbed_N": _rounded(rms["disturbed"]),
            "force_max_N": round(self._highest, 3),
            "contact_lost_s": round(self._lost, 4),
            "distance_error_max_mm": round(1e3 * worst, 3),
            "person_nearest_m": _rounded(self._nearest),
            "guided_m": round(self._guided, 4),
            "hand_moved_mm": round(1e3 * self._moved, 2),
            "tilt_max_deg": round(self._tilt, 3),
            "base_moved_m": [round(float(v), 4) for v in self._base],
        }
        return Verdict(why, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        windows = self.settings.windows()
        return [self.record.plot(folder / "force.png", f"seed {self.seed}", windows, bool(self.settings.contact))]


def _rounded(value: float) -> float | None:
    return round(value, 4) if math.isfinite(value) else None
