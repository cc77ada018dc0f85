"""Hands push through the skin: what a body gains in momentum is what they were to give, in every direction and size."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.errors import SceneError
from plantar.sim.model.world import World
from plantar.sim.partner.hand_pushes import HandPush, HandPushes, faces_of
from plantar.sim.partner.touch import Touch

from .floating import HALF, box_skin, floating_box

SMALL = BodyScale(mass=86.0 * 0.4**3, leg=0.24, sole=0.0924, sole_width=0.064)


def middle(world: World) -> float:
    return 0.0


def pushed(*impulses, body=REFERENCE_BODY, duration=0.1):
    """A box with hands that push it 0.3 s apart, first at 0.4 s."""
    pushes = [
        HandPush(np.array(impulse), duration, lambda start=0.4 + 0.3 * i: start) for i, impulse in enumerate(impulses)
    ]
    hands = HandPushes(pushes, box_skin(body), body, middle)
    return floating_box([hands], body), hands


def run(touch: Touch, seconds: float) -> NDArray[np.float64]:
    """Momentum (3,) of the box in N s after so many seconds."""
    data = touch._world.data
    while data.time < seconds:
        touch.step()
    return np.asarray(data.qvel[:3] * touch._world.body.mass)


@pytest.mark.parametrize("degrees", [0, 135, -110])
def test_a_free_body_gains_the_impulse_in_the_direction_that_was_asked_for(degrees):
    wanted = 30.0 * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    touch, hands = pushed((wanted[0], wanted[1]))
    momentum = run(touch, 0.6)
    np.testing.assert_allclose(momentum[:2], wanted, atol=0.02 * 30.0)
    np.testing.assert_allclose(hands.pushes[0].delivered, momentum, atol=1e-6)
    assert hands.pushes[0].start == pytest.approx(0.4, abs=0.0011)
    assert hands.pushes[0].end - hands.pushes[0].start < 1.5 * 0.1
    assert np.abs(touch._world.data.qvel[3:6]).max() < 0.02  # rad/s: no hand pushes beside the middle


def test_a_small_body_is_pushed_alike():
    impulse = 0.3 * SMALL.mass
    touch, _ = pushed((0.0, impulse), body=SMALL)
    np.testing.assert_allclose(run(touch, 0.6), [0.0, impulse, 0.0], atol=0.02 * impulse)


def test_a_push_away_from_the_last_one_stops_the_body():
    touch, hands = pushed((20.0, 0.0), (-20.0, 0.0))
    momentum = run(touch, 0.9)
    assert [push.step for push in hands.pushes] == [-1, -1]
    assert np.linalg.norm(momentum) < 0.6
    assert faces_of(hands.pushes) == ("front", "back")


def test_taxels_measure_the_true_force_and_only_during_a_push():
    touch, _ = pushed((20.0, 0.0))
    skin, felt = touch.sensor.body_skin, []
    data = touch._world.data
    while data.time < 0.7:
        touch.step()
        reading = touch.read()
        active = reading.force > skin.thresholds
        felt.append((data.time, float(reading.force[active] @ -skin.normals[active, 0]), float(touch.force[0])))
    times, told, true = np.array(felt).T
    pushing = true > 100.0
    assert pushing.sum() > 50
    assert np.abs(told + true)[pushing].mean() < 0.05 * true[pushing].mean()  # of some dozen taxels of 5 % each
    quiet = (times < 0.39) | (times > 0.6)
    assert not told[quiet].any()


def test_a_waiting_hand_is_beyond_what_the_skin_sees():
    touch, _ = pushed((20.0, 0.0))
    run(touch, 0.05)
    touch.sensor.press(touch._world.data)
    assert np.isinf(touch.sensor.distance).all()


def test_a_push_over_the_skin_is_refused():
    hands = HandPushes([HandPush(np.array([1.0, 0.0]), 0.1, lambda: 0.4)], box_skin(), REFERENCE_BODY, lambda _: 0.5)
    with pytest.raises(SceneError, match=r"at a height of 1.500 m; allowed: where the upper body has skin, 0.7"):
        floating_box([hands])
    assert HALF[2] < 0.5
