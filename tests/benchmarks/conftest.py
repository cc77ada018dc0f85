"""Benchmarks are scripts: their folder is on the path as when one of them runs."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "benchmarks"))
