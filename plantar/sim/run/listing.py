"""Names of robots, machines, scenes, papers, formats and live sources, without a simulator."""

from plantar.common.files.structured_text import described_files, packaged_files
from plantar.errors import InputError
from plantar.sim.papers.preset import paper_files


def listed(what: str) -> dict[str, str]:
    """Names with a line on each.

    `what`: "robots", "scenes", "papers", "formats" or "sources". Returns descriptions by name.

    Example:
        >>> "h1" in listed("robots"), "beam" in listed("scenes")
        (True, True)
    """
    if what == "formats":
        from plantar.formats import formats

        return {f.name: f"{f.title} ({', '.join(f.suffixes)})" for f in formats().values()}
    if what == "sources":
        from plantar.live.source import live_sources

        return {source.name: source.title for source in live_sources().values()}
    if what == "robots":
        files = packaged_files("plantar.robots", "*/robot.toml")
        files += packaged_files("plantar.sim", "companion/machines/*/machine.toml")
        return {path.parent.name: text for path, text in described_files(files).items()}
    if what == "scenes":
        return {
            path.stem: text for path, text in described_files(packaged_files("plantar.sim", "scenes/*.toml")).items()
        }
    if what == "papers":
        found = paper_files()
        return dict(zip(found, described_files(found.values()).values(), strict=True))
    raise InputError(f"cannot list '{what}'; allowed: robots, scenes, papers, formats, sources, settings")
