"""Reports of steps as Moticon's program writes them: workbooks (.xlsx) of events."""

import zipfile
from collections.abc import Sequence
from pathlib import Path

_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_SPACES = f'xmlns="{_MAIN}" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"'


def write_report(path: Path, sheets: Sequence[str], rows: int = 3, head: str = "", padding: int = 0) -> Path:
    """Write a report whose rows are a second apart; each sheet begins with `head` and ends with megabytes of blanks."""
    names = "".join(f'<sheet name="{name}" r:id="r{i}"/>' for i, name in enumerate(sheets))
    links = "".join(f'<Relationship Id="r{i}" Target="s{i}.xml"/>' for i in range(len(sheets)))
    cells = "".join(f'<row><c r="B{i}"><v>{i}</v></c><c r="C{i}"><v>{i}.6</v></c></row>' for i in range(1, rows + 1))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/workbook.xml", f"<workbook {_SPACES}><sheets>{names}</sheets></workbook>")
        archive.writestr("xl/_rels/workbook.xml.rels", f"<Relationships>{links}</Relationships>")
        for i in range(len(sheets)):
            with archive.open(f"xl/s{i}.xml", "w") as part:
                part.write(f"{head}<worksheet {_SPACES}><sheetData>{cells}".encode())
                for _ in range(padding):
                    part.write(b" " * 1_000_000)
                part.write(b"</sheetData></worksheet>")
    return path
