"""A mutation loop over a reader.

python -m tests.fuzz.mutants view --seconds 60  # mutants of small files, kept where they fail

A failing mutant is kept as tests/fuzz/cases/READER-HASH; the tests read it from then on.
"""

import argparse
import hashlib
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from plantar.errors import PlantarError

from .targets import TARGETS, Target

CASES = Path(__file__).parent / "cases"
_LONGEST = 10.0
_WORDS = (b"0", b"-1", b"1e308", b"nan", b"inf", b"99999999999", b"\xff" * 8, bytes(8), b"\n", b",", b'"', b"<", b"=")


class Failure(Exception):
    """A mutant that traced back, or took longer than 10 s."""


def mutant(seed: bytes, rng: np.random.Generator) -> bytes:
    """A file with some damage: other bytes, words, a part missing, doubled or moved."""
    data = bytearray(seed)
    for _ in range(rng.integers(1, 8)):
        at, kind = int(rng.integers(0, max(1, len(data)))), rng.integers(0, 6)
        size = int(min(2 ** rng.integers(0, 12), len(data)))
        if kind <= 1 and data:
            data[at] = rng.integers(0, 256)
        elif kind == 2:
            word = _WORDS[rng.integers(0, len(_WORDS))]
            data[at : at + len(word)] = word
        elif kind == 3:
            del data[at : at + size]
        elif kind == 4:
            data[at:at] = data[at : at + size]
        else:
            other = int(rng.integers(0, max(1, len(data))))
            data[at : at + size] = data[other : other + size]
    return bytes(data)


def tried(target: Target, path: Path, content: bytes) -> bool:
    """Read a file; returns whether it was read, and not refused."""
    path.write_bytes(content)
    begun = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            target.read(path)
        read = True
    except (PlantarError, ValueError) as error:
        if not isinstance(error, PlantarError) and target.suffix != ".toml":
            raise Failure(f"{type(error).__name__}: {error}") from error
        read = False
    except Exception as error:
        raise Failure(f"{type(error).__name__}: {error}") from error
    if time.process_time() - begun > _LONGEST:
        raise Failure(f"takes {time.process_time() - begun:.0f} s")
    return read


def read_all(name: str, seconds: float, most: int, folder: Path, seed: int = 0) -> Iterator[tuple[bytes, str]]:
    """Try mutants for a while."""
    target, rng, count = TARGETS[name], np.random.default_rng(seed), 0
    corpus = target.seeds(folder)
    begun = time.monotonic()
    while corpus and time.monotonic() - begun < seconds and count < most:
        content = mutant(corpus[rng.integers(0, len(corpus))], rng)
        count += 1
        try:
            if tried(target, folder / f"mutant{target.suffix}", content) and len(corpus) < 200:
                corpus.append(content)  # what is still read leads further
        except Failure as failure:
            yield content, str(failure)
    yield b"", str(count)


def main() -> None:
    """Fuzz a reader from the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("reader", choices=[*TARGETS, "all"])
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    given = parser.parse_args()
    names = list(TARGETS) if given.reader == "all" else [given.reader]
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        failed = 0
        for name in names:
            for content, why in read_all(name, given.seconds / len(names), 10**9, folder, given.seed):
                if content:
                    failed += 1
                    CASES.mkdir(exist_ok=True)
                    (CASES / f"{name}-{hashlib.sha256(content).hexdigest()[:12]}").write_bytes(content)
                    print(f"{name}: {why}", file=sys.stderr)
                else:
                    print(f"{name}: {why} mutants")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
