"""Parts of an assembly leave each other room."""

import pytest

from plantar.shoes import ShoeParameters, build_shoe
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.papers.step_assembly import assembly_parts

from ..foot_family import box


def test_straps_pass_between_the_foot_and_their_lugs():
    cadquery = pytest.importorskip("cadquery")
    foot = foot_from_triangles("slab", box((-40.0, 60.0), (-25.0, 25.0), (0.0, 22.0)), where="slab", forward="x")
    build = build_shoe(foot, side="left", cell_area=300.0, parameters=ShoeParameters(retention="straps"))
    shoe, *_, strap = assembly_parts(build.shoes[0], build)
    assert strap.name == "strap 1"
    both = [cadquery.Shape.cast(part.shape) for part in (shoe, strap)]
    assert both[0].intersect(both[1]).Volume() < 0.01
