import numpy as np

from plantar.wholebody.behaviours.nociceptive_reflex import NociceptiveReflex, ReflexSettings


class Nothing:
    def demand(self, robot, skin):
        return None


def test_the_reflex_begins_at_the_threshold_and_ends_after_a_calm():
    default, withdrawn = [[Nothing()], [Nothing()]], [[Nothing()]]
    reflex = NociceptiveReflex(default, withdrawn)
    assert not reflex.update(10.0, 0.0)
    assert reflex.levels is default
    assert reflex.update(10.1, 0.1)
    assert reflex.levels is withdrawn
    assert not reflex.update(6.0, 1.0)  # under the threshold, but not released
    assert not reflex.update(1.0, 1.1)
    assert not reflex.update(1.0, 1.4)
    assert reflex.update(1.0, 1.5)
    assert reflex.levels is default


def test_a_force_that_swings_about_the_threshold_switches_once():
    reflex = NociceptiveReflex([], [], ReflexSettings(threshold=10.0, release=0.5))
    changes = [reflex.update(10.0 + 4.0 * np.sin(40.0 * t), t) for t in np.arange(0.0, 5.0, 2e-3)]
    assert sum(changes) == 1
    plain = np.diff(np.sign([4.0 * np.sin(40.0 * t) for t in np.arange(0.0, 5.0, 2e-3)]))
    assert np.count_nonzero(plain) > 50
