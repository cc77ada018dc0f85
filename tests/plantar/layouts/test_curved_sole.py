import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import LayoutError, hex_layout, laid_over, read_layout, write_layout
from plantar.layouts.curved_sole import rotations_to_normals
from plantar.sensing.force import ground_reaction_wrench

RECTANGLE = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]
seeds = st.integers(0, 2**32 - 1)


def rocker(x, y):
    """Part of a ball of 0.3 m that touches the ground in the origin."""
    return 0.3 - np.sqrt(0.09 - x**2 - y**2)


@pytest.fixture(scope="module")
def flat():
    return hex_layout(RECTANGLE, cell_area=100e-6, minimum_fraction=0.0)


def test_taxels_stand_on_the_ball_and_look_at_its_middle(flat):
    layout = laid_over(flat, rocker)
    assert layout.positions[:, :2].tolist() == flat.positions[:, :2].tolist()
    middle = np.array([0.0, 0.0, 0.3])
    assert np.linalg.norm(layout.positions - middle, axis=1) == pytest.approx(0.3)
    assert np.linalg.norm(layout.vertices - middle, axis=1) == pytest.approx(0.3)
    assert layout.rotations[:, :, 2] == pytest.approx((middle - layout.positions) / 0.3, abs=1e-8)


def test_the_area_is_that_of_the_surface(flat):
    x, y = np.meshgrid(np.linspace(-0.1, 0.1, 2001), np.linspace(-0.05, 0.05, 1001))
    density = 0.3 / np.sqrt(0.09 - x**2 - y**2)
    exact = np.trapezoid(np.trapezoid(density, x[0], axis=1), y[:, 0])
    covered = flat.areas.sum() / 0.02
    assert laid_over(flat, rocker).areas.sum() == pytest.approx(exact * covered, rel=1e-3)
    assert exact > 1.02 * 0.02


def test_a_uniform_pressure_presses_on_the_area_seen_from_above(flat):
    """The pressure's force on any surface over a flat outline is upwards p times the area inside the outline."""
    layout = laid_over(flat, rocker)
    wrench = ground_reaction_wrench(layout, 1e4 * layout.areas, 0.0)
    assert wrench[2] == pytest.approx(1e4 * flat.areas.sum(), rel=1e-3)
    # On a ball all forces pass through its middle.
    about_middle = wrench[3:] - np.cross([0, 0, 0.3], wrench[:3])
    assert np.abs(about_middle).max() < 1e-6 * wrench[2]


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.0, 0.05))
def test_an_inclined_plane_tilts_all_taxels_alike(a, b, c):
    flat = hex_layout(RECTANGLE)
    layout = laid_over(flat, lambda x, y: c + a * x + b * y)
    normal = np.cross([1, 0, a], [0, 1, b])
    assert layout.rotations[:, :, 2] == pytest.approx(
        np.tile(normal / np.linalg.norm(normal), (len(flat), 1)), abs=1e-8
    )
    assert layout.areas == pytest.approx(flat.areas * np.sqrt(1 + a * a + b * b))
    assert layout.neighbours == flat.neighbours


def test_a_flat_surface_changes_nothing_but_the_height(flat):
    bay = [[0.006, 0.0], [-0.1, -0.04], [0.1, -0.04], [0.1, 0.04], [-0.1, 0.04]]  # its cells are not all convex
    for one in (flat, hex_layout(bay)):
        assert laid_over(one, lambda x, y: 0.0 * x).areas == pytest.approx(one.areas, rel=1e-9)
    layout = laid_over(flat, lambda x, y: 0.01)
    assert layout.rotations.tolist() == flat.rotations.tolist()
    assert layout.areas == pytest.approx(flat.areas, rel=1e-9)
    assert (layout.positions[:, 2] == 0.01).all()


@given(seeds)
def test_rotations_are_the_shortest_ones_onto_the_normals(seed):
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(20, 3))
    normals[:, 2] = np.abs(normals[:, 2]) + 1e-3
    rotations = rotations_to_normals(normals)
    unit = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    for rotation, n in zip(rotations, unit, strict=True):
        assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
        assert rotation[:, 2] == pytest.approx(n)
        angle = np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1))
        assert angle == pytest.approx(np.arccos(np.clip(n[2], -1, 1)), abs=1e-6)  # no twist on top


def test_a_curved_layout_survives_its_file(flat, tmp_path):
    layout = laid_over(flat, rocker)
    again = read_layout(write_layout(layout, tmp_path / "layout.json"))
    assert again.rotations.tolist() == layout.rotations.tolist()
    assert again.positions.tolist() == layout.positions.tolist()


def test_what_is_no_surface_is_refused(flat):
    for surface, message in (
        (lambda x, y: np.nan, "not finite"),
        (lambda x, y: np.zeros(3), "shape"),
        (lambda x, y: "high", "no height"),
    ):
        with pytest.raises(LayoutError, match=message):
            laid_over(flat, surface)
    with pytest.raises(LayoutError, match="curved already"):
        laid_over(laid_over(flat, rocker), rocker)
    with pytest.raises(LayoutError, match="face the ground"):
        rotations_to_normals(np.array([[0.0, 1.0, 0.0]]))
