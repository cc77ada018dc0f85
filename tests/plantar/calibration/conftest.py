"""Faulty soles of the benchmark, small enough for a test."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[3] / "benchmarks"))
