"""What came of a robot that a hand leads, from made-up motions of its arm and feet."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.mechanics.rotation import level_rotation
from plantar.sim.judging.guide_truth import ASTRAY, FOLLOWED, YIELDED, GuideTruth

HELD, BASE = 3, 1
POINT = np.array([0.1, 0.0, 0.02])


class Led:
    """A trunk, a forearm that is held, and two feet."""

    def __init__(self, way: float = 0.3, yaw: float = 0.0) -> None:
        self.data: Any = SimpleNamespace(
            xpos=np.zeros((5, 3)), xmat=np.tile(np.eye(3).ravel(), (5, 1)), site_xpos=np.zeros((2, 3)), qpos=np.zeros(9)
        )
        self.data.site_xpos[:] = [[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]
        self.data.xmat[:] = level_rotation(yaw).ravel()
        self.along = level_rotation(yaw)[:, 0]
        model: Any = SimpleNamespace(
            body=lambda name: SimpleNamespace(id=HELD),
            body_rootid=np.array([0, 1, 1, BASE, 1]),
            joint=lambda name: SimpleNamespace(qposadr=[int(name[-1])]),
        )
        world: Any = SimpleNamespace(model=model, data=self.data, sole_sites={"left": 0, "right": 1})
        posture = np.array([0.1, 0.2])
        self.data.qpos[[7, 8]] = posture
        self.truth = GuideTruth(world, "arm", POINT, ("joint7", "joint8"), posture, way, 1.0)

    def at(self, time: float, arm: float = 0.0, feet: float = 0.0, aside: float = 0.0, trunk: float = 0.0) -> None:
        self.data.xpos[BASE] = trunk * self.along
        self.data.xpos[HELD] = (trunk + arm) * self.along
        self.data.site_xpos[:, 0], self.data.site_xpos[:, 1] = feet, np.array([0.1, -0.1]) + aside
        self.truth.update(time)


def criteria(led: Led) -> set[str]:
    return {reason["criterion"] for reason in led.truth.reasons()}


def test_before_the_hand_goes_nothing_was_measured():
    led = Led()
    led.at(0.5, arm=0.2, feet=0.3)
    assert set(led.truth.summary().values()) == {None}


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("yaw", [0.0, 0.5])
def test_arm_and_feet_are_followed_along_the_hand_s_way(sign, yaw):
    led = Led(sign * 0.3, yaw)
    led.at(0.99, arm=0.05, feet=0.02, aside=0.01)  # from here on
    led.at(1.0, arm=0.05 + sign * 0.12, feet=0.02, aside=0.01)
    led.data.qpos[8] -= 0.3
    led.at(2.0, arm=0.05 + sign * 0.04, feet=0.02 + sign * 0.25, aside=-0.02, trunk=0.4)
    told = led.truth.summary()
    assert told["arm_yielded_m"] == pytest.approx(0.12)  # at most, and against the trunk
    assert told["feet_followed_m"] == pytest.approx(0.25)
    assert told["feet_astray_m"] == pytest.approx(0.03)
    assert told["arm_turned_deg"] == pytest.approx(17.19)
    assert criteria(led) == set()


@pytest.mark.parametrize(
    ("arm", "feet", "aside", "failed"),
    [
        (YIELDED, FOLLOWED, ASTRAY, set()),
        (YIELDED - 0.01, 1.0, 0.0, {"yielded"}),
        (1.0, FOLLOWED - 0.01, 0.0, {"followed"}),
        (1.0, 1.0, ASTRAY + 0.01, {"astray"}),
        (1.0, 1.0, -ASTRAY - 0.01, {"astray"}),
        (0.0, 0.0, 0.0, {"yielded", "followed"}),
    ],
)
def test_each_criterion_has_its_share_of_the_way(arm, feet, aside, failed):
    way, hair = 0.3, 1e-9
    led = Led(way)
    led.at(0.0)
    led.at(1.5, arm=way * arm + hair, feet=way * feet + hair, aside=way * aside - hair * np.sign(aside))
    assert criteria(led) == failed
    for reason in led.truth.reasons():
        assert f"{reason['limit']:.3f} m" in reason["text"]
