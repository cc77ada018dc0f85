"""The kernel of a pressed patch: compiled against interpreted, and against the load that it spreads."""

import numpy as np
import pytest
import scipy.optimize
from hypothesis import example, given
from hypothesis import strategies as st

from plantar.geometry.polygon import convex_hull, inner_offset
from plantar.kernels import compiled, python_form
from plantar.kernels.contacts import pressed_patch

from ...examples import examples

seeds = st.integers(0, 2**32 - 1)
FORMS = (pressed_patch, python_form("pressed_patch"))


def pressed(module, seed: int):
    """A patch of a lattice of cells after three loads: whether each was spread, with which forces, and where."""
    rng = np.random.default_rng(seed)
    points = np.array([(x, y) for x in range(int(rng.integers(2, 8))) for y in range(int(rng.integers(2, 5)))], float)
    area = rng.uniform(0.2, 1.0, len(points))
    area /= area.sum()
    centre = area @ points
    u = np.column_stack([np.ones(len(points)), points - centre])
    reach = inner_offset(convex_hull(u[:, 1:]), 0.01)
    patch = module.PressedPatch(
        np.arange(len(points)), tuple(centre.tolist()), 1.0, area, u, np.linalg.inv((area * u.T) @ u), reach
    )
    np.asarray(patch.carried)[:] = 1
    found = []
    for _ in range(3):
        out, force = np.zeros(len(points)), float(rng.uniform(1.0, 500.0))
        x, y = (centre + rng.normal(size=2) * np.ptp(points, axis=0) * 0.4).tolist()
        done = patch.spread(force, x, y, out)
        found.append((done, out.tolist(), force, (patch.x, patch.y), (u, reach)))
    return found


@pytest.mark.skipif(not compiled, reason="without a compiler there is one form only")
@examples(60)
@given(seeds)
def test_the_two_forms_agree_to_the_last_bit(seed):
    for one, other in zip(*(pressed(module, seed) for module in FORMS), strict=True):
        assert one[:4] == other[:4]
    points = np.random.default_rng(seed).uniform(-0.2, 0.2, (5, 2)).tolist()
    keys = {module.patch_key(some, 1e-4) for module in FORMS for some in (points, points[::-1], points * 2)}
    assert keys == {tuple(sorted({(round(x / 1e-4), round(y / 1e-4)) for x, y in points}))}


@examples(60)
@given(seeds)
def test_forces_have_the_load_s_wrench_where_cells_can_carry_it(seed):
    for done, out, force, point, (u, _) in pressed(pressed_patch, seed):
        if done:
            assert min(out) >= 0.0
            assert np.array(out) @ u == pytest.approx(force * np.array([1.0, *point]), abs=1e-7 * force)


def test_a_patch_of_which_nothing_carried_yet_says_so():
    u = np.array([[1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    area, reach = np.full(3, 1.0 / 3.0), np.array([[-0.9, 0.0], [0.9, 0.0]])
    for module in FORMS:
        patch = module.PressedPatch(np.arange(3), (0.0, 0.0), 1.0, area, u, np.diag([1.0, 1.5, 0.0]), reach)
        out = np.zeros(3)
        assert not patch.spread(5.0, 0.95, 0.0, out)
        assert (patch.x, patch.y) == (0.9, 0.0)
        assert not out.any()
        np.asarray(patch.carried)[1:] = 1
        assert patch.part(5.0, out)
        assert out == pytest.approx([0.0, 0.5, 4.5])


@examples(60)
@given(seeds)
@example(4)
@example(22)
@example(13303)
def test_a_load_that_few_cells_carry_is_settled(seed):
    found = []
    for module in FORMS:
        rng = np.random.default_rng(seed)
        u, area, inverse, *_ = patch(seed)
        reach = inner_offset(convex_hull(u[:, 1:]), 1e-4)
        pressed = module.PressedPatch(np.arange(len(u)), (0.0, 0.0), 1.0, area, u, inverse, reach)
        out, force = np.zeros(len(u)), float(rng.uniform(1.0, 900.0))
        if not pressed.spread(force, *(3.0 * rng.normal(size=2)).tolist(), out):
            np.asarray(pressed.carried)[:] = rng.random(len(u)) < 0.2 * rng.integers(2)
            pressed.settle(force, out)
        assert out.min() >= 0.0
        assert out @ u == pytest.approx(force * np.array([1.0, pressed.x, pressed.y]), abs=1e-7 * force)
        found.append(out.tolist())
    assert found[0] == found[1]


def patch(seed: int):
    """Cells of a patch and a load on it: u (m, 3), area (m,), inverse (3, 3), x, y, force."""
    rng = np.random.default_rng(seed)
    m = int(rng.integers(4, 40))
    points = rng.uniform(-1.0, 1.0, (m, 2))
    area = rng.uniform(0.1, 1.0, m)
    area /= area.sum()
    points -= area @ points
    u = np.column_stack([np.ones(m), points])
    inside = rng.dirichlet(np.full(m, 0.3)) @ points
    return u, area, np.linalg.inv((area * u.T) @ u), float(inside[0]), float(inside[1]), float(rng.uniform(1.0, 900.0))


def spread(module, seed: int):
    u, area, inverse, x, y, force = patch(seed)
    cells, out = np.arange(len(u))[::-1].copy(), np.zeros(len(u))
    whole = module.spread_whole(u, area, inverse, x, y, force, cells, out)
    part, carried = True, np.ones(len(u), dtype=np.uint8)
    if not whole:
        part = module.spread_part(u, area, x, y, force, carried, cells, out)
    return whole, part, carried, out[cells]


@pytest.mark.skipif(not compiled, reason="without a compiler there is one form only")
@examples(100)
@given(seeds)
def test_both_forms_of_the_foundation_agree(seed):
    one, other = (spread(m, seed) for m in (pressed_patch, python_form("pressed_patch")))
    assert one[:2] == other[:2]
    assert (one[2] == other[2]).all()
    assert (one[3] == other[3]).all()


@examples(100)
@given(seeds)
def test_forces_add_up_to_the_load_and_its_moments(seed):
    whole, part, carried, forces = spread(pressed_patch, seed)
    if not (whole or part):
        return
    u, area, _, x, y, force = patch(seed)
    assert (forces >= 0.0).all()
    assert forces @ u == pytest.approx(force * np.array([1.0, x, y]), abs=1e-8 * force)
    carries = np.ones(len(u), dtype=bool) if whole else carried.astype(bool)
    field = np.linalg.lstsq(u[carries], forces[carries] / area[carries], rcond=None)[0]
    pressure = u @ field
    assert forces / area == pytest.approx(np.maximum(pressure, 0.0), abs=1e-6 * force)


def test_part_of_a_patch_carries_what_minimises_the_energy():
    """Of all forces that have the load's wrench, those of least energy sum F^2 / A: a quadratic program."""
    found = 0
    for seed in range(90):
        whole, part, _, forces = spread(pressed_patch, seed)
        if whole or not part:
            continue
        u, area, _, x, y, force = patch(seed)
        best = scipy.optimize.minimize(
            lambda f, area=area: (f * f / area).sum(),
            np.full(len(u), 1.0 / len(u)),
            jac=lambda f, area=area: 2.0 * f / area,
            bounds=[(0.0, None)] * len(u),
            constraints={"type": "eq", "fun": lambda f, u=u, x=x, y=y: f @ u - (1.0, x, y), "jac": lambda f, u=u: u.T},
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 500},
        )
        if best.success:
            found += 1
            energy = ((forces / force) ** 2 / area).sum()
            assert energy == pytest.approx(best.fun, rel=1e-6)
    assert found >= 20
