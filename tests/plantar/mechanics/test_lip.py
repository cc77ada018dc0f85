import math
import re
from pathlib import Path

import pytest

import plantar
from plantar.errors import InputError
from plantar.mechanics.lip import GRAVITY, divergent_component, pendulum_frequency


def test_frequency_is_that_of_the_pendulum():
    assert pendulum_frequency(0.8) == pytest.approx(math.sqrt(GRAVITY / 0.8), rel=1e-15)


@pytest.mark.parametrize("height", [0.0, -1.0, math.nan, math.inf])
def test_bad_height_is_named(height):
    with pytest.raises(InputError, match="CoM height"):
        pendulum_frequency(height)


def test_a_pendulum_whose_foot_is_at_the_dcm_settles_there():
    omega, x, v = 3.5, 0.02, 0.3
    xi = float(divergent_component([x], [v], omega)[0])
    start, dt = x, 1e-6
    for _ in range(500_000):  # semi-implicit Euler of x'' = w^2 (x - p) with p = xi
        v += dt * omega**2 * (x - xi)
        x += dt * v
    assert x == pytest.approx(xi + (start - xi) * math.exp(-omega * 0.5), abs=1e-5)
    assert divergent_component(x, v, omega) == pytest.approx(xi, abs=1e-5)


def test_free_fall_stands_in_one_place():
    root = Path(plantar.__file__).resolve().parents[1]  # of what is imported, a checkout or an installation
    files = (root / "plantar").rglob("*.py")
    # 9.80665 in plantar/formats/units.py is the definition of a unit.
    found = {p.relative_to(root).as_posix() for p in files if re.search(r"\b9\.81", p.read_text(encoding="utf-8"))}
    assert found == {"plantar/common/gravity.py"}
