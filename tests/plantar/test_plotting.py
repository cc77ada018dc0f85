import subprocess
import sys
from itertools import pairwise

import pytest

from plantar import InputError
from plantar.plotting import COLOURS, new_figure, save_figure, ticks_in_mm


def drawn():
    figure, axes = new_figure(4.0, 3.0)
    axes.plot([0, 1], [0, 1], color=COLOURS["left"])
    axes.set_xlabel("x [m]")
    return figure


@pytest.mark.parametrize(("suffix", "start"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_a_figure_is_written_in_the_format_of_its_name(tmp_path, suffix, start):
    path = save_figure(drawn(), tmp_path / f"cop.{suffix}")
    assert path.read_bytes().startswith(start)
    assert [p.name for p in tmp_path.iterdir()] == [f"cop.{suffix}"]


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_the_same_figure_gives_the_same_bytes(tmp_path, suffix):
    one, two = (save_figure(drawn(), tmp_path / f"{name}.{suffix}").read_bytes() for name in ("one", "two"))
    assert one == two


def test_several_axes_come_as_an_array():
    _, axes = new_figure(rows=2, columns=3, squeeze=False)
    assert axes.shape == (2, 3)


def test_colours_are_colours_and_each_has_one_meaning():
    from matplotlib.colors import is_color_like

    assert all(is_color_like(c) for c in COLOURS.values())
    assert len(set(COLOURS.values())) == len(COLOURS)


def test_an_unknown_format_is_one_line_and_leaves_nothing(tmp_path):
    with pytest.raises(InputError, match=r"cop\.xyz.*allowed: pdf, png, svg"):
        save_figure(drawn(), tmp_path / "cop.xyz")
    assert list(tmp_path.iterdir()) == []


def test_figures_need_no_display_and_matplotlib_waits_for_the_first():
    code = (
        "import sys, plantar.plotting as p; assert 'matplotlib' not in sys.modules; p.new_figure();"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True, env={"PATH": ""})


@pytest.mark.parametrize("width", [0.06, 0.08, 0.12, 0.4])
def test_ticks_of_a_foot_can_be_read(width):
    """Every foot has three to six ticks across it, whole millimetres that do not run into each other."""
    figure, axes = new_figure(2.6, 5.0)
    axes.plot([-0.5 * width, 0.5 * width], [0.0, 3.0 * width])
    ticks_in_mm(axes)
    figure.draw_without_rendering()
    low, high = axes.get_xlim()
    labels = [t for t in axes.get_xticklabels() if low <= t.get_position()[0] <= high]
    assert 3 <= len(labels) <= 6
    assert all(float(t.get_text().replace("\u2212", "-")) == pytest.approx(1e3 * t.get_position()[0]) for t in labels)
    boxes = [t.get_window_extent() for t in labels]
    assert all(a.x1 + 2.0 < b.x0 for a, b in pairwise(boxes))
