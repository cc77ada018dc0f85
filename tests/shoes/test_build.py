"""Tests of the one call from foot to shoes, on feet of many shapes."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from plantar import Percept, Reading, read_layout
from plantar.errors import FootError, InputError
from plantar.gait.analysis.analyse import analyse, with_layout
from plantar.layouts.hex_lattice import HexLattice
from plantar.shoes import ShoeBuild, ShoeParameters, build_shoe, export_shoe, foot_from_dimensions, foot_from_mesh
from plantar.shoes.build import build_insole
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.checks.check import ShoeCheck, check_plan, check_shoe
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.foot.mesh_file import read_mesh
from plantar.shoes.geometry.outline import grown
from plantar.shoes.papers.mesh_files import write_stl
from plantar.shoes.parameters import read_parameters
from plantar.shoes.solid.step_model import StepPart, read_step, write_step

from .foot_family import oval, prism
from .shoe_witness import Witness

NAMES = (
    "flat_box",
    "rounded",
    "arched",
    "two_patch",
    "far_patches",
    "toe_out",
    "short",
    "long",
    "waist",
    "flared",
    "plate",
)


def checked(build: ShoeBuild, folder: Path) -> ShoeCheck:
    """What is measured on the first shoe's STL and STEP."""
    shoe = build.shoes[0]
    assert shoe.surface is not None
    write_stl(shoe.surface, folder / "shoe.stl")
    assert shoe.solid is not None
    write_step([StepPart("a", shoe.solid, {})], folder / "shoe.step", "a")
    return check_shoe(shoe, build, surface=read_mesh(folder / "shoe.stl")[0], step=read_step(folder / "shoe.step"))


def test_sides_are_what_was_asked_and_mirror_each_other(small_foot):
    both = build_shoe(small_foot, layout_only=True)
    assert [s.side for s in both.shoes] == ["left", "right"]
    for side in ("left", "right"):
        one = build_shoe(small_foot, side=side, layout_only=True)
        assert [s.side for s in one.shoes] == [side]
    left, right = (s.layout for s in both.shoes)
    np.testing.assert_array_equal(left.positions * [1, -1, 1], right.positions)


def test_arguments_out_of_range_are_refused(small_foot):
    with pytest.raises(InputError, match="side is 'middle'; allowed: left, right, both"):
        build_shoe(small_foot, side="middle")
    with pytest.raises(InputError, match="overhang of the taxels is 11 mm; allowed: 0 to 10 mm"):
        build_shoe(small_foot, overhang=11.0)
    with pytest.raises(InputError, match="cell area is"):
        build_shoe(small_foot, cell_area=691e-6)
    with pytest.raises(FootError, match="do not fit"):
        build_shoe(small_foot, taxels=60)


def test_progress_rises_to_one(small_foot):
    seen: list[tuple[float, str]] = []
    build_shoe(small_foot, layout_only=True, progress=lambda fraction, text: seen.append((fraction, text)))
    fractions = [f for f, _ in seen]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert all(text for _, text in seen)


def test_a_shoe_is_built_from_a_file_as_from_its_foot(stl, box):
    path = stl(box((-60, 140), (-45, 45), (0, 40)), "left_foot.stl")
    build = build_shoe(path, layout_only=True)
    assert build.foot.name == "left_foot"
    np.testing.assert_array_equal(
        build.shoes[0].layout.positions,
        build_shoe(foot_from_mesh(str(path)), layout_only=True).shoes[0].layout.positions,
    )
    assert len(build_insole(str(path), 6.0, layout_only=True).shoes[0].layout) > 10
    with pytest.raises(InputError, match="foot is a int; allowed: a Foot, or the path"):
        build_shoe(3)
    with pytest.raises(FootError, match=r"none\.stl"):
        build_shoe("none.stl")


