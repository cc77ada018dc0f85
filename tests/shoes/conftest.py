"""Feet that the shoe tests generate, and one shoe built and exported for all of them."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.shoes import build_shoe, export_shoe, foot_from_dimensions

from .foot_family import box as box_of
from .foot_family import loft, oval
from .foot_family import prism as prism_of

Triangles = NDArray[np.float64]

_SMALL_CELL = 498.0  # mm^2: those of 691 mm^2 would reach 5.5 mm beyond this foot


def _rounded() -> Triangles:
    up = np.radians([0.0, 30.0, 60.0, 90.0])
    radius = 12.0
    inset, height = radius * (1.0 - np.sin(up)), radius * (1.0 - np.cos(up))
    outlines = [oval(230.0 - 2 * d, 100.0 - 2 * d, 25.0, 96, 3.0) for d in inset]
    return loft([*outlines, outlines[-1]], [*height, 60.0])


def _waist() -> Triangles:
    outline = oval(240.0, 105.0, 20.0, 96, 2.6)
    squeeze = 1.0 - 0.42 * np.exp(-(((outline[:, 0] - 20.0) / 32.0) ** 2))
    return prism_of(outline * np.column_stack([np.ones(96), squeeze]), 0.0, 45.0)


def _arched() -> Triangles:
    blocks = [box_of((x, x + 10.0), (-45.0, 45.0), (_arch(x + 5.0), 60.0)) for x in range(-90, 150, 10)]
    return np.concatenate(blocks)


def _arch(x: float) -> float:
    return 9.0 * max(0.0, 1.0 - ((x - 25.0) / 65.0) ** 2)


def _generated() -> dict[str, Triangles]:
    toe_out = np.array([[-80, -38], [60, -52], [135, -8], [142, 30], [120, 58], [40, 62], [-75, 34]], dtype=float)
    return {
        "flat_box": box_of((-70.0, 130.0), (-45.0, 45.0), (0.0, 55.0)),
        "rounded": _rounded(),
        "arched": _arched(),
        "two_patch": np.concatenate(
            [
                box_of((-90.0, -20.0), (-40.0, 40.0), (0.0, 20.0)),
                box_of((30.0, 140.0), (-48.0, 48.0), (0.0, 20.0)),
                box_of((-90.0, 140.0), (-40.0, 40.0), (15.0, 40.0)),
            ]
        ),
        "far_patches": np.concatenate(
            [
                box_of((-130.0, -50.0), (-45.0, 45.0), (0.0, 20.0)),
                box_of((40.0, 140.0), (-50.0, 50.0), (0.0, 20.0)),
                box_of((-130.0, 140.0), (-40.0, 40.0), (12.0, 50.0)),
            ]
        ),
        "toe_out": prism_of(toe_out, 0.0, 70.0),
        "short": box_of((-28.0, 52.0), (-26.0, 26.0), (0.0, 25.0)),
        "long": loft([oval(350.0, 150.0, 45.0, 96, 4.0)] * 2, [0.0, 90.0]),
        "waist": _waist(),
        "flared": loft([oval(200.0, 85.0, 20.0, 96, 5.0), oval(212.0, 97.0, 20.0, 96, 5.0)], [0.0, 30.0]),
        "plate": np.concatenate(
            [box_of((-85.0, 135.0), (-60.0, 60.0), (0.0, 18.0)), box_of((-40.0, 40.0), (-30.0, 30.0), (18.0, 120.0))]
        ),
    }


@pytest.fixture(scope="session")
def generated_feet():
    """Surfaces (n, 3, 3) in mm of feet of many shapes, by name."""
    return _generated()


@pytest.fixture(scope="session")
def prism():
    """Makes the closed surface of a prism from its outline (k, 2) and two heights."""
    return prism_of


@pytest.fixture(scope="session")
def box():
    """Makes the closed surface of a box from its extents along x, y and z."""
    return box_of


@pytest.fixture
def stl(tmp_path):
    """Writes triangles to an STL file and gives its path."""
    from plantar.shoes.papers.mesh_files import write_stl

    def write(triangles: Triangles, name: str = "foot.stl") -> Path:
        with np.errstate(invalid="ignore"):  # a test may write what is not finite
            return write_stl(triangles, tmp_path / name)

    return write


@pytest.fixture(scope="session")
def small_foot():
    """A foot of 120 x 70 mm, its middle 15 mm before and 5 mm left of the ankle."""
    return foot_from_dimensions("small", length=0.12, width=0.07, sole_center=(0.015, 0.005), corner_radius=0.01)


@pytest.fixture(scope="session")
def exported(small_foot, tmp_path_factory):
    """Both shoes of the small foot, built and exported once; and the folder they are in."""
    folder = tmp_path_factory.mktemp("shoe")
    return export_shoe(build_shoe(small_foot, cell_area=_SMALL_CELL), folder), folder
