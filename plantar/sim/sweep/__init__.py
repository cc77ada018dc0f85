"""Many runs of a scene, on this machine or a Dask cluster."""

from plantar.sim.sweep.limit_search import LimitSearch
from plantar.sim.sweep.loop import SweepStopped, run_sweep
from plantar.sim.sweep.plan import Sweep
from plantar.sim.sweep.plan_text import plan_from_texts
from plantar.sim.sweep.random_search import RandomSearch
from plantar.sim.sweep.task import run_one

__all__ = ["LimitSearch", "RandomSearch", "Sweep", "SweepStopped", "plan_from_texts", "run_one", "run_sweep"]
