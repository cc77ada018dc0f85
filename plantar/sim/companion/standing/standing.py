"""What standing experiments share: ground, first posture, balance."""

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.rotation import rotation_from_angles
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sim.body_skin.surface import skin_from_tables
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import Experiment, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.controller import StandingControl
from plantar.sim.companion.standing.joint_range import JointRange
from plantar.sim.companion.standing.pad import Pad
from plantar.sim.companion.standing.stance import Stance, add_floor
from plantar.sim.figures.render import View
from plantar.sim.model.contact_truth import foot_contacts
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.self_collision import SelfCollision, Sphere
from plantar.wholebody.tasks.task import Task

_TILTED = math.cos(math.radians(35.0))  # of the base: it falls
_SETTLING = 0.3  # s until the soles carry evenly
_MARGIN = math.radians(5.0)
_BASE_STIFFER = 6.0  # than the balance: soles give way at first
_LOOK_EVERY = 5  # physics steps between two looks at the contacts of the soles
_CARRIED = 4  # looks over which the centre of pressure is taken


class StandingExperiment(Experiment):
    """A machine on one foot or two, judged by the true contacts.

    `weight` in N; `com_height`: wanted height in m of the centre of mass above the feet; None: the posture's; `roll` of
    the base in degrees; towards the only foot it stands on it relieves that hip; `cop_margin_least`: least distance in
    mm of the true centre of pressure to the soles' edge; `posture`: joints in degrees that differ from the machine's;
    `lift`: height in m of a foot that does not stand.
    """

    control_type: ClassVar = StandingControl
    view: ClassVar = ("", View(2.7, 145.0, -10.0, 0.08))
    claims: ClassVar = {
        "cop_margin_mm": "the centre of pressure stays inside the soles",
        "balance": "it does not fall",
    }
    sides: ClassVar[tuple[str, ...]] = ("left", "right")
    com_height: ClassVar[float | None] = None
    roll: ClassVar[float] = 0.0
    cop_margin_least: ClassVar[float] = 5.0
    posture: ClassVar[Mapping[str, float]] = {}
    lift: ClassVar[float] = 0.06

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        alone = machine.spec().compile()
        self.robot = MujocoDynamics(alone)
        self.stance = Stance(alone, self.sides)
        self.skin = skin_from_tables(alone, machine.patches, machine.name)
        self.weight = GRAVITY * float(alone.body_subtreemass[0])
        self.first = self._first_posture()
        self.robot.update(self.first, np.zeros(alone.nv), 0.0)
        self.com = self.robot.com()[0]
        self.pads: list[Pad] = []
        self.tilt_max = 0.0
        self.com_off_max = 0.0
        self.cop_margin_min = math.inf
        self._steps = 0
        self._borne: deque[tuple[float, ...]] = deque(maxlen=_CARRIED)
        self._forces: dict[str, float] = {}

    def _first_posture(self) -> NDArray[np.float64]:
        # Positions (nq,), centre of mass over the feet.
        robot = self.robot
        model = self.robot.model
        qpos = model.qpos0.copy()
        qpos[7:] = self.machine.posture
        for name, degrees in self.posture.items():
            qpos[model.joint(name).qposadr[0]] = math.radians(degrees)
        robot.update(qpos, np.zeros(model.nv), 0.0)
        link, point = next(iter(self.stance.feet.items()))
        qpos[2] -= robot.place(link, point)[2]
        robot.update(qpos, np.zeros(model.nv), 0.0)
        self.stance.place(robot)
        middle = np.mean(list(self.stance.places.values()), axis=0)
        height = robot.com()[0][2] if self.com_height is None else self.com_height
        lifted = {}
        for side in ("left", "right"):
            foot = f"{side}_foot"
            if foot not in self.stance.feet:
                lifted[foot] = robot.pose(foot)[0] + [0.0, 0.02 if side == "left" else -0.02, self.lift]
        turned = (self.machine.base.link, rotation_from_angles(0.0, roll=math.radians(self.roll)))
        return self.stance.solve(robot, np.array([middle[0], middle[1], height]), turned, lifted)

    def add_to(self, spec: Any) -> None:
        add_floor(spec)
        for pad in self.pads:
            pad.add_to(spec)

    def start(self, world: World) -> None:
        world.data.qpos[world.positions] = self.first

    def balance_tasks(self) -> list[Task]:
        """Keep the centre of mass in place and the base upright."""
        stiff = self.control.balance
        gains = PoseGains(turn_stiffness=stiff, turn_damping=2.0 * math.sqrt(stiff))
        upright = CartesianPose(self.machine.base.link, gains=gains, rows="orientation")
        upright.target_rotation = rotation_from_angles(0.0, roll=math.radians(self.roll))
        self.balance = CenterOfMass(self.com.copy(), stiff)
        return [self.balance, upright]

    def base_task(self) -> CartesianPose:
        """Keeps the base where it is."""
        stiff = _BASE_STIFFER * self.control.balance
        damp = 2.0 * math.sqrt(stiff)
        return CartesianPose(self.machine.base.link, gains=PoseGains(stiff, damp, stiff, damp))

    def posture_task(self) -> Posture:
        """Springs and dampers towards the first posture, by motor torque."""
        strength = self.machine.efforts / 75.0
        stiff = self.control.posture * strength
        damp = self.control.posture_damping * strength
        return Posture(self.first[7:], stiff, damp, torques=True)

    def joint_range_task(self) -> JointRange:
        """Keeps joints 5 degrees off their ends, half their effort there."""
        low, high = self.machine.ranges(self.robot.model)
        stiff = 0.5 * self.machine.efforts / _MARGIN
        return JointRange(low, high, _MARGIN, stiff, 0.1 * stiff)

    def self_collision_task(self) -> SelfCollision:
        """Keeps hands and forearms from trunk, legs and each other."""
        trunk = [Sphere("torso", np.array([0.0, y, z]), 0.13) for y in (-0.07, 0.07) for z in (0.18, 0.32, 0.46)]
        trunk.append(Sphere("base", np.array([0.0, 0.0, -0.06]), 0.14))
        hands = [Sphere(f"{s}_hand", np.array([0.0, 0.0, -0.09]), 0.06) for s in ("left", "right")]
        arms = [
            Sphere(f"{s}_lower_arm", np.array([0.0, 0.0, z]), 0.05) for s in ("left", "right") for z in (-0.1, -0.2)
        ]
        pairs = [(limb, part) for limb in (*hands, *arms) for part in trunk]
        pairs += [(a, b) for a in (hands[0], *arms[:2]) for b in (hands[1], *arms[2:])]
        left, right = (
            [Sphere(f"{s}_{k}", np.array([0.0, 0.0, -0.25]), 0.05) for k in ("thigh", "shank")]
            for s in ("left", "right")
        )
        pairs += [(a, b) for a in left for b in right]
        return SelfCollision(pairs, margin=0.03, stiffness=2000.0, damping=60.0)

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        self._forces.clear()
        for pad in self.pads:
            if not pad.parked:
                rotation = world.data.body(pad.patch.link).xmat.reshape(3, 3)
                self._forces[pad.name] = pad.force(sensor.on_obstacles, rotation)
        self._steps += 1
        if self._steps % _LOOK_EVERY:
            return
        self.look_at_trunk(world)
        if time < _SETTLING:
            return
        base = world.data.body(self.machine.base.link)
        off = world.data.subtree_com[base.id][:2] - self.com[:2]
        self.com_off_max = max(self.com_off_max, float(np.hypot(*off)))

    def look_at_trunk(self, world: World) -> None:
        """Whether its base tilts or sinks."""
        base = world.data.body(self.machine.base.link)
        up = float(base.xmat[8])
        self.tilt_max = max(self.tilt_max, math.degrees(math.acos(min(1.0, up))))
        self.fell = bool(self.fell or up < _TILTED or base.xpos[2] < 0.7 * self.first[2])

    def pressing(self, pad: Pad) -> float:
        """True force in N of a pad at the last physics step."""
        return self._forces.get(pad.name, 0.0)

    def act(self, world: World, time: float) -> None:
        if time > _SETTLING and self._steps % _LOOK_EVERY == 0:  # contact forces are those of the last whole step
            self.cop_margin_min = min(self.cop_margin_min, self._cop_margin(world))
        for pad in self.pads:
            pad.act(world, self.pressing(pad), world.model.opt.timestep)

    def _cop_margin(self, world: World) -> float:
        # Distance in m of true centre of pressure, over 20 ms, to the soles' rectangle; negative outside.
        model = world.model
        data = world.data
        floor = model.geom("floor").id
        pressed = foot_contacts(model, data, {floor})
        loads = -pressed.forces[:, 2]
        self._borne.append((float(loads.sum()), *(loads @ pressed.positions[:, :2]).tolist()))
        total, *moment = np.sum(self._borne, axis=0)
        if total < 0.2 * GRAVITY:
            return -1.0
        corners = []
        for side in self.sides:
            geom = model.geom(f"{side}_sole_box")
            corners += [data.geom(geom.id).xpos[:2] + s * geom.size[:2] for s in (-1.0, 1.0)]
        low = np.min(corners, axis=0)
        high = np.max(corners, axis=0)
        cop = np.array(moment) / total
        return float(min((cop - low).min(), (high - cop).min()))

    def balance_reasons(self) -> list[dict[str, Any]]:
        """Failed criteria of the balance."""
        if self.fell:
            return unmet((False, "balance", self.tilt_max, 35.0, f"it fell: tilted by {self.tilt_max:.0f} degrees"))
        margin = 1e3 * self.cop_margin_min
        least = self.cop_margin_least
        text = f"the centre of pressure was {margin:.1f} mm inside the soles' edge; wanted: {least:g}"
        return unmet((margin >= least, "cop_margin_mm", margin, least, text))

    def balance_figures(self) -> dict[str, Any]:
        """Figures of the balance."""
        return {
            "tilt_max_deg": round(self.tilt_max, 2),
            "com_off_max_mm": round(1e3 * self.com_off_max, 1),
            "cop_margin_min_mm": None if self.fell else round(1e3 * self.cop_margin_min, 1),
        }


def by_active(took: Sequence[float], active: Sequence[int]) -> dict[str, float]:
    """Returns the median time in us of ticks `took` by number of `active` links."""
    counts = np.array(active)
    times = np.array(took[: len(active)])
    return {str(n): round(float(np.median(times[counts == n])), 1) for n in np.unique(counts).tolist()}
