"""Sums of forces in arrays of other libraries, against `plantar.batch`; of those that are installed."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from plantar import ReadingError, batch, hex_layout
from plantar.layouts.curved_sole import rotations_to_normals
from plantar.percepts import any_array

FLAT = hex_layout([[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]])
_SLOPE = 5.0 * FLAT.positions[:, 0]
CURVED = replace(
    FLAT, rotations=rotations_to_normals(np.column_stack([-np.sin(_SLOPE), np.zeros(len(FLAT)), np.cos(_SLOPE)]))
)
LIBRARIES = ("numpy", "array_api_strict", "torch", "jax.numpy")


def forces(*lead: int) -> np.ndarray:
    """Patches, with taxels that are dead, saturated or negative, and frames without load."""
    rng = np.random.default_rng(7)
    shape = (*lead, len(FLAT))
    force = np.where(rng.random(shape) < rng.random((*lead, 1)), rng.uniform(0.0, 60.0, shape), 0.0)
    force = np.where(rng.random(shape) < 0.05, rng.choice([np.nan, np.inf, -np.inf, -5.0, 785.0, 1e9], shape), force)
    force[0] = 0.0
    return force


def library(name: str) -> Any:
    found = pytest.importorskip(name, exc_type=ImportError)
    if name == "jax.numpy":
        import jax

        jax.config.update("jax_enable_x64", True)
    return found


@pytest.mark.parametrize("name", LIBRARIES)
@pytest.mark.parametrize("sole", [FLAT, CURVED], ids=["flat", "curved"])
@pytest.mark.parametrize("bits", [64, 32])
def test_every_library_gives_what_batch_gives(name, sole, bits):
    xp = library(name)
    force = forces(3, 4).astype(f"float{bits}")
    given = xp.asarray(force)
    found = any_array.loads(sole, given, 2.0)
    wanted = batch.loads(sole, force, 2.0)
    mask = any_array.active(sole, given, 2.0)
    assert np.array_equal(np.asarray(mask), (force > 2.0) & (force < sole.force_limit))
    for got, want in zip(found, (wanted.wrench, wanted.contact_area, wanted.center_of_pressure), strict=True):
        assert type(got) is type(given)
        assert str(got.dtype).endswith(f"float{bits}")
        scale = max(1e-300, float(np.nanmax(np.abs(want))))
        np.testing.assert_allclose(np.asarray(got), want, rtol=0.0, atol=scale * (1e-12 if bits == 64 else 1e-5))


def jacobians(name: str, sole: Any, force: np.ndarray) -> np.ndarray:
    """Derivatives (9, n) of wrench, area and CoP by a library's own means."""
    xp = library(name)

    def flat(given: Any) -> Any:
        found = any_array.loads(sole, given, 2.0)
        return xp.concatenate([found.wrench, found.contact_area[None], found.center_of_pressure])

    if name == "torch":
        return np.asarray(xp.autograd.functional.jacobian(flat, xp.asarray(force)))
    import jax

    return np.asarray(jax.jit(jax.jacrev(flat))(xp.asarray(force)))


@pytest.mark.parametrize("name", ["torch", "jax.numpy"])
@pytest.mark.parametrize("sole", [FLAT, CURVED], ids=["flat", "curved"])
def test_derivatives_are_those_of_finite_differences(name, sole):
    force = np.where(np.arange(len(sole)) % 3 == 0, 30.0 + np.arange(len(sole)), 0.5)
    force[4] = np.nan  # a dead taxel must not spoil the others' derivatives
    found = jacobians(name, sole, force)
    step = 1e-4
    wanted = np.zeros_like(found)
    for i in range(len(sole)):
        ends = []
        for sign in (1.0, -1.0):
            moved = force.copy()
            moved[i] += sign * step
            sums = batch.loads(sole, moved, 2.0)
            ends.append([*sums.wrench, sums.contact_area, *sums.center_of_pressure])
        wanted[:, i] = (np.array(ends[0]) - ends[1]) / (2.0 * step)
    np.testing.assert_allclose(found, wanted, atol=1e-8)
    assert np.isfinite(found).all()
    assert np.abs(found[:, force > 2.0]).max() > 0.5


@pytest.mark.parametrize("name", ["torch", "jax.numpy"])
def test_without_load_a_cop_is_none_and_its_derivative_zero(name):
    assert not jacobians(name, FLAT, np.zeros(len(FLAT)))[7:].any()


@pytest.mark.parametrize(
    ("force", "words"),
    [
        ([1.0, 2.0], "of type list"),
        (np.zeros(3), r"shape \(3,\); expected \(\.\.\., "),
        (np.float64(3.0), r"shape \(\)" if hasattr(np.float64, "__array_namespace__") else "of type float64"),
        (np.zeros(len(FLAT), dtype=int), "of type int64; expected real floating point"),
        (np.zeros(len(FLAT), dtype=complex), "complex"),
        (None, "NoneType"),
    ],
)
def test_bad_forces_are_named(force, words):
    for function in (any_array.active, any_array.loads):
        with pytest.raises(ReadingError, match=words):
            function(FLAT, force)
