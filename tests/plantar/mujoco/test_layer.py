"""The layer's shares: sums, symmetry, and the spread of a line load on a continuous layer."""

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.layouts.tiling import hex_layout
from plantar.mujoco import ElasticLayer, Skin

LAYER = ElasticLayer(modulus=1e6, thickness=0.02)


def test_no_force_is_lost_and_none_pulls():
    sole = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], cell_area=3e-5)
    shares = LAYER.shares(sole)
    assert np.abs(shares.sum(axis=0) - 1.0).max() < 1e-12
    assert shares.min() >= 0.0
    assert np.allclose(shares.argmax(axis=0), np.arange(len(sole)))
    assert np.allclose(ElasticLayer(5e6, 0.02).shares(sole), shares)  # a linear layer's spread has no modulus


def test_a_line_load_falls_off_as_on_a_continuous_layer():
    """Far from the ends exp(-|x| / L) / 2 L of it, in cells much smaller than L."""
    sole = hex_layout([[-0.04, -0.015], [0.04, -0.015], [0.04, 0.015], [-0.04, 0.015]], cell_area=1.5e-6)
    layer = ElasticLayer(1e6, 0.03)
    x = sole.positions[:, 0]
    line = np.where(np.abs(x) < 0.5 * np.sqrt(1.5e-6), sole.areas, 0.0)
    read = layer.shares(sole) @ (line / line.sum())
    found = np.sqrt(0.5 * (read @ x**2) / read.sum())  # the second moment is 2 L^2
    assert found == pytest.approx(layer.spread, rel=0.03)


def test_its_numbers_are_those_of_the_book():
    nu = 0.4
    assert LAYER.stiffness == pytest.approx(1e6 * 0.6 / (1.4 * 0.2) / 0.02)
    shear = 1e6 / (2 * (1 + nu)) * 0.02 / 3
    assert LAYER.spread == pytest.approx(np.sqrt(shear / LAYER.stiffness))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((0.0, 0.01), "modulus"),
        ((1e6, -1.0), "thickness"),
        ((1e6, 0.01, 0.5), "poisson is 0.5"),
        ((1e6, np.nan), "thick"),
    ],
)
def test_wrong_layers_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        ElasticLayer(*given)
    with pytest.raises(InputError, match="layer"):
        Skin(body="foot", layer=0.01)


@pytest.mark.parametrize("way", [{}, {"outward": (0, 0, -1)}, {"around": (1, 0, 0)}])
def test_a_skin_with_a_layer_keeps_the_load_and_spreads_it(way, make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 100)
    mujoco.mj_forward(model, data)
    bare = Skin(body="foot", cell_area=2e-4, **way).bind(model)(data)
    feel = Skin(body="foot", cell_area=2e-4, layer=ElasticLayer(1e6, 0.05), **way).bind(model)
    soft = feel(data)
    assert np.abs(soft.vectors.sum(axis=0) - bare.vectors.sum(axis=0)).max() < 1e-9
    assert np.array_equal(soft.wrench, bare.wrench)
    assert (soft.force > 1e-9).sum() >= (bare.force > 1e-9).sum()
    assert soft.force.max() < bare.force.max()
    pressed = soft.force > 0.0
    yielding = soft.force / (feel.layer.stiffness * feel.layout.areas)
    assert np.allclose(soft.depth[pressed], yielding[pressed])
    again = feel(data)
    assert np.array_equal(again.vectors, soft.vectors)
    vectors, _ = feel.many([data])
    assert np.array_equal(vectors[0], soft.vectors)
    data.qpos[2] += 1.0
    mujoco.mj_forward(model, data)
    assert not feel(data).vectors.any()
