"""The kernel of a foot's contacts: compiled against interpreted, and against numpy's sums."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.kernels import compiled, python_form
from plantar.kernels.contacts import foot_contacts, ground_reaction
from plantar.kernels.geometry import convex, few_points
from plantar.kernels.geometry.hull import convex_hull

from ...examples import examples

REACH = 5e-4
OWN = np.array([1, 0, 1, 0, 0], dtype=np.uint8)  # geoms 0 and 2 are the foot's
seeds = st.integers(0, 2**32 - 1)


def listed(seed: int):
    """Contacts as a simulator lists them, up to 40, and the numbers of those that carry."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 40))
    geoms = rng.integers(-1, len(OWN), (n, 2)).astype(np.int32)
    frames = np.array([np.linalg.qr(rng.normal(size=(3, 3)))[0].ravel() for _ in range(n)])
    sizes = rng.choice([1, 3, 4, 6], n).astype(np.int32)
    carries = rng.random(n) < 0.7
    ends = np.cumsum(np.where(carries, sizes, 0))
    addresses = np.where(carries, ends - sizes, -1).astype(np.int32)
    gaps = rng.uniform(-REACH, 3.0 * REACH, n)
    return (geoms, rng.normal(size=(n, 3)), frames, gaps, addresses, sizes), rng.normal(size=int(ends[-1]))


def gathered(module, seed: int):
    shown, forces = listed(seed)
    foot = module.FootContacts(OWN)
    module.gather_feet((foot,), module.ContactList(*shown), forces)
    return foot


def parts(foot):
    """Ids (k, 2), positions, forces, torques (k, 3), gaps and whether it carries (k,)."""
    k = foot.size
    vectors = np.asarray(foot.vectors)[: 3 * k]
    ids, gaps, carries = (np.asarray(a)[:k] for a in (foot.ids, foot.gaps, foot.carries))
    return ids, vectors[::3], vectors[1::3], vectors[2::3], gaps, carries.astype(bool)


def ground(foot, module=few_points):
    sums, points = np.zeros(7), module.FewPoints()
    for _ in range(2):  # of two feet
        foot.add_to_ground(REACH, None, sums, points)
    return sums, points.points_of(0, points.count)


def hull_of(points, module=few_points):
    cloud = module.FewPoints()
    for point in points:
        cloud.add(*point)
    cloud.hull(0, cloud.count)
    return cloud


def seen(foot, origin):
    out = np.zeros((3 * foot.size + 2, 3))
    foot.from_origin(origin, out)
    return out


@pytest.mark.skipif(not compiled, reason="without a compiler there is one form only")
@examples(60)
@given(seeds)
def test_the_two_forms_agree_to_the_last_bit(seed):
    one, other = (gathered(m, seed) for m in (foot_contacts, python_form("foot_contacts")))
    assert all(np.array_equal(a, b) for a, b in zip(parts(one), parts(other), strict=True))
    source = python_form("few_points")
    (sums, points), (same, equal) = ground(one), ground(other, source)
    assert sums.tolist() == same.tolist()
    assert points == equal
    origin = np.array([0.1, 0.2, 0.3])
    assert np.array_equal(seen(one, origin), seen(other, origin))
    assert one.pair_loads(seen(one, origin), REACH) == other.pair_loads(seen(other, origin), REACH)
    x, y = np.random.default_rng(seed).uniform(-0.3, 0.3, 2).tolist()
    mine, same = (
        (hull.corners_of(), hull.margin(x, y), hull.area()) for hull in (hull_of(points), hull_of(points, source))
    )
    assert mine == same


@examples(60)
@given(seeds)
def test_those_of_the_foot_are_gathered_with_forces_in_the_world(seed):
    (geoms, positions, frames, gaps, addresses, sizes), numbers = listed(seed)
    own = np.append(OWN, 0)[geoms]  # -1 is no geom, and nobody's
    mine = np.flatnonzero(own[:, 0] != own[:, 1])
    ids, at, forces, torques, found, carries = parts(gathered(foot_contacts, seed))
    assert len(ids) == len(mine)
    assert np.array_equal(at, positions[mine])
    assert np.array_equal(found, gaps[mine])
    assert np.array_equal(carries, addresses[mine] >= 0)
    for row, i in enumerate(mine):
        second = bool(own[i, 1])
        local = np.zeros(6)
        if addresses[i] >= 0:
            local[: sizes[i]] = numbers[addresses[i] : addresses[i] + sizes[i]]
        local *= 1.0 if second else -1.0
        axes = frames[i].reshape(3, 3)
        assert ids[row].tolist() == geoms[i].tolist()[:: -1 if second else 1]
        assert forces[row] == pytest.approx(local[:3] @ axes, abs=1e-12)
        assert torques[row] == pytest.approx(local[3:] @ axes, abs=1e-12)


@examples(60)
@given(seeds)
def test_the_ground_s_sums_are_numpy_s(seed):
    foot = gathered(foot_contacts, seed)
    sums, points = ground(foot)
    _, positions, forces, torques, gaps, carries = parts(foot)
    assert sums[:3] == pytest.approx(2.0 * forces.sum(axis=0), abs=1e-12)
    assert sums[3:6] == pytest.approx(2.0 * (np.cross(positions, forces) + torques).sum(axis=0), abs=1e-11)
    assert sums[6] == pytest.approx(2.0 * positions[:, 2] @ forces[:, 2], abs=1e-12)
    assert points == 2 * [(x, y) for x, y, _ in positions[carries | (gaps <= REACH)].tolist()]