def test_a_shoes_solid_is_a_workplane_of_cadquery(exported):
    shoe = exported[0].build.shoes[0]
    solid = shoe.workplane.val()
    assert solid.isValid()
    assert solid.Volume() == pytest.approx(shoe.solid.volume, rel=2e-3)
    half = shoe.workplane.cut(type(shoe.workplane)("XY").box(1e3, 1e3, 1e3).translate((500.0, 0.0, 0.0)))
    assert 0.2 * solid.Volume() < half.val().Volume() < 0.8 * solid.Volume()
    with pytest.raises(InputError, match="no solid; build it without layout_only"):
        replace(shoe, solid=None).workplane  # noqa: B018


def test_a_layout_needs_no_cad_kernel():
    code = (
        "import sys; from plantar.shoes import build_shoe, foot_from_dimensions;"
        "foot = foot_from_dimensions('a', length=.2, width=.1, sole_center=(0, 0), corner_radius=.01);"
        "build_shoe(foot, layout_only=True);"
        "print([m for m in ('cadquery', 'OCP', 'trimesh', 'mujoco', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", NAMES)
def test_no_random_lattice_has_more_cells_on_feet_of_every_shape(generated_feet, name):
    foot = foot_from_triangles(name, generated_feet[name], where=name)
    fit = build_shoe(foot, cell_area=300.0 if name == "short" else 691.0, layout_only=True).fit
    region = grown(fit.sole, fit.overhang)
    chance = np.random.default_rng(3)
    for _ in range(30):
        turn = chance.uniform(0.0, np.pi / 3.0)
        lattice = HexLattice(fit.cell_area, tuple(chance.uniform(0.0, 40.0, 2)), turn)
        near = lattice.cells_near(region.bounds[:2], region.bounds[2:])
        assert shapely.covers(region, shapely.polygons(lattice.corners(near))).sum() <= fit.whole


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
def test_feet_of_every_shape_pass_their_checks(generated_feet, tmp_path, name):
    foot = foot_from_triangles(name, generated_feet[name], where=name)
    build = build_shoe(foot, side="right", cell_area=300.0 if name == "short" else 691.0)
    check = checked(build, tmp_path)
    assert check.holds, [c for c in check.checks if not c.holds]
    assert build.retention.kind == ("clips" if name in ("plate", "short", "flared", "far_patches") else "straps")


@pytest.mark.long
@pytest.mark.parametrize("change", [{"retention": "screws"}, {"board_length": 0.0, "scribe": 0.0}, {"material": "PLA"}])
def test_other_kinds_of_shoe_pass_their_checks(generated_feet, tmp_path, change):
    foot = foot_from_triangles("toe_out", generated_feet["toe_out"], where="toe_out")
    check = checked(build_shoe(foot, side="left", parameters=ShoeParameters(**change)), tmp_path)
    assert check.holds, [c for c in check.checks if not c.holds]


@pytest.mark.long
@pytest.mark.parametrize("name", ["jvrc1", "talos", "robotis_op3"])
def test_real_feet_give_shoes_that_hold(real_data, tmp_path, name):
    truth = json.loads((real_data / "feet" / f"{name}.json").read_text())
    foot = foot_from_mesh(real_data / "feet" / f"{name}.stl")
    report = export_shoe(build_shoe(foot, side="left"), tmp_path)
    assert report.holds, report.checks
    fit = report.build.fit
    face = report.build.shoes[0].plan.contact.area
    assert fit.whole <= face / 691.0
    assert fit.whole >= 0.7 * truth["taxels_691mm2_upper_bound_hull"]
    size = np.ptp(report.build.shoes[0].layout.outline, axis=0) * 1000
    assert truth["lowest_5mm"]["length_mm"] < size[0] < truth["silhouette_mm"][0] + 8
    assert truth["lowest_5mm"]["width_mm"] < size[1] < truth["silhouette_mm"][1] + 8
    layout = read_layout(tmp_path / "layout_left.json")
    outline = layout.outline * 1000  # taxels lie wherever the shoe meets the ground
    corners = layout.vertices * 1000
    assert (corners.min(axis=0)[:2] > outline.min(axis=0) + 1.0).all()
    assert (corners.max(axis=0)[:2] < outline.max(axis=0) - 1.0).all()


