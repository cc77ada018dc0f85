"""The written robot file: every value with its reason."""

import json
import math
import warnings
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.mechanics.rotation import vector_from_rotation
from plantar.robots.robot import Robot
from plantar.robots.survey.fitted_gait import QUICK_HELD, FittedGait
from plantar.robots.survey.servo_gains import SAMPLED, STIFFNESS
from plantar.robots.survey.step_search import KNEE_LEAST, STEP_SHARE
from plantar.robots.survey.step_time import LEAN_MOST
from plantar.robots.survey.survey import NO_SPEED, Survey
from plantar.robots.walk import CONTROL_PERIOD

_WIDTH = 110  # characters of a comment


def roll_pitch_yaw(rotation: NDArray[np.float64]) -> list[float]:
    """Roll, pitch, yaw in degrees of a rotation (3, 3), about fixed axes.

    Example:
        >>> roll_pitch_yaw(np.eye(3))
        [0.0, 0.0, 0.0]
    """
    with warnings.catch_warnings():
        # A body that points straight down has no roll and yaw apart: SciPy says so, and puts both into the roll.
        warnings.simplefilter("ignore", UserWarning)
        angles = Rotation.from_matrix(rotation).as_euler("xyz", degrees=True)
    return [round(v, 4) + 0.0 for v in angles.tolist()]


def robot_text(survey: Survey, fitted: FittedGait, shoe_notes: Sequence[str], weighed: bool) -> str:
    """Returns a robot file's TOML from `survey`, `fitted`, `shoe_notes` and whether shoes were `weighed`."""
    robot = fitted.robot
    lines = [
        *_comment(
            f"Written by plantar robot from {survey.source.file.name}. SI units, angles in degrees. Change what you "
        ),
        *_comment("know better: plantar robot check ROBOT.toml measures what would go wrong."),
        f"name = {json.dumps(robot.name)}",
        f"description = {json.dumps(robot.description)}",
        "",
        "[model]",
        *_comment("A copy of the model: one floating base, the legs' joints, all others held."),
        *(line for note in (*survey.notes, *fitted.notes) for line in _comment(f"Note: {note}.")),
        'kind = "mjcf"',
        'file = "model.xml"',
        "",
        *_shoe(survey, robot, shoe_notes, weighed),
    ]
    parts = [*(_leg(robot, side) for side in SIDES), _torso(survey, robot), _posture(robot), _gait(fitted)]
    parts += [_servo(survey, fitted), _balance(fitted), _landing(), *([_rocking()] if robot.rocks else [])]
    return "\n".join([*lines, *(line for part in parts for line in ("", *part))]) + "\n"


def _comment(text: str) -> list[str]:
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) > _WIDTH:
            lines.append("")
        lines[-1] += f" {word}"
    return [f"#{line}" for line in lines]


def _numbers(values: Iterable[float], digits: int) -> str:
    return "[" + ", ".join(f"{float(v) + 0.0:.{digits}g}" for v in values) + "]"


def _places(values: Iterable[float], decimals: int) -> str:
    return "[" + ", ".join(f"{round(float(v), decimals) + 0.0:.10g}" for v in values) + "]"


def _shoe(survey: Survey, robot: Robot, notes: Sequence[str], weighed: bool) -> list[str]:
    left, right = (robot.sole_origins[s] for s in SIDES)
    turns = {s: roll_pitch_yaw(robot.sole_rotations[s]) for s in SIDES}
    lines = ["[shoe]", *_comment("; ".join((*survey.soles["left"].notes, *notes)) + ".")]
    lines += [
        'layout = "layout_{side}.json"',
        *_comment("Sole frame in the left foot's body: below the ankle, at the shoe's outer face."),
        f"origin = {_places(left, 6)}",
    ]
    angle = math.degrees(float(np.linalg.norm(vector_from_rotation(robot.sole_rotations["left"]))))
    turned = f"The body's frame is turned by {angle:.1f} degrees against the sole: its roll, pitch and yaw."
    lines += [*_comment(turned), f"rotation = {_places(turns['left'], 4)}"] if angle > 1e-3 else []
    unlike = not np.allclose(left * (1.0, -1.0, 1.0), right, atol=1e-4)
    twisted = not np.allclose(np.array(turns["left"]) * (-1.0, 1.0, -1.0), turns["right"], atol=1e-2)
    lines += _comment("The right foot's body does not mirror the left one's.") if unlike or twisted else []
    lines += [f"origin_right = {_places(right, 6)}"] if unlike else []
    lines += [f"rotation_right = {_places(turns['right'], 4)}"] if twisted else []
    how = "of the shoe that was built" if weighed else "15.5 kg/m^2 of contact face, as built shoes have"
    return [
        *lines,
        f"thickness = {robot.shoe_thickness:g}  # m, of the planned shoe",
        f"mass = {robot.shoe_mass:.3g}  # kg, {how}",
        *_comment(
            "Damping ratio of the sole on the ground. A contact is as stiff as suits the foot, but carries the robot: "
            "with 1 light feet rattle between the edges of what they stand on, at some 60 Hz."
        ),
        f"contact_damping = {robot.contact_damping:g}",
    ]


