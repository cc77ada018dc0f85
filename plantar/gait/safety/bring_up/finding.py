"""What bring-up finds wrong."""

from plantar.common.record import Record


class Finding(Record, frozen=True):
    """A check that failed.

    Attributes:
        cause: Likely cause, such as "soles exchanged".
        measured: What was measured, with its unit.
        allowed: What passes.
    """

    cause: str
    measured: str
    allowed: str

    def __str__(self) -> str:
        return f"{self.cause}: {self.measured}; allowed: {self.allowed}"
