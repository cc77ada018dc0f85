"""The layer against what is known of it in closed form: Love, Hertz, a flat punch, a thin layer."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import dblquad

from plantar.sim.sensing.elastic_layer import LayerContact, influence


def squares(half: float, side: float) -> NDArray[np.float64]:
    """Middles (n, 2) of the squares of a grid about the origin."""
    axis = np.arange(-half + 0.5 * side, half, side)
    return np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("place", [(1.7, 0.4), (2.9, -0.3), (0.0, 2.0)])
def test_square_on_the_half_space_is_the_integral_of_boussinesqs_point_forces(place):
    x, y = place
    expected, _ = dblquad(lambda v, u: 1.0 / (math.pi * math.hypot(x - u, y - v)), -0.5, 0.5, -0.5, 0.5)
    found = influence([(0.0, 0.0), place], [1.0], math.inf)[1, 0]
    assert found == pytest.approx(expected, rel=1e-6)


def test_a_far_square_is_a_point():
    """The near form and the far one agree where one takes over from the other."""
    near, far = influence([(0.0, 0.0), (2.999, 0.0), (3.001, 0.0)], [1.0], math.inf)[1:, 0]
    assert near == pytest.approx(far, rel=0.01)


def test_flat_round_punch_has_its_pressure_at_the_edge():
    """p = F / (2 pi a sqrt(a^2 - r^2)), approach F / (2 a E*) (Johnson 3.34, 3.36)."""
    radius, side, force = 0.05, 0.0025, 100.0
    points = squares(radius, side)
    points = points[np.hypot(*points.T) < radius]
    contact = LayerContact(influence(points, np.full(len(points), side), math.inf), points).press(
        np.array([force, 0.0, 0.0])
    )
    distance = np.hypot(*points.T)
    inner = distance < 0.8 * radius
    expected = force / (2.0 * math.pi * radius * np.sqrt(radius**2 - distance[inner] ** 2))
    assert contact.settled
    assert contact.on.all()
    assert contact.forces[inner] / side**2 == pytest.approx(expected, rel=0.02)
    assert contact.field[0] == pytest.approx(force / (2.0 * radius), rel=0.005)
    assert contact.forces[distance > 0.95 * radius].max() > 2.0 * contact.forces[inner].min()


def test_a_sphere_meets_the_half_space_as_by_hertz():
    radius, modulus, force, side = 0.5, 1e6, 50.0, 0.002
    points = squares(0.034, side)
    compliance = influence(points, np.full(len(points), side), math.inf)
    distance = np.hypot(*points.T)
    contact = LayerContact(compliance, points).press(
        np.array([force, 0.0, 0.0]), gap=modulus * distance**2 / (2.0 * radius)
    )
    reach = (3.0 * force * radius / (4.0 * modulus)) ** (1.0 / 3.0)
    peak = 3.0 * force / (2.0 * math.pi * reach**2)
    expected = peak * np.sqrt(np.maximum(0.0, 1.0 - (distance / reach) ** 2))
    inner = distance < 0.9 * reach
    assert contact.settled
    assert distance[contact.on].max() == pytest.approx(reach, abs=side)
    assert contact.forces[inner] / side**2 == pytest.approx(expected[inner], abs=0.01 * peak)
    assert contact.field[0] / modulus == pytest.approx(reach**2 / radius, rel=0.005)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.4])
def test_a_thin_layer_gives_way_by_its_oedometric_modulus(poisson):
    """Far from an edge u = p d / M with M = E (1 - nu) / ((1 + nu) (1 - 2 nu)), and E = 1 - nu^2 here."""
    thickness, side = 0.002, 0.004
    points = squares(0.06, side)
    compliance = influence(points, np.full(len(points), side), thickness, poisson)
    middle = int(np.argmin(np.hypot(*points.T)))
    modulus = (1.0 - poisson**2) * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    assert (compliance @ np.full(len(points), side**2))[middle] == pytest.approx(thickness / modulus, rel=0.01)


def test_a_thick_layer_is_the_half_space():
    """What a layer holds back falls with its thickness: 3 mm under 10 mm of it are left of a half-space's 20 times."""
    points = squares(0.01, 0.0025)
    sides = np.full(len(points), 0.0025)
    half_space, thick = influence(points, sides, math.inf), influence(points, sides, 1.0)
    assert thick == pytest.approx(half_space, rel=0.05)
    assert (influence(points, sides, 0.003) < half_space).all()


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.035, 0.0), (0.044, 0.04), (0.0475, 0.0474)])
def test_contact_is_complementary_and_has_the_load(place):
    """No square pulls, none is penetrated, wherever the load is, also in a corner; the same from any start."""
    points = squares(0.05, 0.005)
    body = LayerContact(influence(points, np.full(len(points), 0.005), 0.01), points)
    load = 300.0 * np.array([1.0, *place])
    contact = body.press(load)
    gap = body.compliance @ contact.forces - contact.field @ np.column_stack([np.ones(len(points)), points]).T
    scale = 300.0 * body.compliance.max()
    assert contact.settled
    assert contact.forces.min() >= 0.0
    assert contact.forces.sum() == pytest.approx(300.0)
    assert points.T @ contact.forces == pytest.approx(load[1:], abs=1e-4)
    assert gap[contact.on] == pytest.approx(0.0, abs=1e-5 * scale)
    assert gap[~contact.on].min(initial=0.0) > -1e-5 * scale
    again = body.press(load, start=points[:, 0] > 0.02)
    assert again.forces == pytest.approx(contact.forces, abs=0.01)
