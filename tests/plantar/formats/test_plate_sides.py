"""The foot of each contact where names, markers and events do not show it."""

import numpy as np
import pytest

from plantar.formats.force_plates import feet_of_plates
from plantar.formats.format import ReadOptions
from plantar.formats.plate_sides import Plate, PlateContact, sides_of_contacts
from plantar.recordings.pressure_recording import StatedEvents

RATE = 100.0
LENGTH = 60  # frames of a contact


def walk(across: list[float], pushes: list[float]) -> tuple[list[Plate], list[PlateContact]]:
    """Plates in the way of x, stepped on one after another at places `across` it in m, pushed leftward by shares."""
    plates = []
    contacts = []
    gone = np.linspace(0.0, 1.0, LENGTH)
    for i, (y, push) in enumerate(zip(across, pushes, strict=True)):
        begin = 50 * i
        force = np.zeros((50 * len(across) + LENGTH, 3))
        load = 800.0 * np.sin(np.pi * gone) ** 0.5
        force[begin : begin + LENGTH] = np.column_stack([0.2 * load * (2.0 * gone - 1.0), push * load, load])
        cop = np.full((len(force), 2), np.nan)
        cop[begin : begin + LENGTH] = np.column_stack([0.65 * i + 0.2 * gone, np.full(LENGTH, y)])
        plates.append(Plate(f"plate {i + 1}", force, cop=cop))
        contacts.append(PlateContact(i, begin, begin + LENGTH))
    return plates, contacts


@pytest.mark.parametrize(
    ("across", "pushes", "why"),
    [
        ([-0.05, 0.05, -0.05, 0.05], [0.05, -0.05, 0.05, 0.0], "places across"),  # one push is not clear
        ([0.10, 0.25, 0.14, 0.17], [0.05, -0.05, 0.05, -0.002], "push to the body's middle"),  # two steps of one foot
        ([0.05, 0.20, 0.14, 0.10], [0.05, -0.05, 0.05, -0.002], "push to the body's middle"),  # places say otherwise
    ],
)
def test_clear_pushes_decide_over_places_that_contradict_them(across, pushes, why):
    plates, contacts = walk(across, pushes)
    warnings: list[str] = []
    found = sides_of_contacts(plates, contacts, False, RATE, None, warnings)
    assert found == ["right", "left", "right", "left"]
    assert why in warnings[0]


def test_events_of_feet_that_land_together_show_no_foot():
    plates, contacts = walk([0.1, -0.1], [-0.05, 0.05])
    plates[1] = Plate("plate 2", np.roll(plates[1].force, -50, axis=0), cop=np.roll(plates[1].cop, -50, axis=0))
    contacts[1] = PlateContact(1, 0, LENGTH)
    together = {side: StatedEvents(np.array([0.01]), np.zeros(0)) for side in ("left", "right")}
    warnings: list[str] = []
    assert sides_of_contacts(plates, contacts, False, RATE, None, warnings, None, together) == ["left", "right"]
    assert "push" in warnings[0]


@pytest.mark.parametrize(("apart", "told"), [(0.1, 1), (0.6, 0)])
def test_a_plate_under_the_markers_of_both_feet_is_doubted(apart, told):
    force = np.zeros((300, 3))
    force[:, 2] = 700.0 + 5.0 * np.sin(np.arange(300.0))
    corners = np.array([[0.25, 0.25], [-0.25, 0.25], [-0.25, -0.25], [0.25, -0.25]])
    plate = Plate("plate 1", force, cop=np.zeros((300, 2)), corners=corners)
    markers = {side: np.tile([0.0, y], (300, 1)) for side, y in (("left", apart), ("right", -0.1))}
    warnings: list[str] = []
    feet_of_plates([plate], RATE, ReadOptions(), warnings, markers)
    assert sum("load is that of both feet" in w for w in warnings) == told


@pytest.mark.parametrize("stuck", [-1447.6, 374.1])
def test_a_plate_that_reads_the_same_throughout_is_left_out(stuck):
    plates, _ = walk([0.1, -0.1], [-0.05, 0.05])
    plates.append(Plate("plate 3", np.full_like(plates[0].force, stuck)))
    warnings: list[str] = []
    feet, _ = feet_of_plates(plates, RATE, ReadOptions(), warnings)
    assert [float(feet[side].vertical_force.max()) for side in ("left", "right")] == pytest.approx(
        [800.0, 800.0], rel=0.001
    )
    assert any("in every frame" in w and "plate 3" in w for w in warnings)
