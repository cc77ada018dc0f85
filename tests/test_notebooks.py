"""The notebooks: their code runs from the first cell to the last, in an empty folder, and shows what is stored.

`tools/notebooks.py` runs and stores them.
"""

import importlib.util
import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
SHARE = 0.1  # that a number may differ from the one that was stored, with other versions of libraries
LARGEST = 300_000  # bytes of a notebook


@pytest.fixture(scope="module")
def notebooks():
    """The script that runs the notebooks."""
    spec = importlib.util.spec_from_file_location("notebooks", ROOT / "tools" / "notebooks.py")
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def texts(cell):
    """What a cell shows as text."""
    return ["".join(o["text"] if o["output_type"] == "stream" else o["data"]["text/plain"]) for o in cell["outputs"]]


def agree(stored, shown):
    """Whether two texts have the same words, and numbers that differ by a tenth at most, or by the last digit."""
    if NUMBER.sub("#", stored) != NUMBER.sub("#", shown):
        return False
    pairs = zip(NUMBER.findall(stored), NUMBER.findall(shown), strict=True)
    return all(abs(float(a) - float(b)) <= max(SHARE * abs(float(a)), last_digit(a)) for a, b in pairs)


def last_digit(number):
    """1 of "12", 0.1 of "1.2"."""
    return 10.0 ** -len(number.partition(".")[2])


@pytest.mark.parametrize(
    "path", [pytest.param(p, id=p.stem, marks=[] if p.stem == "sole" else [pytest.mark.long]) for p in NOTEBOOKS]
)
def test_a_notebook_runs_and_shows_what_is_stored(path, notebooks, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    stored = json.loads(path.read_text(encoding="utf-8"))
    for before, now in zip(stored["cells"], notebooks.run_notebook(path)["cells"], strict=True):
        if before["cell_type"] == "code":
            assert len(texts(before)) == len(texts(now))
            assert all(agree(a, b) for a, b in zip(texts(before), texts(now), strict=True)), (texts(before), texts(now))
            kinds = [[set(o.get("data", ())) for o in cell["outputs"]] for cell in (before, now)]
            assert kinds[0] == kinds[1]


def test_a_number_that_moved_is_noticed():
    assert agree("400 N at x = 26 mm", "401 N at x = 27 mm")
    assert not agree("400 N at x = 26 mm", "400 N at x = 30 mm")
    assert not agree("400 N at x = 26 mm", "400 N at y = 26 mm")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_is_a_whole_one_with_its_output(path):
    """The fields that nbformat 4.5 asks for; no counts, which would change with each run."""
    book = json.loads(path.read_text(encoding="utf-8"))
    assert path.stat().st_size < LARGEST
    assert (book["nbformat"], book["nbformat_minor"]) == (4, 5)
    ids = [cell["id"] for cell in book["cells"]]
    assert len(set(ids)) == len(ids) > 3
    for cell in book["cells"]:
        assert cell["cell_type"] in ("code", "markdown")
        assert isinstance(cell["source"], list)
        assert "metadata" in cell
        if cell["cell_type"] == "code":
            assert cell["execution_count"] is None
    shown = [o for cell in book["cells"] if cell["cell_type"] == "code" for o in cell["outputs"]]
    assert any("image/png" in o.get("data", {}) for o in shown)
    assert any(o["output_type"] == "stream" for o in shown)


def test_the_page_of_examples_names_each():
    page = (NOTEBOOKS[0].parents[1] / "README.md").read_text(encoding="utf-8")
    assert [path.stem for path in NOTEBOOKS] == ["push", "sole", "study", "walk"]
    assert all(f"(notebooks/{path.name})" in page for path in NOTEBOOKS)
