"""What the columns of a study's tables are."""

from collections.abc import Iterable

from plantar.gait.analysis.measures import full_title

_UNITS = (
    *(("_percent_bw_per_s", "% of body weight per s"), ("_percent_bw_s", "% of body weight x s")),
    *(("_percent_bw", "% of body weight"), ("_percent_foot", "% of foot length"), ("_raw_s1", "counts/s")),
    *(("_raw_s", "counts x s"), ("_raw", "counts"), ("_percent", "%"), ("_deg", "degrees"), ("_m_s", "m/s")),
    *(("_N_s", "N/s"), ("_Ns", "N s"), ("_Nm", "N m"), ("_N", "N"), ("_Pas", "Pa s"), ("_Pa", "Pa")),
    *(("_m2", "m2"), ("_kg", "kg"), ("_m", "m"), ("_hz", "Hz"), ("_per_min", "1/min"), ("_s", "s")),
)

COLUMNS = {
    "recording": "file, relative to the study's folder",
    "participant": "who walked",
    "condition": "condition or group that the table states",
    "side": "foot",
    "step": "number of the foot's complete contact, from 1",
    "used": "1: in the means",
    "note": "why not in the means, or what is odd",
    "steps": "steps in the means",
    "factor": "what is compared",
    "a": "level A",
    "b": "level B",
    "measure": "measure of the foot, or region.measure",
    "paired": "whether levels are compared within participants",
    "n_a": "participants in A",
    "n_b": "participants in B",
    "mean_a": "mean of A's participants, in the measure's unit",
    "mean_b": "mean of B's participants, in the measure's unit",
    "difference": "B less A; adjusted for covariates where there are any",
    "low": "lower end of the 95 % interval (of one against a group: of what 95 % of the group's people have)",
    "high": "upper end of that interval",
    "effect_size": "Hedges' g of B less A",
    "effect_low": "lower end of its 95 % confidence interval",
    "effect_high": "upper end of its 95 % confidence interval",
    "p": "probability of such a difference by chance, of this measure and pair alone, by permutation",
    "p_all": "the same, allowing for all measures, regions and pairs together",
    "error": "standard error",
    "freedom": "degrees of freedom of the standard error",
    "margin": "difference up to which levels are called equivalent",
    "p_equivalent": "two one-sided tests: below 0.05 the levels are equivalent within the margin",
    "people_for_80_percent": "pairs, or people a group, that find such a difference in 80 of 100 studies",
    "n": "participants",
    "k": "trials of each participant",
    "icc_2_1": "ICC(2,1): one trial, absolute agreement, two-way random",
    "icc_2_k": "ICC(2,k): the mean of k trials",
    "sem": "standard error of measurement of one trial, in the measure's unit",
    "mdc95": "smallest change between two trials beyond error in 95 of 100, in the measure's unit",
    "bias": "mean difference of the devices, B less A",
    "sd": "standard deviation (of differences, or of the group)",
    "below_percent": "estimated share of the group's people below the person",
    "t": "Crawford & Howell's t",
}
"""Meanings of columns that are no measures."""


def definition_of(column: str) -> tuple[str, str]:
    """Meaning and unit of a column.

    Example:
        >>> definition_of("heel.peak_force_percent_bw"), definition_of("mdc95")[1]
        (('Heel: peak force', '% of body weight'), '')
    """
    if column in COLUMNS:
        return COLUMNS[column], ""
    unit = next((unit for end, unit in _UNITS if column.endswith(end)), "")
    title = full_title(column)
    return ("" if title == column else title), unit


def definition_rows(columns: Iterable[str]) -> list[tuple[str, str, str]]:
    """Column, meaning and unit of each column that is known, once."""
    rows = ((name, *definition_of(name)) for name in dict.fromkeys(columns))
    return [row for row in rows if row[1] or row[2]]
