"""Random damage to files: a reader raises a PlantarError of one line or gives a recording, never anything else."""

import numpy as np

from plantar import PlantarError
from plantar.formats import read_recording
from plantar.recordings.pressure_recording import PressureRecording

from ...examples import scaled


def mutants(whole, trials, header=1500, seed=0):
    """A file damaged in many ways: other bytes, by turns near its beginning, a cut end, a part missing."""
    random = np.random.default_rng(seed)
    for trial in range(trials):
        data = bytearray(whole)
        top = min(header, len(data)) if trial % 2 else len(data)
        for at in random.integers(0, top, size=random.integers(1, 20)):
            data[at] = random.integers(0, 256)
        if trial % 5 == 3:
            data = data[: random.integers(1, len(data))]
        if trial % 5 == 4:
            at = int(random.integers(0, top))
            del data[at : at + int(random.integers(1, 100))]
        yield bytes(data)


def refusals(path, trials=40, read=read_recording, **damage):
    """Read a file damaged in many ways; returns what the refusals state, which are one line each."""
    lines: list[str] = []
    for data in mutants(path.read_bytes(), trials, **damage):
        path.write_bytes(data)
        try:
            read(path)
        except PlantarError as error:
            lines.append(str(error))
    assert [line for line in lines if "\n" in line] == []
    return lines


def survive_corruption(path, trials=40, seed=0, options=None, header=1500, check=None):
    """Damage a file in many ways, fewer in the short tests, and read each; returns the share that was read."""
    trials = scaled(trials)
    whole = path.read_bytes()
    before = read_recording(path, options=options)
    usual = peaks(before)

    def read(path):
        try:
            recording = read_recording(path, options=options)
        except PlantarError as error:
            if error.__cause__ is not None:
                raise AssertionError(f"the reader did not expect {error.__cause__!r}") from error.__cause__
            raise
        assert np.isfinite(recording.time).all()
        assert (np.diff(recording.time) > 0.0).all()
        new = set(recording.warnings) - set(before.warnings)
        for side, peak in peaks(recording).items():
            wrong = side in usual and not 0.8 < peak / max(usual[side], 1e-9) < 1.25
            assert not wrong or new or recording.raw, f"{usual[side]} N became {peak} N in silence"
        if check is not None:
            check(recording)

    refused = refusals(path, trials, read, header=header, seed=seed)
    path.write_bytes(whole)
    return 1.0 - len(refused) / trials


def peaks(recording: PressureRecording) -> dict[str, float]:
    """A robust peak of each foot's force."""
    out = {}
    for side, foot in recording.feet.items():
        force = foot.vertical_force[np.isfinite(foot.vertical_force)]
        out[side] = float(np.percentile(force, 90.0)) if len(force) else 0.0
    return out
