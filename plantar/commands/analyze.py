"""`plantar analyze`: measure the steps of a recording, or a study of many."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, cast

from typer import Argument, Option

from plantar.common.console.command import Command, Json, Output, end_command, file_lines, with_option_groups
from plantar.common.console.ending import print_note
from plantar.common.console.progress import progress_bar
from plantar.errors import InputError

_NOTES = 3  # Warnings that are printed of each recording; the files hold all


def _option(default: Any, text: str, *names: str, metavar: str | None = None) -> Any:
    return field(default=default, metadata={"help": text, "metavar": metavar, "names": names})


@dataclass(frozen=True)
class FileOrder:
    """Options for facts that a file does not contain."""

    TITLE: ClassVar[str] = "What the file does not state"

    format: str | None = _option(None, "Name of the format, where recognition fails: see plantar list formats.")
    layout: Path | None = _option(  # noqa: RUF009
        None,
        "Layout file, or an insole by maker and size (moticon:7, pedar:xw), instead of the format's own geometry; "
        "mirrored for the other foot.",
    )
    unit: str | None = _option(None, "Unit of the values, instead of the file's: kPa, N/cm2, mmHg, psi, N, raw, ...")
    rate: float | None = _option(None, "Frames a second, instead of the file's.")
    side: str | None = _option(
        None, "Which foot a file of one foot, or the first columns of a pedar file, hold.", metavar="left|right"
    )
    insole_size: str | None = _option(
        None, "Size of a pedar insole, instead of the file's.", metavar="u|v|w|x|y|z|uw|vw|xw"
    )
    plates: str | None = _option(
        None, "Which foot steps on each force plate, in order; - leaves a plate out.", metavar="L,R"
    )
    columns: str | None = _option(
        None,
        "Which columns of a table are what, where their names do not show it: a name or number each.",
        metavar="MAP",
    )
    mm_per_pixel: float | None = _option(None, "Footprint images: size of a pixel in mm.")

    def options(self, mass: float | None) -> Any:
        """The `ReadOptions` of this order for a body of `mass` in kg; an InputError if a value is not allowed."""
        from plantar.formats import ReadOptions
        from plantar.formats.side import sides_of_plates

        return ReadOptions(
            unit=self.unit,
            rate_hz=self.rate,
            side=cast(Any, self.side),
            insole_size=self.insole_size,
            mass_kg=mass,
            plates=sides_of_plates(self.plates),
            columns=self.columns,
        )


@dataclass(frozen=True)
class AnalysisOrder:
    """Options for the measured steps and the person."""

    TITLE: ClassVar[str] = "Which steps, and whose"

    steps: str | None = _option(
        None, "Steps of each foot in the means, or all, or steady (without start and stop).", metavar="3-14|all|steady"
    )
    begin: float | None = _option(None, "Time in s before which no step is in the means.", "--from")
    end: float | None = _option(None, "Time in s after which no step is in the means.", "--to")
    segment: str | None = _option(
        None, "Activity in the means. Default: that of most steps.", metavar="walking|running|hopping"
    )
    baseline: str = _option(
        "auto", "auto subtracts what sensors read in swing where that is an offset; keep does not.", metavar="auto|keep"
    )
    events: str = _option(
        "own",
        "own finds heel strikes and toe offs in the force; vendor uses those of the file; or a file's path.",
        metavar="own|vendor|FILE",
    )
    threshold: float | None = _option(
        None, "Force in N at which heel strikes and toe offs lie, by a protocol, instead of those found in the force."
    )
    masks: str = _option(
        "seven",
        "Regions of the foot: seven (automatic), ten (by anatomy), or a file of polygons (JSON, or mask,u,v).",
        metavar="seven|ten|FILE",
    )
    participant: str = _option("", "The person's name, for the report's heading.")
    mass: float | None = _option(None, "Mass of the body in kg: forces are given in percent of its weight.")
    foot_length: float | None = _option(None, "Length of the foot in m, for the report's heading.")

    day: bool = _option(False, "Measure a day of insoles: bouts, steps and load by the hour, on one page.")
    clock: str | None = _option(None, "Of a day: when the recording began, as 08:30 or 2026-03-02T08:30.")

    def choices(self) -> Any:
        """The `AnalysisOptions`: which steps and events count."""
        from plantar.gait.analysis.masks import masks_of
        from plantar.gait.analysis.options import AnalysisOptions, steps_of_text

        steps = steps_of_text(self.steps)
        return AnalysisOptions(
            steps,
            self.begin,
            self.end,
            self.segment,
            cast(Any, self.baseline),
            self.events,
            self.threshold,
            masks_of(self.masks),
        )

    def subject(self) -> Any:
        """The person."""
        from plantar.gait.analysis.subject import Subject

        return Subject(self.participant, self.mass, self.foot_length)


@dataclass(frozen=True)
class StudyOrder:
    """Options for a folder of recordings: what is compared."""

    TITLE: ClassVar[str] = "Of a folder: what is compared"

    factor: list[str] | None = _option(  # noqa: RUF009
        None,
        "What is compared: condition, side, affected, or a column of the table; repeatable. Default: condition.",
        metavar="NAME",
    )
    covariate: list[str] | None = _option(  # noqa: RUF009
        None, "Column or measure that is allowed for, as speed or age; repeatable.", metavar="NAME"
    )
    margin: float | None = _option(
        None, "Call differences up to this share of the mean equivalent, in percent, by two one-sided tests."
    )
    devices: str | None = _option(None, "Column of two devices, whose agreement is stated.", metavar="COLUMN")
    patient: str | None = _option(None, "Participant who is compared with the others, on a sheet.", metavar="NAME")
    norm: str | None = _option(None, "Condition or group that the patient is compared with. Default: all others.")
    mixed: bool = _option(False, "Fit mixed models of single steps, too (needs statsmodels).")
    xlsx: bool = _option(False, "Write study.xlsx, with a sheet of definitions, too (needs XlsxWriter).")
    jobs: int = _option(1, "Processes that measure recordings.")
    parquet: bool = _option(False, "Write steps.parquet instead of steps.csv (needs pyarrow).")
    scheduler: str | None = _option(
        None, "Dask scheduler whose workers measure, on machines that see the folders under the same paths."
    )

    def plan(self) -> Any:
        """The `StudyOptions`."""
        from plantar.gait.analysis.study.study_options import StudyOptions

        return StudyOptions(
            tuple(self.factor or ("condition",)),
            tuple(self.covariate or ()),
            self.margin,
            self.devices,
            self.patient,
            self.norm,
            self.mixed,
            self.xlsx,
            self.jobs,
            self.parquet,
            self.scheduler,
        )


@with_option_groups
def analyze(
    file: FileOrder,
    order: AnalysisOrder,
    study: StudyOrder,
    recording: Annotated[
        Path | None,
        Argument(
            metavar="RECORDING",
            help="Recording, footprint image, or a folder of recordings (a study).",
            show_default=False,
        ),
    ] = None,
    participants: Annotated[
        Path | None,
        Option(
            help="Table (CSV) of file, participant, condition and what else is known.",
            rich_help_panel=StudyOrder.TITLE,
        ),
    ] = None,
    compare: Annotated[
        tuple[Path, Path] | None,
        Option("--compare", metavar="A B", help="Compare two recordings instead of measuring one."),
    ] = None,
    export: Annotated[
        list[str] | None,
        Option(metavar="FORMAT", help="Write the recording in another format, too: c3d, csv, mot or npz; repeatable."),
    ] = None,
    figures: Annotated[
        bool | None,
        Option("--figures/--no-figures", help="Whether figures and report are drawn; not with --json, else yes."),
    ] = None,
    output: Output = Path("out/analysis"),
    as_json: Json = False,
) -> None:
    """Measure feet: recordings of insoles, platforms, robot soles and force plates, or an image of a footprint.

    Finds the steps and writes metrics.json, steps.csv (a row a step), regions.csv, figures (PNG and SVG) and
    report.html, which opens anywhere. What had to be assumed is listed in "warnings"; docs/metrics.md explains each
    measure.

    Example: plantar analyze walk.asc -o out/walk

    Example: plantar analyze out/walk/run.mcap --json

    Example: plantar analyze walk.asc --participant P07 --mass 71.5

    Example: plantar analyze walk.asc --export c3d --export npz

    Example: plantar analyze table.csv --layout insole.json --unit kPa

    Example: plantar analyze table.csv --columns "left=Fz1, right=Fz2, time=t"

    Example: plantar analyze scan.png --mm-per-pixel 0.5

    Example: plantar analyze day.npz --day --clock 08:30

    Example: plantar analyze --compare before.mcap after.mcap -o out/both

    Example: plantar analyze recordings/ --participants table.csv -o out/study

    Example: plantar analyze recordings/ --participants table.csv --factor shoe --factor side --covariate speed

    Example: plantar analyze recordings/ --participants table.csv --patient P07 --norm healthy

    Of a folder, every recording is measured; steps.csv, recordings.csv and comparison.csv hold all of them, study.html
    compares the conditions, and a study that was stopped goes on where it was.
    """
    from plantar.formats import is_study_folder
    from plantar.formats.walkway import is_walkway

    if (recording is None) == (compare is None):
        raise InputError("give either one recording or --compare A B: plantar analyze walk.asc")
    drawn = not as_json if figures is None else figures
    if recording is not None and (is_study_folder(recording) or is_walkway(recording)):
        if export:
            raise InputError("--export is for one recording; a study's tables are CSV files")
        _analyze_study(recording, participants, file, order, study, output, as_json, drawn)
        return
    if order.day or order.clock:
        if not order.day or recording is None or export:
            raise InputError("--day measures one recording, --clock is its begin: plantar analyze day.npz --day")
        _analyze_day(recording, file, order, output, as_json, drawn)
        return
    if study != StudyOrder():
        raise InputError("--factor to --scheduler are for a folder of recordings: plantar analyze recordings/")
    if participants is not None:
        raise InputError(
            "--participants is for a folder of recordings: plantar analyze recordings/ --participants table.csv"
        )
    if compare is not None:
        if export:
            raise InputError("--export is for one recording; --compare takes two")
        result = _compare(compare, file, order, output, drawn)
        _end(result, {"A": result["a"], "B": result["b"]}, output, as_json)
    else:
        result = _analyze_one(cast(Path, recording), export or [], file, order, output, drawn)
        _end(result, {"": result}, output, as_json)


def _analyze_one(
    recording: Path, export: list[str], file: FileOrder, order: AnalysisOrder, output: Path, figures: bool
) -> dict[str, Any]:
    from plantar.gait.analysis.analyse_one import analyse_recording
    from plantar.gait.analysis.exports import exporter

    with progress_bar() as progress:
        return analyse_recording(
            recording,
            output,
            progress=progress,
            mm_per_pixel=file.mm_per_pixel,
            also=exporter(export),
            **_known(file, order, figures),
        )


def _analyze_day(
    recording: Path, file: FileOrder, order: AnalysisOrder, output: Path, as_json: bool, figures: bool
) -> None:
    from plantar.formats import read_recording
    from plantar.gait.analysis.analyse_one import with_layout
    from plantar.gait.analysis.day.day_page import summary_of, write_day
    from plantar.gait.analysis.day.measured_day import clock_of, hours_and_minutes, measure_day

    clock = clock_of(order.clock)
    masks = order.choices().masks
    held = read_recording(recording, file.format, options=with_layout(file.options(order.mass), file.layout))
    day = measure_day(held, order.mass, clock, masks)
    title = order.participant or recording.name
    files = write_day(day, masks, output, title, figures)
    text = (
        f"{hours_and_minutes(day.end - day.begin)}: {day.steps} steps, walking "
        f"{hours_and_minutes(day.seconds('walking'))}, standing {hours_and_minutes(day.seconds('standing'))}, sitting "
        f"{hours_and_minutes(day.seconds('sitting'))}"
    )
    end_command(summary_of(day) | {"files": files}, as_json, text + file_lines(files))
    for note in () if as_json else day.notes[:_NOTES]:
        print_note(f"note: {note}")


def _known(file: FileOrder, order: AnalysisOrder, figures: bool) -> dict[str, Any]:
    return {
        "format": file.format,
        "layout": file.layout,
        "options": file.options(order.mass),
        "choices": order.choices(),
        "subject": order.subject(),
        "figures": figures,
    }


def _compare(
    pair: tuple[Path, Path], file: FileOrder, order: AnalysisOrder, output: Path, figures: bool
) -> dict[str, Any]:
    from plantar.gait.analysis.compare import compare_recordings

    if file.mm_per_pixel is not None:
        raise InputError("--mm-per-pixel is for footprint images; --compare takes recordings over time")
    with progress_bar() as progress:
        return compare_recordings(*pair, output, progress=progress, **_known(file, order, figures))


def _end(result: dict[str, Any], parts: dict[str, Any], output: Path, as_json: bool) -> None:
    from plantar.common.pages.folder_page import with_folder_page
    from plantar.gait.analysis.pages.report import analysis_text

    result["files"] = with_folder_page(output, "Analysis", result["files"])
    text = "\n".join(analysis_text(metrics, name) for name, metrics in parts.items())
    end_command(result, as_json, text + file_lines(result["files"]))
    written = {Path(name).name for name in result["files"]}
    for name, metrics in () if as_json else {"": result, **parts}.items():
        warnings = metrics["warnings"]
        about = f" of {name}" if name else ""
        for warning in warnings[:_NOTES]:
            print_note(f"note{about}: {warning}")
        if len(warnings) > _NOTES:
            listed = [name for name in ("metrics.json", "report.html") if name in written]
            print_note(f"note{about}: {len(warnings) - _NOTES} more in {' and '.join(listed)}")


def _analyze_study(
    folder: Path,
    participants: Path | None,
    file: FileOrder,
    order: AnalysisOrder,
    plan: StudyOrder,
    output: Path,
    as_json: bool,
    figures: bool,
) -> None:
    """Measure a folder of recordings; one that cannot be read is listed, without failing the command."""
    from plantar.common.pages.folder_page import with_folder_page
    from plantar.common.workers.cluster_workers import network_note
    from plantar.gait.analysis.analyse_one import with_layout
    from plantar.gait.analysis.study.run_study import run_study
    from plantar.gait.analysis.subject import Subject

    options = with_layout(file.options(order.mass), file.layout)
    choices = order.choices()
    if plan.scheduler is not None and (note := network_note(plan.scheduler)):
        print_note(f"note: {note}")
    if order.subject() != Subject():
        raise InputError("--participant, --mass and --foot-length are for one recording: a study has --participants")
    with progress_bar() as progress:
        study = run_study(
            folder,
            output,
            participants,
            progress,
            choices=choices,
            options=options,
            figures=figures,
            plan=plan.plan(),
        )
    files = with_folder_page(output, "Study", study.files)
    summary = study.summary() | {"files": files}
    text = f"{summary['measured']} of {summary['recordings']} recordings measured, {summary['steps']} steps"
    end_command(summary, as_json, text + file_lines(files))
    missed = [f"not measured: {name}: {why}" for name, why in summary["errors"].items()]
    lines = ((f"{c['a']} and {c['b']}", line) for c in summary["comparisons"] for line in (c["note"], *c["doubts"]))
    compared = [f"{pair}: {line}" for pair, line in lines if line]
    for note in () if as_json else (*summary["notes"], *compared, *missed):
        print_note(note)


COMMAND = Command(analyze, "Measure the steps of a recording, or a study of many.", 20)
