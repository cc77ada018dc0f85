"""The kernel of the elastic foundation: compiled against interpreted, and against its own statics."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize
from hypothesis import given, settings
from hypothesis import strategies as st

from plantar.kernels import is_compiled, python_form
from plantar.kernels.contacts import foundation

seeds = st.integers(0, 2**32 - 1)


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


@pytest.mark.skipif(not is_compiled("foundation"), reason="without a compiler there is one form only")
@settings(max_examples=100)
@given(seeds)
def test_the_two_forms_agree_to_the_last_bit(seed):
    one, other = (spread(m, seed) for m in (foundation, python_form("foundation")))
    assert one[:2] == other[:2]
    assert (one[2] == other[2]).all()
    assert (one[3] == other[3]).all()


@settings(max_examples=100)
@given(seeds)
def test_forces_add_up_to_the_load_and_its_moments(seed):
    whole, part, carried, forces = spread(foundation, seed)
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
        whole, part, _, forces = spread(foundation, seed)
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
