"""Measures of a step (docs/metrics.md): name, title, unit and heading."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache


@dataclass(frozen=True)
class Measure:
    """One measure. `unit`: unit in reports; `factor`: SI to that unit."""

    title: str
    unit: str
    factor: float
    group: str


_TIME = "Time"
_FORCE = "Vertical force"
_PRESSURE = "Pressure and area"
_COP = "Centre of pressure"
_FOOT = "Footprint and walk"
_ROBOT = "Robot sole"

MEASURES: Mapping[str, Measure] = {
    "contact_time_s": Measure("Contact time", "s", 1.0, _TIME),
    "stride_time_s": Measure("Stride time", "s", 1.0, _TIME),
    "step_time_s": Measure("Step time", "s", 1.0, _TIME),
    "swing_time_s": Measure("Swing time", "s", 1.0, _TIME),
    "stance_percent": Measure("Stance", "% of stride", 1.0, _TIME),
    "swing_percent": Measure("Swing", "% of stride", 1.0, _TIME),
    "double_support_percent": Measure("Double support", "% of stride", 1.0, _TIME),
    "single_support_percent": Measure("Single support", "% of stride", 1.0, _TIME),
    "flight_time_s": Measure("Flight time, both feet off the ground", "s", 1.0, _TIME),
    "peak_force_N": Measure("Peak force", "N", 1.0, _FORCE),
    "mean_force_N": Measure("Mean force over the contact", "N", 1.0, _FORCE),
    "first_peak_N": Measure("First peak (loading)", "N", 1.0, _FORCE),
    "valley_N": Measure("Valley (mid-stance)", "N", 1.0, _FORCE),
    "second_peak_N": Measure("Second peak (push-off)", "N", 1.0, _FORCE),
    "first_peak_percent": Measure("First peak at", "% of stance", 1.0, _FORCE),
    "valley_percent": Measure("Valley at", "% of stance", 1.0, _FORCE),
    "second_peak_percent": Measure("Second peak at", "% of stance", 1.0, _FORCE),
    "loading_rate_N_s": Measure("Loading rate, 20 to 80 % of the rise", "kN/s", 1e-3, _FORCE),
    "loading_rate_max_N_s": Measure("Largest loading rate", "kN/s", 1e-3, _FORCE),
    "impulse_Ns": Measure("Impulse (force-time integral)", "N·s", 1.0, _FORCE),
    "landing_impact_N": Measure("Landing impact (50 ms)", "N", 1.0, _FORCE),
    "peak_pressure_Pa": Measure("Peak pressure", "kPa", 1e-3, _PRESSURE),
    "mean_pressure_Pa": Measure("Mean pressure, mean over the contact", "kPa", 1e-3, _PRESSURE),
    "mean_pressure_max_Pa": Measure("Mean pressure, largest of a frame", "kPa", 1e-3, _PRESSURE),
    "pressure_time_integral_Pas": Measure("Pressure-time integral, of each frame's peak", "kPa·s", 1e-3, _PRESSURE),
    "pressure_time_integral_cell_Pas": Measure("Pressure-time integral, largest of a cell", "kPa·s", 1e-3, _PRESSURE),
    "force_time_integral_area_Pas": Measure("Force-time integral over footprint area", "kPa·s", 1e-3, _PRESSURE),
    "contact_area_m2": Measure("Contact area, largest of a frame", "cm²", 1e4, _PRESSURE),
    "footprint_area_m2": Measure("Footprint area, all of the contact", "cm²", 1e4, _PRESSURE),
    "support_polygon_area_m2": Measure("Support polygon, largest of a frame", "cm²", 1e4, _PRESSURE),
    "support_polygon_mean_m2": Measure("Support polygon, mean over the contact", "cm²", 1e4, _PRESSURE),
    "cop_path_m": Measure("Path length", "mm", 1e3, _COP),
    "cop_excursion_ap_m": Measure("Excursion, back to front", "mm", 1e3, _COP),
    "cop_excursion_ml_m": Measure("Excursion, side to side", "mm", 1e3, _COP),
    "cop_velocity_m_s": Measure("Velocity", "mm/s", 1e3, _COP),
    "cop_velocity_max_m_s": Measure("Largest velocity", "mm/s", 1e3, _COP),
    "cpei_percent": Measure("Excursion index (CPEI)", "% of width", 1.0, _COP),
    "cop_margin_m": Measure("Margin to the sole's edge", "mm", 1e3, _COP),
    "arch_index": Measure("Arch index", "", 1.0, _FOOT),
    "foot_length_m": Measure("Footprint length", "mm", 1e3, _FOOT),
    "foot_width_m": Measure("Footprint width", "mm", 1e3, _FOOT),
    "foot_progression_deg": Measure("Foot progression angle, outward", "°", 1.0, _FOOT),
    "step_length_m": Measure("Step length", "mm", 1e3, _FOOT),
    "step_width_m": Measure("Step width", "mm", 1e3, _FOOT),
    "stride_length_m": Measure("Stride length", "mm", 1e3, _FOOT),
    "stride_velocity_m_s": Measure("Stride velocity", "m/s", 1.0, _FOOT),
    "cop_margin_polygon_m": Measure("CoP margin to the support polygon, smallest", "mm", 1e3, _ROBOT),
    "cop_margin_polygon_mean_m": Measure("CoP margin to the support polygon, mean", "mm", 1e3, _ROBOT),
    "fx_peak_N": Measure("Wrench: largest |fx|", "N", 1.0, _ROBOT),
    "fy_peak_N": Measure("Wrench: largest |fy|", "N", 1.0, _ROBOT),
    "tx_peak_Nm": Measure("Wrench: largest |tx|", "N·m", 1.0, _ROBOT),
    "ty_peak_Nm": Measure("Wrench: largest |ty|", "N·m", 1.0, _ROBOT),
    "tz_peak_Nm": Measure("Wrench: largest |tz|", "N·m", 1.0, _ROBOT),
}
"""Measures of a step that have a mean and a spread, by their key, which names the SI unit."""

REGION_MEASURES: Mapping[str, Measure] = {
    "peak_force_N": Measure("Peak force", "N", 1.0, ""),
    "peak_pressure_Pa": Measure("Peak pressure", "kPa", 1e-3, ""),
    "impulse_Ns": Measure("Force-time integral", "N·s", 1.0, ""),
    "impulse_percent": Measure("Share of impulse", "%", 1.0, ""),
    "pressure_time_integral_Pas": Measure("Pressure-time integral", "kPa·s", 1e-3, ""),
    "contact_area_m2": Measure("Contact area", "cm²", 1e4, ""),
    "contact_time_s": Measure("Contact time", "s", 1.0, ""),
    "contact_percent": Measure("Contact", "% of stance", 1.0, ""),
}
"""Measures of a region of the foot in a step."""

_PERCENT = (
    ("_percent_bw_per_s", "_N_s"),
    ("_percent_bw_s", "_Ns"),
    ("_percent_bw", "_N"),
    ("_percent_foot", "_m"),
)
"""Ends of keys in percent of body weight and foot length, and those in SI."""

_PERCENT_UNITS = {
    "_percent_bw_per_s": "% BW/s",
    "_percent_bw_s": "% BW·s",
    "_percent_bw": "% BW",
    "_percent_foot": "% of foot length",
}

_IN_FEET = (
    "cop_path_m",
    "cop_excursion_ap_m",
    "cop_excursion_ml_m",
    "step_length_m",
    "step_width_m",
    "stride_length_m",
)
"""Lengths that are given in percent of the foot's."""

