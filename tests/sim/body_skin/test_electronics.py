"""Readings of a skin's electronics: rate, delay, gain errors, dead taxels."""

import numpy as np
import pytest

from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.electronics import SkinElectronics, SkinElectronicsSettings, SkinSensing

COUNT = 300
LINE = np.column_stack([0.03 * np.arange(COUNT), np.zeros((COUNT, 2))])
SKIN = BodySkin([SkinPatch("line", "link", LINE, np.tile(np.eye(3), (COUNT, 1, 1)), np.full(COUNT, 691e-6))])


def test_readings_have_rate_delay_gain_errors_and_dead_taxels():
    electronics = SkinElectronics(SKIN, SkinSensing(dead_taxels=0.1, delay_periods=2, noise=0.0, rate=100.0), 3)
    told = []
    for step in range(50):
        true = Reading(0.001 * step, np.full(COUNT, 10.0 * (1.0 + step)))
        told.append(electronics.read(0.001 * step, lambda true=true: true))
    assert [r.time for r in told[::10]] == pytest.approx([0.0, 0.0, 0.0, 0.01, 0.02])
    assert np.isnan(told[0].force).sum() == round(0.1 * COUNT)
    spread = np.nanstd(told[0].force / 10.0)
    assert 0.02 < spread < 0.08
    assert SkinElectronicsSettings().bits == 10


def test_temperatures_are_read_where_there_are_some():
    electronics = SkinElectronics(SKIN, SkinSensing(), 3)
    true = Reading(0.0, np.zeros(COUNT))
    assert electronics.read(0.0, lambda: true).temperature is None
    warm = electronics.read(0.01, lambda: true, np.full(COUNT, 40.0)).temperature
    assert warm is not None
    assert warm == pytest.approx(40.0, abs=1.0)
