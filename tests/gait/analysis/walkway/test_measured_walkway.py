"""Walkways and stacks of footsteps in StepUP-P150's form, against what they were made of and platforms' analysis."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError, InputError, read
from plantar.formats.format import ReadOptions
from plantar.formats.recorded_layouts import grid_cells
from plantar.formats.step_table import read_step_table
from plantar.formats.walkway import is_walkway, walkway_file
from plantar.formats.walkway_passes import passes_of
from plantar.gait.analysis.analyse_one import analyse_one
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.study.one_recording import GRID
from plantar.gait.analysis.study.run_study import run_study
from plantar.gait.analysis.study.study_options import StudyOptions
from plantar.gait.analysis.walkway.measured_walkway import measure_walkway
from plantar.layouts.cell_grid import CellGrid
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

sys.path.insert(0, str(Path(__file__).resolve().parents[4] / "benchmarks"))
from made_walkway import PITCH, MadeStep, made_walk, metadata_of, trial_of, upright, walker, write_stack

FRAMES = 900


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """One person's two passes: footsteps, a stack, and the walkway with and without the table."""
    random = np.random.default_rng(4)
    steps = made_walk(walker(random), FRAMES, random)
    root = tmp_path_factory.mktemp("walkway")
    write_stack(root / "stack", steps, 7, "BF", "W1")
    for name in ("stated", "found"):
        (root / name).mkdir()
    np.savez(root / "found" / "trial.npz", trial_of(steps, FRAMES))
    (root / "stated" / "trial.npz").symlink_to(root / "found" / "trial.npz")
    turns = [upright(step)[1] for step in steps]
    (root / "stated" / "metadata.csv").write_text(metadata_of(steps, turns, 7, "BF", "W1"))
    return root, steps


def measured(path: Path, **choices):
    return measure_walkway(path, ReadOptions(), AnalysisOptions(steps="all", **choices), GRID)


def in_order(found):
    return sorted((s for gait in found.feet.values() for s in gait.steps), key=lambda s: s.heel_strike_s)


def force_of(step: MadeStep) -> np.ndarray:
    return step.frames.sum(axis=(1, 2)) * 1e3 * PITCH**2


@pytest.mark.parametrize("form", ["stack/pipeline_1.npz", "stated/trial.npz", "found/trial.npz"])
def test_feet_times_and_forces_are_those_that_were_made(made, form):
    root, steps = made
    found = in_order(measured(root / form))
    assert [s.side for s in found] == [s.side for s in steps]
    assert len(steps) >= 8
    turned = 0.05 if form.startswith("stack") else 1e-9  # cells that a turn to the nearest cells doubles or loses
    for own, true in zip(found, steps, strict=True):
        assert own.measures["contact_time_s"] == pytest.approx(0.01 * (len(true.frames) - 1), abs=0.021)
        assert own.measures["peak_force_N"] == pytest.approx(force_of(true).max(), rel=turned)
        assert own.measures["impulse_Ns"] == pytest.approx(np.trapezoid(force_of(true), dx=0.01), rel=turned + 2e-3)


def test_lengths_of_a_stack_are_those_of_its_walk(made):
    root, _ = made
    of_stack, of_walk = (in_order(measured(root / form)) for form in ("stack/pipeline_1.npz", "stated/trial.npz"))
    for key, most in (("foot_length_m", 0.006), ("step_length_m", 0.012), ("step_width_m", 0.012)):
        pairs = [(a[key], b[key]) for a, b in zip(of_stack, of_walk, strict=True)]
        known = np.array([pair for pair in pairs if np.isfinite(pair).all()])
        assert len(known) >= 6
        assert np.abs(known[:, 0] - known[:, 1]).max() < most
    turn = [(a["foot_progression_deg"], b["foot_progression_deg"]) for a, b in zip(of_stack, of_walk, strict=True)]
    assert np.nanmax(np.abs(np.subtract(*np.array(turn).T))) < 4.0


