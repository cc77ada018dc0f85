"""Legs, feet, torso and motors of a robot's model."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.errors import RobotError
from plantar.robots.survey.leg_chains import Legs, find_legs
from plantar.robots.survey.sole_frame import Sole, find_sole
from plantar.robots.survey.stated_model import StatedModel, explained, named_note, read_stated_model
from plantar.robots.survey.wishes import NO_WISHES, Wishes, found

_SPEEDS = (0.5, 100.0)  # rad/s: what a model states outside of them is a placeholder
NO_SPEED = 1e3  # rad/s: stands for no limit
_Limit = TypeVar("_Limit", float, tuple[float, float])
_TORQUE = 50.0  # of the robot's weight times its size: what is larger stands for no limit, or is in N mm
_WEIGHTS = (0.1, 1000.0)  # kg: the least that walk weigh 1 kg, 1000 in g


@dataclass(frozen=True)
class Survey:
    """What was found in a model.

    `held`: angles in rad by name of other joints; `imu`: "site" or "body" of IMU, and its name; or None; `efforts`:
    largest torque in N m of each leg joint, or None; `speeds` in rad/s, or empty; `gains`: stiffness in N m/rad and
    damping in N m s/rad of each leg joint, or empty.
    """

    source: StatedModel
    legs: Legs
    soles: Mapping[Side, Sole]
    held: Mapping[str, float]
    imu: tuple[str, str] | None
    efforts: tuple[float | None, ...]
    speeds: tuple[float, ...]
    gains: tuple[tuple[float, float], ...]
    notes: tuple[str, ...]

    @property
    def mass(self) -> float:
        """Of the robot in kg."""
        return float(mujoco.mj_getTotalmass(self.source.model))

    def joint_names(self, side: Side) -> list[str]:
        """Hinges of a leg from hip to ankle."""
        return [self.source.model.joint(j).name for j in self.legs.by_side[side].joints]

    def foot_name(self, side: Side) -> str:
        """Name of a foot's body."""
        return str(self.source.model.body(self.legs.by_side[side].foot).name)


def survey_model(file: Path, folder: Path, wishes: Wishes = NO_WISHES) -> Survey:
    """Returns the findings on the robot in `file`; converted meshes go to `folder`; `wishes` are taken as they are."""
    source = read_stated_model(file, folder, wishes.posture)
    model = source.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    try:
        legs = find_legs(model, data, str(file), wishes.feet)
        left, right = (len(legs.by_side[s].joints) for s in SIDES)
        if left != right:
            raise RobotError(f"{file}: the left leg has {left} hinges, the right {right}; allowed: as many")
        soles = {s: find_sole(model, data, legs.by_side[s], legs.rotation, str(file)) for s in SIDES}
    except RobotError as error:
        raise explained(error, source.notes) from None
    held, held_notes = _held(source, legs)
    imu = _lowest_imu(source, legs) if wishes.imu is None else _named_imu(source, legs, wishes.imu, str(file))
    names = {s: [model.joint(j).name for j in legs.by_side[s].joints] for s in SIDES}
    pairs = list(zip(names["left"], names["right"], strict=True))
    efforts = tuple(_lesser(source.efforts, pair) for pair in pairs)
    speeds = [_lesser(source.speeds, pair) for pair in pairs]
    usable = [v if v is not None and _SPEEDS[0] <= v <= _SPEEDS[1] else NO_SPEED for v in speeds]
    notes = [*source.notes, *legs.notes, *held_notes, *_coupled_notes(source, names), *_loop_notes(source, legs)]
    toes = {side: ", ".join(legs.by_side[side].toes) for side in SIDES}
    notes += [f"{toes[side]}: below the {side} foot, held (toes)" for side in SIDES if toes[side]]
    notes += _unlike(soles)
    notes += named_note(
        "no torque limit is known, so that none is taken (put the motors' in effort_limits)",
        [name for name, effort in zip(names["left"], efforts, strict=True) if effort is None],
    )
    odd = [f"{n} {v:g}" for n, v, use in zip(names["left"], speeds, usable, strict=True) if v not in (None, use)]
    notes += named_note(f"speed limits beyond {_SPEEDS[0]:g} to {_SPEEDS[1]:g} rad/s are left out", odd)
    unlike = [a for a, b in pairs if source.gains.get(a) != source.gains.get(b)]
    notes += named_note("the legs' own servos differ; the softer one's gains are taken for both", unlike)
    notes += named_note(
        "the joints' springs are left out",
        [name for name in names["left"] + names["right"] if model.joint(name).stiffness.any()],
    )
    feet = sum(float(model.body_mass[list(legs.by_side[side].parts)].sum()) for side in SIDES)
    _check_masses(model, feet, file)
    most = _TORQUE * mujoco.mj_getTotalmass(model) * GRAVITY * float(model.stat.extent)
    strong = [f"{name} {e:g}" for name, e in zip(names["left"], efforts, strict=True) if e is not None and e > most]
    notes += named_note(f"torque limits beyond {most:.2g} N m limit nothing (N m are read, not N mm)", strong)
    gains = [pair for pair in (_lesser(source.gains, pair) for pair in pairs) if pair is not None]
    return Survey(
        *(source, legs, soles, held, imu, efforts, tuple(usable) if min(usable) < NO_SPEED else ()),
        *(tuple(gains) if len(gains) == left else (), tuple(notes)),
    )


