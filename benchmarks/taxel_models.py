"""How well a straight edge under a sole is found under two models of its taxels: `python benchmarks/taxel_models.py`.

The fit (`plantar/sensing/partial_contact.py`) assumes springs side by side. Here it reads springs, an elastic layer of
12 mm and nearly a half-space: the same edges, loads and noise.
"""

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from resumable import write_table

from plantar.bench.tables import markdown_table
from plantar.geometry.polygon import area, centroid
from plantar.layouts.layout import SoleLayout
from plantar.robots.robot_file import load_robot
from plantar.sensing.partial_contact import PartialContact
from plantar.sim.sensing.elastic_pressure import ElasticPressure
from plantar.sim.sensing.sole_pressure import SolePressure

EDGES = 200
LOAD, NOISE = 800.0, 0.3
"""Load in N of a foot that stands, and standard deviation in N of a mean over a dozen readings of a taxel."""


def errors(layout: SoleLayout, pressure: SolePressure | ElasticPressure) -> NDArray[np.float64]:
    """Errors (m, 2) of random edges that leave a fifth to nine tenths of a sole: centroid in mm, share of the sole."""
    rng = np.random.default_rng(0)
    fit = PartialContact(layout)
    whole = fit.polygon(np.empty((0, 3)))
    found = []
    while len(found) < EDGES:
        turn = rng.uniform(0.0, 2.0 * math.pi)
        line = np.array([[math.cos(turn), math.sin(turn), rng.uniform(-0.1, 0.1)]])
        true = fit.polygon(line)
        if len(true) < 3 or not 0.2 < area(true) / area(whole) < 0.9:
            continue
        middle = centroid(true)
        place = tuple((middle + rng.normal(0.0, 0.008, 2)).tolist())
        force = pressure.spread([tuple(p) for p in true.tolist()], LOAD, place)
        force = np.maximum(force + rng.normal(0.0, NOISE, len(layout)), 0.0)
        fit.reset()
        edges = fit.update(force, force > 3.0, noise=math.hypot(NOISE, 0.1 * float(force.max())), steps=8)
        seen = centroid(edges.polygon)
        assert seen is not None
        found.append((1e3 * math.dist(seen, middle), (area(edges.polygon) - area(true)) / area(whole)))
    return np.array(found)


if __name__ == "__main__":
    lines = []
    head = ["taxels", "robot", "centroid error, median [mm]", "95 % [mm]", "area found less true [share of the sole]"]
    for robot in ("h1", "hrp2kai"):
        layout = load_robot(robot).layouts["left"]
        models: dict[str, SolePressure | ElasticPressure] = {
            "springs side by side": SolePressure(layout),
            "elastic layer, 12 mm": ElasticPressure(layout, thickness=0.012),
            "elastic layer, 50 mm": ElasticPressure(layout, thickness=0.05),
            "half-space": ElasticPressure(layout, thickness=math.inf),
        }
        for name, model in models.items():
            error, share = errors(layout, model).T
            cells = f"{np.median(error):.1f}", f"{np.percentile(error, 95):.1f}", f"{np.median(share):+.3f}"
            lines.append((name, robot, *cells))
    write_table(Path(__file__).with_name("taxel_models.md"), [markdown_table(head, lines)])
