"""The page of a kind of `plantar bench`: a title, a figure, and tables in Markdown."""

from pathlib import Path

from plantar.bench.kind import Finding, Kind
from plantar.bench.tables import made_on, markdown_table, write_rows
from plantar.common.atomic import write_text


def write_page(folder: Path, kind: Kind, finding: Finding) -> list[str]:
    """Write page, figure and summary of a `kind`'s `finding` into an existing `folder`; returns their names."""
    files = [f"{kind.page}.md"]
    parts = [f"# {kind.title}"]
    if finding.draw is not None:
        finding.draw(folder / f"{kind.page}.png")
        files.append(f"{kind.page}.png")
        parts.append(f"![{kind.title}]({kind.page}.png)")
    parts.append(f"{kind.lead}\n\nMade on {made_on()}.")
    parts.append(tables_text(finding))
    write_text(folder / files[0], "\n\n".join(parts) + "\n")
    if finding.summary:
        write_rows(folder / f"{kind.page}.csv", finding.summary)
        files.append(f"{kind.page}.csv")
    return files


def tables_text(finding: Finding) -> str:
    """The tables of a `finding` in Markdown, for page and terminal."""
    return "\n\n".join(f"## {t.heading}\n\n{markdown_table(t.head, t.rows)}" for t in finding.tables)
