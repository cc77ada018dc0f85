"""A run's summary in words."""

import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plantar.common.gravity import GRAVITY
from plantar.robots.kinematics.command_joints import REACH_ERROR

Summary = Mapping[str, Any]

# Settings whose numbers people want to know of a run; the JSON lists all of them
_SHOWN = ("terrain.", "push.", "walk.length", "walk.sideways", "walk.swing_height")

# Units of values by the ends of their names in the JSON
_UNITS = {"_rad_s": "rad/s", "_Nm": "N m", "_mm_N": "mm/N", "_mm": "mm", "_m": "m", "_N": "N", "_deg": "deg", "_s": "s"}

# Sizes of a body that a share is a percentage of
_SIZES = ("leg", "sole", "sole_width", "weight")

_COMMON = {"scene", "robot", "seed", "completed", "reasons", "fell", "sim_time_s", "wall_time_s", "real_time_factor"}
_COMMON |= {"control_us", "control_us_by_active", "skipped", "figures"}
"""What a summary of an experiment prints elsewhere or not at all."""


def run_text(summary: Summary) -> str:
    """A walk's or experiment's `summary` as lines of text."""
    tick = summary["control_us"]
    walked = "steps_planned" in summary
    parts = (_shares, _plant, _body, _joints, _balance) if walked else (_figures,)
    return "\n".join(
        [
            *_outcome(summary),
            *(line for part in parts for line in part(summary)),
            f"  {summary['real_time_factor']:.1f} x real time; control tick {tick['p50']:.0f} us (median), "
            f"{tick['p99']:.0f} us (99 %)",
            *(f"  {name}" for name in summary.get("figures", [])),
        ]
    )


def demo_text(made: Mapping[str, Any], output: Path) -> str:
    """Returns demonstration lines, by results `made` ("shoe", "walk", "analysis", "files") and folder `output`."""
    shoe = made["shoe"]
    steps = {side: foot["steps"] for side, foot in made["analysis"]["feet"].items()}
    return (
        f"shoe: {shoe['taxels']} taxels, {shoe['mass_g']:.0f} g, "
        f"{'all checks hold' if shoe['holds'] else 'A CHECK DOES NOT HOLD'}\n"
        f"{run_text(made['walk'])}\n"
        f"analysis: {steps.get('left', 0)} left and {steps.get('right', 0)} right complete steps\n"
        f"open {output / 'index.html'} in a browser: it leads to all {len(made['files']) - 1} files"
    )


def _outcome(summary: Summary) -> list[str]:
    end = "completed" if summary["completed"] else ("FELL" if summary["fell"] else "NOT COMPLETED")
    steps = ""
    if "steps_planned" in summary:
        planned = "" if summary["steps_planned"] is None else f" of {summary['steps_planned']}"
        steps = f"{summary['steps_taken']}{planned} steps in "
    ran = f"{summary['scene']} with {summary['robot']}, seed {summary['seed']}"
    return [
        f"{ran}: {end}, {steps}{summary['sim_time_s']:.1f} s",
        *(f"  not completed, {why['criterion'].replace('_', ' ')}: {why['text']}" for why in summary["reasons"]),
    ]


def _figures(summary: Summary) -> list[str]:
    return [f"  {_named(name, value)}" for name, value in summary.items() if name not in _COMMON]


def _named(name: str, value: Any) -> str:
    ending = next((e for e in _UNITS if name.endswith(e)), "")
    words = name.removesuffix(ending).replace("_", " ")
    return f"{words}: {_value(value)} {_UNITS.get(ending, '')}".rstrip()


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_value(inner)}" for name, inner in value.items())
    if isinstance(value, list):
        return ", ".join(map(_value, value))
    return "-" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def _shares(summary: Summary) -> list[str]:
    shares = {name: share for name, share in summary["shares"].items() if name.startswith(_SHOWN)}
    parts = [f"{name} {x['value']:.3g} {x['unit']} ({_share(x['share'])})" for name, x in shares.items()]
    body = summary["body"]
    size = f"{body['mass_kg']:.3g} kg, legs of {body['leg_m']:.3g} m, soles of {body['sole_m']:.3g} m"
    return textwrap.wrap(f"{size}: {', '.join(parts)}", 118, initial_indent="  ", subsequent_indent="    ")


