"""Benchmarks are scripts: their folder is on the path as when one of them runs."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "benchmarks"))
sys.path.append(str(ROOT / "tests" / "plantar"))
