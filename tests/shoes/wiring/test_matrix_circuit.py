"""Currents of a sheet by nodal analysis, against a circuit by hand, and what is left of ghosts."""

import numpy as np
import pytest

from plantar.shoes.wiring.matrix_circuit import column_voltages, ghost_error, read_conductances

CHANCE = np.random.default_rng(2)


def test_three_taxels_of_a_rectangle_make_a_fourth():
    """By hand: through the three others in a row, each 1 kOhm, flows what one of 3 kOhm would let through."""
    g = 1e-3 * np.array([[1.0, 1.0], [1.0, 0.0]])
    volts, _ = column_voltages(g, 1, sense=1e-3, driver=1e9, idle=0.0)
    # column 1 hangs on row 0 alone, which floats: row 1 - column 0 - row 0 - column 1 - ground
    v0 = np.linalg.solve([[1 + 1 + 1, -1, 0], [-1, 2, -1], [0, -1, 2]], [1.0, 0.0, 0.0])
    np.testing.assert_allclose(volts, [v0[0], v0[2]], rtol=1e-9)
    g[1, 1] = 1e-9  # there, and not pressed
    assert ghost_error(g, "floating")[1] > 0.15
    assert ghost_error(g, "solved")[1] < 1e-6


def test_currents_into_every_line_add_up_to_zero():
    g = CHANCE.uniform(0.0, 1e-3, (5, 7))
    volts, levels = column_voltages(g, 2, sense=1e-3, driver=0.025, idle=0.025)
    np.testing.assert_allclose((g * (levels[:, None] - volts)).sum(axis=0), 1e-3 * volts, rtol=1e-9)
    into = 0.025 * ((np.arange(5) == 2) - levels)
    np.testing.assert_allclose((g * (levels[:, None] - volts)).sum(axis=1), into, rtol=1e-9)


@pytest.mark.parametrize("scale", [1e-5, 1e-4, 1e-3])
def test_solving_all_voltages_leaves_no_ghost_where_others_do(scale):
    g = scale * CHANCE.uniform(0.0, 1.0, (13, 17)) * (CHANCE.uniform(size=(13, 17)) < 0.4)
    np.testing.assert_allclose(read_conductances(g, "solved"), g, atol=1e-9 * scale)
    np.testing.assert_allclose(read_conductances(g, "virtual_ground"), g, rtol=0.02, atol=1e-3 * scale)
    assert np.abs(read_conductances(g, "floating") - g).max() > 0.01 * scale