def _share(text: str) -> str:
    """A share such as "0.3333 leg" in words: "33.3 % of the leg"; one of no single size of the body as it is."""
    number, _, unit = text.partition(" ")
    if unit not in _SIZES:
        return text
    return f"{100.0 * float(number):.3g} % of the {unit.replace('_', ' ')}"


def _plant(summary: Summary) -> list[str]:
    parts = []
    for key, value in summary.get("plant", {}).items():
        ending = next((e for e in _UNITS if key.endswith(e)), "")
        numbers = value if isinstance(value, list) else [value]
        size = ", ".join(f"{v:.3g}" for v in numbers)
        if len(numbers) > 3:
            size = f"up to {max(map(abs, numbers)):.3g}"
        parts.append(f"{key.removesuffix(ending).replace('_', ' ')} {size} {_UNITS.get(ending, '')}".rstrip())
    words = f"true plant, which the controller does not know: {'; '.join(parts)}"
    return textwrap.wrap(words, 118, initial_indent="  ", subsequent_indent="    ") if parts else []


def _body(summary: Summary) -> list[str]:
    margin = summary["zmp_margin_min_m"]
    lines = [
        f"  largest tilt {summary['tilt_max_deg']:.2f} deg, smallest true ZMP margin "
        f"{'-' if margin is None else f'{1e3 * margin:.1f} mm'}"
    ]
    if summary["impacts_N"]:
        impacts = sorted(summary["impacts_N"])
        weight = GRAVITY * summary["body"]["mass_kg"]
        median = impacts[len(impacts) // 2]
        most = impacts[-1]
        lines.append(
            f"  landing impact: median {median / weight:.2f}, largest {most / weight:.2f} body weights "
            f"({median:.0f} and {most:.0f} N)"
        )
    drift = summary["drift"]
    if drift is not None:
        lines.append(
            f"  from foothold to foothold the walk drifted by {1e3 * drift['position_m']:.0f} mm and "
            f"{drift['heading_deg']:.1f} deg on {drift['way_m']:.1f} m"
        )
    final = summary["final"]
    lines.append(
        f"  at the end {1e3 * final['position_error_m']:.1f} mm and {final['heading_error_deg']:.2f} deg off the plan, "
        f"tilted by {final['tilt_deg']:.2f} deg, CoM at {final['height_m']:.3f} m; "
        f"estimated CoM off by at most {1e3 * max(summary['estimate']['com_error_max_m']):.1f} mm"
    )
    return lines


def _joints(summary: Summary) -> list[str]:
    held = summary["torque_limit"]
    most = sorted(held["joints"].items(), key=lambda joint: -joint[1])[:3]
    joints = ", ".join(f"{name} {100 * share:.1f} %" for name, share in most)
    lines = [
        f"  a standing foot slipped by at most {1e3 * summary['slip_max_m']:.1f} mm; joints at their torque limit in "
        f"{100 * held['share_of_time']:.1f} % of the time{f' ({joints})' if joints else ''}"
    ]
    speed = summary["joint_speed"]
    if speed is None:
        lines.append("  joint speeds are not limited: the robot's file gives no [servo] velocity_limits")
    else:
        lines.append(f"  fastest joint: {speed['joint']}, {speed['share_of_limit']:.2f} of its speed limit")
    late = summary["out_of_reach_since_s"]
    if late is not None:
        lines.append(
            f"  from {late:.2f} s on a leg was at times more than {1e3 * REACH_ERROR:g} mm or mrad off its target: "
            "if that matters, walk lower (--set crouch=0.05)"
        )
    return lines


def _balance(summary: Summary) -> list[str]:
    balance = summary.get("balance", {})
    lines = []
    if balance.get("pushes"):
        off = balance["zmp_off_max_m"]
        lines.append(
            f"  recovered from {balance['recovered']} of {len(balance['pushes'])} pushes, which moved the true ZMP by "
            f"up to {'-' if off is None else f'{1e3 * off:.0f} mm'}"
        )
    zmps = balance.get("skin_against_force_torque", {})
    if zmps.get("rms_m") is not None:
        lines.append(
            f"  ZMP of the skin against that of the ankles: {1e3 * zmps['rms_m']:.2f} mm RMS, "
            f"{1e3 * zmps['max_m']:.1f} mm at most"
        )
    return lines
