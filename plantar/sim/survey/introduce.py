"""From a model file to a robot that walks."""

import os
import re
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import write_text
from plantar.common.console.ending import one_line
from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES
from plantar.errors import RobotError
from plantar.geometry.polygon import area
from plantar.layouts.layout_file import read_layout
from plantar.robots.robot import LegNames, Robot
from plantar.robots.robot_file import load_robot
from plantar.robots.survey.fitted_gait import FittedGait, fit_gait
from plantar.robots.survey.model_copy import add_rotors, write_model_copy
from plantar.robots.survey.robot_text import robot_text
from plantar.robots.survey.servo_gains import rotor_inertia
from plantar.robots.survey.stated_model import explained
from plantar.robots.survey.survey import Survey, survey_model
from plantar.robots.survey.wishes import NO_WISHES, Wishes
from plantar.robots.walk import CONTROL_PERIOD
from plantar.sim.survey.check import check_robot
from plantar.sim.survey.robot_picture import draw_robot
from plantar.sim.survey.trial_walk import TRIALS, Trial, level_trial, other_trials, push_text

# Of the leg whose steps missed a trial, tried next: JVRC-1, whose knees leave no crouch, steps off a slab with 0.8
_SHORTER = 0.75
_SHOE_DENSITY = 15.5  # kg/m^2 of a shoe that was not built: those built for feet of 130 and 230 mm have 15.3 and 15.5
# With 1 the soles of light feet rattle on a beam's edges: G1, two iCubs and Romeo cross it with 5 of 20 fresh seeds,
# with 2 they do with 19. With 4, soles creep while a foot swings, and G1 comes over no obstacle.
_CONTACT_DAMPING = 2.0
_NO_OPENGL = (RuntimeError, ImportError, AttributeError, mujoco.FatalError)  # as MuJoCo reports a lack of it
_LICENCES = ("LICENSE*", "LICENCE*", "COPYING*", "NOTICE*")
_NO_NAME = re.compile(r"[^A-Za-z0-9_.-]+")


class ShoesMade(Protocol):
    """What shoes that were built provide."""

    @property
    def thickness(self) -> float:
        """From outer contact face to bare sole in m."""
        ...

    @property
    def mass(self) -> float | None:
        """Of one in kg, or None."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """Findings, assumptions, decisions."""
        ...


MakeShoes = Callable[[str, NDArray[np.float64], Path, float], ShoesMade]
"""Builds the shoes from the robot's name, the surface (n, 3, 3) of the left foot in the frame of its bare sole in m, a
folder to write to, and the robot's mass in kg."""


