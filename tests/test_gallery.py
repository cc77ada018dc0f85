"""The gallery of docs/perception.md can be drawn again."""

import re
import subprocess
import sys


def test_the_gallery_draws_what_the_page_shows(repository, tmp_path):
    subprocess.run([sys.executable, "examples/gallery.py", str(tmp_path)], cwd=repository, check=True, timeout=300)
    drawn = {p.name: p.stat().st_size for p in tmp_path.iterdir()}
    shown = set(
        re.findall(r"\]\(images/(gallery_\w+\.png)\)", (repository / "docs" / "perception.md").read_text("utf-8"))
    )
    assert set(drawn) == shown
    assert len(shown) == 4
    assert all(10_000 < size < 200_000 for size in drawn.values())
    assert all((repository / "docs" / "images" / name).exists() for name in shown)
