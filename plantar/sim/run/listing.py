"""Names of robots, machines, scenes, papers, formats and live sources, without a simulator."""

from fnmatch import fnmatch
from typing import Any

from plantar.common.files.structured_text import described_files, packaged_files
from plantar.errors import InputError
from plantar.sim.papers.preset import paper_files

SCENE_GROUPS: dict[str, tuple[str, ...]] = {
    "level ground": ("flat", "long-walk", "s-curve", "turn", "stop", "wander", "load"),
    "narrow and partial footholds": ("beam*", "partial-*", "stones", "pebbles"),
    "ground that the plan does not know": (
        *("feasibility-*", "obstacle", "tilt", "uneven", "height-field"),
        *("slopes", "stairs", "slide-in", "mixed"),
    ),
    "pushes, and hands that lead": ("push", "push-*", "balance", "box-step", "guide", "leader-follower"),
    "skin on the whole body": ("hug", "lean", "multi-contact", "nociception", "pressure", "feather", "stove"),
    "arms": ("force-tracking-*", "intentional-contact", "table-contact"),
}
"""Built-in scenes by what they try; names, or patterns of names."""


def scenes_by_group() -> dict[str, dict[str, str]]:
    """Built-in scenes with a line on each, by group; those of no group last.

    Example:
        >>> sorted(scenes_by_group()["arms"])[0]
        'force-tracking-1'
    """
    left = listed("scenes")
    found = {
        group: {name: left.pop(name) for name in [n for n in left if any(fnmatch(n, p) for p in patterns)]}
        for group, patterns in SCENE_GROUPS.items()
    }
    return found | ({"others": left} if left else {})


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


def scene_row(name: str) -> dict[str, Any]:
    """A scene's name, description and outcome: what its experiment shows, by criterion.

    Raises:
        SceneError: If there is no such scene.
    """
    from plantar.sim.run.scene import Scene
    from plantar.sim.run.scene_kind import open_scene

    scene = open_scene(name)
    outcome = {k: c.claim() for k, c in scene.outcome.items()} if isinstance(scene, Scene) else scene.claims()
    return {"name": name, "description": scene.description, "outcome": outcome}


def scene_text(row: dict[str, Any]) -> str:
    """A `scene_row` as text."""
    lines = [f"{row['name']}: {row['description']}", "completed where the criteria of every run hold"]
    lines += [f"and {claim} ({criterion})" for criterion, claim in row["outcome"].items()]
    return "\n".join(lines)