def _check_masses(model: Any, feet: float, file: Path) -> None:
    weight = float(mujoco.mj_getTotalmass(model))
    size = 0.5 * float(model.stat.extent)
    radius = np.sqrt(model.body_inertia.max(axis=1) / np.maximum(model.body_mass, 0.01 * weight))
    widest = int(radius.argmax())
    if not (_WEIGHTS[0] <= weight <= _WEIGHTS[1] and radius[widest] <= size):
        raise RobotError(
            f"{file}: the robot weighs {weight:.3g} kg, and '{model.body(widest).name}' turns as if its mass were "
            f"{radius[widest]:.2g} m off; allowed: 0.1 to 1000 kg, {size:.2g} m (masses in kg, inertias in kg m^2)"
        )
    if feet > 0.5 * weight:
        raise RobotError(
            f"{file}: {100.0 * feet / weight:.0f} % of the robot's {weight:.3g} kg are in its feet; allowed: half at "
            "most; give its other links a mass"
        )


def _loop_notes(source: StatedModel, legs: Legs) -> list[str]:
    model = source.model
    return [
        f"a leg is a closed chain: '{a}' and '{b}' are tied together apart from its joints; here each joint has "
        "a motor of its own, and what closes the loop is rigid"
        for a, b in source.loops
        if any(_on_leg(model, legs, model.body(name).id) for name in (a, b))
    ]


def _held(source: StatedModel, legs: Legs) -> tuple[dict[str, float], list[str]]:
    model = source.model
    hinges = {j for leg in legs.by_side.values() for j in leg.joints}
    held = {}
    outside = []
    for joint in range(model.njnt):
        if joint in hinges or model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE:
            continue
        name = model.joint(joint).name
        zero = float(model.qpos0[model.jnt_qposadr[joint]])
        angle = source.upper_posture.get(name, zero)
        if model.jnt_limited[joint]:
            low, high = model.jnt_range[joint].tolist()
            if not low - 1e-6 <= angle <= high + 1e-6:
                outside.append(name)
                angle = min(high, max(low, angle))
        if abs(angle - zero) > 1e-9:
            held[name] = angle
    keyframe = f"arms, head and waist are held as in the model's first keyframe ({len(held)} joints off zero)"
    notes = named_note("held at their limits, which leave zero out", outside[:6])
    return held, [*([keyframe] if source.upper_posture and held else []), *notes]


def _lowest_imu(source: StatedModel, legs: Legs) -> tuple[str, str] | None:
    """The IMU that the fewest joints part from the pelvis: one above the waist turns with it."""
    model = source.model
    usable = [imu for imu in source.imus if _on_body(model, legs, imu)]
    return min(usable, key=lambda imu: _joints_between(model, _body_of_imu(model, imu), legs.pelvis), default=None)


def _named_imu(source: StatedModel, legs: Legs, name: str, where: str) -> tuple[str, str]:
    model = source.model
    sites = [model.site(i).name for i in range(model.nsite)]
    bodies = [model.body(i).name for i in range(1, model.nbody)]
    found([*sites, *bodies], name, "--imu", where)
    imu = ("site" if name in sites else "body", name)
    if not _on_body(model, legs, imu):
        raise RobotError(f"{where}: --imu names '{name}', which hangs on a leg; allowed: above the legs' joints")
    return imu


def _joints_between(model: Any, body: int, pelvis: int) -> int:
    """Joints from a body up to the pelvis's link, or to the world where it is not above."""
    count = 0
    while body > 0 and int(model.body_weldid[body]) != int(model.body_weldid[pelvis]):
        count += int(model.body_jntnum[body])
        body = int(model.body_parentid[body])
    return count


def _body_of_imu(model: Any, imu: tuple[str, str]) -> int:
    kind, name = imu
    return int(model.body(name).id) if kind == "body" else int(model.site(name).bodyid[0])


def _on_body(model: Any, legs: Legs, imu: tuple[str, str]) -> bool:
    return not _on_leg(model, legs, _body_of_imu(model, imu))


def _on_leg(model: Any, legs: Legs, body: int) -> bool:
    moved = {int(model.jnt_bodyid[j]) for leg in legs.by_side.values() for j in leg.joints}
    return body > 0 and (body in moved or _on_leg(model, legs, int(model.body_parentid[body])))


def _lesser(limits: Mapping[str, _Limit], pair: tuple[str, str]) -> _Limit | None:
    return min((limits[name] for name in pair if name in limits), default=None)


def _coupled_notes(source: StatedModel, names: Mapping[Side, list[str]]) -> list[str]:
    return [
        f"'{follower}' follows '{leader}' in the model; here each is driven by itself"
        for follower, leader in dict.fromkeys(source.coupled)
        if any(follower in own for own in names.values())
    ]


def _unlike(soles: Mapping[Side, Sole]) -> list[str]:
    left = soles["left"]
    right = soles["right"]
    mirrored = np.array([[right.low[0], -right.high[1]], [right.high[0], -right.low[1]]])
    gap: NDArray[np.float64] = np.abs(mirrored - [left.low, left.high])
    text = f"the soles differ by up to {1e3 * float(gap.max()):.0f} mm; the shoes are those of the left one, mirrored"
    return [text] if float(gap.max()) > 2e-3 else []
