from pathlib import Path
from typing import Any

import pytest

from plantar.errors import InputError
from plantar.sim.figures.run_figure import plot_landing_forces, plot_run


def test_figures_of_a_run_are_written(short_run: tuple[dict[str, Any], Path], tmp_path: Path) -> None:
    files = plot_run(short_run[1], tmp_path)
    assert [f.name for f in files] == ["balance.png", "plane.png", "feet.png", "footholds.png"]
    assert all(f.read_bytes().startswith(b"\x89PNG") and f.stat().st_size > 20_000 for f in files)


def test_landing_forces_of_runs_are_drawn_below_each_other(
    short_run: tuple[dict[str, Any], Path], tmp_path: Path
) -> None:
    one = plot_landing_forces({"once": short_run[1]}, tmp_path / "one.png")
    two = plot_landing_forces({"once": short_run[1], "again": short_run[1]}, tmp_path / "two.png")
    assert 10_000 < one.stat().st_size < two.stat().st_size
    with pytest.raises(InputError, match="no runs"):
        plot_landing_forces({}, tmp_path / "none.png")
    assert not (tmp_path / "none.png").exists()
