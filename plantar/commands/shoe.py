"""`plantar shoe`: build a printable tactile shoe for a robot's foot, and the layout of its taxels."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, Output, end_command, with_option_groups
from plantar.common.console.progress import part_of, progress_bar
from plantar.common.sides import SIDES
from plantar.errors import InputError
from plantar.shoes.order import FootSource, ShoeOrder


@with_option_groups
def shoe(
    source: FootSource,
    order: ShoeOrder,
    foot: Annotated[
        Path | None,
        Argument(
            metavar="FOOT",
            help="Mesh of the foot (.stl .obj .ply .off .dae .3mf .step), robot's model (.xml .urdf, with --body), "
            "or outline of its sole (.dxf .svg .geojson).",
            show_default=False,
        ),
    ] = None,
    parameters: Annotated[
        Path | None, Option(help="JSON or TOML file with parameters; their names are in docs/shoes.md.")
    ] = None,
    settings: Annotated[
        list[str] | None, Option("--set", metavar="NAME=VALUE", help="Change one parameter; repeatable.")
    ] = None,
    preview: Annotated[
        bool, Option("--preview", help="Only draw the foot with the axes that were found (preview.png), in 3 s.")
    ] = False,
    output: Output = Path("out/shoe"),
    as_json: Json = False,
) -> None:
    """Build a printable tactile shoe for a robot's foot, and the layout of its taxels.

    Writes the printable part (shoe_<side>.stl, .step, .3mf), its pad, layout_<side>.json, a drawing, a picture, the
    bill of parts (parts.csv), how it is put together (assembly.html) and check.json. Exit code 1 if a check does not
    hold.

    Example: plantar shoe foot.stl -o out/shoe

    Example: plantar shoe robot.xml --body left_foot --side left

    Example: plantar shoe --robot h1 --set material=PETG --set rim_height=16 --json

    Example: plantar shoe foot.stl --coupon -o out/coupon

    Example: plantar shoe outline_of_my_foot.svg --insole 6 --set robot_mass=72 -o out/insole
    """
    from plantar.common.atomic import output_folder
    from plantar.common.pages.folder_page import with_folder_page
    from plantar.shoes import ShoeParameters, export_shoe, read_parameters
    from plantar.shoes.foot.source import read_foot
    from plantar.shoes.ordered import build_ordered, coupons_text, write_ordered_coupons
    from plantar.shoes.papers.export import failed_checks, shoe_text

    if order.side not in (*SIDES, "both"):
        raise InputError(f"--side is '{order.side}'; allowed: left, right, both")
    used = (ShoeParameters() if parameters is None else read_parameters(parameters)).changed(settings or [])
    shape, taxels = read_foot(replace(source, file=foot), sole_band=used.sole_band)
    read = (foot, parameters)
    if preview:
        from plantar.shoes.papers.picture import draw_preview

        with output_folder(output, read) as folder:
            draw_preview(shape, folder / "preview.png")
        drawn = {"notes": list(shape.notes), "files": [str(output / "preview.png")]}
        end_command(drawn, as_json, "\n".join(f"  {line}" for line in (*drawn["notes"], *drawn["files"])))
        return
    with output_folder(output, read) as folder, progress_bar() as progress:
        build = build_ordered(shape, order, used, taxels, part_of(progress, 0.0, 0.6))
        if order.coupon:
            made = write_ordered_coupons(build, folder, part_of(progress, 0.6, 0.4))
            made |= {"files": [str(output / name) for name in made["files"]]}
            end_command(made, as_json, coupons_text(made))
            return
        report = export_shoe(build, folder, progress=part_of(progress, 0.6, 0.4))
    files = with_folder_page(output, "Shoe", [str(output / name) for name in report.files])
    summary = report.as_dict() | {"files": files}
    failed = failed_checks(summary)
    end_command(summary, as_json, shoe_text(summary), (f"check does not hold: {line}" for line in failed), bool(failed))


COMMAND = Command(shoe, "Build a printable tactile shoe for a foot, and its taxel layout.", 10)