def test_footprints_and_regions_are_those_of_the_analysis_of_platforms(made):
    root, _ = made
    path = root / "found" / "trial.npz"
    (load, *_) = passes_of(walkway_file(path, ReadOptions()))
    low = load.cells.row.min(), load.cells.column.min()
    present = load.cells.numbers() >= 0
    layout = grid_cells(present[::-1, ::-1], PITCH, PITCH, side="left", name="walkway", threshold=10e3)
    order = load.cells.numbers()[::-1, ::-1]
    force = np.pad(load.force[:, order[order >= 0]], ((30, 30), (0, 0)))
    time = 0.01 * np.arange(len(force))
    whole = PressureRecording(
        path, "made", 100.0, time, {"left": FootRecording("left", force, layout)}, kind="platform"
    )
    platform = analyse_one(whole, choices=AnalysisOptions(steps="all"))
    theirs = sorted((s for gait in platform.feet.values() for s in gait.steps), key=lambda s: s.heel_strike_s)
    ours = [s for s in in_order(measured(path)) if s.contact.walk == 0]
    assert [s.side for s in ours] == [s.side for s in theirs]
    assert low[0] >= 0
    for own, other in zip(ours, theirs, strict=True):
        for key in ("foot_length_m", "foot_width_m", "arch_index", "peak_pressure_Pa", "footprint_area_m2"):
            assert own[key] == pytest.approx(other[key], rel=1e-9)
        for region, measures in other.regions.items():
            assert own.regions[region]["peak_pressure_Pa"] == pytest.approx(measures["peak_pressure_Pa"], rel=1e-9)
            assert own.regions[region]["contact_area_m2"] == pytest.approx(measures["contact_area_m2"], rel=1e-9)


def test_cells_of_a_grid_join_as_a_layouts_neighbours_do():
    present = np.random.default_rng(2).random((14, 11)) < 0.22
    layout = grid_cells(np.ones((14, 11), dtype=bool), PITCH, PITCH, side="left", name="mat", threshold=0.0)
    near = layout.neighbours
    left = set(np.flatnonzero(present).tolist())
    groups = []
    while left:
        group = [left.pop()]
        for cell in group:
            found = {other for k in near[cell] for other in (k, *near[k])} & left
            left -= found
            group += sorted(found)
        groups.append(sorted(group))
    row, column = np.nonzero(present)
    own = CellGrid(row, column).groups(np.ones(len(row), dtype=bool))
    number = row * 11 + column
    assert sorted(sorted(number[group].tolist()) for group in own) == sorted(groups)


def test_steps_that_the_table_excludes_are_in_no_mean(made, tmp_path):
    root, steps = made
    text = (root / "stated" / "metadata.csv").read_text().splitlines()
    cells = text[3].split(",")
    cells[14] = cells[17] = "1"
    (tmp_path / "metadata.csv").write_text("\n".join([*text[:3], ",".join(cells), *text[4:]]))
    (tmp_path / "pipeline_1.npz").symlink_to(root / "stack" / "pipeline_1.npz")
    (out,) = [s for s in in_order(measured(tmp_path / "pipeline_1.npz")) if not s.used]
    assert out.unused == "excluded by metadata.csv: incomplete"
    assert out.heel_strike_s == pytest.approx(0.01 * steps[2].begin)


