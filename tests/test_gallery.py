"""The gallery of docs/perception.md can be drawn again."""

import re
import subprocess
import sys

import pytest

from plantar import FeetPercept, Percept


@pytest.mark.long
def test_the_gallery_draws_what_the_page_shows(repository, tmp_path):
    subprocess.run([sys.executable, "examples/gallery.py", str(tmp_path)], cwd=repository, check=True, timeout=600)
    drawn = {p.name: p.stat().st_size for p in tmp_path.iterdir()}
    shown = set(
        re.findall(r"\]\(images/(gallery_\w+\.png)\)", (repository / "docs" / "perception.md").read_text("utf-8"))
    )
    assert set(drawn) == shown
    assert len(shown) == 4
    assert all(10_000 < size < 200_000 for size in drawn.values())
    assert all((repository / "docs" / "images" / name).exists() for name in shown)


def test_the_page_explains_every_member(repository):
    page = (repository / "docs" / "perception.md").read_text("utf-8")
    told = set(
        re.findall(r"`(\w+)`", "\n".join(line.split("|")[1] for line in page.splitlines() if line.count("|") > 3))
    )
    of_feet = {k for k in vars(FeetPercept) if not k.startswith("_")}
    assert (set(Percept.members()) | of_feet) - told == set()
    assert told - set(Percept.members()) - of_feet == set()
