"""Counts of calibrated soles become newtons."""

from dataclasses import replace

from plantar.recordings.pressure_recording import PressureRecording

_NOT_GIVEN = "raw counts"  # in warnings about what counts cannot give


def in_newtons(recording: PressureRecording) -> PressureRecording:
    """Returns recording in N where all its soles are calibrated, else as it is; a warning names what was done."""
    if not recording.raw:
        return recording
    lacking = [side for side, foot in recording.feet.items() if foot.layout is None or foot.layout.calibration is None]
    if len(lacking) == len(recording.feet):
        return recording
    if lacking:
        line = f"the {lacking[0]} sole is not calibrated: both stay counts (plantar calibrate)"
        return replace(recording, warnings=(*recording.warnings, line))
    feet = {}
    lines = []
    for side, foot in recording.feet.items():
        assert foot.layout is not None
        assert foot.layout.calibration is not None
        known = foot.layout.calibration
        feet[side] = replace(foot, force=known.forces(foot.force, foot.layout, recording.rate_hz), total=None, cop=None)
        lines.append(f"counts of the {side} sole are forces by its calibration of {known.date}: {known.method}")
    kept = (line for line in recording.warnings if _NOT_GIVEN not in line)
    return replace(recording, feet=feet, raw=False, warnings=(*lines, *kept))
