"""Force plates in C3D files that ezc3d writes."""

from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import analyse

ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed: pip install 'plantar[formats]'")

RATE = 1000.0


def write_c3d(
    path: Path,
    forces: list[np.ndarray],
    sign: float = -1.0,
    unit: str = "mm",
    used: bool = True,
    events: tuple[tuple[str, str, float], ...] = (),
) -> None:
    """Plates of 600 x 400 mm, one after the other, to the left and to the right in turns; forces (n,) in N.

    The load moves 0.1 m forward over each plate, in the plate's own axes: C3D plates have z down.
    """
    n = len(forces[0])
    scale = 1.0 if unit == "mm" else 1e-3
    file = ezc3d.c3d()
    analog, plates = file["parameters"]["ANALOG"], file["parameters"]["FORCE_PLATFORM"]
    k = len(forces)
    file["parameters"]["POINT"]["RATE"]["value"] = [100]
    file["parameters"]["POINT"]["UNITS"]["value"] = [unit]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["none"]
    analog["RATE"]["value"] = [RATE]
    analog["LABELS"]["value"] = [f"{c}{i}" for i in range(k) for c in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")]
    analog["UNITS"]["value"] = ["N", "N", "N", f"N{unit}", f"N{unit}", f"N{unit}"] * k
    analog["SCALE"]["value"] = [1.0] * (6 * k)
    analog["OFFSET"]["value"] = [0] * (6 * k)
    analog["USED"]["value"] = [6 * k]
    channels = np.zeros((6 * k, n))
    corners = np.zeros((3, 4, k))
    for i, force in enumerate(forces):
        busy = force > 0
        ahead = np.zeros(n)
        ahead[busy] = np.linspace(-50.0, 50.0, busy.sum()) * scale
        channels[6 * i + 2] = sign * force
        channels[6 * i + 4] = -sign * force * ahead  # My = -x Fz
        x, y = 600.0 * i, 400.0 if i % 2 == 0 else 0.0
        corners[:, :, i] = np.array([[x + 600, y, 0], [x, y, 0], [x, y - 400, 0], [x + 600, y - 400, 0]]).T * scale
    for name, value in (
        ("USED", np.array([k if used else 0])),
        ("TYPE", np.full(k, 2)),
        ("ZERO", np.array([1, 0])),
        ("CORNERS", corners),
        ("ORIGIN", np.zeros((3, k))),
        ("CHANNEL", np.arange(1, 6 * k + 1).reshape(k, 6).T),
    ):
        plates[name]["value"] = value
    file["data"]["points"] = np.zeros((4, 1, n // 10))
    file["data"]["analogs"] = channels[None]
    if events:
        labels, contexts, times = zip(*events, strict=True)
        file.add_parameter("EVENT", "LABELS", list(labels))
        file.add_parameter("EVENT", "CONTEXTS", list(contexts))
        file.add_parameter("EVENT", "TIMES", np.array([[t // 60.0 for t in times], [t % 60.0 for t in times]]))
    file.write(str(path))


def stance(begin: float, end: float, peak: float, seconds: float = 2.0) -> np.ndarray:
    time = np.arange(0.0, seconds, 1.0 / RATE)
    share = (time - begin) / (end - begin)
    return np.where((share > 0) & (share < 1), peak * np.sin(np.pi * np.clip(share, 0, 1)), 0.0)


@pytest.mark.parametrize(("sign", "unit"), [(-1.0, "mm"), (1.0, "mm"), (-1.0, "m")])
def test_two_plates_are_two_feet(tmp_path, sign, unit):
    path = tmp_path / "walk.c3d"
    forces = [stance(0.2, 0.9, 800.0), stance(0.8, 1.5, 700.0)]
    write_c3d(path, forces, sign, unit)
    assert detect_format(path).name == "c3d"
    analysis = analyse(path)
    recording = analysis.recording
    assert (recording.rate_hz, len(recording.time), recording.kind) == (RATE, 2000, "plate")
    assert np.abs(recording.feet["left"].vertical_force - forces[0]).max() < 0.1
    assert np.abs(recording.feet["right"].vertical_force - forces[1]).max() < 0.1
    (left,), (right,) = analysis.feet["left"].steps, analysis.feet["right"].steps
    assert left["peak_force_N"] == pytest.approx(800.0, rel=1e-3)
    assert left["impulse_Ns"] == pytest.approx(800.0 * 0.7 * 2 / np.pi, rel=0.01)
    assert left["contact_time_s"] == pytest.approx(0.7, abs=0.02)
    assert right["peak_force_N"] == pytest.approx(700.0, rel=1e-3)
    assert left["cop_path_m"] == pytest.approx(0.1, rel=0.1)
    assert left["double_support_percent"] != left["double_support_percent"]  # no stride
    text = " ".join(analysis.metrics["warnings"])
    assert "no cells" in text
    assert ("point down" in text) == (sign < 0)


def test_events_of_the_file_are_read(tmp_path):
    path = tmp_path / "walk.c3d"
    stated = (("Foot Strike", "Left", 0.21), ("Foot Off", "Left", 0.89), ("Foot Strike", "Right", 0.82))
    write_c3d(path, [stance(0.2, 0.9, 800.0), stance(0.8, 1.5, 700.0)], events=(*stated, ("General", "General", 1.0)))
    events = analyse(path).recording.events
    assert events["left"].heel_strikes == pytest.approx([0.21])
    assert events["left"].toe_offs == pytest.approx([0.89])
    assert events["right"].heel_strikes == pytest.approx([0.82])
    assert len(events["right"].toe_offs) == 0


def test_one_plate_and_other_files(tmp_path):
    path = tmp_path / "walk.c3d"
    write_c3d(path, [stance(0.2, 0.9, 800.0)])
    assert any("does not say which foot" in w for w in read_recording(path).warnings)
    assert list(read_recording(path, options=ReadOptions(side="right")).feet) == ["right"]
    write_c3d(path, [np.zeros(2000)])
    with pytest.raises(FormatError, match="carries more than 20 N"):
        read_recording(path)
    write_c3d(path, [stance(0.2, 0.9, 800.0)], used=False)
    with pytest.raises(FormatError, match="holds no force plate"):
        read_recording(path)


@pytest.mark.long
def test_damage(tmp_path):
    path = tmp_path / "walk.c3d"
    write_c3d(path, [stance(0.2, 0.9, 800.0, 1.2)])
    whole = path.read_bytes()
    random = np.random.default_rng(0)
    lines = []
    for trial in range(12):
        data = bytearray(whole)
        for at in random.integers(0, 4000 if trial % 2 else len(data), size=8):
            data[at] = random.integers(0, 256)
        path.write_bytes(bytes(data[: random.integers(600, len(data))]) if trial % 3 == 0 else bytes(data))
        try:
            read_recording(path, "c3d")
        except FormatError as error:
            lines.append(str(error))
    assert lines
    assert not any("\n" in line for line in lines)
