"""How a simulated sole can touch the ground and measure it: candidates, what they are measured by, and the comparison.

`plantar bench contact` runs it. The simulator uses the model of `plantar.sim.sensing.skin`; the others stay here so
that the choice can be repeated on another machine or another version of MuJoCo.
"""

from plantar.sim.contact_models.candidate import CANDIDATES, Candidate
from plantar.sim.contact_models.comparison import ContactRow, compare_contact_models
from plantar.sim.contact_models.page import holds
from plantar.sim.contact_models.parameters import ParameterRow, study_contact_parameters
from plantar.sim.contact_models.report import measure_contact, write_contact_report
from plantar.sim.contact_models.sole import build_sole

__all__ = [
    "CANDIDATES",
    "Candidate",
    "ContactRow",
    "ParameterRow",
    "build_sole",
    "compare_contact_models",
    "holds",
    "measure_contact",
    "study_contact_parameters",
    "write_contact_report",
]
