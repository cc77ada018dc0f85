"""Bring-up of a simulated robot before its walk."""

from collections.abc import Callable
from typing import Any

from plantar.errors import SceneError
from plantar.gait.command import Sensors
from plantar.gait.safety.bring_up.bring_up import BringUp
from plantar.robots.bring_up import bring_up_of
from plantar.sim.run.runner import Simulation

Wiring = Callable[[Sensors], Sensors]
"""What arrives of a reading, such as with soles exchanged."""

_REFUSED = 0.5  # s for which a refused robot is watched further


def check_before_walk(run: Simulation, wiring: Wiring | None = None) -> BringUp:
    """Check a robot before its walk; the walk then begins at time 0, as without.

    Args:
        run: The scene, not begun.
        wiring: Changes what the controller reads; None for as simulated.

    Returns:
        The checks, which passed or not.

    Raises:
        SceneError: If the controller runs without its shell.
    """
    shell = run.controller.shell
    if shell is None:
        raise SceneError("bring-up needs the controller's safety shell; allowed: a controller with one")
    checks = bring_up_of(run.robot, run.controller, run.feet, () if run.worn is None else (run.worn,))
    shell.bring_up = checks
    period, tick = run.periods
    every = max(1, round(tick / period))
    data = run.world.data
    data.time = -checks.duration
    steps = 0
    watched = round(_REFUSED / period)
    while not checks.passed and watched:
        if steps % run.sensors.skin_every == 0:
            run.sensors.read_skins((), False)
        if steps % every == 0:
            _tick(run, wiring)
        run.servos.drive()
        run.step_physics()
        steps += 1
        watched -= checks.ended
    data.time = 0.0
    return checks


def _tick(run: Simulation, wiring: Wiring | None) -> None:
    reading = run.sensors.read_body()
    if run.arm is not None:
        run.arm.step(reading.skin)
        run.legs.hold_others(run.arm.angles)
    run.servos.command(run.controller.step(reading if wiring is None else wiring(reading)))


def bring_up_summary(checks: BringUp) -> dict[str, Any]:
    """What `plantar sim --json` holds of it under "bring_up"."""
    return {
        "passed": checks.passed,
        "fell": checks.fell,
        "time_s": round(checks.time, 3),
        "findings": [{"cause": f.cause, "measured": f.measured, "allowed": f.allowed} for f in checks.findings],
    }


def bring_up_text(checks: BringUp) -> str:
    """The same in words."""
    if checks.passed:
        return f"bring-up: passed in {checks.time:.1f} s: stood, leaned, unloaded each foot"
    lines = [f"bring-up: NOT PASSED after {checks.time:.1f} s; the robot takes no step"]
    return "\n".join([*lines, *(f"  {finding}" for finding in checks.findings)])