def test_fifty_one_taxels_on_the_foot_of_the_other_paper():
    """HRP-2Kai: 51 taxels on 241 x 138 mm. No 51 whole cells fit within 10 mm of it: ten are trimmed a little."""
    foot = foot_from_dimensions("b", length=0.241, width=0.138, sole_center=(0.015, 0.0), corner_radius=0.0196)
    build = build_shoe(foot, taxels=51, layout_only=True)
    layout = build.shoes[0].layout
    assert len(layout) == 51
    assert build.fit.whole < 51
    assert build.shoes[0].plan.overhang < 10.0
    assert build.fit.shares.min() > 0.95
    assert 0.0352 * 0.99 < layout.areas.sum() <= 51 * 691e-6
    assert any("cells at the rim are cut" in note for note in build.notes)


PERSON = foot_from_dimensions("person", length=0.255, width=0.095, corner_radius=0.035)


@pytest.mark.parametrize("thickness", [4.0, 5.5, 8.0, 15.0])
def test_an_insole_is_as_thick_as_asked_for_and_covers_the_sole(thickness):
    build = build_insole(PERSON, thickness, layout_only=True)
    p = build.parameters
    plan = build.shoes[0].plan
    assert p.thickness == pytest.approx(thickness)
    assert p.floor >= p.wall_min
    assert (p.material, p.retention, build.kind) == ("TPU", "none", "insole")
    assert PERSON.sole.buffer(-0.4).covers(plan.contact)
    assert sum(c.area for c in plan.cells) > 0.84 * PERSON.sole.area
    assert plan.blind_rim <= 12.0
    assert build.load_share.flat >= 0.95
    assert build.load_share.half >= 0.80
    assert build.shoes[1].layout.positions[:, 1] == pytest.approx(-build.shoes[0].layout.positions[:, 1])


def test_what_cannot_be_an_insole_is_refused():
    for thickness, change, reason in (
        (3.0, {}, "insole is 3 mm thick; allowed: 4 to 15 mm"),
        (float("nan"), {}, "insole is nan mm thick"),
        (6.0, {"material": "PLA"}, "an insole of PLA would not bend"),
        (5.0, {"pad_thickness": 3.0}, "has a floor of"),
    ):
        with pytest.raises(InputError, match=reason):
            build_insole(PERSON, thickness, parameters=ShoeParameters(**change), layout_only=True)


@pytest.mark.parametrize(
    ("cell", "way"),
    [
        ("velostat", r"7\d % of .*: use a smaller pitch, or the skin's"),
        ("fsr_402", r"12 % of .*: use smaller ones, or a sheet"),
    ],
)
def test_cells_that_miss_too_much_of_the_pressure_are_refused_with_a_way_out(cell, way):
    foot = foot_from_dimensions("person", length=0.24, width=0.09, corner_radius=0.035)
    with pytest.raises(FootError, match=rf"cells {cell} cover {way}"):
        build_insole(foot, 6.0, cell=read_cell(cell), layout_only=True)
    assert len(build_insole(foot, 6.0, layout_only=True).shoes[0].layout) > 30  # the skin's, which the message names


@pytest.mark.parametrize(("length", "width"), [(0.24, 0.09), (0.29, 0.105)])
def test_whole_cells_that_miss_too_much_of_the_pressure_are_refused(length, width):
    foot = foot_from_dimensions("person", length=length, width=width, corner_radius=0.035)
    with pytest.raises(FootError, match=r"whole cells of 691 mm\^2 cover 7\d % of the foot's outline; .*--rim fine"):
        build_insole(foot, 6.0, rim="whole", layout_only=True)
    build = build_insole(foot, 6.0, rim="whole", cell_area=150.0, layout_only=True)
    cells = shapely.union_all(build.shoes[0].plan.cells)
    assert cells.intersection(foot.sole).area > 0.8 * foot.sole.area


