"""Files of the field that are no recordings of loads, by their first bytes: refused with what to give instead."""

import os
import re

from plantar.errors import FormatError
from plantar.formats.text import head_text

# TRC: Motion Analysis; ANC: EVaRT and Cortex; the section by which an export of Vicon Nexus begins; BTS' TDF by the
# identifier at its beginning.
_OF_TEXT = (
    (
        re.compile(r"PathFileType[\s,;]"),
        "places of markers (.trc) and no loads; allowed: the forces of the same trial, as .mot, .forces or C3D",
    ),
    (
        re.compile(r"File_Type:\s*Analog R/C ASCII"),
        "counts of an A/D converter (.anc), of which only its plates' calibration makes forces; allowed: the same "
        "trial as C3D, or as a table of forces in N",
    ),
    (
        re.compile(r"Trajectories[,;\t\n](?!(?:.*\n)*Devices)"),
        "places of markers and no loads; allowed: an export with the section Devices and its force plates",
    ),
)
_TDF = bytes.fromhex("824b6041d31184ca6000b6ac16680c08")


def refuse_without_loads(path: str | os.PathLike[str], head: bytes) -> None:
    """FormatError for a file whose first bytes show that it holds no loads."""
    if head.startswith(_TDF):
        raise FormatError(f"{path}: a BTS file (.tdf), which is not read; allowed: the same trial as C3D")
    text = head_text(head[: 1 << 16])
    for beginning, what in _OF_TEXT:
        if beginning.match(text):
            raise FormatError(f"{path}: {what}")
