import numpy as np
import pytest

from plantar.wholebody.behaviours.intentional_contact import ContactSettings, ContactSigns, IntentionalContact

SETTINGS = ContactSettings(slow=0.02, force_limit=10.0, stuck=0.3, retreat=0.3, free=0.5, shrink=0.5)


def run(policy, signs, begin, end, period=0.01):
    """Update with the same signs for a while; the times of changes."""
    return [round(t, 3) for t in np.arange(begin, end, period) if policy.update(signs, t)]


@pytest.fixture
def policy():
    return IntentionalContact(["goal"], ["contact"], ["avoidance"], SETTINGS)


def test_the_arrangements_are_those_of_table_1(policy):
    assert policy.levels == (["avoidance"], ["goal"], ["contact"])
    run(policy, ContactSigns(0.0, 1.0, 0.0), 0.0, 0.5)
    assert policy.arrangement == "approach"
    assert policy.levels == (["goal"], ["contact"], ["avoidance"])
    assert policy.update(ContactSigns(0.0, 1.0, 10.0), 0.5)
    assert policy.levels == (["contact"], ["goal"], ["avoidance"])


def test_it_goes_on_avoiding_while_it_moves_or_nothing_is_near_or_it_has_arrived(policy):
    for signs in (ContactSigns(0.5, 9.0, 0.0), ContactSigns(0.0, 0.0, 0.0), ContactSigns(0.0, 9.0, 0.0, arrived=True)):
        assert run(policy, signs, 0.0, 2.0) == []
        assert policy.range_share == 1.0


def test_the_sensing_range_shrinks_to_nothing_while_it_approaches_and_comes_back(policy):
    assert run(policy, ContactSigns(0.0, 1.0, 0.0), 0.0, 0.4) == [pytest.approx(0.3, abs=0.011)]
    assert 0.6 < policy.range_share < 1.0
    run(policy, ContactSigns(0.0, 1.0, 1.0), 0.4, 1.0)
    assert policy.range_share == 0.0
    assert run(policy, ContactSigns(0.1, 0.0, 0.0), 1.0, 1.6) == [pytest.approx(1.5, abs=0.011)]
    run(policy, ContactSigns(0.1, 0.0, 0.0), 1.6, 2.2)
    assert policy.arrangement == "avoid"
    assert policy.range_share == 1.0


def test_a_retreat_lasts_until_the_force_is_well_under_the_limit(policy):
    policy.update(ContactSigns(0.0, 1.0, 12.0), 0.0)
    assert policy.arrangement == "retreat"
    assert run(policy, ContactSigns(0.1, 1.0, 6.0), 0.01, 2.0) == []
    assert len(run(policy, ContactSigns(0.1, 1.0, 1.0), 2.0, 3.0)) == 1
    assert policy.arrangement == "avoid"


def test_signs_that_swing_about_their_thresholds_do_not_chatter(policy):
    changes = 0
    for t in np.arange(0.0, 4.0, 2e-3):
        swing = np.sin(80.0 * t)
        changes += policy.update(ContactSigns(0.02 + 0.01 * swing, max(0.0, swing), 0.0), t)
    assert changes == 0
    for t in np.arange(4.0, 8.0, 2e-3):
        changes += policy.update(ContactSigns(0.0, 1.0, 10.0 + 3.0 * np.sin(80.0 * t)), t)
    assert changes == 1


def test_it_gives_up_what_it_presses_on_in_vain(policy):
    run(policy, ContactSigns(0.0, 1.0, 0.0), 0.0, 0.4)
    assert run(policy, ContactSigns(0.1, 1.0, 5.0), 0.4, 4.0) == []  # what it pushes moves
    assert run(policy, ContactSigns(0.0, 1.0, 5.0), 4.0, 6.3) == [pytest.approx(6.0, abs=0.02)]
    assert policy.arrangement == "retreat"
