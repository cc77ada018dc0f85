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
    ├── WorkerError              the workers of a sweep cannot run or went away; the command line exits 1
    ├── KernelError              what is asked for needs the compiled kernels, which were not built
    └── DependencyError          an optional library is missing (holds the command that installs it) or cannot be loaded

Each message is one line: what is wrong and what is allowed.
"""

import os
import sys


class PlantarError(Exception):
    """Root of every error that Plantar raises on purpose."""


class InputError(PlantarError):
    """Argument or option is outside what is allowed."""


class LayoutError(PlantarError):
    """Sole layout is not valid; the message names the field."""


class ReadingError(PlantarError):
    """Reading does not fit its layout."""


class RecordingError(PlantarError):
    """Recording cannot be read or written."""


class FormatError(RecordingError):
    """A file is not of the format it was taken for."""


class FootError(PlantarError):
    """Foot's geometry cannot carry a shoe."""


class RobotError(PlantarError):
    """Robot description is not valid."""


class SceneError(PlantarError):
    """Scene description is not valid."""


class WorkerError(PlantarError):
    """Worker of a sweep cannot run, or went away; the input is right."""


class KernelError(PlantarError):
    """Compiled kernels are needed, and were not built."""


class DependencyError(PlantarError):
    """Optional library is missing or cannot be loaded.

    Args:
        library: Name of library as it is imported.
        extra: Name of Plantar extra that brings it.
        reason: Why an installed one cannot be loaded; None if missing.
    """

    def __init__(self, library: str, extra: str, reason: str | None = None) -> None:
        if reason is None:
            text = f"{library} is not installed; install it with: {self.install_command(extra)}"
        else:
            reason = " ".join(reason.split())[:300]
            text = f"{library} is installed but cannot be loaded ({reason}); repair it or what it needs"
        super().__init__(text)
        self.library = library
        self.extra = extra
        self.reason = reason

    def __reduce__(self) -> tuple[type["DependencyError"], tuple[str, str, str | None]]:
        """Rebuild from the arguments, in another process."""
        return type(self), (self.library, self.extra, self.reason)

    @staticmethod
    def install_command(extra: str) -> str:
        """The command that installs the libraries of an extra, or with "" those that are always needed.

        It names the libraries, not `plantar[extra]`: that is right in a checkout, beside a wheel and from an index. It
        installs for the Python that runs, also where another one's pip is found first, or none is there.

        Example:
            >>> DependencyError.install_command("gym")  # doctest: +ELLIPSIS
            "...pip install 'gymnasium>=1.0'"
        """
        wanted = [_quoted(requirement) for requirement in DependencyError.requirements(extra)]
        if wanted:
            return f"{_install()} {' '.join(wanted)}"
        return f"{_install()} {_quoted(f'.[{extra}]' if extra else '.')} in a checkout of plantar"

    @staticmethod
    def requirements(extra: str) -> list[str]:
        """What an extra asks for, or with "" what is always needed; empty if Plantar is on the path alone.

        Example:
            >>> DependencyError.requirements("gym")
            ['gymnasium>=1.0']
        """
        from importlib.metadata import PackageNotFoundError, requires

        try:
            lines = requires("plantar") or []
        except PackageNotFoundError:
            return []
        return [line.partition(";")[0].strip() for line in lines if _extra_of(line) == extra]


def _extra_of(requirement: str) -> str:
    """Extra of a line such as 'mujoco>=3.10; extra == "sim"'; "" without one."""
    _, _, marker = requirement.partition("extra ==")
    return marker.strip().strip("\"'")


def _quoted(word: str) -> str:
    """A word that neither a shell nor cmd.exe, which knows no single quotes, takes apart."""
    return f'"{word}"' if os.name == "nt" else f"'{word}'"


def _install() -> str:
    """How to call the pip of the Python that runs."""
    from importlib.metadata import PackageNotFoundError, version
    from shutil import which

    python = _quoted(sys.executable) if " " in sys.executable else sys.executable
    try:
        version("pip")
    except PackageNotFoundError:  # as in environments that uv makes
        return f"uv pip install --python {python}"
    found = which("pip")
    if found is not None and os.path.dirname(found) == os.path.dirname(sys.executable):
        return "pip install"
    return f"{python} -m pip install"
