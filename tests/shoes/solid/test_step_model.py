"""Tests of STEP files: arcs, short edges, names, the date, and assemblies, measured on what is read back."""

import math
import re

import numpy as np
import pytest
import shapely

from plantar.shoes.plan.block import Block, Step, box_block, tapered
from plantar.shoes.solid import step_model
from plantar.shoes.solid.arcs import CurvedSolid, with_arcs
from plantar.shoes.solid.kernel import build_solid
from plantar.shoes.solid.polyhedron import Polyhedron
from plantar.shoes.solid.short_edges import without_short_edges
from plantar.shoes.solid.step_model import StepPart, read_step, write_step

from ..step_walls import bent_walls


def of_blocks(*blocks: Block) -> Polyhedron:
    return build_solid([Step("add", "a", blocks)])


def edge_lengths(body: Polyhedron) -> np.ndarray:
    ends = np.array([e for e in body.neighbours if e[0] < e[1]])
    return np.linalg.norm(body.corners[ends[:, 0]] - body.corners[ends[:, 1]], axis=1)


def test_step_reads_back_with_a_name_and_a_date_that_does_not_change(exported, tmp_path, monkeypatch):
    solid = exported[0].build.shoes[0].solid
    assert solid is not None
    part = StepPart("my foot's shoe", solid, {})
    for name in ("a", "b"):
        write_step([part], tmp_path / f"{name}.step", "my foot's shoe")
    text = (tmp_path / "a.step").read_text()
    assert "FILE_NAME('my foot s shoe','2026-01-01T00:00:00'" in text
    assert len(re.findall(r"PRODUCT\('my foot s shoe',\s*'my foot s shoe'", text)) == 1
    assert text == (tmp_path / "b.step").read_text()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1767225661")
    write_step([part], tmp_path / "a.step", "b")
    assert "'2026-01-01T00:01:01'" in (tmp_path / "a.step").read_text()[:1000]


def test_the_shoes_step_is_valid_small_and_round(exported):
    report, folder = exported
    for shoe in report.build.shoes:
        path = folder / f"shoe_{shoe.side}.step"
        step = read_step(path)
        assert (step.solids, step.valid) == (1, True)
        assert step.volume == pytest.approx(shoe.solid.volume, rel=2e-3)  # arcs bulge beyond facets
        assert step.shortest >= 0.2 - 1e-6
        flat, round_ = bent_walls(path)
        assert round_ >= 0.8 * (round_ + flat)
        assert path.stat().st_size < 1.5e6