_RAW = (("_Pas", "_raw_s"), ("_Pa", "_raw"), ("_Ns", "_raw_s"), ("_N_s", "_raw_s1"), ("_Nm", "_raw_m"), ("_N", "_raw"))


def full_title(key: str) -> str:
    """Title of a measure's key without its group's heading; the key itself if unknown.

    Example:
        >>> full_title("cop_path_m"), full_title("peak_force_N"), full_title("mine")
        ('CoP path length', 'Peak force', 'mine')
        >>> full_title("forefoot_medial.peak_force_percent_bw")
        'Forefoot medial: peak force'
    """
    region, _, name = key.rpartition(".")
    plain = next((name.removesuffix(end) + unit for end, unit in _PERCENT if name.endswith(end)), name)
    if region:
        title = REGION_MEASURES[plain].title if plain in REGION_MEASURES else name
        return f"{region.replace('_', ' ').capitalize()}: {title[0].lower()}{title[1:]}"
    measure = MEASURES.get(plain)
    if measure is None:
        return key
    return f"CoP {measure.title[0].lower()}{measure.title[1:]}" if key.startswith("cop_") else measure.title


@lru_cache(maxsize=2048)  # of the same measures of each of many steps
def in_percent(key: str) -> str:
    """Measure's key in percent of body weight or foot length; empty where it is not given so.

    Example:
        >>> in_percent("peak_force_N"), in_percent("heel.impulse_Ns"), in_percent("arch_index")
        ('peak_force_percent_bw', 'heel.impulse_percent_bw_s', '')
    """
    for percent, end in _PERCENT:
        if key.endswith(end) and (end != "_m" or key in _IN_FEET):
            return key.removesuffix(end) + percent
    return ""


def unit_of(key: str) -> tuple[str, float]:
    """Unit in reports of a measure's key, of a foot or region, and the factor from the key's unit to it.

    Example:
        >>> unit_of("peak_pressure_Pa"), unit_of("heel.peak_force_percent_bw"), unit_of("mine")
        (('kPa', 0.001), ('% BW', 1.0), ('', 1.0))
    """
    for percent, _ in _PERCENT:
        if key.endswith(percent):
            return _PERCENT_UNITS[percent], 1.0
    region, _, name = key.rpartition(".")
    measure = (REGION_MEASURES if region else MEASURES).get(name)
    return ("", 1.0) if measure is None else (measure.unit, measure.factor)


def raw_name(key: str) -> str:
    """Measure's key in a recording of counts, without a force unit.

    Example:
        >>> raw_name("peak_force_N"), raw_name("contact_time_s")
        ('peak_force_raw', 'contact_time_s')
    """
    for end, instead in _RAW:
        if key.endswith(end):
            return key.removesuffix(end) + instead
    return key


def naming(raw: bool) -> Callable[[str], str]:
    """Function for a measure's key, of counts if `raw`."""
    return raw_name if raw else str


COMPARED = (
    "contact_time_s",
    "stride_time_s",
    "stance_percent",
    "double_support_percent",
    "peak_force_N",
    "first_peak_N",
    "second_peak_N",
    "loading_rate_N_s",
    "impulse_Ns",
    "peak_pressure_Pa",
    "pressure_time_integral_Pas",
    "mean_pressure_Pa",
    "contact_area_m2",
    "cop_path_m",
    "cop_velocity_m_s",
    "cpei_percent",
)
"""Measures that are compared between conditions, with one allowance for all of them."""

REGION_COMPARED = (
    "peak_force_N",
    "peak_pressure_Pa",
    "impulse_Ns",
    "pressure_time_integral_Pas",
    "contact_area_m2",
    "contact_time_s",
)
"""Measures of each region that are compared with them."""
