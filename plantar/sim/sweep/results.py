"""The rows of a sweep, and what they depend on: results.csv and sweep.json."""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from plantar.common.atomic import write_text
from plantar.common.files.structured_text import read_json
from plantar.common.row_table import RowTable
from plantar.errors import InputError
from plantar.sim.sweep.inputs import changes
from plantar.sim.sweep.plan import Key
from plantar.sim.sweep.value_range import canonical, is_word


@contextmanager
def open_results(
    folder: Path,
    identity: Mapping[str, Any],
    inputs: Mapping[str, Mapping[str, str]],
    axes: Sequence[str],
    columns: Sequence[str],
) -> Iterator[RowTable]:
    """Open a sweep's results in a `folder` (made if needed), new or stopped, for this process alone; yields the table.

    `identity` is what all rows share (`Sweep.identity`), `inputs` per robot what its rows depend on (`inputs_of`),
    `axes` the grid's settings and first columns, `columns` those after the seed. An InputError if the folder is
    unusable, in use, or another sweep's.
    """
    path = folder / "results.csv"
    plan = folder / "sweep.json"

    def key(row: Mapping[str, str]) -> Key:
        return tuple(canonical(row[axis], word=is_word(axis)) for axis in axes), int(row["seed"])

    try:
        folder.mkdir(parents=True, exist_ok=True)
        begun = path.exists() and path.read_bytes().count(b"\n") > 1  # more than its head
    except OSError as error:
        raise InputError(f"sweep folder {folder} cannot be used ({error.strerror}); choose another with -o") from None
    if begun and not plan.exists():
        raise InputError(f"{path} is there without sweep.json; choose another folder with -o")
    known = _known_inputs(plan, identity, inputs) if begun else {}
    with RowTable(path, (*axes, "seed", *columns), key) as table:
        write_text(plan, json.dumps({**identity, "inputs": {**known, **inputs}}, indent=1) + "\n")
        yield table


def _known_inputs(
    plan: Path, identity: Mapping[str, Any], inputs: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, str]]:
    before = read_json(plan, InputError, str(plan))
    folder = plan.parent
    other = f"{folder} holds the results of another sweep"
    try:
        known = {robot: dict(found) for robot, found in before["inputs"].items()}
        differ = [name for name in identity if before[name] != identity[name]]
    except (KeyError, TypeError, ValueError, AttributeError):
        raise InputError(f"{other}, or of another version of Plantar; choose another folder with -o") from None
    if differ:
        how = "; ".join(f"{k} was {json.dumps(before[k])} and is {json.dumps(identity[k])}" for k in differ)
        raise InputError(f"{other} ({how}); choose another folder with -o")
    for robot in inputs.keys() & known.keys():
        what = changes(known[robot], inputs[robot])
        if what:
            raise InputError(f"{what} since {folder} was begun; bring that back, or choose another folder with -o")
    return known