@dataclass(frozen=True)
class Introduced:
    """A robot whose file was written.

    `trials`: what its trial walks missed, which alone decides; `walked`: what the check expects, and what is missing.
    """

    robot: Robot
    survey: Survey
    fitted: FittedGait
    shoes: ShoesMade
    files: tuple[str, ...]
    trials: tuple[Trial, ...]
    walked: tuple[str, ...]

    @property
    def walks(self) -> bool:
        """Whether each trial is completed."""
        return all(trial.completed for trial in self.trials)

    @property
    def missed(self) -> tuple[str, ...]:
        """A line for each trial that is not completed."""
        return tuple(trial.text() for trial in self.trials if not trial.completed)

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on model, fit and first steps."""
        return (*self.survey.notes, *self.fitted.notes, *self.walked)

    def as_dict(self, output: Path) -> dict[str, Any]:
        """Plain JSON values, with files below a folder."""
        robot = self.robot
        survey = self.survey
        return {
            "name": robot.name,
            "walks": self.walks,
            "trials": [trial.as_dict() for trial in self.trials],
            "mass_kg": round(self.fitted.body.mass, 3),
            "leg_length_m": self.fitted.body.leg,
            "legs": {s: list(robot.legs[s].joints) for s in SIDES},
            "feet": {s: robot.legs[s].foot_body for s in SIDES},
            "sole_turn_deg": {s: round(float(np.degrees(survey.soles[s].turn)), 2) for s in SIDES},
            "torso": robot.torso_body,
            "imu": None if survey.imu is None else survey.imu[1],
            "com_height_m": robot.com_height,
            "stance_width_m": robot.stance_width,
            "single_support_s": robot.single_support,
            "double_support_s": robot.double_support,
            "taxels": len(robot.layouts["left"]),
            "stiffness": list(robot.stiffness),
            "damping": list(robot.damping),
            "effort_limits": list(robot.effort_limits),
            "notes": [*self.notes, *self.shoes.notes],
            "files": [str(output / name) for name in self.files],
        }

    def text(self, output: Path) -> str:
        """As text."""
        robot = self.robot
        survey = self.survey
        body = self.fitted.body
        turns = " and ".join(f"{np.degrees(survey.soles[s].turn):.1f}" for s in SIDES)
        joints = robot.legs["left"].joints
        taxels = len(robot.layouts["left"])
        file = output / "robot.toml"
        size = f"{1e3 * body.sole:.0f} x {1e3 * body.sole_width:.0f} mm"
        return "\n".join(
            [
                f"{robot.name}: {body.mass:.3g} kg with shoes, {len(joints)} joints a leg; legs of {body.leg:.3f} m",
                *(f"  {s} leg: {' '.join(robot.legs[s].joints)}, foot {robot.legs[s].foot_body}" for s in SIDES),
                f"  soles: {size}, {taxels} taxels each; tilted by {turns} degrees against their bodies' axes",
                f"  walks with its CoM at {robot.com_height:.3f} m, feet {robot.stance_width:.3f} m apart, "
                f"{robot.single_support:g} + {robot.double_support:g} s a step",
                *(f"  note: {note}" for note in self.notes),
                *(f"  trial {trial.text()}" for trial in self.trials),
                f"made {file}: look at {output / 'robot.png'}, then",
                f"  plantar robot check {file}",
                f"  plantar sim flat --robot {file}",
            ]
        )


def introduce(
    file: str | os.PathLike[str],
    folder: Path,
    make_shoes: MakeShoes,
    progress: Callable[[float, str], None] | None = None,
    wishes: Wishes = NO_WISHES,
    trials: Sequence[str] = tuple(TRIALS),
) -> Introduced:
    """Write robot file, model copy, shoes and picture, and let it walk; returns robot and reasons.

    Its trials decide whether the robot is introduced: see `Introduced.walks`. What the check expects is a note.

    Args:
        file: The model, MJCF or URDF.
        folder: Existing folder.
        make_shoes: Builds the shoes.
        progress: Gets fraction done and text.
        wishes: What is stated instead of found.
        trials: Names of `TRIALS`; the first is level ground.

    Raises:
        RobotError: If the file holds no biped; the message explains why.
        FootError: If a foot cannot carry taxels.
    """
    report = progress or (lambda fraction, text: None)
    path = Path(file)
    with TemporaryDirectory() as scratch:
        report(0.0, "reading the model")
        survey = survey_model(path, Path(scratch), wishes)
        name = _NO_NAME.sub("_", survey.source.name).strip("_") or "robot"
        imu = None if survey.imu is None else (*survey.imu, "imu")
        upright = write_model_copy(survey.source.model, survey.legs, folder, name, survey.held, imu)
    report(0.1, "building the shoes")
    shoes = make_shoes(name, survey.soles["left"].triangles, folder, survey.mass)
    report(0.6, "fitting the walk")
    draft = _draft(survey, shoes, folder, name, upright)
    try:
        fitted = _fitted(draft, survey.gains, wishes)
    except RobotError as error:
        raise explained(error, survey.notes) from None
    file = folder / "robot.toml"
    text = robot_text(survey, fitted, shoes.notes, shoes.mass is not None)
    _copy_licences(path, folder)
    report(0.7, "walking in simulation: on level ground, over a stone and a slab, and being pushed")
    walked = _walked(file, text, trials)
    notes: list[str] = []
    missed = [trial.text() for trial in walked if not trial.completed]
    if missed and walked[0].completed and wishes.leg is None and not fitted.robot.rocks:
        report(0.8, "walking with shorter steps")
        first = file.read_text(encoding="utf-8")
        stated = replace(wishes, leg=round(_SHORTER * fitted.body.leg, 4))
        shorter = fit_gait(draft, survey.gains, fitted.rotors, stated, fitted.known)
        text = robot_text(survey, shorter, shoes.notes, shoes.mass is not None)
        again = _walked(file, text, trials, fitted.body)
        if all(trial.completed for trial in again):
            notes += [
                f"with steps for a leg of {fitted.body.leg:g} m a trial is missed: {miss}; the same slab and push are "
                f"completed with steps that are shares of leg_length = {shorter.body.leg:g} m (--leg)"
                for miss in missed
            ]
            fitted = shorter
            walked = again
        else:
            write_text(file, first)
    robot = load_robot(file)
    report(0.9, "drawing the robot")
    notes += [f"the check expects trouble: {doubt}" for doubt in check_robot(file, "flat").failures]
    try:
        draw_robot(robot, folder / "robot.png")
    except _NO_OPENGL as error:
        notes.append(f"robot.png is not drawn: {one_line(error)} (set MUJOCO_GL=egl before mujoco is imported)")
    files = sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    return Introduced(robot, survey, fitted, shoes, tuple(files), walked, tuple(notes))


def _walked(file: Path, text: str, trials: Sequence[str], body: BodyScale | None = None) -> tuple[Trial, ...]:
    """Write a robot file with a `text`, and thresholds of a push by its walk on level ground; returns its trials.

    `body`: whose slab and push they are, in m and m/s; by default the robot's own.
    """
    write_text(file, text)
    level, first = level_trial(str(file))
    write_text(file, text + push_text(level))
    return first, *other_trials(str(file), trials, first, body)


def _fitted(draft: Robot, gains: Sequence[tuple[float, float]], wishes: Wishes) -> FittedGait:
    fitted = fit_gait(draft, gains, wishes=wishes)
    assumed = rotor_inertia(fitted.inertia, fitted.body.mass, fitted.robot.com_height, CONTROL_PERIOD)
    if draft.model_file is None or not assumed.any():
        return fitted
    joints = [(name, float(v)) for s in SIDES for name, v in zip(draft.legs[s].joints, assumed, strict=True)]
    add_rotors(draft.model_file, {name: value for name, value in joints if value > 0.0})
    return fit_gait(draft, gains, assumed, wishes, fitted.known)


def _draft(survey: Survey, shoes: ShoesMade, folder: Path, name: str, upright: str) -> Robot:
    joints = {s: tuple(survey.joint_names(s)) for s in SIDES}
    layouts = {s: read_layout(folder / f"layout_{s}.json") for s in SIDES}
    if survey.foot_name("left") == survey.foot_name("right"):
        raise RobotError(f"{survey.source.file}: both feet are called '{survey.foot_name('left')}'")
    return Robot(
        name=name,
        description=f"{name}: {survey.mass:.3g} kg, {len(joints['left'])} joints a leg",
        kind="mjcf",
        biped=None,
        model_file=folder / "model.xml",
        foot=None,
        shoe_thickness=shoes.thickness,
        shoe_mass=shoes.mass
        if shoes.mass is not None
        else round(_SHOE_DENSITY * abs(area(layouts["left"].outline)), 4),
        rim_stiffness=0.0,
        contact_damping=_CONTACT_DAMPING,
        sole_origins=MappingProxyType(
            {s: survey.soles[s].origin - shoes.thickness * survey.soles[s].rotation[:, 2] for s in SIDES}
        ),
        sole_rotations=MappingProxyType({s: survey.soles[s].rotation for s in SIDES}),
        effort_limits=tuple(1e5 if e is None else min(e, 1e5) for e in survey.efforts) if any(survey.efforts) else (),
        velocity_limits=survey.speeds,
        layouts=layouts,
        legs={s: LegNames(joints[s], survey.foot_name(s), f"{s}_sole") for s in SIDES},
        torso_body=upright,
        imu_site="imu",
        posture={s: (0.0,) * len(joints[s]) for s in SIDES},
        com_height=1.0,
        stance_width=0.2,
        leg_length=0.0,
        largest_crouch=0.0,
        trunk_lean=0.0,
        single_support=0.9,
        double_support=0.3,
        approach_support=0.0,
        pace=1.0,
        ankle_reach=1.0,
        rocks=False,
        stiffness=(1000.0,) * len(joints["left"]),
        damping=(10.0,) * len(joints["left"]),
        own_stiffness=(),
        own_damping=(),
        balance={"law": "com_admittance"},
        controller={},
        path=folder / "robot.toml",
    )


def _copy_licences(model: Path, folder: Path) -> None:
    for place in (model.parent, model.parent.parent):
        found = [p for pattern in _LICENCES for p in sorted(place.glob(pattern)) if p.is_file()]
        for licence in found:
            shutil.copyfile(licence, folder / f"model-{licence.name}")
        if found:
            return
