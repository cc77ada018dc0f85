"""Times and errors of several ways to one result."""

import math
import subprocess
import sys

from plantar.bench.comparison import Reference, Route, compare


def test_a_route_that_raises_or_gives_nan_is_wrong_altogether():
    routes = [
        Route("fine", float, [2.0], ours=True),
        Route("raises", math.sqrt, [-1.0]),
        Route("nan", lambda v: math.nan, [2.0]),
    ]
    found = compare("k", "1", routes, Reference([2.0]), rounds=2, most=0.01)
    assert [r.error for r in found] == [0.0, 1.0, 1.0]
    assert found[0].ratio == 1.0


def test_neither_plantar_nor_the_help_loads_the_measuring():
    code = (
        "import sys, plantar; [getattr(plantar, n) for n in plantar.__all__]; sys.argv = ['plantar', '--help']\n"
        "from plantar import cli\ntry:\n    cli.main()\nexcept SystemExit:\n    pass\n"
        "assert not [m for m in sys.modules if m.startswith('plantar.bench')]"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
