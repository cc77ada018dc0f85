"""The notebooks: their code runs from the first cell to the last, in an empty folder, and they hold no output.

Their cells are Python that is run here as it is. Jupyter's own runner would take 40 packages for the same.
"""

import json
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).resolve().parent.parent / "examples" / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize(
    "path", [pytest.param(p, id=p.stem, marks=[] if p.stem == "sole" else [pytest.mark.long]) for p in NOTEBOOKS]
)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "notebook"}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{path.name}, {cell['id']}", "exec"), names)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_is_a_whole_one_without_output(path):
    """The fields that nbformat 4.5 asks for; output would change with every run and library."""
    book = json.loads(path.read_text(encoding="utf-8"))
    assert (book["nbformat"], book["nbformat_minor"]) == (4, 5)
    ids = [cell["id"] for cell in book["cells"]]
    assert len(set(ids)) == len(ids) > 3
    for cell in book["cells"]:
        assert cell["cell_type"] in ("code", "markdown")
        assert isinstance(cell["source"], list)
        assert "metadata" in cell
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None


def test_the_page_of_examples_names_each():
    page = (NOTEBOOKS[0].parents[1] / "README.md").read_text(encoding="utf-8")
    assert [path.stem for path in NOTEBOOKS] == ["push", "sole", "study", "walk"]
    assert all(f"(notebooks/{path.name})" in page for path in NOTEBOOKS)
