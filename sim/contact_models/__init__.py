"""How a simulated sole can touch the ground and feel it: candidates, what they are measured by, and the comparison.

`plantar bench contact` runs it. The model that the simulator uses is `sim.skin`; the others stay here so that the
choice can be repeated on another machine or another version of MuJoCo.
"""

from sim.contact_models.candidates import CANDIDATES, Candidate, build_sole
from sim.contact_models.comparison import ContactRow, compare_contact_models
from sim.contact_models.parameters import ParameterRow, study_contact_parameters
from sim.contact_models.report import holds, write_contact_report

__all__ = [
    "CANDIDATES",
    "Candidate",
    "ContactRow",
    "ParameterRow",
    "build_sole",
    "compare_contact_models",
    "holds",
    "study_contact_parameters",
    "write_contact_report",
]