def _leg(robot: Robot, side: Side) -> list[str]:
    names = ", ".join(json.dumps(n) for n in robot.legs[side].joints)
    return [
        f"[legs.{side}]",
        *_comment("The hinges between the body and what stands lowest on this side, from hip to ankle."),
        f"joints = [{names}]",
        f"foot_body = {json.dumps(robot.legs[side].foot_body)}",
    ]


def _torso(survey: Survey, robot: Robot) -> list[str]:
    pelvis = survey.source.model.body(survey.legs.pelvis).name
    upright = f"Both legs hang on '{pelvis}'"
    if robot.torso_body != pelvis:
        upright += f"; '{robot.torso_body}', rigid with it, has x forward and z up"
    known = survey.imu is not None and f"the IMU is where the model has its {survey.imu[0]} '{survey.imu[1]}'"
    imu = known or "the model names no IMU on the body: one at the torso's origin is assumed"
    return [
        "[torso]",
        *_comment(f"{upright}; {imu}."),
        f"body = {json.dumps(robot.torso_body)}",
        f"imu_site = {json.dumps(robot.imu_site)}",
    ]


def _posture(robot: Robot) -> list[str]:
    return [
        "[posture]",
        *_comment("Standing with com_height and stance_width, by inverse kinematics."),
        *(f"{s} = {_places([math.degrees(v) for v in robot.posture[s]], 2)}" for s in SIDES),
    ]


def _gait(fitted: FittedGait) -> list[str]:
    robot = fitted.robot
    body = fitted.body
    reach = fitted.reach
    leg = "hip over knee to ankle" if not robot.leg_length else "shorter than the leg, see the note above"
    pace = robot.single_support / math.sqrt(robot.com_height / GRAVITY)
    return [
        "[gait]",
        *_comment(
            f"The greatest height at which motors hold and no knee bends by less than {math.degrees(KNEE_LEAST):.0f} "
            f"degrees over steps of {STEP_SHARE * body.leg:.3f} m, a third of the leg; the straightest has "
            f"{math.degrees(reach.knee):.0f}."
        ),
        f"com_height = {robot.com_height:g}  # m",
        f"stance_width = {robot.stance_width:g}  # m, of the ankles: as in the model, or wider to keep the soles apart",
        f"leg_length = {body.leg:g}  # m, {leg}",
        *_comment("How much lower all joints keep their range and three quarters of their torque."),
        f"largest_crouch = {robot.largest_crouch:g}  # m",
        f"trunk_lean = {robot.trunk_lean:g}  # rad/m, 0.48 in leg lengths as h1",
        *_loaded(robot),
        *_comment(
            f"This pace is {pace:.2f} sqrt(com_height / g)"
            + (
                "."
                if robot.rocks
                else "; that of h1 is 3.15, more spares the motors, or soles from what heavy legs swing."
            )
        ),
        f"single_support = {robot.single_support:g}  # s",
        f"double_support = {robot.double_support:g}  # s, {robot.double_support / robot.single_support:.2f} of it",
        *_approaching(robot),
        *_comment(
            "Beats of a pace, so that quick steps take "
            + ("its own time." if robot.rocks else f"{100.0 * QUICK_HELD:.0f} % of the motors' torque at most.")
        ),
        f"pace = {robot.pace:g}",
    ]


def _approaching(robot: Robot) -> list[str]:
    why = (
        "A swing that comes down slowly onto unknown ground has to be there in three fifths of its time. With so much "
        f"of it that takes {100.0 * QUICK_HELD:.0f} % of the motors' torque at most, and moves the ZMP no farther to "
        "the sole's edge than h1's leg does."
    )
    return [*_comment(why), f"approach_support = {robot.approach_support:g}  # s"] if robot.approach_support else []


