"""Radiation and warm air of a hot plate against closed forms."""

import numpy as np
import pytest

from plantar.sim.companion.standing.heat import HotPlate, PlateSettings

DOWN = np.array([[0.0, 0.0, -1.0]])


@pytest.mark.parametrize("height", [0.05, 0.1, 0.3])
def test_view_factor_of_a_disc_is_the_closed_form(height):
    settings = PlateSettings()
    plate = HotPlate(np.zeros(3), settings, 1)
    exact = settings.radius**2 / (settings.radius**2 + height**2)
    assert plate.view_factors(np.array([[0.0, 0.0, height]]), DOWN)[0] == pytest.approx(exact, rel=0.03)


def test_what_faces_away_or_is_below_sees_nothing():
    plate = HotPlate(np.zeros(3), PlateSettings(), 2)
    points = np.array([[0.0, 0.0, 0.1], [0.0, 0.0, -0.1]])
    assert plate.view_factors(points, np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])).tolist() == [0.0, 0.0]


def test_it_starts_at_the_rate_of_the_heat_flux_and_ends_where_gain_is_loss(monkeypatch):
    monkeypatch.setattr(PlateSettings, "plume", 0.001)
    s = PlateSettings()
    plate = HotPlate(np.zeros(3), s, 1)
    place = np.array([[0.0, 0.0, 0.1]])
    share = plate.view_factors(place, DOWN)[0]
    flux = s.emissivity**2 * 5.670374e-8 * share * ((s.temperature + 273.15) ** 4 - (s.room + 273.15) ** 4)
    first = plate.step(place, DOWN, 0.01)[0]
    assert (first - s.room) / 0.01 == pytest.approx(flux / s.capacity, rel=1e-6)
    for _ in range(20000):
        last = plate.step(place, DOWN, 0.1)[0]
    gain = s.emissivity**2 * 5.670374e-8 * share * ((s.temperature + 273.15) ** 4 - (last + 273.15) ** 4)
    assert gain == pytest.approx(s.loss * (last - s.room), rel=1e-6)


def test_far_from_the_plate_it_cools_to_the_room():
    plate = HotPlate(np.zeros(3), PlateSettings(), 1)
    plate.temperature[:] = 60.0
    for _ in range(5000):
        last = plate.step(np.array([[5.0, 0.0, 0.1]]), DOWN, 0.2)[0]
    assert last == pytest.approx(plate.settings.room, abs=0.1)