def test_the_assembly_names_its_parts_in_their_places(exported):
    report, folder = exported
    shoe = report.build.shoes[0]
    text = (folder / "assembly_left.step").read_text()
    assert (folder / "assembly_left.step").stat().st_size < 1.5e6
    named = set(re.findall(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('\d+','([^']*)'", text))
    wanted = {f"taxel {k}" for k in shoe.layout.ids.tolist()} | {"pad", "shoe left"}
    assert wanted <= named
    step = read_step(folder / "assembly_left.step")
    assert step.valid
    assert step.solids == len(named)


def test_a_round_wall_becomes_cylinders_and_its_bevel_cones():
    disc = shapely.Point(0.0, 0.0).buffer(30.0, quad_segs=16)
    bevel = tapered(disc, 0.0, -1.0, 8.0, 9.0)
    assert bevel is not None
    body = of_blocks(Block(disc, 0.0, 8.0), bevel)
    round_ = with_arcs(body)
    assert len(round_.body.faces) - 2 == len(round_.curved) <= 8
    radii = {round(a.radius, 3) for a in round_.arcs.values()}
    assert len(radii) == 2
    assert max(radii) == pytest.approx(30.0, abs=1e-3)
    assert all(math.hypot(*a.centre) < 1e-3 for a in round_.arcs.values())


def test_a_concave_wall_and_a_round_hole_are_valid(tmp_path):
    plate = shapely.box(-40, -40, 40, 40).difference(shapely.Point(45, 0).buffer(25, quad_segs=24))
    plate = plate.difference(shapely.Point(-15, 0).buffer(10, quad_segs=24))
    write_step([StepPart("a", of_blocks(Block(plate, 0.0, 10.0)), {})], tmp_path / "a.step", "a")
    step = read_step(tmp_path / "a.step")
    assert (step.solids, step.valid) == (1, True)
    flat, round_ = bent_walls(tmp_path / "a.step")
    assert flat == 0.0
    assert round_ == pytest.approx(10.0 * (2 * math.pi * 10 + 50 * math.acos(5 / 25)), rel=2e-2)
    assert step.volume == pytest.approx(plate.area * 10.0, rel=5e-3)


def test_polygons_of_few_corners_stay_polygons():
    angle = np.radians(np.arange(0, 360, 45))
    octagon = shapely.Polygon(30.0 * np.column_stack([np.cos(angle), np.sin(angle)]))
    assert not with_arcs(of_blocks(Block(octagon, 0.0, 5.0))).curved


@pytest.mark.parametrize("step", [0.004, 0.05, 0.15])
def test_short_edges_vanish_and_the_solid_stays_closed(step):
    body = of_blocks(box_block((0, 0, 0), (20, 20, 5)), box_block((0, 20 - 4, 0), (20 + step, 20 + step, 9)))
    assert edge_lengths(body).min() >= 0.2
    outline = shapely.Polygon([(0, 0), (20, 0), (20, 10), (20 + step, 10 + step), (20, 20), (0, 20)])
    solid = without_short_edges(of_blocks(Block(outline, 0.0, 5.0)), 0.2)
    assert all((b, a) in solid.neighbours for a, b in solid.neighbours)
    assert solid.volume == pytest.approx(outline.area * 5.0, abs=60.0 * step)


def test_a_bent_wall_that_stays_flat_is_counted_and_a_corner_is_not(tmp_path, monkeypatch):
    disc = of_blocks(Block(shapely.Point(0.0, 0.0).buffer(30.0, quad_segs=16), 0.0, 8.0))
    chamfered = of_blocks(Block(shapely.Polygon([(0, 0), (40, 0), (40, 30), (38, 30.5), (0, 30.5)]), 0.0, 8.0))
    monkeypatch.setattr(step_model, "with_arcs", lambda body: CurvedSolid(body, {}, frozenset()))
    for body, flat in ((disc, 8.0 * 64 * 60.0 * math.sin(math.pi / 64)), (chamfered, 0.0)):
        write_step([StepPart("a", body, {})], tmp_path / "a.step", "a")
        assert bent_walls(tmp_path / "a.step") == (pytest.approx(flat, rel=1e-3), 0.0)


def test_edges_that_are_nearly_in_line_are_valid_however_the_solid_is_turned(tmp_path):
    # A strap's lug: its right side bends by one degree, where 1e-6 mm move the crossing of two lines by 6e-5.
    wall = np.array(
        [(-75.4782, 2.0433, 4.9), (-75.4782, 2.0433, 4.5), (-81.7576, 3.1505, 4.5), (-81.7576, 3.1505, 7.0)]
    )
    front = np.array([*wall, (-75.4387, 2.0363, 7.0)])
    across = np.array([0.173652, 0.984807, 0.0])
    front -= np.outer((front - front[2]) @ across, across)
    loops = [(0, 1, 2, 3, 4), (9, 8, 7, 6, 5)] + [((i + 1) % 5, i, i + 5, (i + 1) % 5 + 5) for i in range(5)]
    for angle in np.radians(np.random.default_rng(5).uniform(0.0, 360.0, 12)):
        c, s = math.cos(angle), math.sin(angle)
        corners = np.vstack([front, front - 3.0 * across]) @ np.array([(c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, 1.0)])
        body = Polyhedron(corners, tuple((loop,) for loop in loops))
        write_step([StepPart("a", body, {})], tmp_path / "a.step", "a")
        assert read_step(tmp_path / "a.step").valid, angle
