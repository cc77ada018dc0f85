"""Force plates in C3D files: events, markers, and what is no walk; test_made_plates.py draws plates of every kind."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats import detect_format, read_recording
from plantar.formats.c3d_content import content_of_file, event_of
from plantar.formats.force_plates import on_its_surface
from plantar.formats.format import ReadOptions
from plantar.formats.plate_sides import Plate
from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.gait.analysis.steps.foot_gait import Step

from ...fuzz.made_plates import Contact, Laboratory, made_contact, write_c3d
from .corruption import survive_corruption

ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed: pip install '.[formats]'")

RATE = 500.0
TIME = np.arange(0.0, 3.0, 1.0 / RATE)


def contact(side: str, begin: float, x: float, y: float, top: float = 800.0) -> Contact:
    return made_contact(np.random.default_rng(0), TIME, side, begin, 0.7, np.array([x, y]), top)


WALK = (contact("left", 0.6, 0.3, 0.1), contact("right", 1.2, 0.95, -0.1))
SAME = (contact("right", 0.4, 0.3, 0.0), contact("right", 1.9, 1.3, 0.0))


def write(
    path: Path,
    contacts: Sequence[Contact] = WALK,
    shown: str = "nothing",
    seed: int = 0,
    change: Callable[[Any], object] = lambda file: None,
) -> Laboratory:
    """Write a file of a plate a contact, and change it."""
    lab = Laboratory("type 2", RATE, TIME, [[c] for c in contacts])
    write_c3d(path, lab, np.random.default_rng(seed), shown)
    file = ezc3d.c3d(str(path))
    change(file)
    file.write(str(path))
    return lab


def steps_of(walk: Analysis) -> list[Step]:
    return sorted((s for gait in walk.feet.values() for s in gait.steps), key=lambda s: s.heel_strike_s)


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(6))
def test_two_plates_are_two_feet(tmp_path, seed):
    path = tmp_path / "walk.c3d"
    lab = write(path, seed=seed)
    assert detect_format(path).name == "c3d"
    walk = analyse(path)
    assert (walk.recording.rate_hz, len(walk.recording.time), walk.recording.kind) == (RATE, len(TIME), "plate")
    steps = steps_of(walk)
    assert [s.side for s in steps] == ["left", "right"]
    assert not any(np.isfinite([s["flight_time_s"], s["double_support_percent"]]).any() for s in steps)
    text = " ".join(walk.metrics["warnings"])
    assert "no cells" in text
    assert text.count("when empty") == 2
    assert ("point down" in text) == ("on plate" in lab.text)
    assert ("laboratory's vertical axis" in text) == ("axes [0, 1, 2]" not in lab.text)


@pytest.mark.parametrize("seed", range(8))
def test_the_centre_of_pressure_lies_on_a_tilted_plate(seed):
    random = np.random.default_rng(seed)
    normal = np.array([*random.uniform(-0.4, 0.4, 2), 1.0])
    normal /= np.linalg.norm(normal)
    place = random.uniform(-0.2, 0.2, (50, 3))
    place[:, 2] = -place[:, :2] @ normal[:2] / normal[2]
    force = np.column_stack([random.uniform(-90.0, 90.0, (50, 2)), random.uniform(100.0, 900.0, 50)])
    turn = random.uniform(-5.0, 5.0, 50)
    moment = np.cross(place, force) + turn[:, None] * normal
    found = on_its_surface(Plate("plate 1", force, moment, normal=normal), [])
    assert found.cop == pytest.approx(place[:, :2], abs=1e-12)
    assert found.free == pytest.approx(turn, abs=1e-11)


def test_events_of_the_file_are_read(tmp_path):
    path = tmp_path / "walk.c3d"
    write(path, shown="events")
    events = read_recording(path).events
    for side, strike in (("left", 0.6), ("right", 1.2)):
        assert events[side].heel_strikes == pytest.approx([strike])
        assert events[side].toe_offs == pytest.approx([strike + 0.7])


def test_events_without_contexts(tmp_path):
    def change(file: Any) -> None:
        file.add_parameter("EVENT", "LABELS", ["LHS", "General", "RTO"])
        file.add_parameter("EVENT", "TIMES", np.array([[0.0, 0.0, 1.0], [0.61, 1.0, 0.88]]))  # min and s

    path = tmp_path / "walk.c3d"
    write(path, change=change)
    events = read_recording(path).events
    assert events["left"].heel_strikes == pytest.approx([0.61])
    assert events["right"].toe_offs == pytest.approx([60.88])
    named = {"RIC": ("right", "strikes"), "LFO": ("left", "lifts"), "Right Foot Strike": ("right", "strikes")}
    for label, event in {**named, "L_HS": ("left", "strikes"), "Event": None}.items():
        assert event_of(label) == event


def test_markers_show_that_both_contacts_are_of_one_foot(tmp_path):
    path = tmp_path / "walk.c3d"
    for shown in ("markers", "nothing"):  # without markers the push to the middle shows it
        write(path, SAME, shown)
        assert [s.side for s in steps_of(analyse(path))] == ["right", "right"]
    given = analyse(path, options=ReadOptions(plates=("left", "right")))
    assert sorted(given.feet) == ["left", "right"]
    with pytest.raises(InputError, match="names 1 plates; the file has 2"):
        analyse(path, options=ReadOptions(plates=("left",)))


def test_a_models_output_among_the_points_is_no_marker(tmp_path):
    def with_angles(file: Any) -> None:  # 4 m away from the foot, as degrees and N are
        labels = file["parameters"]["POINT"]["LABELS"]["value"]
        far = np.full((4, 6, file["data"]["points"].shape[2]), 4000.0)
        names = ["LAnkleAngles", "RAnkleAngles", "LANK_ANG", "S1:RAnkleForce", "RTOE_MOM", "LTOE_MOM"]
        file["parameters"]["POINT"]["LABELS"]["value"] = [*labels, *names]
        file.add_parameter("POINT", "ANGLES", [names[2]])
        file.add_parameter("POINT", "MOMENTS", names[4:])
        file["data"]["points"] = np.concatenate([file["data"]["points"], far], axis=1)
        file["data"]["meta_points"]["residuals"] = np.zeros((1, len(labels) + 6, far.shape[2]))
        del file["data"]["meta_points"]["camera_masks"]

    write(tmp_path / "plain.c3d", WALK, "markers")
    write(tmp_path / "walk.c3d", WALK, "markers", change=with_angles)
    plain, found = (content_of_file(tmp_path / name) for name in ("plain.c3d", "walk.c3d"))
    for side in ("left", "right"):
        np.testing.assert_allclose(found[f"track_{side}"], plain[f"track_{side}"], atol=0.01)


def test_the_unit_can_be_stated_where_the_file_states_volts(tmp_path):
    write(tmp_path / "plain.c3d")
    write(tmp_path / "walk.c3d", change=in_volts)
    plain = steps_of(analyse(tmp_path / "plain.c3d"))
    found = steps_of(analyse(tmp_path / "walk.c3d", options=ReadOptions(unit="N")))
    assert [s["peak_force_N"] for s in found] == pytest.approx([s["peak_force_N"] for s in plain], rel=1e-6)
    assert [s.side for s in found] == [s.side for s in plain]


def test_a_file_of_another_processor_is_refused(tmp_path):
    path = tmp_path / "walk.c3d"
    write(path)
    content = bytearray(path.read_bytes())
    content[(content[0] - 1) * 512 + 3] = 86
    path.write_bytes(content)
    with pytest.raises(FormatError, match=r"SGI \(MIPS\) processor; allowed"):
        read_recording(path)


def test_a_foot_that_may_be_partly_beside_its_plate_is_told(tmp_path):
    def smaller(file: Any) -> None:
        corners = file["parameters"]["FORCE_PLATFORM"]["CORNERS"]["value"]
        corners += 0.65 * (corners.mean(axis=1, keepdims=True) - corners)  # 21 cm long; the CoP goes 20 cm

    for change, told in ((lambda file: None, 0), (smaller, 2)):
        write(tmp_path / "walk.c3d", change=change)
        assert sum("mm of its edge" in w for w in read_recording(tmp_path / "walk.c3d").warnings) == told


def test_one_plate_is_of_one_foot(tmp_path):
    path = tmp_path / "walk.c3d"
    write(path, WALK[:1], change=without_sides)
    assert any("does not state which foot" in w for w in read_recording(path).warnings)
    assert list(read_recording(path, options=ReadOptions(side="right")).feet) == ["right"]


def without_sides(file: Any) -> None:
    """No push to the side."""
    file["data"]["analogs"][0, :2] = 0.0


def in_volts(file: Any) -> None:
    file["parameters"]["ANALOG"]["UNITS"]["value"] = ["V"] * 12


def no_plates(file: Any) -> None:
    file["parameters"]["FORCE_PLATFORM"]["USED"]["value"] = np.array([0])


def unloaded(file: Any) -> None:
    file["data"]["analogs"][:] = 0.0


def a_wheel(file: Any) -> None:
    forces = file["data"]["analogs"][0]
    forces[[0, 6]] = forces[[2, 8]]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (in_volts, "are in v, and no calibration matrix"),
        (no_plates, "holds no force plate"),
        (unloaded, "carries more than 20 N"),
        (a_wheel, "no foot pushes so"),
    ],
)
def test_what_is_no_force_of_a_foot_is_refused(tmp_path, change, message):
    write(tmp_path / "walk.c3d", change=change)
    with pytest.raises(FormatError, match=message):
        analyse(tmp_path / "walk.c3d")


@pytest.mark.long
def test_damage(tmp_path):
    write(tmp_path / "walk.c3d")
    survive_corruption(tmp_path / "walk.c3d", trials=12, header=4000)