def _loaded(robot: Robot) -> list[str]:
    weak = _comment("The ankles cannot bear the weight on the toes; no farther from them is the sole loaded:")
    rocks = _comment(
        f"Without ankle roll it rocks from foot to foot, whatever a scene asks for, so quickly that its legs lean "
        f"by {math.degrees(LEAN_MOST):g} degrees."
    )
    return [
        *([*weak, f"ankle_reach = {robot.ankle_reach:g}  # m"] if robot.ankle_reach < 1.0 else []),
        *([*rocks, "rocks = true"] if robot.rocks else []),
    ]


def _servo(survey: Survey, fitted: FittedGait) -> list[str]:
    robot = fitted.robot
    inertia = fitted.inertia
    wanted = STIFFNESS * fitted.body.weight * robot.com_height
    hertz = np.sqrt(np.array(robot.stiffness) / inertia.swing) / (2.0 * math.pi)
    lines = [
        "[servo]",
        *_comment(
            f"A value a joint. Stiffness: {STIFFNESS:g} m g h = {wanted:.3g} N m/rad, less for light joints, which "
            f"must swing by {SAMPLED:g} rad at most in a control period of {1e3 * CONTROL_PERIOD:g} ms. Inertia about "
            f"each joint while it swings: {_numbers(inertia.swing, 2)} kg m^2, while it carries: "
            f"{_numbers(inertia.stance, 2)}; bandwidth while it swings: {_numbers(hertz, 2)} Hz. Damping: critical for "
            "what swings or more, with the model's own."
        ),
    ]
    if fitted.rotors.any():
        lines += _comment(
            f"The model states no rotor inertia (armature). Assumed in model.xml: {_numbers(fitted.rotors, 2)} kg m^2, "
            "without which no ankle could be as stiff, and swinging legs would rock the robot. Put there what the "
            "motors have, times the gear ratio squared."
        )
    elif not inertia.armature.any():
        lines += _comment(
            "The model states no rotor inertia (armature): what swings is lighter than the robot's joints are."
        )
    lines += [
        f"stiffness = {_numbers(robot.stiffness, 4)}  # N m/rad",
        f"damping = {_numbers(robot.damping, 4)}  # N m s/rad",
    ]
    if robot.own_stiffness != robot.stiffness:
        lines += [
            "# Gains of the model's own servos, for control.drives = own or torque.",
            f"own_stiffness = {_numbers(robot.own_stiffness, 4)}  # N m/rad",
            f"own_damping = {_numbers(robot.own_damping, 4)}  # N m s/rad",
        ]
    if robot.effort_limits:
        how = " where known; 1e5 stands for none" if None in survey.efforts else ""
        lines += _comment(f"Of motors or joints, as the model states them{how}.")
        lines.append(f"effort_limits = {_numbers(robot.effort_limits, 4)}  # N m")
    else:
        needed = _numbers(fitted.reach.torque, 2)
        lines += _comment(f"The model states no torque limits, so there are none; level steps need {needed} N m.")
    unknown = _comment("The model states no usable speed limits, so there are none.")
    where = f"; {NO_SPEED:g} stands for none" if NO_SPEED in robot.velocity_limits else ""
    speeds = f"velocity_limits = {_numbers(robot.velocity_limits, 4)}  # rad/s, as the model states them{where}"
    return [*lines, *([speeds] if robot.velocity_limits else unknown)]


def _balance(fitted: FittedGait) -> list[str]:
    return [
        "[balance]",
        *_comment(f"The law and gains of h1, in the beat sqrt(leg / g) = {fitted.body.beat:.3f} s of these legs."),
        *(f"{key} = {json.dumps(value)}" for key, value in fitted.robot.balance.items()),
    ]


def _rocking() -> list[str]:
    return [
        "[estimator]",
        *_comment("Feet that come down on an edge turn, which only the gyro shows: they correct the heading slowly."),
        "yaw = 0.1  # 1/s",
        "",
        "[identification]",
        *_comment("Soles that carry turn as the robot rocks: that shows no bias and no offset."),
        "gyro = false",
        "encoders = false",
        "com = false",
    ]


def _landing() -> list[str]:
    return [
        "[landing]",
        *_comment(
            "Less than the 0.237 that h1 presses a landed foot with: what the press lowers the foot by stays in legs "
            "whose servos give, and the robot ends leaning by it (G1 by 0.67 degrees, with this by 0.4)."
        ),
        'press_force = "0.15 weight"',
        *_comment(
            "A swing is ahead of its command where its servos brake it, so each foothold is found a little higher than "
            "the one before. Expected where the last one was, and not at their average, the ground is not hit hard."
        ),
        "ground_share = 1.0",
        *_comment("What a foot was pressed too far, or not far enough, is given back once the robot stands."),
        'relax_time = "2 beat"',
    ]