def test_a_study_of_stacks_compares_footwear_and_goes_on_where_it_was_killed(tmp_path):
    random = np.random.default_rng(9)
    root = tmp_path / "py"
    for number in (1, 2, 3, 4):
        who = walker(random)
        for footwear in ("BF", "ST"):
            write_stack(root / f"{number:03}" / footwear / "W1", made_walk(who, 420, random), number, footwear, "W1")
    (tmp_path / "participant_metadata.csv").write_text("ParticipantID,Weight (Kg)\n1,70.5\n2,80\n3,60\n4,90\n")
    out = tmp_path / "out"
    first = run_study(root, out, figures=False)
    assert [(c.a, c.b, c.paired) for c in first.comparisons] == [("BF", "ST", True)]
    assert first.results[0].who.mass_kg == 70.5
    before = (out / "steps.csv").read_bytes()
    with (out / "steps.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert (
        len(rows)
        == len({(r["recording"], r["side"], r["step"]) for r in rows})
        == sum(len(r.rows) for r in first.results)
    )
    assert {r["speed"] for r in rows} == {"W1"}
    kept = sorted((out / "measured").iterdir())
    kept[0].unlink()
    kept[1].write_bytes(kept[1].read_bytes()[:900])  # as a power cut leaves it
    (out / "steps.csv").unlink()
    run_study(root, out, figures=False)
    assert (out / "steps.csv").read_bytes() == before


def test_steps_are_written_as_parquet(made, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    root, steps = made
    study = run_study(root / "stack" / "pipeline_1.npz", tmp_path, figures=False, plan=StudyOptions(parquet=True))
    table = parquet.read_table(tmp_path / "steps.parquet")
    assert table.num_rows == len(steps)
    assert table["side"].to_pylist() == [s.side for s in steps]
    assert table["peak_force_N"].to_pylist() == [row["peak_force_N"] for row in study.results[0].rows]
    assert not (tmp_path / "steps.csv").exists()


def test_what_is_no_measurable_stack_is_refused_with_the_reason(made, tmp_path):
    root, _ = made
    with pytest.raises(FormatError, match=r"plantar analyze, which measures its footsteps one by one"):
        read(root / "found" / "trial.npz")
    stack = np.load(root / "stack" / "pipeline_1.npz")["arr_0"]
    np.savez(tmp_path / "pipeline_1.npz", stack)
    with pytest.raises(FormatError, match=r"without metadata\.csv beside it"):
        measured(tmp_path / "pipeline_1.npz")
    table = (root / "stack" / "metadata.csv").read_text()
    (tmp_path / "metadata.csv").write_text(table)
    np.savez(tmp_path / "pipeline_1.npz", stack / stack.sum(axis=(2, 3)).mean(axis=1)[:, None, None, None])
    with pytest.raises(FormatError, match=r"divided by its mean sum, as in StepUP-P150's pipeline 2"):
        measured(tmp_path / "pipeline_1.npz")
    np.savez(tmp_path / "pipeline_1.npz", stack[:3])
    with pytest.raises(FormatError, match=r"lists footstep \d+, the stack has 3"):
        measured(tmp_path / "pipeline_1.npz")
    with pytest.raises(InputError, match=r"not for walkways"):
        measure_walkway(tmp_path / "pipeline_1.npz", ReadOptions(), AnalysisOptions(threshold=20.0), GRID)
    np.savez(tmp_path / "empty.npz", np.zeros((30, 240, 120), dtype=np.uint8))
    with pytest.raises(FormatError, match=r"no footstep in it"):
        measured(tmp_path / "empty.npz")
    np.savez(tmp_path / "small.npz", np.zeros((30, 20, 12)))
    assert not is_walkway(tmp_path / "small.npz")


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("Side,", "Leg,", "no column side"),
        (",Left,", ",Both,", "allowed: left, right"),
        ("FootstepID", "Number", None),
        (",W1,1,", ",W1,0,", "FootstepID is given twice"),
        (",W1,1,0,", ",W1,1,x,", "passid is 'x'"),
    ],
)
def test_a_table_of_footsteps_is_checked_line_by_line(made, tmp_path, old, new, why):
    text = (made[0] / "stack" / "metadata.csv").read_text()
    (tmp_path / "metadata.csv").write_text(text.replace(old, new, 1))
    if why is None:
        assert [s.number for s in read_step_table(tmp_path / "metadata.csv").steps] == list(range(len(made[1])))
        return
    with pytest.raises(FormatError, match=why):
        read_step_table(tmp_path / "metadata.csv")
