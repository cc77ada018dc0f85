"""Force plates as laboratories have them: types, axes, offsets, markers, events; the same walk comes out of each."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats.c3d_content import event_of
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import Analysis, analyse

ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed: pip install 'plantar[formats]'")

RATE, SECONDS = 500.0, 3.0
TIME = np.arange(0.0, SECONDS, 1.0 / RATE)
Z_UP, Y_UP, X_UP = [0, 1, 2], [1, 2, 0], [2, 0, 1]
"""Axes of the file in which each axis (x ahead, y left, z up) of the walk lies."""


class Contact:
    """One contact: force on the foot (n, 3) in N and CoP (n, 2) in m, x ahead and y left."""

    def __init__(self, begin: float, end: float, side: str, x: float, y: float) -> None:
        share = np.clip((TIME - begin) / (end - begin), 0.0, 1.0)
        on = (share > 0.0) & (share < 1.0)
        up = np.where(on, 800.0 * (np.sin(np.pi * share) + 0.25 * np.sin(3.0 * np.pi * share)) / 0.943, 0.0)
        inward = -0.04 if side == "left" else 0.04
        self.side = side
        self.force = np.column_stack([0.3 * up * (share - 0.5), inward * up, up])
        self.cop = np.column_stack([x - 0.1 + 0.2 * share, np.full_like(share, y)])
        self.free = 0.002 * up
        self.centre = np.array([x, y])


WALK = (Contact(0.6, 1.3, "left", 0.3, 0.1), Contact(1.2, 1.9, "right", 0.95, -0.1))
SAME = (Contact(0.4, 1.1, "right", 0.3, 0.0), Contact(1.9, 2.6, "right", 1.3, 0.0))


def channels(contact: Contact, kind: int, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Channels in N, mm and N mm of a plate with local axes (3, 3, as columns), and its ORIGIN in mm."""
    force = contact.force @ local
    away = np.column_stack([contact.cop - contact.centre, np.zeros(len(TIME))]) @ local
    moment = np.cross(away, force) + np.column_stack([np.zeros((len(TIME), 2)), contact.free]) @ local
    if kind == 1:
        return np.column_stack(
            [force, 1e3 * away[:, :2], 1e3 * moment[:, 2] - 1e3 * np.cross(away, force)[:, 2]]
        ).T, np.zeros(3)
    if kind == 3:
        a, b, depth = 120.0, 200.0, -50.0
        below = 1e3 * moment - np.cross(force, [0.0, 0.0, depth])  # about the plane of the transducers
        fz = force[:, 2] / 4.0
        along, across = below[:, 0] / (4.0 * b), below[:, 1] / (4.0 * a)
        fz14 = [fz + along - across, fz + along + across, fz - along + across, fz - along - across]
        turn = below[:, 2] / (2.0 * b)
        return np.array(
            [force[:, 0] / 2 - turn, force[:, 0] / 2 + turn, force[:, 1] / 2, force[:, 1] / 2, *fz14]
        ), np.array([a, b, depth])
    offset = np.array([1.0, -2.0, -40.0])
    return np.column_stack([force, 1e3 * moment - np.cross(force, offset)]).T, offset


