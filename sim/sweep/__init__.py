"""Many runs of a scene: over a grid and seeds, at random or towards a limit, on this machine or on a Dask cluster."""

from sim.sweep.limit_search import LimitSearch
from sim.sweep.loop import run_sweep
from sim.sweep.plan import Sweep
from sim.sweep.plan_text import plan_from_texts
from sim.sweep.random_search import RandomSearch
from sim.sweep.stopping import SweepStopped
from sim.sweep.task import run_one

__all__ = ["LimitSearch", "RandomSearch", "Sweep", "SweepStopped", "plan_from_texts", "run_one", "run_sweep"]
