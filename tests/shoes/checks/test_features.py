"""The feature reader: finds what a good shoe has, and misses what is cut away from one."""

import pytest
import shapely

from plantar.shoes import ShoeReport, build_shoe
from plantar.shoes.checks.features import printed_features
from plantar.shoes.foot.foot import foot_from_outline
from plantar.shoes.plan.block import Block, Step
from plantar.shoes.plan.wiring import wiring_steps
from plantar.shoes.solid.body import shoe_steps
from plantar.shoes.solid.kernel import _assembled, _polyhedron


def missing(report: ShoeReport, cut: Block | None = None, add: Block | None = None) -> set[str]:
    """Features that the left shoe lacks once a block was cut from it, or added."""
    shoe, build = report.build.shoes[0], report.build
    surface = shoe.surface
    if cut is not None or add is not None:
        assert build.retention is not None
        more = Step("add", "block", (add,)) if add is not None else Step("cut", "block", (cut,))
        steps = (*shoe_steps(build.foot, shoe.plan, build.retention, build.parameters), more)
        surface = _polyhedron(_assembled(steps)).surface  # of several bodies, too
    assert surface is not None
    return {f.name for f in printed_features(shoe, report.build, surface) if not f.holds}


FEATURES = (
    "rails at both ends of the board",
    "shelf below the board",
    "bar above each slot",
    "pocket of each",
    "ceiling over each pocket",
    "way from each pocket to the heel",
)


def test_a_good_shoe_has_all_features(exported):
    assert missing(exported[0]) == set()


@pytest.mark.sample(2)
@pytest.mark.parametrize("feature", FEATURES)
def test_a_feature_is_missed_where_it_is_not_there(exported, feature):
    report, _ = exported
    build = report.build
    plan, p = build.shoes[0].plan, build.parameters
    low_x, low_y, high_x, high_y = plan.contact.bounds
    everywhere = shapely.box(low_x - 60, low_y - 60, high_x + 60, high_y + 60)
    behind = shapely.box(low_x - 60, low_y - 60, plan.heel.x - 0.1, high_y + 60)
    above = Block(everywhere, p.thickness + build.retention.top(p) - 3.5, p.rim_top + 60.0)
    pocket = plan.pockets[-1].buffer(-3.0)
    i, j = plan.route[0]
    port = shapely.Point(plan.port(i, j)[0].mean(axis=0)).buffer(8.0)
    changes = {
        "rails at both ends of the board": {"cut": Block(behind, p.thickness + 1.0, p.rim_top + 5)},
        "shelf below the board": {"cut": Block(behind, 0.0, p.thickness - 0.2)},
        "bar above each slot": {"cut": above},
        "pocket of each": {"add": Block(pocket, p.bottom, p.ceiling + 1.0)},
        "ceiling over each pocket": {"cut": Block(pocket, p.bottom, p.thickness + 1.0)},
        "way from each pocket to the heel": {"add": Block(port, p.bottom, p.ceiling + 1.0)},
    }
    found = missing(report, **changes[feature])
    assert feature in found
    if feature in ("rails at both ends of the board", "bar above each slot", "ceiling over each pocket"):
        assert found == {feature}  # what else there is stays


@pytest.mark.parametrize("radius", [20.0, 40.0, 47.0])
def test_round_heels_have_their_rails(radius):
    """Both posts reach the board's ends behind the plate, whatever the heel's radius."""
    box = shapely.box(-80.0, -47.5, 160.0, 47.5)
    outline = box.buffer(-radius).buffer(radius, quad_segs=32) if radius < 47.0 else (
        shapely.Point(-32.5, 0.0).buffer(47.5, quad_segs=32) | shapely.box(-32.5, -47.5, 160.0, 47.5)
    )  # fmt: skip
    build = build_shoe(foot_from_outline("a", outline), side="left", layout_only=True)
    plan, p = build.shoes[0].plan, build.parameters
    blocks, steps = wiring_steps(plan, p)
    slot = steps[0].blocks[0].low
    for post in blocks[1:]:
        assert isinstance(post, Block)
        behind = post.low.difference(slot) & plan.heel.placed(shapely.box(-30.0, -60.0, 0.0, 60.0))
        assert behind.area > 20.0
        assert (post.low & plan.rim).area > 20.0
