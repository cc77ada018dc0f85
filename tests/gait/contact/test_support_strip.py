import numpy as np
import pytest

from plantar.gait.contact.support_strip import SupportStrip

FORWARD = np.array([0.0, 1.0])


def strip() -> SupportStrip:
    return SupportStrip(np.zeros(2), FORWARD)


def test_one_foothold_is_no_strip_and_two_of_both_feet_are():
    found = strip()
    found.update(3, "left", np.array([0.05, 0.3]))
    assert not found.known
    found.update(4, "right", np.array([0.052, 0.2]))
    assert found.known
    assert found.lateral(0.4) == pytest.approx(-0.051, abs=0.002)  # x is to the right of a walk along y


def test_a_turned_strip_is_followed():
    found, slope = strip(), 0.0875
    for k in range(6):
        place = 0.04 * k + (0.17 if k % 2 == 0 else 0.0)
        found.update(k, "left" if k % 2 == 0 else "right", np.array([slope * place, place]))
    assert found.lateral(0.5) == pytest.approx(-slope * 0.5, abs=0.004)


def test_footholds_that_do_not_agree_start_anew():
    found = strip()
    found.update(1, "left", np.array([0.0, 0.1]))
    found.update(2, "right", np.array([0.08, 0.1]))
    assert not found.known
    found.update(3, "left", np.array([0.081, 0.2]))
    assert found.known
    found.update(5, "left", np.array([0.081, 0.3]))  # a step between them stood on whole ground
    assert not found.known


def test_a_foothold_that_is_refined_counts_once():
    found = strip()
    found.update(1, "left", np.array([0.03, 0.1]))
    found.update(2, "right", np.array([0.05, 0.1]))
    found.update(2, "right", np.array([0.03, 0.1]))
    assert found.lateral(0.1) == pytest.approx(-0.03, abs=1e-9)
