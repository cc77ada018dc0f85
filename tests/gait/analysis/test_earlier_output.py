"""A folder of output is of the last analysis alone."""

from plantar.common.pages.folder_page import with_folder_page
from plantar.gait.analysis.analyse_one import analyse_recording
from plantar.gait.analysis.compare import compare_recordings
from plantar.gait.analysis.earlier_output import earlier_output

from ...plantar.formats.test_table_kinds import LEFT, RIGHT, TIME, rows


def names_in(folder) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())


def test_each_analysis_leaves_only_its_own_files(tmp_path, quick_figures):
    walk = tmp_path / "walk.csv"
    walk.write_text("t (s),left Fz (N),right Fz (N)\n" + rows([TIME, LEFT, RIGHT], ","))
    out = tmp_path / "out"
    made = analyse_recording(walk, out)["files"]
    with_folder_page(out, "Analysis", made)
    (out / "notes.txt").write_text("of the user")
    assert {"index.html", "report.html", "force.png"} <= set(names_in(out))

    compare_recordings(walk, walk, out, figures=False)
    both = [f"{key}/{name}" for key in "ab" for name in ("metrics.json", "steps.csv")]
    assert names_in(out) == sorted([*both, "comparison.json", "notes.txt"])

    analyse_recording(walk, out, figures=False)
    assert names_in(out) == ["metrics.json", "notes.txt", "steps.csv"]
    assert not (out / "a").exists()


def test_what_no_analysis_left_stays(tmp_path):
    walk = tmp_path / "steps.csv"
    walk.write_text("t (s),left Fz (N),right Fz (N)\n" + rows([TIME, LEFT, RIGHT], ","))
    (tmp_path / "report.html").write_text("of the user")
    assert earlier_output(tmp_path) == []
    analyse_recording(walk, tmp_path / "out", figures=False)
    again = tmp_path / "out" / "force.png"
    again.write_bytes(walk.read_bytes())
    again = again.rename(tmp_path / "out" / "bouts.csv")  # a recording under the name of a result is kept
    analyse_recording(again, tmp_path / "out", figures=False)
    assert again.exists()