def write(
    path: Path,
    contacts: Sequence[Contact] = WALK,
    kind: int = 2,
    axes: Sequence[int] = Z_UP,
    down: bool = True,
    offsets: Sequence[float] = (0.0, 0.0),
    units: tuple[str, str] = ("N", "Nmm"),
    markers: Mapping[str, tuple[float, float]] | None = None,
    events: Sequence[tuple[str, float]] = (),
    noise: float = 0.5,
) -> None:
    random = np.random.default_rng(0)
    file = ezc3d.c3d()
    names = list(markers or {"C7": (9.0, 9.0)})
    points = np.zeros((4, len(names), len(TIME) // 5))
    for i, place in enumerate((markers or {"C7": (9.0, 9.0)}).values()):
        points[[axes[0], axes[1], axes[2]], i] = np.array([1e3 * place[0], 1e3 * place[1], 60.0])[:, None]
    point = file["parameters"]["POINT"]
    point["RATE"]["value"], point["UNITS"]["value"], point["LABELS"]["value"] = [RATE / 5.0], ["mm"], names
    local = np.diag([1.0, -1.0, -1.0]) if down else np.eye(3)
    every, corners, origins = [], [], []
    for contact, offset in zip(contacts, offsets, strict=True):
        own, origin = channels(contact, kind, local)
        own = own + random.normal(0.0, noise, own.shape)
        own[2 if kind != 3 else slice(4, 8)] += offset if kind != 3 else offset / 4.0
        half = np.array([[0.3, 0.25], [-0.3, 0.25], [-0.3, -0.25], [0.3, -0.25]]) @ local[:2, :2].T
        place = np.column_stack([contact.centre + half, np.zeros(4)])
        turned = np.zeros((4, 3))
        turned[:, axes] = place
        every.append(own)
        corners.append(1e3 * turned.T)
        origins.append(origin)
    count, wide = len(every), len(every[0])
    analog, plates = file["parameters"]["ANALOG"], file["parameters"]["FORCE_PLATFORM"]
    analog["RATE"]["value"] = [RATE]
    analog["LABELS"]["value"] = [f"ch{i}" for i in range(count * wide)]
    own_units = {1: [units[0]] * 3 + ["mm", "mm", units[1]], 3: [units[0]] * 8}.get(
        kind, [units[0]] * 3 + [units[1]] * 3
    )
    analog["UNITS"]["value"] = own_units * count
    analog["SCALE"]["value"], analog["OFFSET"]["value"] = [1.0] * (count * wide), [0] * (count * wide)
    for name, value in (
        ("USED", np.array([count])),
        ("TYPE", np.full(count, kind)),
        ("ZERO", np.array([1, 0])),
        ("CORNERS", np.stack(corners, axis=2)),
        ("ORIGIN", np.stack(origins, axis=1)),
        ("CHANNEL", np.arange(1, count * wide + 1).reshape(count, wide).T),
    ):
        plates[name]["value"] = value
    file["data"]["points"], file["data"]["analogs"] = points, np.concatenate(every)[None]
    if events:
        file.add_parameter("EVENT", "LABELS", [e[0] for e in events])
        file.add_parameter("EVENT", "TIMES", np.array([[0.0] * len(events), [e[1] for e in events]]))
    file.write(str(path))


def check(found: Analysis, contacts: Sequence[Contact] = WALK) -> None:
    steps = sorted((s for gait in found.feet.values() for s in gait.steps), key=lambda s: s.heel_strike_s)
    assert [s.side for s in steps] == [c.side for c in contacts]
    for step, contact in zip(steps, contacts, strict=True):
        assert step["peak_force_N"] == pytest.approx(contact.force[:, 2].max(), abs=4.0)
        assert step["impulse_Ns"] == pytest.approx(np.trapezoid(contact.force[:, 2], TIME), rel=0.01)
        foot = found.feet[step.side].foot  # type: ignore[index]
        assert foot.wrench is not None
        loaded = np.flatnonzero(contact.force[:, 2] > 300.0)
        cop = foot.cop
        assert cop is not None
        assert np.abs(cop[loaded] - contact.cop[loaded]).max() < 0.01
        assert np.abs(foot.wrench[loaded, :2] - contact.force[loaded, :2]).max() < 5.0
    assert not any(np.isfinite(s["flight_time_s"]) or np.isfinite(s["double_support_percent"]) for s in steps)
    assert found.metrics["activity"]["name"] == "walking"


@pytest.mark.parametrize("kind", [1, 2, 3])
@pytest.mark.parametrize("down", [True, False])
def test_plate_types(tmp_path, kind, down):
    if kind == 3 and not down:
        pytest.skip("a Kistler plate's z points down")
    write(tmp_path / "walk.c3d", kind=kind, down=down)
    check(analyse(tmp_path / "walk.c3d"))


@pytest.mark.parametrize("axes", [Y_UP, X_UP])
def test_the_vertical_axis_follows_from_the_corners(tmp_path, axes):
    write(tmp_path / "walk.c3d", axes=axes)
    found = analyse(tmp_path / "walk.c3d")
    assert any("laboratory's vertical axis" in w for w in found.warnings)
    peaks = [s["peak_force_N"] for gait in found.feet.values() for s in gait.steps]
    assert peaks == pytest.approx([c.force[:, 2].max() for c in WALK], abs=4.0)
    assert sorted(found.feet) == ["left", "right"]


@pytest.mark.parametrize("kind", [1, 2, 3])
def test_each_plate_is_zeroed_by_its_empty_frames(tmp_path, kind):
    write(tmp_path / "walk.c3d", kind=kind, offsets=(-32.0, 22.0))
    found = analyse(tmp_path / "walk.c3d")
    assert sum("when empty" in w for w in found.warnings) == 2
    peaks = [s["peak_force_N"] for gait in found.feet.values() for s in gait.steps]
    assert peaks == pytest.approx([c.force[:, 2].max() for c in WALK], abs=4.0)


def test_markers_show_that_both_contacts_are_of_one_foot(tmp_path):
    path = tmp_path / "walk.c3d"
    still = {f"{p}{i}": (0.8, y) for p, y in (("LFT", 0.6), ("RFT", 0.02)) for i in (1, 2)}
    write(path, SAME, offsets=(-32.0, 22.0), markers=still)
    check(analyse(path), SAME)
    write(path, SAME)  # without markers the push to the middle shows it
    check(analyse(path), SAME)
    given = analyse(path, options=ReadOptions(plates=("left", "right")))
    assert sorted(given.feet) == ["left", "right"]
    with pytest.raises(InputError, match="names 1 plates; the file has 2"):
        analyse(path, options=ReadOptions(plates=("left",)))


def test_events_without_contexts(tmp_path):
    write(tmp_path / "walk.c3d", events=(("LHS", 0.61), ("LTO", 1.29), ("RHS", 1.21), ("RTO", 1.88)))
    found = analyse(tmp_path / "walk.c3d")
    assert found.recording.events["left"].heel_strikes == pytest.approx([0.61])
    assert found.recording.events["right"].toe_offs == pytest.approx([1.88])
    assert [event_of(e) for e in ("RIC", "LFO", "Right Foot Strike", "L_HS", "Event")] == [
        ("right", "strikes"),
        ("left", "lifts"),
        ("right", "strikes"),
        ("left", "strikes"),
        None,
    ]


def test_what_is_no_force_of_a_foot_is_refused(tmp_path):
    path = tmp_path / "walk.c3d"
    write(path, units=("V", "V"))
    with pytest.raises(FormatError, match="are in v, and no calibration matrix"):
        analyse(path)
    wheel = [Contact(0.6, 1.3, "left", 0.3, 0.1), Contact(1.2, 1.9, "right", 0.9, -0.1)]
    for contact in wheel:
        contact.force = contact.force[:, [2, 1, 2]]
    write(path, wheel)
    with pytest.raises(FormatError, match="no foot pushes so"):
        analyse(path)
