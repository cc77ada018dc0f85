"""The plan has one owner: nobody but `WalkPlan` changes footsteps, timing or VRPs."""

import ast
from pathlib import Path

import pytest

import plantar

ROOT = Path(plantar.__file__).resolve().parent  # of what is imported: the checkout, or where it is installed
OWNER = "gait/plan/walk_plan.py"
PLANNED = {"_view", "_vrps", "_record", "vrps", "schedule", "phases", "steps", "foothold", "timing"}
"""Names by which what is planned can be reached."""


def writes(source: str) -> list[str]:
    """Assignments to a member of what is planned, of any object but the writer itself, and calls that change a plan."""
    found = []
    for node in ast.walk(ast.parse(source)):
        targets: list[ast.expr] = []
        if isinstance(node, ast.Assign):
            targets = node.targets
        elif isinstance(node, ast.AugAssign | ast.AnnAssign):
            targets = [node.target]
        elif isinstance(node, ast.Delete):
            targets = node.targets
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(
            ("plan.apply", "object.__setattr__", "setattr")
        ):
            found.append(f"{node.lineno}: {ast.unparse(node.func)}")
        for target in targets:
            while isinstance(target, ast.Subscript | ast.Starred):
                target = target.value
            own = isinstance(target, ast.Attribute) and ast.unparse(target.value) == "self"
            if isinstance(target, ast.Attribute) and target.attr in PLANNED and not own:
                found.append(f"{node.lineno}: {ast.unparse(target)}")
    return found


def test_only_the_controller_applies_changes_and_nobody_writes_into_the_plan():
    found = {}
    for path in sorted([*(ROOT / "gait").rglob("*.py"), *(ROOT / "sim" / "run").rglob("*.py")]):
        name = path.relative_to(ROOT).as_posix()
        lines = writes(path.read_text(encoding="utf-8"))
        if lines and name != OWNER:
            found[name] = [line.partition(": ")[2] for line in lines]
    assert found == {"gait/controller.py": ["self.plan.apply"]}


@pytest.mark.parametrize(
    "source",
    [
        "plan.schedule = other",
        "self.plan.view.steps[3] = step",
        "self._plan._vrps = vrps",
        "view.steps += (step,)",
        "object.__setattr__(step, 'x', 1.0)",
        "self.plan.apply(change, time, region)",
    ],
)
def test_a_planted_write_is_found(source):
    assert writes(source)


def test_no_proposer_holds_the_plan_or_the_feet():
    """They get values and return one: neither the plan nor foot motion is imported by them."""
    for path in (ROOT / "gait" / "propose").glob("*.py"):
        names = {
            alias.name
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.ImportFrom)
            for alias in node.names
        }
        assert not names & {"WalkPlan", "FootMotion", "VrpPlan", "WalkingController"}, path.name
