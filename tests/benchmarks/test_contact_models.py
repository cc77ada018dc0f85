"""Contact models on the test rig, and the report of the comparison."""

import csv
import math
from dataclasses import replace

import numpy as np
import pytest
from contact_comparison import PLANE, Rig, compare_contact_models, full_stance, tip_over
from contact_models import holds, write_contact_report
from contact_parameters import study_contact_parameters
from contact_soles import CANDIDATES, Candidate, build_sole

from plantar import InputError, hex_layout
from plantar.layouts.hex_lattice import HexLattice

OUTLINE = [[-0.125, -0.0775], [0.125, -0.0775], [0.125, 0.0775], [-0.125, 0.0775]]
LAYOUT = hex_layout(OUTLINE)
CHOSEN = CANDIDATES[0]


def by_name(name: str) -> Candidate:
    return next(c for c in CANDIDATES if c.name == name)


@pytest.fixture(scope="module")
def rows():
    few = (CHOSEN, by_name("box + tactile, fz"), by_name("1 sphere a taxel"))
    return {
        r.name: r for r in compare_contact_models(LAYOUT, candidates=few, seeds=1, progress=lambda share, text: None)
    }


def test_chosen_model_keeps_what_is_required(rows):
    row = rows[CHOSEN.name]
    assert row.cop_max_mm < 2.0
    assert abs(row.edge_x_mm) < 1.0
    assert abs(row.edge_y_mm) < 1.0
    assert row.force_max_N < 1e-6
    assert row.beam_contact_ratio == pytest.approx(1.0, abs=0.02)
    assert row.beam_wrong_cells == 0
    assert row.beam_silent_cells == 0
    assert holds(row)


def test_known_faults_of_others_are_found(rows):
    """The comparison can tell: a penetration field misplaces the load, one sphere a taxel topples early."""
    assert rows["box + tactile, fz"].cop_max_mm > 10.0
    sphere = rows["1 sphere a taxel"]
    outermost = (LAYOUT.positions[:, 0].max() - 0.125) * 1e3
    assert sphere.edge_x_mm == pytest.approx(outermost, abs=0.5)
    assert sphere.beam_silent_cells > 0
    assert sphere.step_us > 2.0 * rows[CHOSEN.name].step_us
    assert not holds(sphere)


@pytest.mark.parametrize(
    "layout",
    [hex_layout(OUTLINE, cell_area=300e-6, clip=False), hex_layout(OUTLINE, cell_area=900e-6, angle=0.4)],
    ids=["small whole cells", "large turned cells"],
)
def test_chosen_model_on_other_layouts(layout):
    sole = build_sole(CHOSEN, layout, PLANE)
    assert full_stance(sole, layout, seeds=1)["cop_max_mm"] < 2.0
    edges = tip_over(sole, layout)
    assert abs(edges["edge_x_mm"]) < 1.0
    assert abs(edges["edge_y_mm"]) < 1.0


@pytest.mark.parametrize("candidate", CANDIDATES, ids=lambda c: c.name)
def test_rig_pushes_as_wanted(candidate):
    """Every candidate, at rest, shows the pushed wrench in MuJoCo's contacts and the normal force in its taxels."""
    sole = build_sole(candidate, LAYOUT, PLANE)
    rig = Rig(sole, LAYOUT)
    for _ in range(20):
        rig.push(500.0, np.array([0.03, -0.02]), (40.0, -25.0), 2.0)
        rig.step(15)
    assert rig.wrench()[:2] == pytest.approx([-40.0, 25.0], abs=1.0)
    assert rig.wrench()[2:] == pytest.approx([500.0, -0.02 * 500.0, -0.03 * 500.0, -2.0], abs=0.3)
    assert sole.read(rig.data).sum() == pytest.approx(500.0, abs=0.3)
    assert sole.read(rig.data).min() >= 0.0


def test_toppling_sole_is_reported_not_hidden():
    """A layout of cells in the middle only cannot carry the outer loads."""
    cells = np.array([[q, r] for q in (-1, 0, 1) for r in (-1, 0, 1)])
    layout = hex_layout(OUTLINE, cells=cells)
    candidate = by_name("1 sphere a taxel")
    row = full_stance(build_sole(candidate, layout, PLANE), layout, seeds=1)
    assert row["cop_max_mm"] == math.inf
    assert HexLattice(691e-6).centres(cells).max() < 0.05


def test_unknown_candidate_is_refused():
    with pytest.raises(InputError, match="unknown kind"):
        build_sole(replace(CHOSEN, kind="cones"), LAYOUT, PLANE)


def test_report_reads_back(rows, tmp_path):
    parameters = study_contact_parameters(LAYOUT, lambda share, text: None)
    toppled = replace(rows[CHOSEN.name], name="toppled", cop_max_mm=math.inf)
    names = write_contact_report(tmp_path, LAYOUT, [*rows.values(), toppled], parameters)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(names)
    with (tmp_path / "contact.csv").open(encoding="utf-8") as file:
        table = {row["name"]: row for row in csv.DictReader(file)}
    assert float(table[CHOSEN.name]["cop_max_mm"]) == pytest.approx(rows[CHOSEN.name].cop_max_mm, rel=1e-4, abs=1e-9)
    assert table["toppled"]["cop_max_mm"] == ""
    page = (tmp_path / "contact_models.md").read_text(encoding="utf-8")
    assert "Chosen: **box + patches**" in page
    assert "DOES NOT HOLD" not in page
    by = {p.name: p for p in parameters}
    assert by["recommended"].slip_mm_s < 0.1 * by["MuJoCo's defaults"].slip_mm_s
    assert by["recommended"].penetration_mm < by["solref 0.02"].penetration_mm
