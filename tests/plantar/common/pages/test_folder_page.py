"""The page of an output folder leads to everything in it."""

import re
from pathlib import Path
from urllib.parse import unquote

from plantar.common.pages.folder_page import with_folder_page


def linked(page: Path) -> list[str]:
    """Targets of a page's links to files."""
    found = re.findall(r'href="([^"]+)"', page.read_text(encoding="utf-8"))
    return [unquote(target) for target in found if not target.startswith(("#", "data:"))]


def made(folder: Path, *names: str) -> list[str]:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    return [str(folder / name) for name in names]


def test_it_leads_to_each_file_pages_first_and_a_vector_picture_beside_its_twin(tmp_path):
    names = ("walk/run.mcap", "a b/force.png", "a b/force.svg", "report.html", "steps.csv", "shoe_left.stl", "lone.svg")
    files = with_folder_page(tmp_path, "A <walk>", made(tmp_path, *names))
    assert files == [str(tmp_path / "index.html"), *(str(tmp_path / name) for name in names)]
    targets = linked(tmp_path / "index.html")
    assert sorted(targets) == sorted(names)
    assert targets[0] == "report.html"
    assert targets.index("a b/force.svg") == targets.index("a b/force.png") + 1
    text = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "A &lt;walk&gt;" in text
    assert "a row a step" in text


def test_it_is_written_over_and_names_itself_once(tmp_path):
    files = with_folder_page(tmp_path, "walk", made(tmp_path, "report.html"))
    assert with_folder_page(tmp_path, "walk", files) == files
    assert linked(tmp_path / "index.html") == ["report.html"]


def test_tables_alone_need_no_page(tmp_path):
    files = made(tmp_path, "metrics.json", "steps.csv")
    assert with_folder_page(tmp_path, "walk", files) == files
    assert not (tmp_path / "index.html").exists()
