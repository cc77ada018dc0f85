"""Skin against ankle force-torque sensors in the scene `balance`: the table of balance.md, and balance.png.

`python benchmarks/outcomes.py MINUTES balance` runs what is missing and writes the table; `python
benchmarks/balance.py` draws both ZMPs of one run.
"""

import tempfile
from pathlib import Path
from typing import Any

from resumable import FOLDER, Benchmark, Case, Row, shown


def slowest(simulation: Any, out: dict[str, Any]) -> float | str:
    """The slowest recovery from a push in s; empty without one."""
    times = [push["recovered_s"] for push in out["balance"]["pushes"]]
    return "" if None in times else max(times)


def recovered(rows: list[Row]) -> str:
    """Recovered pushes of six a run."""
    return f"{sum(int(r['recovered']) for r in rows)} of {6 * len(rows)}"


ZMPS = "balance.skin_against_force_torque"
BENCHMARK = Benchmark(
    "balance",
    {
        "fell": "fell",
        "recovered": "balance.recovered",
        "zmp_off_max_m": "balance.zmp_off_max_m",
        "slowest_recovery_s": slowest,
        "rms_m": f"{ZMPS}.rms_m",
        "max_m": f"{ZMPS}.max_m",
        "zmp_margin_min_m": "zmp_margin_min_m",
        "tilt_max_deg": "tilt_max_deg",
    },
    [
        Case(source.replace("_", "-"), "balance", robot, (f"zmp_source={source}",), 8)
        for robot in ("h1", "hrp2kai")
        for source in ("skin", "force_torque")
    ],
    {
        "recovered": recovered,
        "largest shift of the ZMP [mm]": shown("zmp_off_max_m", "{median:.0f} ({most:.0f})", 1e3),
        "slowest recovery [s]": shown("slowest_recovery_s", "{median:.2f} ({most:.2f})"),
        "RMS difference [mm]": shown("rms_m", "{median:.2f} ({most:.2f})", 1e3),
        "largest difference [mm]": shown("max_m", "{median:.1f} ({most:.1f})", 1e3),
    },
)


def picture() -> None:
    from plantar.plotting import save_figure
    from plantar.recordings.recording import read_mcap
    from plantar.sim.figures.foothold_figure import draw_zmps
    from plantar.sim.run.runner import run_scene
    from plantar.sim.run.scene import load_scene

    with tempfile.TemporaryDirectory() as folder:
        run_scene(load_scene("balance"), 3, record=Path(folder) / "run.mcap")
        save_figure(draw_zmps(read_mcap(Path(folder) / "run.mcap")), FOLDER / "balance.png")


if __name__ == "__main__":
    picture()
