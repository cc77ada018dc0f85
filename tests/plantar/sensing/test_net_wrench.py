"""The net wrench against sums taxel by taxel in the world, and against the printed active set."""

import numpy as np
import pytest

from plantar.errors import ReadingError
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.net_wrench import NetWrenchRules, net_wrench
from plantar.sensing.reading import Reading

RANGE = 0.05


def turned(rng: np.random.Generator, count: int) -> np.ndarray:
    """Rotations (count, 3, 3) of any sort."""
    found = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    return found * np.linalg.det(found)[:, None, None]


def body(seed: int = 0) -> tuple[BodySkin, dict]:
    """A skin on three links, and where they are."""
    rng = np.random.default_rng(seed)
    patches = [
        SkinPatch(name, link, rng.normal(size=(n, 3)), turned(rng, n), np.full(n, 7e-4), 0.5, sight)
        for name, link, n, sight in (("chest", "torso", 6, RANGE), ("hand", "arm", 4, RANGE), ("blind", "leg", 3, 0.0))
    ]
    skin = BodySkin(patches)
    return skin, {link: (rng.normal(size=3), turned(rng, 1)[0]) for link in skin.links}


def test_it_is_the_sum_over_taxels_in_the_world():
    skin, poses = body()
    rng, rules = np.random.default_rng(1), NetWrenchRules(near=0.2, proximity_force=2.0)
    force = rng.uniform(0.0, 5.0, len(skin)) * (rng.random(len(skin)) < 0.5)
    distance = np.where(rng.random(len(skin)) < 0.5, rng.uniform(0.0, RANGE, len(skin)), np.inf)
    force[2], distance[3] = np.nan, np.nan
    com, wanted, counted = np.array([0.1, -0.2, 0.8]), np.zeros(6), []
    for patch in skin.patches:
        origin, rotation = poses[patch.link]
        for k, i in enumerate(range(*skin.slices[patch.name].indices(len(skin)))):
            sees = patch.proximity_range > 0.0 and np.isfinite(distance[i])
            near = 1.0 - distance[i] / patch.proximity_range if sees else 0.0
            if not (force[i] > 0.5 or near > 0.2):  # K 2, corrected
                continue
            counted.append(i)
            pseudo = np.nan_to_num(force[i]) + 2.0 * near
            push = rotation @ patch.rotations[k] @ [0.0, 0.0, pseudo]  # K 4 with z into the body
            wanted += [*push, *np.cross(origin + rotation @ patch.positions[k] - com, push)]
    found = net_wrench(skin, Reading(0.0, force, distance), poses, com, rules)
    assert found.taxels.tolist() == counted
    assert found.wrench == pytest.approx(wanted, abs=1e-12)


def test_what_is_about_to_touch_counts_and_with_the_printed_active_set_would_not():
    skin, poses = body()
    distance = np.full(len(skin), np.inf)
    distance[skin.slices["hand"]] = 0.01
    reading = Reading(0.0, np.zeros(len(skin)), distance)
    found = net_wrench(skin, reading, poses, np.zeros(3), NetWrenchRules())
    assert found.taxels.tolist() == list(range(*skin.slices["hand"].indices(len(skin))))
    assert np.linalg.norm(found.wrench[:3]) > 0.1
    printed = (reading.force > skin.thresholds) & (distance < 0.95 * RANGE)
    assert not printed.any()


def test_each_link_that_moves_carries_its_wrench_with_it():
    skin, poses = body()
    rng = np.random.default_rng(2)
    reading = Reading(0.0, rng.uniform(0.0, 5.0, len(skin)), np.full(len(skin), np.inf))
    before = net_wrench(skin, reading, poses, np.zeros(3), NetWrenchRules()).wrench
    turn, shift = turned(rng, 1)[0], rng.normal(size=3)
    moved = {link: (turn @ p + shift, turn @ r) for link, (p, r) in poses.items()}
    after = net_wrench(skin, reading, moved, shift, NetWrenchRules()).wrench
    assert after == pytest.approx([*turn @ before[:3], *turn @ before[3:]], abs=1e-12)


def test_silence_is_no_push():
    skin, _ = body()
    quiet = Reading(0.0, np.full(len(skin), np.nan), np.full(len(skin), np.nan))
    found = net_wrench(skin, quiet, {}, np.zeros(3), NetWrenchRules())
    assert found.wrench.tolist() == [0.0] * 6
    assert len(found.taxels) == 0
    loud = Reading(0.0, np.full(len(skin), 1e4), np.zeros(len(skin)))
    assert np.isfinite(net_wrench(skin, loud, body()[1], np.zeros(3), NetWrenchRules()).wrench).all()


def test_wrong_arguments_are_named():
    skin, poses = body()
    reading = Reading(0.0, np.ones(len(skin)), np.zeros(len(skin)))
    with pytest.raises(ReadingError, match="link 'leg' feels something and has no pose; given: arm, torso"):
        net_wrench(skin, reading, {k: poses[k] for k in ("arm", "torso")}, np.zeros(3), NetWrenchRules())
    with pytest.raises(ReadingError, match="the skin has 13 taxels"):
        net_wrench(skin, Reading(0.0, np.ones(2), np.ones(2)), poses, np.zeros(3), NetWrenchRules())
