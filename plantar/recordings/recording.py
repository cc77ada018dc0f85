"""`Recorder` files as tables, and their export to NPZ or CSV."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import output_folder, replacing
from plantar.common.files.input_file import open_input
from plantar.errors import FormatError, InputError
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import layout_to_dict
from plantar.recordings.mcap_content import MCAP_MAGIC, McapContent


@dataclass(frozen=True, eq=False)
class Table:
    """One topic's messages: `time` (n,) in s, and values (n, k) of each of its `fields`."""

    time: NDArray[np.float64]
    fields: Mapping[str, NDArray[np.float64]]

    def __len__(self) -> int:
        return len(self.time)


@dataclass(frozen=True, eq=False)
class Recording:
    """Content of a recording.

    `layouts`: sole layout of each side, if any; `warnings`: what was missing, damaged or skipped.
    """

    path: Path
    metadata: Mapping[str, Any] = field(default_factory=dict)
    layouts: Mapping[str, SoleLayout] = field(default_factory=dict)
    topics: Mapping[str, Table] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def values(self, topic: str, field: str) -> NDArray[np.float64]:
        """Returns values (n, k) of a `field` of a `topic`."""
        return np.asarray(self.topics[topic].fields[field])

    def to_npz(self, path: str | os.PathLike[str]) -> Path:
        """Write all tables to one compressed NPZ at `path` (".npz" added without suffix); returns its path.

        Keys: "<topic>/time" and "<topic>/<field>" without leading slash; "metadata" and "layout_<side>" hold JSON.
        InputError for a field "time".
        """
        final = Path(path)
        final = final if final.suffix else final.with_suffix(".npz")
        arrays: dict[str, Any] = {"metadata": json.dumps(dict(self.metadata))}
        for side, layout in self.layouts.items():
            arrays[f"layout_{side}"] = json.dumps(layout_to_dict(layout))
        for topic, table in self.topics.items():
            if "time" in table.fields:
                raise InputError(f"topic {topic} has a field 'time', as its times are called; allowed: to_csv")
            arrays[f"{topic.lstrip('/')}/time"] = table.time
            for name, values in table.fields.items():
                arrays[f"{topic.lstrip('/')}/{name}"] = values
        with replacing(final) as temporary, temporary.open("wb") as stream:
            np.savez_compressed(stream, **arrays)
        return final

    def to_csv(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Write a CSV a topic, metadata.json and layout files to `folder`; returns the paths.

        Columns are "time_s", then "<field>" or "<field>_<index>", with all digits. InputError for topics of one name.
        """
        texts = {"metadata.json": json.dumps(dict(self.metadata), indent=1) + "\n"}
        for side, layout in self.layouts.items():
            texts[f"layout_{side}.json"] = json.dumps(layout_to_dict(layout), indent=1) + "\n"
        names = [f"{topic.strip('/').replace('/', '_')}.csv" for topic in self.topics]
        if twice := [topic for topic, name in zip(self.topics, names, strict=True) if names.count(name) > 1]:
            raise InputError(f"topics {', '.join(twice)} would be one CSV file; allowed: names that differ, or to_npz")
        with output_folder(folder) as out:
            for name, text in texts.items():
                (out / name).write_text(text, encoding="utf-8")
            for name, table in zip(names, self.topics.values(), strict=True):
                header = ["time_s"]
                for key, values in table.fields.items():
                    header += [f"{key}_{i}" for i in range(values.shape[1])] if values.shape[1] > 1 else [key]
                rows = np.column_stack([table.time, *table.fields.values()])
                np.savetxt(out / name, rows, fmt="%.17g", delimiter=",", header=",".join(header), comments="")
        return [Path(folder) / name for name in [*texts, *names]]


def read_mcap(path: str | os.PathLike[str]) -> Recording:
    """Read an MCAP recording's topics of float64 fields.

    Damaged chunks and other topics are left out and listed in `warnings`. FormatError if unreadable, not MCAP, or
    without a readable part.

    Example:
        >>> read_mcap("none.mcap")
        Traceback (most recent call last):
        plantar.errors.FormatError: none.mcap: cannot be read (No such file or directory)
    """
    content = McapContent()
    take_mcap(path, content)
    topics = {topic.name: Table(*topic.columns()) for topic in content.topics.values()}
    if not topics and not content.metadata and not content.layouts:
        why = f": {content.warnings[0]}" if content.warnings else ""
        raise FormatError(f"{path}: the MCAP file holds nothing that can be read{why}")
    return Recording(
        path=Path(path),
        metadata=content.metadata,
        layouts=content.layouts,
        topics=topics,
        warnings=tuple(content.warnings),
    )


def take_mcap(path: str | os.PathLike[str], content: McapContent) -> None:
    """Pass records of an MCAP file `path` to `content`; FormatError if unreadable or not MCAP."""
    with open_input(path, FormatError) as stream:
        head = stream.read(len(MCAP_MAGIC))
        if not head:
            raise FormatError(f"{path}: the file is empty")
        if head != MCAP_MAGIC:
            raise FormatError(f"{path}: not an MCAP recording (it begins with {head!r}); allowed: one of Plantar")
        try:
            content.take_file(stream)
        except FormatError as error:
            raise FormatError(f"{path}: {error}") from None
