"""Presets by source: `--set paper=K` sets what a paper states of a scene.

Each table `[[settings]]` of this folder's TOML files cites its source.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from plantar.common.files.structured_text import packaged_files, read_toml
from plantar.common.settings.overrides import split_setting
from plantar.errors import SceneError


class PaperSettings(NamedTuple):
    """What a paper states.

    `source`: such as "K Table 1", and what for; `robot`: the only one it holds for; empty for every one; `settings`:
    "key=value" each.
    """

    source: str
    scenes: tuple[str, ...]
    robot: str
    settings: tuple[str, ...]


def paper_files() -> dict[str, Path]:
    """Preset files by the mark of their paper: "A", "K", "T"."""
    return {path.stem: path for path in packaged_files("plantar.sim", "papers/?.toml")}


def paper_settings(paper: str) -> tuple[PaperSettings, ...]:
    """What a paper, named by its mark, states, in order.

    Example:
        >>> paper_settings("K")[1].settings[1]
        'walk.single_support=0.8'
    """
    files = paper_files()
    if paper not in files:
        raise SceneError(f"no paper is called '{paper}'; allowed: {', '.join(files)}")
    found = read_toml(files[paper], SceneError, f"preset {files[paper]}")["settings"]
    return tuple(PaperSettings(f["source"], tuple(f["scenes"]), f.get("robot", ""), tuple(f["set"])) for f in found)


def paper_rows(paper: str) -> list[dict[str, object]]:
    """What a paper states, as plain values."""
    return [found._asdict() for found in paper_settings(paper)]


def paper_text(paper: str) -> str:
    """What a paper states: sources, scenes and settings."""
    lines = []
    for found in paper_settings(paper):
        robot = f" with {found.robot}" if found.robot else ""
        lines += [found.source, f"    {', '.join(found.scenes)}{robot}", *(f"    --set {s}" for s in found.settings)]
    return "\n".join(lines)


def with_paper(settings: Sequence[str], scene: str, robot: str) -> tuple[str, list[str]]:
    """Replace "paper=K" by what that paper states; own settings count after it.

    `settings`: "key=value" each. Returns the paper's mark, or empty, and the settings.

    Example:
        >>> paper, found = with_paper(["paper=K", "walk.confidence=1"], "push-step", "h1")
        >>> paper, found[0], found[-1]
        ('K', 'robot=h1', 'walk.confidence=1')
    """
    pairs = [(split_setting(setting), setting) for setting in settings]
    papers = {text for (key, text), _ in pairs if key == "paper"}
    if not papers:
        return "", list(settings)
    if len(papers) > 1:
        raise SceneError(f"papers {' and '.join(sorted(papers))} are given; allowed: one of them")
    (paper,) = papers
    own = [setting for (key, _), setting in pairs if key != "paper"]
    stated = paper_settings(paper)
    mine = [found for found in stated if scene in found.scenes]
    if not mine:
        known = sorted({name for found in stated for name in found.scenes})
        raise SceneError(f"paper {paper} states nothing of scene '{scene}'; allowed: {', '.join(known)}")
    named = [text for (key, text), _ in pairs if key in ("robot", "machine")]
    robot = named[-1] if named else robot
    return paper, [s for found in mine if found.robot in ("", robot) for s in found.settings] + own
