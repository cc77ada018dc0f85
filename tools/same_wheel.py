"""Build the wheel twice, in two copies of the checkout, and compare: exit code 1 where a byte differs.

python tools/same_wheel.py [--keep FOLDER]

Times in the archive are that of the commit (SOURCE_DATE_EPOCH).
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def wheel(folder: Path, epoch: str) -> Path:
    """The wheel of a fresh copy of what is committed."""
    folder.mkdir()
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout
    subprocess.run(["tar", "x", "-C", str(folder)], input=archive, check=True)
    environment = {**os.environ, "SOURCE_DATE_EPOCH": epoch, "PYTHONHASHSEED": "0"}
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", "dist", "."]
    subprocess.run(command, cwd=folder, env=environment, check=True)
    return next((folder / "dist").glob("*.whl"))


def differing(one: Path, other: Path) -> list[str]:
    """Names of the parts that differ."""
    with zipfile.ZipFile(one) as a, zipfile.ZipFile(other) as b:
        names = sorted({*a.namelist(), *b.namelist()})
        both = {*a.namelist()} & {*b.namelist()}
        return [name for name in names if name not in both or a.read(name) != b.read(name)]


def main() -> None:
    """Build and compare."""
    command = ["git", "log", "-1", "--format=%ct"]
    epoch = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
    with tempfile.TemporaryDirectory() as made:
        one, other = (wheel(Path(made, name), epoch) for name in ("one", "another"))
        same = one.read_bytes() == other.read_bytes()
        print(f"{one.name} sha256 {hashlib.sha256(one.read_bytes()).hexdigest()}")
        if not same:
            sys.exit(f"the second one differs: {', '.join(differing(one, other)[:10]) or 'in its order or times'}")
        if sys.argv[1:2] == ["--keep"]:
            shutil.copy(one, sys.argv[2])


if __name__ == "__main__":
    main()
