"""What a format of recordings has to keep."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from plantar.errors import PlantarError
from plantar.formats.format import Format, ReadOptions
from plantar.recordings.pressure_recording import PressureRecording

_HEAD = 1 << 16  # bytes by which files are recognised
_CUTS = (0.0, 0.1, 0.5, 0.9, 0.999)
_DAMAGED = 40  # files with random bytes


def check_format(format: Format, file: Path) -> list[str]:
    """What a format lacks, a sentence each; empty if nothing.

    Args:
        format: The format.
        file: A good file of it; cut and damaged copies are read, too.

    Returns:
        The sentences.
    """
    content = Path(file).read_bytes()
    lacks = []
    if not format.recognises(content[:_HEAD]):
        lacks.append(f"recognises() does not take {file}")
    others = (b"", b"\x00" * 64, b"time,left,right\n0,1,2\n", b"PK\x03\x04", b"%PDF-1.7\n")
    lacks += [f"recognises() takes a file that begins with {head[:12]!r}" for head in others if format.recognises(head)]
    if format.read is None:
        return lacks
    recording = format.read(Path(file), ReadOptions())
    if not isinstance(recording, PressureRecording):
        return [*lacks, f"read() returns a {type(recording).__name__}; expected a PressureRecording"]
    lacks += _lacks_of(recording)
    if format.read(Path(file), ReadOptions(rate_hz=77.0)).rate_hz != 77.0:
        lacks.append("a stated rate (--rate 77) is passed over")
    return lacks + _lacks_of_damage(format, Path(file), content)


def _lacks_of(recording: PressureRecording) -> list[str]:
    lacks = []
    if not recording.feet:
        lacks.append("the recording has no foot")
    if (np.diff(recording.time) <= 0.0).any():
        lacks.append("times do not rise")
    for side, foot in recording.feet.items():
        if len(foot.vertical_force) != len(recording.time):
            lacks.append(f"the {side} foot has {len(foot.vertical_force)} frames, the recording {len(recording.time)}")
        if np.isinf(foot.vertical_force).any():
            lacks.append(f"a force of the {side} foot is not finite")
    return lacks


def _lacks_of_damage(format: Format, file: Path, content: bytes) -> list[str]:
    """Cut and damaged files are read, or refused in one line; nothing else is raised."""
    random = np.random.default_rng(0)
    damaged = [content[: int(cut * len(content))] for cut in _CUTS]
    for _ in range(_DAMAGED):
        bytes_ = np.frombuffer(content, dtype=np.uint8).copy()
        places = random.integers(0, max(len(bytes_), 1), 5)
        bytes_[places] = random.integers(0, 256, 5)
        damaged.append(bytes_.tobytes())
    assert format.read is not None
    with TemporaryDirectory() as folder:
        path = Path(folder) / file.name
        for text in damaged:
            path.write_bytes(text)
            try:
                format.read(path, ReadOptions())
            except PlantarError as error:
                if "\n" in str(error):
                    return [f"a damaged file is refused in several lines: {str(error)[:80]!r}"]
            except Exception as error:  # of every kind: that is what is looked for
                return [f"a damaged file raises {type(error).__name__} ({error}); expected a FormatError of one line"]
    return []
