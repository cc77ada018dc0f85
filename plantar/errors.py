"""Exception tree of Plantar.

    PlantarError                 root; the command line prints its text as one line and exits 2
    ├── InputError               an argument or option is outside what is allowed
    ├── LayoutError              a sole layout or layout file is not valid; names the field
    ├── ReadingError             a reading does not fit its layout
    ├── RecordingError           a recording cannot be read or written
    │   └── FormatError          a file is not of the format it was taken for
    ├── FootError                a foot's geometry cannot carry a shoe
    ├── RobotError               a robot description is not valid
    ├── SceneError               a scene description is not valid
    └── DependencyError          an optional library is missing; holds the command that installs it

Each message says what is wrong and what is allowed, in one line.
"""

from __future__ import annotations

__all__ = [
    "DependencyError",
    "FootError",
    "FormatError",
    "InputError",
    "LayoutError",
    "PlantarError",
    "ReadingError",
    "RecordingError",
    "RobotError",
    "SceneError",
]


class PlantarError(Exception):
    """Root of every error that Plantar raises on purpose."""


class InputError(PlantarError):
    """An argument or option is outside what is allowed."""


class LayoutError(PlantarError):
    """A sole layout is not valid; the message names the field."""


class ReadingError(PlantarError):
    """A reading does not fit its layout."""


class RecordingError(PlantarError):
    """A recording cannot be read or written."""


class FormatError(RecordingError):
    """A file is not of the format it was taken for."""


class FootError(PlantarError):
    """A foot's geometry cannot carry a shoe."""


class RobotError(PlantarError):
    """A robot description is not valid."""


class SceneError(PlantarError):
    """A scene description is not valid."""


class DependencyError(PlantarError):
    """An optional library is missing.

    Args:
        library: Name of the library as it is imported.
        extra: Name of the Plantar extra that brings it.
    """

    def __init__(self, library: str, extra: str) -> None:
        super().__init__(f"{library} is not installed; install it with: pip install 'plantar[{extra}]'")
        self.library = library
        self.extra = extra

    def __reduce__(self) -> tuple[type[DependencyError], tuple[str, str]]:
        """Rebuild from both arguments, so that the error crosses to another process."""
        return type(self), (self.library, self.extra)
