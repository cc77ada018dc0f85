from plantar.sim.figures.run_figure import plot_run


def test_figures_of_a_run_are_written(short_run, tmp_path):
    files = plot_run(short_run[1], tmp_path)
    assert [f.name for f in files] == ["balance.png", "plane.png", "feet.png", "footholds.png"]
    assert all(f.read_bytes().startswith(b"\x89PNG") and f.stat().st_size > 20_000 for f in files)
