"""Robot and partner go the way of the one that leads, and neither leans on the other."""

from plantar.common.settings.schema import number
from plantar.common.sides import SIDES
from plantar.sim.judging.criteria.criterion import Criterion, JudgedRun, Reason, not_measured
from plantar.sim.judging.unmet import unmet


class PartnerLed(Criterion):
    """The one that leads moves the other one.

    Attributes:
        way: Share of its planned way by which a robot that leads moves its partner: the rest is lost to the gap before
            they touch and to a partner that swings back towards where it rests.
        back: Share of the partner's stride by which the feet of a robot that is led step back, as H1 in K 5.2 once.
        force: Largest force between them, in weights; K has "up to around 80 N". A robot that leans needs more.
    """

    way: float = number(0.5, "1", 0, 1)
    back: float = number(0.5, "1", 0, 10)
    force: float = number(0.15, "1", 0, 10)

    def claim(self) -> str:
        return (
            f"a robot that leads moves its partner by {self.way:g} of its way, one that is led steps back by "
            f"{self.back:g} strides of the partner, and neither presses with more than {self.force:g} of the weight"
        )

    def reasons(self, run: JudgedRun) -> list[Reason]:
        if run.touched is None or run.touched.partner is None:
            return not_measured("partner_led", "there was no partner")
        partner = run.touched.partner
        settings = run.scene.partner
        led = _stepped_back if settings.role == "leader" else _partner_moved
        pressed = partner.largest_force / run.body.weight
        text = f"robot and partner pressed with {pressed:.2f} of the weight; allowed: {self.force:g}, more is leaning"
        share = self.back * settings.stride if settings.role == "leader" else self.way
        return [*led(run, share), *unmet((pressed <= self.force, "leaning", pressed, self.force, text))]


def _partner_moved(run: JudgedRun, share: float) -> list[Reason]:
    way = _way_of_plan(run)
    moved = -float(run.touched.partner.moved)
    needed = share * way
    text = f"the partner was led {moved:.3f} m; a walk of {way:.3f} m towards it needs {needed:.3f} m"
    return unmet((moved >= needed, "led", moved, round(needed, 4), text))


def _stepped_back(run: JudgedRun, needed: float) -> list[Reason]:
    before = _middle({side: foot.ankle[0] for side, foot in run.planned.standing.items()})
    feet = {stand.side: stand.place[0] for stand in run.judge.steps.last_stands()}
    back = before - _middle({side: feet.get(side, foot.ankle[0]) for side, foot in run.planned.standing.items()})
    back += _way_of_plan(run)
    text = f"the feet stepped back by {back:.3f} m before the partner that leads; wanted: {needed:.3f} m"
    return unmet((back >= needed, "led", back, round(needed, 4), text))


def _way_of_plan(run: JudgedRun) -> float:
    return float((run.planned.middle(last=True) - run.planned.middle())[0])


def _middle(places: dict[str, float]) -> float:
    return sum(float(places[side]) for side in SIDES) / len(SIDES)