def walk(weights: dict[str, np.ndarray], steps: int = 8) -> dict[str, np.ndarray]:
    """Forces (time, cells) in N of each foot of a walk of 70 kg: 0.7 s of 1.1 s on the ground, heel to toe."""
    time = np.arange(0.0, 1.1 * steps, 0.01)
    out = {"time": time}
    for side, start in (("left", 0.2), ("right", 0.75)):
        x = weights[side]
        phase = ((time - start) % 1.1) / 0.7
        on = (phase < 1.0) & (time > start)
        total = np.where(on, 687.0 * np.minimum(1.0, 6.0 * np.minimum(phase, 1.0 - phase)), 0.0)
        cop = x.min() + np.clip(phase, 0.0, 1.0) * np.ptp(x)
        share = np.exp(-(((x[None] - cop[:, None]) / 0.05) ** 2))
        out[side] = np.maximum(total, 0.0)[:, None] * share / share.sum(axis=1, keepdims=True)
    return out


def test_a_walk_on_insoles_is_read_and_measured(tmp_path):
    export_shoe(build_insole(PERSON, 6.0, layout_only=True), tmp_path)
    layouts = {side: read_layout(tmp_path / f"layout_{side}.json") for side in ("left", "right")}
    made = walk({side: layout.positions[:, 0] for side, layout in layouts.items()})
    np.savez(tmp_path / "walk.npz", unit="N", **made)
    analysis = analyse(tmp_path / "walk.npz", options=with_layout(None, tmp_path / "layout_left.json"))
    for side, layout in layouts.items():
        got = analysis.recording.feet[side]
        assert len(got.layout) == len(layout)
        k = 40 if side == "left" else 95  # in the middle of a step
        percept = Percept(layout, Reading(time=0.0, force=made[side][k]))
        x = layout.positions[:, 0]
        force = made[side][k]
        assert percept.position_cop_in_sole[0] == pytest.approx(float(force @ x / force.sum()), abs=2e-3)
        assert percept.vertical_force == pytest.approx(float(force.sum()), rel=0.02)
        steps = analysis.feet[side].steps
        assert len(steps) in (7, 8)


@pytest.mark.long
@pytest.mark.parametrize("thickness", [4.0, 6.0])
def test_an_insole_holds_and_a_witness_agrees(small_foot, tmp_path, thickness):
    build = build_insole(replace(small_foot, mass=40.0), thickness, side="left", cell_area=300.0)
    report = export_shoe(build, tmp_path)
    assert report.holds, [c for c in report.checks["left"].checks if not c.holds]
    foot = prism(np.array(small_foot.sole.exterior.coords)[:-1], 0.0, 40.0)
    assert Witness(tmp_path, foot).problems() == []
    told = json.loads((tmp_path / "check.json").read_text())
    assert told["kind"] == "insole"
    assert read_parameters(tmp_path / "check.json") == build.parameters
    again = build_insole(small_foot, thickness, parameters=build.parameters, cell_area=300.0, layout_only=True)
    assert again.parameters == build.parameters


@pytest.mark.parametrize(("rise", "holds"), [(3.0, True), (34.0, False)])
def test_a_foot_that_stands_on_a_part_of_its_length_is_reported(rise, holds):
    outline = oval(236.0, 86.0, 55.0)
    lift = rise / (1.0 + np.exp((outline[:, 0] - 30.0) / 12.0))
    low, high = (np.column_stack([outline, z]) for z in (lift, np.full(len(outline), 80.0)))
    ends = [((55.0, 0.0, 0.11 * rise), low[::-1]), ((55.0, 0.0, 80.0), high)]
    parts = [np.stack([np.broadcast_to(m, r.shape), r, np.roll(r, -1, axis=0)], axis=1) for m, r in ends]
    after = np.roll(low, -1, axis=0)
    up = np.roll(high, -1, axis=0)
    foot = np.concatenate([*parts, np.stack([low, after, up], axis=1), np.stack([low, up, high], axis=1)])
    build = build_shoe(foot_from_triangles("last", foot, where="last", forward="x"), side="left", layout_only=True)
    (check,) = (c for c in check_plan(build.shoes[0].plan, build) if "length of the sole" in c.name)
    assert check.holds == holds
