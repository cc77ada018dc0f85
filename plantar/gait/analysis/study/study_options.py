"""Options of a study: what is compared, allowed for and written."""

from dataclasses import dataclass

from plantar.errors import InputError

MOST_JOBS = 256  # beyond any one machine: a slip of the keyboard


@dataclass(frozen=True)
class StudyOptions:
    """Choices of a study.

    `factors`: "condition", "side", "affected" (of a column that names the affected side) or columns of the table, each
    compared by itself, and whether the difference of one depends on another; `covariates`: columns or measures that
    are allowed for, as speed or age; `margin_percent`: differences up to this share of A's mean in percent are called
    equivalent; `devices`: column of two devices whose agreement is stated; `patient`: participant who is compared with
    the others, of condition or group `norm` if given; `mixed`: whether mixed models with steps in people are fitted;
    `workbook`: whether an Excel workbook is written; `parquet`: whether steps are written as steps.parquet instead of
    steps.csv; `jobs`: processes that measure recordings; `scheduler`: address of a Dask scheduler whose workers measure
    them instead, which see the folders under the same paths.
    """

    factors: tuple[str, ...] = ("condition",)
    covariates: tuple[str, ...] = ()
    margin_percent: float | None = None
    devices: str | None = None
    patient: str | None = None
    norm: str | None = None
    mixed: bool = False
    workbook: bool = False
    jobs: int = 1
    parquet: bool = False
    scheduler: str | None = None

    def __post_init__(self) -> None:
        if not self.factors:
            raise InputError("--factor: allowed: one name or more")
        if len(set(self.factors)) < len(self.factors) or set(self.factors) & set(self.covariates):
            raise InputError("--factor and --covariate: a name is given twice; allowed: each once")
        if self.margin_percent is not None and not 0.0 < self.margin_percent <= 100.0:
            raise InputError(f"--margin is {self.margin_percent:g}; allowed: above 0, up to 100 %")
        if self.norm is not None and self.patient is None:
            raise InputError("--norm is the group that --patient is compared with; allowed: both")
        if not 1 <= self.jobs <= MOST_JOBS:
            raise InputError(f"--jobs is {self.jobs}; allowed: 1 to {MOST_JOBS}")
