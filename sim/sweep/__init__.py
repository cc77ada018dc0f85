"""Many runs: a scene over a grid of settings and seeds, on this machine's cores or on a Dask cluster."""

from sim.sweep.loop import figures_of, run_sweep
from sim.sweep.plan import Sweep
from sim.sweep.stopping import SweepStopped
from sim.sweep.task import run_one

__all__ = ["Sweep", "SweepStopped", "figures_of", "run_one", "run_sweep"]
