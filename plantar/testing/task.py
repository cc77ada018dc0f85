"""What a task has to keep."""

import numpy as np

from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task


def check_task(task: Task, robot: RobotDynamics, skin: Reading | None = None) -> list[str]:
    """What a task lacks, a sentence each; empty if nothing.

    Args:
        task: The task.
        robot: A robot's dynamics at an instant.
        skin: A reading that should make the task ask for something; None without skin.

    Returns:
        The sentences.
    """
    demand = task.demand(robot, skin)
    if demand is None:
        return [] if skin is None else ["demand() is None though the skin reads something"]
    if not isinstance(demand, Demand):
        return [f"demand() returns a {type(demand).__name__}; expected a Demand or None"]
    size = len(robot.velocity)
    jacobian = np.asarray(demand.jacobian)
    if jacobian.ndim != 2 or jacobian.shape[1] != size:
        return [f"the Jacobian has shape {jacobian.shape}; expected (m, {size})"]
    rows = len(jacobian)
    lacks = []
    if (demand.force is None) == (demand.acceleration is None):
        lacks.append("a demand is of a force or of an acceleration: give one of them")
    for name in ("force", "acceleration", "drift"):
        value = getattr(demand, name)
        if value is not None and np.shape(value) != (rows,):
            lacks.append(f"{name} has shape {np.shape(value)}; expected ({rows},)")
        elif value is not None and not np.isfinite(value).all():
            lacks.append(f"{name} is not finite")
    again = task.demand(robot, skin)
    if again is None or not np.allclose(again.jacobian, jacobian):
        lacks.append("asked twice at one instant, it gives two Jacobians")
    return lacks
