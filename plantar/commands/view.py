"""`plantar view`: write a page that plays one or two recordings in 3D."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, end_command
from plantar.errors import InputError


def view(
    recording: Annotated[Path, Argument(help="Recording (.mcap) of plantar sim --record, or of a robot's soles.")],
    other: Annotated[
        Path | None, Argument(help="A second recording, to see both side by side.", show_default=False)
    ] = None,
    output: Annotated[Path, Option("-o", "--output", help="The page to write, an .html file.")] = Path("out/view.html"),
    as_json: Json = False,
) -> None:
    """Write a page that plays a recording in 3D: robot, soles, CoP, forces, support polygon and footsteps.

    The page is one file for any browser and asks for no network: about 1 MB, and 60 kB for each second.

    Example: plantar view run.mcap -o view.html

    Example: plantar view feedback.mcap open_loop.mcap -o both.html
    """
    if output.suffix not in (".html", ".htm"):
        raise InputError(f"-o {output} needs a name that ends in .html")
    from plantar.common.atomic import parent_folder
    from plantar.viewer.page import view_text, write_page

    with parent_folder(output):
        written = write_page([recording] if other is None else [recording, other], output)
    end_command(written, as_json, view_text(written), written["warnings"])


COMMAND = Command(view, "Write a page that plays one or two recordings in 3D.", 50)
