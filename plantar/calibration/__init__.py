"""How counts become newtons: `calibrate` fits soles' responses to recordings of counts under known loads."""

from plantar.calibration.calibrated import Calibrated, calibrate
from plantar.calibration.check import CheckedCalibration, check_calibration, drift
from plantar.calibration.take import Take, read_take

__all__ = ["Calibrated", "CheckedCalibration", "Take", "calibrate", "check_calibration", "drift", "read_take"]