@pytest.mark.parametrize("height", [np.nan, 0.3])
@given(seeds)
def test_the_ground_s_reaction_is_that_of_both_feet_in_both_forms(height, seed):
    forms = (foot_contacts, ground_reaction), (python_form("foot_contacts"), python_form("ground_reaction"))
    reactions = []
    for lists, module in forms:
        reaction = module.GroundReaction(height, 1.0, REACH)
        for first in (seed + 5, seed):  # what was found before leaves no trace
            reaction.update([gathered(lists, first), gathered(lists, first + 1)])
        areas = [reaction.area(foot) for foot in (0, 1)]
        reactions.append((*reaction.found_now(), areas))
    one, other = reactions
    assert one[0].tolist() == other[0].tolist()
    assert (one[1] is None) == (other[1] is None)
    assert one[1] is None or one[1].tolist() == other[1].tolist()
    assert one[2:] == other[2:]
    for own, measure in zip(one[4], one[5], strict=True):
        assert measure == hull_of(own).area()
    one = one[:5]
    wrench, zmp, ring, margin, points = one
    sums, together = np.zeros(7), []
    for number, own in enumerate(points):
        added = few_points.FewPoints()
        gathered(foot_contacts, seed + number).add_to_ground(REACH, None, sums, added)
        assert own == added.points_of(0, added.count)
        together += own
    assert wrench.tolist() == sums[:6].tolist()
    assert ring == hull_of(together).corners_of()
    if zmp is None:
        assert sums[2] < 1.0
        assert margin is None
        return
    plane = sums[6] / sums[2] if np.isnan(height) else height
    moment = sums[3:6] - np.cross([*zmp, plane], sums[:3])  # about the ZMP there is none but about the vertical
    assert moment[:2] == pytest.approx(np.zeros(2), abs=1e-9 * np.abs(sums).max())
    assert margin == hull_of(together).margin(*zmp)


@examples(60)
@given(seeds)
def test_hulls_of_gathered_points_are_those_of_a_list_and_their_measures_those_of_arrays(seed):
    rng = np.random.default_rng(seed)
    points = [tuple(p) for p in rng.integers(-3, 4, (int(rng.integers(0, 30)), 2)).astype(float).tolist()]
    hull = hull_of(points)
    assert hull.corners_of() == [tuple(p) for p in convex_hull(np.array(points).reshape(-1, 2)).tolist()]
    if not points:
        assert hull.margin(0.0, 0.0) == -np.inf
    else:
        ring, point = np.array(hull.corners_of()), rng.uniform(-5.0, 5.0, 2)
        assert hull.margin(*point.tolist()) == pytest.approx(convex.signed_margin(ring, *point.tolist()), abs=1e-12)
        assert hull.area() == pytest.approx(convex.area(ring))


@examples(60)
@given(seeds)
def test_each_pair_has_its_contacts_wrench_and_points(seed):
    foot, origin = gathered(foot_contacts, seed), np.array([0.5, -0.2, 0.1])
    ids, positions, forces, torques, gaps, _ = parts(foot)
    positions = positions - origin
    counts = ~((gaps > REACH) & (forces[:, 2] == 0.0))
    pairs = list(dict.fromkeys(map(tuple, ids[counts].tolist())))
    loads = foot.pair_loads(seen(foot, origin), REACH)
    assert len(loads) == len(pairs)
    for pair, (force, about_x, about_y, points) in zip(pairs, loads, strict=True):
        mine = counts & (ids == pair).all(axis=1)
        moment = (np.cross(positions, forces) + torques)[mine].sum(axis=0)
        assert [force, about_x, about_y] == pytest.approx([forces[mine, 2].sum(), *moment[:2]], abs=1e-12)
        assert points == [(x, y) for x, y, _ in positions[mine].tolist()]


FORMS = (foot_contacts, python_form("foot_contacts"))


@pytest.mark.parametrize("seed", range(5))
def test_contacts_are_seen_from_the_sole_wherever_it_is(seed):
    rng = np.random.default_rng(seed)
    origin, rotation = np.zeros(3), np.eye(3)
    seen = [form.ContactsInSole() for form in FORMS]
    for one in seen:
        one.look_from(origin, rotation)
    for k in (4, 1, 0, 3, 30, 2, 1):
        origin[:], rotation[:] = rng.normal(size=3), np.linalg.qr(rng.normal(size=(3, 3)))[0]
        vectors = rng.normal(size=(3 * k, 3))
        shifted = vectors.copy()
        shifted[::3] -= origin
        found = []
        for one, form in zip(seen, FORMS, strict=True):
            foot = form.FootContacts(np.zeros(1, dtype=np.uint8))
            foot.take(np.zeros((k, 2), dtype=np.int32), vectors, np.zeros(k), np.ones(k, dtype=np.uint8))
            one.turn(foot)
            found.append(np.array(one.vectors)[: 3 * k])
        assert np.array_equal(*found)
        assert found[0] == pytest.approx(shifted @ rotation, abs=1e-14)
    assert [(one.pressed, one.in_air) for one in seen] == [(6, 1)] * 2
